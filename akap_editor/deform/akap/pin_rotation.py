"""Pins that hold an angle: the faces around such a pin rotate with it."""

import numpy as np
from numpy.typing import NDArray

from ...geometry.mesh import MeshPoints, TriMesh
from ...geometry.operators import hat_gradients
from ...geometry.validation import Complexes, Floats, Ints

_RADIUS = 0.04  # share of √area: distance from a pin within which faces rotate with it
_WEIGHT = 1e4  # c of the energies


class PinRotationConstraints:
    """The faces that rotate with pins, and the energies that make them do so.

    On each such face f, the field of eq. 3 has the further energy c A_f (ω_f − ω̃)², where ω is the rate at
    which a field rotates the face, half its curl, and the rest memory has c A_f |z_f − e^{iθ}|², where z is
    the part of the face's Jacobian that rotates and scales, as a complex number. Both are sums over faces, so
    the sparsity patterns do not change.

    points: the pins; has_angle: (k,) which of them hold an angle.
    faces: (q,) that rotate with pins; pins: (q,) the pin of each; rotation_weights: (m,) c of every face of
    the mesh, 0 for faces that rotate freely.
    """

    def __init__(self, mesh: TriMesh, points: MeshPoints, has_angle: NDArray[np.bool_]) -> None:
        self._mesh = mesh
        centers = mesh.vertices[mesh.faces].mean(axis=1)
        radius = _RADIUS * mesh.length
        component = mesh.component[mesh.faces[:, 0]]
        shortest, owner = np.full(len(centers), np.inf), np.full(len(centers), -1)
        for pin in np.flatnonzero(has_angle):
            pin_face = points.faces[pin]
            distance = np.hypot(*(centers - mesh.evaluate(points, mesh.vertices)[pin]).T)
            distance[pin_face] = 0.0
            is_neighbor = np.isin(mesh.faces, mesh.faces[pin_face]).any(axis=1)  # also on a coarse mesh
            near = (distance <= radius) | is_neighbor
            nearest = near & (distance < shortest) & (component == component[pin_face])
            shortest[nearest], owner[nearest] = distance[nearest], pin
        self.faces: Ints = np.flatnonzero(owner >= 0)
        self.pins: Ints = owner[self.faces]
        self.rotation_weights = np.where(owner >= 0, _WEIGHT, 0.0)
        # of pins on one face, one owns the faces around all of them
        self._owner_of_pin = np.where(has_angle, owner[points.faces], -1)
        self._corners = mesh.faces[self.faces]
        dx, dy, areas = hat_gradients(mesh.vertices, self._corners)
        self._rest_hats, self._rest_areas = dx + 1j * dy, areas
        self._hats, self._areas = self._rest_hats, areas
        self._unscaled = self._rest_hats, self._rest_areas

    def set_scales(self, scales: Floats | None) -> None:
        """Compare with the rest shape enlarged by scales (m,) of the faces, None for 1."""
        self._rest_hats, self._rest_areas = self._unscaled
        if scales is not None:
            own = scales[self.faces]
            self._rest_hats, self._rest_areas = self._rest_hats / own[:, None], self._rest_areas * own**2

    def set_pose(self, positions: Floats) -> None:
        """Set the pose (n, 2) for `energy` and `pin_force`."""
        dx, dy, areas = hat_gradients(positions, self._corners)
        self._hats, self._areas = dx + 1j * dy, np.abs(areas)

    def energy(self, field: Complexes) -> float:
        """Σ c A ω² of a field (n,) at the pose last set."""
        rates = 0.5 * (self._hats.conj() * field[self._corners]).imag.sum(axis=1)
        return float(_WEIGHT * (self._areas @ rates**2))

    def pin_force(self, rates: Floats) -> Complexes:
        """Half the derivative of 2 Σ c A ω ω̃ by the field, (n,), for rates ω̃ (q,) in radians per time."""
        return self._scatter((0.5j * _WEIGHT * self._areas * rates)[:, None] * self._hats)

    def face_rotations(self, pose: Complexes) -> Complexes:
        """z of each face, (q,), at a pose (n,); 1 at rest. Linear in the pose."""
        return np.asarray(0.5 * (self._rest_hats.conj() * pose[self._corners]).sum(axis=1))

    def angles(self, pose: Complexes) -> Floats:
        """The rotation from rest around each pin, (k,) radians in (−π, π], at a pose (n,).

        NaN for pins that hold no angle.
        """
        sums = np.zeros(len(self._owner_of_pin), dtype=np.complex128)
        np.add.at(sums, self.pins, self._rest_areas * self.face_rotations(pose))
        return np.where(self._owner_of_pin >= 0, np.angle(sums[self._owner_of_pin]), np.nan)

    def residual_energy(self, residuals: Complexes) -> float:
        """Σ c A |r|² of residuals r = z − e^{iθ}, (q,)."""
        return float(_WEIGHT * (self._rest_areas @ (residuals.real**2 + residuals.imag**2)))

    def residual_gradient(self, residuals: Complexes) -> Complexes:
        """Half the derivative of `residual_energy` by the vertices, (n,)."""
        return self._scatter((0.5 * _WEIGHT * self._rest_areas * residuals)[:, None] * self._rest_hats)

    def _scatter(self, values: NDArray[np.complexfloating]) -> Complexes:
        """Sum values (q, 3) at corners of the faces to the vertices, (n,)."""
        result = np.zeros(len(self._mesh.vertices), dtype=np.complex128)
        np.add.at(result, self._corners.ravel(), values.ravel())
        return result
