"""Layers: CPU time of a step of a puppet beside its flat picture, and opening of a large PSD file.

Run from the project's root: python benchmarks/layers.py [step | open] [--puppet FILE ...]
A step is timed in CPU milliseconds while a pin is led around, both drawings with as many vertices, the same
pins and memory: the median of the thread, and the mean of the process, in which another thread makes factors.
The bundled puppet has pins at the places below; further puppets have one at the end of each limb of their
flat picture. Then the time of adding the last pin, after which the chain between the pins is another one,
and of the first two steps, in which that chain is prepared. The large file, 3000 x 3000 pixels with 25
layers, is opened in a process of its own, whose peak of memory counts.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw
from psd_tools import PSDImage

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.geometry.limbs import find_limbs
from akap_editor.io.layers.open_layers import open_layers
from akap_editor.layers.composite import composite
from akap_editor.resources import bundled_puppets

Place = tuple[float, float]
FEET, HEAD, HAND, OTHER_HAND = (
    ((396.0, 880.0), (604.0, 880.0)),
    (420.0, 160.0),
    (846.0, 390.0),
    (160.0, 766.0),
)
PINS: dict[str, tuple[Place, ...]] = {  # of the bundled puppet; the last one is dragged
    "feet, head, hand": (*FEET, HEAD, HAND),
    "hands and feet": (*FEET, OTHER_HAND, HAND),
    "hand only": (HAND,),
}
STEPS, RADIUS = 120, 0.1  # of the drag, a circle, as a share of √area
SIDE, LAYERS = 3000, 25


class Drag(NamedTuple):
    """CPU milliseconds: median step of the thread, mean step of the process, last pin, first two steps."""

    step: float
    process_step: float
    last_pin: float
    first_steps: float


def measure_drag(drawing: Drawing, places: Sequence[Place]) -> Drag:
    """Pin ``places`` of the drawing, and lead the last one around."""
    document = new_document(drawing)
    joints = tuple(replace(joint, is_proposed=False) for joint in suggest_joints(drawing))
    session = Session(document.with_state(replace(document.state, joints=joints)))
    session.begin("Drag Pins")
    for place in places[:-1]:
        assert add_pin(session, place) is not None, f"no pin at {place}"
    start = time.thread_time()
    pin = add_pin(session, places[-1])
    last_pin = time.thread_time() - start
    assert pin is not None, f"no pin at {places[-1]}"
    own, all_threads, radius = [], [], RADIUS * drawing.mesh.length
    for turn in np.linspace(0, 2 * np.pi, STEPS):
        x, y = places[-1][0] + radius * (np.cos(turn) - 1), places[-1][1] + radius * np.sin(turn)
        session.apply(SetTargets({pin: (float(x), float(y))}))
        start, start_of_all = time.thread_time(), time.process_time()
        session.step()
        own.append(time.thread_time() - start)
        all_threads.append(time.process_time() - start_of_all)
    times = float(np.median(own[10:])), float(np.mean(all_threads[10:])), last_pin, own[0] + own[1]
    return Drag(*(1000 * seconds for seconds in times))


def limb_ends(drawing: Drawing) -> tuple[Place, ...]:
    """Places at the ends of the limbs of a flat drawing."""
    places = drawing.mesh.vertices[find_limbs(drawing.mesh).tips].tolist()
    return tuple((x, y) for x, y in places)


def print_steps(puppets: list[str]) -> None:
    """Print the steps of puppets and of their flat pictures."""
    for path in (*bundled_puppets(), *map(Path, puppets)):
        layered = open_layers(path)
        flat = composite(layered)
        for vertices in (2_000, 10_000):
            puppet = make_drawing(layers=layered, vertices=vertices)
            picture = make_drawing(flat, vertices=vertices)
            cases = PINS if path in bundled_puppets() else {"ends of limbs": limb_ends(picture)}
            for name, places in cases.items():
                measure_drag(puppet, places)  # loads what is compiled
                a, b = measure_drag(puppet, places), measure_drag(picture, places)
                print(
                    f"{path.stem:14} {vertices:6} vertices, {name:16}: layers {a.step:5.2f} ms, flat "
                    f"{b.step:5.2f} ms, {a.step / b.step:.2f} times; of the process "
                    f"{a.process_step:5.2f} and {b.process_step:5.2f}; "
                    f"last pin {a.last_pin:5.1f} and {b.last_pin:4.1f}, "
                    f"first steps {a.first_steps:4.1f} and {b.first_steps:4.1f}",
                    flush=True,
                )


def make_large_file(path: Path) -> None:
    """A PSD file whose layers cover a third of the canvas each, as those of a large puppet do."""
    psd, rng = PSDImage.new("RGB", (SIDE, SIDE)), np.random.default_rng(0)
    for number in range(LAYERS):
        side = int(SIDE * 0.58)
        picture = Image.new("RGBA", (side, side))
        color = (*rng.integers(40, 255, 3).tolist(), 255)
        ImageDraw.Draw(picture).ellipse(
            (8, 8, side - 8, side - 8), fill=color, outline=(30, 25, 40, 255), width=24
        )
        noise = rng.integers(-6, 7, (side, side, 1))
        pixels = np.asarray(picture).astype(int)
        pixels[..., :3] = np.clip(pixels[..., :3] + noise * (pixels[..., 3:] > 0), 0, 255)
        left, top = rng.integers(0, SIDE - side, 2).tolist()
        psd.create_pixel_layer(
            Image.fromarray(pixels.astype(np.uint8), "RGBA"), name=f"layer {number}", left=left, top=top
        )
    psd.save(path)


def print_opening() -> None:
    """Print time and peak of memory of reading the large file's layers."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.psd"
        make_large_file(path)
        print(f"{SIDE} x {SIDE} pixels, {LAYERS} layers, {path.stat().st_size / 1e6:.0f} MB:", flush=True)
        subprocess.run([sys.executable, __file__, "--child", str(path)], check=True)


def peak_megabytes() -> float:
    """Most memory that this process has had, on Linux; getrusage also counts what its parent had."""
    (kilobytes,) = re.findall(r"VmHWM:\s*(\d+)", Path("/proc/self/status").read_text())
    return int(kilobytes) / 1024


def print_child(path: str) -> None:
    """Print what opening takes in this process."""
    before = peak_megabytes()
    start = time.perf_counter()
    layered = open_layers(path)
    seconds = time.perf_counter() - start
    memory = f"{before:.0f} MB before, peak {peak_megabytes():.0f} MB"
    print(f"{len(layered.layers)} layers in {seconds:.1f} s, {memory}")


def main() -> None:
    """Print what was asked for, by default all."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("part", nargs="?", choices=["step", "open"], help="by default both")
    parser.add_argument("--puppet", action="append", default=[], help="a further drawing in layers")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        print_child(arguments.child)
        return
    if arguments.part != "open":
        print_steps(arguments.puppet)
    if arguments.part != "step":
        print_opening()


if __name__ == "__main__":
    main()
