"""Shows two methods side by side: the left half of the canvas is edited, the right half follows."""

from imgui_bundle import ImVec2, imgui

from ...deform.methods import nearest_preset, presets
from ...editor.camera import Camera
from ...editor.editor import FRAME_BUDGET
from ...editor.events import ScrollEvent
from ...editor.session.session import Session
from ...geometry.distortion import Distortion
from ...words import number_text, tr
from .. import widgets
from ..app_state import AppState
from ..theme import SECONDARY, packed
from .legend import draw_plate
from .pin_markers import draw_pin

Rectangle = tuple[float, float, float, float]  # left, top, right, bottom in points of the window

# The right half is a window, so that clicks on it do not reach the drawing in the left half; it has no
# background, because the renderer draws the second pose under it.
_RIGHT_HALF_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_background
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_bring_to_front_on_focus
)


def halves(canvas: Rectangle) -> tuple[Rectangle, Rectangle]:
    """The left and the right half of the canvas, of the same size."""
    left, top, right, bottom = canvas
    middle = round((left + right) / 2)
    return (left, top, middle, bottom), (middle, top, right, bottom)


def right_half(left_half: Rectangle) -> Rectangle:
    """The half beside the one that is edited."""
    left, top, right, bottom = left_half
    return right, top, right + (right - left), bottom


def comparison_camera(camera: Camera, left_half: Rectangle) -> Camera:
    """The camera of the right half, which shows the same part of the plane as ``camera`` in the left half."""
    return camera.panned(left_half[2] - left_half[0], 0.0)


def draw(state: AppState, canvas: Rectangle, scale: float) -> Rectangle:
    """Step the second method and draw the texts of both halves; returns the part of the canvas to edit in."""
    session = state.editor.session
    if not state.view.is_split or session is None:
        state.comparison.close()
        return canvas
    left, right = halves(canvas)

    def follow() -> None:
        if state.comparison.follow(session, state.editor.worker, FRAME_BUDGET):
            state.wake()  # for the next step

    if not state.run_reporting_errors(follow):
        state.view.is_split = False
        return canvas
    settings = session.state.settings
    method = nearest_preset(settings.method, dict(settings.parameters))
    _draw_caption(left, tr(method.label), state.measure_distortion(), session, scale)
    _draw_right_half(state, right, scale)
    return left


def _draw_right_half(state: AppState, half: Rectangle, scale: float) -> None:
    """The choice of the second method, its numbers, and its pins."""
    comparison = state.comparison
    left, top, right, bottom = half
    imgui.set_next_window_pos(ImVec2(left, top))
    imgui.set_next_window_size(ImVec2(right - left, bottom - top))
    imgui.push_style_var(imgui.StyleVar_.window_padding, ImVec2(12 * scale, 10 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.begin("Comparison", None, _RIGHT_HALF_FLAGS)
    imgui.set_next_item_width(min(220 * scale, right - left - 24 * scale))
    specs = [preset.spec for preset in presets()]
    labels = [tr(preset.label) for preset in presets()]
    changed, index = widgets.combo("##beside", specs.index(comparison.spec), labels)
    if changed:
        comparison.spec = specs[index]
    wheel, pointer = imgui.get_io().mouse_wheel, imgui.get_mouse_pos()
    if imgui.is_window_hovered() and wheel:  # zooms both halves about the same place of the drawing
        state.editor.handle_event(ScrollEvent((pointer.x - (right - left), pointer.y), wheel))
    imgui.end()
    imgui.pop_style_var(2)
    background = imgui.get_background_draw_list()
    background.add_line(ImVec2(left, top), ImVec2(left, bottom), packed((1, 1, 1, 0.16)), scale)
    if comparison.session is not None:
        _draw_caption(half, "", comparison.measure(), comparison.session, scale)
        if state.view.show_pins:
            camera = comparison_camera(state.editor.camera, state.editor.canvas)
            _draw_pins(half, comparison.session, camera, scale)


def _draw_caption(
    half: Rectangle, method: str, distortion: Distortion | None, session: Session, scale: float
) -> None:
    """The name of the method at the top of a half, its numbers at the bottom."""
    background = imgui.get_background_draw_list()
    left, top, right, bottom = half
    margin = 12 * scale
    name = widgets.shortened(method, right - left - 2 * margin)
    plate_margin = ImVec2(6 * scale, 3 * scale)
    if name:
        draw_plate(background, ImVec2(left + margin, top + 14 * scale), name, plate_margin)
    if distortion is None:
        return
    first_line = [
        f"E_area {number_text(distortion.area, '.3f')}",
        f"E_angle {number_text(distortion.angle, '.3f')}",
    ]
    if distortion.flipped:
        first_line.append(tr("{count} flipped", count=distortion.flipped))
    second_line = [tr("Pin error {pixels:.2f} px", pixels=session.pin_error())]
    if session.last_step is not None:
        second_line.append(
            tr("{milliseconds:.1f} ms per step", milliseconds=1e3 * session.last_step.report.seconds)
        )
    width = right - left - 24 * scale
    numbers = "\n".join(_fit_into(width, line) for line in (first_line, second_line))
    height = imgui.calc_text_size(numbers).y
    corner = ImVec2(left + margin, bottom - height - margin)
    draw_plate(background, corner, numbers, plate_margin, SECONDARY)


def _fit_into(width: float, texts: list[str]) -> str:
    """The texts in one line, or one below the other if the line is wider than ``width``."""
    line = "   ".join(texts)
    return line if imgui.calc_text_size(line).x <= width else "\n".join(texts)


def _draw_pins(half: Rectangle, session: Session, camera: Camera, scale: float) -> None:
    background = imgui.get_background_draw_list()
    background.push_clip_rect(ImVec2(*half[:2]), ImVec2(*half[2:]))
    for x, y in session.pin_positions().tolist():
        draw_pin(background, camera.to_screen((x, y)), scale)
    background.pop_clip_rect()
