"""Joints: points at which two layers of a drawing are held together."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....errors import InputError
from ....geometry.joints import MeshJoints
from ....geometry.json_numbers import MAX_INTEGER
from ....geometry.mesh import MeshPoints, TriMesh
from ....geometry.validation import Floats, as_choice, as_floats, as_switch
from ....words import tr

MAX_JOINTS = 10_000
KINDS = ("hinge", "weld")
WEIGHT_TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Joint:
    """A point at which two layers are held together; arrays are read-only.

    id: unique in its document; faces: one of the limb and one of the layer that it hangs on; weights: (2, 3)
    float64 barycentric, the point on each; kind: "hinge", about which the limb turns, or "weld"; is_proposed:
    whether the program placed it and nobody has accepted it yet. Raises InputError on other values.
    """

    id: int
    faces: tuple[int, int]
    weights: Floats
    kind: str = "hinge"
    is_proposed: bool = False

    def __post_init__(self) -> None:
        limb, carrier = self.faces
        object.__setattr__(self, "faces", (int(limb), int(carrier)))
        object.__setattr__(self, "weights", as_floats(self.weights, "weights"))
        as_choice(self.kind, "kind", KINDS)
        as_switch(self.is_proposed, "is_proposed")

    def layers(self, mesh: TriMesh) -> tuple[int, int]:
        """The layers of the limb and of what it hangs on."""
        limb, carrier = mesh.face_layers[list(self.faces)].tolist()
        return limb, carrier

    def places(self, mesh: TriMesh, positions: Floats) -> Floats:
        """Its points on limb and carrier in a pose (n, 2), (2, 2) pixels."""
        return mesh.evaluate(MeshPoints(np.array(self.faces), self.weights), positions)

    def to_json(self) -> dict[str, Any]:
        """The joint as an object of a document or recording; docs/file-format.md describes it."""
        return {
            "id": int(self.id),
            "faces": list(self.faces),
            "weights": self.weights.tolist(),
            **({"kind": self.kind} if self.kind != "hinge" else {}),
            **({"proposed": True} if self.is_proposed else {}),
        }


def mesh_joints(joints: Sequence[Joint]) -> MeshJoints | None:
    """Joints as those of the mesh; None without any."""
    if not joints:
        return None
    return MeshJoints(
        np.array([joint.faces for joint in joints], dtype=np.int32),
        np.array([joint.weights for joint in joints]),
        np.array([joint.kind == "weld" for joint in joints]),
    )


def make_joint(
    mesh: TriMesh,
    joint_id: int,
    limb: int,
    carrier: int,
    place: Floats,
    positions: Floats | None = None,
    kind: str = "hinge",
    is_proposed: bool = False,
) -> Joint:
    """A joint between two layers at a place (2,) in a pose (n, 2), by default at rest.

    Where a layer is not at the place, its nearest point is taken. Raises InputError on unknown layers.
    """
    pose = mesh.vertices if positions is None else positions
    faces, weights = [], []
    for layer in (limb, carrier):
        own = np.flatnonzero(mesh.face_layers == layer)
        if not len(own):
            raise InputError(tr("joint: expected a layer of the drawing, got {layer}", layer=layer))
        point = _nearest_point(mesh, own, pose, np.asarray(place, dtype=np.float64))
        faces.append(int(point.faces[0]))
        weights.append(point.weights[0])
    return Joint(joint_id, (faces[0], faces[1]), np.array(weights), kind, is_proposed)


def _nearest_point(mesh: TriMesh, own: Any, pose: Floats, place: Floats) -> MeshPoints:
    hits = mesh.find_all(place, pose)
    inside = np.flatnonzero(np.isin(hits.faces, own))
    if len(inside):
        return MeshPoints(hits.faces[inside[-1:]], hits.weights[inside[-1:]])
    vertices = np.unique(mesh.faces[own])
    nearest = vertices[np.argmin(((pose[vertices] - place) ** 2).sum(axis=1))]
    face = own[np.argmax((mesh.faces[own] == nearest).any(axis=1))]
    return MeshPoints(np.array([face]), (mesh.faces[[face]] == nearest).astype(float))


def check_joints(joints: Sequence[Joint], mesh: TriMesh) -> None:
    """Check that joints can be those of a mesh. Raises InputError."""
    if len(joints) > MAX_JOINTS:
        raise InputError(
            tr("expected at most {most} joints, got {count}", most=MAX_JOINTS, count=len(joints))
        )
    if joints and mesh.layers is None:
        raise InputError(tr("joints: expected a drawing in layers"))
    count = len(mesh.faces)
    if len({joint.id for joint in joints}) < len(joints):
        raise InputError(tr("expected each joint once, got one id twice"))
    for joint in joints:
        if abs(joint.id) > MAX_INTEGER:
            raise InputError(tr("joints: expected ids up to {most}, got a larger one", most=MAX_INTEGER))
        if not all(0 <= face < count for face in joint.faces):
            raise InputError(
                tr(
                    "joint {joint}: expected faces from 0 to {last}, got {faces}",
                    joint=joint.id,
                    last=count - 1,
                    faces=joint.faces,
                )
            )
        weights = joint.weights
        low, high = -WEIGHT_TOLERANCE, 1 + WEIGHT_TOLERANCE
        is_sound = weights.shape == (2, 3) and bool(((weights >= low) & (weights <= high)).all())
        if not is_sound or np.abs(weights.sum(axis=1) - 1).max() > WEIGHT_TOLERANCE:
            raise InputError(
                tr(
                    "joint {joint}: expected two times 3 weights from 0 to 1 that sum to 1, got {weights}",
                    joint=joint.id,
                    weights=weights.tolist(),
                )
            )
        limb, carrier = joint.layers(mesh)
        if limb == carrier:
            raise InputError(
                tr(
                    "joint {joint}: expected points on two layers, got both on layer {limb}",
                    joint=joint.id,
                    limb=limb,
                )
            )


def changed_joint(joints: Sequence[Joint], joint_id: int, **values: Any) -> tuple[Joint, ...]:
    """Joints with values of one of them changed; it is no proposal any more."""
    return tuple(
        replace(joint, is_proposed=False, **values) if joint.id == joint_id else joint for joint in joints
    )
