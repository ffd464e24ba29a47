"""In-betweens of two poses: every edge turns and grows at a constant rate."""

from collections import OrderedDict
from collections.abc import Callable

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from ..geometry.area_bounds import bound_face_areas, worst_area_factor
from ..geometry.mesh import TriMesh
from ..geometry.operators import to_complex, to_points
from ..geometry.validation import Complexes, Floats, Ints, as_number, as_points
from .cholesky import SparseCholesky, SummedPattern

_STILL = 1e-3  # share of √area: vertices that move less hold a part in place alike
_FULL_TURN = 1e-6  # of a rate s: nearer to a full turn, 1 − eˢ says nothing about a center


class PoseInterpolation:
    """Poses on the way from one pose of a mesh to another.

    Of each edge the quotient of its two directions, as complex numbers, is eˢ, where s says how it grows and
    turns; at time t it is multiplied by eᵗˢ, which is a logarithmic spiral. Positions are fitted to these
    edges by least squares. So a half turn of an arm sweeps an arc, and nothing shrinks on the way. s is known
    up to full turns: neighboring faces turn by nearly the same angle, which carries it through the mesh, also
    beyond half a turn, from the face that turns least. No face shrinks or grows by more than the worst one
    does at either end, where none is flipped there.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh
        n, (i, j) = len(mesh.vertices), mesh.edges.T.astype(np.int64)
        self._start, self._end = i, j
        self._weights = 1.0 / np.abs(self._along(to_complex(mesh.vertices))) ** 2
        _, anchors = np.unique(mesh.component, return_index=True)
        pattern = SummedPattern(np.concatenate([i, j, i, anchors]), np.concatenate([i, j, j, anchors]), n)
        ones = np.full(len(anchors), self._weights.mean())
        entries = np.concatenate([self._weights, self._weights, -self._weights, ones])
        self._laplacian = SparseCholesky(pattern)
        self._laplacian.factorize(pattern.summed(entries))
        e, ends = len(i), np.concatenate([i, j])
        edge, signs = np.tile(np.arange(e), 2), np.repeat([1.0, -1.0], e)
        self._divergence = csr_array((signs * self._weights[edge], (ends, edge)), shape=(n, e))
        degree = np.bincount(ends, minlength=n)
        self._mean = csr_array((1.0 / degree[ends], (ends, edge)), shape=(n, e))
        self._edge_faces, self._neighbors = _adjacency(mesh)

    def between(self, start: Floats, end: Floats) -> Callable[[float], Floats]:
        """The pose (n, 2) at each time from 0, exactly ``start``, to 1, exactly ``end``, both (n, 2).

        Raises InputError for other shapes, and in the function returned for times outside.
        """
        n = len(self._mesh.vertices)
        first, last = as_points(start, "start", n), as_points(end, "end", n)
        a, b = to_complex(first), to_complex(last)
        edges, rates = self._along(a), self._rates(a, b)
        local = self._mean @ rates
        weights = 1.0 / (np.abs(b - a) ** 2 + (_STILL * self._mesh.length) ** 2)
        weights /= np.bincount(self._mesh.component, weights)[self._mesh.component]
        most = max(worst_area_factor(self._mesh, first), worst_area_factor(self._mesh, last))

        def pose(t: float) -> Floats:
            t = as_number(t, "t", 0, 1)
            if t in (0.0, 1.0):
                return first if t == 0.0 else last
            fitted = self._fit(edges * np.exp(t * rates))
            off = weights * (a + (b - a) * _progress(local, t) - fitted)
            shift = np.bincount(self._mesh.component, off.real) + 1j * np.bincount(
                self._mesh.component, off.imag
            )
            made = to_points(fitted + shift[self._mesh.component])
            return bound_face_areas(self._mesh, made, most) if np.isfinite(most) else made

        return pose

    def _along(self, pose: Complexes) -> Complexes:
        return pose[self._start] - pose[self._end]

    def _fit(self, edges: Complexes) -> Complexes:
        """Vertices (n,) whose edges are nearest to ``edges``; where each component is does not matter."""
        right = self._divergence @ edges
        return self._laplacian.solve(right.real.copy()) + 1j * self._laplacian.solve(right.imag.copy())

    def _rates(self, a: Complexes, b: Complexes) -> Complexes:
        """s of each edge, (e,): its growth, and its turn with all full turns."""
        with np.errstate(divide="ignore", invalid="ignore"):
            rates = np.log(self._along(b) / self._along(a))
        rates = np.where(np.isfinite(rates), rates, 0.0)  # an edge without length has no direction
        turns = self._face_turns(a, b)
        expected = 0.5 * (turns[self._edge_faces[0]] + turns[self._edge_faces[1]])
        return rates.real + 1j * (expected + _wrapped(rates.imag - expected))

    def _face_turns(self, a: Complexes, b: Complexes) -> Floats:
        """By how much each face turns, (m,): the angle of the similarity nearest to its map."""
        corners = self._mesh.faces.T
        before, after = a[corners] - a[corners].mean(axis=0), b[corners] - b[corners].mean(axis=0)
        angles = np.angle((before.conj() * after).sum(axis=0))
        if np.abs(angles).max() < np.pi / 2:  # no two of them can differ by half a turn
            return np.asarray(angles)
        left, right = self._neighbors
        jumps = np.abs(_wrapped(angles[right] - angles[left])) + 1e-9  # zero would be no edge of the graph
        m = len(angles)
        tree = minimum_spanning_tree(coo_array((jumps, (left, right)), shape=(m, m)).tocsr())
        turns = angles.copy()
        part = self._mesh.component[corners[0]]
        for number in range(int(part.max()) + 1):
            mine = np.flatnonzero(part == number)
            root = int(mine[np.argmin(np.abs(angles[mine]))])
            order, parents = breadth_first_order(tree, root, directed=False)
            for face, parent in zip(order[1:].tolist(), parents[order[1:]].tolist(), strict=True):
                turns[face] = turns[parent] + _wrapped(angles[face] - turns[parent])
        return turns


class InterpolationCache:
    """In-betweens of many pairs of poses: what a mesh or a pair needs is prepared once, and kept a while."""

    def __init__(self, most: int = 64) -> None:
        self._most = most
        self._inbetween: PoseInterpolation | None = None
        self._mesh: TriMesh | None = None
        self._ways: OrderedDict[tuple[int, int], tuple[Floats, Floats, Callable[[float], Floats]]]
        self._ways = OrderedDict()

    def prepare(self, mesh: TriMesh, start: Floats, end: Floats) -> Callable[[float], Floats]:
        """As `PoseInterpolation.between`. Pairs are told apart by which arrays they are."""
        if self._inbetween is None or mesh is not self._mesh:
            self._mesh, self._inbetween = mesh, PoseInterpolation(mesh)
            self._ways.clear()
        pair = id(start), id(end)
        if pair not in self._ways:
            self._ways[pair] = start, end, self._inbetween.between(start, end)
            if len(self._ways) > self._most:
                self._ways.popitem(last=False)
        self._ways.move_to_end(pair)
        return self._ways[pair][2]

    def pose(self, mesh: TriMesh, start: Floats, end: Floats, t: float) -> Floats:
        """The pose (n, 2) at a time from 0, exactly ``start``, to 1, exactly ``end``, both (n, 2)."""
        return start if t == 0 or start is end else end if t == 1 else self.prepare(mesh, start, end)(t)


def _progress(rates: Complexes, t: float) -> Complexes:
    """(eᵗˢ − 1) / (eˢ − 1): how far on its spiral a point is that arrives at time 1."""
    whole = np.expm1(rates)
    turned = np.abs(whole) > _FULL_TURN
    return np.where(turned, np.expm1(t * rates) / np.where(turned, whole, 1.0), t)


def _wrapped(angle: Floats) -> Floats:
    """The same direction, from −π to π."""
    return np.asarray(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)


def _adjacency(mesh: TriMesh) -> tuple[Ints, Ints]:
    """The faces of each edge, (2, e), one twice at the boundary; and the pairs among them, (2, q)."""
    n, m = len(mesh.vertices), len(mesh.faces)
    half = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1)
    keys = mesh.edges.astype(np.int64) @ [n, 1]
    edge = np.searchsorted(keys, half @ [n, 1])
    face = np.repeat(np.arange(m), 3)
    faces = np.full((2, len(keys)), -1, dtype=np.int64)
    faces[0, edge] = face  # the last face of each edge ...
    first = np.full(len(keys), -1, dtype=np.int64)
    first[edge[::-1]] = face[::-1]  # ... and its first
    faces[1] = first
    return faces, faces[:, faces[0] != faces[1]]
