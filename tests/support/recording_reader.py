"""A reader of .akaprec files, written from docs/file-format.md alone, with nothing of ours but the engine."""

import json
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from akap_editor.deform.akap.pin_rotation import PinRotationConstraints
from akap_editor.deform.methods import make_deformer
from akap_editor.geometry.mesh import MeshPoints, TriMesh

REACH, MOST_ROTATION = 0.035, 0.2  # of a step: share of √area, and radians


class State(NamedTuple):
    """What undo restores: pose (n, 2), pins, method with parameters, and stiffness (m,)."""

    positions: NDArray[np.float64]
    pins: tuple[dict, ...] = ()
    settings: tuple[str, dict] = ("akap", {})
    stiffness: NDArray[np.float64] | None = None


class RecordingReader:
    """Replays the lines of a recording on the mesh of its header."""

    def __init__(self, mesh: TriMesh) -> None:
        self.mesh = mesh
        self.state = State(mesh.vertices)
        self.undo: list[State] = []
        self.redo: list[State] = []
        self.open: State | None = None
        self.last_angles: dict[int, float] = {}

    def poses(self, text: str) -> Iterator[NDArray[np.float64]]:
        """The pose after each event."""
        for line in text.splitlines()[1:]:
            event = json.loads(line)
            handle = getattr(self, f"on_{event['do']}", None)
            assert handle is not None, event["do"]
            handle(event)
            yield self.state.positions

    # -- the deformer --------------------------------------------------------------------------------------

    def make_deformer(self) -> None:
        method, parameters = self.state.settings
        stiffness = {} if self.state.stiffness is None else {"stiffness": self.state.stiffness}
        self.deformer = make_deformer(method, self.mesh, **parameters, **stiffness)
        self.deformer.set_pins(self.points())
        self.last_angles = {}

    def points(self) -> MeshPoints:
        faces = np.array([pin["face"] for pin in self.state.pins], dtype=np.int32)
        return MeshPoints(faces, np.array([pin["weights"] for pin in self.state.pins]).reshape(-1, 3))

    def restore(self, state: State) -> None:
        old, self.state = self.state, state
        if old.settings != state.settings or old.stiffness is not state.stiffness:
            self.make_deformer()
        else:
            self.last_angles = {}
            self.deformer.set_pins(self.points())

    def errors_of_angles(self) -> NDArray[np.float64]:
        held = np.array([pin.get("angle") is not None for pin in self.state.pins])
        if not held.any():
            return np.full(len(held), np.nan)
        goals = np.array([pin.get("angle") for pin in self.state.pins], dtype=float)  # None becomes NaN
        z = self.state.positions[:, 0] + 1j * self.state.positions[:, 1]
        angles = PinRotationConstraints(self.mesh, self.points(), held).angles(z)
        last = np.array([self.last_angles.get(pin["id"], pin.get("angle") or 0) for pin in self.state.pins])
        angles = angles + 2 * np.pi * np.round((last - angles) / (2 * np.pi))
        self.last_angles = {
            pin["id"]: float(angle) for pin, angle in zip(self.state.pins, angles, strict=True)
        }
        return goals - angles

    def on_step(self, _: dict) -> None:
        at = self.mesh.evaluate(self.points(), self.state.positions)
        goals = np.array([pin["target"] for pin in self.state.pins], dtype=float).reshape(-1, 2)
        errors = self.errors_of_angles()
        length = np.linalg.norm(goals - at, axis=1).max(initial=0.0)
        rotation = float(np.nan_to_num(np.abs(errors)).max(initial=0.0))
        steps = max(length / (REACH * self.mesh.length), rotation / MOST_ROTATION)
        share = 1.0 / max(1.0, steps)
        targets = goals if share == 1.0 else at + share * (goals - at)
        held = np.isfinite(errors).any()
        angles = np.array([pin.get("angle") for pin in self.state.pins], dtype=float)
        more = (angles - (1.0 - share) * errors,) if held else ()
        result = self.deformer.step(self.state.positions, targets, *more)
        self.state = self.state._replace(positions=result.positions)

    # -- events --------------------------------------------------------------------------------------------

    def on_settings(self, event: dict) -> None:
        self.state = self.state._replace(settings=(event["method"], event["parameters"]))
        self.make_deformer()

    def on_stiffness(self, event: dict) -> None:
        factors = None if event["factors"] is None else np.array(event["factors"], dtype=float)
        self.state = self.state._replace(stiffness=factors)
        self.make_deformer()

    def on_pins(self, event: dict) -> None:
        self.state = self.state._replace(pins=tuple(event["pins"]))
        self.deformer.set_pins(self.points())

    def on_targets(self, event: dict) -> None:
        self._change_pins("target", event["targets"])

    def on_angles(self, event: dict) -> None:
        self._change_pins("angle", event["angles"])

    def _change_pins(self, key: str, values: dict) -> None:
        pins = [{**pin, key: values.get(str(pin["id"]), pin.get(key))} for pin in self.state.pins]
        self.state = self.state._replace(pins=tuple(pins))

    def on_pose(self, event: dict) -> None:
        self._move_to(np.array(event["positions"], dtype=float))

    def on_reset(self, _: dict) -> None:
        self._move_to(self.mesh.vertices)

    def _move_to(self, positions: NDArray[np.float64]) -> None:
        self.state = self.state._replace(positions=positions)
        at = self.mesh.evaluate(self.points(), positions)
        pins = [{**pin, "target": point} for pin, point in zip(self.state.pins, at, strict=True)]
        self.state = self.state._replace(pins=tuple(pins))

    def on_begin(self, _: dict) -> None:
        self.open, self.last_angles = self.state, {}

    def on_label(self, _: dict) -> None:
        pass

    def on_commit(self, event: dict) -> None:
        assert self.open is not None
        if any(old is not new for old, new in zip(self.open, self.state, strict=True)):
            if not event.get("join"):
                self.undo.append(self.open)
            self.redo.clear()
        self.open = None

    def on_abort(self, _: dict) -> None:
        assert self.open is not None
        self.restore(self.open)
        self.open = None

    def on_undo(self, _: dict) -> None:
        self.redo.append(self.state)
        self.restore(self.undo.pop())

    def on_redo(self, _: dict) -> None:
        self.undo.append(self.state)
        self.restore(self.redo.pop())
