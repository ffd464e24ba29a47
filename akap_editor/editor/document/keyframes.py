"""Keyframes: poses at times, what is changed about them, and where a moment lies between two."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...errors import InputError
from ...geometry.validation import Floats, as_number
from .easing import check_keyframe_easing, keyframe_easing_function
from .named_poses import as_pose

MAX_KEYFRAME_TIME = 3600.0  # seconds
TIME_DECIMALS = 3  # times are whole milliseconds, so that a keyframe is found by its time


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A pose (n, 2) float64, in pixels, at a time in seconds.

    ease: how it goes from here to the next one, a name of `easing.KEYFRAME_EASINGS`; None: as in the whole
    animation.
    """

    time: float
    positions: Floats
    ease: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", as_keyframe_time(self.time))
        object.__setattr__(self, "positions", as_pose(self.positions, "keyframe"))
        if self.ease is not None:
            check_keyframe_easing(self.ease)


@dataclass(frozen=True, eq=False)
class Animation:
    """keys: in the order of their times, of which no two are alike; ease: between them, see `Keyframe`;
    loop: whether it plays over and over.
    """

    keyframes: tuple[Keyframe, ...] = ()
    ease: str = "in-out"
    loop: bool = True

    def __post_init__(self) -> None:
        check_keyframe_easing(self.ease)
        times = [key.time for key in self.keyframes]
        if times != sorted(set(times)):
            raise InputError(f"keyframes: expected times that grow, got {times}")

    @property
    def duration(self) -> float:
        """Seconds from 0 to the last keyframe."""
        return self.keyframes[-1].time if self.keyframes else 0.0

    @property
    def times(self) -> tuple[float, ...]:
        """Of all keyframes."""
        return tuple(key.time for key in self.keyframes)

    def keyframes_around(self, time: float) -> tuple[Keyframe, Keyframe, float]:
        """The keyframes around a time, and the share of the way from one to the other that is done then.

        Twice the same one before the first and after the last. There must be one.
        """
        later = next(
            (number for number, key in enumerate(self.keyframes) if key.time > time), len(self.keyframes)
        )
        if later == 0 or later == len(self.keyframes):
            alone = self.keyframes[max(later - 1, 0)]
            return alone, alone, 0.0
        start, end = self.keyframes[later - 1 : later + 1]
        ease = keyframe_easing_function(start.ease or self.ease)
        return start, end, ease((time - start.time) / (end.time - start.time))

    def with_keyframe(self, key: Keyframe) -> "Animation":
        """One more keyframe; one of the same time makes way, and leaves its easing where none is said."""
        old = {each.time: each for each in self.keyframes}
        if key.ease is None and key.time in old:
            key = replace(key, ease=old[key.time].ease)
        return self._of({**old, key.time: key})

    def without_keyframes(self, times: Iterable[float]) -> "Animation":
        """The keyframes but those at some times."""
        gone = set(times)
        return replace(self, keyframes=tuple(key for key in self.keyframes if key.time not in gone))

    def with_moved_keyframes(self, times: Mapping[float, float], copy: bool = False) -> "Animation":
        """Keyframes, by their times, at other times; those that stand there make way; copy: they stay."""
        keys = {key.time: key for key in self.keyframes}
        stay = {time: key for time, key in keys.items() if copy or time not in times}
        return self._of({**stay, **_shifted(keys, times)})

    def with_easing(self, times: Iterable[float] | None, ease: str | None) -> "Animation":
        """Another easing from some keyframes on, by their times; without times, where none is said.

        Raises InputError.
        """
        if times is None:
            return replace(self, ease=check_keyframe_easing(ease))
        chosen = set(times)
        keys = (replace(key, ease=ease) if key.time in chosen else key for key in self.keyframes)
        return replace(self, keyframes=tuple(keys))

    def with_poses(self, carry: Callable[[Floats], Floats]) -> "Animation":
        """The same on another mesh; carry: makes its poses of those that are here."""
        poses = {id(key.positions): key.positions for key in self.keyframes}
        made = {number: carry(pose) for number, pose in poses.items()}
        return replace(
            self, keyframes=tuple(replace(key, positions=made[id(key.positions)]) for key in self.keyframes)
        )

    def _of(self, keys: Mapping[float, Keyframe]) -> "Animation":
        return replace(self, keyframes=tuple(keys[time] for time in sorted(keys)))


NO_ANIMATION = Animation()


def _shifted(keys: Mapping[float, Keyframe], times: Mapping[float, float]) -> dict[float, Keyframe]:
    shifted = (replace(keys[old], time=new) for old, new in times.items() if old in keys)
    return {key.time: key for key in shifted}


def as_keyframe_time(value: Any) -> float:
    """A time as keyframes have it. Raises InputError out of range."""
    return round(as_number(value, "time of a keyframe", 0, MAX_KEYFRAME_TIME), TIME_DECIMALS)
