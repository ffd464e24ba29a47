"""Makes and measures the meshes of the command `mesh`."""

import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing, apply_mask, make_drawing
from ...errors import FileError, file_errors
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats
from ...io.atomic import noted_reads
from ...io.images import Picture, has_transparency, read_image, read_mask
from ...io.layers.open_layers import is_layered, left_out_notes, merging_notes, open_layers
from ...io.mesh_files.obj_off import write_obj
from ...io.outputs import refuse_source
from ...io.streams import named_path
from ...layers.composite import composite
from ...layers.layered_picture import LayeredPicture
from ...layers.merging import movable_layers
from ...meshing.faint import faint_share, fitting_threshold
from ...meshing.picture_mesh import mesh_picture
from ...meshing.quality import MeshQuality, mesh_quality, smallest_angles
from ..options import make_folder_of


@dataclass(frozen=True)
class MeshOptions:
    """The options of a mesh, see `Meshing`; threshold: None for one that suits the picture."""

    vertices: int
    expand: float
    threshold: float | None
    mesher: str


@dataclass(frozen=True)
class LayerRow:
    """The mesh of one layer; name: with its groups."""

    name: str
    quality: MeshQuality


@dataclass(frozen=True)
class MeshRow:
    """The mesh of one picture; see `MeshQuality` for its measures.

    faint: share of the visible pixels that the threshold cuts off, which ``covered`` does not count;
    specks: number of islands that are too small and left out; speck_share: their share of the visible area;
    cut_out: whether the picture has transparency; seconds: from the file to the mesh; mesh: the written file;
    notes: about what was left out; layers: of a picture in layers, the measures of each from back to front,
    where ``covered`` counts nothing as faint. Its own measures are those of all layers together.
    """

    picture: str
    parts: int
    holes: int
    specks: int
    speck_share: float
    vertices: int
    faces: int
    low_angle: float
    worst_angle: float
    covered: float
    faint: float
    outside: float
    cut_out: bool
    seconds: float
    mesh: str | None
    notes: tuple[str, ...] = ()
    layers: tuple[LayerRow, ...] = ()

    @property
    def record(self) -> dict[str, Any]:
        """The record for --json."""
        layers = [{"name": layer.name, **asdict(layer.quality)} for layer in self.layers]
        return {**asdict(self), "layers": layers}


def measure(
    picture: Path,
    output: Path | None,
    options: MeshOptions,
    mask: Path | None = None,
    overwrite: bool = False,
) -> MeshRow:
    """Make and measure the mesh of one picture; write it if ``output`` is given. Raises InputError."""
    if output is not None and output.suffix.lower() != ".obj":
        raise FileError("save", output, f"expected a name that ends in .obj, got {output.suffix or 'none'}")
    started = time.perf_counter()
    with noted_reads() as read:
        layered = open_layers(picture) if is_layered(picture) else None
        image = read_image(picture) if layered is None else None
        shown = read_mask(mask) if mask is not None else None
    if output is not None:
        refuse_source(output, read, overwrite)
    if layered is not None and len(movable_layers(layered)) > 1:
        return _measure_layers(picture, layered, shown, output, options, started)
    notes = () if layered is None else tuple(merging_notes(layered))
    if image is None:
        assert layered is not None
        image = composite(layered)
    return _measure_image(picture, image, shown, output, options, started, notes)


def _measure_image(
    picture: Path,
    image: Picture,
    shown: NDArray[np.uint8] | None,
    output: Path | None,
    options: MeshOptions,
    started: float,
    notes: tuple[str, ...],
) -> MeshRow:
    """`measure` of a flat picture, or of one whose layers are merged. Raises InputError."""
    with file_errors("mesh", picture):
        if shown is not None:
            image = apply_mask(image, shown)
        alpha = np.ascontiguousarray(image[..., 3])
        threshold = fitting_threshold(alpha) if options.threshold is None else options.threshold
        meshed = mesh_picture(alpha, options.vertices, options.expand, threshold, options.mesher)
    seconds = time.perf_counter() - started
    _write_mesh(output, meshed.mesh, (image.shape[1], image.shape[0]))
    quality = mesh_quality(meshed.mesh, alpha, threshold)
    faint = faint_share(alpha, meshed.mesh, threshold)
    visible = meshed.mesh.rest_areas.sum() * (1 - quality.outside) / quality.covered
    return MeshRow(
        picture=str(named_path(picture)),
        specks=meshed.specks,
        speck_share=meshed.speck_area / visible,
        cut_out=has_transparency(image),
        seconds=round(seconds, 4),
        mesh=None if output is None else str(output),
        notes=notes,
        faint=faint,
        **{**asdict(quality), "covered": quality.covered * (1 - faint)},
    )


def _measure_layers(
    picture: Path,
    layered: LayeredPicture,
    shown: NDArray[np.uint8] | None,
    output: Path | None,
    options: MeshOptions,
    started: float,
) -> MeshRow:
    """`measure` of a picture in layers, which are meshed as in the editor. Raises InputError."""
    with file_errors("mesh", picture):
        drawing = make_drawing(None, shown, layers=layered, **asdict(options))
        seconds = time.perf_counter() - started
        _write_mesh(output, drawing.mesh, drawing.size)
        rows, areas = _measured_layers(drawing)
    qualities = [row.quality for row in rows]
    common = areas * [1 - quality.outside for quality in qualities]
    angles = smallest_angles(drawing.mesh)
    return MeshRow(
        picture=str(named_path(picture)),
        parts=sum(quality.parts for quality in qualities),
        holes=sum(quality.holes for quality in qualities),
        specks=0,
        speck_share=0.0,
        vertices=len(drawing.mesh.vertices),
        faces=len(drawing.mesh.faces),
        low_angle=float(np.percentile(angles, 1)),
        worst_angle=float(angles.min()),
        covered=float(common.sum() / (common / [quality.covered for quality in qualities]).sum()),
        faint=0.0,
        outside=float(1 - common.sum() / areas.sum()),
        cut_out=True,
        seconds=round(seconds, 4),
        mesh=None if output is None else str(output),
        notes=tuple(left_out_notes(layered)),
        layers=tuple(rows),
    )


def _measured_layers(drawing: Drawing) -> tuple[list[LayerRow], Floats]:
    """The mesh of each layer from back to front, and the areas (l,) of these meshes, square pixels."""
    assert drawing.meshing is not None
    mesh, level = drawing.mesh, drawing.meshing.threshold
    rows, areas = [], []
    for number, layer in enumerate(drawing.layers):
        own, alpha = mesh.face_layers == number, np.pad(layer.artwork.picture[..., 3], 1)
        used = np.flatnonzero(mesh.layers == number)
        origin = np.subtract(layer.artwork.offset, 1)
        part = TriMesh(mesh.vertices[used] - origin, mesh.faces[own] - used[0])
        quality = mesh_quality(part, alpha, fitting_threshold(alpha, level))
        rows.append(LayerRow("/".join(layer.path), quality))
        areas.append(float(part.rest_areas.sum()))
    return rows, np.array(areas)


def _write_mesh(output: Path | None, mesh: TriMesh, size: tuple[int, int]) -> None:
    """Write a mesh if ``output`` is given; size: of the picture."""
    if output is not None:
        make_folder_of(output)
        write_obj(output, mesh, size)
