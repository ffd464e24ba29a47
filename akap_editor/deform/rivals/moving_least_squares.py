"""Moving least squares: Schaefer, McPhail and Warren 2006, "Image Deformation Using Moving Least Squares".

Each vertex v is moved by the transform that fits the pins best in the sense of least squares: a pin p at rest
with its target q has the weight w = 1 / |p − v|^2α (eq. 1). All such transforms take the weighted mean p* of
the pins to that of their targets, q*. With points as complex numbers, u = v − p*, p̂ = p − p*, μ = Σ w |p̂|²
and τ = Σ w p̂², v moves to q* plus

    f = u S / μ with S = Σ w conj(p̂) q          similarity (section 2.2)
    |u| f / |f|                                  rigid (section 2.3)
    a u + b conj(u)                              affine (section 2.1)

where a μ + b conj(τ) = S and a τ + b μ = Σ w p̂ q.
"""

from typing import Literal

import numpy as np

from ...geometry.mesh import TriMesh
from ...geometry.validation import Complexes, Floats, as_choice, as_number
from .rest_based import RestBasedDeformer, product

Transform = Literal["rigid", "similarity", "affine"]

_COLLINEAR = 1e-6  # 1 − |τ/μ|², nearly 4 (width / length)², below which pins are on a line


class MovingLeastSquaresDeformer(RestBasedDeformer):
    """Moving least squares (Schaefer, McPhail and Warren 2006); each component has its own pins.

    mesh: the rest pose.
    transform: "rigid", "similarity" or "affine"; alpha: the exponent α of the weights.
    The map takes every pin to its target but is evaluated at the vertices: a pin at a vertex arrives exactly,
    a pin inside a face up to the error of linear interpolation. Pins on a line get a similarity instead of an
    affine map, pins at one place a translation. The result does not depend on the current pose. Faces may
    flip.
    Raises InputError for arguments out of range.
    """

    def __init__(self, mesh: TriMesh, transform: Transform = "rigid", alpha: float = 1.0) -> None:
        as_choice(transform, "transform", ("rigid", "similarity", "affine"))
        self._transform = transform
        self._alpha = as_number(alpha, "alpha", 0.1, 10)
        super().__init__(mesh)

    def _prepare(self) -> None:
        """Compute arms u (n,), and matrices (n, k) that take targets to q* and to f or a u + b conj(u)."""
        shape = len(self._rest), len(self._pins)
        self._mean = np.zeros(shape)
        self._linear = np.zeros(shape, dtype=np.complex128)
        self._arms = np.zeros(shape[0], dtype=np.complex128)
        self._origin = np.zeros(shape[1], dtype=np.int64)
        for _, own, pins, at_one_place in self._pinned_components():
            block = np.ix_(own, pins)
            self._origin[pins] = pins[0]
            mean, arms, hats = self._weighted(self._rest[own], self._pins[pins])
            self._mean[block], self._arms[own] = mean, arms
            if not at_one_place:
                affine = self._transform == "affine" and not _is_line(self._pins[pins])
                self._linear[block] = _linear_part(mean, arms, hats, affine)
        self._is_translated = ~self._linear.any(axis=1)

    def _weighted(self, vertices: Complexes, pins: Complexes) -> tuple[Floats, Complexes, Complexes]:
        """Weights w with sum 1 (n, k), arms u (n,) and offsets p̂ (n, k).

        Computed relative to the nearest pin, next to which the weights of the others may vanish.
        """
        squares = np.abs(vertices[:, None] - pins) ** 2
        nearest = squares.argmin(axis=1)
        least = squares.min(axis=1, keepdims=True)
        weights = np.divide(least, squares, out=np.ones_like(squares), where=squares > least) ** self._alpha
        weights /= weights.sum(axis=1, keepdims=True)
        offsets = pins - pins[nearest][:, None]
        mean = (weights * offsets).sum(axis=1)
        return weights, vertices - pins[nearest] - mean, offsets - mean[:, None]

    def _deform(self, pose: Complexes, goals: Complexes) -> Complexes:
        linear = product(self._linear, goals - goals[self._origin])
        if self._transform == "rigid":
            size = np.abs(linear)
            linear = np.where(size > 0, np.abs(self._arms) * linear / np.where(size > 0, size, 1), self._arms)
        return product(self._mean, goals) + np.where(self._is_translated, self._arms, linear)


def _is_line(pins: Complexes) -> bool:
    """Whether pins (k,) are on a line."""
    hats = pins - pins.mean()
    return bool(1 - np.abs((hats**2).sum() / (np.abs(hats) ** 2).sum()) ** 2 < _COLLINEAR)


def _linear_part(weights: Floats, arms: Complexes, hats: Complexes, affine: bool) -> Complexes:
    """The matrix (n, k) that takes targets to f or a u + b conj(u). Rows have sum 0, or are 0 with u or μ."""
    mu = (weights * np.abs(hats) ** 2).sum(axis=1, keepdims=True)
    normalized = np.divide(weights, mu, out=np.zeros_like(weights), where=mu > 0)
    similar, mirrored = normalized * hats.conj(), normalized * hats
    u = arms[:, None]
    if affine:
        tau = (normalized * hats**2).sum(axis=1, keepdims=True)
        determinant = 1 - np.abs(tau) ** 2
        a = (similar - tau.conj() * mirrored) / determinant
        b = (mirrored - tau * similar) / determinant
        linear = a * u + b * u.conj()
    else:
        linear = similar * u
    nearest = weights.argmax(axis=1)[:, None]
    np.put_along_axis(linear, nearest, 0.0, axis=1)
    np.put_along_axis(linear, nearest, -linear.sum(axis=1, keepdims=True), axis=1)
    return linear
