"""Trajectories of a vector field along logarithmic spirals (paper, section 2.3)."""

import numpy as np

from ...geometry.jit import compiled
from ...geometry.mesh import TriMesh
from ...geometry.validation import Complexes, Floats, Indices

_SERIES_BELOW = 0.25  # |s| below which φ(s) is computed by its series
_ROUNDING = 1e-17  # terms of the series below this are left out
_BLOCK = 512  # edges whose series are summed together, so that they stay in the fastest cache


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
        return _follow(self._edges, self._inverse_degree, positions, t * field)


def linear_flow(positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
    """Straight steps in place of spirals (Fig. 5): γ(t) = p + t u; arguments as in `LogSpirals.flow`."""
    return positions + t * field


@compiled
def spiral_factor(s: Complexes) -> Complexes:
    """φ(s) = (eˢ − 1) / s, φ(0) = 1, for rates s (e,): a spiral of rate s with velocity u moves by φ(s) u."""
    result = np.empty_like(s)
    x, y, real, imaginary = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for begin in range(0, len(s), _BLOCK):
        count = min(_BLOCK, len(s) - begin)
        for e in range(count):
            x[e], y[e] = s[begin + e].real, s[begin + e].imag
        _spiral_factors(x, y, count, real, imaginary)
        for e in range(count):
            result[begin + e] = complex(real[e], imaginary[e])
    return result


@compiled
def _follow(
    edges: Indices, inverse_degree: Floats, positions: Complexes, displacements: Complexes
) -> Complexes:
    """The positions (n,) that displacements (n,) lead to along the averaged spirals."""
    sums = np.zeros_like(positions)
    x, y, real, imaginary = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for begin in range(0, len(edges), _BLOCK):
        count = min(_BLOCK, len(edges) - begin)
        for e in range(count):
            i, j = edges[begin + e, 0], edges[begin + e, 1]
            d, u = positions[i] - positions[j], displacements[i] - displacements[j]
            x[e], y[e] = u.real * d.real + u.imag * d.imag, u.imag * d.real - u.real * d.imag
            real[e] = d.real * d.real + d.imag * d.imag
        for e in range(count):
            inverse = 1 / real[e]
            x[e] *= inverse
            y[e] *= inverse
        _spiral_factors(x, y, count, real, imaginary)
        for e in range(count):
            factor = complex(real[e], imaginary[e])
            sums[edges[begin + e, 0]] += factor
            sums[edges[begin + e, 1]] += factor
    for i in range(len(positions)):
        sums[i] = positions[i] + displacements[i] * (inverse_degree[i] * sums[i])
    return sums


@compiled
def _spiral_factors(x: Floats, y: Floats, count: int, real: Floats, imaginary: Floats) -> None:
    """Set ``real`` and ``imaginary`` to φ of the first ``count`` rates x + i y; at most a block.

    Small rates, the usual ones in a substep, are summed by Horner's rule with as many terms of
    Σ sᵏ / (k + 1)! as the largest one needs. These loops are vectorized, since all rates advance together.
    """
    largest, has_large = 0.0, False
    for e in range(count):
        square = x[e] * x[e] + y[e] * y[e]
        if square < _SERIES_BELOW**2:
            largest = max(largest, square)
        else:
            has_large = True
    largest = np.sqrt(largest)
    terms, term = 1, largest / 2
    while term > _ROUNDING:
        terms += 1
        term *= largest / (terms + 1)
    for e in range(count):
        real[e], imaginary[e] = 1.0, 0.0
    for k in range(terms, 1, -1):
        inverse = 1.0 / k
        for e in range(count):
            a, b = real[e], imaginary[e]
            real[e] = (a * x[e] - b * y[e]) * inverse + 1.0
            imaginary[e] = (a * y[e] + b * x[e]) * inverse
    if has_large:
        for e in range(count):
            if not x[e] * x[e] + y[e] * y[e] < _SERIES_BELOW**2:
                rate = complex(x[e], y[e])
                value = (np.exp(rate) - 1.0) / rate
                real[e], imaginary[e] = value.real, value.imag
