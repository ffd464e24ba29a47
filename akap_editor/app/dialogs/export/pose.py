"""The dialog that exports the current pose for other programs."""

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, ImVec4, imgui

from ....display_text import display_name, file_stem
from ....editor.document.document import Document
from ....editor.framing import CROPS, MAX_SIZE, Color, crop_box, output_size
from ....errors import InputError
from ....io.export import EXPORT_FORMATS, ExportFormat, ExportOptions, export, format_of, replaced_companions
from ....io.outputs import is_source
from ....io.painter import Painter
from ....words import mark, number_text, tr
from ... import widgets
from ...app_state import AppState
from ...jobs.file_manager import folder_button
from ...theme import ACCENT
from ..file_dialog import FileDialog, FileRequest
from ..replace_files import ask_unless_new
from .fields import LABEL_WIDTH, background_field, format_list, number_field, preset_buttons

SCALES = (0.5, 1.0, 2.0, 4.0)
SMALLEST_SCALE, LARGEST_SCALE = 0.01, 100.0
_CROPS = {"none": mark("Frame and pose"), "frame": mark("Picture frame"), "pose": mark("Pose only")}
_ABOUT_CROPS = mark(
    "Frame and pose: nothing is cut off. Picture frame: the size of the picture, so that the export can "
    "replace it. Pose only: no empty space around the pose."
)
_WIDTH, _HEIGHT, _LIST_WIDTH = 580, 226, 208  # design points


@dataclass
class PoseExportOptions:
    """Choices of the dialog; see `ExportOptions`. is_opaque: whether ``background`` is used."""

    format: ExportFormat = EXPORT_FORMATS[0]
    scale: float = 1.0
    is_opaque: bool = False
    background: Color = (1.0, 1.0, 1.0)
    crop: str = CROPS[0]
    rest: bool = False
    textured: bool = False
    z_order: bool | None = None

    @property
    def export_options(self) -> ExportOptions:
        """The choices as `export` takes them."""
        background = self.background if self.is_opaque else None
        z_order = None if self.format.z_order is None else self.z_order
        return ExportOptions(self.scale, background, self.crop, self.rest, self.textured, z_order)

    def output_size(self, document: Document) -> tuple[int, int]:
        """Width and height in pixels of an exported picture. Raises InputError if it is too large."""
        pose = document.drawing.mesh.vertices if self.rest else document.state.positions
        return output_size(crop_box(document.drawing, pose, self.crop), self.scale)

    def file_name(self, document: Document) -> str:
        """The suggested file name; differs from the picture's, which may be in the same folder."""
        return f"{file_stem(document.drawing.name)}-{'rest' if self.rest else 'posed'}{self.format.suffix}"


class ExportPoseDialog:
    """Asks for a format and its options, then for a file. Keeps the options while it is closed."""

    def __init__(self) -> None:
        self.is_open = False
        self.options = PoseExportOptions()

    def open(self, state: AppState) -> None:
        """Show the dialog if a document is open."""
        self.is_open = state.document is not None

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        options, document = self.options, state.document
        if document is None:
            self.is_open = False
            return
        if not widgets.begin_dialog("Export"):
            return
        options.format = format_list(EXPORT_FORMATS, options.format, _LIST_WIDTH * scale, _HEIGHT * scale)
        imgui.same_line(0, 18 * scale)
        size = ImVec2((_WIDTH - _LIST_WIDTH - 18) * scale, _HEIGHT * scale)
        imgui.begin_child("##options", size, widgets.NAV_FLATTENED)
        problem = _draw_options(options, document, scale)
        imgui.end_child()
        imgui.spacing()
        imgui.begin_disabled(bool(problem))
        accepted = widgets.button(tr("Export..."), primary=True)
        imgui.end_disabled()
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._close()
        elif accepted or (widgets.confirm_pressed() and not problem and not imgui.get_io().want_text_input):
            self._close()
            request_file(state, options)
        imgui.end_popup()

    def _close(self) -> None:
        self.is_open = False
        widgets.close_popup()


def request_file(state: AppState, options: PoseExportOptions) -> None:
    """Ask for the file to write, then write it."""
    if state.document is not None:
        suffixes, name = (options.format.suffix,), options.file_name(state.document)
        use = partial(export_pose, state, replace(options))
        state.part(FileDialog).ask(
            FileRequest(tr("Export to"), suffixes, state.folder, use, name, saving=True)
        )


def export_pose(state: AppState, options: PoseExportOptions, path: Path) -> None:
    """Write the current pose in the background; the file name's ending decides on the format.

    Ask before files are replaced that the user did not name, or that the drawing was opened from.
    """
    if state.document is None:
        return
    rename, write = partial(request_file, state, options), partial(_begin_export, state, options, path)
    source = path if is_source(path, state.document.sources) else None
    ask_unless_new(state, replaced_companions(path), write, rename, source)


def _begin_export(state: AppState, options: PoseExportOptions, path: Path) -> None:
    document, options = state.document, replace(options)
    if document is None:
        return

    def work(painter: Painter) -> str:
        *companions, _ = export(document, path, options.export_options, painter, overwrite=True)
        said = tr("Exported {files}", files=", ".join(map(display_name, [path, *companions])))
        if format_of(path).uses_framing:
            width, height = options.output_size(document)
            said = tr("{exported}, {width} × {height} pixels", exported=said, width=width, height=height)
        state.notice_button = folder_button(said, path)
        return said

    state.notice = tr("Exporting {file} ...", file=display_name(path))
    state.pose_exports.begin(work)


def _draw_options(options: PoseExportOptions, document: Document, scale: float) -> str:
    """Draw the right half; return what prevents this export, or ""."""
    below = imgui.get_cursor_pos_y() + 3 * imgui.get_text_line_height()
    widgets.secondary_text(tr(options.format.about))
    imgui.set_cursor_pos_y(below)  # the same for all formats, so that nothing jumps
    draw_format_options = _draw_framing if options.format.uses_framing else _draw_mesh_size
    problem = draw_format_options(options, document, scale)
    widgets.switch_label(tr("Pose"), LABEL_WIDTH * scale)
    tooltip = tr("Export the rest pose instead of the current pose.")
    _, options.rest = widgets.switch(tr("Rest pose"), options.rest, tooltip)
    if options.format.z_order is not None:
        imgui.same_line(0, 16 * scale)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
        tooltip = tr(
            "Lay what is in front nearer to the viewer in z, for ray tracers and depth-tested viewers."
        )
        value = options.format.z_order if options.z_order is None else options.z_order
        changed, value = widgets.switch(tr("Depth in z"), value, tooltip)
        options.z_order = value if changed else options.z_order
    if options.format.can_be_textured:
        imgui.same_line(0, 16 * scale)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
        tooltip = tr("A picture of each part, from back to front. Off: the outline alone.")
        _, options.textured = widgets.switch(tr("Texture"), options.textured, tooltip)
    return problem


def _draw_framing(options: PoseExportOptions, document: Document, scale: float) -> str:
    """Draw scale, crop and background of a picture; return what prevents this export, or ""."""
    limits, speed = (100 * SMALLEST_SCALE, 100 * LARGEST_SCALE), max(0.5, options.scale)
    options.scale = number_field(tr("Scale"), 100 * options.scale, limits, "%.4g %%", speed, 86, scale) / 100
    preset = preset_buttons([f"{number_text(each, 'g')}×" for each in SCALES], scale)
    if preset is not None:
        options.scale = SCALES[preset]
    problem = _draw_picture_size(options, document, scale)
    widgets.label(tr("Crop"), LABEL_WIDTH * scale)
    imgui.set_next_item_width(widgets.FULL)
    names = list(_CROPS)
    _, crop = widgets.combo("##crop", names.index(options.crop), [tr(label) for label in _CROPS.values()])
    options.crop = names[crop]
    widgets.show_tooltip(tr(_ABOUT_CROPS))
    options.is_opaque, options.background = background_field(
        options.is_opaque, options.background, False, tr("Off: the background is transparent."), scale
    )
    return problem


def _draw_picture_size(options: PoseExportOptions, document: Document, scale: float) -> str:
    """Draw the size of the picture; return what prevents this export, or ""."""
    widgets.label(tr("Size"), LABEL_WIDTH * scale)
    try:
        width, height = options.output_size(document)
    except InputError:
        problem = tr("More than {pixels} px per side", pixels=MAX_SIZE)
        imgui.text_colored(ImVec4(*ACCENT), problem)
        return problem
    imgui.text(tr("{width} × {height} px", width=width, height=height))
    return ""


def _draw_mesh_size(_: PoseExportOptions, document: Document, scale: float) -> str:
    """Draw the size of the mesh and its texture; return "", as nothing prevents this export."""
    mesh, size = document.drawing.mesh, document.drawing.size
    for label, value in (
        (
            tr("Mesh"),
            tr("{vertices:,} vertices, {faces:,} faces", vertices=len(mesh.vertices), faces=len(mesh.faces)),
        ),
        (tr("Texture"), tr("{width} × {height} px", width=size[0], height=size[1])),
    ):
        widgets.label(label, LABEL_WIDTH * scale)
        imgui.text(value)
    return ""
