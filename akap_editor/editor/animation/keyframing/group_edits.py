"""Edits of several keyframes at once: play them backwards, insert others."""

from collections.abc import Sequence

from ...document.easing import NEW_EASING
from ...document.keyframes import Animation, Keyframe
from ...session.edits import DeleteKeyframes, MoveKeyframes, SetEasing, SetKeyframe
from ...session.edits.keyframes import KeyframeEdit
from ..keyframe_times import mirror_easings


def reverse_edits(animation: Animation, moves: dict[float, float], copy: bool) -> list[KeyframeEdit]:
    """The edits that play keyframes backwards, or copies of them, with their easings.

    moves: new times by old ones, ascending, see `mirror_times`.
    """
    easings = mirror_easings([animation.easing_after(each) for each in animation.keyframes_at(moves)])
    changes = [
        SetEasing([new], None if ease == animation.ease else ease)
        for new, ease in zip(moves.values(), easings, strict=True)
    ]
    return [MoveKeyframes(moves, copy), *changes]


def insert_edits(animation: Animation, keyframes: Sequence[Keyframe]) -> list[KeyframeEdit]:
    """The edits that add keyframes, with ascending times, instead of those in their time."""
    first, last = keyframes[0].time, keyframes[-1].time
    replaced = [time for time in animation.times if first <= time <= last]
    deletion = [DeleteKeyframes(replaced)] if replaced else []
    start = [] if animation.keyframes else [SetEasing(None, NEW_EASING)]
    new = (
        SetKeyframe(each.time, each.positions, each.ease, each.crossings, each.layers, each.depths)
        for each in keyframes
    )
    return [*deletion, *start, *new]
