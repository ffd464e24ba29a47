"""The dialog for exports: format on the left, what can be chosen about it on the right."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, ImVec4, imgui

from ...editor.document.document import Document
from ...errors import InputError
from ...io.export import FORMATS, Painter, export, format_of
from .. import widgets
from ..app_state import AppState
from ..theme import ACCENT, QUIET
from .exporting import LARGEST, SCALES, SMALLEST, PoseExportOptions
from .file_dialog import FileRequest

_CROPS = {"none": "Frame and pose", "frame": "Picture's frame", "pose": "Pose alone"}
_ABOUT_CROPS = (
    "Frame and pose: nothing is cut off. Picture's frame: as large as the picture was, so that it can take "
    "its place. Pose alone: no empty space around."
)
_WIDTH, _HEIGHT, _LEFT, _LABEL = 580, 226, 208, 104  # points of the design


def draw(state: AppState, scale: float) -> None:
    """One frame of the dialog."""
    choice, document = state.export, state.document
    if document is None:
        choice.shown = False
        return
    if not widgets.begin_dialog("Export"):
        return
    imgui.begin_child(
        "##formats", ImVec2(_LEFT * scale, _HEIGHT * scale), imgui.ChildFlags_.borders | widgets.WALKED
    )
    _formats(choice)
    imgui.end_child()
    imgui.same_line(0, 18 * scale)
    imgui.begin_child("##options", ImVec2((_WIDTH - _LEFT - 18) * scale, _HEIGHT * scale), widgets.WALKED)
    problem = _options(choice, document, scale)
    imgui.end_child()
    imgui.spacing()
    imgui.begin_disabled(bool(problem))
    accepted = widgets.button("Export...", primary=True)
    imgui.end_disabled()
    imgui.same_line()
    if widgets.button("Cancel") or widgets.escape():
        _close(choice)
    elif accepted or (widgets.enter() and not problem and not imgui.get_io().want_text_input):
        _close(choice)
        ask_file(state)
    imgui.end_popup()


def ask_file(state: AppState) -> None:
    """Ask where what was chosen goes."""
    if state.document is not None:
        suffixes, name = (state.export.format.suffix,), state.export.file_name(state.document)
        use = partial(write, state)
        state.request = FileRequest("Export to", suffixes, state.folder, use, name, saving=True)


def write(state: AppState, path: Path) -> None:
    """Write what was chosen, of the pose as it is now; one may go on meanwhile."""
    document, choice = state.document, replace(state.export)
    assert document is not None

    def work(painter: Painter) -> str:
        *companions, _ = export(document, path, choice.options, painter)
        said = f"Exported {', '.join([path.name, *(each.name for each in companions)])}"
        if format_of(path).framed:
            width, height = choice.size(document)
            said += f", {width} × {height} pixels"
        return said

    state.notice = f"Exporting {path.name} ..."
    state.writer.begin(work)


def _close(choice: PoseExportOptions) -> None:
    imgui.close_current_popup()
    choice.shown = False


def _formats(choice: PoseExportOptions) -> None:
    flags = imgui.SelectableFlags_.no_auto_close_popups
    for each in FORMATS:
        right = imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x
        if imgui.selectable(each.label, each is choice.format, flags)[0]:
            choice.format = each
        imgui.same_line(right - imgui.calc_text_size(each.suffix).x)
        imgui.text_colored(ImVec4(*QUIET), each.suffix)


def _options(choice: PoseExportOptions, document: Document, scale: float) -> str:
    """The right half; what stands in the way of this export, if anything does."""
    below = imgui.get_cursor_pos_y() + 3 * imgui.get_text_line_height()
    widgets.quiet(choice.format.about)
    imgui.set_cursor_pos_y(below)  # so that nothing jumps when another format is chosen
    problem = _framing(choice, document, scale) if choice.format.framed else _numbers(document, scale)
    widgets.switch_label("Pose", _LABEL * scale)
    _, choice.rest = widgets.switch("At rest", choice.rest, "The drawing as it was before it was bent.")
    return problem


def _framing(choice: PoseExportOptions, document: Document, scale: float) -> str:
    widgets.label("Scale", _LABEL * scale)
    imgui.set_next_item_width(86 * scale)
    speed, low, high = max(0.5, choice.scale), 100 * SMALLEST, 100 * LARGEST
    clamp = imgui.SliderFlags_.always_clamp
    _, percent = imgui.drag_float("##scale", 100 * choice.scale, speed, low, high, "%.4g %%", clamp)
    choice.scale = percent / 100
    widgets.explain("Drag, or double-click to type.")
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(7 * scale, imgui.get_style().frame_padding.y))
    for preset in SCALES:
        imgui.same_line(0, 5 * scale)
        if imgui.button(f"{preset:g}×"):
            choice.scale = preset
    imgui.pop_style_var()
    problem = _size(choice, document, scale)
    widgets.label("Shows", _LABEL * scale)
    imgui.set_next_item_width(widgets.FULL)
    opened = imgui.begin_combo("##crop", _CROPS[choice.crop])
    widgets.explain(_ABOUT_CROPS)
    if opened:
        for name, label in _CROPS.items():
            if imgui.selectable(label, name == choice.crop)[0]:
                choice.crop = name
        imgui.end_combo()
    widgets.switch_label("Background", _LABEL * scale)
    _, choice.opaque = widgets.switch("Color", choice.opaque, "Without it, the background is transparent.")
    if choice.opaque:
        imgui.same_line(0, 10 * scale)
        choice.background = widgets.color("##background", choice.background)
    return problem


def _size(choice: PoseExportOptions, document: Document, scale: float) -> str:
    widgets.label("Size", _LABEL * scale)
    try:
        width, height = choice.size(document)
    except InputError:
        problem = "more than 8192 px a side"
        imgui.text_colored(ImVec4(*ACCENT), problem)
        return problem
    imgui.text(f"{width} × {height} px")
    return ""


def _numbers(document: Document, scale: float) -> str:
    mesh = document.drawing.mesh
    for label, value in (
        ("Mesh", f"{len(mesh.vertices):,} vertices, {len(mesh.faces):,} faces"),
        ("Texture", f"{document.drawing.size[0]} × {document.drawing.size[1]} px"),
    ):
        widgets.label(label, _LABEL * scale)
        imgui.text(value)
    return ""
