"""The contract of all deformation methods, and the table of those that there are."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from numpy.typing import ArrayLike

from ..errors import InputError
from ..geometry.mesh import MeshPoints, TriMesh
from ..geometry.validation import Floats, as_number


@dataclass(frozen=True)
class StepReport:
    """What one step cost and how good it is.

    seconds; substeps; energy: Killing energy of the last field at the pose it was made for, square pixels, 0
    without a field; flipped: faces with a negative area afterwards; pin_error: largest distance of a pin from
    its target, pixels; blocked: whether the last move was cut short because it would have flipped a face.
    """

    seconds: float
    substeps: int
    energy: float
    flipped: int
    pin_error: float
    blocked: bool = False


@dataclass(frozen=True, eq=False)
class StepResult:
    """positions: (n, 2) new pose; field: (n, 2) the last vector field, or None for methods without one.

    flow: the way there, for `at`; None for methods that know no way.
    """

    positions: Floats
    field: Floats | None
    report: StepReport
    flow: Callable[[float], Floats] | None = None

    def at(self, t: float) -> Floats:
        """The pose (n, 2) at time ``t`` of the step: 0 is where it began, 1 is `positions`.

        Vertices move along the trajectories γ(t) of eq. 14, substep after substep, for in-betweens, slow
        motion and motion blur. Raises InputError outside [0, 1], or where the method knows no way.
        """
        if self.flow is None:
            raise InputError("at: expected the result of a method that moves along trajectories, got another")
        return self.flow(as_number(t, "t", 0, 1))


class Deformer(Protocol):
    """Bends a mesh by its pins.

    What depends on topology is prepared in the constructor, what depends on where the pins are in `set_pins`,
    the rest in `step`. Arguments are never modified. The result depends only on constructor, `set_pins` and
    arguments. It is finite, or SolverError is raised. Moving, turning or scaling rest pose, positions and
    targets together does the same to the result; renumbering the vertices renumbers it.

    A method may have more: `step` with ``angles`` that pins hold (see `holds_angles`), and a constructor with
    the ``stiffness`` of faces (see `takes_stiffness`).
    """

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing."""

    def step(self, positions: ArrayLike, targets: ArrayLike) -> StepResult:
        """Move the pose (n, 2) so that its pins come to ``targets`` (k, 2).

        Raises InputError and SolverError.
        """


def _methods() -> dict[str, Any]:
    from .akap.deformer import AkapDeformer
    from .rivals.arap import ArapDeformer
    from .rivals.cauchy_green import CauchyGreenDeformer
    from .rivals.igarashi import IgarashiDeformer
    from .rivals.moving_least_squares import MovingLeastSquaresDeformer

    return {
        "akap": AkapDeformer,
        "arap": ArapDeformer,
        "igarashi": IgarashiDeformer,
        "cauchy-green": CauchyGreenDeformer,
        "mls": MovingLeastSquaresDeformer,
    }


def method_names() -> list[str]:
    """The names that `make_deformer` knows."""
    return list(_methods())


def method_class(method: str) -> Any:
    """The class behind a method's name. Raises InputError on an unknown one."""
    methods = _methods()
    if method not in list(methods):
        raise InputError(f"method: expected one of {', '.join(methods)}, got {method!r}")
    return methods[method]


def holds_angles(method: str) -> bool:
    """Whether pins of a method can hold angles: `step` then takes ``angles``, (k,) radians from rest or NaN.

    Raises InputError on an unknown method.
    """
    return "angles" in inspect.signature(method_class(method).step).parameters


def takes_stiffness(method: str) -> bool:
    """Whether a method takes ``stiffness``, (m,) factors by which faces bend less, as one of its settings.

    Raises InputError on an unknown method.
    """
    return "stiffness" in inspect.signature(method_class(method)).parameters


def make_deformer(method: str, mesh: TriMesh, /, **settings: Any) -> Deformer:
    """A deformation method by name, its settings by keyword. Raises InputError on unknown ones.

    Of a mesh whose parts are tied, those without a pin ride with the others.
    """
    from .islands import IslandDeformer

    chosen = method_class(method)
    known = list(inspect.signature(chosen).parameters)[1:]
    for name in settings:
        if name not in known:
            raise InputError(f"method {method}: expected settings among {', '.join(known)}, got {name!r}")
    deformer: Deformer = chosen(mesh, **settings)
    return IslandDeformer(mesh, deformer) if mesh.tied and mesh.component.any() else deformer
