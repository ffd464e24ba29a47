"""How the time of a step grows with the mesh, beside the time in which its factors can be read from memory.

Run from the project's root: python benchmarks/scaling.py [--sizes 1000 3000 10000 30000 100000] [--plot FILE]
The bundled elephant lifts its trunk with memory, on one thread; new factors are made in a second one. Prints
for each size the median and the largest time of a frame, both until it is done, one numeric phase, one
solve, and the time to stream the factors through the caches twice at the bandwidth measured in the same run;
if libigl is installed, also its ARAP with ten iterations. Times are those that the processor spends in the
calling thread, so that other programs disturb them less, but for "wall" and "longest", which include
waiting for the factors that the second thread makes. The plot needs matplotlib.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import time
from collections.abc import Callable

import numpy as np
from step import Drag, elephant, igl_frames

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.akap.elimination_order import EliminationOrder
from akap_editor.deform.cholesky import CholeskyFactors
from akap_editor.deform.fronts import SymbolicCholesky
from akap_editor.geometry.killing_matrix import KillingMatrix
from akap_editor.geometry.operators import to_complex
from akap_editor.geometry.validation import Floats

COLUMNS = ("median", "largest", "wall", "longest", "libigl", "numeric", "solve", "stream")  # milliseconds


def bandwidth() -> float:
    """Bytes a second that one thread reads and writes when it copies a large array."""
    source, target = np.ones(2**24), np.empty(2**24)
    return 2 * source.nbytes / least_seconds(lambda: np.copyto(target, source))


def least_seconds(function: Callable[[], object], repetitions: int = 9) -> float:
    """The shortest time of several calls."""
    times = []
    for _ in range(repetitions):
        started = time.thread_time()
        function()
        times.append(time.thread_time() - started)
    return min(times)


def frames(drag: Drag) -> Floats:
    """Milliseconds of each frame of a drag with memory, (q, 2): of the processor, and until it is done."""
    deformer = AkapDeformer(drag.mesh, memory=1.0)
    deformer.set_pins(drag.points)
    deformer.prepare(drag.mesh.vertices)
    time.sleep(0.5)  # a hand, too, presses before it moves
    pose, times = drag.mesh.vertices, []
    for targets in drag.path:
        started = np.array([time.thread_time(), time.perf_counter()])
        pose = deformer.step(pose, targets).positions
        times.append(1000 * (np.array([time.thread_time(), time.perf_counter()]) - started))
    return np.array(times)


def measure(drag: Drag, bytes_per_second: float) -> dict[str, float]:
    """The columns of the table for one size, in milliseconds, and the bytes of the factors."""
    times = frames(drag)
    order = EliminationOrder(drag.mesh)
    killing = KillingMatrix(order.mesh)
    rows, columns = killing.blocks.rows, killing.blocks.columns
    nonzeros = killing.nonzeros(to_complex(order.mesh.vertices)) + (rows == columns)
    factors = CholeskyFactors(SymbolicCholesky(rows, columns, 2, order.starts), np.float16)
    right = np.ones(2 * len(order.mesh.vertices))
    size = factors.values.nbytes
    row = {
        "median": float(np.median(times[:, 0])),
        "largest": float(times[:, 0].max()),
        "wall": float(np.median(times[:, 1])),
        "longest": float(times[:, 1].max()),
        "numeric": 1000 * least_seconds(lambda: factors.factorize(nonzeros)),
        "solve": 1000 * least_seconds(lambda: factors.solve(right)),
        "stream": 2000 * size / bytes_per_second,
        "bytes": size,
    }
    theirs = igl_frames(drag, 10, time.thread_time)
    return row | {"libigl": float(np.median(theirs[1])) if theirs else np.nan}


def plot(sizes: list[int], rows: list[dict[str, float]], path: str) -> None:
    """Write a picture of the columns over the number of vertices."""
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    labels = {
        "libigl": "libigl ARAP, 10 iterations",
        "median": "a step with memory",
        "longest": "the longest one, with waiting for factors",
        "numeric": "a numeric phase",
        "solve": "a solve",
        "stream": "factors streamed twice",
    }
    for name, label in labels.items():
        style = {"linestyle": "--", "color": "gray"} if name == "stream" else {"marker": "o", "markersize": 4}
        axes.loglog(sizes, [row[name] for row in rows], label=label, **style)
    axes.axhline(1000 / 30, color="black", linewidth=0.6)
    axes.annotate("30 frames a second", (sizes[0], 1000 / 30 * 1.08), fontsize=8)
    axes.set_xlabel("vertices")
    axes.set_ylabel("milliseconds")
    axes.grid(which="both", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the table, and write the plot if asked to."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[1000, 3000, 10000, 30000, 100000])
    parser.add_argument("--plot", help="file to write, e.g. docs/images/scaling.png")
    options = parser.parse_args()
    speed = bandwidth()
    print(f"bandwidth {speed / 1e9:.1f} GB/s")
    print(f"{'vertices':>9}" + "".join(f"{name:>10}" for name in COLUMNS) + "   factors")
    frames(elephant(3000))  # loads the compiled functions
    counts, rows = [], []
    for size in options.sizes:
        drag = elephant(size)
        counts.append(len(drag.mesh.vertices))
        rows.append(measure(drag, speed))
        values = "".join(f"{rows[-1][name]:10.2f}" for name in COLUMNS)
        print(f"{counts[-1]:>9}{values}{rows[-1]['bytes'] / 1e6:7.1f} MB", flush=True)
    if options.plot:
        plot(counts, rows, options.plot)


if __name__ == "__main__":
    main()
