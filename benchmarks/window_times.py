"""Measures the running window from outside: start, latency of a drag, idle time, memory of a large picture.

Run from the project's root: python benchmarks/window_times.py [start] [drag] [idle] [memory]
Needs Xvfb and xdotool. Times are taken by a process beside the program that moves a real mouse (XTest) and
looks at single pixels of the screen, so they include the X server and the program's drawing.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image
from Xlib import X
from Xlib.display import Display
from Xlib.ext import xtest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.akap.project import save
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.running_program import RunningProgram
from tests.support.x_server import x_server

STARTS, MOVES, IDLE_SECONDS = 5, 20, 15.0
SIZES = (2_000, 10_000)
LARGE = 6_000  # pixels a side
HOLDS, GRAB = ((430, 420), (650, 420)), (540, 330)  # on the elephant's body, points of the window
PATCH = 60  # pixels a side, around the pointer: what is watched for a change
STEP = 6  # pixels of a move


def start_seconds(display: str, file: Path, preferences: Path) -> float:
    """Time from the start of the process to the first pixel of the drawing in the window."""
    environment = {**os.environ, "DISPLAY": display, "AKAP_EDITOR_CONFIG": str(preferences)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # installed programs have their bytecode
    connection = Display(display)
    root = connection.screen().root
    began = time.perf_counter()
    command = [sys.executable, "-m", "akap_editor.cli", str(file)]
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    try:
        while _is_plain(root.get_image(340, 300, 400, 200, X.ZPixmap, 0xFFFFFF).data):
            assert process.poll() is None, "the program has ended"
            time.sleep(0.002)
        return time.perf_counter() - began
    finally:
        process.kill()
        process.wait()
        connection.close()


def _is_plain(data: bytes) -> bool:
    """Whether pixels hold no color, as before the drawing is shown."""
    pixels = np.frombuffer(data, dtype=np.uint8).reshape(-1, 4)[:, :3].astype(int)
    return bool((np.ptp(pixels, axis=1) > 60).mean() < 0.1)


def drag_milliseconds(program: RunningProgram, display: str) -> list[float]:
    """Times from a movement of the mouse to the first change of the picture around the pointer."""
    connection = Display(display)
    root = connection.screen().root
    for point in HOLDS:
        program.click(point)
    program.xdotool("mousemove", *GRAB)
    time.sleep(0.3)
    program.xdotool("mousedown", 1)
    times = []
    for number in range(1, MOVES + 1):
        x, y = GRAB[0] + STEP * (number % 2), GRAB[1] - STEP * number // 2
        program.until_idle()
        corner = x - PATCH // 2, y - PATCH // 2
        before = root.get_image(*corner, PATCH, PATCH, X.ZPixmap, 0xFFFFFF).data
        began = time.perf_counter()
        xtest.fake_input(connection, X.MotionNotify, x=x, y=y)
        connection.sync()
        while root.get_image(*corner, PATCH, PATCH, X.ZPixmap, 0xFFFFFF).data == before:
            assert time.perf_counter() < began + 5, "the picture does not change"
        times.append(1000 * (time.perf_counter() - began))
    program.xdotool("mouseup", 1)
    connection.close()
    return times


def memory_megabytes(program: RunningProgram) -> float:
    """Resident memory of the program."""
    for line in Path(f"/proc/{program.process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    raise AssertionError("the program has ended")


def _large_picture(path: Path) -> None:
    y, x = np.mgrid[:LARGE, :LARGE]
    inside = np.hypot(x - LARGE / 2, y - LARGE / 2) < 0.45 * LARGE
    noise = np.random.default_rng(1).integers(0, 256, (LARGE, LARGE), dtype=np.uint8)
    picture = np.stack([noise, np.full_like(noise, 90), np.full_like(noise, 40), 255 * inside], axis=-1)
    Image.fromarray(picture.astype(np.uint8)).save(path, compress_level=1)


def _elephant(folder: Path, vertices: int) -> Path:
    image = read_image(resource("assets", "drawings", "elephant.png"))
    path = folder / f"elephant-{vertices}.akap"
    save(new_document(make_drawing(image, vertices=vertices, name="elephant")), path)
    return path


def measure_start(display: str, folder: Path) -> None:
    """Print the times of the first start and of later ones."""
    file = _elephant(folder, SIZES[0])
    times = [start_seconds(display, file, folder / "preferences") for _ in range(STARTS)]
    print(f"start to first picture: first {times[0]:.2f} s, later {statistics.median(times[1:]):.2f} s")


def measure_drag(display: str, folder: Path) -> None:
    """Print the latency of a drag at both sizes."""
    for vertices in SIZES:
        program = RunningProgram(display, _elephant(folder, vertices), folder, folder / "preferences")
        times = sorted(drag_milliseconds(program, display))
        print(
            f"hand to changed picture, {vertices} vertices: median {statistics.median(times):.0f} ms, "
            f"95 % {times[int(0.95 * len(times))]:.0f} ms"
        )
        program.process.kill()
        program.process.wait()


def measure_idle(display: str, folder: Path) -> None:
    """Print the share of a processor that the idle window uses."""
    program = RunningProgram(display, _elephant(folder, SIZES[0]), folder, folder / "preferences")
    program.until_idle()
    time.sleep(3.0)
    before, began = program.cpu_seconds(), time.perf_counter()
    time.sleep(IDLE_SECONDS)
    share = (program.cpu_seconds() - before) / (time.perf_counter() - began)
    print(f"idle: {100 * share:.2f} % of a processor")
    program.process.kill()
    program.process.wait()


def measure_memory(display: str, folder: Path) -> None:
    """Print the memory before, with and after a large picture."""
    path = folder / "large.png"
    _large_picture(path)
    program = RunningProgram(display, _elephant(folder, SIZES[0]), folder, folder / "preferences")
    found = [memory_megabytes(program)]
    program.press("ctrl+o")
    time.sleep(1.0)
    program.type_file(path)
    _wait_for(lambda: memory_megabytes(program) > found[0] + 100)
    program.until_idle()
    found.append(memory_megabytes(program))
    program.press("ctrl+w")
    time.sleep(3.0)
    program.until_idle()
    found.append(memory_megabytes(program))
    before, opened, closed = found
    print(f"memory: {before:.0f} MB, with {LARGE} × {LARGE} pixels {opened:.0f} MB, closed {closed:.0f} MB")
    program.process.kill()
    program.process.wait()


def _wait_for(holds: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 120
    while not holds():
        assert time.monotonic() < deadline, "nothing happens"
        time.sleep(0.1)


MEASUREMENTS = {"start": measure_start, "drag": measure_drag, "idle": measure_idle, "memory": measure_memory}


def main() -> None:
    """Run the chosen measurements, by default all."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", choices=[[], *MEASUREMENTS], default=[])
    os.environ["AKAP_EDITOR_FILE_DIALOG"] = "own"
    os.environ["AKAP_EDITOR_LANGUAGE"] = "en"
    for name in parser.parse_args().names or MEASUREMENTS:
        with tempfile.TemporaryDirectory() as folder, x_server() as server:
            (Path(folder) / "preferences").mkdir()
            os.environ["AKAP_EDITOR_STATE"] = folder  # no recovery copies of programs that were killed
            MEASUREMENTS[name](server.display, Path(folder))


if __name__ == "__main__":
    main()
