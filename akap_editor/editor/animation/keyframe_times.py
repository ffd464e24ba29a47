"""New times of keyframes that are dragged, stretched or reversed, and the easings that go with them."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from ..document.easing import mirrored_easing
from ..document.keyframes import MAX_KEYFRAME_TIME, Animation, as_keyframe_time

TIME_STEP = 0.05  # seconds: times snap to multiples of it, and keys move by it


@dataclass(frozen=True)
class TimesDrag:
    """Keyframes that are being dragged. moves: old times to new ones; copy: whether they also stay."""

    moves: dict[float, float]
    copy: bool = False

    @property
    def changes_times(self) -> bool:
        """Whether a keyframe gets another time."""
        return any(old != new for old, new in self.moves.items())

    def apply(self, animation: Animation) -> Animation:
        """The animation as the drag would leave it."""
        return animation.with_moved_keyframes(self.moves, self.copy)


@dataclass(frozen=True)
class EasingDrag:
    """An easing whose handle is being dragged. time: of the keyframe before it."""

    time: float
    easing: str

    def apply(self, animation: Animation) -> Animation:
        """The animation as the drag would leave it."""
        return animation.with_easing([self.time], self.easing)


def stretch_times(times: Iterable[float], dragged: float, to: float) -> dict[float, float]:
    """Old times to new ones, when ``dragged`` moves ``to`` a time and the first or the last one stays."""
    ascending = sorted(times)
    fixed = ascending[-1] if dragged == ascending[0] else ascending[0]
    span = dragged - fixed
    scale = (to - fixed) / span if span else 1.0
    min_scale = TIME_STEP / max(abs(span), TIME_STEP)
    return {time: fixed + max(scale, min_scale) * (time - fixed) for time in ascending}


def within_limits(time: float) -> float:
    """The nearest time that a keyframe may have, seconds."""
    return as_keyframe_time(min(max(time, 0.0), MAX_KEYFRAME_TIME))


def mirror_times(times: Iterable[float], start: float) -> dict[float, float]:
    """Old times to new ones in the reverse order, the first of which is ``start``."""
    last = max(times := list(times))
    return {time: start + last - time for time in times}


def mirror_easings(easings: Sequence[str]) -> list[str]:
    """The easings after keyframes that are played backwards, in their old order.

    easings: those after them now; that after the last one leads on from the group, and does so afterwards.
    """
    return [easings[-1], *map(mirrored_easing, easings[:-1])]


def counted(verb: str, times: Collection[float]) -> str:
    """The name of an edit of keyframes in the history, for example "Move 3 Keyframes"."""
    return f"{verb} Keyframe" if len(times) == 1 else f"{verb} {len(times)} Keyframes"
