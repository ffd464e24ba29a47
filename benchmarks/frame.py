"""Measures the frames of the editor while a pin is dragged.

Run from the project's root: python benchmarks/frame.py [--seconds S] [--drawing NAME]
Opens the window on GLFW's null platform, which needs no display, runs its own loop, and drags the trunk of
the bundled elephant with a hundred pointer events a second. Prints for each mesh size, in milliseconds, the
median, the 95th percentile and the maximum of the time between two frames, of the `PARTS` of a frame, and of
the steps that the engine's thread computes meanwhile. Also prints frames and steps per second and the peak
memory.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import ctypes
import resource as system
import subprocess
import sys
import time
from typing import Any

# imgui_bundle first: its import makes pyGLFW load the same libglfw that ImGui's backend is linked to
import imgui_bundle  # noqa: F401  # isort: skip
import glfw
import numpy as np
from timing import FunctionTimer

from akap_editor.app import files
from akap_editor.app.window import Window
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.session import Session
from akap_editor.io.images import read_image
from akap_editor.render.renderer import Renderer
from akap_editor.resources import resource

SIZES = (1000, 3000, 10000, 30000)
PINS = ((135, 800), (285, 795), (445, 795), (625, 800), (260, 420))
GRIP, REACH = (915, 180), (-250.0, -90.0)
RATE = 100  # pointer events per second
PARTS = ("wait", "upload", "draw", "interface")
COLUMNS = ("interval", *PARTS, "step")


class Hand:
    """Drags the tip of the trunk to another point and back. seconds: duration of the drag."""

    def __init__(self, window: Window, seconds: float) -> None:
        self._editor, self._seconds = window.state.editor, seconds
        self._to_screen = self._editor.camera.to_screen
        self._editor.handle_event(PointerEvent("press", self._to_screen(GRIP)))
        self._started = time.perf_counter()
        self._moves = 0

    @property
    def elapsed(self) -> float:
        """Seconds since the press."""
        return time.perf_counter() - self._started

    def move(self) -> bool:
        """Send the pointer event that is due; whether there was one."""
        moves = int(self.elapsed * RATE)
        if moves == self._moves:
            return False
        self._moves = moves
        t = 0.5 - 0.5 * np.cos(2 * np.pi * self.elapsed / self._seconds)
        point = GRIP[0] + t * REACH[0], GRIP[1] + t * REACH[1]
        self._editor.handle_event(PointerEvent("move", self._to_screen(point)))
        return True

    def until_next_move(self) -> float:
        """Seconds until the next pointer event is due."""
        return max((self._moves + 1) / RATE - self.elapsed, 0.0)


def instrument(timer: FunctionTimer, window: Window) -> list[float]:
    """Time the parts of each frame; returns a list that will hold the seconds of each step.

    The time of a frame that belongs to no other part counts as the interface.
    """
    timer.wrap(Session, "step_is_ready", "wait")
    timer.wrap(Renderer, "show", "upload")
    timer.wrap(Renderer, "draw", "draw")
    # Without a screen no frame is ever finished, and its commands stay in memory. As in `glfw.swap_buffers`,
    # other threads run meanwhile.
    address: Any = glfw.get_proc_address("glFinish")
    finish = ctypes.CFUNCTYPE(None)(address)
    glfw.swap_buffers = lambda _: finish()  # type: ignore[assignment]
    timer.wrap(glfw, "swap_buffers", "draw")
    timer.wrap(Window, "_draw", "interface")
    steps: list[float] = []
    step = Session.step

    def timed_step(session: Session) -> object:
        result = step(session)
        steps.append(result.report.seconds)
        return result

    Session.step = timed_step  # type: ignore[assignment, method-assign]
    return steps


def measure(vertices: int, seconds: float, name: str) -> tuple[int, list[dict[str, float]], list[float]]:
    """Drag for some seconds; returns the vertex count, the seconds of each frame's parts and of each step."""
    timer = FunctionTimer(PARTS)
    image = read_image(resource("assets", "drawings", f"{name}.png"))
    with Window(null=True) as window:
        files.show_document(window.state, new_document(make_drawing(image, vertices=vertices, name=name)))
        editor = window.state.editor
        for pin in PINS:
            gestures.add_pin(editor, pin)
        for _ in range(20):  # until the panels have their final size and the drawing is fitted
            window.frame()
        steps = instrument(timer, window)
        hand = Hand(window, seconds)
        wait_for_wake = window.wait_for_events
        window.wait_for_events = lambda seconds: wait_for_wake(min(seconds, hand.until_next_move()))
        rows: list[dict[str, float]] = []
        before = window.frames, time.perf_counter()
        while hand.elapsed < seconds:
            if hand.move():
                window.wake()
            window.loop_once()
            now = window.frames, time.perf_counter()
            if now[0] > before[0]:
                rows.append({**timer.take(), "interval": now[1] - before[1]})
                before = now
        assert editor.session is not None
        count = len(editor.session.drawing.mesh.vertices)
    return count, rows[3:], steps


def print_table(count: int, rows: list[dict[str, float]], steps: list[float], seconds: float) -> None:
    """Print the median, the 95th percentile and the maximum of each column in milliseconds."""
    memory = system.getrusage(system.RUSAGE_SELF).ru_maxrss / (1024**2 if sys.platform == "darwin" else 1024)
    columns = {name: [row[name] for row in rows] for name in COLUMNS[:-1]} | {"step": steps}
    for label, quantile in (("median", 50), ("95 %", 95), ("max", 100)):
        values = [1000 * float(np.percentile(columns[name], quantile)) for name in COLUMNS]
        first = quantile == 50
        rates = f"  {len(rows) / seconds:6.0f} {len(steps) / seconds:6.0f} /s  {memory:5.0f} MB"
        line = "".join(f"{value:10.2f}" for value in values)
        print(f"{count if first else '':>8}  {label:>6} {line}{rates if first else ''}", flush=True)


def main() -> None:
    """Measure each size in its own process, so that the peak memory is that of the size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=6.0)
    parser.add_argument("--drawing", default="elephant", choices=["elephant"])
    parser.add_argument("--size", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.size:
        count, rows, steps = measure(options.size, options.seconds, options.drawing)
        print_table(count, rows, steps, options.seconds)
        return
    print(f"While a pin is dragged, milliseconds ({options.drawing}, {len(PINS) + 1} pins, 1280×800)")
    print(f"{'vertices':>8}  {'':>6} " + "".join(f"{name:>10}" for name in COLUMNS) + "  frames  steps")
    for size in SIZES:
        command = [sys.executable, __file__, "--size", str(size), "--seconds", str(options.seconds)]
        subprocess.run(command, check=True)


if __name__ == "__main__":
    main()
