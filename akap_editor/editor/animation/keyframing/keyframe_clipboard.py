"""Copied keyframes, to be pasted at another time, also backwards."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from ....geometry.mesh import TriMesh
from ...document.keyframes import MAX_KEYFRAME_TIME, Animation, Keyframe
from ..keyframe_times import mirror_easings, mirror_times


class KeyframeClipboard:
    """Keeps keyframes of one mesh, each with an easing of its own."""

    def __init__(self) -> None:
        self._mesh: TriMesh | None = None
        self._keyframes: list[Keyframe] = []

    def copy(self, mesh: TriMesh, animation: Animation, times: Iterable[float]) -> None:
        """Keep the keyframes at some of the times of an animation of the mesh."""
        self._mesh = mesh
        self._keyframes = [
            replace(each, ease=animation.easing_after(each)) for each in animation.keyframes_at(times)
        ]

    def fits(self, mesh: TriMesh) -> bool:
        """Whether there are keyframes of this mesh."""
        return bool(self._keyframes) and mesh is self._mesh

    def pasted(self, start: float, reverse: bool = False) -> list[Keyframe]:
        """The keyframes, the first of them at the time ``start``, seconds; reverse: in the reverse order."""
        keyframes = _reversed(self._keyframes) if reverse else self._keyframes
        shift = min(start - keyframes[0].time, MAX_KEYFRAME_TIME - keyframes[-1].time)
        return [replace(each, time=each.time + shift) for each in keyframes]


def _reversed(keyframes: Sequence[Keyframe]) -> list[Keyframe]:
    easings = mirror_easings([each.ease or "" for each in keyframes])
    times = mirror_times([each.time for each in keyframes], keyframes[0].time)
    turned = (
        replace(each, time=times[each.time], ease=ease) for each, ease in zip(keyframes, easings, strict=True)
    )
    return list(turned)[::-1]
