"""What bends a drawing as its state says, and how far one step goes."""

from collections.abc import Callable
from threading import Lock
from typing import Any

import numpy as np

from ...deform.deformer import StepResult, holds_angles, make_deformer, takes_stiffness
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats
from ..document.document import EditState
from ..document.pin_angles import FullTurnCounter, pin_angles

REACH = 0.035  # longest way of a pin in one step, as a share of √area; longer steps cost as much a pixel
MOST_TURN = 0.2  # radians that a pin turns in one step


class Bending:
    """The deformer of a mesh, made for the settings and the stiffness of a state, with that state's pins.

    turns: full turns of pins since it was told to forget them; last_way: of pins that moved, the pose before
    and their velocities, for `fields`. Raises InputError on settings that no method knows.
    """

    def __init__(self, mesh: TriMesh, state: EditState) -> None:
        self._mesh, self._one_at_a_time = mesh, Lock()
        self.settings, self.stiffness = state.settings, state.stiffness
        method, parameters = state.settings.method, dict(state.settings.parameters)
        if state.stiffness is not None and takes_stiffness(method):
            parameters["stiffness"] = state.stiffness
        # Any: of a method that may have more than the contract asks for
        self.deformer: Any = make_deformer(method, mesh, **parameters)
        self.set_pins(state)
        self.holds_angles = holds_angles(method)
        self.turns = FullTurnCounter()
        self.last_way: tuple[Floats, Floats] | None = None
        self._reach = REACH * float(np.sqrt(mesh.rest_areas.sum()))

    def set_pins(self, state: EditState) -> None:
        """Choose the pins of a state; moves nothing."""
        with self._one_at_a_time:
            self.deformer.set_pins(state.points)
            self._pins = len(state.pins)

    def fits(self, mesh: TriMesh, state: EditState) -> bool:
        """Whether it bends this mesh as this state says, whatever the pins are."""
        same = mesh is self._mesh and state.stiffness is self.stiffness
        return same and state.settings == self.settings

    def off(self, state: EditState) -> Floats:
        """(k, 2): by how much pins are away from where they should be."""
        return state.targets - self._mesh.evaluate(state.points, state.positions)

    def angles_off(self, state: EditState) -> Floats:
        """(k,): by how many radians pins still have to turn; NaN for those that turn as they will."""
        wanted = state.angles
        if not self.holds_angles or not np.isfinite(wanted).any():
            return np.full(len(wanted), np.nan)
        return wanted - self.turns.counted(state.pins, pin_angles(self._mesh, state.pins, state.positions))

    def turn_error(self, state: EditState) -> float:
        """Largest angle by which a pin still has to turn, radians."""
        return float(np.nan_to_num(np.abs(self.angles_off(state))).max(initial=0.0))

    def steps_left(self, state: EditState) -> float:
        """How many steps pins need at least to where they should be."""
        way = np.linalg.norm(self.off(state), axis=1).max(initial=0.0)
        return float(max(way / self._reach, self.turn_error(state) / MOST_TURN))

    def way(self, state: EditState) -> Callable[[], StepResult]:
        """One step from a state towards its targets and angles, to be computed in any thread.

        It raises SolverError.
        """
        here, turn = self._mesh.evaluate(state.points, state.positions), self.angles_off(state)
        share = 1.0 / max(1.0, self.steps_left(state))
        goals = state.targets if share == 1.0 else here + share * (state.targets - here)
        angles = (state.angles - (1.0 - share) * turn,) if np.isfinite(turn).any() else ()

        def step() -> StepResult:
            with self._one_at_a_time:
                result: StepResult = self.deformer.step(state.positions, goals, *angles)
            return result

        return step

    def fields(self) -> tuple[Floats, Floats] | None:
        """U_opt and U°, (n, 2) each, of the last way of these pins; None without one. From any thread."""
        with self._one_at_a_time:
            way = self.last_way
            if way is None or len(way[1]) != self._pins:
                return None
            optimal, smooth = self.deformer.vector_fields(*way)
        return optimal, smooth
