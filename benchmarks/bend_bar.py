"""The bar of the paper's Fig. 9 and Table 1, by every method: which bend gives the paper's figures?

Run from the project's root: python benchmarks/bend_bar.py [vertices]. Takes minutes; docs/methods.md has the
results.
"""

import sys
from collections.abc import Iterable

import numpy as np

import akap_editor as akap
from akap_editor.deform.methods import parse_method
from akap_editor.geometry.validation import Floats
from akap_editor.resources import resource

MIDDLE, REACH, HALF_HEIGHT = np.array([560.0, 150.0]), 485.0, 70.0
PAPER = "the paper | 2.356 / 2.001 | 2.042 / 2.036 | 2.070 / 2.062 | 4.951 / 8.158"
CORNERS = MIDDLE + [[x, y] for x in (-REACH, REACH) for y in (-HALF_HEIGHT, HALF_HEIGHT)]


def arc_targets(degrees: float) -> Floats:
    """The targets of the pins at the ends, (4, 2), on an arc on which the middle line keeps its length."""
    if not degrees:
        return CORNERS
    radius = 2 * REACH / np.radians(degrees)
    along, up = (CORNERS - MIDDLE).T
    arm = radius - up
    return MIDDLE + np.stack([arm * np.sin(along / radius), radius - arm * np.cos(along / radius)], axis=1)


def bend(drawing: akap.Drawing, spec: str, degrees: float, moves: int, settling: int = 0) -> str:
    """E_area / E_angle after a bend in equal moves, then ``settling`` more steps at the end."""
    method, parameters = parse_method(spec)
    deformer = akap.make_deformer(method, drawing.mesh, **parameters)
    deformer.set_pins(drawing.mesh.locate(CORNERS))
    pose = drawing.mesh.vertices
    for move in [*range(1, moves + 1), *[moves] * settling]:
        pose = deformer.step(pose, arc_targets(degrees * move / moves)).positions
    after = akap.distortion(drawing.mesh, pose)
    flipped = f" ({after.flipped} flipped)" if after.flipped else ""
    return f"{after.area:.3f} / {after.angle:.3f}{flipped}"


def print_table(head: str, rows: Iterable[tuple[str, list[str]]]) -> None:
    """Print a Markdown table; each row as soon as it is computed."""
    print(f"\n| {head} |\n|{'---|' * (head.count('|') + 1)}")
    for name, cells in rows:
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


def main() -> None:
    """Print results by bend, then those of AKAP by the number of moves, at the bend of the paper."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    image = akap.read_image(resource("assets", "drawings", "bar.png"))
    drawing = akap.make_drawing(image, vertices=count, name="bar")
    print(f"{len(drawing.mesh.vertices)} vertices")

    def by_bend(degrees: float) -> list[str]:
        return [
            bend(drawing, "cauchy-green", degrees, 1),
            bend(drawing, "arap:iterations=50", degrees, 60, 60),
            bend(drawing, "akap", degrees, 120),
            bend(drawing, "mls", degrees, 1),
        ]

    rows = ((f"{degrees}°", by_bend(degrees)) for degrees in range(177, 212, 5))
    print_table("bend | Cauchy–Green | ARAP | AKAP | MLS", rows)
    print(f"| {PAPER} |")
    spec = "akap:exact,max_step=100"  # one field a move, as in the paper
    rows = ((f"{moves}", [bend(drawing, spec, 207, moves)]) for moves in (8, 9, 10, 12, 16, 30, 60))
    print_table("moves of 207° | AKAP, one field a move", rows)


if __name__ == "__main__":
    main()
