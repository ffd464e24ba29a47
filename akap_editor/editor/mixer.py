"""A pose between two that were given names, to be looked at before it is taken."""

from collections.abc import Callable
from dataclasses import replace

from ..geometry.checks import Floats
from ..geometry.mesh import TriMesh
from .inbetween import Inbetween
from .poses import NamedPose
from .session import Session


class Mixer:
    """start, end: names of poses; share: how far from one to the other, 0 to 1."""

    def __init__(self) -> None:
        self.start = self.end = ""
        self.share = 0.0
        self._inbetween: tuple[TriMesh, Inbetween] | None = None
        self._way: tuple[NamedPose, NamedPose, Callable[[float], Floats]] | None = None

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
        mesh = session.drawing.mesh
        if self._inbetween is None or self._inbetween[0] is not mesh:
            self._inbetween, self._way = (mesh, Inbetween(mesh)), None
        if self._way is None or self._way[:2] != chosen:
            start, end = chosen
            self._way = start, end, self._inbetween[1].between(start.positions, end.positions)
        return self._way[2](self.share)

    def show(self, session: Session) -> None:
        """Look at it; nothing is edited."""
        pose = None if session.history.is_open else self.pose(session)
        if pose is not None:
            session.visit(replace(session.state, positions=pose), None)
