"""The table of formats for other programs, and the export of a document by it."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...editor.document.document import Document
from ...editor.framing import Color, crop_box
from ...errors import FileError, InputError, file_errors, join_with_or
from ...geometry.validation import as_instance
from ...overlap.overlaps import NO_CROSSINGS
from ...words import mark, tr
from ..atomic import as_path, write_atomic
from ..images import encode_png
from ..outputs import existing, refuse_replacing, refuse_source
from ..painter import Painter
from .baked_animation import bake_animation
from .gltf import encode_glb
from .mesh_json import encode_json
from .obj import companion_names, encode_obj
from .spine import atlas_name, encode_spine
from .svg import encode_svg, encode_textured_svg
from .texture import texture_name

Files = dict[str, bytes]  # contents by file name


@dataclass(frozen=True)
class ExportOptions:
    """Options of an export.

    scale: pixels per pixel of the drawing; background: None for transparent; crop: see `crop_box`; rest:
    export the rest pose instead of the current pose; textured: draw an SVG with its texture instead of the
    outline alone; z_order: lay what is in front nearer to the viewer in z, None for the format's default.
    """

    scale: float = 1.0
    background: Color | None = None
    crop: str = "none"
    rest: bool = False
    textured: bool = False
    z_order: bool | None = None


@dataclass(frozen=True)
class ExportFormat:
    """A row of the table of formats.

    label: name on the screen; suffix: ending of file names; about: description for the user; uses_framing:
    whether scale, background and crop matter; encode: returns the contents of all files by name, the named
    file last; companions: names of the other files for a stem; can_be_textured: see `ExportOptions`; z_order:
    whether it has z by the order of drawing by default, None if never.
    """

    label: str
    suffix: str
    about: str
    uses_framing: bool
    encode: Callable[[Document, str, ExportOptions, Painter | None], Files] = field(repr=False)
    companions: Callable[[str], list[str]] = field(default=lambda _: [], repr=False)
    can_be_textured: bool = False
    z_order: bool | None = None


def _require_painter(painter: Painter | None) -> Painter:
    if painter is None:
        raise InputError(tr("expected a painter for a picture, e.g. an OffscreenRenderer, got None"))
    return painter


def _encode_png(document: Document, stem: str, options: ExportOptions, painter: Painter | None) -> Files:
    drawing, pose = document.drawing, document.state.positions
    box = crop_box(drawing, pose, options.crop)
    picture = _require_painter(painter).render(
        drawing, pose, box, options.scale, options.background, document.draw_order
    )
    return {f"{stem}.png": encode_png(picture)}


def _encode_svg(document: Document, stem: str, options: ExportOptions, painter: Painter | None) -> Files:
    drawing, pose = document.drawing, document.state.positions
    framing = crop_box(drawing, pose, options.crop), options.scale, options.background
    if options.textured:
        text = encode_textured_svg(drawing, pose, *framing, _require_painter(painter), document.draw_order)
    else:
        text = encode_svg(drawing, pose, *framing)
    return {f"{stem}.svg": text.encode()}


def _encode_spine(document: Document, stem: str, _: ExportOptions, __: Painter | None) -> Files:
    drawing, pose = document.drawing, document.state.positions
    return encode_spine(drawing, pose, stem, document.draw_order, bake_animation(document))


def _encode_glb(document: Document, stem: str, options: ExportOptions, _: Painter | None) -> Files:
    drawing, pose = document.drawing, document.state.positions
    baked = bake_animation(document)
    return {f"{stem}.glb": encode_glb(drawing, pose, document.draw_order, baked, options.z_order is True)}


def _encode_obj(document: Document, stem: str, options: ExportOptions, _: Painter | None) -> Files:
    drawing, pose = document.drawing, document.state.positions
    return encode_obj(drawing, pose, stem, document.draw_order, options.z_order is not False)


EXPORT_FORMATS = (
    ExportFormat(
        mark("PNG picture"), ".png", mark("The pose as a picture with transparency."), True, _encode_png
    ),
    ExportFormat(
        "SVG",
        ".svg",
        mark("The outline of the pose as paths, for cutting and tracing, or a picture of each part."),
        True,
        _encode_svg,
        can_be_textured=True,
    ),
    ExportFormat(
        mark("glTF binary"),
        ".glb",
        mark(
            "Mesh and texture in one file, pose and keyframes as morph targets, for Blender and game engines."
        ),
        False,
        _encode_glb,
        z_order=False,
    ),
    ExportFormat(
        "Wavefront OBJ",
        ".obj",
        mark("The posed mesh with its material and texture, as three files, for almost any 3D program."),
        False,
        _encode_obj,
        companion_names,
        z_order=True,
    ),
    ExportFormat(
        mark("Spine skeleton"),
        ".spine.json",
        mark(
            "Mesh attachments, pose and keyframes as deform keys, and an atlas, for Spine and its runtimes."
        ),
        False,
        _encode_spine,
        lambda stem: [texture_name(stem), atlas_name(stem)],
    ),
    ExportFormat(
        mark("Mesh and pins"),
        ".json",
        mark("All numbers as documented JSON, for your own programs."),
        False,
        lambda document, stem, *_: {f"{stem}.json": encode_json(document)},
    ),
)


def format_of(path: str | Path) -> ExportFormat:
    """The format for a file name's ending. Raises InputError if there is none."""
    name = Path(path).name.lower()
    for each in EXPORT_FORMATS:  # .spine.json comes before .json
        if name.endswith(each.suffix):
            return each
    endings = join_with_or([each.suffix for each in EXPORT_FORMATS])
    came = Path(path).suffix or "none"
    raise FileError(
        "export", path, tr("expected a name that ends in {endings}, got {came}", endings=endings, came=came)
    )


def export(
    document: Document,
    path: str | Path,
    options: ExportOptions | None = None,
    painter: Painter | None = None,
    overwrite: bool = False,
) -> list[Path]:
    """Export a drawing; return the written files, with ``path`` last.

    The ending of ``path`` decides on the format. Additional files, e.g. textures, are named after it. Each
    file is written whole or not at all, and replaces an older one at ``path``. painter: draws pictures,
    needed for .png only; overwrite: replace also the files that the drawing was read from, and additional
    files that exist with another content. Raises InputError for an unknown ending, or if the drawing cannot
    be exported or written.
    """
    as_instance(document, "document", Document)
    options = ExportOptions() if options is None else as_instance(options, "options", ExportOptions)
    path = as_path(path)
    chosen = format_of(path)
    refuse_source(path, (document.path, *document.sources), overwrite)
    if options.rest:
        state = replace(document.state, positions=document.drawing.mesh.vertices, crossings=NO_CROSSINGS)
        document = document.with_state(state)
    with file_errors("export", path):
        files = chosen.encode(document, path.name[: -len(chosen.suffix)], options, painter)
    written = [path.with_name(name) for name in files]
    written[-1] = path  # as spelled by the caller, e.g. in capitals
    contents = dict(zip(written, files.values(), strict=True))
    refuse_replacing(path, (each for each in written[:-1] if not _holds(each, contents[each])), overwrite)
    for target, data in contents.items():
        write_atomic(target, data)
    return written


def replaced_companions(path: Path) -> list[Path]:
    """The files that exist and that an export to ``path`` replaces besides it. Raises InputError."""
    chosen = format_of(path)
    return existing(path.with_name(name) for name in chosen.companions(path.name[: -len(chosen.suffix)]))


def _holds(path: Path, data: bytes) -> bool:
    """Whether a file exists and holds these bytes."""
    try:
        return path.stat().st_size == len(data) and path.read_bytes() == data
    except OSError:
        return False
