"""The program on a real X server, with a real mouse and keyboard, judged by what is on the screen."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageGrab
from scipy.ndimage import distance_transform_edt

import akap_editor
from akap_editor.editor.camera import ZOOM_STEP
from akap_editor.editor.tools.keyboard_pointer import BIG_STEP
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.cartoons import SHARED_DATA
from tests.support.x11 import X11Client

pytestmark = pytest.mark.window

SIZE = (1280, 800)  # of the screen, and of the window by default
DEADLINE = 30.0  # seconds; a slow machine takes 3 to start the program
LEFT, TOP, RIGHT, BOTTOM = 48, 40, 1280 - 268, 760  # well within the canvas, without menu and status bar
CORNER = (LEFT + 12, TOP + 12)  # on the canvas, beside the drawing
MARKER = 14  # pixels around a pin's center in which its marker lies


@contextmanager
def x_server():
    """An X server of our own, never the user's screen: its process and its display."""
    for tool in ("Xvfb", "xdotool"):
        assert shutil.which(tool), f"{tool} is missing: install the packages xvfb and xdotool"
    read, write = os.pipe()
    screen = "{}x{}x24".format(*SIZE)
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", screen, "-nolisten", "tcp", "-noreset"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    yield server, f":{number}"
    server.terminate()
    server.wait(DEADLINE)


@pytest.fixture(scope="module")
def display():
    with x_server() as (_, name):
        yield name


@pytest.fixture
def start(display, tmp_path):
    """Starts the program on a file."""
    programs = []

    def run(file, remembered=None):
        preferences = tmp_path / f"preferences-{len(programs)}"
        preferences.mkdir()
        (preferences / "preferences.json").write_text(json.dumps(remembered or {"first steps done": True}))
        programs.append(Program(display, file, tmp_path, preferences))
        return programs[-1]

    yield run
    for program in programs:
        program.process.kill()
        program.process.wait()


@pytest.fixture
def picture():
    """The gecko of the real cartoons, or a bundled drawing if they are absent."""
    gecko = SHARED_DATA / "noto" / "gecko.png"
    return gecko if gecko.is_file() else resource("assets", "drawings", "gingerbread.png")


class Program:
    """The running program, its screen, and a hand at mouse and keyboard."""

    def __init__(self, display, file, folder, preferences):
        self._folder, self._shots = folder, 0
        away = {"WAYLAND_DISPLAY", "XDG_SESSION_TYPE"}
        self._environment = {name: value for name, value in os.environ.items() if name not in away}
        self._environment["DISPLAY"] = self._display = display
        self._environment["AKAP_EDITOR_CONFIG"] = str(preferences)
        command = [sys.executable, "-m", "akap_editor.cli", str(file)]
        self._log = (folder / f"{Path(file).stem}.log").open("w+")
        self.process = subprocess.Popen(command, env=self._environment, stderr=self._log)
        self.hand("mousemove", *CORNER)
        self.until(lambda shot: (np.ptp(canvas(shot), axis=2) > 60).mean() > 0.02, "a drawing is shown")

    def hand(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self._environment, check=True)

    def grab(self):
        """(h, w, 3) uint8 of the screen."""
        return np.asarray(ImageGrab.grab(xdisplay=self._display).convert("RGB"))

    def keep(self, shot):
        """Write a screenshot for whoever reads a failure; returns its path."""
        self._shots += 1
        path = self._folder / f"screen-{self._shots}.png"
        Image.fromarray(shot).save(path)
        return path

    def until(self, holds, what):
        """The screen once ``holds(screen)`` and nothing moves any more."""
        before, deadline = self.grab(), time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            assert self.process.poll() is None, f"the program has ended: {self.log()}"
            time.sleep(0.05)
            shot = self.grab()
            if holds(shot) and (shot == before).all():
                return shot
            before = shot
        raise AssertionError(f"not within {DEADLINE:g} s: {what}; see {self.keep(before)}; {self.log()}")

    def log(self):
        self._log.seek(0)
        return self._log.read()

    def press(self, chord):
        """Type e.g. "ctrl+s" as a hand does, the key inside the modifiers; xdotool's own chords overlap."""
        *modifiers, key = chord.split("+")
        down = [word for name in modifiers for word in ("keydown", name)]
        up = [word for name in reversed(modifiers) for word in ("keyup", name)]
        self.hand(*down, "key", key, *up)

    def key(self, chord, what):
        """Press a key; the canvas must change."""
        before = canvas(self.grab())
        self.press(chord)
        return self.until(lambda shot: (canvas(shot) != before).any(), what)

    def click(self, at):
        before = canvas(self.grab())
        self.hand("mousemove", *at, "click", 1, "mousemove", *CORNER)
        return self.until(lambda shot: (canvas(shot) != before).any(), f"a pin at {at}")

    def drag(self, start, end):
        self.hand("mousemove", *start)
        self.hand("mousedown", 1)
        for x, y in np.linspace(start, end, 11)[1:]:
            self.hand("mousemove", round(x), round(y))
            time.sleep(0.02)  # a hand takes its time, but no result depends on it
        self.hand("mouseup", 1, "mousemove", *CORNER)
        return self.until(lambda shot: True, "the drawing is at rest")

    def client(self):
        """Tells the window what other programs do."""
        search = ["xdotool", "search", "--name", "akap-editor"]
        found = subprocess.run(search, env=self._environment, check=True, capture_output=True, text=True)
        (window,) = map(int, found.stdout.split())
        return X11Client(self._display, window)

    def close_window(self):
        """Ask as a window manager does for whom the cross was clicked."""
        with self.client() as client:
            client.close()

    def save_as(self, path, last):
        """Save through the dialog; in the end the canvas is again what the screen ``last`` showed."""
        self.key("ctrl+shift+s", "the file dialog is open")
        self.hand("type", "--delay", 10, str(path))
        self.press("Return")
        self.until(lambda shot: path.is_file() and (canvas(shot) == canvas(last)).all(), "the file is saved")

    def without_pins(self):
        """The screen with pins hidden; they are shown again."""
        self.key("shift+p", "pins are hidden")
        hidden, before = self.grab(), None
        while before is None or (hidden != before).any():  # a picture may be taken while a frame is shown
            hidden, before = self.grab(), hidden
        self.key("shift+p", "pins are shown")
        return hidden

    def seconds_of_work(self):
        """CPU time so far."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def ended(self):
        try:
            return self.process.wait(DEADLINE)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"still running; see {self.keep(self.grab())}") from None


def canvas(shot):
    return shot[TOP:BOTTOM, LEFT:RIGHT]


def find_camera(shot, alpha):
    """(zoom, offset (2,)): from the bounding boxes of what is seen and of the picture's alpha."""
    part = canvas(shot).astype(int)
    seen = np.argwhere(abs(part - part[0, 0]).sum(axis=2) > 30)[:, ::-1] + (LEFT, TOP)
    drawn = np.argwhere(alpha > 127)[:, ::-1]
    low, high = seen.min(axis=0), seen.max(axis=0) + 1
    spans = (high - low) / (drawn.max(axis=0) + 1 - drawn.min(axis=0))
    assert abs(spans[0] - spans[1]) < 0.02, "the drawing is not stretched"
    zoom = spans.mean()
    return zoom, (low + high) / 2 - zoom * (drawn.min(axis=0) + drawn.max(axis=0) + 1) / 2


def far_apart(alpha, count):
    """(count, 2) places (x, y) well inside the drawing, far from one another."""
    depth = distance_transform_edt(alpha > 127)
    inside = np.argwhere(depth > 0.4 * depth.max())[:, ::-1].astype(float)
    chosen = [inside[0]]
    while len(chosen) < count:
        distances = np.min([np.linalg.norm(inside - place, axis=1) for place in chosen], axis=0)
        chosen.append(inside[distances.argmax()])
    return np.array(chosen) + 0.5


def marker_center(shown, hidden, near):
    """(2,): the middle of what hiding the pins changes around a point of the screen."""
    x, y = map(round, near)
    part = slice(y - MARKER, y + MARKER + 1), slice(x - MARKER, x + MARKER + 1)
    changed = np.argwhere((shown[part] != hidden[part]).any(axis=2))
    assert len(changed) > 100, f"a pin is expected near {x}, {y}"
    return (changed.min(axis=0) + changed.max(axis=0) + 1)[::-1] / 2 + (x - MARKER, y - MARKER)


def assert_markers(program, shown, hidden, places):
    for place in places:
        try:
            found = marker_center(shown, hidden, place)
            assert np.linalg.norm(found - place) < 1.5, f"pin at {found}, expected at {place}"
        except AssertionError as error:
            raise AssertionError(f"{error}; see {program.keep(shown)} and {program.keep(hidden)}") from None


def changed_near(before, after, place, radius=20):
    """How much of the surroundings of a point of the screen is another color, 0 to 1."""
    x, y = map(round, place)
    part = slice(y - radius, y + radius + 1), slice(x - radius, x + radius + 1)
    return (abs(before[part].astype(int) - after[part]).sum(axis=2) > 30).mean()


def test_bend_save_quit_and_open_again(start, picture, tmp_path):
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 3) * zoom + offset).astype(int)
    rest = program.grab()

    for pin in pins.tolist():
        shown = program.click(pin)
    hidden = program.without_pins()
    assert_markers(program, shown, hidden, pins)
    assert (canvas(hidden) == canvas(rest)).all(), f"pins alone move nothing; see {program.keep(hidden)}"

    inwards = np.array([(LEFT + RIGHT) / 2, (TOP + BOTTOM) / 2]) - pins[2]
    end = np.rint(pins[2] + 150 * inwards / np.linalg.norm(inwards)).astype(int)
    shown = program.drag(pins[2], end)
    hidden = program.without_pins()
    assert_markers(program, shown, hidden, [pins[0], pins[1], end])
    for place in (pins[2], end):
        assert changed_near(rest, hidden, place) > 0.2, f"nothing bent; see {program.keep(hidden)}"

    began, worked = time.monotonic(), program.seconds_of_work()
    time.sleep(2.0)
    share = (program.seconds_of_work() - worked) / (time.monotonic() - began)
    assert share < 0.05, f"busy for {100 * share:.0f} % of the time though nothing happens"

    program.key("f", "the pose is fitted into the window")
    last = program.key("ctrl+d", "no pin is selected")
    saved = tmp_path / "posed.akap"
    program.save_as(saved, last)
    program.press("ctrl+q")
    assert program.ended() == 0

    state = akap_editor.load(saved).state
    drawing = akap_editor.load(saved).drawing
    targets = ([*pins[:2], end] - offset) / zoom
    assert np.linalg.norm(state.targets - targets, axis=1).max() * zoom < 2.0
    arrived = drawing.mesh.evaluate(state.points, state.positions)
    assert np.linalg.norm(arrived - state.targets, axis=1).max() < 0.25
    assert akap_editor.distortion(drawing.mesh, state.positions).angle > 2.001

    again = start(saved)
    shot = again.key("b", "the checkerboard is gone")
    assert (canvas(shot) == canvas(last)).all(), f"see {again.keep(last)} and {again.keep(shot)}"
    again.press("ctrl+q")
    assert again.ended() == 0
    remembered = json.loads((tmp_path / "preferences-1" / "preferences.json").read_text())
    assert remembered["recent"] == [str(saved)], "a file that the program is begun with is a recent one"


def test_a_mouse_that_comes_to_rest_on_a_tool_sees_what_it_is(start, picture):
    program = start(picture)
    before = canvas(program.grab())[:, :200]
    for x in range(LEFT + 40, LEFT // 2, -2):
        program.hand("mousemove", x, 140)
    program.until(lambda shot: (canvas(shot)[:, :200] != before).any(axis=2).sum() > 2000, "a tooltip")


def test_closing_the_window_asks_for_unsaved_changes_and_else_ends(start, picture):
    program = start(picture)
    alpha = read_image(picture)[..., 3]
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pinned = canvas(program.click(np.rint(far_apart(alpha, 1)[0] * zoom + offset).astype(int).tolist()))
    program.close_window()
    program.until(lambda shot: (canvas(shot) < pinned).any(axis=2).mean() > 0.9, "a question dims the canvas")
    program.press("Escape")
    program.until(lambda shot: (canvas(shot) == pinned).all(), "the question is gone")
    program.key("ctrl+z", "the pin is taken back")
    program.close_window()
    assert program.ended() == 0


def pins_in_copies(state):
    """The number of pins in each recovery copy."""
    return [len(akap_editor.load(path).state.pins) for path in state.glob("autosave/*.akap")]


@pytest.mark.parametrize("end", ["SIGTERM", "SIGHUP", "the display is lost"])
def test_unsaved_work_survives_the_end_of_the_program(picture, monkeypatch, tmp_path, end):
    """Also if it comes right after the first pin, while the program sleeps."""
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    with x_server() as (server, display):
        preferences = tmp_path / "preferences"
        preferences.mkdir()
        (preferences / "preferences.json").write_text(json.dumps({"first steps done": True}))
        program = Program(display, picture, tmp_path, preferences)
        alpha = read_image(picture)[..., 3]
        zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
        (pin,) = np.rint(far_apart(alpha, 1) * zoom + offset).astype(int).tolist()
        program.click(pin)
        if end == "the display is lost":
            server.kill()
        else:
            program.process.send_signal(getattr(signal, end))
        assert program.process.wait(DEADLINE) != 0
    assert pins_in_copies(state) == [1], program.log()
    assert "Traceback" not in program.log()


def test_after_a_kill_in_a_drag_the_next_start_offers_the_drawing(start, picture, monkeypatch, tmp_path):
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 10) * zoom + offset).astype(int)
    for pin in pins.tolist():
        program.click(pin)
    program.until(lambda _: pins_in_copies(state) == [10], "the tenth pin is in a copy")
    program.hand("mousemove", *pins[0], "mousedown", 1)
    program.hand("mousemove", *(pins[0] + 25))
    program.process.kill()
    program.process.wait()
    program.hand("mouseup", 1)

    again = start(picture)
    offered = again.until(lambda _: True, "the question is there")
    again.press("Return")
    again.until(lambda shot: (canvas(shot) > canvas(offered)).any(axis=2).mean() > 0.2, "it is answered")
    saved = tmp_path / "recovered.akap"
    again.key("ctrl+shift+s", "the file dialog is open")
    again.hand("type", "--delay", 10, str(saved))
    again.press("Return")
    again.until(lambda _: saved.is_file(), "the file is saved")
    again.press("ctrl+q")
    assert again.ended() == 0
    recovered = akap_editor.load(saved)
    assert len(recovered.state.pins) == 10
    assert np.linalg.norm(recovered.state.targets - (pins - offset) / zoom, axis=1).max() * zoom < 2.0
    assert not list(state.glob("autosave/*.akap")), "what was saved leaves no copy"


def test_pins_by_keys_alt_and_the_right_button(start, picture):
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 2) * zoom + offset).astype(int).tolist()
    bare = canvas(program.grab())
    one = canvas(program.click(pins[0]))
    both = canvas(program.click(pins[1]))

    program.hand("mousemove", *pins[0], "mousedown", 3, "mousemove", *pins[1], "mouseup", 3)
    program.hand("mousemove", *CORNER)
    program.until(lambda shot: (canvas(shot) == both).all(), "a right-drag does nothing")

    program.hand("mousemove", *pins[0], "click", 3)
    program.until(lambda shot: (canvas(shot) != both).any(axis=2).sum() > 5000, "a menu is open")
    program.press("Escape")
    program.hand("mousemove", *CORNER)
    program.press("ctrl+z")  # the second pin; the right-click has selected the first one
    program.until(lambda shot: (canvas(shot) == one).all(), "one pin, selected, no menu")

    nudged = canvas(program.key("shift+Right", "the pin and the drawing are nudged"))
    assert changed_near(one, nudged, np.subtract(pins[0], (LEFT, TOP))) > 0
    program.press("ctrl+z")
    program.until(lambda shot: (canvas(shot) == one).all(), "the nudge is taken back")

    program.hand("mousemove", *pins[0], "keydown", "alt", "click", 1, "keyup", "alt", "mousemove", *CORNER)
    program.until(lambda shot: (canvas(shot) == bare).all(), "the pin is cut off")


def test_an_alt_drag_of_the_ring_turns_the_drawing_and_the_pin_stays(start, picture, tmp_path):
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 2) * zoom + offset).astype(int).tolist()
    for pin in pins:
        program.click(pin)
    pinned = canvas(program.grab())
    x, y = pins[0]
    turns = np.radians(np.linspace(0, 60, 13))
    ring = [(round(x + 28 * np.cos(turn)), round(y + 28 * np.sin(turn))) for turn in turns]
    program.hand("mousemove", *ring[0], "keydown", "alt", "mousedown", 1)
    for place in ring[1:]:
        program.hand("mousemove", *place)
        time.sleep(0.02)
    program.hand("mouseup", 1, "keyup", "alt", "mousemove", *CORNER)
    turned = program.until(lambda shot: (canvas(shot) != pinned).any(), "the drawing has turned")
    saved = tmp_path / "turned.akap"
    program.key("ctrl+shift+s", "the file dialog is open")
    program.hand("type", "--delay", 10, str(saved))
    program.press("Return")
    program.until(lambda _: saved.is_file(), f"the file is saved; see {program.keep(turned)}")
    program.press("ctrl+q")
    assert program.ended() == 0
    state = akap_editor.load(saved).state
    held, free = (pin.angle for pin in state.pins)
    assert np.degrees(held) == pytest.approx(60, abs=4)
    assert free is None
    assert np.linalg.norm(state.targets - (pins - offset) / zoom, axis=1).max() * zoom < 2.0


def test_a_box_a_drag_of_all_pins_a_pan_and_a_zoom(start, picture):
    """All pins go the same way, so the drawing does, too; then the canvas, then the wheel at a point."""
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("b", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 3) * zoom + offset).astype(int)
    for pin in pins.tolist():
        program.click(pin)
    program.key("ctrl+d", "no pin is selected")
    program.drag(CORNER, (RIGHT - 12, BOTTOM - 12))
    program.drag(pins[1], pins[1] + (-22, 17))
    camera = find_camera(program.key("shift+p", "pins are hidden"), alpha)
    assert camera[0] == pytest.approx(zoom, rel=0.005)
    np.testing.assert_allclose(camera[1], np.add(offset, (-22, 17)), atol=2.0)

    program.hand("mousemove", *pins[0], "mousedown", 2)
    for way in ((9, 2), (18, -12)):
        program.hand("mousemove", *(pins[0] + way))
    program.hand("mouseup", 2)
    panned = find_camera(program.until(lambda shot: True, "the canvas is at rest"), alpha)
    assert panned[0] == pytest.approx(camera[0], rel=0.005)
    np.testing.assert_allclose(panned[1], camera[1] + (18, -12), atol=1.5)

    before = program.grab()
    program.hand("mousemove", *pins[0], "click", 5)
    smaller = program.until(lambda shot: (canvas(shot) != canvas(before)).any(), "the drawing is smaller")
    zoomed = find_camera(smaller, alpha)
    assert zoomed[0] == pytest.approx(panned[0] / ZOOM_STEP, rel=0.005)
    np.testing.assert_allclose(zoomed[1], pins[0] + (panned[1] - pins[0]) / ZOOM_STEP, atol=2.0)


def test_pins_are_set_bent_and_saved_by_keys_alone(start, tmp_path):
    program = start(resource("assets", "drawings", "gingerbread.png"))
    program.key("c", "the crosshair is shown where the mouse is")
    ways = {"Right": (LEFT + RIGHT) / 2 - CORNER[0], "Down": (TOP + BOTTOM) / 2 - CORNER[1]}
    for name, way in ways.items():
        for _ in range(round(way / BIG_STEP)):
            program.press(f"shift+{name}")
    program.key("Return", "a pin is there")
    for _ in range(3):
        program.key("shift+Up", "the crosshair moves")
    program.key("space", "another pin is there")
    before = program.key("Escape", "the crosshair is gone")
    program.key("shift+Left", "the drawing bends")
    bent = program.until(lambda shot: True, "the drawing is at rest")
    assert (canvas(bent) != canvas(before)).any()
    program.key("shift+j", "the first pin is selected")
    program.key("Return", "its values are shown")
    program.key("Escape", "they are closed")
    program.key("ctrl+Right", "one looks to the right")
    saved = tmp_path / "keys.akap"
    last = program.grab()
    program.save_as(saved, last)
    program.press("ctrl+q")
    assert program.ended() == 0

    document = akap_editor.load(saved)
    first, second = document.state.targets
    assert second[0] == pytest.approx(first[0] - 10, abs=0.01)
    assert np.abs(first - np.array(document.drawing.size) / 2).max() < 60, "near the middle of the picture"
    width, height = document.drawing.size
    zoom = 3 * BIG_STEP / (first[1] - second[1])
    assert zoom == pytest.approx(min((RIGHT - LEFT) / width, (BOTTOM - TOP) / height), rel=0.2)


def test_a_file_dropped_on_the_window_is_opened(start, picture, tmp_path):
    other = tmp_path / "käse & co.png"
    shutil.copy(resource("assets", "drawings", "raptor.png"), other)
    program = start(picture)
    before = canvas(program.grab())
    with program.client() as client:
        client.drop(other, ((LEFT + RIGHT) // 2, (TOP + BOTTOM) // 2))
    shown = program.until(lambda shot: (canvas(shot) != before).any(axis=2).mean() > 0.05, "it is open")
    alpha = read_image(other)[..., 3]
    program.press("b")
    plain = program.until(lambda shot: (canvas(shot) != canvas(shown)).any(), "the checkerboard is gone")
    zoom, offset = find_camera(plain, alpha)
    assert zoom > 0.1
    for place in far_apart(alpha, 4):
        x, y = np.rint(place * zoom + offset).astype(int)
        assert (plain[y, x] != plain[TOP, LEFT]).any(), "the raptor is where its picture says"
