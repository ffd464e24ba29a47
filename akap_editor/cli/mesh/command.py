"""The command `mesh`: makes meshes of pictures and reports their quality."""

import json
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...display_text import display_text
from ...errors import FileError, InputError
from ...geometry.validation import as_number
from ...io.outputs import refuse_replacing
from ...io.streams import written_path
from ...meshing.meshers import check_mesher
from ..options import (
    FILE,
    INPUT,
    MESH_MARGIN,
    MESH_VERTICES,
    check_threshold,
    mesher_option,
    overwrite_option,
    refuse_stream_of_several,
    say,
    threshold_option,
)

if TYPE_CHECKING:
    from .measures import MeshOptions, MeshRow

MAX_EXPANSION = 1000.0  # pixels


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
    from ...meshing.mesher_process import MESHER_PROCESS
    from ...meshing.triangulate import MAX_VERTICES, MIN_VERTICES
    from .measures import MeshOptions, measure
    from .report import description, table

    as_number(vertices, "--vertices", MIN_VERTICES, MAX_VERTICES)
    as_number(expand, "--expand", 0, MAX_EXPANSION)
    options = MeshOptions(vertices, expand, check_threshold(threshold), check_mesher(mesher))
    if len(pictures) == 1 and not pictures[0].is_dir():
        MESHER_PROCESS.start()
        with written_path(output or Path(), ".obj") as path:
            row = measure(pictures[0], path if output else None, options, mask, overwrite)
        row = replace(row, mesh=None if row.mesh is None else str(output))
        say(json.dumps([row.record], indent=2) if as_json else description(row), output)
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
        click.echo(json.dumps([row.record for row in rows] + errors, indent=2))
    else:
        click.echo("\n".join(table(rows, len(errors))))
    for error in errors:
        click.echo(f"akap-editor: {error['error']}", err=True)
    if errors:
        raise SystemExit(1)


def _expand_folders(pictures: tuple[Path, ...]) -> list[Path]:
    """The pictures, with folders replaced by their pictures in alphabetical order. Raises InputError."""
    from ...io.layers.open_layers import LAYER_SUFFIXES
    from ...io.open_document import PICTURE_SUFFIXES

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
    paths: list[Path], outputs: list[Path | None], options: "MeshOptions"
) -> tuple[list["MeshRow"], list[dict[str, Any]]]:
    """Measure several pictures; the errors of those that fail as records for --json."""
    from ...meshing.mesher_process import MESHER_PROCESS
    from .measures import measure

    MESHER_PROCESS.start()
    rows, errors = [], []
    with click.progressbar(zip(paths, outputs, strict=True), len(paths), "Meshing", file=sys.stderr) as bar:
        for path, output in bar:
            try:
                rows.append(measure(path, output, options))
            except InputError as error:
                errors.append({"picture": str(path), "error": str(error)})
    return rows, errors
