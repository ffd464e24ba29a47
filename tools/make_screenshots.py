"""Makes the pictures in README and docs from the running program, so that they never go stale.

Run from the project's root, all pictures or those that are named:

    python tools/make_screenshots.py [NAME ...] [--scale 2] [--folder docs/images]

Needs no display: the window opens on GLFW's null platform. A new picture is one function with @shot here.
"""

from imgui_bundle import imgui  # isort: skip
import argparse
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from akap_editor.app.app_state import AppState, Palette
from akap_editor.app.dialogs.export_animation import ExportAnimationDialog
from akap_editor.app.preferences import Preferences
from akap_editor.app.window import SIZE, Window
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.events import KeyEvent, PinRequest, PointerEvent
from akap_editor.editor.session.edits import PaintStiffness
from akap_editor.editor.session.pin_edits import hold_angles
from akap_editor.editor.session.replay import replay
from akap_editor.editor.tools.keyboard_pointer import toggle_keyboard_pointer
from akap_editor.editor.tools.rotate import RING
from akap_editor.io.akap.recording import read_recording
from akap_editor.io.images import read_image, write_png
from akap_editor.resources import resource

FOLDER = Path("docs/images")
SETTLE = 12  # frames in which dialogs have their size and numbers their values
RECENT = ("dragon.akap", "walk cycle/goose 03.png", "sketches/robot.webp")

SHOTS: dict[str, Callable[[Window], None]] = {}


def shot(name: str) -> Callable[[Callable[[Window], None]], Callable[[Window], None]]:
    """Register what brings the window from the posed elephant to what NAME.png shows."""

    def register(prepare: Callable[[Window], None]) -> Callable[[Window], None]:
        SHOTS[name] = prepare
        return prepare

    return register


@cache
def posed_elephant() -> Document:
    """The elephant as the bundled recording leaves it."""
    recording = read_recording(resource("assets", "recordings", "elephant.akaprec"))
    image = read_image(resource("assets", "drawings", "elephant.png"))
    document = new_document(make_drawing(image, name="elephant"))
    *_, last = replay(recording, document.drawing)
    return document.with_state(last.state)


def rest(window: Window) -> None:
    """The elephant without pins instead."""
    window.state.show(new_document(posed_elephant().drawing))


@shot("editor")
def editor(window: Window) -> None:
    """The editor, and nothing else."""


@shot("mesh")
def mesh(window: Window) -> None:
    """The mesh over the drawing."""
    window.state.show_mesh = True


@shot("start")
def start(window: Window) -> None:
    """The start page, with recent files."""
    window.state.editor.close()
    home = Path("/home/ada/Pictures")
    for name in reversed(RECENT):
        window.state.preferences.opened(home / name)


@shot("first-steps")
def first_steps(window: Window) -> None:
    """What a newcomer sees."""
    rest(window)
    window.state.first_steps = True


@shot("palette")
def palette(window: Window) -> None:
    """The command palette while something is searched."""
    window.state.palette = Palette("sho")


@shot("keys")
def keys(window: Window) -> None:
    """The page of keys."""
    window.state.keys = True


@shot("pins")
def pins(window: Window) -> None:
    """Two pins selected, and the values of one of them."""
    state = window.state
    chosen = [pin.id for pin in posed_elephant().state.pins][-2:]
    state.editor.select(chosen)
    state.editor.request = PinRequest("values", chosen[-1])


@shot("crosshair")
def crosshair(window: Window) -> None:
    """The pointer that is moved by keys, where a pin may be added."""
    editor = window.state.editor
    width, height = posed_elephant().drawing.size
    editor.last_pointer = editor.camera.to_screen((0.42 * width, 0.5 * height))
    toggle_keyboard_pointer(editor)


@shot("ring")
def ring(window: Window) -> None:
    """The drawing while it is turned around a pin, and another pin that holds its angle."""
    editor = window.state.editor
    pins = [pin.id for pin in posed_elephant().state.pins]
    editor.edit("Hold angle", lambda session: hold_angles(session, pins[:1]))
    x, y = editor.pins_on_screen()[pins[-1]]
    way = [(RING * np.cos(turn), RING * np.sin(turn)) for turn in np.radians((0, 15, 30, 35))]
    at = [(x + window.scale * dx, y + window.scale * dy) for dx, dy in way]
    editor.handle_event(KeyEvent("alt"))
    editor.handle_event(PointerEvent("move", at[0]))
    editor.handle_event(PointerEvent("press", at[0], alt=True))
    for place in at[1:]:
        editor.handle_event(PointerEvent("move", place, alt=True))


@shot("brush")
def brush(window: Window) -> None:
    """The back and a tusk of the elephant made stiff, and the brush."""
    rest(window)
    editor = window.state.editor
    editor.chosen_tool = "brush"
    width, height = posed_elephant().drawing.size
    for factor, places in (
        (1000.0, [(0.30, 0.35), (0.36, 0.42)]),
        (10.0, [(0.70, 0.55), (0.78, 0.50)]),
    ):
        dabs = [(x * width, y * height) for x, y in places]
        editor.edit("Stiffen", lambda session, f=factor, d=dabs: session.apply(PaintStiffness(d, 110.0, f)))
    editor.handle_event(PointerEvent("move", editor.camera.to_screen((0.5 * width, 0.4 * height))))


@shot("field")
def field(window: Window) -> None:
    """The vector fields in the middle of a drag."""
    state, camera = window.state, window.state.editor.camera
    state.view.vectors = True
    pin = posed_elephant().state.pins[-1]
    x, y = camera.to_screen((pin.target[0], pin.target[1]))
    state.editor.handle_event(PointerEvent("press", (x, y)))
    for way in (10.0, 40.0):
        state.editor.handle_event(PointerEvent("move", (x - way, y)))


@shot("heat")
def heat(window: Window) -> None:
    """The map of distortion, with its scale."""
    window.state.view.heat = "angle"
    window.state.show_pins = False


@shot("ghost")
def ghost(window: Window) -> None:
    """The rest pose behind the pose."""
    window.state.view.ghost = True


@shot("split")
def split(window: Window) -> None:
    """Two methods side by side."""
    window.state.split = True


@shot("export")
def export(window: Window) -> None:
    """The export dialog."""
    window.state.ask_export()


def animated(window: Window) -> None:
    """Three keyframes of the elephant's trunk on the timeline, looked at between the first two."""
    state, editor = window.state, window.state.editor
    state.show_timeline, state.timeline = True, "keyframes"
    window.frame()
    pin = posed_elephant().state.pins[-1]
    x, y = pin.target.tolist()
    rest = posed_elephant().drawing.mesh.vertices
    state.keyframe_playback.put(0.0, rest)
    state.keyframe_playback.put(0.8, posed_elephant().state.positions)
    editor.place_pin(pin.id, (x - 120.0, y + 260.0))
    editor.session.settle()
    state.keyframe_playback.put(1.6)
    for time, name in ((0.0, "Rest"), (0.8, "Trunk up"), (1.6, "Reach")):
        state.keyframe_playback.scrub(time)
        editor.keep_pose(name)
    state.keyframe_playback.scrub(0.45)
    editor.select(())


@shot("keyframes")
def keyframes(window: Window) -> None:
    """Keyframes on the timeline, with onion skin."""
    animated(window)
    window.state.show_pins = False
    window.state.keyframe_playback.onion.shown = True
    window.state.keyframe_playback.chosen = frozenset({0.8})


@shot("timeline")
def timeline(window: Window) -> None:
    """A recording that was opened, looked at in its middle."""
    window.state.open_path(resource("assets", "recordings", "elephant.akaprec"))
    while window.state.waiting:
        window.frame()
    window.state.session_playback.cut_to(1.5, 6.0)
    window.state.session_playback.scrub(4.0)
    window.state.notice = ""


@shot("animation")
def animation(window: Window) -> None:
    """The dialog for exports of the timeline."""
    animated(window)
    window.state.dialog(ExportAnimationDialog).open(window.state)


def take(window: Window, name: str, folder: Path) -> None:
    """Write one picture, starting from the posed elephant."""
    if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
        imgui.internal.close_popup_to_level(0, False)
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)
    state = window.state = AppState(exporter=window.state.exporter, preferences=Preferences())
    state.editor.ui_scale = window.scale
    state.show(posed_elephant())
    state.editor.mark_saved(Path("elephant.akap"))
    window.frame()
    SHOTS[name](window)
    for _ in range(SETTLE):
        window.frame()
    shots: list[np.ndarray] = []
    window.after_draw.append(lambda: shots.append(window.screenshot()))
    window.frame()
    window.after_draw.clear()
    assert not state.error, state.error
    write_png(folder / f"{name}.png", np.dstack([shots[0], np.full(shots[0].shape[:2], 255, np.uint8)]))
    print(folder / f"{name}.png")


def main() -> None:
    """All pictures, or those that are named."""
    parser = argparse.ArgumentParser(description="Makes the pictures in README and docs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(SHOTS))
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--folder", type=Path, default=FOLDER)
    options = parser.parse_args()
    if unknown := set(options.names) - set(SHOTS):
        parser.error(f"expected names among {', '.join(SHOTS)}, got {', '.join(sorted(unknown))}")
    options.folder.mkdir(parents=True, exist_ok=True)
    size = round(SIZE[0] * options.scale), round(SIZE[1] * options.scale)
    with Window(null=True, scale=options.scale, size=size) as window:
        for name in options.names or SHOTS:
            take(window, name, options.folder)


if __name__ == "__main__":
    main()
