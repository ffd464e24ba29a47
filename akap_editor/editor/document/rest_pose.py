"""The current pose as the new rest pose, to which the drawing springs back and from which it deforms."""

from dataclasses import replace

from ...errors import InputError
from ...geometry.mesh import signed_areas
from ...geometry.validation import as_instance
from ...words import tr
from .document import Document, EditState
from .drawing import Drawing
from .pin_angles import pins_fixed_at_pose


def with_pose_as_rest(state: EditState, drawing: Drawing) -> EditState:
    """A state of ``drawing`` with its current pose as the rest pose; no vertex moves, pins stay.

    The picture stays on the mesh. Raises InputError if the pose has flipped faces, which a rest pose may not
    have.
    """
    flipped = int((signed_areas(state.positions, drawing.mesh.faces) <= 0).sum())
    if flipped:
        raise InputError(
            tr(
                "the pose cannot become the rest pose: expected all faces the right way up, but "
                "{flipped} of {faces} are flipped or flat",
                flipped=flipped,
                faces=len(drawing.mesh.faces),
            )
        )
    mesh = replace(drawing.mesh, vertices=state.positions)
    pins = pins_fixed_at_pose(mesh, state.pins, mesh.vertices)
    return replace(state, pins=pins, positions=mesh.vertices, drawing=replace(drawing, mesh=mesh))


def bake(document: Document) -> Document:
    """A document with its current pose as the rest pose, see `with_pose_as_rest`. Raises InputError."""
    as_instance(document, "document", Document)
    state = with_pose_as_rest(document.state, document.drawing)
    assert state.drawing is not None
    return replace(document.with_state(state), drawing=state.drawing)
