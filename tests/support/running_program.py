"""`RunningProgram`: the program on an X server, with a real mouse and keyboard, seen through screenshots."""

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageGrab
from scipy.ndimage import distance_transform_edt
from Xlib.display import Display

from tests.support.x11 import X11Client

Screen = NDArray[np.uint8]  # (h, w, 3)
Point = Sequence[float]

SIZE = (1280, 800)  # of the window by default
DEADLINE = 300.0  # seconds; a slow machine takes minutes to compile the engine at the first start
PAUSE = 0.05  # seconds between two looks at the screen
LEFT, TOP, RIGHT, BOTTOM = 48, 64, 1280 - 288, 760  # within the canvas, without menu, options and status bar
CORNER = (LEFT + 12, TOP + 12)  # on the canvas, beside the drawing
MARKER = 12  # pixels around a pin's center that its marker covers, without the handles of its ring


class RunningProgram:
    """The running program and its window, which is called the screen; points count from its top left corner.

    display: of the X server; file: to open; folder: for the log and for screenshots of failures; preferences:
    folder of the program's preferences.
    """

    def __init__(self, display: str, file: Path, folder: Path, preferences: Path) -> None:
        self._folder, self._saved_screens = folder, 0
        removed = {"WAYLAND_DISPLAY", "XDG_SESSION_TYPE"}
        self._environment = {name: value for name, value in os.environ.items() if name not in removed}
        self._environment["DISPLAY"] = self._display = display
        self._environment["AKAP_EDITOR_CONFIG"] = str(preferences)
        command = [sys.executable, "-m", "akap_editor.cli", str(file)]
        self._log = (folder / f"{Path(file).stem}.log").open("w+")
        self.process = subprocess.Popen(command, env=self._environment, stderr=self._log)
        self._connection = Display(display)
        self._window = self._find_window()
        self.xdotool("mousemove", *CORNER)
        self.until(lambda screen: (np.ptp(canvas(screen), axis=2) > 60).mean() > 0.02, "a drawing is shown")

    # -- the screen ----------------------------------------------------------------------------------------

    def grab(self) -> Screen:
        """The screen."""
        x, y = self._origin
        box = x, y, x + SIZE[0], y + SIZE[1]
        return np.asarray(ImageGrab.grab(box, xdisplay=self._display).convert("RGB"))

    def _find_window(self) -> int:
        """Wait for the window, and for the keyboard focus; returns its number."""
        find = ["search", "--onlyvisible", "--all", "--pid", self.process.pid, "--name", "akap-editor"]
        command = ["xdotool", *map(str, find)]
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            assert self.process.poll() is None, f"the program has ended: {self.log()}"
            found = subprocess.run(command, env=self._environment, capture_output=True, text=True).stdout
            if found and getattr(self._connection.get_input_focus().focus, "id", None) == int(found):
                return int(found)
            time.sleep(PAUSE)
        raise AssertionError(f"no window with the keyboard focus within {DEADLINE:g} s; {self.log()}")

    @property
    def _origin(self) -> tuple[int, int]:
        """The window's top left corner on the X server's screen."""
        root = self._connection.screen().root
        place = root.translate_coords(self._window, 0, 0)
        return place.x, place.y

    def save(self, screen: Screen) -> Path:
        """Write a screenshot for whoever reads a failure; returns its path."""
        self._saved_screens += 1
        path = self._folder / f"screen-{self._saved_screens}.png"
        Image.fromarray(screen).save(path)
        return path

    def until(self, holds: Callable[[Screen], bool], what: str) -> Screen:
        """Wait until ``holds(screen)`` and the program sleeps; returns the screen.

        what: the condition in words.
        """
        before, activity = self.grab(), self._activity()
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            assert self.process.poll() is None, f"the program has ended: {self.log()}"
            time.sleep(PAUSE)
            screen, activity_before = self.grab(), activity
            activity = self._activity()
            sleeps = activity == activity_before and {state for state, _ in activity.values()} == {"S"}
            if sleeps and (screen == before).all() and holds(screen):
                return screen
            before = screen
        raise AssertionError(f"not within {DEADLINE:g} s: {what}; see {self.save(before)}; {self.log()}")

    def until_idle(self) -> Screen:
        """Wait until the program sleeps; returns the screen."""
        return self.until(lambda screen: True, "the program is idle")

    def log(self) -> str:
        """The program's error output."""
        self._log.seek(0)
        return self._log.read()

    # -- the process ---------------------------------------------------------------------------------------

    def _activity(self) -> dict[str, tuple[str, int]]:
        """State and number of context switches of each thread; it does not change while a thread sleeps.

        The threads are those of the program and of the mesher, its child, for which the program waits asleep.
        """
        activity, processes = {}, [str(self.process.pid)]
        for process in processes:
            with suppress(OSError):  # a process or thread that has ended meanwhile
                for thread in Path(f"/proc/{process}/task").iterdir():
                    lines = (thread / "status").read_text("utf-8").splitlines()
                    fields = dict(line.split(":\t", 1) for line in lines if ":\t" in line)
                    switches = fields["voluntary_ctxt_switches"], fields["nonvoluntary_ctxt_switches"]
                    if fields["State"][0] != "Z":
                        activity[thread.name] = fields["State"][0], sum(map(int, switches))
                    processes += (thread / "children").read_text("utf-8").split()
        return activity

    def cpu_seconds(self) -> float:
        """CPU time of the program so far."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def wait_for_sleeps(self, count: int) -> None:
        """Wait until the main thread has gone to sleep ``count`` times."""
        main, deadline = str(self.process.pid), time.monotonic() + DEADLINE
        start = self._activity()[main][1]
        while self._activity()[main][1] < start + count:
            assert time.monotonic() < deadline, f"the main thread has not slept {count} times"
            time.sleep(PAUSE)

    def exit_code(self) -> int:
        """Wait until the program has ended."""
        try:
            return self.process.wait(DEADLINE)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running; see {self.save(self.grab())}") from None

    # -- actions -------------------------------------------------------------------------------------------

    def xdotool(self, *arguments: object) -> None:
        """Move the mouse, press buttons or keys."""
        command = ["xdotool"]
        for word in map(str, arguments):
            command += [word, "--window", str(self._window)] if word == "mousemove" else [word]
        subprocess.run(command, env=self._environment, check=True)

    def press(self, chord: str) -> None:
        """Type e.g. "ctrl+s" as a hand does, the key inside the modifiers; xdotool's own chords overlap."""
        *modifiers, key = chord.split("+")
        down = [word for name in modifiers for word in ("keydown", name)]
        up = [word for name in reversed(modifiers) for word in ("keyup", name)]
        self.xdotool(*down, "key", key, *up)

    def key(self, chord: str, what: str) -> Screen:
        """Press a key that changes the canvas; returns the screen after it."""
        before = canvas(self.grab())
        self.press(chord)
        return self.until(lambda screen: (canvas(screen) != before).any(), what)

    def click(self, point: Point) -> Screen:
        """Click a point of the screen where this changes the canvas; returns the screen after it."""
        before = canvas(self.grab())
        self.xdotool("mousemove", *point, "click", 1, "mousemove", *CORNER)
        return self.until(lambda screen: (canvas(screen) != before).any(), f"a pin at {point}")

    def drag(self, start: Point, end: ArrayLike) -> Screen:
        """Drag from one point of the screen to another; returns the screen when the program is idle."""
        self.xdotool("mousemove", *start)
        self.xdotool("mousedown", 1)
        for x, y in np.linspace(start, end, 11)[1:]:
            self.xdotool("mousemove", round(x), round(y))
        self.xdotool("mouseup", 1, "mousemove", *CORNER)
        return self.until_idle()

    def type_file(self, path: Path) -> None:
        """Type a file's path into the file dialog, and accept it."""
        self.xdotool("type", "--delay", 10, path)
        self.press("Return")

    def save_as(self, path: Path, last: Screen | None = None) -> None:
        """Save through the dialog. last: a screen; its canvas must be shown again in the end."""
        self.key("ctrl+shift+s", "the file dialog is open")
        self.type_file(path)
        self.until(
            lambda screen: path.is_file() and (last is None or (canvas(screen) == canvas(last)).all()),
            "the file is saved",
        )

    def without_pins(self) -> Screen:
        """The screen with the pins hidden; they are shown again."""
        hidden = self.key("shift+p", "pins are hidden")
        self.key("shift+p", "pins are shown")
        return hidden

    def client(self) -> X11Client:
        """A connection for messages of other programs to the window."""
        return X11Client(self._display, self._window)

    def close_window(self) -> None:
        """Ask the window to close, as a window manager does."""
        with self.client() as client:
            client.close()


# -- what a screen shows ------------------------------------------------------------------------------------


def canvas(screen: Screen) -> Screen:
    """The canvas of a screen."""
    return screen[TOP:BOTTOM, LEFT:RIGHT]


def find_camera(screen: Screen, alpha: NDArray[np.uint8]) -> tuple[float, NDArray[np.float64]]:
    """Zoom and offset (2,) of the view, from the drawing's bounding boxes on the screen and in its picture.

    alpha: (h, w) of the picture.
    """
    part = canvas(screen).astype(int)
    shown = np.argwhere(abs(part - part[0, 0]).sum(axis=2) > 30)[:, ::-1] + (LEFT, TOP)
    drawn = np.argwhere(alpha > 127)[:, ::-1]
    low, high = shown.min(axis=0), shown.max(axis=0) + 1
    zooms = (high - low) / (drawn.max(axis=0) + 1 - drawn.min(axis=0))
    assert abs(zooms[0] - zooms[1]) < 0.02, "the drawing is stretched"
    zoom = zooms.mean()
    return zoom, (low + high) / 2 - zoom * (drawn.min(axis=0) + drawn.max(axis=0) + 1) / 2


def far_apart(alpha: NDArray[np.uint8], count: int) -> NDArray[np.float64]:
    """(count, 2) points (x, y) well inside the drawing of a picture, far from one another."""
    depth = distance_transform_edt(alpha > 127)
    inside = np.argwhere(depth > 0.4 * depth.max())[:, ::-1].astype(float)
    chosen = [inside[0]]
    while len(chosen) < count:
        distances = np.min([np.linalg.norm(inside - point, axis=1) for point in chosen], axis=0)
        chosen.append(inside[distances.argmax()])
    return np.array(chosen) + 0.5


def marker_center(shown: Screen, hidden: Screen, point: Point) -> NDArray[np.float64]:
    """(2,) the middle of the pixels near a point that change if the pins are hidden."""
    x, y = map(round, point)
    part = slice(y - MARKER, y + MARKER + 1), slice(x - MARKER, x + MARKER + 1)
    changed = np.argwhere((shown[part] != hidden[part]).any(axis=2))
    assert len(changed) > 100, f"no pin near {x}, {y}"
    return (changed.min(axis=0) + changed.max(axis=0) + 1)[::-1] / 2 + (x - MARKER, y - MARKER)


def assert_markers(program: RunningProgram, shown: Screen, hidden: Screen, points: Sequence[Point]) -> None:
    """Check that there are pins at these points of the screen. hidden: the screen without pins."""
    for point in points:
        try:
            center = marker_center(shown, hidden, point)
            assert np.linalg.norm(center - point) < 1.5, f"pin at {center}, expected at {point}"
        except AssertionError as error:
            raise AssertionError(f"{error}; see {program.save(shown)} and {program.save(hidden)}") from None


def changed_near(before: Screen, after: Screen, point: Point, radius: int = 20) -> float:
    """The share of the pixels around a point that have another color, 0 to 1."""
    x, y = map(round, point)
    part = slice(y - radius, y + radius + 1), slice(x - radius, x + radius + 1)
    return float((abs(before[part].astype(int) - after[part]).sum(axis=2) > 30).mean())
