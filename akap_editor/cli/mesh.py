"""Makes meshes of pictures and says how good they are."""

import json
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np

from ..editor.document.drawing import Meshing, apply_mask
from ..errors import InputError, file_errors
from ..geometry.validation import as_number
from ..io.images import has_transparency, read_image, read_mask
from ..io.mesh_files.obj_off import write_obj
from ..io.open_document import PICTURE_SUFFIXES
from ..meshing.picture_mesh import mesh_picture
from ..meshing.quality import mesh_quality
from ..meshing.triangle_process import TRIANGLE
from ..meshing.triangulate import MAX_VERTICES, MIN_VERTICES
from .options import FILE, make_folder_of

MOST_EXPANSION = 1000.0  # pixels


@dataclass(frozen=True)
class MeshRow:
    """What became of one picture: see `MeshQuality`; seconds from the file to the mesh, without measuring.

    specks: islands left out as too small; speck_share: their share of the visible area; cut_out: whether the
    picture has transparency; mesh: the file written.
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
    outside: float
    cut_out: bool
    seconds: float
    mesh: str | None


@click.command(epilog="Example: akap-editor mesh drawings/*.png -o meshes --vertices 3000")
@click.argument("pictures", type=FILE, nargs=-1, required=True, metavar="PICTURE...")
@click.option(
    "-o", "--output", type=FILE, help="OBJ file to write; of several pictures, the folder for them."
)
@click.option("--vertices", default=Meshing.vertices, show_default=True, help="Wanted number of vertices.")
@click.option(
    "--expand",
    default=Meshing.expand,
    show_default=True,
    metavar="PX",
    help="Pixels by which the outline moves out.",
)
@click.option(
    "--threshold",
    default=Meshing.threshold,
    show_default=True,
    metavar="SHARE",
    help="Share of full opacity at which the picture ends.",
)
@click.option("--mask", type=FILE, help="Picture that is bright, or opaque, where PICTURE is to be visible.")
@click.option(
    "--json", "as_json", is_flag=True, help="Print the figures as JSON, a list with one object each."
)
def mesh(
    pictures: tuple[Path, ...],
    output: Path | None,
    vertices: int,
    expand: float,
    threshold: float,
    mask: Path | None,
    as_json: bool,
) -> None:
    """Make a mesh of each PICTURE, or of all pictures in a folder, and say how good it is.

    Of several pictures, bad ones are named and left out; the exit code is then 1.
    """
    meshing = _meshing(vertices, expand, threshold)
    if len(pictures) == 1 and not pictures[0].is_dir():
        TRIANGLE.start()
        row = measure(pictures[0], output, meshing, mask)
        click.echo(json.dumps([asdict(row)], indent=2) if as_json else _words(row))
        return
    if mask is not None:
        raise InputError("--mask: expected one picture that it belongs to, got several")
    paths = _listed(pictures)
    rows, errors = _measure_all(paths, _outputs(paths, output), meshing)
    if as_json:
        click.echo(json.dumps([asdict(row) for row in rows] + errors, indent=2))
    else:
        click.echo("\n".join(_table(rows, len(errors))))
    for error in errors:
        click.echo(f"akap-editor: {error['error']}", err=True)
    if errors:
        raise SystemExit(1)


def measure(picture: Path, output: Path | None, meshing: Meshing, mask: Path | None = None) -> MeshRow:
    """Make the mesh of one picture, write it where wanted, and measure it. Raises InputError."""
    if output is not None and output.suffix.lower() != ".obj":
        raise InputError(f"{output}: expected a name that ends in .obj, got {output.suffix or 'none'}")
    started = time.perf_counter()
    image = read_image(picture)
    shown = read_mask(mask) if mask is not None else None
    with file_errors("mesh", picture):
        if shown is not None:
            image = apply_mask(image, shown)
        alpha = np.ascontiguousarray(image[..., 3])
        made = mesh_picture(alpha, meshing.vertices, meshing.expand, meshing.threshold)
    seconds = time.perf_counter() - started
    if output is not None:
        make_folder_of(output)
        write_obj(output, made.mesh, (image.shape[1], image.shape[0]))
    quality = mesh_quality(made.mesh, alpha, meshing.threshold)
    visible = made.mesh.rest_areas.sum() * (1 - quality.outside) / quality.covered
    return MeshRow(
        picture=str(picture),
        specks=made.specks,
        speck_share=made.speck_area / visible,
        cut_out=has_transparency(image),
        seconds=round(seconds, 4),
        mesh=None if output is None else str(output),
        **asdict(quality),
    )


def _meshing(vertices: int, expand: float, threshold: float) -> Meshing:
    as_number(vertices, "--vertices", MIN_VERTICES, MAX_VERTICES)
    as_number(expand, "--expand", 0, MOST_EXPANSION)
    if not 0 < threshold < 1:
        raise InputError(f"--threshold: expected a share between 0 and 1, got {threshold:g}")
    return Meshing(vertices, expand, threshold)


def _listed(pictures: tuple[Path, ...]) -> list[Path]:
    """The pictures, those in folders by name. Raises InputError where a folder has none."""
    paths: list[Path] = []
    for path in pictures:
        if path.is_dir():
            found = sorted(child for child in path.iterdir() if child.suffix.lower() in PICTURE_SUFFIXES)
            if not found:
                raise InputError(f"{path}: expected a folder with pictures, got one without")
            paths += found
        else:
            paths.append(path)
    return paths


def _outputs(paths: list[Path], folder: Path | None) -> list[Path | None]:
    """Where each mesh goes; pictures of one name would overwrite each other's. Raises InputError."""
    if folder is None:
        return [None] * len(paths)
    if (folder.exists() and not folder.is_dir()) or folder.suffix.lower() == ".obj":
        raise InputError(f"{folder}: expected a folder for the meshes of {len(paths)} pictures, got a file")
    name, count = Counter(path.stem for path in paths).most_common(1)[0]
    if count > 1:
        raise InputError(f"expected pictures of different names, got {count} whose mesh would be {name}.obj")
    return [folder / f"{path.stem}.obj" for path in paths]


def _measure_all(
    paths: list[Path], outputs: list[Path | None], meshing: Meshing
) -> tuple[list[MeshRow], list[dict[str, Any]]]:
    TRIANGLE.start()
    rows, errors = [], []
    with click.progressbar(zip(paths, outputs, strict=True), len(paths), "Meshing", file=sys.stderr) as bar:
        for path, output in bar:
            try:
                rows.append(measure(path, output, meshing))
            except InputError as error:
                errors.append({"picture": str(path), "error": str(error)})
    return rows, errors


def _words(row: MeshRow) -> str:
    lines = [
        f"{row.picture}: {_counted(row.parts, 'part')}, {_counted(row.holes, 'hole')}, "
        f"{row.vertices} vertices, {row.faces} faces",
        f"  smallest angle  {row.worst_angle:.1f}°, 1st percentile {row.low_angle:.1f}°",
        f"  covered         {row.covered:.2%} of what is visible; {row.outside:.1%} of the mesh is beyond it",
        f"  time            {row.seconds:.3f} s",
    ]
    if row.specks:
        lines.append(
            f"  left out        {_counted(row.specks, 'speck')}, {row.speck_share:.2%} of what is visible"
        )
    if not row.cut_out:
        lines.append("  The picture has no transparency, so the mesh is its frame: give it a mask.")
    if row.mesh is not None:
        lines.append(f"Wrote {row.mesh}")
    return "\n".join(lines)


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _table(rows: list[MeshRow], failed: int) -> list[str]:
    """One line for each picture, and how good they are together."""
    width = max([len("picture"), *(len(row.picture) for row in rows)])
    lines = [
        f"{'picture':<{width}} {'parts':>6} {'holes':>6} {'specks':>7} {'vertices':>9} {'faces':>7}"
        f" {'1 % angle':>10} {'worst':>6} {'covered':>8} {'outside':>8} {'seconds':>8}"
    ]
    lines += [
        f"{row.picture:<{width}} {row.parts:>6} {row.holes:>6} {row.specks:>7} {row.vertices:>9}"
        f" {row.faces:>7} {row.low_angle:>9.1f}° {row.worst_angle:>5.1f}° {row.covered:>8.2%}"
        f" {row.outside:>8.1%} {row.seconds:>8.3f}"
        for row in rows
    ]
    if rows:
        seconds = [row.seconds for row in rows]
        worst, least = min(row.worst_angle for row in rows), min(row.covered for row in rows)
        lines.append(
            f"{_counted(len(rows), 'mesh') if len(rows) == 1 else f'{len(rows)} meshes'}, {failed} failed; "
            f"median {np.median(seconds):.3f} s, slowest {max(seconds):.3f} s; "
            f"worst angle {worst:.1f}°, least covered {least:.2%}"
        )
    else:
        lines.append(f"0 meshes, {failed} failed")
    return lines
