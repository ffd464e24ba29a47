"""A clip: the motion of named pins, in the form of a tree, without a drawing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....errors import InputError
from ....geometry.validation import MAX_COORDINATE, Floats, as_points
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.easing import check_keyframe_easing
from ...document.keyframes import Animation, as_keyframe_time
from ...document.pin import MAX_PIN_NAME, Pin, pin_points
from .pin_tree import pin_tree

MAX_CLIP_PINS, MAX_CLIP_KEYS = 1000, 1000
_NEAR = 0.12  # of √area: a pin this near to a place is the one that is meant
_SIDES = (("left", "right"), ("Left", "Right"), ("LEFT", "RIGHT"))


@dataclass(frozen=True)
class ClipPin:
    """A pin of a clip. parent: the name of the pin that it hangs on, None for the root."""

    name: str
    parent: str | None


@dataclass(frozen=True, eq=False)
class ClipKey:
    """Positions of a clip's pins, (k, 2) in their order, at a time in seconds from its start.

    ease: the easing to the next key, see `easing.check_keyframe_easing`.
    """

    time: float
    positions: Floats
    ease: str = "smooth"


@dataclass(frozen=True, eq=False)
class Clip:
    """A motion of named pins.

    pins: k of them, one of which is the root of the tree; rest: (k, 2) their positions at rest, in any unit;
    keys: with ascending times, the first at 0. Raises InputError on anything else.
    """

    name: str
    pins: tuple[ClipPin, ...]
    rest: Floats
    keys: tuple[ClipKey, ...]

    def __post_init__(self) -> None:
        _check_tree(self.pins)
        if not 1 <= len(self.keys) <= MAX_CLIP_KEYS:
            raise InputError(
                tr("keys: expected 1 to {most} keys, got {count}", most=MAX_CLIP_KEYS, count=len(self.keys))
            )
        _check_points(self.rest, "rest", len(self.pins))
        for key in self.keys:
            _check_points(key.positions, "positions", len(self.pins))
            check_keyframe_easing(key.ease)
        times = [as_keyframe_time(key.time) for key in self.keys]
        if times != sorted(set(times)) or times[0] != 0:
            raise InputError(tr("keys: expected times that grow from 0, got {times!r:.100}", times=times))

    @property
    def duration(self) -> float:
        """Seconds from the first key to the last one."""
        return self.keys[-1].time

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the pins."""
        return tuple(pin.name for pin in self.pins)

    def mirrored(self) -> "Clip":
        """The clip with left and right exchanged, in names and positions."""
        pins = tuple(
            ClipPin(other_side(pin.name), None if pin.parent is None else other_side(pin.parent))
            for pin in self.pins
        )
        keys = tuple(ClipKey(key.time, key.positions * [-1.0, 1.0], key.ease) for key in self.keys)
        return Clip(self.name, pins, self.rest * [-1.0, 1.0], keys)


def other_side(name: str) -> str:
    """The name with “left” and “right” exchanged."""
    for left, right in _SIDES:
        if left in name:
            return name.replace(left, right)
        if right in name:
            return name.replace(right, left)
    return name


def clip_from_keyframes(
    name: str, drawing: Drawing, state: EditState, animation: Animation, times: Sequence[float]
) -> Clip:
    """The motion of the named pins of a drawing through its keyframes at some times.

    Raises InputError if no pin has a name, two have the same, or there is no keyframe.
    """
    pins = [pin for pin in state.pins if pin.name]
    keyframes = animation.keyframes_at(times)
    if not pins:
        raise InputError(tr("A clip needs pins with names; name the pins that are to move"))
    if not keyframes:
        raise InputError(tr("A clip needs keyframes; select those of the motion"))
    mesh, points = drawing.mesh, pin_points(pins)
    start = keyframes[0].time
    keys = tuple(
        ClipKey(each.time - start, mesh.evaluate(points, each.positions), animation.easing_after(each))
        for each in keyframes
    )
    parents = pin_tree(mesh, pins)
    clip_pins = tuple(
        ClipPin(pin.name, None if parent is None else pins[parent].name)
        for pin, parent in zip(pins, parents, strict=True)
    )
    return Clip(name, clip_pins, mesh.evaluate(points, mesh.vertices), keys)


def named_pins(pins: Sequence[Pin]) -> dict[str, Pin]:
    """Pins by their names; of several with one name, the first."""
    by_name: dict[str, Pin] = {}
    for pin in pins:
        if pin.name:
            by_name.setdefault(pin.name, pin)
    return by_name


def pins_with_names(
    drawing: Drawing, state: EditState, places: Mapping[str, tuple[float, float]]
) -> tuple[Pin, ...]:
    """The pins of a state, with named ones at ``places`` at rest, pixels, if it lacks these names.

    An unnamed pin that is near such a place gets its name; else a pin is added, which stays where it is.
    """
    mesh, pins = drawing.mesh, list(state.pins)
    missing = {name: place for name, place in places.items() if name not in named_pins(pins)}
    for name, place in missing.items():
        rest = mesh.evaluate(pin_points(pins), mesh.vertices)
        far = np.linalg.norm(rest - place, axis=1) if len(pins) else np.empty(0)
        free = [k for k, pin in enumerate(pins) if not pin.name and far[k] < _NEAR * mesh.length]
        if free:
            nearest = min(free, key=lambda k: far[k])
            pins[nearest] = replace(pins[nearest], name=name)
            continue
        point = mesh.locate([place])
        (target,) = mesh.evaluate(point, state.positions)
        pin_id = 1 + max((pin.id for pin in pins), default=0)
        pins.append(Pin(pin_id, int(point.faces[0]), point.weights[0], target, name=name))
    return tuple(pins) if missing else state.pins


def _check_points(points: Any, name: str, count: int) -> None:
    if abs(as_points(points, name, count)).max(initial=0.0) > MAX_COORDINATE:
        raise InputError(tr("{name}: expected coordinates up to {most:g}", name=name, most=MAX_COORDINATE))


def _check_tree(pins: Sequence[ClipPin]) -> None:
    """Raise InputError unless the pins have names of their own and are one tree."""
    if not 1 <= len(pins) <= MAX_CLIP_PINS:
        raise InputError(
            tr("pins: expected 1 to {most} pins, got {count}", most=MAX_CLIP_PINS, count=len(pins))
        )
    parents = {pin.name: pin.parent for pin in pins}
    if len(parents) < len(pins) or any(not 0 < len(name) <= MAX_PIN_NAME for name in parents):
        raise InputError(tr("pins: expected different names of 1 to {most} letters", most=MAX_PIN_NAME))
    roots = [name for name, parent in parents.items() if parent is None]
    if len(roots) != 1 or any(parent not in parents for parent in parents.values() if parent is not None):
        raise InputError(tr("pins: expected one root, and parents among the pins"))
    for name in parents:
        at: str | None = name
        for _ in range(len(pins)):
            at = parents[at] if at is not None else None
        if at is not None:
            raise InputError(tr("pins: expected a tree, got a circle with {name!r:.60}", name=name))
