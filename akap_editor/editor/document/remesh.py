"""Remeshing: another mesh for a posed drawing; pins, poses and stiffness are transferred to it."""

from dataclasses import dataclass, replace
from itertools import count

import numpy as np
import shapely
from numpy.typing import NDArray

from ...errors import InputError
from ...geometry.area_bounds import grow_faces
from ...geometry.mesh import TriMesh, barycentric, signed_areas
from ...geometry.operators import to_complex, to_points
from ...geometry.validation import Complexes, Floats, Ints
from ...overlap.overlaps import transferred_overlaps
from ...progress import announce
from ...words import tr
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
_SIDE = 0.05  # share of the way from a vertex to the middle of its faces
_MIN_AREA = 0.02  # share of the rest area to which flipped faces grow
_MAX_ROUNDS = 1000  # of growing faces; tens are usual
_ROUNDS_PER_DOUBLING = 200  # of `_MIN_AREA`, because small faces may keep flipping back


def remesh_drawing(drawing: Drawing, meshing: Meshing) -> Drawing:
    """Make another mesh of the same picture.

    Raises InputError if nothing of the picture is visible, or if the mesh does not lie on its picture, which
    may be so for a mesh from a file or after a new rest pose.
    """
    current = drawing.meshing or Meshing()
    check_lies_on_picture(drawing)
    if drawing.layers:
        return remesh_layered_drawing(drawing, meshing)
    if meshing.background == current.background:
        return mesh_drawing(drawing.image, meshing, drawing.name, drawing.original)
    image = drawing.original if drawing.original is not None else drawing.image
    return remove_background_and_mesh(image, meshing, drawing.name)


@dataclass(frozen=True, eq=False)
class LayerOrigins:
    """Where the layers of a drawing come from whose artwork was painted anew.

    layers: (l,) the number of each in the drawing before, −1 for new ones; shifts: (l, 2) pixels by which
    each has moved on the canvas; is_same: (l,) whether its mesh is the same, vertex for
    vertex, but for the shift.
    """

    layers: Ints
    shifts: Floats
    is_same: NDArray[np.bool_]


def check_lies_on_picture(drawing: Drawing) -> None:
    """Raise InputError unless the mesh of a drawing lies on its picture."""
    places = drawing.uv * np.array(drawing.image.shape[1::-1])
    if drawing.layers:
        places = places - texture_shifts(drawing.layers)[drawing.mesh.layers]
    offset = np.abs(places - drawing.mesh.vertices).max()
    if offset > _MAX_UV_OFFSET:
        raise InputError(
            tr(
                "the mesh of {name} cannot be made anew: expected one that lies on its picture, "
                "but a vertex is {offset:.1f} pixels away from its place there",
                name=drawing.name,
                offset=offset,
            )
        )


def transfer_state(
    state: EditState, mesh: TriMesh, drawing: Drawing, origins: LayerOrigins | None = None
) -> EditState:
    """Transfer a state of ``mesh`` to the mesh of ``drawing``, which shows the same picture.

    origins: of its layers, if the artwork was painted anew.

    Poses are transferred by `map_points`, and what passes in front in them stays; if no face of the current
    pose is flipped, none will be. Pins stay at their places on the picture; those on parts that are gone are
    removed. Each face gets the stiffness of the nearest old one. Raises InputError if faces flip that cannot
    be unflipped.
    """
    announce(0.0, tr("Transferring pins and poses"))
    new_mesh = drawing.mesh
    is_at_rest = np.array_equal(state.positions, mesh.vertices)
    positions = new_mesh.vertices if is_at_rest else _map_vertices(new_mesh, mesh, state.positions, origins)
    if _has_flipped(positions, new_mesh) and not _has_flipped(state.positions, mesh):
        positions = _unflip_faces(positions, new_mesh)
        if _has_flipped(positions, new_mesh):
            raise InputError(
                tr(
                    "the drawing is bent too sharply for a mesh of {vertices} vertices: "
                    "expected a pose that it can follow; bend it less first",
                    vertices=len(new_mesh.vertices),
                )
            )
    centers = new_mesh.vertices[new_mesh.faces].mean(axis=1)
    faces = _nearest_on_mesh(*_origin_of(centers, new_mesh.face_layers, mesh, origins))[0]
    stiffness = None if state.stiffness is None else state.stiffness[faces]

    def map_pose(pose: Floats) -> Floats:
        return _map_vertices(new_mesh, mesh, pose, origins)

    poses_to_map = 1 + len(state.poses) + len(state.animation.keyframes)
    mapped_poses = count(1)

    def map_crossings(old: EditState | NamedPose | Keyframe, pose: Floats) -> Ints:
        number = next(mapped_poses)
        announce(
            number / (poses_to_map + 1),
            tr("Transferring pose {number} of {poses_to_map}", number=number, poses_to_map=poses_to_map),
        )
        overlaps = overlaps_of(mesh, state.pins, old.positions, old.crossings)
        return transferred_overlaps(new_mesh, pose, overlaps, mesh, faces.astype(np.int32)).crossings

    animation = state.animation.map_poses(map_pose)
    keyframes = zip(animation.keyframes, state.animation.keyframes, strict=True)
    named_poses = ((pose, map_pose(pose.positions)) for pose in state.poses)
    return EditState(
        pins=_transfer_pins(state, mesh, new_mesh, origins),
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
        joints=_transfer_joints(state.joints, mesh, new_mesh, origins),
        loose=None if state.loose is None else state.loose.on_faces(faces),
    )


def _map_vertices(new_mesh: TriMesh, mesh: TriMesh, pose: Floats, origins: LayerOrigins | None) -> Floats:
    """A pose (n, 2) of ``mesh`` on another mesh of the same layers, or of those with ``origins``."""
    points, _, layers = _origin_of(new_mesh.vertices, new_mesh.layers, mesh, origins)
    mapped = map_points(points, mesh, pose, layers, _sides(new_mesh) if mesh.is_cut else None)
    if origins is None or new_mesh.layers is None or mesh.layers is None:
        return mapped
    for layer, old in enumerate(origins.layers.tolist()):
        own = new_mesh.layers == layer
        if origins.is_same[layer]:
            mapped[own] = pose[mesh.layers == old]
        mapped[own] += _turned(origins.shifts[layer], mesh, pose, old)
    return mapped


def _turned(shift: Floats, mesh: TriMesh, pose: Floats, layer: int) -> Floats:
    """A shift (2,) of a layer at rest in a pose (n, 2), in which the layer is rotated."""
    if not shift.any() or mesh.layers is None:
        return np.zeros(2)
    own = mesh.layers == layer
    rest, moved = (to_complex(p[own]) - to_complex(p[own]).mean() for p in (mesh.vertices, pose))
    turned = complex(*shift) * complex(_unit(np.array([np.vdot(rest, moved)]))[0])
    return np.array([turned.real, turned.imag])


def _origin_of(
    points: Floats, layers: Ints | None, mesh: TriMesh, origins: LayerOrigins | None
) -> tuple[Floats, TriMesh, Ints | None]:
    """Points (k, 2) on layers (k,) as points of ``mesh``, and the layers there, −1 for any."""
    if mesh.layers is None or layers is None:
        return points, mesh, None
    if origins is None:
        return points, mesh, layers
    return points - origins.shifts[layers], mesh, origins.layers[layers]


def _sides(mesh: TriMesh) -> Floats:
    """Vertices (n, 2), moved a little into the mesh: vertices on two lips of a slit differ by that."""
    centers = mesh.vertices[mesh.faces].mean(axis=1)
    count = np.bincount(mesh.faces.ravel(), minlength=len(mesh.vertices))
    middles = [
        np.bincount(mesh.faces.ravel(), np.repeat(c, 3), len(mesh.vertices)) / count for c in centers.T
    ]
    return mesh.vertices + _SIDE * (np.stack(middles, axis=1) - mesh.vertices)


def map_points(
    points: Floats,
    mesh: TriMesh,
    pose: Floats,
    layers: Ints | None = None,
    sides: Floats | None = None,
) -> Floats:
    """Map points (k, 2) of the rest pose of ``mesh`` to its ``pose`` (n, 2).

    layers: (k,) those of the mesh on which the points lie, None for any; sides: (k, 2) points near them, from
    which the nearest faces count. The map is linear on each face. A point outside the mesh moves rigidly with
    the nearest face.
    """
    faces, nearest, weights = _nearest_on_mesh(points, mesh, layers, sides)
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
    points: Floats, mesh: TriMesh, layers: Ints | None = None, sides: Floats | None = None
) -> tuple[Ints, Floats, Floats]:
    """Points of the rest pose that are nearest to ``points`` (k, 2), on the layers (k,) if they are given.

    A layer of −1 stands for any. sides: see `map_points`.

    Returns their faces (k,), their positions (k, 2), and their barycentric weights (k, 3).
    """
    corners = mesh.vertices[mesh.faces]
    triangles = shapely.polygons(corners)
    shapely_points = shapely.points(points)
    seekers = shapely_points if sides is None else shapely.points(sides)
    faces = np.zeros(len(points), dtype=np.int64)
    for layer in [None] if layers is None else np.unique(layers).tolist():
        mine = slice(None) if layer is None else layers == layer
        own = np.arange(len(triangles))
        if layer is not None and layer >= 0:
            own = np.flatnonzero(mesh.face_layers == layer)
        faces[mine] = own[shapely.STRtree(triangles[own]).nearest(seekers[mine])]
    lines = shapely.shortest_line(triangles[faces], shapely_points)
    nearest = shapely.get_coordinates(lines).reshape(-1, 2, 2)[:, 0]
    is_inside = shapely.intersects(triangles[faces], shapely_points)
    nearest[is_inside] = points[is_inside]
    weights = np.clip(barycentric(corners[faces], nearest), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    return faces, nearest, weights


def _transfer_pins(
    state: EditState, mesh: TriMesh, new_mesh: TriMesh, origins: LayerOrigins | None
) -> tuple[Pin, ...]:
    """The pins at their places of the rest pose on another mesh, without those that are too far from it."""
    if not state.pins:
        return ()
    rest_positions = mesh.evaluate(state.points, mesh.vertices)
    layers = None if new_mesh.layers is None else mesh.face_layers[state.points.faces]
    pins, is_there = state.pins, np.ones(len(state.pins), dtype=bool)
    if origins is not None and layers is not None:
        old_layers, layers = layers, _new_numbers(layers, origins)
        is_there = layers >= 0
        shifts = np.where(is_there[:, None], origins.shifts[np.maximum(layers, 0)], 0.0)
        rest_positions = rest_positions + shifts
        pins = tuple(
            replace(pin, target=pin.target + _turned(shift, mesh, state.positions, int(old)))
            for pin, shift, old in zip(pins, shifts, old_layers, strict=True)
        )
    faces, nearest, weights = _nearest_on_mesh(rest_positions, new_mesh, layers)
    distances = np.linalg.norm(rest_positions - nearest, axis=1)
    is_there &= distances <= _MAX_PIN_DISTANCE * new_mesh.length
    return tuple(
        replace(pin, face=int(face), weights=row)
        for pin, face, row, kept in zip(pins, faces, weights, is_there, strict=True)
        if kept
    )


def _new_numbers(layers: Ints, origins: LayerOrigins) -> Ints:
    """The new numbers of old layers (k,), −1 for those that are gone."""
    numbers = {old: new for new, old in enumerate(origins.layers.tolist()) if old >= 0}
    return np.array([numbers.get(layer, -1) for layer in layers.tolist()])


def _transfer_joints(
    joints: tuple[Joint, ...], mesh: TriMesh, new_mesh: TriMesh, origins: LayerOrigins | None
) -> tuple[Joint, ...]:
    """The joints at their places of the rest pose on another mesh, without those of layers that are gone.

    A joint moves with the layer that the limb hangs on.
    """
    result = []
    for joint in joints:
        places, layers = joint.places(mesh, mesh.vertices), np.array(joint.layers(mesh))
        if origins is not None:
            layers = _new_numbers(layers, origins)
            if layers.min() < 0:
                continue
            if origins.shifts[layers].any():
                places = np.repeat(places[1:] + origins.shifts[layers[1]], 2, axis=0)
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
