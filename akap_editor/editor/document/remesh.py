"""Remeshing: another mesh for a posed drawing; pins, poses and stiffness are transferred to it."""

from dataclasses import replace
from itertools import count

import numpy as np
import shapely

from ...errors import InputError
from ...geometry.area_bounds import grow_faces
from ...geometry.mesh import TriMesh, barycentric, signed_areas
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints
from ...overlap.overlaps import transferred_overlaps
from ...progress import announce
from .crossings import overlaps_of
from .document import EditState
from .drawing import (
    Drawing,
    Meshing,
    mesh_drawing,
    remesh_layered_drawing,
    remove_background_and_mesh,
    texture_shifts,
)
from .keyframes import Keyframe
from .named_poses import NamedPose
from .pin import Pin
from .rig.joint import Joint

_MAX_UV_OFFSET = 0.5  # pixels of a vertex from its texture coordinates on the picture
_MAX_PIN_DISTANCE = 0.08  # share of √area: a pin farther from the new mesh was on a part that is gone
_MIN_AREA = 0.02  # share of the rest area to which flipped faces grow
_MAX_ROUNDS = 1000  # of growing faces; tens are usual
_ROUNDS_PER_DOUBLING = 200  # of `_MIN_AREA`, because small faces may keep flipping back


def remesh_drawing(drawing: Drawing, meshing: Meshing) -> Drawing:
    """Make another mesh of the same picture.

    Raises InputError if nothing of the picture is visible, or if the mesh does not lie on its picture, which
    may be so for a mesh from a file or after a new rest pose.
    """
    current = drawing.meshing or Meshing()
    places = drawing.uv * np.array(drawing.image.shape[1::-1])
    if drawing.layers:
        places = places - texture_shifts(drawing.layers)[drawing.mesh.layers]
    offset = np.abs(places - drawing.mesh.vertices).max()
    if offset > _MAX_UV_OFFSET:
        raise InputError(
            f"the mesh of {drawing.name} cannot be made anew: expected one that lies on its picture, "
            f"but a vertex is {offset:.1f} pixels away from its place there"
        )
    if drawing.layers:
        return remesh_layered_drawing(drawing, meshing)
    if meshing.background == current.background:
        return mesh_drawing(drawing.image, meshing, drawing.name, drawing.original)
    image = drawing.original if drawing.original is not None else drawing.image
    return remove_background_and_mesh(image, meshing, drawing.name)


def transfer_state(state: EditState, mesh: TriMesh, drawing: Drawing) -> EditState:
    """Transfer a state of ``mesh`` to the mesh of ``drawing``, which shows the same picture.

    Poses are transferred by `map_points`, and what passes in front in them stays; if no face of the current
    pose is flipped, none will be. Pins stay at their places on the picture; those on parts that are gone are
    removed. Each face gets the stiffness of the nearest old one. Raises InputError if faces flip that cannot
    be unflipped.
    """
    announce(0.0, "Transferring pins and poses")
    new_mesh = drawing.mesh
    is_at_rest = np.array_equal(state.positions, mesh.vertices)
    positions = new_mesh.vertices if is_at_rest else _map_vertices(new_mesh, mesh, state.positions)
    if _has_flipped(positions, new_mesh) and not _has_flipped(state.positions, mesh):
        positions = _unflip_faces(positions, new_mesh)
        if _has_flipped(positions, new_mesh):
            raise InputError(
                f"the drawing is bent too sharply for a mesh of {len(new_mesh.vertices)} vertices: "
                "expected a pose that it can follow; bend it less first"
            )
    centers = new_mesh.vertices[new_mesh.faces].mean(axis=1)
    faces = _nearest_on_mesh(centers, mesh, _layers_of(new_mesh.face_layers, mesh))[0]
    stiffness = None if state.stiffness is None else state.stiffness[faces]

    def map_pose(pose: Floats) -> Floats:
        return _map_vertices(new_mesh, mesh, pose)

    poses_to_map = 1 + len(state.poses) + len(state.animation.keyframes)
    mapped_poses = count(1)

    def map_crossings(old: EditState | NamedPose | Keyframe, pose: Floats) -> Ints:
        number = next(mapped_poses)
        announce(number / (poses_to_map + 1), f"Transferring pose {number} of {poses_to_map}")
        overlaps = overlaps_of(mesh, state.pins, old.positions, old.crossings)
        return transferred_overlaps(new_mesh, pose, overlaps, mesh, faces.astype(np.int32)).crossings

    animation = state.animation.map_poses(map_pose)
    keyframes = zip(animation.keyframes, state.animation.keyframes, strict=True)
    named_poses = ((pose, map_pose(pose.positions)) for pose in state.poses)
    return EditState(
        pins=_transfer_pins(state, mesh, new_mesh),
        positions=positions,
        settings=state.settings,
        drawing=drawing,
        poses=tuple(
            replace(pose, positions=mapped, crossings=map_crossings(pose, mapped))
            for pose, mapped in named_poses
        ),
        stiffness=stiffness,
        animation=replace(
            animation,
            keyframes=tuple(
                replace(new, crossings=map_crossings(old, new.positions)) for new, old in keyframes
            ),
        ),
        crossings=map_crossings(state, positions),
        joints=_transfer_joints(state.joints, mesh, new_mesh),
    )


def _map_vertices(new_mesh: TriMesh, mesh: TriMesh, pose: Floats) -> Floats:
    """A pose (n, 2) of ``mesh`` on another mesh of the same layers."""
    return map_points(new_mesh.vertices, mesh, pose, _layers_of(new_mesh.layers, mesh))


def _layers_of(layers: Ints | None, mesh: TriMesh) -> Ints | None:
    """Layers of points, if those of ``mesh`` are to be told apart."""
    return None if mesh.layers is None else layers


def map_points(points: Floats, mesh: TriMesh, pose: Floats, layers: Ints | None = None) -> Floats:
    """Map points (k, 2) of the rest pose of ``mesh`` to its ``pose`` (n, 2).

    layers: (k,) those of the mesh on which the points lie, None for any. The map is linear on each face. A
    point outside the mesh moves rigidly with the nearest face.
    """
    faces, nearest, weights = _nearest_on_mesh(points, mesh, layers)
    rest_corners, corners = mesh.vertices[mesh.faces[faces]], pose[mesh.faces[faces]]
    is_outside = np.abs(points - nearest).max(axis=1) > 0
    mapped = np.einsum("kc,kcd->kd", weights, corners)
    # The rotation of a face that fits its corners best, as a complex number of modulus 1.
    arms = _centered(rest_corners)
    rotation = _unit((arms.conj() * _centered(corners)).sum(axis=1))
    offset = rotation * to_complex(points - nearest)
    mapped[is_outside] += to_points(offset)[is_outside]
    return mapped


def _nearest_on_mesh(
    points: Floats, mesh: TriMesh, layers: Ints | None = None
) -> tuple[Ints, Floats, Floats]:
    """Points of the rest pose that are nearest to ``points`` (k, 2), on the layers (k,) if they are given.

    Returns their faces (k,), their positions (k, 2), and their barycentric weights (k, 3).
    """
    corners = mesh.vertices[mesh.faces]
    triangles = shapely.polygons(corners)
    shapely_points = shapely.points(points)
    faces = np.zeros(len(points), dtype=np.int64)
    for layer in [None] if layers is None else np.unique(layers).tolist():
        mine = slice(None) if layer is None else layers == layer
        own = np.arange(len(triangles)) if layer is None else np.flatnonzero(mesh.face_layers == layer)
        faces[mine] = own[shapely.STRtree(triangles[own]).nearest(shapely_points[mine])]
    lines = shapely.shortest_line(triangles[faces], shapely_points)
    nearest = shapely.get_coordinates(lines).reshape(-1, 2, 2)[:, 0]
    is_inside = shapely.intersects(triangles[faces], shapely_points)
    nearest[is_inside] = points[is_inside]
    weights = np.clip(barycentric(corners[faces], nearest), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    return faces, nearest, weights


def _transfer_pins(state: EditState, mesh: TriMesh, new_mesh: TriMesh) -> tuple[Pin, ...]:
    """The pins at their places of the rest pose on another mesh, without those that are too far from it."""
    if not state.pins:
        return ()
    rest_positions = mesh.evaluate(state.points, mesh.vertices)
    layers = None if new_mesh.layers is None else mesh.face_layers[state.points.faces]
    faces, nearest, weights = _nearest_on_mesh(rest_positions, new_mesh, layers)
    distances = np.linalg.norm(rest_positions - nearest, axis=1)
    return tuple(
        replace(pin, face=int(face), weights=row)
        for pin, face, row, distance in zip(state.pins, faces, weights, distances, strict=True)
        if distance <= _MAX_PIN_DISTANCE * new_mesh.length
    )


def _transfer_joints(joints: tuple[Joint, ...], mesh: TriMesh, new_mesh: TriMesh) -> tuple[Joint, ...]:
    """The joints at their places of the rest pose on another mesh of the same layers."""
    result = []
    for joint in joints:
        places, layers = joint.places(mesh, mesh.vertices), np.array(joint.layers(mesh))
        faces, _, weights = _nearest_on_mesh(places, new_mesh, layers)
        result.append(replace(joint, faces=(int(faces[0]), int(faces[1])), weights=weights))
    return tuple(result)


def _has_flipped(positions: Floats, mesh: TriMesh) -> bool:
    return bool((signed_areas(positions, mesh.faces) <= 0).any())


def _unflip_faces(positions: Floats, mesh: TriMesh) -> Floats:
    """Unflip the few faces of a pose (n, 2) that lie across sharply bent old ones, as far as possible.

    Repeatedly grows faces that are flipped, or nearly so, to a small area by the shortest moves of their
    corners, until no face is flipped.
    """
    pose = to_complex(positions)
    for index in range(_MAX_ROUNDS):
        min_areas = _MIN_AREA * 2 ** (index / _ROUNDS_PER_DOUBLING) * mesh.rest_areas
        areas = signed_areas(to_points(pose), mesh.faces)
        if areas.min() > 0:
            break
        small = np.flatnonzero(areas < min_areas)
        pose = grow_faces(pose, mesh.faces[small], min_areas[small] - areas[small], min_areas[small])
    return to_points(pose)


def _centered(corners: Floats) -> Complexes:
    """Corners (k, 3, 2) relative to their centroids, (k, 3) complex."""
    return (corners - corners.mean(axis=1, keepdims=True)) @ np.array([1, 1j])


def _unit(values: Complexes) -> Complexes:
    """``values`` divided by their moduli; 1 where the value is 0."""
    size = np.abs(values)
    return np.where(size > 0, values / np.where(size > 0, size, 1.0), 1.0)
