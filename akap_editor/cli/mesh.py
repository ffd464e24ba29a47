"""Makes meshes of pictures and reports their quality."""

import json
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np
from numpy.typing import NDArray

from ..display_text import display_text
from ..errors import FileError, InputError, file_errors
from ..geometry.validation import as_number
from ..io.atomic import noted_reads
from ..io.outputs import refuse_replacing, refuse_source
from ..io.streams import named_path, written_path
from ..meshing.meshers import check_mesher
from .options import (
    FILE,
    INPUT,
    MESH_MARGIN,
    MESH_VERTICES,
    check_threshold,
    make_folder_of,
    mesher_option,
    overwrite_option,
    refuse_stream_of_several,
    say,
    threshold_option,
)

if TYPE_CHECKING:
    from ..layers.layered_picture import LayeredPicture

MAX_EXPANSION = 1000.0  # pixels


@dataclass(frozen=True)
class MeshOptions:
    """The options of a mesh, see `Meshing`; threshold: None for one that suits the picture."""

    vertices: int
    expand: float
    threshold: float | None
    mesher: str


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
    layers: tuple["LayerRow", ...] = ()


@dataclass(frozen=True)
class LayerRow:
    """The mesh of one layer; name: with its groups, see `MeshQuality` for the measures."""

    name: str
    parts: int
    holes: int
    vertices: int
    faces: int
    low_angle: float
    worst_angle: float
    covered: float
    outside: float


@click.command(epilog="Example: akap-editor mesh drawings/*.png -o meshes --vertices 3000")
@click.argument("pictures", type=INPUT, nargs=-1, required=True, metavar="PICTURE...")
@click.option(
    "-o",
    "--output",
    type=FILE,
    help="OBJ file to write, or to replace; for several pictures, a folder; - for stdout.",
)
@click.option("--vertices", default=MESH_VERTICES, show_default=True, help="Number of vertices.")
@click.option(
    "--expand",
    default=MESH_MARGIN,
    show_default=True,
    metavar="PX",
    help="Margin in pixels by which the outline moves outwards.",
)
@threshold_option
@click.option("--mask", type=FILE, help="Picture that is bright, or opaque, where PICTURE is to be visible.")
@mesher_option
@overwrite_option
@click.option(
    "--json", "as_json", is_flag=True, help="Print the measures as JSON, a list with one object per picture."
)
def mesh(
    pictures: tuple[Path, ...],
    output: Path | None,
    vertices: int,
    expand: float,
    threshold: float | None,
    mask: Path | None,
    mesher: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Make a mesh of each PICTURE, or of all pictures in a folder, and report its quality.

    Of several pictures, those that fail are reported and skipped; the exit code is then 1.
    """
    from ..meshing.mesher_process import MESHER_PROCESS
    from ..meshing.triangulate import MAX_VERTICES, MIN_VERTICES

    as_number(vertices, "--vertices", MIN_VERTICES, MAX_VERTICES)
    as_number(expand, "--expand", 0, MAX_EXPANSION)
    options = MeshOptions(vertices, expand, check_threshold(threshold), check_mesher(mesher))
    if len(pictures) == 1 and not pictures[0].is_dir():
        MESHER_PROCESS.start()
        with written_path(output or Path(), ".obj") as path:
            row = measure(pictures[0], path if output else None, options, mask, overwrite)
        row = replace(row, mesh=None if row.mesh is None else str(output))
        say(json.dumps([asdict(row)], indent=2) if as_json else _describe(row), output)
        return
    refuse_stream_of_several(pictures, output or Path())
    if mask is not None:
        raise InputError("--mask: expected one picture, got several")
    paths = _expand_folders(pictures)
    outputs = _outputs(paths, output)
    if output is not None:
        refuse_replacing(output, filter(None, outputs), overwrite)
    rows, errors = _measure_all(paths, outputs, options)
    if as_json:
        click.echo(json.dumps([asdict(row) for row in rows] + errors, indent=2))
    else:
        click.echo("\n".join(_table(rows, len(errors))))
    for error in errors:
        click.echo(f"akap-editor: {error['error']}", err=True)
    if errors:
        raise SystemExit(1)


def measure(
    picture: Path,
    output: Path | None,
    options: MeshOptions,
    mask: Path | None = None,
    overwrite: bool = False,
) -> MeshRow:
    """Make and measure the mesh of one picture; write it if ``output`` is given. Raises InputError."""
    from ..editor.document.drawing import apply_mask
    from ..io.images import has_transparency, read_image, read_mask
    from ..io.layers.open_layers import is_layered, merging_notes, open_layers
    from ..io.mesh_files.obj_off import write_obj
    from ..layers.composite import composite
    from ..layers.merging import movable_layers
    from ..meshing.faint import faint_share, fitting_threshold
    from ..meshing.picture_mesh import mesh_picture
    from ..meshing.quality import mesh_quality

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
    with file_errors("mesh", picture):
        if shown is not None:
            image = apply_mask(image, shown)
        alpha = np.ascontiguousarray(image[..., 3])
        threshold = fitting_threshold(alpha) if options.threshold is None else options.threshold
        meshed = mesh_picture(alpha, options.vertices, options.expand, threshold, options.mesher)
    seconds = time.perf_counter() - started
    if output is not None:
        make_folder_of(output)
        write_obj(output, meshed.mesh, (image.shape[1], image.shape[0]))
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
    layered: "LayeredPicture",
    shown: NDArray[np.uint8] | None,
    output: Path | None,
    options: MeshOptions,
    started: float,
) -> MeshRow:
    """`measure` of a picture in layers, which are meshed as in the editor. Raises InputError."""
    from ..editor.document.drawing import make_drawing
    from ..geometry.mesh import TriMesh
    from ..io.layers.open_layers import left_out_notes
    from ..io.mesh_files.obj_off import write_obj
    from ..meshing.faint import fitting_threshold
    from ..meshing.quality import mesh_quality, smallest_angles

    with file_errors("mesh", picture):
        drawing = make_drawing(None, shown, layers=layered, **asdict(options))
        seconds = time.perf_counter() - started
        assert drawing.meshing is not None
        mesh, level = drawing.mesh, drawing.meshing.threshold
        if output is not None:
            make_folder_of(output)
            write_obj(output, mesh, drawing.size)
        rows = []
        for number, layer in enumerate(drawing.layers):
            own, alpha = mesh.face_layers == number, np.pad(layer.artwork.picture[..., 3], 1)
            used = np.flatnonzero(mesh.layers == number)
            origin = np.subtract(layer.artwork.offset, 1)
            part = TriMesh(mesh.vertices[used] - origin, mesh.faces[own] - used[0])
            quality = mesh_quality(part, alpha, fitting_threshold(alpha, level))
            rows.append((LayerRow("/".join(layer.path), **asdict(quality)), float(part.rest_areas.sum())))
    areas = np.array([area for _, area in rows])
    common = areas * [1 - row.outside for row, _ in rows]
    angles = smallest_angles(mesh)
    return MeshRow(
        picture=str(named_path(picture)),
        parts=sum(row.parts for row, _ in rows),
        holes=sum(row.holes for row, _ in rows),
        specks=0,
        speck_share=0.0,
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        low_angle=float(np.percentile(angles, 1)),
        worst_angle=float(angles.min()),
        covered=float(
            common.sum() / sum(each / row.covered for each, (row, _) in zip(common, rows, strict=True))
        ),
        faint=0.0,
        outside=float(1 - common.sum() / areas.sum()),
        cut_out=True,
        seconds=round(seconds, 4),
        mesh=None if output is None else str(output),
        notes=tuple(left_out_notes(layered)),
        layers=tuple(row for row, _ in rows),
    )


def _expand_folders(pictures: tuple[Path, ...]) -> list[Path]:
    """The pictures, with folders replaced by their pictures in alphabetical order. Raises InputError."""
    from ..io.layers.open_layers import LAYER_SUFFIXES
    from ..io.open_document import PICTURE_SUFFIXES

    paths: list[Path] = []
    for path in pictures:
        if path.is_dir():
            children = sorted(
                child
                for child in path.iterdir()
                if child.suffix.lower() in (*PICTURE_SUFFIXES, *LAYER_SUFFIXES)
            )
            if not children:
                raise FileError("open", path, "the folder contains no pictures")
            paths += children
        else:
            paths.append(path)
    return paths


def _outputs(paths: list[Path], folder: Path | None) -> list[Path | None]:
    """The output file of each picture. Raises InputError if two would have the same name."""
    if folder is None:
        return [None] * len(paths)
    if (folder.exists() and not folder.is_dir()) or folder.suffix.lower() == ".obj":
        reason = f"expected a folder for the meshes of {len(paths)} pictures, got a file"
        raise FileError("save", folder, reason)
    name, count = Counter(path.stem for path in paths).most_common(1)[0]
    if count > 1:
        raise InputError(
            f"expected pictures of different names, got {count} whose mesh would be {display_text(name)}.obj"
        )
    return [folder / f"{path.stem}.obj" for path in paths]


def _measure_all(
    paths: list[Path], outputs: list[Path | None], options: MeshOptions
) -> tuple[list[MeshRow], list[dict[str, Any]]]:
    from ..meshing.mesher_process import MESHER_PROCESS

    MESHER_PROCESS.start()
    rows, errors = [], []
    with click.progressbar(zip(paths, outputs, strict=True), len(paths), "Meshing", file=sys.stderr) as bar:
        for path, output in bar:
            try:
                rows.append(measure(path, output, options))
            except InputError as error:
                errors.append({"picture": str(path), "error": str(error)})
    return rows, errors


def _describe(row: MeshRow) -> str:
    from ..io.open_document import MIN_REPORTED_SHARE, faint_note

    lines = [
        f"{display_text(row.picture)}: {_count_noun(row.parts, 'part')}, {_count_noun(row.holes, 'hole')}, "
        f"{row.vertices} vertices, {row.faces} faces",
        f"  smallest angle  {row.worst_angle:.1f}°, 1st percentile {row.low_angle:.1f}°",
        f"  covered         {row.covered:.2%} of the visible area; {row.outside:.1%} of the mesh is outside",
        f"  time            {row.seconds:.3f} s",
    ]
    width = max((len(layer.name) for layer in row.layers), default=0)
    lines += [
        f"  {display_text(layer.name):<{width}}  {layer.vertices:>6} vertices, smallest angle "
        f"{layer.worst_angle:4.1f}°, covered {layer.covered:7.2%}, {layer.outside:6.1%} outside"
        for layer in row.layers
    ]
    lines += [f"  {note}" for note in row.notes]
    if row.faint >= MIN_REPORTED_SHARE:
        lines.append(f"  {faint_note(row.faint)}")
    if row.specks:
        lines.append(
            f"  left out        {_count_noun(row.specks, 'speck')}, {row.speck_share:.2%} of the visible area"
        )
    if not row.cut_out:
        lines.append("  The picture has no transparency, so the mesh is a rectangle; use --mask.")
    if row.mesh is not None:
        lines.append(f"Wrote {display_text(row.mesh)}")
    return "\n".join(lines)


def _count_noun(count: int, noun: str, plural: str = "") -> str:
    """E.g. "1 part" or "2 parts"; plural: of the noun if it is irregular."""
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def _table(rows: list[MeshRow], failed: int) -> list[str]:
    """One line per picture, and a summary."""
    names = [display_text(row.picture) for row in rows]
    width = max(map(len, ["picture", *names]))
    lines = [
        f"{'picture':<{width}} {'parts':>6} {'holes':>6} {'specks':>7} {'vertices':>9} {'faces':>7}"
        f" {'1 % angle':>10} {'worst':>6} {'covered':>8} {'outside':>8} {'seconds':>8}"
    ]
    lines += [
        f"{name:<{width}} {row.parts:>6} {row.holes:>6} {row.specks:>7} {row.vertices:>9}"
        f" {row.faces:>7} {row.low_angle:>9.1f}° {row.worst_angle:>5.1f}° {row.covered:>8.2%}"
        f" {row.outside:>8.1%} {row.seconds:>8.3f}"
        for name, row in zip(names, rows, strict=True)
    ]
    if rows:
        seconds = [row.seconds for row in rows]
        worst, least = (
            min(row.worst_angle for row in rows),
            min(row.covered for row in rows),
        )
        lines.append(
            f"{_count_noun(len(rows), 'mesh', 'meshes')}, {failed} failed; "
            f"median {np.median(seconds):.3f} s, slowest {max(seconds):.3f} s; "
            f"worst angle {worst:.1f}°, least covered {least:.2%}"
        )
    else:
        lines.append(f"0 meshes, {failed} failed")
    return lines
