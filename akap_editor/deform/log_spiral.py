"""Logarithmic-spiral trajectories of a vector field (paper, section 2.3)."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..geometry.checks import Complexes
from ..geometry.mesh import TriMesh

_SERIES_BELOW = 0.25
_ROUNDING = 1e-17


def spiral_factor(s: Complexes) -> Complexes:
    """φ(s) = (eˢ − 1) / s with φ(0) = 1: a point with velocity u on a spiral of rate s moves by φ(s) u.

    Where all rates are small, as they are in a substep, by as many terms of Σ sᵏ / (k + 1)! as count.
    """
    largest = float(np.abs(s).max(initial=0.0))
    if largest > _SERIES_BELOW:
        small = np.abs(s) < _SERIES_BELOW
        return np.where(small, _series(np.where(small, s, 0.0), _SERIES_BELOW), _closed(s, small))
    return _series(s, largest)


def _closed(s: Complexes, small: NDArray[np.bool_]) -> Complexes:
    safe = np.where(small, 1.0, s)
    return np.asarray(np.expm1(safe) / safe, dtype=np.complex128)


def _series(s: Complexes, largest: float) -> Complexes:
    """Horner's rule, with terms up to the last that rounding does not swallow."""
    count, term = 1, largest / 2
    while term > _ROUNDING:
        count += 1
        term *= largest / (count + 1)
    result = np.ones_like(s)
    for k in range(count, 1, -1):
        result *= s
        result *= 1.0 / k
        result += 1.0
    return result


class LogSpirals:
    """Moves the vertices of a mesh along the averaged spirals of eq. 16.

    Eqs. 14 and 15 in one formula that needs no center: with s = (u1 − u2) / (p1 − p2) for an edge, the flow
    is γ(t) = p + t φ(t s) u, for spirals (s ≠ 0) and translations (s = 0) alike. Since p and u do not depend
    on the neighbor, eq. 16 is p + t u · mean φ(t s).
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._start, self._end = mesh.edges.T
        e, n = len(self._start), len(mesh.vertices)
        ends = mesh.edges.T.ravel()
        degree = np.bincount(ends, minlength=n)
        edge = np.tile(np.arange(e), 2)
        # Complex, as the factors are: a mixed product would be slower.
        self._mean = csr_array((1.0 / degree[ends] + 0j, (ends, edge)), shape=(n, e))

    def flow(self, positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
        """Where the vertices (n,) are at time ``t`` (1: the whole step) if they start with ``field`` (n,)."""
        i, j = self._start, self._end
        s = t * (field[i] - field[j]) / (positions[i] - positions[j])
        return positions + t * field * (self._mean @ spiral_factor(s))


def linear_flow(positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
    """The straight steps that spirals replace: γ(t) = p + t u (Fig. 5)."""
    return positions + t * field
