"""Time of one step of a dragged mesh, at several sizes, compared with the plain method and libigl's ARAP.

Run from the project's root: python benchmarks/step.py [--sizes 1000 3000 10000 30000] [--no-plain]
The bar is bent by 90°, the elephant lifts its trunk, each in 60 frames of one step, on one thread. "plain"
factorizes both systems in every substep (`exact=True`), as the paper does; "ours" is the default, with and
without memory. The row of libigl appears if it is installed (`pip install libigl`).
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import resource as system
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from timing import FunctionTimer

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.akap.killing_field import KillingSystem
from akap_editor.deform.akap.preconditioned_cholesky import PreconditionedCholesky
from akap_editor.deform.akap.rest_memory import RestMemory
from akap_editor.deform.cholesky import CholeskyFactors
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.killing_matrix import KillingMatrix
from akap_editor.geometry.mesh import MeshPoints, TriMesh
from akap_editor.geometry.validation import Floats
from akap_editor.io.images import read_image
from akap_editor.meshing.outline import Outline
from akap_editor.meshing.triangulate import triangulate
from akap_editor.resources import resource

FRAMES = 60
PARTS = ("assemble", "factor", "solve", "spirals", "memory")


@dataclass
class Drag:
    """A mesh, its pins, and their targets in each frame, (FRAMES, k, 2)."""

    name: str
    mesh: TriMesh
    points: MeshPoints
    path: np.ndarray


def bar(vertices: int) -> Drag:
    """A 5:1 bar with two pins at each end; the right end moves along an arc to 90°."""
    mesh = triangulate([Outline(np.array([[0.0, 0.0], [1000, 0], [1000, 200], [0, 200]]))], vertices)
    points = mesh.locate([[20, 50], [20, 150], [980, 50], [980, 150]])
    start = mesh.evaluate(points, mesh.vertices)
    path = np.repeat(start[None], FRAMES, axis=0)
    for frame, angle in enumerate(np.linspace(0, np.pi / 2, FRAMES + 1)[1:]):
        rotation = np.exp(1j * angle)
        end = 1000 / angle * (np.sin(angle) + 1j * (1 - np.cos(angle))) + 100j
        for pin in (2, 3):
            target = end + rotation * complex(start[pin, 0] - 1000, start[pin, 1] - 100)
            path[frame, pin] = target.real, target.imag
    return Drag("bar", mesh, points, path)


def elephant(vertices: int) -> Drag:
    """The bundled elephant with five pins that stay and one that lifts the trunk."""
    image = read_image(resource("assets", "drawings", "elephant.png"))
    mesh = make_drawing(image, vertices=vertices).mesh
    points = mesh.locate([(135, 800), (285, 795), (445, 795), (625, 800), (260, 420), (915, 180)])
    path = np.repeat(mesh.evaluate(points, mesh.vertices)[None], FRAMES, axis=0)
    path[:, -1] += np.linspace(0, 1, FRAMES + 1)[1:, None] * [-250.0, -90.0]
    return Drag("elephant", mesh, points, path)


def run_ours(drag: Drag, timer: FunctionTimer, memory: float, exact: bool) -> float:
    """Run a drag and print one row; returns the median time of a frame in milliseconds."""
    deformer = AkapDeformer(drag.mesh, memory=memory, exact=exact)
    deformer.set_pins(drag.points)
    deformer.prepare(drag.mesh.vertices)
    time.sleep(0.3)  # a hand, too, presses before it moves
    pose, frames, parts, drift = drag.mesh.vertices, [], [], 0.0
    timer.take()  # without what was prepared before the drag
    for targets in drag.path:
        started = time.perf_counter()
        result = deformer.step(pose, targets)
        frames.append(1000 * (time.perf_counter() - started))
        parts.append(timer.take())
        pose = result.positions
        is_fixed = (drag.path[0] == drag.path[-1]).all(axis=1)
        offsets = drag.mesh.evaluate(drag.points, pose) - targets
        drift = max(drift, float(np.linalg.norm(offsets[is_fixed], axis=1).max()))
    solver = deformer._system._pinned_system
    split = "  ".join(f"{np.median([1000 * row[part] for row in parts]):7.2f}" for part in PARTS)
    name = ("plain" if exact else "ours") + (" + memory" if memory else "")
    tail = f"{solver.factorizations:4d} {solver.iterations / FRAMES:5.1f}"
    quality = quality_of(drag, pose, drift)
    print(
        f"  {name:<22}{np.median(frames):8.2f} {np.percentile(frames, 95):8.2f} {max(frames):8.2f}  {split}  "
        f"{tail}  {quality}"
    )
    return float(np.median(frames))


def quality_of(drag: Drag, pose: np.ndarray, drift: float) -> str:
    """Format E_area, E_angle, the number of flipped faces, and the largest drift of a fixed pin in pixels."""
    measure = distortion(drag.mesh, pose)
    return f"{measure.area:8.4f} {measure.angle:8.4f} {measure.flipped:5d} {drift:7.3f}"


def igl_frames(
    drag: Drag, iterations: int, clock: Callable[[], float] = time.perf_counter
) -> tuple[Floats, list[float]] | None:
    """The last pose and the milliseconds of each frame of libigl's ARAP; None if it is not installed.

    It pins vertices only: those nearest to our pins. clock: gives seconds.
    """
    try:
        import igl
    except ImportError:
        return None
    mesh = drag.mesh
    start = drag.mesh.evaluate(drag.points, mesh.vertices)
    nearest = np.array([np.argmin(((mesh.vertices - p) ** 2).sum(axis=1)) for p in start], dtype=np.int32)
    data = igl.ARAPData()
    data.max_iter = iterations
    data.energy = igl.ARAP_ENERGY_TYPE_ELEMENTS
    igl.arap_precomputation(mesh.vertices, mesh.faces.astype(np.int64), 2, nearest, data)
    pose, frames = np.array(mesh.vertices), []
    for targets in drag.path:
        goals = mesh.vertices[nearest] + targets - start
        started = clock()
        pose = np.asarray(igl.arap_solve(goals, data, pose))
        frames.append(1000 * (clock() - started))
    return pose, frames


def run_libigl(drag: Drag, iterations: int) -> None:
    """Print a row for libigl's ARAP, if it is installed."""
    result = igl_frames(drag, iterations)
    if result is None:
        return
    pose, frames = result
    blank = "  ".join("      –" for _ in PARTS)
    name = f"libigl ARAP, {iterations} it."
    print(
        f"  {name:<22}{np.median(frames):8.2f} {np.percentile(frames, 95):8.2f} {max(frames):8.2f}  {blank}"
        "     –     –  "
        f"{quality_of(drag, pose, 0.0)}"
    )


def instrument() -> FunctionTimer:
    """Measure the engine's time by part."""
    timer = FunctionTimer(PARTS)
    timer.wrap(KillingMatrix, "nonzeros", "assemble")
    timer.wrap(CholeskyFactors, "factorize", "factor")
    timer.wrap(PreconditionedCholesky, "solve", "solve")
    timer.wrap(KillingSystem, "field", "solve")
    timer.wrap(AkapDeformer, "_follow_field", "spirals")
    timer.wrap(RestMemory, "descend", "memory")
    return timer


def main() -> None:
    """Print one table for each drag and size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[1000, 3000, 10000, 30000])
    parser.add_argument("--no-plain", action="store_true", help="leave out the slow rows")
    options = parser.parse_args()
    timer = instrument()
    head = "  ".join(f"{part:>7}"[-8:] for part in PARTS)
    print(
        f"{'milliseconds a frame':<24}{'median':>8} {'95 %':>8} {'max':>8}  {head}  fact. iter."
        "    E_area  E_angle flips   drift"
    )
    for make in (bar, elephant):
        for size in options.sizes:
            drag = make(size)
            print(f"{drag.name}, {len(drag.mesh.vertices):,} vertices")
            for memory in (0.0, 1.0):
                ours = run_ours(drag, timer, memory, exact=False)
                if not options.no_plain:
                    plain = run_ours(drag, timer, memory, exact=True)
                    print(f"    {plain / ours:.2f} times as fast as plain")
            if not options.no_plain:
                run_libigl(drag, 10)
    memory = system.getrusage(system.RUSAGE_SELF).ru_maxrss / (1024**2 if sys.platform == "darwin" else 1024)
    print(f"peak memory {memory:.0f} MB")


if __name__ == "__main__":
    main()
