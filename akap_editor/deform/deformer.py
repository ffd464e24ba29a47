"""The contract that every deformation method keeps, and the result of a step."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..geometry.mesh import MeshPoints, TriMesh
from ..geometry.operators import to_complex
from ..geometry.validation import Complexes, Floats, as_number, as_points

SAME_PLACE = 1e-3  # share of √area: pins that are closer count as at one place
MAX_REACH = 1e9  # times √area: a target farther from the drawing leaves a pose no digits

Flow = Callable[[float], Floats]  # from time, 0 to 1, to a pose (n, 2)


@dataclass(frozen=True)
class StepReport:
    """Cost and quality of a step.

    seconds: duration; substeps: their number; energy: Killing energy of the last field, square pixels, 0
    without a field; flipped: number of faces without a positive area; pin_error: largest distance of a pin
    from its target, pixels; blocked: whether the last move was cut short, because it would have
    flipped a face; unfinished: whether the step ended early, because the targets are too far for one step.
    """

    seconds: float
    substeps: int
    energy: float
    flipped: int
    pin_error: float
    blocked: bool = False
    unfinished: bool = False


@dataclass(frozen=True, eq=False)
class StepResult:
    """The result of a step.

    positions: (n, 2) the new pose; field: (n, 2) the vector field of the last substep, None for methods
    without one; flow: γ of eq. 14 over the whole step, None for methods without trajectories.
    """

    positions: Floats
    field: Floats | None
    report: StepReport
    flow: Flow | None = None

    def at(self, t: float) -> Floats:
        """The pose (n, 2) at time ``t`` of the step, from 0, its start, to 1, `positions`.

        Vertices move along the trajectories of eq. 14, substep after substep. For slow motion and motion
        blur. Raises InputError for a time out of range, or if the method has no trajectories.
        """
        if self.flow is None:
            raise InputError("at: expected the result of a method that moves along trajectories, got another")
        return self.flow(as_number(t, "t", 0, 1))


class Deformer(Protocol):
    """Deforms a mesh by its pins; the contract of every method.

    The constructor prepares what depends on the rest mesh, `set_pins` what depends on where the pins are, and
    `step` the rest. Arguments are never modified. The result depends only on the arguments of constructor,
    `set_pins` and `step`; a cache may change the cost of a step, and its result within the method's stated
    tolerance. It is finite, or SolverError is raised. Moving, rotating or scaling rest pose, positions and
    targets together does the same to the result; renumbering the vertices renumbers it. Components without
    pins stay where they are.

    A method can do more than this contract asks for; the attributes say what.

    holds_angles: `step` takes ``angles``, (k,) radians by which the surroundings of pins are rotated from
    rest, NaN for pins that let them rotate freely.
    takes_stiffness: the constructor takes ``stiffness``, (m,) factors of the faces' energies.
    has_memory: the constructor takes ``memory``, from 0 to 1: how strongly a step pulls towards the rest
    pose.
    takes_joints: the constructor takes ``joints``, `MeshJoints` that hold components together.
    takes_scales: ``set_scales(scales)`` takes factors (m,) by which the rest shape of each face is enlarged
    for the memory from now on, None for none; moves nothing.
    has_vector_fields: the pose follows a vector field: results have one, and ``vector_fields(positions,
    velocities)`` returns two of shape (n, 2), the one followed and the one before its last solve.
    """

    holds_angles: bool = False
    takes_stiffness: bool = False
    has_memory: bool = False
    has_vector_fields: bool = False
    takes_joints: bool = False
    takes_scales: bool = False

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing. Raises InputError."""

    def prepare(self, positions: ArrayLike) -> None:
        """Announce that the next step will probably start from the pose (n, 2).

        A method may then begin to compute beside, in another thread, what that step needs. Results do not
        depend on it. By default nothing is done.
        """
        return

    def step(self, positions: ArrayLike, targets: ArrayLike) -> StepResult:
        """Move the pose (n, 2) so that its pins reach ``targets`` (k, 2), as far as the method allows.

        Raises InputError for other shapes or numbers that are not finite, and SolverError.
        """


def as_targets(value: ArrayLike, count: int, mesh: TriMesh, pose: Complexes) -> Complexes:
    """Targets (count, 2) of pins as complex numbers (count,), for a step from ``pose`` (n,).

    Raises InputError for another shape, numbers that are not finite, and targets so far away that the
    vertices around a pin could no longer be told apart.
    """
    targets = to_complex(as_points(value, "targets", count))
    distance = np.abs(targets - pose.mean()).max(initial=0.0)
    if not distance <= MAX_REACH * mesh.length:
        raise InputError(
            f"targets: expected points within {MAX_REACH * mesh.length:.3g} pixels of the drawing, "
            f"got one {distance:.3g} away"
        )
    return targets
