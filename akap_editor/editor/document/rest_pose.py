"""The current pose as the rest pose: from then on the drawing springs back to it, and bends from it."""

from dataclasses import replace

from ...errors import InputError
from ...geometry.mesh import signed_areas
from .document import Document, EditState
from .drawing import Drawing
from .pin_angles import pins_fixed_at_pose


def with_pose_as_rest(state: EditState, drawing: Drawing) -> EditState:
    """``state`` of ``drawing`` with its pose as the rest pose: nothing moves, pins stay where they are.

    The picture stays on the mesh as it is. Raises InputError where faces are flipped, for a mesh at rest has
    none.
    """
    flipped = int((signed_areas(state.positions, drawing.mesh.faces) <= 0).sum())
    if flipped:
        raise InputError(
            "the pose cannot become the rest pose: expected all faces the right way up, but "
            f"{flipped} of {len(drawing.mesh.faces)} are flipped or flat"
        )
    mesh = replace(drawing.mesh, vertices=state.positions)
    pins = pins_fixed_at_pose(mesh, state.pins, mesh.vertices)
    return replace(state, pins=pins, positions=mesh.vertices, drawing=replace(drawing, mesh=mesh))


def bake(document: Document) -> Document:
    """A document with its pose as the rest pose, see `with_pose_as_rest`. Raises InputError."""
    state = with_pose_as_rest(document.state, document.drawing)
    assert state.drawing is not None
    return replace(document.with_state(state), drawing=state.drawing)
