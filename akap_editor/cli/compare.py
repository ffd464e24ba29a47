"""Compares deformation methods on recordings and writes a report."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from ..display_text import display_text
from ..errors import InputError, file_errors
from ..io.atomic import write_atomic
from ..io.outputs import refuse_replacing
from ..meshing.meshers import nearest_mesher
from .options import COMPARED_METHODS, FILE, make_folder_of, overwrite_option, parse_numbers, progress_bar

if TYPE_CHECKING:
    from ..editor.document.drawing import Drawing
    from ..editor.session.recording import Recording


@click.command(
    "compare", epilog="Example: akap-editor compare wave.akaprec -m akap -m arap:converge -o report/"
)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option("-o", "--output", type=FILE, required=True, help="Folder for the report.")
@click.option(
    "-m",
    "--methods",
    multiple=True,
    metavar="METHOD",
    help="Methods, separated by spaces, with parameters after a colon: arap:converge. Can be repeated. "
    f"By default {' '.join(COMPARED_METHODS)}.",
)
@click.option(
    "--vertices",
    default="",
    metavar="NUMBERS",
    help="Sizes of other meshes, separated by commas, for plots of convergence: 500,1000,4000.",
)
@overwrite_option
def compare_command(
    recordings: tuple[Path, ...], output: Path, methods: tuple[str, ...], vertices: str, overwrite: bool
) -> None:
    """Replay recordings with several methods and write a report: index.html and comparison.json."""
    from ..deform.methods import compared_methods, parse_method
    from ..io.akap.recording import read_recording, recorded_drawing

    specs = list(dict.fromkeys(" ".join(methods).split())) or compared_methods()
    for spec in specs:
        parse_method(spec)
    sizes = sorted(set(parse_numbers("--vertices", vertices, 50, 20_000))) if vertices.strip() else []
    page_path, numbers_path = output / "index.html", output / "comparison.json"
    refuse_replacing(output, [page_path, numbers_path], overwrite)
    report = _import_report()
    inputs = [(path, read_recording(path)) for path in recordings]
    drawings = [recorded_drawing(recording) for _, recording in inputs]
    make_folder_of(page_path)
    count = len(inputs) * len(specs) * (1 + len(sizes))
    with progress_bar(range(count), count, "Replaying") as bar:
        models = [
            _run_methods(path, recording, drawing, specs, sizes, bar.update)
            for (path, recording), drawing in zip(inputs, drawings, strict=True)
        ]
    click.echo("Drawing the report ...")
    from ..render.offscreen import OffscreenRenderer

    with OffscreenRenderer(is_smooth=False) as renderer:
        page = report.to_html(models, renderer)
    write_atomic(page_path, page.encode("utf-8"))
    write_atomic(numbers_path, report.to_json(models).encode("utf-8"))
    click.echo(f"Wrote {display_text(page_path)} and {display_text(numbers_path)}")


def _import_report() -> Any:
    """The module that writes reports. Raises InputError if a package that it needs is not installed."""
    try:
        from ..compare import report
    except ImportError as error:
        raise InputError(
            f"reports need packages of which one is missing ({error}): pip install 'akap-editor[report]'"
        ) from error
    return report


def _run_methods(
    path: Path,
    recording: "Recording",
    drawing: "Drawing",
    specs: Sequence[str],
    sizes: Sequence[int],
    count_runs: Callable[[int], None],
) -> Any:
    """Replay one recording with all methods, also on meshes of other sizes; returns a `Model`.

    count_runs: called with the number of runs that are finished, for the progress bar.
    """
    from ..compare.report import Model
    from ..compare.run import replay_method, run
    from ..editor.document.drawing import Meshing, make_drawing, remesh_layered_drawing
    from ..geometry.distortion import distortion

    runs, finer = [], []
    mesher = None if drawing.meshing is None else nearest_mesher(drawing.meshing.mesher)
    if drawing.layers:
        made = drawing.meshing or Meshing()
        others = [remesh_layered_drawing(drawing, replace(made, vertices=size)) for size in sizes]
    else:
        image, name = drawing.image, drawing.name
        others = [make_drawing(image, vertices=size, name=name, mesher=mesher) for size in sizes]
    for spec in specs:
        with file_errors(f"replay with {spec}", path):
            runs.append(run(recording, drawing, spec))
        count_runs(1)
        after = [runs[-1].final_distortion]
        for other in others:
            after.append(distortion(other.mesh, replay_method(recording, other, spec).pose))
            count_runs(1)
        counts = [len(each.mesh.vertices) for each in (drawing, *others)]
        rows = sorted((count, d.area, d.angle) for count, d in zip(counts, after, strict=True))
        finer.append(np.array(rows))
    return Model(drawing.name, display_text(path.stem), runs, finer)
