"""How time passes on the way from one moment to another: evenly, or with a slow start or end."""

from collections.abc import Callable

from ...errors import InputError

EASINGS: dict[str, Callable[[float], float]] = {
    "none": lambda t: t,
    "in": lambda t: t * t,
    "out": lambda t: t * (2 - t),
    "in-out": lambda t: t * t * (3 - 2 * t),
}
KEY_EASINGS: dict[str, Callable[[float], float]] = {**EASINGS, "hold": lambda t: float(t >= 1)}


def easing(name: str) -> Callable[[float], float]:
    """A way from 0 to 1 that starts slowly ("in"), ends slowly ("out"), both or none. Raises InputError."""
    return EASINGS[_known(name, EASINGS)]


def key_easing(name: str) -> Callable[[float], float]:
    """As `easing`; between keyframes there is also "hold", which waits and then jumps. Raises InputError."""
    return KEY_EASINGS[as_key_easing(name)]


def as_key_easing(name: object) -> str:
    """A name of `KEY_EASINGS`. Raises InputError on anything else."""
    return _known(name, KEY_EASINGS)


def _known(name: object, names: dict[str, Callable[[float], float]]) -> str:
    if not isinstance(name, str) or name not in names:
        raise InputError(f"ease: expected one of {', '.join(names)}, got {name!r}")
    return name
