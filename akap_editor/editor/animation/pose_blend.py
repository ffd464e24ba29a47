"""A blend of two named poses, to look at before it is applied."""

from dataclasses import replace

from ...deform.pose_interpolation import InterpolationCache
from ...geometry.validation import Floats, Ints
from ..document.named_poses import NamedPose
from ..session.session import Session
from .crossing_blend import CrossingBlend


class PoseBlend:
    """A pose between two named poses.

    start, end: names of the poses; share: 0 for the start, 1 for the end.
    """

    def __init__(self) -> None:
        self.start = self.end = ""
        self.share = 0.0
        self._interpolation = InterpolationCache()
        self._crossings = CrossingBlend()

    def endpoints(self, session: Session) -> tuple[NamedPose, NamedPose] | None:
        """The two poses; the first or the last one for an unknown name, None with fewer than two poses."""
        poses = session.state.poses
        if len(poses) < 2:
            return None
        by_name = {pose.name: pose for pose in poses}
        return by_name.get(self.start, poses[0]), by_name.get(self.end, poses[-1])

    def pose(self, session: Session) -> Floats | None:
        """The blended pose (n, 2); None if there are fewer than two named poses."""
        blended = self.blend(session)
        return None if blended is None else blended[0]

    def blend(self, session: Session) -> tuple[Floats, Ints] | None:
        """The blended pose (n, 2) and its crossings (s, 2); None if there are fewer than two named poses."""
        endpoints = self.endpoints(session)
        if endpoints is None:
            return None
        start, end = endpoints
        mesh = session.drawing.mesh

        def pose_at(share: float) -> Floats:
            return self._interpolation.pose(mesh, start.positions, end.positions, share)

        return self._crossings.crossings(mesh, session.state.pins, start, end, self.share, pose_at)

    def preview(self, session: Session) -> None:
        """Show the blend without editing anything; see `Session.preview`."""
        blended = None if session.history.is_open else self.blend(session)
        if blended is not None:
            session.preview(replace(session.state, positions=blended[0], crossings=blended[1]))
