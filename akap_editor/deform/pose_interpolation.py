"""Interpolation of two poses: every edge rotates and grows at a constant rate."""

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
from .dissection import dissect

_STATIONARY = 1e-3  # share of √area: vertices that move less count as stationary, all with the same weight
_NO_CENTER = 1e-6  # |1 − eˢ| below which s is a translation, up to full turns: no center to rotate about


class PoseInterpolation:
    """Interpolates poses of a mesh along logarithmic spirals, so that a rotating arm sweeps an arc.

    The quotient of an edge at the end and at the start, as complex numbers, is eˢ: the real part of s is its
    growth, the imaginary part its rotation. At time t the edge is multiplied by eᵗˢ, and positions are fitted
    to all edges by least squares. s is known up to full turns only: since neighboring faces rotate by nearly
    the same angle, the number of turns is carried through each component from the face that rotates least.
    If no face is flipped in either pose, none grows or shrinks by more than the worst one does there.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._mesh = mesh
        n, (i, j) = len(mesh.vertices), mesh.edges.T.astype(np.int64)
        self._start, self._end = i, j
        self._weights = 1.0 / np.abs(self._edges_of(to_complex(mesh.vertices))) ** 2
        _, anchors = np.unique(mesh.component, return_index=True)
        pattern = SummedPattern(np.concatenate([i, j, i, anchors]), np.concatenate([i, j, j, anchors]), n)
        anchor_weights = np.full(len(anchors), self._weights.mean())
        entries = np.concatenate([self._weights, self._weights, -self._weights, anchor_weights])
        self._laplacian = SparseCholesky(pattern, dissect(mesh.vertices, mesh.edges))
        self._laplacian.factorize(pattern.sum_entries(entries))
        e, ends = len(i), np.concatenate([i, j])  # number of edges, and the vertices they end at
        edge, signs = np.tile(np.arange(e), 2), np.repeat([1.0, -1.0], e)
        self._divergence = csr_array((signs * self._weights[edge], (ends, edge)), shape=(n, e))
        degree = np.bincount(ends, minlength=n)
        self._mean = csr_array((1.0 / degree[ends], (ends, edge)), shape=(n, e))
        self._edge_faces, self._neighbors = _adjacency(mesh)

    def between(self, start: Floats, end: Floats) -> Callable[[float], Floats]:
        """A function of time from 0 to 1 that returns the pose (n, 2) between ``start`` and ``end``, (n, 2).

        At 0 and 1 it returns exactly these poses; from -1 to 0 and from 1 to 2 it goes on beyond them. Raises
        InputError for other shapes, and in the function for a time out of range.
        """
        n = len(self._mesh.vertices)
        first, last = as_points(start, "start", n), as_points(end, "end", n)
        a, b = to_complex(first), to_complex(last)
        edges, rates = self._edges_of(a), self._rates(a, b)
        vertex_rates = self._mean @ rates
        weights = 1.0 / (np.abs(b - a) ** 2 + (_STATIONARY * self._mesh.length) ** 2)
        weights /= np.bincount(self._mesh.component, weights)[self._mesh.component]
        max_factor = max(worst_area_factor(self._mesh, first), worst_area_factor(self._mesh, last))

        def pose(t: float) -> Floats:
            t = as_number(t, "t", -1, 2)
            if t in (0.0, 1.0):
                return first if t == 0.0 else last
            bound = max_factor ** (1 + 2 * max(-t, t - 1, 0.0))
            fitted = self._fit(edges * np.exp(t * rates))
            offsets = weights * (a + (b - a) * _progress(vertex_rates, t) - fitted)
            component = self._mesh.component
            shift = np.bincount(component, offsets.real) + 1j * np.bincount(component, offsets.imag)
            placed = to_points(fitted + shift[component])
            return bound_face_areas(self._mesh, placed, bound) if np.isfinite(bound) else placed

        return pose

    def _edges_of(self, pose: Complexes) -> Complexes:
        """The edges (e,) of a pose (n,) as complex numbers."""
        return pose[self._start] - pose[self._end]

    def _fit(self, edges: Complexes) -> Complexes:
        """The vertices (n,) whose edges are nearest to ``edges`` (e,); each component may be anywhere."""
        right = self._divergence @ edges
        return self._laplacian.solve(right.real.copy()) + 1j * self._laplacian.solve(right.imag.copy())

    def _rates(self, a: Complexes, b: Complexes) -> Complexes:
        """s of each edge, (e,), full turns included, from the pose a (n,) to the pose b (n,)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            rates = np.log(self._edges_of(b) / self._edges_of(a))
        rates = np.where(np.isfinite(rates), rates, 0.0)  # an edge without length has no direction
        rotations = self._face_rotations(a, b)
        expected = 0.5 * (rotations[self._edge_faces[0]] + rotations[self._edge_faces[1]])
        return rates.real + 1j * (expected + _wrap_angle(rates.imag - expected))

    def _face_rotations(self, a: Complexes, b: Complexes) -> Floats:
        """The rotation of each face, (m,) radians, full turns included.

        It is the angle of the similarity nearest to the map of the face from the pose a to the pose b.
        """
        corners = self._mesh.faces.T
        before, after = a[corners] - a[corners].mean(axis=0), b[corners] - b[corners].mean(axis=0)
        angles = np.angle((before.conj() * after).sum(axis=0))
        if np.abs(angles).max() < np.pi / 2:  # no two faces can differ by half a turn
            return np.asarray(angles)
        left, right = self._neighbors
        jumps = np.abs(_wrap_angle(angles[right] - angles[left])) + 1e-9  # a sparse graph has no edges of 0
        m = len(angles)
        tree = minimum_spanning_tree(coo_array((jumps, (left, right)), shape=(m, m)).tocsr())
        rotations = angles.copy()
        component = self._mesh.component[corners[0]]
        for number in range(int(component.max()) + 1):
            faces = np.flatnonzero(component == number)
            root = int(faces[np.argmin(np.abs(angles[faces]))])
            order, parents = breadth_first_order(tree, root, directed=False)
            for face, parent in zip(order[1:].tolist(), parents[order[1:]].tolist(), strict=True):
                rotations[face] = rotations[parent] + _wrap_angle(angles[face] - rotations[parent])
        return rotations


class InterpolationCache:
    """Interpolates many pairs of poses, and keeps what was prepared for the last mesh and the last pairs.

    max_pairs: number of pairs to keep.
    """

    def __init__(self, max_pairs: int = 64) -> None:
        self._max_pairs = max_pairs
        self._interpolation: PoseInterpolation | None = None
        self._mesh: TriMesh | None = None
        self._pairs: OrderedDict[tuple[int, int], tuple[Floats, Floats, Callable[[float], Floats]]]
        self._pairs = OrderedDict()

    def prepare(self, mesh: TriMesh, start: Floats, end: Floats) -> Callable[[float], Floats]:
        """As `PoseInterpolation.between`; poses are compared by identity."""
        if self._interpolation is None or mesh is not self._mesh:
            self._mesh, self._interpolation = mesh, PoseInterpolation(mesh)
            self._pairs.clear()
        pair = id(start), id(end)
        if pair not in self._pairs:
            self._pairs[pair] = start, end, self._interpolation.between(start, end)
            if len(self._pairs) > self._max_pairs:
                self._pairs.popitem(last=False)
        self._pairs.move_to_end(pair)
        return self._pairs[pair][2]

    def pose(self, mesh: TriMesh, start: Floats, end: Floats, t: float) -> Floats:
        """The pose (n, 2) at time ``t``; at 0 ``start`` (n, 2) itself, at 1 ``end`` (n, 2) itself."""
        return start if t == 0 or start is end else end if t == 1 else self.prepare(mesh, start, end)(t)


def _progress(rates: Complexes, t: float) -> Complexes:
    """(eᵗˢ − 1) / (eˢ − 1): the share of its way on a spiral of rate s that a point has moved at time t."""
    total = np.expm1(rates)
    has_center = np.abs(total) > _NO_CENTER
    return np.where(has_center, np.expm1(t * rates) / np.where(has_center, total, 1.0), t)


def _wrap_angle(angle: Floats) -> Floats:
    """The angle of the same direction from −π to π."""
    return np.asarray(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)


def _adjacency(mesh: TriMesh) -> tuple[Ints, Ints]:
    """The two faces of each edge, (2, e), equal on the boundary; and the pairs of different ones, (2, q)."""
    n, m = len(mesh.vertices), len(mesh.faces)
    half_edges = np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1)
    keys = mesh.edges.astype(np.int64) @ [n, 1]
    edge = np.searchsorted(keys, half_edges @ [n, 1])
    face = np.repeat(np.arange(m), 3)
    faces = np.full((2, len(keys)), -1, dtype=np.int64)
    faces[0, edge] = face  # of repeated indices, numpy keeps the last
    first = np.full(len(keys), -1, dtype=np.int64)
    first[edge[::-1]] = face[::-1]
    faces[1] = first
    return faces, faces[:, faces[0] != faces[1]]
