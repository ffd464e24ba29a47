"""Writes the bundled clips, assets/clips/*.clip.json: python tools/make_clips.py.

The figure has the unit of its trunk; x points right, y down, and left and right are those of the picture.
"""

import cmath
from collections.abc import Callable, Iterable
from math import cos, pi, radians, sin

import numpy as np

from akap_editor.editor.animation.clips.clip import Clip, ClipKey, ClipPin
from akap_editor.io.akap.clip import CLIP_SUFFIX, save_clip
from akap_editor.resources import resource

FIGURE = {  # the pin on which each hangs, and its place at rest
    "Body": (None, 0j),
    "Chest": ("Body", -1j),
    "Head": ("Chest", -2j),
    "Left Hand": ("Chest", -1.6 - 0.7j),
    "Right Hand": ("Chest", 1.6 - 0.7j),
    "Left Foot": ("Body", -0.5 + 1.4j),
    "Right Foot": ("Body", 0.5 + 1.4j),
    "Tail Root": ("Body", -1 + 0.2j),
    "Tail": ("Tail Root", -1.6 - 0.6j),
}
Pose = dict[str, complex]


def turned(name: str, degrees: float, length: float = 1.0, base: complex = 0j) -> complex:
    """The place of a pin rotated clockwise about the one on which it hangs, which has moved by ``base``."""
    parent, place = FIGURE[name]
    pivot = FIGURE[parent][1] if parent is not None else 0j
    return pivot + base + length * cmath.rect(1, radians(degrees)) * (place - pivot)


def clip(name: str, pins: Iterable[str], keys: Iterable[tuple[float, Pose]]) -> Clip:
    """A clip of some pins of the figure; those that a key does not place are at rest."""
    names = list(pins)
    rest = np.array([[FIGURE[pin][1].real, FIGURE[pin][1].imag] for pin in names])
    made = []
    for time, pose in keys:
        places = [pose.get(pin, FIGURE[pin][1]) for pin in names]
        positions = np.array([[place.real, place.imag] for place in places]).round(4)
        made.append(ClipKey(round(time, 3), positions))
    parents = [FIGURE[pin][0] for pin in names]
    tree = (
        ClipPin(pin, parent if parent in names else None) for pin, parent in zip(names, parents, strict=True)
    )
    return Clip(name, tuple(tree), rest, tuple(made))


def wave() -> Clip:
    """The right hand goes up and waves three times; the head leans."""
    up = {"Right Hand": turned("Right Hand", -20), "Head": turned("Head", 4)}
    down = {"Right Hand": turned("Right Hand", 14), "Head": turned("Head", 4)}
    poses = [{}, up, down, up, down, up, {}]
    return clip(
        "Wave",
        ["Body", "Chest", "Head", "Right Hand"],
        zip((0, 0.35, 0.6, 0.85, 1.1, 1.35, 1.8), poses, strict=True),
    )


def nod() -> Clip:
    """The head goes down twice."""
    down = {"Head": turned("Head", 12, 0.9)}
    poses = [{}, down, {}, down, {}]
    return clip("Nod", ["Body", "Chest", "Head"], zip((0, 0.25, 0.5, 0.75, 1.1), poses, strict=True))


def hop() -> Clip:
    """A crouch, a jump, and a landing."""

    def shifted(shift: complex, feet: complex, squash: float, arms: float) -> Pose:
        chest = shift - 1j * squash
        return {
            "Body": shift,
            "Chest": chest,
            "Head": chest - 1j * squash,
            "Left Hand": turned("Left Hand", arms, base=chest + 1j),
            "Right Hand": turned("Right Hand", -arms, base=chest + 1j),
            "Left Foot": FIGURE["Left Foot"][1] + feet,
            "Right Foot": FIGURE["Right Foot"][1] + feet,
        }

    crouch, leap = shifted(0.3j, 0j, 0.92, -16), shifted(-1.0j, -0.85j, 1.05, 22)
    times = (0, 0.25, 0.55, 0.85, 1.15)
    pins = [name for name in FIGURE if "Tail" not in name]
    return clip("Hop", pins, zip(times, [{}, crouch, leap, crouch, {}], strict=True))


def walk() -> Clip:
    """Two steps on the spot in a second."""

    def pose(phase: float) -> Pose:
        body = -0.05j * abs(sin(phase)) + 0.03 * sin(phase)
        lean = 3 * sin(phase)
        return {
            "Body": body,
            "Chest": turned("Chest", lean / 2, base=body),
            "Head": turned("Head", -lean / 2, base=body),
            "Left Hand": turned("Left Hand", 7 * cos(phase), base=body),
            "Right Hand": turned("Right Hand", 7 * cos(phase), base=body),
            "Left Foot": FIGURE["Left Foot"][1] + 0.12 * cos(phase) - 0.45j * max(sin(phase), 0),
            "Right Foot": FIGURE["Right Foot"][1] - 0.12 * cos(phase) - 0.45j * max(-sin(phase), 0),
        }

    pins = [name for name in FIGURE if "Tail" not in name]
    return clip("Walk in Place", pins, ((k / 8, pose(2 * pi * (k % 8) / 8)) for k in range(9)))


def tail_wag() -> Clip:
    """The tail swings to both sides."""
    angles = (0, 20, -16, 20, -16, 0)
    times = (0, 0.2, 0.5, 0.8, 1.1, 1.4)
    keys = ((time, {"Tail": turned("Tail", angle)}) for time, angle in zip(times, angles, strict=True))
    return clip("Tail Wag", ["Body", "Tail Root", "Tail"], keys)


CLIPS: tuple[Callable[[], Clip], ...] = (wave, nod, hop, walk, tail_wag)


def main() -> None:
    for make in CLIPS:
        made = make()
        save_clip(made, resource("assets", "clips") / f"{made.name.lower().replace(' ', '-')}{CLIP_SUFFIX}")


if __name__ == "__main__":
    main()
