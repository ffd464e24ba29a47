"""The onion skin: poses before and after the playhead."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from ....geometry.validation import Floats
from ...document.keyframes import Animation, as_keyframe_time

MAX_ONION_POSES = 6  # on each side


@dataclass
class OnionSkin:
    """The poses before and after the playhead, shown translucently.

    kind: the nearest keyframes, or the poses at times that are ``step`` seconds apart; count: on each side.
    """

    is_shown: bool = False
    kind: Literal["keyframes", "times"] = "keyframes"
    count: int = 2
    step: float = 0.1

    def poses(
        self, animation: Animation, now: float, pose_at: Callable[[float], Floats | None]
    ) -> tuple[list[Floats], list[Floats]]:
        """The poses (n, 2) before and after the time ``now``, seconds, the nearest ones first.

        pose_at: gives the pose at a time.
        """
        if self.kind == "keyframes":
            time, keyframes = as_keyframe_time(now), animation.keyframes
            before = [keyframe.positions for keyframe in reversed(keyframes) if keyframe.time < time]
            after = [keyframe.positions for keyframe in keyframes if keyframe.time > time]
            return before[: self.count], after[: self.count]
        offsets = [self.step * (number + 1) for number in range(self.count)]
        earlier = (pose_at(now - offset) for offset in offsets if now - offset >= -1e-9)
        latest = animation.duration + 1e-9
        later = (pose_at(now + offset) for offset in offsets if now + offset <= latest)
        return [pose for pose in earlier if pose is not None], [pose for pose in later if pose is not None]
