"""Two methods on the same pins at once: the left half of the canvas is edited, the right half follows."""

import moderngl
from imgui_bundle import ImVec2, imgui

from ...deform.methods import nearest_preset, presets
from ...editor.camera import Camera
from ...editor.editor import FRAME_BUDGET
from ...editor.events import ScrollEvent
from ...editor.session.session import Session
from ...geometry.distortion import Distortion
from ...render.renderer import Background, Renderer
from ..app_state import AppState
from ..theme import QUIET, TEXT, packed
from .pin_markers import draw_pin

Canvas = tuple[float, float, float, float]

_PANE = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_background
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_bring_to_front_on_focus
)


def halves(canvas: Canvas) -> tuple[Canvas, Canvas]:
    """The canvas (left, top, right, bottom) cut in two of one size."""
    left, top, right, bottom = canvas
    middle = round((left + right) / 2)
    return (left, top, middle, bottom), (middle, top, right, bottom)


def draw(state: AppState, canvas: Canvas, scale: float) -> Canvas:
    """Draw names and numbers and step the second method; what is left of the canvas for editing."""
    session = state.editor.session
    if not state.split or session is None:
        state.comparison.close()
        return canvas
    left, right = halves(canvas)

    def follow() -> None:
        if state.comparison.follow(session, state.editor.worker, FRAME_BUDGET):
            state.wake()

    if not state.run_reporting_errors(follow):
        state.split = False
        return canvas
    settings = session.state.settings
    name = nearest_preset(settings.method, dict(settings.parameters)).label
    _caption(left, name, state.measure(), session, scale)
    _pane(state, right, scale)
    return left


def _pane(state: AppState, pane: Canvas, scale: float) -> None:
    """The right half: a window without background, so that no click in it reaches the left half's drawing."""
    comparison = state.comparison
    imgui.set_next_window_pos(ImVec2(pane[0], pane[1]))
    imgui.set_next_window_size(ImVec2(pane[2] - pane[0], pane[3] - pane[1]))
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(12 * scale, 10 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.begin("Comparison", None, _PANE)
    imgui.set_next_item_width(min(220 * scale, pane[2] - pane[0] - 24 * scale))
    specs = [preset.spec for preset in presets()]
    labels = [preset.label for preset in presets()]
    changed, index = imgui.combo("##beside", specs.index(comparison.spec), labels, len(labels))
    if changed:
        comparison.spec = specs[index]
    wheel, at = imgui.get_io().mouse_wheel, imgui.get_mouse_pos()
    if imgui.is_window_hovered() and wheel:  # zooms both halves, as in the left one
        state.editor.handle_event(ScrollEvent((at.x - (pane[2] - pane[0]), at.y), wheel))
    imgui.end()
    imgui.pop_style_var(2)
    lines = imgui.get_background_draw_list()
    lines.add_line(ImVec2(pane[0], pane[1]), ImVec2(pane[0], pane[3]), packed((1, 1, 1, 0.16)), scale)
    if comparison.session is not None:
        _caption(pane, "", comparison.measure(), comparison.session, scale)
        if state.show_pins:
            _pins(pane, comparison.session, _camera(state.editor.camera, pane, state.editor.canvas), scale)


def _caption(pane: Canvas, name: str, found: Distortion | None, session: Session, scale: float) -> None:
    """A method's name at the top and its numbers at the bottom of a half."""
    lines = imgui.get_background_draw_list()
    left, top, right, bottom = pane
    lines.add_text(ImVec2(left + 12 * scale, top + 14 * scale), packed(TEXT), name)
    if found is None:
        return
    first = [f"E_area {found.area:.3f}", f"E_angle {found.angle:.3f}"]
    if found.flipped:
        first.append(f"{found.flipped} flipped")
    second = [f"Pins off {session.pin_error():.2f} px"]
    if session.last_step is not None:
        second.append(f"{1e3 * session.last_step.report.seconds:.1f} ms a step")
    room = right - left - 24 * scale
    numbers = "\n".join(_joined(facts, room) for facts in (first, second))
    height = imgui.calc_text_size(numbers).y
    lines.add_text(ImVec2(left + 12 * scale, bottom - height - 12 * scale), packed(QUIET), numbers)


def _joined(facts: list[str], room: float) -> str:
    """In one line, or where there is no room for it, each in its own."""
    line = "   ".join(facts)
    return line if imgui.calc_text_size(line).x <= room else "\n".join(facts)


def _pins(pane: Canvas, session: Session, camera: Camera, scale: float) -> None:
    lines = imgui.get_background_draw_list()
    lines.push_clip_rect(ImVec2(*pane[:2]), ImVec2(*pane[2:]))
    for x, y in session.pin_positions().tolist():
        draw_pin(lines, camera.to_screen((x, y)), scale)
    lines.pop_clip_rect()


def _camera(camera: Camera, pane: Canvas, edited: Canvas) -> Camera:
    """The camera of the right half, which shows the same part of the plane as the left."""
    return camera.panned(pane[0] - edited[0], 0.0)


def render(
    state: AppState,
    renderer: Renderer,
    target: moderngl.Framebuffer,
    pixels: tuple[int, int],
    window: tuple[int, int],
    background: Background,
) -> None:
    """Draw the second pose over the right half. pixels, window: sizes in framebuffer pixels and in points."""
    session = state.comparison.session
    if not state.split or session is None:
        return
    left, top, right, bottom = state.editor.canvas
    pane = right, top, right + (right - left), bottom
    density = pixels[0] / max(window[0], 1)
    x0, x1 = (round(density * x) for x in (pane[0], pane[2]))
    y0, y1 = (round(density * y) for y in (pane[1], pane[3]))
    renderer.show(session.drawing, session.state.positions, session.document.face_order)
    renderer.draw(
        target,
        pixels,
        _camera(state.editor.camera, pane, state.editor.canvas).view(*window),
        background=background,
        region=(x0, pixels[1] - y1, x1 - x0, y1 - y0),
    )
