"""Whether the drawing is seen at a place: asked several times a frame, and looked up once."""

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats
from .camera import Point
from .session.session import Session


class Sight:
    """Remembers the last answer, which holds until the pointer or the drawing has moved."""

    def __init__(self) -> None:
        self._asked: tuple[TriMesh, Floats, Point] | None = None
        self._answer = False

    def sees_drawing(self, session: Session, place: Point) -> bool:
        """Whether some part of the pose is at ``place``, in drawing pixels."""
        mesh, pose = session.drawing.mesh, session.state.positions
        asked = self._asked
        if asked is None or asked[0] is not mesh or asked[1] is not pose or asked[2] != place:
            self._asked, self._answer = (mesh, pose, place), mesh.find(place, pose) is not None
        return self._answer
