"""Layers: CPU time of a step of the bundled puppet beside its flat picture, and opening of a large PSD file.

Run from the project's root: python benchmarks/layers.py [step | open]
A step is timed as the median of a drag of the puppet's hand in CPU milliseconds of the thread, both drawings
with as many vertices, the same pins and memory. The large file, 3000 x 3000 pixels with 25 layers, is opened
in a process of its own, whose peak of memory counts.
"""

import argparse
import re
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from psd_tools import PSDImage

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.io.layers.open_layers import open_layers
from akap_editor.layers.composite import composite
from akap_editor.resources import bundled_puppets

HELD, HAND = ((396.0, 880.0), (604.0, 880.0), (420.0, 160.0)), (846.0, 390.0)  # feet and head; a hand
STEPS, RADIUS = 120, 60.0  # of the drag, a circle, in pixels
SIDE, LAYERS = 3000, 25


def step_milliseconds(drawing: Drawing) -> float:
    """Median CPU time of a step while the hand is led around."""
    document = new_document(drawing)
    joints = tuple(replace(joint, is_proposed=False) for joint in suggest_joints(drawing))
    session = Session(document.with_state(replace(document.state, joints=joints)))
    session.begin("Drag Pins")
    for place in HELD:
        add_pin(session, place)
    pin = add_pin(session, HAND)
    assert pin is not None
    times = []
    for turn in np.linspace(0, 2 * np.pi, STEPS):
        x, y = HAND[0] + RADIUS * (np.cos(turn) - 1), HAND[1] + RADIUS * np.sin(turn)
        session.apply(SetTargets({pin: (float(x), float(y))}))
        start = time.thread_time()
        session.step()
        times.append(1000 * (time.thread_time() - start))
    return float(np.median(times[10:]))


def print_steps() -> None:
    """Print the step of the puppet and of the flat picture."""
    (path,) = bundled_puppets()
    layered = open_layers(path)
    flat = composite(layered)
    for vertices in (2_000, 10_000):
        puppet = make_drawing(layers=layered, vertices=vertices)
        picture = make_drawing(flat, vertices=vertices)
        layers, whole = step_milliseconds(puppet), step_milliseconds(picture)
        ratio = layers / whole
        print(f"{vertices:6} vertices: layers {layers:5.2f} ms, flat {whole:5.2f} ms, {ratio:.2f} times")


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
    parser.add_argument("--child", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        print_child(arguments.child)
        return
    if arguments.part != "open":
        print_steps()
    if arguments.part != "step":
        print_opening()


if __name__ == "__main__":
    main()
