"""A driver of the editor: it presses, moves and releases, and checks invariants after every event."""

from concurrent.futures import Executor
from typing import Any

import numpy as np

from akap_editor.editor.document.document import Document, EditState
from akap_editor.editor.document.drawing import Drawing
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import Button, KeyEvent, PointerEvent, ScrollEvent
from akap_editor.editor.session.recording import Recording, parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.editor.session.stepper import INLINE
from akap_editor.geometry.mesh import signed_areas
from akap_editor.layers.drawing_layer import DrawingLayer

Point = tuple[float, float]
OUTSIDE = (2.0, 2.0)  # a corner of the picture that the drawing leaves free


class Ticks:
    """A clock that advances by a millisecond each time it is read."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        self.now += 0.001
        return self.now


def bits(state: EditState) -> tuple[Any, ...]:
    """A state as a value to compare; two are equal only if the states are equal to the last bit."""
    pins = tuple(
        (
            *(pin.id, pin.face, pin.weights.tobytes(), pin.target.tobytes(), pin.depth, pin.angle),
            *(pin.name, pin.is_hidden, pin.is_locked, pin.scale),
        )
        for pin in state.pins
    )
    mesh = None if state.drawing is None else state.drawing.mesh
    mesh_bits = None if mesh is None else (mesh.vertices.tobytes(), mesh.faces.tobytes())
    layers = () if state.drawing is None else tuple(map(_layer_bits, state.drawing.layers))
    layer_list = layers, () if state.drawing is None else state.drawing.layer_order
    stiffness = None if state.stiffness is None else state.stiffness.tobytes()
    poses = tuple((pose.name, pose.positions.tobytes(), pose.crossings.tobytes()) for pose in state.poses)
    keyframes = tuple(
        (key.time, key.positions.tobytes(), key.ease, key.crossings.tobytes(), key.layers)
        for key in state.animation.keyframes
    )
    animation = keyframes, state.animation.ease, state.animation.loop
    pose = state.positions.tobytes(), state.crossings.tobytes()
    joints = tuple(
        (joint.id, joint.faces, joint.weights.tobytes(), joint.kind, joint.is_proposed)
        for joint in state.joints
    )
    rig = joints, state.mirror
    loose = state.loose
    loose_bits = None if loose is None else (loose.faces.tobytes(), loose.speed, loose.bounce)
    factors = stiffness, loose_bits
    return pose, pins, state.settings, mesh_bits, layer_list, rig, factors, poses, animation


def _layer_bits(layer: DrawingLayer) -> tuple[Any, ...]:
    switches = layer.visible, layer.solo, layer.locked, layer.slot, layer.closed_groups
    return layer.path, layer.opacity, layer.blend, switches, layer.artwork.picture.tobytes()


def replayed_state(recording: Recording, drawing: Drawing) -> EditState:
    """The state after the last event of a recording, which is written as text, read and replayed."""
    *_, last = replay(parse_recording(recording.to_text()), drawing)
    return last.state


class Driver:
    """An editor with one document open; points are in drawing pixels.

    clock: of the editor.
    """

    def __init__(self, document: Document, clock: Ticks | None = None, worker: Executor = INLINE) -> None:
        self.clock = Ticks() if clock is None else clock
        self.editor = Editor(self.clock, worker)
        self.editor.open(document)
        self._revision = 0
        self.check()

    @property
    def session(self) -> Session:
        assert self.editor.session is not None
        return self.editor.session

    @property
    def state(self) -> EditState:
        return self.session.state

    @property
    def tool(self) -> str:
        return type(self.editor.tool).__name__

    @property
    def hovered_pin(self) -> int | None:
        """The pin that the tool marks under the pointer."""
        return self.editor.tool.markers.hovered_pin

    @property
    def would_add_pin(self) -> bool:
        """Whether the tool marks a pin that a click would add."""
        return self.editor.tool.markers.new_pin is not None

    @property
    def depth(self) -> int:
        return self.session.history.depth

    @property
    def ids(self) -> list[int]:
        return [pin.id for pin in self.state.pins]

    @property
    def everything(self) -> tuple[Any, ...]:
        """All that a cancelled gesture must leave as it was."""
        history, editor = self.session.history, self.editor
        labels = history.undo_label, history.redo_label
        return bits(self.state), editor.selection, history.depth, labels, editor.camera

    def where(self, pin: int) -> Point:
        """Where a pin is now."""
        x, y = self.session.pin_positions()[self.ids.index(pin)].tolist()
        return x, y

    # -- input -----------------------------------------------------------------------------------------------

    def press(self, at: Point, button: Button = "left", shift: bool = False) -> None:
        self._pointer("press", at, button, shift)

    def move(self, at: Point, button: Button = "left") -> None:
        self._pointer("move", at, button, False)

    def release(self, at: Point, button: Button = "left", shift: bool = False) -> None:
        self._pointer("release", at, button, shift)

    def click(self, at: Point, shift: bool = False) -> None:
        self.press(at, shift=shift)
        self.release(at, shift=shift)

    def drag(self, start: Point, end: Point, steps: int = 4, button: Button = "left") -> None:
        """Press, move, advance one step at each move, and release; not settled."""
        path = np.linspace(self.editor.camera.to_screen(start), self.editor.camera.to_screen(end), steps + 1)
        self.press(start, button)
        for x, y in path[1:].tolist():  # points of the screen, so that a canvas may move meanwhile
            self.handle(PointerEvent("move", (x, y), button))
            self.advance()
        self.handle(PointerEvent("release", (x, y), button))

    def key(self, name: str, pressed: bool = True) -> None:
        self.handle(KeyEvent(name, pressed))

    def scroll(self, at: Point, amount: float) -> None:
        self.handle(ScrollEvent(self.editor.camera.to_screen(at), amount))

    def advance(self) -> None:
        """One step, if anything moves; a worker's is taken over later."""
        self.editor.advance(budget=0.0)
        self.check()

    def settle(self) -> None:
        """Frames until the program would sleep."""
        while self.editor.is_moving:
            self.advance()

    def undo(self) -> None:
        self.editor.undo()
        self.check()

    def redo(self) -> None:
        self.editor.redo()
        self.check()

    def handle(self, event: KeyEvent | PointerEvent | ScrollEvent) -> None:
        self.editor.handle_event(event)
        self.check()

    def _pointer(self, kind: Any, at: Point, button: Button, shift: bool) -> None:
        self.handle(PointerEvent(kind, self.editor.camera.to_screen(at), button, shift))

    # -- invariants ------------------------------------------------------------------------------------------

    def check(self) -> None:
        """Check what holds after every event: a valid state, and tools, selection and popup that fit it."""
        self._check_state()
        editor, ids = self.editor, set(self.ids)
        assert editor.selection <= ids
        assert editor.request is None or editor.request.pin in ids
        assert editor.is_busy or not self.session.history.is_open
        assert editor.is_busy or editor.tool.is_idle
        assert editor.hint
        markers = editor.tool.markers
        assert markers.hovered_pin is None or markers.hovered_pin in ids
        assert markers.ring is None or markers.ring.pin in ids
        assert set(markers.pin_targets) <= ids
        assert self.session.document.revision >= self._revision
        self._revision = self.session.document.revision

    def _check_state(self) -> None:
        state, mesh = self.state, self.session.drawing.mesh
        assert np.isfinite(state.positions).all()
        assert (signed_areas(state.positions, mesh.faces) > 0).all()
        assert not state.positions.flags.writeable
        for pin in state.pins:
            assert not pin.weights.flags.writeable
            assert not pin.target.flags.writeable
            assert np.isfinite(pin.target).all()
            assert abs(pin.weights.sum() - 1) < 1e-9
            assert 0 <= pin.face < len(mesh.faces)
        assert len(set(self.ids)) == len(self.ids)
