"""Logarithmic-spiral trajectories of a vector field (paper, section 2.3)."""

import numpy as np

from ...geometry.jit import compiled
from ...geometry.mesh import TriMesh
from ...geometry.validation import Complexes, Ints

_SERIES_BELOW = 0.25
_ROUNDING = 1e-17


@compiled
def spiral_factor(s: Complexes) -> Complexes:
    """φ(s) = (eˢ − 1) / s with φ(0) = 1: a point with velocity u on a spiral of rate s moves by φ(s) u.

    s: (e,). Small rates, as they are in a substep, by as many terms of Σ sᵏ / (k + 1)! as the largest needs.
    """
    largest = 0.0
    for rate in s:
        size = rate.real * rate.real + rate.imag * rate.imag
        if largest < size < _SERIES_BELOW**2:
            largest = size
    largest = np.sqrt(largest)
    terms, term = 1, largest / 2
    while term > _ROUNDING:
        terms += 1
        term *= largest / (terms + 1)
    shares = 1.0 / np.arange(1.0, terms + 1.0)
    result = np.empty_like(s)
    for e in range(len(s)):
        x, y = s[e].real, s[e].imag
        if x * x + y * y < _SERIES_BELOW**2:
            real, imaginary = 1.0, 0.0
            for k in range(terms - 1, 0, -1):  # Horner's rule
                real, imaginary = (
                    (real * x - imaginary * y) * shares[k] + 1.0,
                    (real * y + imaginary * x) * shares[k],
                )
            result[e] = complex(real, imaginary)
        else:
            result[e] = (np.exp(s[e]) - 1.0) / s[e]
    return result


class LogSpirals:
    """Moves the vertices of a mesh along the averaged spirals of eq. 16.

    Eqs. 14 and 15 in one formula that needs no center: with s = (u1 − u2) / (p1 − p2) for an edge, the flow
    is γ(t) = p + t φ(t s) u, for spirals (s ≠ 0) and translations (s = 0) alike. Since p and u do not depend
    on the neighbor, eq. 16 is p + t u · mean φ(t s).
    """

    def __init__(self, mesh: TriMesh) -> None:
        self._edges = mesh.edges.copy()
        self._shares = 1.0 / np.bincount(mesh.edges.ravel(), minlength=len(mesh.vertices))

    def flow(self, positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
        """Where the vertices (n,) are at time ``t`` (1: the whole step) if they start with ``field`` (n,)."""
        moves = t * field
        factors = spiral_factor(_rates(self._edges, positions, moves))
        return positions + moves * (self._shares * _sums_at_ends(self._edges, factors, len(positions)))


@compiled
def _rates(edges: Ints, positions: Complexes, moves: Complexes) -> Complexes:
    result = np.empty(len(edges), dtype=np.complex128)
    for e in range(len(edges)):
        i, j = edges[e, 0], edges[e, 1]
        d, u = positions[i] - positions[j], moves[i] - moves[j]
        size = d.real * d.real + d.imag * d.imag
        result[e] = complex(u.real * d.real + u.imag * d.imag, u.imag * d.real - u.real * d.imag) / size
    return result


@compiled
def _sums_at_ends(edges: Ints, values: Complexes, count: int) -> Complexes:
    result = np.zeros(count, dtype=np.complex128)
    for e in range(len(edges)):
        result[edges[e, 0]] += values[e]
        result[edges[e, 1]] += values[e]
    return result


def linear_flow(positions: Complexes, field: Complexes, t: float = 1.0) -> Complexes:
    """The straight steps that spirals replace: γ(t) = p + t u (Fig. 5)."""
    return positions + t * field
