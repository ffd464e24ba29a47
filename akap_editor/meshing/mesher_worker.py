"""Runs a mesher in a process of its own, because bad input can crash it or make it loop forever.

`mesher_process` starts this file as a script. It reads jobs from stdin and answers on stdout; each message is
an .npz archive after its length in eight bytes. It imports nothing of the package, so that it starts fast.
"""

import io
import math
import os
import struct
import sys
from functools import cache
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Graph = dict[str, NDArray[Any]]

_ON_LINE = 1e-6  # pixels
_FRAME = ((False, False), (True, False), (True, True), (False, True))  # whether right, whether below
_MAX_INSERTED = 1_000_000  # vertices; the process is ended long before


def read_message(stream: BinaryIO) -> Graph | None:
    """Read the next message; None at the end of the stream."""
    head = stream.read(8)
    if len(head) < 8:
        return None
    (length,) = struct.unpack("<Q", head)
    body = stream.read(length)
    if len(body) < length:
        return None
    with np.load(io.BytesIO(body), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def write_message(stream: BinaryIO, **arrays: NDArray[Any]) -> None:
    """Write named arrays as one message."""
    body = io.BytesIO()
    np.savez(body, **arrays)  # type: ignore[arg-type]
    stream.write(struct.pack("<Q", body.tell()) + body.getvalue())
    stream.flush()


def main() -> None:
    """Answer jobs until stdin closes."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a mesher prints must not mix with the answers
    while (job := read_message(sys.stdin.buffer)) is not None:
        mesher = _MESHERS[str(job.pop("mesher"))]
        min_angle, max_area, most = (job.pop(name).item() for name in ("min_angle", "max_area", "most"))
        vertices, triangles = mesher(job, min_angle, max_area, most)
        write_message(answers, vertices=vertices, triangles=triangles)


def _triangle(graph: Graph, min_angle: float, max_area: float, most: int) -> tuple[Floats, Ints]:
    """Mesh a graph with Triangle (Shewchuk 1996); ``most`` has no effect, because it needs few vertices."""
    import triangle

    graph.pop("slits", None)
    if not len(graph["holes"]):
        del graph["holes"]
    mesh = triangle.triangulate(graph, f"pq{min_angle:g}a{max_area:.9f}")
    vertices = np.asarray(mesh["vertices"], dtype=np.float64).reshape(-1, 2)
    return vertices, np.asarray(mesh.get("triangles", []), dtype=np.int32).reshape(-1, 3)


def _pythoncdt(graph: Graph, min_angle: float, max_area: float, most: int) -> tuple[Floats, Ints]:
    """Mesh a graph with PythonCDT; removes vertices that it inserted as long as there are over ``most``."""
    import pythoncdt as cdt

    outline = np.asarray(graph["vertices"], dtype=np.float64)
    low, high = outline.min(axis=0), outline.max(axis=0)
    margin = np.abs(high - low).max() / 2
    # Corners of a frame keep the triangles outside so round that new vertices on the outline stay on it. They
    # come last and are dropped with the outside.
    frame = np.where(_FRAME, high + margin, low - margin)
    mesh = cdt.Triangulation(cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0)
    mesh.insert_vertices(np.concatenate([outline, frame]))
    mesh.insert_edges(graph["segments"].astype(np.uint32))
    slits = graph["segments"][graph["slits"]] if "slits" in graph else np.zeros((0, 2), np.int32)
    outside = mesh.collect_outer_triangles_and_holes() if not len(slits) else _outside(mesh, graph)
    # Small faces have fewer bad angles: area first needs fewer vertices, and the angles are right in the end.
    mesh.refine_triangles(_MAX_INSERTED, cdt.RefinementCriterion.LARGEST_AREA, max_area, outside)
    angle = cdt.deg_to_rad(min_angle)
    mesh.refine_triangles(_MAX_INSERTED, cdt.RefinementCriterion.SMALLEST_ANGLE, angle, outside)
    mesh.finalize_triangulation(outside)
    points, faces = mesh.vertices_array(), mesh.triangles_array()["vertices"].astype(np.int32)
    vertices: Floats = np.stack([points["x"], points["y"]], axis=1)
    if len(np.unique(faces)) > most:
        faces = _Thinning(vertices, faces, _on_segments(vertices, outline, slits)).run(
            len(outline), most, min_angle
        )
    used, index = np.unique(faces, return_inverse=True)
    return vertices[used], index.reshape(-1, 3).astype(np.int32)


def _outside(mesh: Any, graph: Graph) -> set[int]:
    """The triangles outside the outline and in its holes.

    A ray from there crosses the outline an even number of times. The mesher itself would count slits, too.
    """
    points = mesh.vertices_array()
    places = np.stack([points["x"], points["y"]], axis=1)
    x, y = places[mesh.triangles_array()["vertices"]].mean(axis=1).T
    is_inside = np.zeros(len(x), dtype=bool)
    for (ax, ay), (bx, by) in graph["vertices"][graph["segments"][~graph["slits"]]]:
        if ay != by:
            crossed = np.flatnonzero((y >= min(ay, by)) & (y < max(ay, by)))
            is_right = ax + (y[crossed] - ay) / (by - ay) * (bx - ax) > x[crossed]
            is_inside[crossed[is_right]] ^= True
    return set(np.flatnonzero(~is_inside).tolist())


def _on_segments(points: Floats, corners: Floats, segments: NDArray[Any]) -> set[int]:
    """The points (p, 2) on segments (s, 2) between corners."""
    found: set[int] = set()
    for start, end in corners[segments]:
        along, offset = end - start, points - start
        distance = np.abs(along[0] * offset[:, 1] - along[1] * offset[:, 0]) / np.hypot(*along)
        share = offset @ along / (along @ along)
        found.update(np.flatnonzero((distance < _ON_LINE) & (share > 0) & (share < 1)).tolist())
    return found


@cache
def _sides(count: int) -> NDArray[np.uint32]:
    """(count, 2) the corners of each side of a polygon; cached, because a mesh needs thousands of them."""
    index = np.arange(count, dtype=np.uint32)
    return np.stack([index, np.roll(index, -1)], axis=1)


class _Thinning:
    """Removes vertices from a constrained Delaunay mesh, which stays one.

    A removed vertex leaves a star-shaped polygon, and the constrained Delaunay triangulation of that polygon
    takes the place of its faces. vertices: (n, 2); faces: (m, 3); fixed: vertices that stay.
    """

    def __init__(self, vertices: Floats, faces: Ints, fixed: set[int]) -> None:
        self._fixed = fixed
        self._vertices = vertices
        self._places = [complex(x, y) for x, y in vertices.tolist()]
        self._next_number = len(faces)
        self._faces = {number: tuple(face) for number, face in enumerate(faces.tolist())}
        self._cotangents = {number: self._cotangent(face) for number, face in self._faces.items()}
        self._star: dict[int, set[int]] = {}  # the faces of each vertex
        for number, face in self._faces.items():
            for vertex in face:
                self._star.setdefault(vertex, set()).add(number)

    def run(self, first: int, most: int, min_angle: float) -> Ints:
        """Remove vertices, the last first and none before ``first``, until ``most`` are left; return faces.

        None is removed whose polygon would get an angle below both ``min_angle``, in degrees, and the
        smallest one there before.
        """
        limit = 1 / math.tan(math.radians(min_angle))
        candidates = {vertex for vertex in self._star if vertex >= first} - self._fixed
        while candidates:
            changed: set[int] = set()
            for vertex in sorted(candidates, reverse=True):
                if len(self._star) <= most:
                    return self._all_faces()
                changed.update(self._remove(vertex, limit))
            changed -= self._fixed
            candidates = {vertex for vertex in changed if vertex >= first and vertex in self._star}
        return self._all_faces()

    def _all_faces(self) -> Ints:
        return np.array(list(self._faces.values()), dtype=np.int32)

    def _remove(self, vertex: int, limit: float) -> list[int]:
        """Remove a vertex if the angles allow it; return the vertices around it, none if they do not.

        limit: cotangent of the smallest allowed angle.
        """
        star = self._star[vertex]
        rim = self._rim(vertex, [self._faces[number] for number in star])
        limit = max(limit, *(self._cotangents[number] for number in star))
        new: dict[tuple[int, ...], float] = {}
        for face in self._fill(rim):
            new[face] = self._cotangent(face)
            if new[face] > limit:
                return []
        if not new:
            return []
        for number in self._star.pop(vertex):
            del self._cotangents[number]
            for corner in self._faces.pop(number):
                if corner != vertex:
                    self._star[corner].discard(number)
        for face, cotangent in new.items():
            self._faces[self._next_number], self._cotangents[self._next_number] = face, cotangent
            for corner in face:
                self._star[corner].add(self._next_number)
            self._next_number += 1
        return rim

    def _rim(self, vertex: int, star: list[tuple[int, ...]]) -> list[int]:
        """The polygon around a vertex; at a vertex on the outline it runs along the outline there."""
        following = {}
        for face in star:
            place = face.index(vertex)
            following[face[(place + 1) % 3]] = face[(place + 2) % 3]
        at = next(iter(set(following) - set(following.values())), next(iter(following)))
        rim = [at]
        while at in following and (at := following[at]) != rim[0]:
            rim.append(at)
        return rim

    def _fill(self, rim: list[int]) -> list[tuple[int, ...]]:
        """The constrained Delaunay faces of a polygon."""
        import pythoncdt as cdt

        mesh = cdt.Triangulation(
            cdt.VertexInsertionOrder.AS_PROVIDED, cdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
        )
        mesh.insert_vertices(np.ascontiguousarray(self._vertices[rim]))
        mesh.insert_edges(_sides(len(rim)))
        mesh.erase_outer_triangles()
        faces = mesh.triangles_array()["vertices"].tolist()
        return [tuple(rim[corner] for corner in face) for face in faces] if len(faces) == len(rim) - 2 else []

    def _cotangent(self, face: tuple[int, ...]) -> float:
        """The cotangent of the smallest angle of a face, infinite if it is flipped or has no area.

        Without numpy, which is slow for so few numbers.
        """
        a, b, c = (self._places[vertex] for vertex in face)
        double_area = ((b - a).conjugate() * (c - a)).imag
        if double_area <= 0:
            return math.inf
        # The products of the two sides at each corner are the cosine of its angle times their lengths.
        at_a, at_b = ((b - a).conjugate() * (c - a)).real, ((c - b).conjugate() * (a - b)).real
        at_c = ((a - c).conjugate() * (b - c)).real
        return max(at_a, at_b, at_c) / double_area


_MESHERS = {"triangle": _triangle, "pythoncdt": _pythoncdt}

if __name__ == "__main__":
    main()
