"""Makes the bundled recordings: a hand, played by smooth curves, poses a drawing at 30 moves a second.

Run from the project's root: python tools/make_recordings.py
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import SetTargets
from akap_editor.io.akap.recording import write_recording
from akap_editor.io.images import read_image
from akap_editor.resources import resource

MOVES_PER_SECOND = 30
Curve = Callable[[float], tuple[float, float]]


class Hand:
    """Moves the pointer over an editor whose clock it turns."""

    def __init__(self, name: str) -> None:
        self.now = 0.0
        self.editor = Editor(clock=lambda: self.now)
        image = read_image(resource("assets", "drawings", f"{name}.png"))
        self.editor.open(new_document(make_drawing(image, name=name)))

    def pause(self, seconds: float) -> None:
        """Let time pass; the drawing settles meanwhile."""
        for _ in range(round(seconds * MOVES_PER_SECOND)):
            self.now += 1 / MOVES_PER_SECOND
            self.editor.advance(budget=np.inf)

    def pin(self, x: float, y: float) -> int:
        """Click on the drawing."""
        added = self.editor.add_pin((x, y))
        assert added is not None
        self.pause(0.1)
        return added

    def drag(self, pin: int, curve: Curve, seconds: float) -> None:
        """Drag a pin along offsets ``curve`` of 0..1 from where it is."""
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

    def move(self, way: Callable[[float], dict[int, tuple[float, float]]], seconds: float) -> None:
        """Drag several pins at once, each on its own way of 0..1."""
        session = self.editor.session
        assert session is not None
        session.begin("Move Pins")
        steps = round(seconds * MOVES_PER_SECOND)
        for step in range(1, steps + 1):
            session.apply(SetTargets(way(step / steps)))
            self.pause(1 / MOVES_PER_SECOND)
        session.commit()
        self.pause(0.2)

    def save(self, path: Path) -> None:
        """Write what was recorded."""
        assert self.editor.session is not None
        write_recording(self.editor.session.recording, path)


def ease(t: float) -> float:
    """From 0 to 1, slow at both ends."""
    return t * t * (3 - 2 * t)


def line(dx: float, dy: float) -> Curve:
    """Straight to an offset, slow at both ends."""
    return lambda t: (dx * ease(t), dy * ease(t))


def swing(dx: float, dy: float, times: int) -> Curve:
    """To and fro about the start, ending there."""
    return lambda t: (
        dx * np.sin(2 * np.pi * times * t) * (1 - t),
        dy * np.sin(2 * np.pi * times * t) * (1 - t),
    )


def elephant() -> Hand:
    """Holds its feet still, swings its trunk, wags its tail, nods, and lifts its trunk over its head."""
    hand = Hand("elephant")
    for foot in ((135, 800), (285, 795), (445, 795), (625, 800)):
        hand.pin(*foot)
    hand.pin(260, 420)
    trunk = hand.pin(915, 180)
    hand.drag(trunk, line(30, 170), 1.0)
    hand.drag(trunk, swing(60, 70, 2), 1.2)
    tail = hand.pin(65, 290)
    hand.drag(tail, swing(70, -30, 2), 1.2)
    head = hand.pin(560, 170)
    hand.drag(head, line(40, 60), 0.7)
    hand.drag(head, line(-70, -75), 0.8)
    hand.drag(trunk, line(-310, -270), 1.5)
    hand.pause(0.4)
    return hand


def bar() -> Hand:
    """Bends the bar as in Fig. 9: both ends, two pins each, along the arc on which its middle line keeps its
    length. 207° is where conformal coordinates give the figure of Table 1, see docs/methods.md.
    """
    hand, middle, height, reach, bend = Hand("bar"), 560.0, 150.0, 485.0, np.radians(207)
    places = [(middle + side * reach, height + up) for side in (-1, 1) for up in (-70.0, 70.0)]
    pins = {hand.pin(*place): place for place in places}

    def bent(t: float) -> dict[int, tuple[float, float]]:
        radius = 2 * reach / (bend * ease(t)) if t else np.inf
        ways = {}
        for pin, (x, y) in pins.items():
            turn, arm = (x - middle) / radius, radius - (y - height)
            ways[pin] = (
                round(middle + arm * np.sin(turn), 2),
                round(height + radius - arm * np.cos(turn), 2),
            )
        return ways

    hand.move(bent, 3.0)
    return hand


def rearing() -> Hand:
    """The elephant rears up on its hind legs, trumpeting."""
    hand = Hand("elephant")
    for foot in ((135, 800), (285, 795)):
        hand.pin(*foot)
    ways = (
        ((445, 795), (275, -155)),
        ((625, 800), (275, -240)),
        ((915, 180), (-155, -330)),
        ((560, 150), (-130, -90)),
    )
    pins = {hand.pin(*place): (place, way) for place, way in ways}
    hand.move(
        lambda t: {
            pin: (round(x + dx * ease(t), 2), round(y + dy * ease(t), 2))
            for pin, ((x, y), (dx, dy)) in pins.items()
        },
        2.0,
    )
    return hand


def alien() -> Hand:
    """Stands on its feet, throws up its hands, leans its head and bends an antenna."""
    hand = Hand("alien")
    for place in ((390, 925), (670, 925), (515, 700)):
        hand.pin(*place)
    left, right = hand.pin(110, 660), hand.pin(880, 430)
    head, antenna = hand.pin(500, 260), hand.pin(655, 60)
    hand.drag(left, lambda t: (-60 * np.sin(np.pi * t) + 20 * t, -330 * ease(t)), 1.2)
    hand.drag(right, lambda t: (70 * np.sin(np.pi * t) - 20 * t, 330 * ease(t)), 1.2)
    hand.drag(head, line(-60, 25), 0.8)
    hand.drag(antenna, line(120, 120), 1.0)
    return hand


if __name__ == "__main__":
    for make in (elephant, rearing, bar, alien):
        target = resource("assets", "recordings") / f"{make.__name__}.akaprec"
        make().save(target)
        print(target)
