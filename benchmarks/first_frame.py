"""Time of what comes before a drag: a new mesh, a change of the pins, and the first frame after each.

Run from the project's root: python benchmarks/first_frame.py [--sizes 3000 10000 30000]
The bundled elephant with memory, in milliseconds of the processor in the calling thread, medians of several
runs. "mesh" is the `TriMesh`, "deformer" the `AkapDeformer` with its symbolic factorizations, "pins" what a
press takes for them. "first" and "after" are the frames after a new mesh and after a change of the pins, if
factors were made between press and motion; the columns after these, if they are made in the frame.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import time
from collections import defaultdict
from collections.abc import Callable
from typing import TypeVar

import numpy as np
from step import Drag, elephant

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.geometry.mesh import MeshPoints, TriMesh

RUNS, FRAMES_BETWEEN = 7, 8
COLUMNS = ("mesh", "deformer", "pins", "first", "after", "median", "first in one", "after in one")
T = TypeVar("T")


def measure(drag: Drag, times: dict[str, list[float]], ahead: bool) -> None:
    """Add the times of one drag, in which a pin is removed after some frames; ahead: prepare first frames."""

    def timed(name: str, function: Callable[[], T]) -> T:
        started = time.thread_time()
        result = function()
        times[name].append(1000 * (time.thread_time() - started))
        return result

    def set_pins(points: MeshPoints) -> None:
        deformer.set_pins(points)
        if ahead:
            deformer.prepare(pose)

    suffix = "" if ahead else " in one"
    vertices, faces = np.array(drag.mesh.vertices), np.array(drag.mesh.faces)
    mesh = timed("mesh", lambda: TriMesh(vertices, faces))
    deformer = timed("deformer", lambda: AkapDeformer(mesh, memory=1.0))
    pose, path = mesh.vertices, iter(drag.path)
    fewer = MeshPoints(drag.points.faces[1:], drag.points.weights[1:])
    for points, name in ((drag.points, "first"), (fewer, "after")):
        timed("pins" + suffix, lambda points=points: set_pins(points))  # type: ignore[misc]
        time.sleep(0.2)  # a hand, too, presses before it moves
        for number in range(FRAMES_BETWEEN):
            targets = next(path)[-len(points) :]
            step = lambda pose=pose, targets=targets: deformer.step(pose, targets)  # noqa: E731
            pose = timed(
                "median" if number > 1 else name + suffix if number == 0 else "second", step
            ).positions


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[3000, 10000, 30000])
    options = parser.parse_args()
    print(f"{'vertices':>9}" + "".join(f"{name:>14}" for name in COLUMNS))
    for size in options.sizes:
        drag, times = elephant(size), defaultdict[str, list[float]](list)
        measure(drag, defaultdict(list), True)  # loads the compiled functions
        for _ in range(RUNS):
            measure(drag, times, True)
            measure(drag, times, False)
        row = "".join(f"{np.median(times[name]):14.2f}" for name in COLUMNS)
        print(f"{len(drag.mesh.vertices):>9}{row}", flush=True)


if __name__ == "__main__":
    main()
