"""One dragged frame of the editor, taken apart: what does each part of it cost?

Run from the project's root: python benchmarks/frame.py [--frames N] [--drawing NAME]
Opens the real window on GLFW's null platform (no display needed), drags the trunk of the bundled elephant
with pointer events, and prints for each mesh size the median and the 95th percentile of one frame in
milliseconds, split into the parts named in `PARTS`, and the process's peak memory.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import resource as system
import subprocess
import sys
import time

import numpy as np
from timing import Clock

from akap_editor.app import window as window_module
from akap_editor.app.window import Window
from akap_editor.deform.akap import AkapDeformer
from akap_editor.deform.akvf import KillingSystem
from akap_editor.editor.document import make_drawing, new_document
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.io.images import read_image
from akap_editor.render.renderer import Renderer
from akap_editor.resources import resource

SIZES = (1000, 3000, 10000)
PINS = ((135, 800), (285, 795), (445, 795), (625, 800), (260, 420))
GRIP, REACH = (915, 180), (-250.0, -90.0)
PARTS = ("solve", "spirals", "memory", "upload", "draw", "interface", "frame")


def instrument(clock: Clock) -> None:
    """Sort the parts of a frame; whatever no other part claims is the interface."""
    clock.wrap(KillingSystem, "prepare", "solve")
    clock.wrap(KillingSystem, "field", "solve")
    clock.wrap(AkapDeformer, "_move", "spirals")
    clock.wrap(AkapDeformer, "_remember", "memory")
    clock.wrap(Renderer, "show", "upload")
    clock.wrap(Renderer, "draw", "draw")
    # llvmpipe draws when it must: the wait for the picture belongs to drawing.
    clock.wrap(window_module.glfw, "swap_buffers", "draw")
    clock.wrap(Window, "_frame", "interface")


def measure(vertices: int, frames: int, name: str) -> tuple[int, list[dict[str, float]], float]:
    """Drag for ``frames`` frames; the vertex count, the seconds of each frame, steps per frame."""
    clock = Clock(PARTS)
    instrument(clock)
    steps = [0]
    original = Editor.advance

    def advance(editor: Editor, budget: float = 0.0) -> bool:
        steps[0] += 1
        return original(editor, 0.0)  # one step a frame, so that sizes compare

    Editor.advance = advance  # type: ignore[method-assign]
    image = read_image(resource("assets", "drawings", f"{name}.png"))
    rows = []
    with Window(null=True) as window:
        for _ in range(4):
            window.frame()
        window.space.show(new_document(make_drawing(image, vertices=vertices, name=name)))
        editor = window.space.editor
        for pin in PINS:
            editor.add_pin(pin)
        to_screen = editor.camera.to_screen
        editor.handle_event(PointerEvent("press", to_screen(GRIP)))
        for frame in range(1, frames + 1):
            t = 0.5 - 0.5 * np.cos(2 * np.pi * frame / frames)
            editor.handle_event(
                PointerEvent("move", to_screen((GRIP[0] + t * REACH[0], GRIP[1] + t * REACH[1])))
            )
            clock.take()
            started = time.perf_counter()
            window.frame()
            total = time.perf_counter() - started
            rows.append({**clock.take(), "frame": total})
        assert editor.session is not None
        count = len(editor.session.drawing.mesh.vertices)
    return count, rows[3:], steps[0] / frames


def print_table(count: int, rows: list[dict[str, float]]) -> None:
    """Median and 95th percentile of each part, milliseconds."""
    memory = system.getrusage(system.RUSAGE_SELF).ru_maxrss / (1024**2 if sys.platform == "darwin" else 1024)
    for label, quantile in (("median", 50), ("95 %", 95)):
        values = [1000 * float(np.percentile([row[part] for row in rows], quantile)) for part in PARTS]
        lead = f"{count:>8,}" if quantile == 50 else " " * 8
        tail = f"{1000 / values[-1]:7.0f} fps  {memory:6.0f} MB" if quantile == 50 else ""
        print(
            f"{lead}  {label:>6} " + "".join(f"{value:10.2f}" for value in values) + f"  {tail}", flush=True
        )


def main() -> None:
    """Each size in a process of its own, so that peak memory is its own as well."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=90)
    parser.add_argument("--drawing", default="elephant", choices=["elephant"])
    parser.add_argument("--size", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.size:
        count, rows, _ = measure(options.size, options.frames, options.drawing)
        print_table(count, rows)
        return
    print(f"One dragged frame, milliseconds ({options.drawing}, {len(PINS) + 1} pins, 1280×800, one thread)")
    print(f"{'vertices':>8}  {'':>6} " + "".join(f"{part:>10}" for part in PARTS))
    for size in SIZES:
        command = [sys.executable, __file__, "--size", str(size), "--frames", str(options.frames)]
        subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
