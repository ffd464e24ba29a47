"""Easing: how fast time passes between two moments, such as two keyframes."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import hypot

from ...errors import InputError
from ...geometry.validation import as_number
from ...words import mark, tr

EASINGS: dict[str, Callable[[float], float]] = {
    "none": lambda t: t,
    "in": lambda t: t * t,
    "out": lambda t: t * (2 - t),
    "in-out": lambda t: t * t * (3 - 2 * t),
}
# "smooth" has no function of its own: how the motion passes a keyframe depends on both of its neighbors
KEYFRAME_EASINGS: dict[str, Callable[[float], float]] = {
    "smooth": lambda t: t,
    **EASINGS,
    "hold": lambda t: float(t >= 1),
}
NEW_EASING = "smooth"  # of animations that begin
# Velocity at the start and at the end of an interval, by its mean velocity; None where its neighbors decide.
END_VELOCITIES: dict[str, tuple[float, float] | None] = {
    "smooth": None,
    "none": (1.0, 1.0),
    "in": (0.0, 2.0),
    "out": (2.0, 0.0),
    "in-out": (0.0, 0.0),
    "hold": (0.0, 0.0),
}
EASING_LABELS = {
    "smooth": mark("Smooth"),
    "none": mark("Linear"),
    "in": mark("Ease In"),
    "out": mark("Ease Out"),
    "in-out": mark("Ease In and Out"),
    "hold": mark("Hold"),
}  # on the screen


MIN_PROGRESS, MAX_PROGRESS = -1.0, 2.0  # of the handles of a curve: beyond 0 and 1 it overshoots a pose
CURVE_LABEL = mark("Curve")  # on the screen
_NUMBER = r"\s*(-?[0-9]+(?:\.[0-9]+)?)\s*"
_CURVE_TEXT = re.compile(rf"cubic-bezier\({_NUMBER},{_NUMBER},{_NUMBER},{_NUMBER}\)")
_MAX_TEXT = 100  # characters
_HALVINGS = 40  # of the interval in which the parameter of a curve is searched
_STEEPEST_END = 1e3  # velocity at an end whose handle points straight up


@dataclass(frozen=True)
class EasingCurve:
    """An easing as a cubic Bézier curve from (0, 0) to (1, 1) with two handles, as in CSS.

    x1, x2: shares of the time, 0 to 1; y1, y2: shares of the motion, `MIN_PROGRESS` to `MAX_PROGRESS`.
    Raises InputError out of range.
    """

    x1: float
    y1: float
    x2: float
    y2: float

    def __post_init__(self) -> None:
        for name in ("x1", "x2"):
            as_number(getattr(self, name), f"{name} of a curve", 0, 1)
        for name in ("y1", "y2"):
            as_number(getattr(self, name), f"{name} of a curve", MIN_PROGRESS, MAX_PROGRESS)

    @property
    def name(self) -> str:
        """The easing's name in documents and recordings, as CSS writes it, with three decimals."""
        numbers = (round(value, 3) + 0.0 for value in (self.x1, self.y1, self.x2, self.y2))
        return f"cubic-bezier({', '.join(f'{number:g}' for number in numbers)})"

    @property
    def end_velocities(self) -> tuple[float, float]:
        """Velocities at the start and at the end, by the mean velocity."""
        starts = (self.x1, self.y1), (self.x2, self.y2)
        first = next(((x, y) for x, y in starts if hypot(x, y)), (1, 1))
        last = next(
            ((x, y) for x, y in ((1 - self.x2, 1 - self.y2), (1 - self.x1, 1 - self.y1)) if hypot(x, y)),
            (1, 1),
        )
        return _slope(*first), _slope(*last)

    def mirrored(self) -> "EasingCurve":
        """The curve of the motion that is played backwards."""
        return EasingCurve(1 - self.x2, 1 - self.y2, 1 - self.x1, 1 - self.y1)

    def value(self, t: float) -> float:
        """The share of the motion at a share of the time, 0 to 1."""
        if t <= 0 or t >= 1:
            return 0.0 if t <= 0 else 1.0
        low, high = 0.0, 1.0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (middle, high) if _bezier(middle, self.x1, self.x2) < t else (low, middle)
        return _bezier((low + high) / 2, self.y1, self.y2)


_LIKE_CURVES = {
    "none": EasingCurve(1 / 3, 1 / 3, 2 / 3, 2 / 3),
    "in": EasingCurve(1 / 3, 0, 2 / 3, 1 / 3),
    "out": EasingCurve(1 / 3, 2 / 3, 2 / 3, 1),
}
_EASE_IN_AND_OUT = EasingCurve(1 / 3, 0, 2 / 3, 1)


def easing_function(name: str) -> Callable[[float], float]:
    """The function of `EASINGS` with this name; it maps [0, 1] onto [0, 1]. Raises InputError."""
    return EASINGS[_check_name(name, EASINGS)]


def keyframe_easing_function(name: str) -> Callable[[float], float]:
    """The function on [0, 1] of an easing, see `check_keyframe_easing`. Raises InputError."""
    curve = easing_curve(check_keyframe_easing(name))
    return KEYFRAME_EASINGS[name] if curve is None else curve.value


def check_keyframe_easing(name: object) -> str:
    """Return ``name`` if it is in `KEYFRAME_EASINGS` or of an `EasingCurve`. Raises InputError otherwise."""
    if isinstance(name, str) and easing_curve(name) is not None:
        return name
    return _check_name(name, KEYFRAME_EASINGS, " or cubic-bezier(x1, y1, x2, y2)")


@lru_cache(256)
def easing_curve(name: str) -> EasingCurve | None:
    """The curve with this name; None for another easing. Raises InputError on handles out of range."""
    match = _CURVE_TEXT.fullmatch(name) if len(name) <= _MAX_TEXT else None
    return None if match is None else EasingCurve(*map(float, match.groups()))


def curve_like(name: str) -> EasingCurve:
    """The curve with which handles of an easing begin: the same motion if there is one, else a near one."""
    return easing_curve(name) or _LIKE_CURVES.get(name, _EASE_IN_AND_OUT)


def end_velocities(name: str) -> tuple[float, float] | None:
    """Velocities of an easing at both ends, by the mean velocity; None where its neighbors decide."""
    curve = easing_curve(name)
    return END_VELOCITIES[name] if curve is None else curve.end_velocities


def mirrored_easing(name: str) -> str:
    """The easing of an interval that is played backwards."""
    curve = easing_curve(name)
    return {"in": "out", "out": "in"}.get(name, name) if curve is None else curve.mirrored().name


def easing_label(name: str) -> str:
    """The easing on the screen."""
    return EASING_LABELS.get(name, CURVE_LABEL)


def _check_name(name: object, easings: dict[str, Callable[[float], float]], more: str = "") -> str:
    if not isinstance(name, str) or name not in easings:
        names = ", ".join(easings) + more
        raise InputError(tr("ease: expected one of {names}, got {name!r:.80}", names=names, name=name))
    return name


def _bezier(u: float, first: float, second: float) -> float:
    """A coordinate of a cubic Bézier curve from 0 to 1."""
    return 3 * u * (1 - u) ** 2 * first + 3 * u * u * (1 - u) * second + u**3


def _slope(x: float, y: float) -> float:
    return (
        max(-_STEEPEST_END, min(y / x, _STEEPEST_END)) if x else (_STEEPEST_END if y > 0 else -_STEEPEST_END)
    )
