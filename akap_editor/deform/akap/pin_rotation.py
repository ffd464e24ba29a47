"""Pins that hold an angle: the faces around such a pin turn with it."""

import numpy as np
from numpy.typing import NDArray

from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import hat_gradients
from ...geometry.validation import Complexes, Floats, Ints

_RADIUS = 0.04  # share of √area: how far around a pin faces turn with it
_WEIGHT = 1e4  # c of the energy c A ω² of a face that turns too fast or too slowly by ω


class PinRotationConstraints:
    """The faces that turn with pins, and how far they are turned.

    On each such face f the field of eq. 3 has a further energy c A_f (ω_f − ω̃)², where ω is the rate at which
    a field turns, half its curl, and the rest memory c A_f |z_f − e^{iθ}|², where z is the part of the
    Jacobian that turns and scales, as a complex number. Both are sums over faces, and so change no pattern.

    pins: (q,) which pin each of the ``faces`` (q,) belongs to; spin: (m,) c of every face of the mesh.
    """

    def __init__(self, mesh: TriMesh, points: MeshPoints, holding: NDArray[np.bool_]) -> None:
        self._mesh = mesh
        centers = mesh.vertices[mesh.faces].mean(axis=1)
        radius = _RADIUS * mesh.length
        component = mesh.component[mesh.faces[:, 0]]
        nearest, owner = np.full(len(centers), np.inf), np.full(len(centers), -1)
        for pin in np.flatnonzero(holding):
            own = points.faces[pin]
            far = np.hypot(*(centers - mesh.evaluate(points, mesh.vertices)[pin]).T)
            far[own] = 0.0
            # on a coarse mesh at least the face's neighbors
            near = (far <= radius) | np.isin(mesh.faces, mesh.faces[own]).any(axis=1)
            taken = near & (far < nearest) & (component == component[own])
            nearest[taken], owner[taken] = far[taken], pin
        self.faces: Ints = np.flatnonzero(owner >= 0)
        self.pins: Ints = owner[self.faces]
        self.spin = np.where(owner >= 0, _WEIGHT, 0.0)
        self._owner_of = np.where(holding, owner[points.faces], -1)  # a pin may share its face with another
        self._corners = mesh.faces[self.faces]
        dx, dy, areas = hat_gradients(mesh.vertices, self._corners)
        self._rest_hats, self._rest_areas = dx + 1j * dy, areas
        self._hats, self._areas = self._rest_hats, areas

    def place(self, positions: Floats) -> None:
        """The pose (n, 2) at which fields are asked for from now on."""
        dx, dy, areas = hat_gradients(positions, self._corners)
        self._hats, self._areas = dx + 1j * dy, np.abs(areas)

    def energy(self, field: Complexes) -> float:
        """Σ c A ω² of a field (n,)."""
        rates = 0.5 * (self._hats.conj() * field[self._corners]).imag.sum(axis=1)
        return float(_WEIGHT * (self._areas @ rates**2))

    def pull(self, rates: Floats) -> Complexes:
        """Half the derivative of 2 Σ c A ω ω̃ by a field, (n,), for the rates ω̃ (q,)."""
        return self._spread((0.5j * _WEIGHT * self._areas * rates)[:, None] * self._hats)

    def turns(self, pose: Complexes) -> Complexes:
        """z of each face, (q,), at a pose (n,); 1 at rest. Linear in the pose."""
        return np.asarray(0.5 * (self._rest_hats.conj() * pose[self._corners]).sum(axis=1))

    def angles(self, pose: Complexes) -> Floats:
        """How far the surroundings of each pin are turned from rest, (k,), in (−π, π]; NaN without angle."""
        sums = np.zeros(len(self._owner_of), dtype=np.complex128)
        np.add.at(sums, self.pins, self._rest_areas * self.turns(pose))
        return np.where(self._owner_of >= 0, np.angle(sums[self._owner_of]), np.nan)

    def misfit(self, off: Complexes) -> float:
        """Σ c A |off|² of z − e^{iθ}, (q,)."""
        return float(_WEIGHT * (self._rest_areas @ (off.real**2 + off.imag**2)))

    def misfit_gradient(self, off: Complexes) -> Complexes:
        """Half its derivative with respect to the vertices, (n,)."""
        return self._spread((0.5 * _WEIGHT * self._rest_areas * off)[:, None] * self._rest_hats)

    def _spread(self, values: NDArray[np.complexfloating]) -> Complexes:
        result = np.zeros(len(self._mesh.vertices), dtype=np.complex128)
        np.add.at(result, self._corners.ravel(), values.ravel())
        return result
