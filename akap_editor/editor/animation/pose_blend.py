"""A blend of two named poses, to look at before it is applied."""

from dataclasses import replace

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats
from ..document.named_poses import NamedPose
from ..session.session import Session


class PoseBlend:
    """A pose between two named poses.

    start, end: names of the poses; share: 0 for the start, 1 for the end.
    """

    def __init__(self) -> None:
        self.start = self.end = ""
        self.share = 0.0
        self._interpolation = InterpolationCache()

    def endpoints(self, session: Session) -> tuple[NamedPose, NamedPose] | None:
        """The two poses; the first or the last one for an unknown name, None with fewer than two poses."""
        poses = session.state.poses
        if len(poses) < 2:
            return None
        by_name = {pose.name: pose for pose in poses}
        return by_name.get(self.start, poses[0]), by_name.get(self.end, poses[-1])

    def pose(self, session: Session) -> Floats | None:
        """The blended pose (n, 2); None if there are fewer than two named poses."""
        endpoints = self.endpoints(session)
        if endpoints is None:
            return None
        start, end = endpoints
        return self._interpolation.pose(session.drawing.mesh, start.positions, end.positions, self.share)

    def preview(self, session: Session) -> None:
        """Show the blend without editing anything; see `Session.preview`."""
        pose = None if session.history.is_open else self.pose(session)
        if pose is not None:
            session.preview(replace(session.state, positions=pose))
