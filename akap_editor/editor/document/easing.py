"""Easing: how fast time passes between two moments, such as two keyframes."""

from collections.abc import Callable

from ...errors import InputError

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
    "smooth": "Smooth",
    "none": "Linear",
    "in": "Ease In",
    "out": "Ease Out",
    "in-out": "Ease In and Out",
    "hold": "Hold",
}  # on the screen


def easing_function(name: str) -> Callable[[float], float]:
    """The function of `EASINGS` with this name; it maps [0, 1] onto [0, 1]. Raises InputError."""
    return EASINGS[_check_name(name, EASINGS)]


def keyframe_easing_function(name: str) -> Callable[[float], float]:
    """The function of `KEYFRAME_EASINGS` with this name, on [0, 1]. Raises InputError."""
    return KEYFRAME_EASINGS[_check_name(name, KEYFRAME_EASINGS)]


def check_keyframe_easing(name: object) -> str:
    """Return ``name`` if it is one of `KEYFRAME_EASINGS`. Raises InputError otherwise."""
    return _check_name(name, KEYFRAME_EASINGS)


def _check_name(name: object, easings: dict[str, Callable[[float], float]]) -> str:
    if not isinstance(name, str) or name not in easings:
        raise InputError(f"ease: expected one of {', '.join(easings)}, got {name!r}")
    return name
