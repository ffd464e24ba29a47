"""Words on the canvas: the legend of the overlays in the lower left corner, and plates with a text."""

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui

from ...deform.methods import get_method
from ...editor.editor import Editor
from ...editor.session.session import Session
from ...render.overlays import Rgba
from ...words import number_text, tr
from ..theme import DARK, SECONDARY, TEXT, packed
from .vector_field_arrows import U_OPT_COLOR, U_SMOOTH_COLOR
from .view_options import DISTORTION_RANGES, DISTORTION_SCALES, Measure, ViewOptions

PLATE_OPACITY = 0.85  # of the dark plates under texts


def draw_legend(view: ViewOptions, editor: Editor, scale: float) -> None:
    """Draw the legend of the overlays that are on; a click on the distortion scale changes its range."""
    if editor.session is None or not (view.show_vector_fields or view.distortion_measure is not None):
        return
    left, _, _, bottom = editor.canvas
    imgui.set_next_window_pos(
        ImVec2(left + 12 * scale, bottom - 12 * scale), imgui.Cond_.always, ImVec2(0, 1)
    )
    imgui.set_next_window_bg_alpha(PLATE_OPACITY)
    flags = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.always_auto_resize
    flags |= imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
    flags |= imgui.WindowFlags_.no_focus_on_appearing
    if view.distortion_measure is None:
        flags |= imgui.WindowFlags_.no_inputs  # keys that go from panel to panel skip it, too
    if imgui.begin("##legend", None, flags)[0]:
        if view.show_vector_fields:
            _draw_vector_fields(editor.session, scale)
        if view.distortion_measure is not None:
            _draw_distortion_scale(view, view.distortion_measure, scale)
    imgui.end()


def _draw_vector_fields(session: Session, scale: float) -> None:
    """An arrow in the color of each field, and the field's name."""
    if not get_method(session.state.settings.method).deformer.has_vector_fields:
        imgui.text_colored(ImVec4(*SECONDARY), tr("This method has no vector field"))
        return
    for color, label in (
        (U_OPT_COLOR, tr("U_opt, the field followed")),
        (U_SMOOTH_COLOR, tr("U°, before the second solve")),
    ):
        corner, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
        start = ImVec2(corner.x, corner.y + height / 2)
        end = ImVec2(corner.x + 18 * scale, corner.y + height / 2)
        draw, barb = imgui.get_window_draw_list(), 4 * scale
        draw.add_line(start, end, packed(color), 2 * scale)
        draw.add_line(end, ImVec2(end.x - barb, end.y - barb), packed(color), 2 * scale)
        draw.add_line(end, ImVec2(end.x - barb, end.y + barb), packed(color), 2 * scale)
        imgui.dummy(ImVec2(22 * scale, height))
        imgui.same_line()
        imgui.text_colored(ImVec4(*TEXT), label)


def _draw_distortion_scale(view: ViewOptions, measure: Measure, scale: float) -> None:
    """The color scale with the ratios at its ends."""
    limit = DISTORTION_RANGES[view.distortion_range]
    title = (
        tr("Area, against the drawing at rest")
        if measure == "area"
        else tr("Stretch, longer by shorter axis")
    )
    imgui.text_colored(ImVec4(*SECONDARY), title)
    size, gap = ImVec2(230 * scale, 10 * scale), 3 * scale
    corner = imgui.get_cursor_screen_pos()
    size_with_labels = ImVec2(size.x, size.y + gap + imgui.get_text_line_height())
    if imgui.invisible_button("##range", size_with_labels, imgui.ButtonFlags_.enable_nav):
        view.use_next_distortion_range()
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        imgui.set_tooltip(tr("Click, or Shift+R, for another range"))
    draw, colors = imgui.get_window_draw_list(), DISTORTION_SCALES[measure]
    edges = np.linspace(corner.x, corner.x + size.x, len(colors) + 1).tolist()
    for low, high, color in zip(edges, edges[1:], colors.tolist(), strict=False):
        lower_right = ImVec2(high + 0.5, corner.y + size.y)
        draw.add_rect_filled(ImVec2(low, corner.y), lower_right, packed((*color, 1.0)))
    end = number_text(limit, "g")
    labels = (f"÷ {end}", tr("same"), f"× {end}") if measure == "area" else (tr("1 (none)"), "", end)
    for position, label in zip((0.0, 0.5, 1.0), labels, strict=True):
        x = corner.x + position * (size.x - imgui.calc_text_size(label).x)
        draw.add_text(ImVec2(x, corner.y + size.y + gap), packed(TEXT), label)


def draw_plate(draw: imgui.ImDrawList, corner: ImVec2, text: str, margin: ImVec2, color: Rgba = TEXT) -> None:
    """Draw a text on a dark plate, on which it is readable over any drawing.

    corner: upper left one of the text; margin: of the plate around it, points.
    """
    end, size = corner + margin, imgui.calc_text_size(text)
    high = ImVec2(end.x + size.x, end.y + size.y)
    rounding = 0.3 * imgui.get_font_size()
    draw.add_rect_filled(corner - margin, high, packed(DARK, PLATE_OPACITY), rounding)
    draw.add_text(corner, packed(color), text)
