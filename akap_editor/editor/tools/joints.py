"""The joint tool: a click puts a joint through two layers, a drag moves one, Alt-click removes one."""

import numpy as np

from ...words import mark, tr
from .. import gestures
from ..camera import Point
from ..document.drawing import visible_point
from ..events import PointerEvent
from ..session.session import Session
from .base import Cursor, IdleTool, Markers, Pointing, Tool, ToolContext, distance

PICK_RADIUS = 14.0  # design points


def joints_on_screen(context: ToolContext) -> dict[int, Point]:
    """Positions of the joints on the screen, by id."""
    session = context.session
    if session is None:
        return {}
    mesh, pose = session.drawing.mesh, session.state.positions
    places = {joint.id: joint.places(mesh, pose).mean(axis=0).tolist() for joint in session.state.joints}
    return {joint_id: context.camera.to_screen((x, y)) for joint_id, (x, y) in places.items()}


def joint_at(context: ToolContext, position: Point) -> int | None:
    """The nearest joint within reach of a point of the screen, or None."""
    found = [(distance(place, position), joint) for joint, place in joints_on_screen(context).items()]
    nearest = min(found, default=None)
    return nearest[1] if nearest is not None and nearest[0] <= PICK_RADIUS * context.ui_scale else None


def layers_at(session: Session, place: Point) -> tuple[int, int] | None:
    """The layer that is seen at a place of the pose, pixels, and the next one behind it there, or None."""
    drawing, pose, order = session.drawing, session.state.positions, session.document.face_order
    seen = visible_point(drawing, place, pose, order, unlocked=True)
    if seen is None or not drawing.layers:
        return None
    limb = int(drawing.face_layers[seen.faces[0]])
    hits = drawing.face_layers[drawing.mesh.find_all(place, pose, order).faces].tolist()
    ranks = {layer: rank for rank, layer in enumerate(drawing.layer_order)}
    others = sorted({layer for layer in hits if layer != limb}, key=lambda layer: ranks[layer])
    below = [layer for layer in others if ranks[layer] < ranks[limb]]
    carrier = below[-1] if below else (others[0] if others else None)
    return None if carrier is None else (limb, carrier)


class JointsIdle(IdleTool):
    """The joint tool waits for a press.

    selected: id of the joint that was chosen last in the list, or added, pressed or moved on the canvas; None
    or the id of a removed joint if none is selected.
    """

    selected: int | None = None

    @property
    def press_hint(self) -> str:
        pointer, session = self.context.pointer, self.context.session
        if session is not None and not session.drawing.layers:
            return tr("Joints hold layers together; this drawing has none")
        if pointer is not None and joint_at(self.context, pointer) is not None:
            return tr("Drag the joint, or Alt-click to remove it")
        return tr("Click where two layers overlap to hold them together there")

    keyboard_hint = mark("Enter adds a joint, Alt+Enter removes one, arrows move, Esc ends")

    @property
    def cursor(self) -> Cursor:
        return "cross" if self._hovered is None else "hand"

    @property
    def markers(self) -> Markers:
        return Markers(hovered_joint=self._hovered)

    @property
    def _hovered(self) -> int | None:
        pointer = self.context.pointer
        return None if pointer is None else joint_at(self.context, pointer)

    def press(self, event: PointerEvent) -> None:
        if self.context.session is not None and event.button == "left":
            self.context.set_tool(PointingJoint(self, event))


class PointingJoint(Pointing):
    """The canvas is pressed and not dragged yet."""

    hint = mark("Release to add or remove a joint, or drag one")
    cursor = "cross"

    def __init__(self, idle: JointsIdle, event: PointerEvent) -> None:
        super().__init__(idle.context, event)
        self._idle = idle
        self._joint = joint_at(idle.context, event.position)

    def drag(self, event: PointerEvent) -> None:
        if self._joint is None:
            self.context.return_to_idle()
            return
        self._idle.selected = self._joint
        dragging = DraggingJoint(self.context, self._joint)
        self.context.set_tool(dragging)
        dragging.move(event)

    def click(self, event: PointerEvent) -> None:
        context, session = self.context, self.session
        context.return_to_idle()
        removes = event.alt or "alt" in context.held
        if self._joint is not None:
            self._idle.selected = None if removes else self._joint
            if removes:
                gestures.remove_joints(context, {self._joint})
            return
        place = context.camera.to_drawing(self.start)
        layers = None if removes else layers_at(session, place)
        if layers is not None:
            self._idle.selected = gestures.add_joint(context, *layers, place)


class DraggingJoint(Tool):
    """A joint follows the pointer; it is moved when the button is released."""

    hint = mark("Release to move the joint here, Esc to cancel")
    cursor = "grab"

    def __init__(self, context: ToolContext, joint: int) -> None:
        super().__init__(context)
        self._joint = joint
        self._place: Point | None = None

    @property
    def markers(self) -> Markers:
        return Markers(hovered_joint=self._joint, new_joint=self._place)

    def move(self, event: PointerEvent) -> None:
        self._place = event.position

    def release(self, event: PointerEvent) -> None:
        if event.button != "left":
            return
        self.context.return_to_idle()
        if self._place is not None:
            x, y = np.asarray(self.context.camera.to_drawing(self._place), dtype=float).tolist()
            gestures.move_joint(self.context, self._joint, (x, y))
