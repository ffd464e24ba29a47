"""Records the bundled sessions: a scripted pointer poses a drawing along smooth curves, at 30 moves a second.

Run from the project's root: python tools/make_recordings.py
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.tools.stiffness_brush import Brush
from akap_editor.io.akap.recording import write_recording
from akap_editor.io.images import read_image
from akap_editor.io.layers.open_layers import open_layers
from akap_editor.resources import resource

MOVES_PER_SECOND = 30
Curve = Callable[[float], tuple[float, float]]


class ScriptedPointer:
    """Moves the pointer of an editor and advances the editor's clock."""

    def __init__(self, name: str) -> None:
        self.now = 0.0
        self.editor = Editor(clock=lambda: self.now)
        self.puppet: Drawing | None = None
        path = resource("assets", "drawings") / f"{name}.ora"
        if path.exists():
            self.puppet = make_drawing(layers=open_layers(path), name=name)
            document = new_document(self.puppet)
            joints = tuple(replace(joint, is_proposed=False) for joint in suggest_joints(self.puppet))
            self.editor.open(document.with_state(replace(document.state, joints=joints)))
            return
        image = read_image(resource("assets", "drawings", f"{name}.png"))
        self.editor.open(new_document(make_drawing(image, name=name)))

    def pause(self, seconds: float) -> None:
        """Advance the clock frame by frame; the drawing settles meanwhile."""
        for _ in range(round(seconds * MOVES_PER_SECOND)):
            self.now += 1 / MOVES_PER_SECOND
            self.editor.advance(budget=np.inf)

    def add_pin(self, x: float, y: float) -> int:
        """Add a pin at a point of the drawing; return its id."""
        pin = gestures.add_pin(self.editor, (x, y))
        assert pin is not None
        self.pause(0.1)
        return pin

    def paint_loose(self, points: Sequence[tuple[float, float]], radius: float, speed: float) -> None:
        """Paint a stroke of loose parts through points of the drawing, where ``radius`` is in pixels, too."""
        editor, to_screen = self.editor, self.editor.camera.to_screen
        brush = Brush(radius * editor.camera.zoom, paints="loose", speed=speed)
        editor.chosen_tool, editor.brush_tool.brush = editor.brush_tool, brush
        editor.handle_event(PointerEvent("press", to_screen(points[0])))
        for point in points[1:]:
            editor.handle_event(PointerEvent("move", to_screen(point)))
        editor.handle_event(PointerEvent("release", to_screen(points[-1])))
        editor.chosen_tool = editor.pins_tool
        self.pause(0.1)

    def show(self, layer: str) -> None:
        """Show a layer in place of the others of its slot."""
        assert self.puppet is not None
        number = [each.name for each in self.puppet.layers].index(layer)
        gestures.set_layers(self.editor, "Switch Layer", [number], visible=True)
        self.pause(0.1)

    def drag(self, pin: int, curve: Curve, seconds: float) -> None:
        """Drag a pin; ``curve(t)``, t from 0 to 1, is its offset from where it is now."""
        session = self.editor.session
        assert session is not None
        x, y = session.state.pin(pin).target
        to_screen = self.editor.camera.to_screen
        self.editor.handle_event(PointerEvent("press", to_screen((x, y))))
        steps = round(seconds * MOVES_PER_SECOND)
        for step in range(1, steps + 1):
            dx, dy = curve(step / steps)
            self.editor.handle_event(PointerEvent("move", to_screen((x + dx, y + dy))))
            self.pause(1 / MOVES_PER_SECOND)
        self.editor.handle_event(PointerEvent("release", to_screen((x + dx, y + dy))))
        self.pause(0.2)

    def move(self, targets: Callable[[float], dict[int, tuple[float, float]]], seconds: float) -> None:
        """Drag several pins at once; ``targets(t)``, t from 0 to 1, maps each pin's id to its target."""
        session = self.editor.session
        assert session is not None
        session.begin("Move Pins")
        steps = round(seconds * MOVES_PER_SECOND)
        for step in range(1, steps + 1):
            session.apply(SetTargets(targets(step / steps)))
            self.pause(1 / MOVES_PER_SECOND)
        session.commit()
        self.pause(0.2)

    def save(self, path: Path) -> None:
        """Write the recording of the session."""
        assert self.editor.session is not None
        write_recording(self.editor.session.recording, path, self.puppet)


def ease(t: float) -> float:
    """Map t from 0 to 1 onto 0 to 1 with no speed at either end (smoothstep)."""
    return t * t * (3 - 2 * t)


def line(dx: float, dy: float) -> Curve:
    """Return the straight curve to an offset, slow at both ends."""
    return lambda t: (dx * ease(t), dy * ease(t))


def swing(dx: float, dy: float, times: int) -> Curve:
    """Return a curve that swings about its start with a decreasing amplitude and ends there."""
    return lambda t: (
        dx * np.sin(2 * np.pi * times * t) * (1 - t),
        dy * np.sin(2 * np.pi * times * t) * (1 - t),
    )


def elephant() -> ScriptedPointer:
    """Fix the elephant's feet; swing its trunk, wag its tail, shake and nod its head, lift its trunk.

    Its ear, its tail and the hair on its head are loose.
    """
    pointer = ScriptedPointer("elephant")
    hair = [(500, 75), (545, 95), (565, 60), (605, 70), (570, 115)]
    ear = [(430, 330), (480, 330), (430, 400), (490, 400), (430, 460), (470, 520)]
    for stroke, radius in ((hair, 40), (ear, 75), ([(50, 240), (50, 290), (65, 335)], 60)):
        pointer.paint_loose(stroke, radius, 3.0)
    for foot in ((135, 800), (285, 795), (445, 795), (625, 800)):
        pointer.add_pin(*foot)
    pointer.add_pin(260, 420)
    trunk = pointer.add_pin(915, 180)
    pointer.drag(trunk, line(30, 170), 1.0)
    pointer.drag(trunk, swing(60, 70, 2), 1.2)
    tail = pointer.add_pin(85, 370)
    pointer.drag(tail, swing(18, -8, 2), 1.2)
    pointer.pause(0.6)
    head = pointer.add_pin(560, 170)
    pointer.drag(head, swing(50, 15, 2), 1.0)
    pointer.drag(head, line(40, 60), 0.7)
    pointer.drag(head, line(-70, -75), 0.8)
    pointer.drag(trunk, line(-310, -270), 1.5)
    pointer.pause(0.4)
    return pointer


def bar() -> ScriptedPointer:
    """Bend the bar as in Fig. 9, two pins at each end, along the arc that keeps the midline's length.

    At 207° Cauchy–Green coordinates reproduce the values of Table 1, see docs/methods.md.
    """
    pointer, middle, height, half_length, angle = ScriptedPointer("bar"), 560.0, 150.0, 485.0, np.radians(207)
    points = [(middle + side * half_length, height + dy) for side in (-1, 1) for dy in (-70.0, 70.0)]
    pins = {pointer.add_pin(*point): point for point in points}

    def targets(t: float) -> dict[int, tuple[float, float]]:
        radius = 2 * half_length / (angle * ease(t)) if t else np.inf
        bent = {}
        for pin, (x, y) in pins.items():
            phi, r = (x - middle) / radius, radius - (y - height)
            bent[pin] = round(middle + r * np.sin(phi), 2), round(height + radius - r * np.cos(phi), 2)
        return bent

    pointer.move(targets, 3.0)
    return pointer


def rearing() -> ScriptedPointer:
    """Let the elephant rear up on its hind legs."""
    pointer = ScriptedPointer("elephant")
    for foot in ((135, 800), (285, 795)):
        pointer.add_pin(*foot)
    points_and_offsets = (
        ((445, 795), (275, -155)),
        ((625, 800), (275, -240)),
        ((915, 180), (-155, -330)),
        ((560, 150), (-130, -90)),
    )
    pins = {pointer.add_pin(*point): (point, offset) for point, offset in points_and_offsets}
    pointer.move(
        lambda t: {
            pin: (round(x + dx * ease(t), 2), round(y + dy * ease(t), 2))
            for pin, ((x, y), (dx, dy)) in pins.items()
        },
        2.0,
    )
    return pointer


def alien() -> ScriptedPointer:
    """Fix the alien's feet; throw up its hands, shake and lean its head, bend an antenna.

    Its antennae are loose.
    """
    pointer = ScriptedPointer("alien")
    for antenna_points in (
        [(285, 122), (345, 135), (370, 165)],
        [(627, 85), (570, 120), (555, 160)],
    ):
        pointer.paint_loose(antenna_points, 65, 2.5)
    for point in ((390, 925), (670, 925), (515, 700)):
        pointer.add_pin(*point)
    left, right = pointer.add_pin(110, 660), pointer.add_pin(880, 430)
    head = pointer.add_pin(500, 260)
    pointer.drag(left, lambda t: (-60 * np.sin(np.pi * t) + 20 * t, -330 * ease(t)), 1.2)
    pointer.drag(right, lambda t: (70 * np.sin(np.pi * t) - 20 * t, 330 * ease(t)), 1.2)
    pointer.drag(head, swing(45, 0, 2), 1.2)
    pointer.pause(1.2)
    antenna = pointer.add_pin(640, 70)
    pointer.drag(head, line(-60, 25), 0.8)
    pointer.drag(antenna, line(90, 100), 1.0)
    return pointer


def cat() -> ScriptedPointer:
    """Fix the cat's feet and body; wave a paw, swing the tail, lean the head."""
    pointer = ScriptedPointer("cat")
    for point in ((415, 912), (590, 912), (800, 912), (640, 600)):
        pointer.add_pin(*point)
    head, paw, tail = (pointer.add_pin(*point) for point in ((290, 310), (118, 798), (881, 100)))
    pointer.drag(paw, swing(-40, -150, 2), 1.4)
    pointer.drag(tail, swing(-110, 40, 2), 1.4)
    pointer.drag(head, swing(45, 20, 1), 1.0)
    return pointer


def gingerbread() -> ScriptedPointer:
    """Fix the gingerbread man's legs; let it wave with both arms and nod."""
    pointer = ScriptedPointer("gingerbread")
    for point in ((315, 902), (709, 902), (500, 640)):
        pointer.add_pin(*point)
    left, right, head = (pointer.add_pin(*point) for point in ((118, 522), (885, 218), (440, 187)))
    pointer.drag(right, swing(-110, -30, 2), 1.4)
    pointer.drag(left, swing(10, -170, 2), 1.4)
    pointer.drag(head, swing(60, 10, 1), 1.0)
    return pointer


def raptor() -> ScriptedPointer:
    """Fix the raptor's feet; swing its tail, nod its head."""
    pointer = ScriptedPointer("raptor")
    for point in ((342, 757), (609, 757), (517, 388)):
        pointer.add_pin(*point)
    tail, head = pointer.add_pin(55, 212), pointer.add_pin(997, 185)
    pointer.drag(tail, swing(40, 130, 2), 1.4)
    pointer.drag(head, swing(-40, 90, 2), 1.4)
    return pointer


def rope() -> ScriptedPointer:
    """Hold the rope in the middle; swing its ends."""
    pointer = ScriptedPointer("rope")
    pointer.add_pin(997, 42)
    left, right = pointer.add_pin(57, 42), pointer.add_pin(1954, 42)
    pointer.drag(left, swing(90, -420, 1), 1.4)
    pointer.drag(right, swing(-90, 420, 1), 1.4)
    return pointer


def robot() -> ScriptedPointer:
    """Fix the robot's feet; let it wave, pass its arm behind its back, talk, nod, and lift the other arm."""
    pointer = ScriptedPointer("robot")
    for point in ((396, 880), (604, 880), (500, 690)):
        pointer.add_pin(*point)
    head = pointer.add_pin(420, 160)
    left, right = pointer.add_pin(846, 390), pointer.add_pin(160, 766)
    pointer.drag(left, swing(60, 0, 2), 1.2)
    pointer.show("mouth open")
    pointer.drag(left, lambda t: (-300 * ease(t), 250 * ease(t) + 150 * np.sin(np.pi * t)), 1.4)
    pointer.show("mouth round")
    pointer.drag(head, line(60, 20), 0.8)
    pointer.show("mouth sad")
    pointer.drag(left, lambda t: (300 * ease(t), -250 * ease(t) + 150 * np.sin(np.pi * t)), 1.2)
    pointer.show("mouth smile")
    pointer.drag(right, lambda t: (-30 * ease(t) - 60 * np.sin(np.pi * t), -430 * ease(t)), 1.3)
    pointer.drag(head, line(-90, 10), 0.8)
    pointer.drag(right, swing(50, 20, 2), 1.0)
    return pointer


if __name__ == "__main__":
    for record in (elephant, rearing, bar, alien, cat, gingerbread, raptor, robot, rope):
        path = resource("assets", "recordings") / f"{record.__name__}.akaprec"
        record().save(path)
        print(path)
