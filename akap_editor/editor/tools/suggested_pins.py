"""Suggested pins: ghosts where limbs end and fork, to be moved, removed, and then accepted in one step."""

from dataclasses import dataclass

import numpy as np

from ...words import mark, tr
from ..camera import Point
from ..document.rig.pin_suggestion import suggest_places
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


@dataclass(frozen=True)
class Suggestion:
    """A pin that is suggested: its position in drawing units of the pose, and its layer, None for any."""

    position: Point
    layer: int | None = None


def suggestions(context: ToolContext) -> list[Suggestion]:
    """Pins that help to bend the open drawing; none near pins that exist."""
    assert context.session is not None
    drawing, state = context.session.drawing, context.session.state
    mesh = drawing.mesh
    places = suggest_places(drawing, state.joints)
    pins = mesh.evaluate(state.points, mesh.vertices)
    distances = np.linalg.norm(pins[:, None] - places.rest, axis=2).min(axis=0, initial=np.inf)
    places = places.among(np.flatnonzero(distances > MIN_DISTANCE * mesh.length)[:MAX_SUGGESTED])
    positions = mesh.evaluate(places.points(mesh), state.positions)
    layers = (None if layer < 0 else layer for layer in places.layers.tolist())
    return [Suggestion((x, y), layer) for (x, y), layer in zip(positions.tolist(), layers, strict=True)]


class SuggestedPins(IdleTool):
    """Shows the suggestions until they are accepted or cancelled. ghosts: the suggestions."""

    can_finish = True

    def __init__(self, context: ToolContext) -> None:
        super().__init__(context)
        self.ghosts = suggestions(context)

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
            suggested_pins=tuple(to_screen(ghost.position) for ghost in self.ghosts),
            hovered_suggestion=hovered,
            removes_hovered_pin="alt" in self.context.held,
        )

    def press(self, event: PointerEvent) -> None:
        ghost = self._at(event.position)
        if ghost is None:
            return
        if event.alt or event.button == "right":
            del self.ghosts[ghost]
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
        positions = [ghost.position for ghost in self.ghosts]
        add_pins(self.context, positions, [ghost.layer for ghost in self.ghosts])

    @property
    def hovered(self) -> int | None:
        """The number of the ghost under the pointer."""
        pointer = self.context.pointer
        return None if pointer is None else self._at(pointer)

    def _at(self, position: Point) -> int | None:
        """The number of the nearest ghost within reach of a point of the screen."""
        to_screen = self.context.camera.to_screen
        distances = [
            (distance(to_screen(ghost.position), position), at) for at, ghost in enumerate(self.ghosts)
        ]
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
        self._before = suggestions.ghosts[ghost]

    @property
    def markers(self) -> Markers:
        return self._suggestions.markers_with(self._ghost)

    def move(self, event: PointerEvent) -> None:
        if self.context.is_on_drawing(event.position):
            position = self.context.camera.to_drawing(event.position)
            self._suggestions.ghosts[self._ghost] = Suggestion(position)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            self.context.set_tool(self._suggestions)

    def cancel(self) -> None:
        self._suggestions.ghosts[self._ghost] = self._before
        self.context.set_tool(self._suggestions)
