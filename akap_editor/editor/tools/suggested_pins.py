"""Suggested pins: ghosts where limbs end and fork, to be moved, removed, and then accepted in one step."""

import numpy as np

from ...geometry.limbs import find_limbs
from ...words import mark, tr
from ..camera import Point
from ..document.document import EditState
from ..events import KeyEvent, PointerEvent
from ..gestures import add_pins
from .base import Cursor, IdleTool, Markers, Tool, ToolContext, distance

PICK_RADIUS = 12.0  # points of the screen around the center of a ghost
MAX_SUGGESTED = 12  # the most telling ones: tips, then middles of parts, then forks
MIN_DISTANCE = 0.06  # from pins that exist, of the mesh's length


def suggest_pins(context: ToolContext) -> None:
    """Show pins that help to bend the drawing, until they are accepted or cancelled."""
    if context.session is not None and not context.is_busy:
        context.set_tool(SuggestedPins(context))


def suggested_positions(context: ToolContext) -> list[Point]:
    """Where pins help to bend the open drawing, in drawing units of its pose; none near pins that exist."""
    assert context.session is not None
    mesh, state = context.session.drawing.mesh, context.session.state
    limbs = find_limbs(mesh)
    vertices = [*limbs.tips.tolist(), *limbs.middles.tolist(), *limbs.forks.tolist()]
    pins = _rest_positions(context, state)
    far = [
        vertex
        for vertex in vertices
        if np.linalg.norm(pins - mesh.vertices[vertex], axis=1).min(initial=np.inf)
        > MIN_DISTANCE * mesh.length
    ]
    return [(float(x), float(y)) for x, y in state.positions[far[:MAX_SUGGESTED]]]


def _rest_positions(context: ToolContext, state: EditState) -> np.ndarray:
    """(k, 2) places of the pins in the rest pose."""
    assert context.session is not None
    mesh = context.session.drawing.mesh
    return mesh.evaluate(state.points, mesh.vertices)


class SuggestedPins(IdleTool):
    """Shows the suggestions until they are accepted or cancelled.

    positions: of the ghosts, in drawing units.
    """

    can_finish = True

    def __init__(self, context: ToolContext) -> None:
        super().__init__(context)
        self.positions = suggested_positions(context)

    @property
    def press_hint(self) -> str:
        if self.hovered is not None and "alt" in self.context.held:
            return tr("Click to remove this suggestion")
        return tr("Drag suggestions to move them, Alt-click to remove one; Enter adds the pins, Esc cancels")

    @property
    def cursor(self) -> Cursor:
        return "arrow" if self.hovered is None else "hand"

    @property
    def markers(self) -> Markers:
        return self.markers_with(self.hovered)

    def markers_with(self, hovered: int | None) -> Markers:
        """The ghosts. hovered: the number of the one that is drawn larger."""
        to_screen = self.context.camera.to_screen
        return Markers(
            suggested_pins=tuple(to_screen(position) for position in self.positions),
            hovered_suggestion=hovered,
            removes_hovered_pin="alt" in self.context.held,
        )

    def press(self, event: PointerEvent) -> None:
        ghost = self._at(event.position)
        if ghost is None:
            return
        if event.alt or event.button == "right":
            del self.positions[ghost]
        elif event.button == "left":
            self.context.set_tool(MovingSuggestion(self.context, self, ghost))

    def key(self, event: KeyEvent) -> bool:
        if event.key == "enter":
            self.finish()
        elif event.key == "escape":
            self.context.return_to_idle()
        else:
            return False
        return True

    def finish(self) -> None:
        """Add the pins in one gesture."""
        self.context.return_to_idle()
        add_pins(self.context, self.positions)

    @property
    def hovered(self) -> int | None:
        """The number of the ghost under the pointer."""
        pointer = self.context.pointer
        return None if pointer is None else self._at(pointer)

    def _at(self, position: Point) -> int | None:
        """The number of the nearest ghost within reach of a point of the screen."""
        to_screen = self.context.camera.to_screen
        distances = [(distance(to_screen(ghost), position), at) for at, ghost in enumerate(self.positions)]
        nearest = min(distances, default=None)
        if nearest is None or nearest[0] > PICK_RADIUS * self.context.ui_scale:
            return None
        return nearest[1]


class MovingSuggestion(Tool):
    """A ghost follows the pointer over the drawing."""

    hint = mark("Release to keep this place, Esc to cancel")
    cursor: Cursor = "grab"

    def __init__(self, context: ToolContext, suggestions: SuggestedPins, ghost: int) -> None:
        super().__init__(context)
        self._suggestions, self._ghost = suggestions, ghost
        self._position_before = suggestions.positions[ghost]

    @property
    def markers(self) -> Markers:
        return self._suggestions.markers_with(self._ghost)

    def move(self, event: PointerEvent) -> None:
        if self.context.is_on_drawing(event.position):
            self._suggestions.positions[self._ghost] = self.context.camera.to_drawing(event.position)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.context.set_tool(self._suggestions)

    def cancel(self) -> None:
        self._suggestions.positions[self._ghost] = self._position_before
        self.context.set_tool(self._suggestions)
