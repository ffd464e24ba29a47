"""Trajectories of a vector field along logarithmic spirals (paper, section 2.3)."""

import numpy as np

from ...geometry.jit import compiled
from ...geometry.mesh import TriMesh
from ...geometry.validation import Complexes, Indices

_SERIES_BELOW = 0.25  # |s| below which φ(s) is computed by its series
_ROUNDING = 1e-17  # terms of the series below this are left out
_BLOCK = 1024  # rates whose series are summed together, so that they stay in the fastest cache


@compiled
def spiral_factor(s: Complexes) -> Complexes:
    """φ(s) = (eˢ − 1) / s, φ(0) = 1, for rates s (e,): with velocity u, a spiral of rate s moves by φ(s) u.

    Small rates, the usual ones in a substep, use as many terms of Σ sᵏ / (k + 1)! as the largest one needs.
    """
    largest, has_large = 0.0, False
    for rate in s:
        size = rate.real * rate.real + rate.imag * rate.imag
        if size < _SERIES_BELOW**2:
            largest = max(largest, size)
        else:
            has_large = True
    largest = np.sqrt(largest)
    terms, term = 1, largest / 2
    while term > _ROUNDING:
        terms += 1
        term *= largest / (terms + 1)
    result = np.empty_like(s)
    for begin in range(0, len(s), _BLOCK):
        _sum_series(s[begin : begin + _BLOCK], terms, result[begin : begin + _BLOCK])
    if has_large:
        for e in range(len(s)):
            if not s[e].real * s[e].real + s[e].imag * s[e].imag < _SERIES_BELOW**2:
                result[e] = (np.exp(s[e]) - 1.0) / s[e]
    return result


@compiled
def _sum_series(s: Complexes, terms: int, result: Complexes) -> None:
    """The first ``terms`` of Σ sᵏ / (k + 1)! by Horner's rule; vectorized, since all s advance together."""
    count = len(s)
    x, y, real, imaginary = np.empty(count), np.empty(count), np.ones(count), np.zeros(count)
    for e in range(count):
        x[e], y[e] = s[e].real, s[e].imag
    for k in range(terms, 1, -1):
        inverse = 1.0 / k
        for e in range(count):
            a, b = real[e], imaginary[e]
            real[e] = (a * x[e] - b * y[e]) * inverse + 1.0
            imaginary[e] = (a * y[e] + b * x[e]) * inverse
    for e in range(count):
        result[e] = complex(real[e], imaginary[e])


class LogSpirals:
    """Moves the vertices of a mesh along the averaged spirals of eq. 16.

    Eqs. 14 and 15 are computed without a center: with s = (u₁ − u₂) / (p₁ − p₂) for an edge, the flow is
    γ(t) = p + t φ(t s) u for spirals (s ≠ 0) and translations (s = 0) alike. Since p and u do not depend on
    the neighbor, eq. 16 is p + t u · mean φ(t s), the mean over the edges of the vertex.
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._edges = mesh.edges.astype(np.uint32)
        self._inverse_degree = 1.0 / np.bincount(mesh.edges.ravel(), minlength=len(mesh.vertices))

    def flow(self, positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
        """The pose (n,) at time ``t``, from ``positions`` (n,) at time 0 with velocities ``field`` (n,)."""
        displacements = t * field
        factors = spiral_factor(_rates(self._edges, positions, displacements))
        sums = _sum_at_ends(self._edges, factors, len(positions))
        return positions + displacements * (self._inverse_degree * sums)


@compiled
def _rates(edges: Indices, positions: Complexes, displacements: Complexes) -> Complexes:
    """The rate s of each edge, (e,)."""
    result = np.empty(len(edges), dtype=np.complex128)
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        d, u = positions[i] - positions[j], displacements[i] - displacements[j]
        square = d.real * d.real + d.imag * d.imag
        result[e] = complex(u.real * d.real + u.imag * d.imag, u.imag * d.real - u.real * d.imag) / square
    return result


@compiled
def _sum_at_ends(edges: Indices, values: Complexes, count: int) -> Complexes:
    """The sum at each of ``count`` vertices of the values (e,) of its edges."""
    result = np.zeros(count, dtype=np.complex128)
    for e in range(len(edges)):
        result[edges[e, 0]] += values[e]
        result[edges[e, 1]] += values[e]
    return result


def linear_flow(positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
    """Straight steps in place of spirals (Fig. 5): γ(t) = p + t u; arguments as in `LogSpirals.flow`."""
    return positions + t * field
