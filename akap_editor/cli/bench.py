"""Measures the speed and the distortion of deformation methods."""

import json
import sys
import time
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from ..errors import InputError
from ..geometry.validation import Floats
from .options import bundled, parse_numbers

if TYPE_CHECKING:
    from ..editor.document.drawing import Drawing

DRAWING = "elephant"
FIXED_PINS = [(135.0, 800.0), (285.0, 795.0), (445.0, 795.0), (625.0, 800.0), (260.0, 420.0)]  # pixels
DRAGGED_PIN, DRAG = (915.0, 180.0), (-250.0, -90.0)
FRAMES = 60


@dataclass(frozen=True)
class BenchRow:
    """The measures of one drag.

    prepare_ms: construction of the deformer and its pins; median_ms, slowest_ms: 50th and 95th percentile of
    the steps; area, angle: E_area and E_angle in the end; flipped: number of flipped faces; pin_error:
    largest distance of a pin from its target, pixels.
    """

    method: str
    vertices: int
    faces: int
    prepare_ms: float
    median_ms: float
    slowest_ms: float
    area: float
    angle: float
    flipped: int
    pin_error: float


@click.command(epilog="Example: akap-editor bench --sizes 1000,10000 -m akap -m arap")
@click.option(
    "--sizes",
    default="1000,3000,10000",
    show_default=True,
    metavar="NUMBERS",
    help="Numbers of vertices, separated by commas.",
)
@click.option(
    "-m",
    "--method",
    "methods",
    multiple=True,
    metavar="METHOD",
    default=("akap:memory=1",),
    show_default=True,
    help="Deformation method; can be repeated.",
)
@click.option("--frames", default=FRAMES, show_default=True, help="Number of steps.")
@click.option("--json", "as_json", is_flag=True, help="Print the measures as JSON.")
def bench(sizes: str, methods: tuple[str, ...], frames: int, as_json: bool) -> None:
    """Measure deformation methods on this computer: the bundled elephant lifts its trunk, one step per frame.

    E_area and E_angle are the distortion of areas and angles in the end; 2 is none.
    """
    from ..deform.methods import parse_method
    from ..editor.document.drawing import make_drawing
    from ..io.images import read_image

    if not 1 <= frames <= 10_000:
        raise InputError(f"--frames: expected a number from 1 to 10000, got {frames}")
    counts = parse_numbers("--sizes", sizes, 100, 100_000)
    specs = [(name, *parse_method(name)) for name in methods]
    rows = []
    image = read_image(bundled(DRAWING))
    with click.progressbar(length=len(counts) * len(specs), label="Measuring", file=sys.stderr) as bar:
        for count in counts:
            drawing = make_drawing(image, vertices=count)
            for name, method, settings in specs:
                rows.append(measure(drawing, name, method, settings, frames))
                bar.update(1)
    click.echo(json.dumps([asdict(row) for row in rows], indent=2) if as_json else _table(rows))


def measure(drawing: "Drawing", name: str, method: str, settings: dict[str, Any], frames: int) -> BenchRow:
    """Measure one drag of ``frames`` steps. name: the method as it was typed; settings: its parameters."""
    from ..deform.methods import make_deformer
    from ..geometry.distortion import distortion

    mesh = drawing.mesh
    points = mesh.locate([*FIXED_PINS, DRAGGED_PIN])
    started = time.perf_counter()
    deformer = make_deformer(method, mesh, **settings)
    deformer.set_pins(points)
    pose: Floats = mesh.vertices
    start = mesh.evaluate(points, pose)
    targets = start
    prepare_seconds = time.perf_counter() - started
    step_seconds = []
    for share in np.linspace(0, 1, frames + 1)[1:]:
        targets = start.copy()
        targets[-1] += share * np.array(DRAG)
        started = time.perf_counter()
        pose = deformer.step(pose, targets).positions
        step_seconds.append(time.perf_counter() - started)
    step_ms = 1000 * np.array(step_seconds)
    measured = distortion(mesh, pose)
    return BenchRow(
        method=name,
        vertices=len(mesh.vertices),
        faces=len(mesh.faces),
        prepare_ms=round(1000 * prepare_seconds, 3),
        median_ms=round(float(np.median(step_ms)), 3),
        slowest_ms=round(float(np.percentile(step_ms, 95)), 3),
        area=measured.area,
        angle=measured.angle,
        flipped=measured.flipped,
        pin_error=float(np.linalg.norm(mesh.evaluate(points, pose) - targets, axis=1).max()),
    )


def _table(rows: list[BenchRow]) -> str:
    width = max(len("method"), *(len(row.method) for row in rows))
    lines = [
        f"{'method':<{width}} {'vertices':>9} {'prepare':>12} {'median':>12} {'95 %':>12}"
        f" {'E_area':>9} {'E_angle':>9} {'flipped':>8} {'pin error':>10}"
    ]
    lines += [
        f"{row.method:<{width}} {row.vertices:>9} {row.prepare_ms:>9.1f} ms {row.median_ms:>9.2f} ms"
        f" {row.slowest_ms:>9.2f} ms {row.area:>9.4f} {row.angle:>9.4f} {row.flipped:>8}"
        f" {row.pin_error:>7.2f} px"
        for row in rows
    ]
    return "\n".join(lines)
