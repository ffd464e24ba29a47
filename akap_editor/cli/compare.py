"""Bends the same drawings by several methods and writes what came out side by side."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from ..deform.methods import compared_methods, parse_method
from ..editor.document.drawing import Drawing, make_drawing
from ..editor.session.recording import Recording
from ..errors import InputError, file_errors
from ..geometry.distortion import distortion
from ..io.akap.recording import read_recording, recorded_drawing
from ..io.atomic import write_atomic
from .options import FILE, make_folder_of


@click.command(
    "compare", epilog="Example: akap-editor compare wave.akaprec -m akap -m arap:converge -o report/"
)
@click.argument("recordings", type=FILE, nargs=-1, required=True, metavar="RECORDING...")
@click.option("-o", "--output", type=FILE, required=True, help="Folder to write the report to.")
@click.option(
    "-m",
    "--methods",
    multiple=True,
    metavar="METHOD",
    help="A method, with settings after a colon: arap:converge. Several: more of this option, or divided by "
    f"spaces. By default {' '.join(compared_methods())}.",
)
@click.option(
    "--vertices",
    default="",
    metavar="NUMBERS",
    help="Sizes of other meshes, divided by commas, for plots of convergence: 500,1000,4000.",
)
def compare_command(
    recordings: tuple[Path, ...], output: Path, methods: tuple[str, ...], vertices: str
) -> None:
    """Bend drawings as recorded by several methods and write a report: index.html and comparison.json."""
    specs = list(dict.fromkeys(" ".join(methods).split())) or compared_methods()
    for spec in specs:
        parse_method(spec)
    sizes = _sizes(vertices)
    report = _report()
    models = [(path, read_recording(path)) for path in recordings]
    drawings = [recorded_drawing(recording) for _, recording in models]
    make_folder_of(output / "index.html")
    count = len(models) * len(specs) * (1 + len(sizes))
    with click.progressbar(length=count, label="Bending") as bar:
        bent = [
            _bent(path, recording, drawing, specs, sizes, bar.update)
            for (path, recording), drawing in zip(models, drawings, strict=True)
        ]
    click.echo("Drawing the report ...")
    from ..render.offscreen import OffscreenRenderer

    with OffscreenRenderer() as renderer:
        page = report.to_html(bent, renderer)
    write_atomic(output / "index.html", page.encode("utf-8"))
    write_atomic(output / "comparison.json", report.to_json(bent).encode("utf-8"))
    click.echo(f"Wrote {output / 'index.html'} and {output / 'comparison.json'}")


def _sizes(text: str) -> list[int]:
    """Numbers of vertices, ascending. Raises InputError."""
    try:
        sizes = sorted({int(part) for part in text.split(",") if part.strip()})
    except ValueError as error:
        raise InputError(f"--vertices: expected numbers divided by commas, got {text!r}") from error
    for size in sizes:
        if not 50 <= size <= 20_000:
            raise InputError(f"--vertices: expected numbers from 50 to 20000, got {size}")
    return sizes


def _report() -> Any:
    """The module that writes reports. Raises InputError where what it needs is not installed."""
    try:
        from ..compare import report
    except ImportError as error:
        raise InputError(
            f"compare: expected the libraries for reports, but one is missing ({error}); "
            "install them with pip install 'akap-editor[report]'"
        ) from error
    return report


def _bent(
    path: Path,
    recording: Recording,
    drawing: Drawing,
    specs: Sequence[str],
    sizes: Sequence[int],
    done: Callable[[int], None],
) -> Any:
    """One model: all methods over one recording, and on meshes of other sizes. ``done`` counts runs."""
    from ..compare.report import Model
    from ..compare.run import bend, run

    runs, finer = [], []
    others = [make_drawing(drawing.image, vertices=size, name=drawing.name) for size in sizes]
    for spec in specs:
        with file_errors(f"replay with {spec}", path):
            runs.append(run(recording, drawing, spec))
        done(1)
        after = [runs[-1].after]
        for other in others:
            after.append(distortion(other.mesh, bend(recording, other, spec).pose))
            done(1)
        counts = [len(each.mesh.vertices) for each in (drawing, *others)]
        rows = sorted((count, d.area, d.angle) for count, d in zip(counts, after, strict=True))
        finer.append(np.array(rows))
    return Model(drawing.name, path.stem, runs, finer)
