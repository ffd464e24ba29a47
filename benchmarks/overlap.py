"""The overlaps of a pose: CPU time of a frame with nothing, one arm and both arms over the body.

Run from the project's root: python benchmarks/overlap.py [--sizes 2000 10000 30000] [--soak 10000]
The gingerbread man folds its arms at 2,000 vertices; finer meshes take over the pose. Times are the least of
several, in CPU milliseconds of the thread. --soak N instead drags pins of all bundled drawings, and of those
in ../shared/data, at random for N frames, and counts what breaks a law: circles that are left, decisions that
are not restored, and pairs that turn over.
"""

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
from make_crossings import SCENES, nearest_pin

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.remesh import map_points
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError, SolverError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io.images import read_image
from akap_editor.overlap.circles import satisfies
from akap_editor.overlap.common_area import common_areas
from akap_editor.overlap.overlaps import Overlaps, next_overlaps, no_overlaps, restored_overlaps
from akap_editor.resources import bundled_drawings

SEAM_TRAVEL = 3e-4  # share of size² that may turn over beside a seam


def cpu_milliseconds(run: Callable[[], object], repeats: int = 20) -> float:
    """The least CPU time of a call."""
    best = np.inf
    for _ in range(repeats):
        start = time.thread_time()
        run()
        best = min(best, time.thread_time() - start)
    return 1000 * best


def folding_arms() -> tuple[TriMesh, list[np.ndarray], int]:
    """The mesh, all poses (n, 2), and how many of them there are when the first arm has arrived."""
    scene = SCENES["gingerbread"]
    session = Session(new_document(make_drawing(read_image(scene.image), vertices=2000)))
    mesh, poses, first = session.drawing.mesh, [], 0
    session.begin("Fold Arms")
    for place in scene.pins:
        add_pin(session, place)
    for drag in scene.drags:
        start = mesh.evaluate(mesh.locate([drag.start]), session.state.positions)[0]
        pin = nearest_pin(session, start)
        for x, y in drag.path:
            session.apply(SetTargets({pin: (x, y)}))
            session.step()
            poses.append(session.state.positions)
        while session.is_moving:
            session.step()
            poses.append(session.state.positions)
        first = first or len(poses)
    return mesh, poses, first


def measure(sizes: list[int]) -> None:
    """Print one line for each size and pose."""
    coarse, poses, first = folding_arms()
    print(f"{'vertices':>8} {'pose':<9} {'pairs':>7} {'a frame':>8} {'the same pose':>14}")
    for size in sizes:
        image = read_image(SCENES["gingerbread"].image)
        mesh = make_drawing(image, vertices=size).mesh
        rest, empty = mesh.vertices, no_overlaps(mesh)
        spent = cpu_milliseconds(lambda: next_overlaps(mesh, rest, empty))  # noqa: B023
        print(f"{len(rest):>8} {'nothing':<9} {0:>7} {spent:>8.2f}")
        for name, index in (("one arm", first - 30), ("both arms", len(poses) - 30)):
            pose, following = (map_points(rest, coarse, poses[k]) for k in (index, index + 1))
            before = empty
            for earlier in range(index % 5, index, 5):
                before = next_overlaps(mesh, map_points(rest, coarse, poses[earlier]), before)
            before = next_overlaps(mesh, pose, before)
            after = next_overlaps(mesh, following, before)
            spent = cpu_milliseconds(lambda: next_overlaps(mesh, following, before))  # noqa: B023
            same = cpu_milliseconds(lambda: next_overlaps(mesh, following, after))  # noqa: B023
            seam = ", with a seam" if after.has_seam else ""
            print(f"{len(rest):>8} {name:<9} {len(after):>7} {spent:>8.2f} {same:>14.2f}{seam}", flush=True)


def random_sessions(seed: int) -> Iterator[Session]:
    """Sessions on all drawings in turn, each after a step of a random drag."""
    rng = np.random.default_rng(seed)
    shared = Path("../shared/data")
    files = [*bundled_drawings(), *sorted(shared.glob("noto/*.png")), *sorted(shared.glob("gophers/*.png"))]
    drawings = {}
    while True:
        path = files[rng.integers(len(files))]
        if path not in drawings:
            drawings[path] = make_drawing(read_image(path), vertices=700, name=path.stem)
        session = Session(new_document(drawings[path]))
        mesh = session.drawing.mesh
        size = np.ptp(mesh.vertices, axis=0).max()
        session.begin("Drag at random")
        try:
            for face in rng.integers(len(mesh.faces), size=4):
                add_pin(session, tuple(mesh.vertices[mesh.faces[face]].mean(axis=0)))
            for _ in range(4):
                face = mesh.faces[rng.integers(len(mesh.faces))]
                start = session.state.positions[face].mean(axis=0)
                end = start + rng.normal(0, 0.45 * size, 2)
                pin = nearest_pin(session, start)
                for share in np.linspace(0, 1, 16)[1:]:
                    session.apply(SetTargets({pin: tuple(start + share * (end - start))}))
                    session.step()
                    yield session
                for _ in range(25):
                    if session.is_moving:
                        session.step()
                        yield session
        except (InputError, SolverError, AssertionError) as error:
            print(f"{path.stem}: {error}")


def soak(frames: int, seed: int = 1) -> None:
    """Check the laws on random drags and print what broke them."""
    counts = dict.fromkeys(["frames", "overlaps", "seams", "circles", "lost decisions", "long travels"], 0)
    owner: Session | None = None
    before, worst, longest = no_overlaps(next(random_sessions(seed)).drawing.mesh), 0.0, 0.0
    for session in random_sessions(seed):
        mesh, state = session.drawing.mesh, session.state
        if session is not owner:
            before, owner = no_overlaps(mesh), session
        start = time.thread_time()
        after = next_overlaps(mesh, state.positions, before)
        longest = max(longest, time.thread_time() - start)
        counts["frames"] += 1
        if after.levels is not None:
            counts["overlaps"] += 1
            counts["seams"] += after.has_seam
            counts["circles"] += not satisfies(after.levels, *after.low_and_high)
            restored = restored_overlaps(mesh, state.positions, after.crossings)
            counts["lost decisions"] += not np.array_equal(restored.signs, after.signs)
            travel = turned_area(mesh, state.positions, before, after)
            worst = max(worst, travel)
            counts["long travels"] += travel > SEAM_TRAVEL
        before = after
        if counts["frames"] >= frames:
            break
    print(", ".join(f"{count} {name}" for name, count in counts.items()))
    print(
        f"most that turned over at once: {100 * worst:.3f} % of size²; longest frame {1000 * longest:.1f} ms"
    )


def turned_area(mesh: TriMesh, pose: np.ndarray, before: Overlaps, after: Overlaps) -> float:
    """Area of the pairs that turned over from one pose to the next, as a share of size²."""
    m = len(mesh.faces)
    (old_low, old_high), (low, high) = before.low_and_high, after.low_and_high
    turned = np.isin(high.astype(np.int64) * m + low, old_low.astype(np.int64) * m + old_high)
    areas = common_areas(pose, mesh.faces, low[turned], high[turned])
    return float(areas.sum() / np.ptp(mesh.vertices, axis=0).max() ** 2)


def main() -> None:
    """Measure, or soak."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[2000, 10000, 30000])
    parser.add_argument("--soak", type=int, metavar="FRAMES")
    arguments = parser.parse_args()
    if arguments.soak:
        soak(arguments.soak)
    else:
        measure(arguments.sizes)


if __name__ == "__main__":
    main()
