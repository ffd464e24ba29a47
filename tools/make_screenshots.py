"""Makes the screenshots in README and docs from the running program.

Run from the project's root, for all screenshots or for some:

    python tools/make_screenshots.py [NAME ...] [--scale 2] [--folder docs/images]

Needs no display: the window opens on GLFW's null platform. To add a screenshot, add a function with @shot.
"""

from imgui_bundle import imgui  # isort: skip
import argparse
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from akap_editor.app import files, theme
from akap_editor.app.app_state import AppState
from akap_editor.app.commands.palette import Palette
from akap_editor.app.commands.registry import PALETTE_ITEMS, PREFERENCES, SHORTCUTS
from akap_editor.app.dialogs.clips import ClipsDialog
from akap_editor.app.dialogs.export.animation import ExportAnimationDialog
from akap_editor.app.dialogs.export.pose import ExportPoseDialog
from akap_editor.app.dialogs.first_steps import FirstSteps
from akap_editor.app.glfw_window import DEFAULT_SIZE
from akap_editor.app.preferences import Preferences
from akap_editor.app.window import Window
from akap_editor.editor import gestures
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.events import KeyEvent, PinRequest, PointerEvent
from akap_editor.editor.session.edits import PaintStiffness
from akap_editor.editor.session.pin_edits import hold_angles
from akap_editor.editor.session.replay import replay
from akap_editor.editor.tools.rotate import RING_RADIUS
from akap_editor.io.akap.recording import read_recording
from akap_editor.io.images import read_image, write_png
from akap_editor.resources import resource
from akap_editor.words import use_language

FOLDER = Path("docs/images")
SETTLE_FRAMES = 12  # until dialogs have their size and measurements their values
RECENT = ("dragon.akap", "walk cycle/goose 03.png", "sketches/robot.webp")

SHOTS: dict[str, Callable[[Window], None]] = {}


def shot(name: str) -> Callable[[Callable[[Window], None]], Callable[[Window], None]]:
    """Register a function that prepares a window with the posed elephant for the screenshot NAME.png."""

    def register(prepare: Callable[[Window], None]) -> Callable[[Window], None]:
        SHOTS[name] = prepare
        return prepare

    return register


@cache
def posed_elephant() -> Document:
    """Return the elephant in the last pose of the bundled recording."""
    recording = read_recording(resource("assets", "recordings", "elephant.akaprec"))
    image = read_image(resource("assets", "drawings", "elephant.png"))
    document = new_document(make_drawing(image, name="elephant"))
    *_, last = replay(recording, document.drawing)
    return document.with_state(last.state)


def show_rest_pose(window: Window) -> None:
    """Show the elephant at rest, without pins."""
    files.show_document(window.state, new_document(posed_elephant().drawing))


@shot("editor")
def editor(window: Window) -> None:
    """The posed elephant."""


@shot("mesh")
def mesh(window: Window) -> None:
    """The mesh over the drawing."""
    window.state.view.show_mesh = True


@shot("start")
def start(window: Window) -> None:
    """The start page, with recent files."""
    window.state.editor.close()
    home = Path("/home/ada/Pictures")
    for name in reversed(RECENT):
        window.state.preferences.add_recent(home / name)


@shot("first-steps")
def first_steps(window: Window) -> None:
    """The first steps for newcomers."""
    show_rest_pose(window)
    window.state.part(FirstSteps).is_open = True


@shot("palette")
def palette(window: Window) -> None:
    """The command palette after a few letters."""
    window.state.part(Palette).open(PALETTE_ITEMS, "sho")


@shot("keys")
def keys(window: Window) -> None:
    """The shortcuts page."""
    SHORTCUTS.run(window.state)


@shot("pins")
def pins(window: Window) -> None:
    """Two selected pins, and the values of one of them."""
    state = window.state
    last_two = [pin.id for pin in posed_elephant().state.pins][-2:]
    state.editor.select(last_two)
    state.editor.request = PinRequest("values", last_two[-1])


@shot("crosshair")
def crosshair(window: Window) -> None:
    """The keyboard pointer on the drawing."""
    editor = window.state.editor
    width, height = posed_elephant().drawing.size
    editor.last_pointer = editor.camera.to_screen((0.42 * width, 0.5 * height))
    editor.toggle_keyboard_pointer()


@shot("ring")
def ring(window: Window) -> None:
    """The drawing being rotated around a pin; another pin holds its angle."""
    editor = window.state.editor
    pins = [pin.id for pin in posed_elephant().state.pins]
    editor.edit("Hold Angle", lambda session: hold_angles(session, pins[:1]))
    x, y = editor.pins_on_screen()[pins[-1]]
    radius = window.scale * RING_RADIUS
    path = [(x + radius * np.cos(a), y + radius * np.sin(a)) for a in np.radians((0, 15, 30, 35))]
    editor.handle_event(KeyEvent("alt"))
    editor.handle_event(PointerEvent("move", path[0]))
    editor.handle_event(PointerEvent("press", path[0], alt=True))
    for point in path[1:]:
        editor.handle_event(PointerEvent("move", point, alt=True))


@shot("brush")
def brush(window: Window) -> None:
    """The stiffness brush; the back and a tusk of the elephant are stiff."""
    show_rest_pose(window)
    editor = window.state.editor
    editor.chosen_tool = editor.brush_tool
    width, height = posed_elephant().drawing.size
    for factor, points in (
        (1000.0, [(0.30, 0.35), (0.36, 0.42)]),
        (10.0, [(0.70, 0.55), (0.78, 0.50)]),
    ):
        dabs = [(x * width, y * height) for x, y in points]
        editor.apply("Paint Stiffness", PaintStiffness(dabs, 110.0, factor))
    editor.handle_event(PointerEvent("move", editor.camera.to_screen((0.5 * width, 0.4 * height))))


@shot("field")
def field(window: Window) -> None:
    """The vector fields during a drag."""
    state, camera = window.state, window.state.editor.camera
    state.view.show_vector_fields = True
    pin = posed_elephant().state.pins[-1]
    x, y = camera.to_screen((pin.target[0], pin.target[1]))
    state.editor.handle_event(PointerEvent("press", (x, y)))
    for distance in (10.0, 40.0):
        state.editor.handle_event(PointerEvent("move", (x - distance, y)))


@shot("heat")
def heat(window: Window) -> None:
    """The distortion map with its color scale."""
    window.state.view.distortion_measure = "angle"
    window.state.view.show_pins = False


@shot("ghost")
def ghost(window: Window) -> None:
    """The rest pose behind the pose."""
    window.state.view.show_rest_pose = True


@shot("split")
def split(window: Window) -> None:
    """Two methods compared on the same pins."""
    window.state.view.is_split = True


@shot("export")
def export(window: Window) -> None:
    """The export dialog."""
    window.state.part(ExportPoseDialog).open(window.state)


def add_keyframes(window: Window) -> None:
    """Add three keyframes and poses of the elephant's trunk; show a time between the first two."""
    state, editor = window.state, window.state.editor
    state.timeline.is_shown, state.timeline.mode = True, "keyframes"
    window.frame()
    pin = posed_elephant().state.pins[-1]
    x, y = pin.target.tolist()
    rest = posed_elephant().drawing.mesh.vertices
    state.timeline.keyframe_playback.set_keyframe(0.0, rest)
    state.timeline.keyframe_playback.set_keyframe(0.8, posed_elephant().state.positions)
    gestures.move_pin(editor, pin.id, (x - 120.0, y + 260.0))
    assert editor.session is not None
    editor.session.settle()
    state.timeline.keyframe_playback.set_keyframe(1.6)
    for time, name in ((0.0, "Rest"), (0.8, "Trunk up"), (1.6, "Reach")):
        state.timeline.keyframe_playback.scrub(time)
        gestures.add_pose(editor, name)
    state.timeline.keyframe_playback.scrub(0.45)
    editor.select(())


@shot("keyframes")
def keyframes(window: Window) -> None:
    """Keyframes on the timeline, with onion skin."""
    add_keyframes(window)
    window.state.view.show_pins = False
    window.state.timeline.keyframe_playback.onion_skin.is_shown = True
    window.state.timeline.keyframe_playback.selected = frozenset({0.8})


@shot("speed")
def speed(window: Window) -> None:
    """The speed graph, with the handles of an easing that overshoots."""
    add_keyframes(window)
    playback = window.state.timeline.keyframe_playback
    playback.selected = frozenset({0.0})
    playback.set_easing("cubic-bezier(0.4, 0, 0.35, 1.25)")
    window.state.view.show_speed_graph = True
    for _ in range(200):  # until all speeds are known
        window.frame()


@shot("clips")
def clips(window: Window) -> None:
    """The dialog of clips."""
    window.state.part(ClipsDialog).open(window.state)


@shot("timeline")
def timeline(window: Window) -> None:
    """An opened recording at a time in its middle."""
    files.open_path(window.state, resource("assets", "recordings", "elephant.akaprec"))
    while window.state.is_busy:
        window.frame()
    window.state.timeline.session_playback.mark_range(1.5, 6.0)
    window.state.timeline.session_playback.scrub(4.0)
    window.state.notice = ""


@shot("animation")
def animation(window: Window) -> None:
    """The export dialog of the timeline."""
    add_keyframes(window)
    window.state.part(ExportAnimationDialog).open(window.state)


@shot("languages")
def languages(window: Window) -> None:
    """The preferences in Japanese; needs a font for it."""
    window.state.preferences.language = "ja"
    use_language("ja")
    theme.load_fonts(theme.system_fonts())
    PREFERENCES.run(window.state)


def take(window: Window, name: str, folder: Path) -> None:
    """Write one screenshot, starting from the posed elephant."""
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
        imgui.internal.close_popup_to_level(0, False)
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
    use_language("en")
    state = window.state = AppState(
        offscreen_renderer=window.state.offscreen_renderer,
        thumbnails=window.state.thumbnails,
        preferences=Preferences(),
    )
    state.editor.ui_scale = window.scale
    files.show_document(state, posed_elephant())
    state.editor.mark_saved(Path("elephant.akap"))
    window.frame()
    SHOTS[name](window)
    for _ in range(SETTLE_FRAMES):
        window.frame()
    screenshots: list[np.ndarray] = []
    window.after_draw.append(lambda: screenshots.append(window.screenshot()))
    window.frame()
    window.after_draw.clear()
    assert not state.error, state.error
    (rgb,), path = screenshots, folder / f"{name}.png"
    write_png(path, np.dstack([rgb, np.full(rgb.shape[:2], 255, np.uint8)]))
    print(path)


def main() -> None:
    """Make all screenshots, or those named on the command line."""
    parser = argparse.ArgumentParser(description="Makes the screenshots in README and docs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(SHOTS))
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--folder", type=Path, default=FOLDER)
    options = parser.parse_args()
    if unknown := set(options.names) - set(SHOTS):
        parser.error(f"expected names among {', '.join(SHOTS)}, got {', '.join(sorted(unknown))}")
    options.folder.mkdir(parents=True, exist_ok=True)
    size = round(DEFAULT_SIZE[0] * options.scale), round(DEFAULT_SIZE[1] * options.scale)
    with Window(null=True, scale=options.scale, size=size) as window:
        for name in options.names or SHOTS:
            take(window, name, options.folder)


if __name__ == "__main__":
    main()
