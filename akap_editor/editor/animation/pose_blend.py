"""A pose between two that were given names, to be looked at before it is taken."""

from dataclasses import replace

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats
from ..document.named_poses import NamedPose
from ..session.session import Session


class PoseBlend:
    """start, end: names of poses; share: how far from one to the other, 0 to 1."""

    def __init__(self) -> None:
        self.start = self.end = ""
        self.share = 0.0
        self._ways = InterpolationCache()

    def chosen(self, session: Session) -> tuple[NamedPose, NamedPose] | None:
        """The two poses; the first and the last one where none was chosen; None with less than two poses."""
        poses = {pose.name: pose for pose in session.state.poses}
        if len(poses) < 2:
            return None
        every = list(poses.values())
        return poses.get(self.start, every[0]), poses.get(self.end, every[-1])

    def pose(self, session: Session) -> Floats | None:
        """The pose (n, 2) between the two that are chosen."""
        chosen = self.chosen(session)
        if chosen is None:
            return None
        start, end = chosen
        return self._ways.pose(session.drawing.mesh, start.positions, end.positions, self.share)

    def show(self, session: Session) -> None:
        """Look at it; nothing is edited."""
        pose = None if session.history.is_open else self.pose(session)
        if pose is not None:
            session.preview(replace(session.state, positions=pose))
