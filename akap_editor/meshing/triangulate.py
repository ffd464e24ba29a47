"""From polygons to a quality mesh, by Triangle (Shewchuk 1996)."""

import atexit
import contextlib
import io
import subprocess
import sys
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from ..errors import InputError
from ..geometry.mesh import TriMesh, signed_areas
from ..geometry.validation import Floats, Ints, as_number
from .outline import Outline
from .triangle_worker import read_message, write_message

TIME_LIMIT = 30.0  # seconds for one run of Triangle
MIN_ANGLE = 28.0  # degrees; Triangle is proven to end up to 20.7 and does so in practice up to 33
FEWEST, MOST = 20, 200_000
COUNT_TOLERANCE = 0.05  # share by which the vertex count may miss what was asked for
MAX_TRIES = 6  # runs of Triangle for one mesh
EDGE_TRIES = 3  # of these with another edge length
COARSER_INSIDE = 2.0  # edges inside are this much longer than at the outline: see docs/meshing.md


def triangulate(parts: Sequence[Outline], vertices: int = 2000) -> TriMesh:
    """A graded Delaunay mesh of polygons with holes, no angle below 28° that the outline does not force.

    parts: polygons that do not touch one another; vertices: the wanted number, reached within a few percent
    unless the outline alone needs more. Raises InputError on unusable outlines, or where Triangle fails.
    """
    as_number(vertices, "vertices", FEWEST, MOST)
    shape = _union(parts)
    corners = sum(len(part.outer) + sum(map(len, part.holes)) for part in parts)
    fit = _EdgeLength(shape.area, shape.length, corners, vertices)
    tries: list[_Try] = []
    edge = fit.edge()
    largest = _face_area(COARSER_INSIDE * edge)
    for number in range(1, MAX_TRIES + 1):
        job = _pslg(parts, shape, edge)
        result = _triangle(job, f"pq{MIN_ANGLE:g}a{largest:.9f}")
        tries.append(_Try(edge, largest, len(job["vertices"]), len(result[0]), result))
        if abs(tries[-1].count - vertices) <= COUNT_TOLERANCE * vertices or largest > shape.area:
            break
        if number < EDGE_TRIES:
            fit.learn(tries[-1].count)
            edge = fit.edge()
            largest = _face_area(COARSER_INSIDE * edge)
        else:  # sides of one length are all cut at once: what no edge length gives, the inside has to
            below = [one for one in tries if one.rim < one.count < vertices]
            if not below:
                break
            near = max(below, key=lambda one: one.count)
            edge = near.edge
            above = [one.largest for one in tries if one.edge == edge and one.count > vertices]
            wanted = near.largest * (near.count - near.rim) / (vertices - near.rim)
            largest = np.sqrt(near.largest * max(above)) if above else max(wanted, near.largest / 3)
    return _mesh(*min(tries, key=lambda one: abs(one.count - vertices)).result)


@dataclass(frozen=True, eq=False)
class _Try:
    """Edge length at the outline, largest face, vertices on the outline before and of all after."""

    edge: float
    largest: float
    rim: int
    count: int
    result: tuple[Floats, Ints]


def _face_area(edge: float) -> float:
    """Area of an equilateral triangle."""
    return float(np.sqrt(3) / 4 * edge**2)


class _EdgeLength:
    """The edge length at the outline that gives the wanted number of vertices.

    Triangle's count was found to be close to a / e² + b / e + c at edge length e, with a from the area, b
    from the length of the outline and c from its corners; each try tells c better.
    The factors belong to `MIN_ANGLE` and `COARSER_INSIDE`.
    """

    def __init__(self, area: float, length: float, corners: int, wanted: int) -> None:
        self._area, self._length, self._wanted = 0.44 * area, 0.8 * length, wanted
        self._constant = min(1.2 * corners, 0.5 * wanted)
        self._longest = 2 * np.sqrt(area)

    def edge(self) -> float:
        """The edge length to try next."""
        rest = max(self._wanted - self._constant, 0.0)
        root = np.sqrt(self._length**2 + 4 * self._area * rest)
        inverse = (root - self._length) / (2 * self._area)
        return float(min(1 / max(inverse, 1e-12 / self._longest), self._longest))

    def learn(self, count: int) -> None:
        """Use that the last try gave ``count`` vertices."""
        edge = self.edge()
        self._constant = count - self._area / edge**2 - self._length / edge


def _union(parts: Sequence[Outline]) -> shapely.Geometry:
    """The parts as one shape. Raises InputError where they are not simple or not apart."""
    if not parts:
        raise InputError("outlines: expected at least one part, got none")
    polygons = [part.polygon for part in parts]
    for polygon in polygons:
        if not polygon.is_valid:
            raise InputError(f"outlines: expected simple polygons, got {shapely.is_valid_reason(polygon)}")
    shape = shapely.union_all(polygons)
    rings = shapely.get_rings(polygons)
    meetings = shapely.STRtree(rings).query(rings, predicate="intersects")
    if meetings.shape[1] > len(rings) or len(shapely.get_parts(shape)) < len(parts):
        raise InputError("outlines: expected parts and holes apart from one another, but some touch")
    return shape


def _mesh(points: Floats, faces: Ints) -> TriMesh:
    """Faces turned to positive area and put in order, vertices that no face uses left out."""
    used, faces = np.unique(faces, return_inverse=True)
    points, faces = points[used], faces.reshape(-1, 3).astype(np.int32)
    flipped = signed_areas(points, faces) < 0
    faces[flipped] = faces[flipped][:, ::-1]
    return TriMesh(points, faces[_limbs_last(points, faces)])


def _limbs_last(points: Floats, faces: Ints) -> Ints:
    """Order of the faces by their way through the drawing from the middle of their part.

    Faces are drawn in their order: where a limb is bent over the body, it passes in front as a whole, which
    an order without meaning would not give.
    """
    i, j = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).T  # each direction of an edge at most once
    lengths = np.linalg.norm(points[i] - points[j], axis=1)
    ways = csr_array((lengths, (i, j)), shape=(len(points), len(points)))
    count, part = connected_components(ways, directed=False)
    middles = []
    for label in range(count):
        members = np.flatnonzero(part == label)
        away = points[members] - points[members].mean(axis=0)
        middles.append(members[np.argmin((away**2).sum(axis=1))])
    way = dijkstra(ways, directed=False, indices=middles, min_only=True)
    return np.argsort(way[faces].mean(axis=1), kind="stable")


def _pslg(parts: Sequence[Outline], shape: shapely.Geometry, edge: float) -> dict[str, np.ndarray]:
    """Triangle's input: points, segments no longer than ``edge``, one point in each hole."""
    rings = [ring for part in parts for ring in (part.outer, *part.holes)]
    points, segments, at = [], [], 0
    for ring in rings:
        line = shapely.segmentize(shapely.LinearRing(ring), edge)
        dense = np.array(line.coords)[:-1]
        index = np.arange(len(dense))
        points.append(dense)
        segments.append(np.stack([index, np.roll(index, -1)], axis=1) + at)
        at += len(dense)
    holes = []
    for part in parts:
        for hole in part.holes:
            for gap in shapely.get_parts(shapely.Polygon(hole).difference(shape)):
                if gap.area > 0:
                    inside = gap.representative_point()
                    holes.append((inside.x, inside.y))
    return {
        "vertices": np.concatenate(points),
        "segments": np.concatenate(segments).astype(np.int32),
        "holes": np.array(holes, dtype=np.float64).reshape(-1, 2),
    }


class _Worker:
    """One warm child process; a job that crashes or hangs ends the child, not the program."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()

    def run(self, job: dict[str, np.ndarray], limit: float) -> dict[str, np.ndarray]:
        with self._lock:
            process = self._start()
            assert isinstance(process.stdin, io.BufferedWriter)
            assert isinstance(process.stdout, io.BufferedReader)
            late = threading.Event()

            def stop() -> None:
                late.set()
                process.kill()

            timer = threading.Timer(limit, stop)
            timer.start()
            try:
                write_message(process.stdin, **job)
                answer = read_message(process.stdout)
            except OSError:
                answer = None
            finally:
                timer.cancel()
            if answer is None:
                self.close()
                reason = f"took longer than {limit:g} s" if late.is_set() else "stopped without an answer"
                raise InputError(f"the outline cannot be triangulated: Triangle {reason}")
            return answer

    def start_worker(self) -> None:
        with self._lock:
            self._start()

    def _start(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            script = Path(__file__).with_name("triangle_worker.py")
            self._process = subprocess.Popen(
                [sys.executable, str(script)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
            )
        return self._process

    def close(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    with contextlib.suppress(OSError):  # what a dead child has not read
                        pipe.close()


_worker = _Worker()


def start_worker() -> None:
    """Start the child process, which takes a moment, without waiting for it."""
    _worker.start_worker()


atexit.register(_worker.close)


def _triangle(job: dict[str, np.ndarray], switches: str, limit: float = TIME_LIMIT) -> tuple[Floats, Ints]:
    if not np.isfinite(job["vertices"]).all():
        raise InputError("outlines: expected finite coordinates")
    answer = _worker.run({**job, "switches": np.array(switches)}, limit)
    if not len(answer["triangles"]) or not np.isfinite(answer["vertices"]).all():
        raise InputError("the outline cannot be triangulated: Triangle returned no faces")
    return answer["vertices"], answer["triangles"]
