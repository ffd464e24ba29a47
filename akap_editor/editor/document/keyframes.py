"""Keyframes: poses at times, with the easing between them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ...errors import InputError
from ...geometry.validation import Floats, Ints, as_number
from ...layers.layer_view import LayerView
from ...words import tr
from .crossings import as_crossings, no_crossings
from .easing import check_keyframe_easing, keyframe_easing_function
from .named_poses import as_pose
from .pin import Pin, PinDepths, as_pin_depths, with_depths

MAX_KEYFRAME_TIME = 3600.0  # seconds
TIME_DECIMALS = 3  # whole milliseconds, so that a keyframe can be found by its time


@dataclass(frozen=True, eq=False)
class Keyframe:
    """A pose (n, 2) float64, in pixels, at a time in seconds.

    ease: the easing from here to the next keyframe, see `easing.check_keyframe_easing`; None for that of
    the animation. crossings: which part passes in front, (s, 2), see `EditState`. layers: which layers are
    visible from here on, and their order; None leaves them as they are. depths: of the pins from here on;
    pins without one keep theirs. Raises InputError on a time, easing or depth out of range.
    """

    time: float
    positions: Floats
    ease: str | None = None
    crossings: Ints = field(default_factory=no_crossings)
    layers: LayerView | None = None
    depths: PinDepths = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", as_keyframe_time(self.time))
        object.__setattr__(self, "positions", as_pose(self.positions, "keyframe"))
        object.__setattr__(self, "crossings", as_crossings(self.crossings))
        object.__setattr__(self, "depths", as_pin_depths(self.depths))
        if self.ease is not None:
            check_keyframe_easing(self.ease)


@dataclass(frozen=True, eq=False)
class Animation:
    """The keyframes of a document and how they play.

    keyframes: with ascending times; ease: the easing after keyframes without one of their own; loop: whether
    they play over and over. Raises InputError on times that do not ascend, or an unknown easing.
    """

    keyframes: tuple[Keyframe, ...] = ()
    ease: str = "in-out"
    loop: bool = True

    def __post_init__(self) -> None:
        check_keyframe_easing(self.ease)
        times = [keyframe.time for keyframe in self.keyframes]
        if times != sorted(set(times)):
            raise InputError(tr("keyframes: expected times that grow, got {times}", times=times))

    @property
    def duration(self) -> float:
        """Seconds from 0 to the last keyframe."""
        return self.keyframes[-1].time if self.keyframes else 0.0

    @property
    def times(self) -> tuple[float, ...]:
        """The times of all keyframes, seconds."""
        return tuple(keyframe.time for keyframe in self.keyframes)

    def easing_after(self, keyframe: Keyframe) -> str:
        """The name of the easing from a keyframe to the next."""
        return keyframe.ease or self.ease

    def keyframes_at(self, times: Iterable[float]) -> list[Keyframe]:
        """The keyframes at some of the times of the animation."""
        chosen = set(times)
        return [keyframe for keyframe in self.keyframes if keyframe.time in chosen]

    def keyframes_around(self, time: float) -> tuple[Keyframe, Keyframe, float]:
        """The keyframes before and after a time, and the eased share of the motion between them.

        Before the first keyframe and after the last one, that keyframe twice and 0. There must be one.
        """
        count = len(self.keyframes)
        later = next((index for index, keyframe in enumerate(self.keyframes) if keyframe.time > time), count)
        if later == 0 or later == count:
            nearest = self.keyframes[max(later - 1, 0)]
            return nearest, nearest, 0.0
        start, end = self.keyframes[later - 1 : later + 1]
        ease = keyframe_easing_function(self.easing_after(start))
        return start, end, ease((time - start.time) / (end.time - start.time))

    def layer_view_at(self, time: float) -> LayerView | None:
        """The layers that are visible at a time, and their order: a step at each keyframe, never blended.

        Before the first keyframe that has some, those of that one. None if no keyframe has any.
        """
        views = [(each.time, each.layers) for each in self.keyframes if each.layers is not None]
        past = [view for start, view in views if start <= time]
        return past[-1] if past else views[0][1] if views else None

    def pins_at(self, pins: Sequence[Pin], time: float) -> tuple[Pin, ...]:
        """Pins with the depths that they have at a time: a step at each keyframe, as for the layers."""
        keyed = [(each.time, each.depths) for each in self.keyframes if each.depths]
        past = [depths for start, depths in keyed if start <= time]
        return with_depths(pins, past[-1] if past else keyed[0][1] if keyed else ())

    def map_layers(self, change: Callable[[LayerView], LayerView]) -> "Animation":
        """Replace the layers of each keyframe that has some by ``change(layers)``."""
        keyframes = (
            each if each.layers is None else replace(each, layers=change(each.layers))
            for each in self.keyframes
        )
        return replace(self, keyframes=tuple(keyframes))

    def with_keyframe(self, keyframe: Keyframe) -> "Animation":
        """Add a keyframe; replaces one at the same time, and keeps its easing unless it has its own."""
        by_time = {each.time: each for each in self.keyframes}
        if keyframe.ease is None and keyframe.time in by_time:
            keyframe = replace(keyframe, ease=by_time[keyframe.time].ease)
        return self._from({**by_time, keyframe.time: keyframe})

    def without_keyframes(self, times: Iterable[float]) -> "Animation":
        """Delete the keyframes at the given times, seconds."""
        deleted = set(times)
        return replace(self, keyframes=tuple(each for each in self.keyframes if each.time not in deleted))

    def with_moved_keyframes(self, moves: Mapping[float, float], copy: bool = False) -> "Animation":
        """Move keyframes from old times to new ones, seconds; replaces keyframes that are there already.

        copy: leave the originals where they are.
        """
        by_time = {keyframe.time: keyframe for keyframe in self.keyframes}
        staying = {time: keyframe for time, keyframe in by_time.items() if copy or time not in moves}
        moved = [replace(by_time[old], time=new) for old, new in moves.items() if old in by_time]
        return self._from({**staying, **{keyframe.time: keyframe for keyframe in moved}})

    def with_easing(self, times: Iterable[float] | None, ease: str | None) -> "Animation":
        """Set the easing after the keyframes at ``times``; None sets that of the animation.

        Raises InputError on an unknown easing.
        """
        if times is None:
            return replace(self, ease=check_keyframe_easing(ease))
        changed = set(times)
        keyframes = (replace(each, ease=ease) if each.time in changed else each for each in self.keyframes)
        return replace(self, keyframes=tuple(keyframes))

    def map_poses(self, change: Callable[[Floats], Floats]) -> "Animation":
        """Replace each pose by ``change(pose)``; keyframes that share a pose share the new one."""
        old_poses = {id(keyframe.positions): keyframe.positions for keyframe in self.keyframes}
        new_poses = {identity: as_pose(change(pose), "keyframe") for identity, pose in old_poses.items()}
        keyframes = (replace(each, positions=new_poses[id(each.positions)]) for each in self.keyframes)
        return replace(self, keyframes=tuple(keyframes))

    def _from(self, by_time: Mapping[float, Keyframe]) -> "Animation":
        return replace(self, keyframes=tuple(by_time[time] for time in sorted(by_time)))


NO_ANIMATION = Animation()


def as_keyframe_time(value: Any) -> float:
    """``value`` in seconds, rounded to whole milliseconds. Raises InputError out of range."""
    return round(as_number(value, "time of a keyframe", 0, MAX_KEYFRAME_TIME), TIME_DECIMALS)
