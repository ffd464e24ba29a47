"""Another mesh for a drawing that is already bent: pins and pose are carried over."""

from dataclasses import replace

import numpy as np
import shapely

from ...errors import InputError
from ...geometry.area_bounds import grow_faces
from ...geometry.mesh import TriMesh, barycentric, signed_areas
from ...geometry.validation import Complexes, Floats, Ints
from .document import EditState
from .drawing import Drawing, Meshing, mesh_drawing, remove_background_and_mesh
from .pin import Pin

_ON_PICTURE = 0.5  # pixels by which vertices may be beside where their texture coordinates say
_COMPLEX = np.array([1, 1j])  # makes x + iy of (x, y)
_THIN = 0.02  # share of its rest area that a face gets when it is unfolded
_ROUNDS, _DOUBLING = 1000, 200  # most rounds of unfolding, tens are usual; how many until that share doubles
_LOST = 0.08  # share of √area: a pin farther from the new mesh sat on a part that is gone


def remesh_drawing(drawing: Drawing, meshing: Meshing) -> Drawing:
    """The same picture with a mesh made in another way.

    Raises InputError where there would be nothing to cut out, or where the mesh does not lie on its picture,
    as one that came from a file need not.
    """
    made = drawing.meshing or Meshing()
    away = np.abs(drawing.uv * np.array(drawing.size) - drawing.mesh.vertices).max()
    if away > _ON_PICTURE:
        raise InputError(
            f"the mesh of {drawing.name} cannot be made anew: expected one that lies on its picture, "
            f"but a vertex is {away:.1f} pixels away from its place there"
        )
    if meshing.background == made.background:
        return mesh_drawing(drawing.image, meshing, drawing.name, drawing.original)
    before = drawing.original if drawing.original is not None else drawing.image
    return remove_background_and_mesh(before, meshing, drawing.name)


def transfer_state(state: EditState, old: TriMesh, drawing: Drawing) -> EditState:
    """The state of a drawing with the mesh ``old`` on another mesh of the same picture.

    The pose goes on as a map: a vertex goes where its place was taken, one beside the old mesh goes along
    with the face nearest to it, rigidly. Pins stay where they are on the drawing; those on parts that are
    gone are gone. Faces are as stiff as the old ones nearest to them. They do not flip where none was
    flipped; InputError is raised where that is not possible.
    """
    mesh = drawing.mesh
    at_rest = np.array_equal(state.positions, old.vertices)
    positions = mesh.vertices if at_rest else _carried(mesh.vertices, old, state.positions)
    flipped = signed_areas(positions, mesh.faces) <= 0
    if flipped.any() and (signed_areas(state.positions, old.faces) > 0).all():
        positions = _unfolded(positions, mesh)
        if (signed_areas(positions, mesh.faces) <= 0).any():
            raise InputError(
                f"the drawing is bent too sharply for a mesh of {len(mesh.vertices)} vertices: "
                "expected a pose that it can follow; bend it less first"
            )
    pins = _moved_pins(state, old, mesh)
    poses = tuple(
        replace(pose, positions=_carried(mesh.vertices, old, pose.positions)) for pose in state.poses
    )
    animation = state.animation.with_poses(lambda pose: _carried(mesh.vertices, old, pose))
    stiffness = state.stiffness
    if stiffness is not None:
        stiffness = stiffness[_nearest(mesh.vertices[mesh.faces].mean(axis=1), old)[0]]
    return EditState(pins, positions, state.settings, drawing, poses, stiffness, animation)


def _nearest(points: Floats, mesh: TriMesh) -> tuple[Ints, Floats, Floats]:
    """The face (k,) that each of ``points`` (k, 2) is on or nearest to, the place there, (k, 2), and its
    weights (k, 3).
    """
    corners = mesh.vertices[mesh.faces]
    triangles = shapely.polygons(corners)
    places = shapely.points(points)
    faces = shapely.STRtree(triangles).nearest(places)
    lines = shapely.shortest_line(triangles[faces], places)
    on_face = shapely.get_coordinates(lines).reshape(-1, 2, 2)[:, 0]
    inside = shapely.intersects(triangles[faces], places)
    on_face[inside] = points[inside]
    weights = np.clip(barycentric(corners[faces], on_face), 0.0, 1.0)
    weights /= weights.sum(axis=1, keepdims=True)
    return faces, on_face, weights


def _carried(points: Floats, old: TriMesh, pose: Floats) -> Floats:
    """Where the map from the mesh ``old`` at rest to its ``pose`` takes points (k, 2)."""
    faces, on_face, weights = _nearest(points, old)
    corners, moved = old.vertices[old.faces[faces]], pose[old.faces[faces]]
    outside = np.abs(points - on_face).max(axis=1) > 0
    result = np.einsum("kc,kcd->kd", weights, moved)
    arms = (corners - corners.mean(axis=1, keepdims=True)) @ _COMPLEX
    turn = _unit((arms.conj() * ((moved - moved.mean(axis=1, keepdims=True)) @ _COMPLEX)).sum(axis=1))
    offset = turn * ((points - on_face) @ _COMPLEX)
    result[outside] += np.stack([offset.real, offset.imag], axis=1)[outside]
    return result


def _moved_pins(state: EditState, old: TriMesh, mesh: TriMesh) -> tuple[Pin, ...]:
    if not state.pins:
        return ()
    places = old.evaluate(state.points, old.vertices)
    faces, on_face, weights = _nearest(places, mesh)
    near = np.linalg.norm(places - on_face, axis=1) <= _LOST * mesh.length
    return tuple(
        replace(pin, face=int(face), weights=weight)
        for pin, face, weight, stays in zip(state.pins, faces, weights, near, strict=True)
        if stays
    )


def _unfolded(positions: Floats, mesh: TriMesh) -> Floats:
    """The pose with the few faces unfolded that have flipped because they lie across sharply bent ones.

    Again and again the corners of each face that is flipped, or nearly so, are moved the shortest way that
    gives it a little area, and by the mean of these moves where faces share them.
    """
    pose = positions @ _COMPLEX
    for number in range(_ROUNDS):
        least = _THIN * 2 ** (number / _DOUBLING) * mesh.rest_areas
        areas = signed_areas(np.stack([pose.real, pose.imag], axis=1), mesh.faces)
        if areas.min() > 0:
            break
        thin = np.flatnonzero(areas < least)
        pose = grow_faces(pose, mesh.faces[thin], least[thin] - areas[thin], least[thin])
    return np.stack([pose.real, pose.imag], axis=1)


def _unit(values: Complexes) -> Complexes:
    size = np.abs(values)
    return np.where(size > 0, values / np.where(size > 0, size, 1.0), 1.0)
