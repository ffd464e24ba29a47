"""Drawings for other programs: pictures, outlines, meshes. docs/exporting.md says what each file holds."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

from ...editor.document.document import Document
from ...editor.document.drawing import Drawing
from ...editor.document.framing import Box, Color, crop_box
from ...errors import InputError
from ...geometry.validation import Floats, Ints
from ..atomic import write_atomic
from ..images import Picture, encode_png, join_with_or
from .gltf import encode_glb
from .mesh_json import encode_json
from .obj import encode_obj
from .spine import encode_spine
from .svg import encode_svg

Files = dict[str, bytes]


class Painter(Protocol):
    """Draws poses; `render.offscreen.OffscreenRenderer` is one."""

    def render(
        self,
        drawing: Drawing,
        positions: Floats,
        box: Box,
        scale: float,
        background: Color | None,
        order: Ints | None,
    ) -> Picture:
        """The drawing in a pose as (h, w, 4) uint8, straight alpha, its faces drawn in ``order``."""


@dataclass(frozen=True)
class ExportOptions:
    """scale: pixels per pixel of the picture; background: (r, g, b) from 0 to 1, or None for transparent;
    crop: see `crop_box`; rest: the rest pose in place of the current one.
    """

    scale: float = 1.0
    background: Color | None = None
    crop: str = "none"
    rest: bool = False


@dataclass(frozen=True)
class Format:
    """One kind of file.

    label, suffix: what it is called and how its names end; about: a sentence for people; framed: whether
    scale, background and crop matter; encode: the bytes of each file, by name, the one asked for last.
    """

    label: str
    suffix: str
    about: str
    framed: bool
    encode: Callable[[Document, str, ExportOptions, Painter | None], Files] = field(repr=False)


def _encode_png(document: Document, stem: str, options: ExportOptions, painter: Painter | None) -> Files:
    if painter is None:
        raise InputError("expected a painter for a picture, e.g. an OffscreenRenderer, got None")
    drawing, pose = document.drawing, document.state.positions
    box = crop_box(drawing, pose, options.crop)
    picture = painter.render(drawing, pose, box, options.scale, options.background, document.face_order)
    return {f"{stem}.png": encode_png(picture)}


def _encode_svg(document: Document, stem: str, options: ExportOptions, _: Painter | None) -> Files:
    box = crop_box(document.drawing, document.state.positions, options.crop)
    text = encode_svg(document.drawing, document.state.positions, box, options.scale, options.background)
    return {f"{stem}.svg": text.encode()}


def _in_order(document: Document) -> Drawing:
    """The drawing with its faces from the hindmost to the foremost."""
    drawing, order = document.drawing, document.face_order
    if order is None:
        return drawing
    return replace(drawing, mesh=replace(drawing.mesh, faces=drawing.mesh.faces[order]))


FORMATS = (
    Format("PNG picture", ".png", "The pose as a picture with transparency.", True, _encode_png),
    Format(
        "SVG outline", ".svg", "The outline of the pose as paths, for cutting and tracing.", True, _encode_svg
    ),
    Format(
        "glTF binary",
        ".glb",
        "Mesh and texture in one file, with the pose as a morph target, for Blender and game engines.",
        False,
        lambda document, stem, *_: {f"{stem}.glb": encode_glb(_in_order(document), document.state.positions)},
    ),
    Format(
        "Wavefront OBJ",
        ".obj",
        "The posed mesh with its material and texture, as three files, for almost any 3D program.",
        False,
        lambda document, stem, *_: encode_obj(_in_order(document), document.state.positions, stem),
    ),
    Format(
        "Spine skeleton",
        ".spine.json",
        "Mesh attachments with the pose as a deform key, and their texture, for Spine and its runtimes.",
        False,
        lambda document, stem, *_: encode_spine(_in_order(document), document.state.positions, stem),
    ),
    Format(
        "Mesh and pins",
        ".json",
        "All numbers as documented JSON, for programs of one's own.",
        False,
        lambda document, stem, *_: {f"{stem}.json": encode_json(document)},
    ),
)


def format_of(path: str | Path) -> Format:
    """The format that a file's name asks for. Raises InputError."""
    name = Path(path).name.lower()
    for each in FORMATS:  # .spine.json comes before .json
        if name.endswith(each.suffix):
            return each
    came = Path(path).suffix or "none"
    raise InputError(
        f"{path}: expected a name that ends in {join_with_or([f.suffix for f in FORMATS])}, got {came}"
    )


def export(
    document: Document,
    path: str | Path,
    options: ExportOptions | None = None,
    painter: Painter | None = None,
) -> list[Path]:
    """Write a drawing for other programs; the files written, the one named last.

    The name decides on the format. Files beside it, such as textures, are named after it. painter: draws
    pictures, needed for .png only. Raises InputError for an unknown name or what cannot be exported or
    written; each file is written whole or not at all.
    """
    options = options or ExportOptions()
    path = Path(path)
    chosen = format_of(path)
    if options.rest:
        state = replace(document.state, positions=document.drawing.mesh.vertices)
        document = document.with_state(state)
    try:
        files = chosen.encode(document, path.name[: -len(chosen.suffix)], options, painter)
    except InputError as error:
        raise InputError(f"cannot write {path}: {error}") from error
    written = [path.with_name(name) for name in files]
    written[-1] = path  # as it was spelled, e.g. in capitals
    for target, data in zip(written, files.values(), strict=True):
        write_atomic(target, data)
    return written
