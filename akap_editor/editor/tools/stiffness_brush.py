"""The stiffness brush: it paints areas that bend less, or loose ones, which swing about the pose."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ...deform.follow_through import (
    DEFAULT_BOUNCE,
    DEFAULT_SPEED,
    MAX_BOUNCE,
    MAX_SPEED,
    MIN_SPEED,
)
from ...geometry.validation import Floats
from ...words import mark, tr
from ..camera import Point
from ..document.drawing import point_of_layer, visible_point
from ..document.rig.loose_parts import LooseParts, painted_loose
from ..document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS, apply_stroke, stroke_coverage
from ..events import PointerEvent
from ..session.edits import PaintLoose, PaintStiffness, SetSwing
from .base import BrushCircle, Cursor, IdleTool, Markers, Tool, ToolContext

MIN_RADIUS, MAX_RADIUS = 4.0, 400.0  # points of the design
_RADIUS_STEP = 1.25  # ratio of a radius to the next smaller one
_DAB_SPACING = 0.25  # distance between two dabs of a stroke, as a share of the radius


@dataclass(frozen=True)
class Brush:
    """The options of the brush.

    radius: in points of the design, at any zoom; factor: by which painted areas are stiffer; erasing: whether
    it removes what it paints; paints: what that is; speed, bounce: of the first loose parts of a drawing, see
    `LooseParts`.
    """

    radius: float = 32.0
    factor: float = 100.0
    erasing: bool = False
    paints: Literal["stiff", "loose"] = "stiff"
    speed: float = DEFAULT_SPEED
    bounce: float = DEFAULT_BOUNCE

    def to_json(self) -> list[object]:
        """What the next start of the program takes over by `restored`: all but the eraser."""
        return [self.factor, self.radius, self.paints, self.speed, self.bounce]

    @classmethod
    def restored(cls, values: list[object]) -> "Brush":
        """The brush that wrote ``values``, or earlier versions their first two; the default one for others.

        Numbers are clamped to their ranges, because the file may have been edited by hand; NaN becomes the
        upper limit.
        """
        match values:
            case [int() | float() as factor, int() | float() as radius, *others]:
                brush = cls(
                    _clamp(radius, MIN_RADIUS, MAX_RADIUS), _clamp(factor, MIN_STIFFNESS, MAX_STIFFNESS)
                )
            case _:
                return cls()
        match others:
            case ["stiff" | "loose" as paints, int() | float() as speed, int() | float() as bounce]:
                speed, bounce = _clamp(speed, MIN_SPEED, MAX_SPEED), _clamp(bounce, 0.0, MAX_BOUNCE)
                return replace(brush, paints=paints, speed=speed, bounce=bounce)
        return brush

    def resized(self, larger: bool) -> "Brush":
        """The next larger or smaller brush."""
        radius = self.radius * (_RADIUS_STEP if larger else 1 / _RADIUS_STEP)
        return replace(self, radius=min(max(radius, MIN_RADIUS), MAX_RADIUS))


def _clamp(value: float, low: float, high: float) -> float:
    return max(low, min(high, value))


class BrushIdle(IdleTool):
    """The stiffness brush waits for a press. brush: its options."""

    def __init__(self, context: ToolContext) -> None:
        super().__init__(context)
        self.brush = Brush()
        self.last_end: Point | None = (
            None  # of the last stroke, in the drawing: Shift-click goes on from there
        )

    @property
    def press_hint(self) -> str:
        if self.brush.paints == "loose":
            if self.brush.erasing:
                return tr("Drag over loose parts so that they no longer swing, E to paint")
            return tr("Paint ears, tails or hair that should swing, right-drag to erase")
        if self.brush.erasing:
            return tr("Drag over areas to erase their stiffness, E to paint")
        return tr(
            "Paint areas to stiffen ({factor:.3g}×), Shift-click for a line, right-drag to erase",
            factor=self.brush.factor,
        )

    @property
    def keyboard_hint(self) -> str:
        if self.brush.paints == "loose":
            return tr("Enter uses the brush in the circle, [ and ] change its size, arrows move it, Esc ends")
        if self.brush.erasing:
            return tr(
                "Enter erases stiffness in the circle, [ and ] change its size, arrows move it, Esc ends"
            )
        return tr("Enter stiffens in the circle, [ and ] change its size, arrows move it, Esc ends")

    @property
    def cursor(self) -> Cursor:
        return "arrow" if self.context.session is None else "hidden"

    @property
    def markers(self) -> Markers:
        """The circle of the brush around the pointer."""
        pointer = self.context.pointer
        if self.context.session is None or pointer is None:
            return Markers()
        return Markers(brush=BrushCircle(pointer, self.radius_on_screen, self.brush.erasing))

    @property
    def radius_on_screen(self) -> float:
        """Radius of the brush in points of the screen."""
        return self.brush.radius * self.context.ui_scale

    @property
    def shown_stiffness(self) -> Floats | None:
        session = self.context.session
        return None if session is None or self.brush.paints != "stiff" else session.state.stiffness

    @property
    def shown_loose(self) -> LooseParts | None:
        session = self.context.session
        return None if session is None or self.brush.paints != "loose" else session.state.loose

    def press(self, event: PointerEvent) -> None:
        if self.context.session is not None:
            self.context.set_tool(Painting(self.context, event, self))


class Painting(Tool):
    """A stroke of the brush. It is shown while it grows, and applied to the document when it ends.

    In a drawing in layers it paints the layer that is seen where it begins, and no other.
    """

    cursor = "hidden"

    def __init__(self, context: ToolContext, event: PointerEvent, idle_tool: BrushIdle) -> None:
        super().__init__(context)
        session, brush = self.session, idle_tool.brush
        erases = brush.erasing or event.button == "right"
        self._idle_tool, self._brush, self._erases = idle_tool, brush, erases
        self._button, self._last = event.button, event.position
        if event.shift and idle_tool.last_end is not None:
            self._last = context.camera.to_screen(idle_tool.last_end)
        self._factor = MIN_STIFFNESS if erases else brush.factor
        self._radius_on_screen = idle_tool.radius_on_screen
        self._radius = self._radius_on_screen / context.camera.zoom
        self._dabs: list[Floats] = []
        self._layer: int | None = None
        self._coverage = np.zeros(len(session.drawing.mesh.faces))
        self._stiffness, self._loose = session.state.stiffness, session.state.loose
        if self._is_loose:
            session.begin(mark("Erase Loose Parts") if erases else mark("Paint Loose Parts"))
        else:
            session.begin(mark("Erase Stiffness") if erases else mark("Paint Stiffness"))
        self.move(event)

    @property
    def hint(self) -> str:
        """What the stroke does."""
        return (
            tr("Release to erase, Esc to cancel") if self._erases else tr("Release to paint, Esc to cancel")
        )

    @property
    def markers(self) -> Markers:
        """The circle of the brush around the pointer."""
        return self._idle_tool.markers

    @property
    def shown_stiffness(self) -> Floats | None:
        """(m,) stiffness with the stroke so far; None is 1 everywhere."""
        return None if self._is_loose else self._stiffness

    @property
    def shown_loose(self) -> LooseParts | None:
        """The loose parts with the stroke so far."""
        return self._loose if self._is_loose else None

    @property
    def _is_loose(self) -> bool:
        return self._brush.paints == "loose"

    def move(self, event: PointerEvent) -> None:
        start, end = np.array(self._last), np.array(event.position)
        spacing = _DAB_SPACING * self._radius_on_screen
        count = max(1, math.ceil(float(np.hypot(*(end - start))) / spacing))
        positions = [start + (end - start) * number / count for number in range(1, count + 1)]
        dabs = [dab for x, y in positions if (dab := self._at_rest((float(x), float(y)))) is not None]
        self._last = event.position
        if dabs:
            self._dabs += dabs
            coverage = stroke_coverage(self.session.drawing.mesh, dabs, self._radius, self._layer)
            self._coverage = np.maximum(self._coverage, coverage)
            before = self.session.state
            if self._is_loose:
                self._loose = painted_loose(before.loose, self._coverage, self._erases)
            else:
                self._stiffness = apply_stroke(before.stiffness, self._coverage, self._factor)

    def _at_rest(self, position: Point) -> Floats | None:
        """The point (2,) of the rest pose that is seen at a point of the screen; None outside the drawing.

        After the first one it is on the same layer, which may be covered there.
        """
        session = self.session
        drawing, pose = session.drawing, session.state.positions
        mesh, center = drawing.mesh, self.context.camera.to_drawing(position)
        order = session.document.face_order
        if self._layer is None:
            point = visible_point(drawing, center, pose, order, unlocked=True)
            if point is not None and drawing.layers:
                self._layer = int(drawing.face_layers[point.faces[0]])
        else:
            point = point_of_layer(drawing, center, pose, order, self._layer)
        return None if point is None else np.round(mesh.evaluate(point, mesh.vertices)[0], 3)

    def release(self, event: PointerEvent) -> None:
        if event.button == self._button:
            if self._dabs:
                self._idle_tool.last_end = self.context.camera.to_drawing(self._last)
                self._apply()
            self.session.commit()
            self.context.return_to_idle()

    def _apply(self) -> None:
        session = self.session
        if not self._is_loose:
            session.apply(PaintStiffness(self._dabs, self._radius, self._factor, self._layer))
            return
        is_first = session.state.loose is None
        session.apply(PaintLoose(self._dabs, self._radius, self._erases, self._layer))
        if is_first and session.state.loose is not None:
            session.apply(SetSwing(self._brush.speed, self._brush.bounce))

    def cancel(self) -> None:
        self.session.abort()
        super().cancel()
