"""The brush that paints parts which bend less."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...geometry.validation import Floats
from ..document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS, apply_stroke, stroke_coverage
from ..events import PointerEvent
from ..session.edits import PaintStiffness
from .base import Tool

if TYPE_CHECKING:
    from ..editor import Editor

SMALLEST, LARGEST = 4.0, 400.0  # points of the screen
_GROWTH = 1.25
_SPACING = 0.25  # share of the radius between two dabs of a stroke


@dataclass(frozen=True)
class Brush:
    """radius: in points of the design, whatever the zoom; factor: how much less what it paints bends."""

    radius: float = 32.0
    factor: float = 100.0
    erasing: bool = False

    @classmethod
    def of(cls, radius: float, factor: float) -> "Brush":
        """The nearest brush that there is."""
        return cls(max(SMALLEST, min(LARGEST, radius)), max(MIN_STIFFNESS, min(MAX_STIFFNESS, factor)))

    @property
    def hint(self) -> str:
        """What a press would do."""
        if self.erasing:
            return "Drag over parts that are to bend freely again, E to paint"
        return f"Drag over parts that are to bend {self.factor:.3g} times less, right-drag or E to erase"

    def resized(self, up: bool) -> "Brush":
        """The next larger or smaller one."""
        radius = self.radius * (_GROWTH if up else 1 / _GROWTH)
        return replace(self, radius=min(max(radius, SMALLEST), LARGEST))


class Painting(Tool):
    """The brush is down; what it covers is shown, and taken over in the end.

    stiffness: (m,) as it would be now, None is 1 everywhere.
    """

    def __init__(self, editor: "Editor", event: PointerEvent) -> None:
        super().__init__(editor)
        session = editor.session
        assert session is not None
        erases = editor.brush.erasing or event.button == "right"
        self._button, self._last = event.button, event.position
        self._factor = MIN_STIFFNESS if erases else editor.brush.factor
        self._reach = editor.brush.radius * editor.ui_scale
        self._radius = self._reach / editor.camera.zoom
        self._dabs: list[Floats] = []
        self._covered = np.zeros(len(session.drawing.mesh.faces))
        self.stiffness = session.state.stiffness
        session.begin("Erase stiffness" if erases else "Stiffen")
        self.move(event)

    @property
    def hint(self) -> str:  # type: ignore[override]
        """What the stroke does."""
        does = "erase" if self._factor == MIN_STIFFNESS else "paint"
        return f"Release to {does}, Escape to go back"

    def move(self, event: PointerEvent) -> None:
        start, end = np.array(self._last), np.array(event.position)
        count = max(1, math.ceil(float(np.hypot(*(end - start))) / (_SPACING * self._reach)))
        places = (start + (end - start) * number / count for number in range(1, count + 1))
        dabs = [dab for x, y in places if (dab := self._at_rest((float(x), float(y)))) is not None]
        self._last = event.position
        session = self.editor.session
        if dabs and session is not None:
            self._dabs += dabs
            more = stroke_coverage(session.drawing.mesh, dabs, self._radius)
            self._covered = np.maximum(self._covered, more)
            self.stiffness = apply_stroke(session.state.stiffness, self._covered, self._factor)

    def _at_rest(self, position: tuple[float, float]) -> Floats | None:
        """Where in the rest pose that is which is seen at a point of the screen, (2,)."""
        session = self.editor.session
        assert session is not None
        mesh, at = session.drawing.mesh, self.editor.camera.to_drawing(position)
        found = mesh.find(at, session.state.positions, session.document.face_order)
        return None if found is None else np.round(mesh.evaluate(found, mesh.vertices)[0], 3)

    def release(self, event: PointerEvent) -> None:
        if event.button != self._button:
            return
        session = self.editor.session
        assert session is not None
        if self._dabs:
            session.apply(PaintStiffness(self._dabs, self._radius, self._factor))
        session.commit()
        self.editor.return_to_idle()

    def cancel(self) -> None:
        if self.editor.session is not None:
            self.editor.session.abort()
        super().cancel()


def shown_stiffness(editor: "Editor") -> Floats | None:
    """(m,) what is shown of the stiffness: all while the brush is at hand, None where there is nothing."""
    if editor.session is None or editor.chosen_tool != "brush":
        return None
    return editor.tool.stiffness if isinstance(editor.tool, Painting) else editor.session.state.stiffness
