"""Gestures on several pins at once: nudge, align, distribute, depth and stiffness."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..words import mark
from .document.pin import Pin, pin_points
from .document.stiffness import MIN_STIFFNESS
from .gestures import EditContext
from .mirroring import mirrored_targets, with_partners
from .session import pin_edits
from .session.edits import PaintStiffness, SetTargets
from .session.history import HistoryEntry
from .session.session import Session

NUDGE, BIG_NUDGE = 1.0, 10.0  # pixels
SERIES_PAUSE = 1.0  # seconds: a longer pause between two nudges starts a new gesture
_STIFF_SHARE = 0.12  # radius of the stiffness around a pin, as a share of the drawing's length


class NudgeSeries:
    """Moves the selected pins by small steps; steps in quick succession are one gesture.

    clock: returns seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._last: tuple[HistoryEntry | None, frozenset[int], float] | None = None  # entry, pins, time

    def nudge_towards(self, editor: EditContext, direction: tuple[int, int], is_long: bool) -> None:
        """Move the targets of the selected pins by a step along a direction of the screen."""
        length = BIG_NUDGE if is_long else NUDGE
        self.nudge(editor, length * direction[0], length * direction[1])

    def nudge(self, editor: EditContext, dx: float, dy: float) -> None:
        """Move the targets of the selected pins by (dx, dy) pixels."""
        session = editor.session
        if session is None or editor.is_busy:
            return
        locked = {pin.id for pin in session.state.pins if pin.is_locked}
        pins = editor.selection - locked
        if not pins:
            return
        now = self._clock()
        entry, last_pins, last_time = self._last or (None, pins, now)
        joins = entry is not None and entry is session.history.last and last_pins == pins
        session.begin(mark("Nudge Pin") if len(pins) == 1 else f"Nudge {len(pins)} Pins")
        try:
            pin_edits.hold_stopped_pins(session)
            moved = (session.state.pin(pin) for pin in sorted(with_partners(session, pins)))
            starts = {pin.id: (float(pin.target[0]), float(pin.target[1])) for pin in moved}
            leader = min(pins)
            session.apply(SetTargets(mirrored_targets(session, starts, np.array([dx, dy]), leader)))
        except Exception:
            session.abort()
            raise
        session.commit(join=joins and now - last_time < SERIES_PAUSE)
        self._last = session.history.last, pins, now


@dataclass(frozen=True)
class Alignment:
    """Where pins are moved along an axis: 0 is x, 1 is y; low is left or top."""

    axis: int
    end: Literal["low", "middle", "high"]


def align_pins(editor: EditContext, alignment: Alignment) -> None:
    """Move the targets of the selected pins to one coordinate; locked pins stay, but count."""
    coordinates = _coordinates(editor, alignment.axis)
    if len(coordinates) < 2:
        return
    low, high = min(coordinates.values()), max(coordinates.values())
    value = {"low": low, "middle": (low + high) / 2, "high": high}[alignment.end]
    _move(editor, "Align Pins", alignment.axis, dict.fromkeys(coordinates, value))


def distribute_pins(editor: EditContext, axis: int) -> None:
    """Move the targets of the selected pins so that they have equal distances along an axis, 0 or 1."""
    coordinates = _coordinates(editor, axis)
    if len(coordinates) < 3:
        return
    ordered = sorted(coordinates, key=lambda pin: coordinates[pin])
    ends = coordinates[ordered[0]], coordinates[ordered[-1]]
    values = np.linspace(*ends, len(ordered)).tolist()
    _move(editor, "Distribute Pins", axis, dict(zip(ordered, values, strict=True)))


def _coordinates(editor: EditContext, axis: int) -> dict[int, float]:
    """One coordinate of the selected pins where they are now, by id."""
    session = editor.session
    if session is None:
        return {}
    positions = zip(session.state.pins, session.pin_positions()[:, axis].tolist(), strict=True)
    return {pin.id: value for pin, value in positions if pin.id in editor.selection}


def _move(editor: EditContext, label: str, axis: int, values: dict[int, float]) -> None:
    """Move the pins that are not locked to these coordinates."""

    def move(session: Session) -> None:
        pin_edits.hold_stopped_pins(session)
        targets: dict[int, tuple[float, float]] = {}
        for pin in session.state.pins:
            if pin.id in values and not pin.is_locked:
                x, y = pin.target.tolist()
                targets[pin.id] = (values[pin.id], y) if axis == 0 else (x, values[pin.id])
        session.apply(SetTargets(targets))

    editor.edit(label, move)


def set_depths(editor: EditContext, pins: Iterable[int], depth: int) -> None:
    """Set the depth of pins, by id. Raises InputError on a depth out of range."""
    depths = dict.fromkeys(pins, depth)
    editor.edit(mark("Set Depth"), lambda session: pin_edits.set_depths(session, depths))


def stiffness_at(session: Session, pin: Pin) -> float:
    """The factor by which the drawing is stiffer at a pin."""
    stiffness = session.state.stiffness
    return MIN_STIFFNESS if stiffness is None else float(stiffness[pin.face])


def stiffen_pins(editor: EditContext, pins: Iterable[int], factor: float) -> None:
    """Make the drawing stiffer around pins, by id, in place of what is painted there; a factor of 1 erases.

    Raises InputError on a factor out of range.
    """
    session = editor.session
    if session is None:
        return
    wanted = set(pins)
    chosen = [pin for pin in session.state.pins if pin.id in wanted]
    mesh = session.drawing.mesh
    places = mesh.evaluate(pin_points(chosen), mesh.vertices).round(3).tolist()
    radius = round(_STIFF_SHARE * mesh.length, 3)
    # A dab covers half of its radius wholly, so twice the radius erases all of an earlier one.
    strokes = [(2 * radius, MIN_STIFFNESS), (radius, factor)]
    edits = [
        PaintStiffness([place], reach, value, _layer_of(session, pin))
        for reach, value in strokes[: 1 if factor == MIN_STIFFNESS else 2]
        for pin, place in zip(chosen, places, strict=True)
    ]
    editor.apply(mark("Set Stiffness"), *edits)


def _layer_of(session: Session, pin: Pin) -> int | None:
    """The layer that a pin is on; None in a drawing without layers."""
    return int(session.drawing.face_layers[pin.face]) if session.drawing.layers else None
