"""The program on a real X server, with a real mouse and keyboard, judged by what is on the screen."""

import json
import os
import shutil
import signal
import tempfile
from pathlib import Path

import numpy as np
import pytest

import akap_editor
from akap_editor.app.theme import ACCENT
from akap_editor.editor.camera import ZOOM_STEP
from akap_editor.editor.tools.keyboard_pointer import BIG_STEP
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.cartoons import SHARED_DATA
from tests.support.native_dialog import StandInDialog
from tests.support.running_program import (
    BOTTOM,
    CORNER,
    DEADLINE,
    LEFT,
    RIGHT,
    TOP,
    RunningProgram,
    assert_markers,
    canvas,
    changed_near,
    far_apart,
    find_camera,
)
from tests.support.x_server import MANAGER_VARIABLE, x_server

pytestmark = pytest.mark.window

# Most window managers move a window with Alt and the mouse, and the program does not see these clicks.
needs_alt = pytest.mark.skipif(
    MANAGER_VARIABLE in os.environ, reason="Alt-click belongs to the window manager"
)


@pytest.fixture(scope="module")
def display():
    with x_server() as server:
        yield server.display


@pytest.fixture
def tmp_path():
    """A folder with a short path: the program draws two frames for each letter typed into its dialog.

    It stays if a failure has left a screenshot there.
    """
    folder = Path(tempfile.mkdtemp(prefix=""))
    yield folder
    if not any(folder.glob("screen-*.png")):
        shutil.rmtree(folder)


@pytest.fixture
def start(display, tmp_path):
    """Starts the program on a file."""
    programs = []

    def run(file, remembered=None):
        preferences = tmp_path / f"preferences-{len(programs)}"
        preferences.mkdir()
        (preferences / "preferences.json").write_text(json.dumps(remembered or {"first steps done": True}))
        programs.append(RunningProgram(display, file, tmp_path, preferences))
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


def test_bend_save_quit_and_open_again(start, picture, tmp_path):
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 3) * zoom + offset).astype(int)
    rest = program.grab()

    for pin in pins.tolist():
        shown = program.click(pin)
    hidden = program.without_pins()
    assert_markers(program, shown, hidden, pins)
    assert (canvas(hidden) == canvas(rest)).all(), f"pins alone move nothing; see {program.save(hidden)}"

    inwards = np.array([(LEFT + RIGHT) / 2, (TOP + BOTTOM) / 2]) - pins[2]
    end = np.rint(pins[2] + 150 * inwards / np.linalg.norm(inwards)).astype(int)
    shown = program.drag(pins[2], end)
    hidden = program.without_pins()
    assert_markers(program, shown, hidden, [pins[0], pins[1], end])
    for place in (pins[2], end):
        assert changed_near(rest, hidden, place) > 0.2, f"nothing bent; see {program.save(hidden)}"

    before = program.cpu_seconds()
    program.wait_for_sleeps(10)
    assert program.cpu_seconds() - before < 0.05, "ten frames cost more"

    program.key("f", "the pose is fitted into the window")
    last = program.key("ctrl+d", "no pin is selected")
    saved = tmp_path / "posed.akap"
    program.save_as(saved, last)
    program.press("ctrl+q")
    assert program.exit_code() == 0

    state = akap_editor.load(saved).state
    drawing = akap_editor.load(saved).drawing
    targets = ([*pins[:2], end] - offset) / zoom
    assert np.linalg.norm(state.targets - targets, axis=1).max() * zoom < 2.0
    arrived = drawing.mesh.evaluate(state.points, state.positions)
    assert np.linalg.norm(arrived - state.targets, axis=1).max() < 0.25
    assert akap_editor.distortion(drawing.mesh, state.positions).angle > 2.001

    again = start(saved)
    screen = again.key("shift+c", "the checkerboard is gone")
    assert (canvas(screen) == canvas(last)).all(), f"see {again.save(last)} and {again.save(screen)}"
    again.press("ctrl+q")
    assert again.exit_code() == 0
    remembered = json.loads((tmp_path / "preferences-1" / "preferences.json").read_text())
    assert remembered["recent"] == [str(saved)], "a file that the program is begun with is a recent one"


def test_a_tooltip_full_screen_and_the_question_of_a_closed_window(start, picture):
    """A mouse that rests on a tool sees what it is; closing asks for unsaved changes, and else ends."""
    program = start(picture)
    before = program.grab()
    for x in range(LEFT + 40, LEFT // 2, -2):
        program.xdotool("mousemove", x, 140)
    program.until(
        lambda screen: (canvas(screen)[:, :200] != canvas(before)[:, :200]).any(axis=2).sum() > 2000,
        "a tooltip",
    )
    program.xdotool("mousemove", *CORNER)
    program.until(lambda screen: (canvas(screen) == canvas(before)).all(), "the tooltip is gone")

    program.key("Tab", "the panels are hidden")
    program.press("Tab")
    program.until(lambda screen: (canvas(screen) == canvas(before)).all(), "they are back")
    program.press("F11")
    program.until_idle()
    program.press("F11")
    program.until(lambda screen: (canvas(screen) == canvas(before)).all(), "the window is as before")

    alpha = read_image(picture)[..., 3]
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    pinned = canvas(program.click(np.rint(far_apart(alpha, 1)[0] * zoom + offset).astype(int).tolist()))
    program.close_window()
    program.until(
        lambda screen: (canvas(screen) < pinned).any(axis=2).mean() > 0.9, "a question dims the canvas"
    )
    program.press("Escape")
    program.until(lambda screen: (canvas(screen) == pinned).all(), "the question is gone")
    program.key("ctrl+z", "the pin is taken back")
    program.close_window()
    assert program.exit_code() == 0


def pins_in_copies(state):
    """The number of pins in each recovery copy."""
    return [len(akap_editor.load(path).state.pins) for path in state.glob("autosave/*.akap")]


def assert_rescued(program, state, pin, end):
    """Unsaved work survives the end of the program, also right after its first pin, while it sleeps.

    state: the folder of recovery copies; pin: a point of the screen; end: ends the program.
    """
    program.click(pin)
    end()
    assert program.process.wait(DEADLINE) != 0
    assert pins_in_copies(state) == [1], program.log()
    assert "Traceback" not in program.log()


def test_unsaved_work_survives_the_loss_of_the_display(picture, monkeypatch, tmp_path):
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    with x_server() as server:
        preferences = tmp_path / "preferences"
        preferences.mkdir()
        (preferences / "preferences.json").write_text(json.dumps({"first steps done": True}))
        program = RunningProgram(server.display, picture, tmp_path, preferences)
        alpha = read_image(picture)[..., 3]
        zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
        (pin,) = np.rint(far_apart(alpha, 1) * zoom + offset).astype(int).tolist()
        assert_rescued(program, state, pin, server.process.kill)


def test_after_a_kill_in_a_drag_the_next_start_offers_the_drawing(start, picture, monkeypatch, tmp_path):
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 4) * zoom + offset).astype(int)
    for pin in pins.tolist():
        program.click(pin)
    program.until(lambda _: pins_in_copies(state) == [4], "the last pin is in a copy")
    program.xdotool("mousemove", *pins[0], "mousedown", 1)
    program.xdotool("mousemove", *(pins[0] + 25))
    program.process.kill()
    program.process.wait()
    program.xdotool("mouseup", 1)

    again = start(picture)
    offered = again.until_idle()
    again.press("Return")
    again.until(lambda screen: (canvas(screen) > canvas(offered)).any(axis=2).mean() > 0.2, "it is answered")
    saved = tmp_path / "recovered.akap"
    again.save_as(saved)
    again.press("ctrl+q")
    assert again.exit_code() == 0
    recovered = akap_editor.load(saved)
    assert len(recovered.state.pins) == 4
    assert np.linalg.norm(recovered.state.targets - (pins - offset) / zoom, axis=1).max() * zoom < 2.0
    assert not list(state.glob("autosave/*.akap")), "what was saved leaves no copy"


@needs_alt
def test_pins_by_keys_alt_and_the_right_button(start, picture, tmp_path):
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 2) * zoom + offset).astype(int).tolist()
    bare = canvas(program.grab())
    one = canvas(program.click(pins[0]))
    both = canvas(program.click(pins[1]))

    program.xdotool("mousemove", *pins[0], "mousedown", 3, "mousemove", *pins[1], "mouseup", 3)
    program.xdotool("mousemove", *CORNER)
    program.until(lambda screen: (canvas(screen) == both).all(), "a right-drag does nothing")

    program.xdotool("mousemove", *pins[0], "click", 3)
    program.until(lambda screen: (canvas(screen) != both).any(axis=2).sum() > 5000, "a menu is open")
    program.press("Escape")
    program.xdotool("mousemove", *CORNER)
    program.until(lambda screen: (canvas(screen) != both).any(axis=2).sum() < 5000, "the menu is closed")
    program.press("ctrl+z")  # the second pin; the right-click has selected the first one
    program.until(lambda screen: (canvas(screen) == one).all(), "one pin, selected, no menu")

    nudged = canvas(program.key("shift+Right", "the pin and the drawing are nudged"))
    assert changed_near(one, nudged, np.subtract(pins[0], (LEFT, TOP))) > 0
    program.press("ctrl+z")
    program.until(lambda screen: (canvas(screen) == one).all(), "the nudge is taken back")

    program.xdotool("mousemove", *pins[0], "keydown", "alt", "click", 1, "keyup", "alt", "mousemove", *CORNER)
    program.until(lambda screen: (canvas(screen) == bare).all(), "the pin is cut off")

    for pin in pins:
        program.click(pin)
    pinned = canvas(program.grab())
    x, y = pins[0]
    turns = np.radians(np.linspace(0, 60, 13))
    ring = [(round(x + 28 * np.cos(turn)), round(y + 28 * np.sin(turn))) for turn in turns]
    program.xdotool("mousemove", *ring[0], "keydown", "alt", "mousedown", 1)
    for point in ring[1:]:
        program.xdotool("mousemove", *point)
    program.xdotool("mouseup", 1, "keyup", "alt", "mousemove", *CORNER)
    program.until(lambda screen: (canvas(screen) != pinned).any(), "the drawing has rotated")
    saved = tmp_path / "rotated.akap"
    program.save_as(saved)
    program.press("ctrl+q")
    assert program.exit_code() == 0
    state = akap_editor.load(saved).state
    held, free = (pin.angle for pin in state.pins)
    assert np.degrees(held) == pytest.approx(60, abs=4), "the ring rotates the drawing"
    assert free is None
    assert np.linalg.norm(state.targets - (pins - offset) / zoom, axis=1).max() * zoom < 2.0, "pins stay"


def test_a_box_a_drag_of_all_pins_a_pan_and_a_zoom(start, picture):
    """All pins go the same way, so the drawing does, too; then the canvas, then the wheel at a point."""
    alpha = read_image(picture)[..., 3]
    program = start(picture)
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    pins = np.rint(far_apart(alpha, 3) * zoom + offset).astype(int)
    for pin in pins.tolist():
        program.click(pin)
    program.key("ctrl+d", "no pin is selected")
    program.drag(CORNER, (RIGHT - 12, BOTTOM - 12))
    program.drag(pins[1], pins[1] + (-22, 17))
    camera = find_camera(program.key("shift+p", "pins are hidden"), alpha)
    assert camera[0] == pytest.approx(zoom, rel=0.005)
    np.testing.assert_allclose(camera[1], np.add(offset, (-22, 17)), atol=2.0)

    program.xdotool("mousemove", *pins[0], "mousedown", 2)
    for way in ((9, 2), (18, -12)):
        program.xdotool("mousemove", *(pins[0] + way))
    program.xdotool("mouseup", 2)
    panned = find_camera(program.until_idle(), alpha)
    assert panned[0] == pytest.approx(camera[0], rel=0.005)
    np.testing.assert_allclose(panned[1], camera[1] + (18, -12), atol=1.5)

    before = program.grab()
    program.xdotool("mousemove", *pins[0], "click", 5)
    smaller = program.until(lambda screen: (canvas(screen) != canvas(before)).any(), "the drawing is smaller")
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
    bent = program.until_idle()
    assert (canvas(bent) != canvas(before)).any()
    program.key("shift+j", "the first pin is selected")
    program.key("F2", "its values are shown")
    program.key("Escape", "they are closed")
    program.key("ctrl+Right", "one looks to the right")
    saved = tmp_path / "keys.akap"
    last = program.grab()
    program.save_as(saved, last)
    program.press("ctrl+q")
    assert program.exit_code() == 0

    document = akap_editor.load(saved)
    first, second = document.state.targets
    assert second[0] == pytest.approx(first[0] - 10, abs=0.01)
    assert np.abs(first - np.array(document.drawing.size) / 2).max() < 60, "near the middle of the picture"
    width, height = document.drawing.size
    zoom = 3 * BIG_STEP / (first[1] - second[1])
    assert zoom == pytest.approx(min((RIGHT - LEFT) / width, (BOTTOM - TOP) / height), rel=0.2)


def test_a_file_dropped_on_the_window_is_opened_and_survives_sigterm(start, picture, monkeypatch, tmp_path):
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    other = tmp_path / "käse & co.png"
    shutil.copy(resource("assets", "drawings", "raptor.png"), other)
    program = start(picture)
    before = canvas(program.grab())
    with program.client() as client:
        client.drop(other, ((LEFT + RIGHT) // 2, (TOP + BOTTOM) // 2))
    shown = program.until(lambda screen: (canvas(screen) != before).any(axis=2).mean() > 0.05, "it is open")
    alpha = read_image(other)[..., 3]
    program.press("shift+c")
    plain = program.until(lambda screen: (canvas(screen) != canvas(shown)).any(), "the checkerboard is gone")
    zoom, offset = find_camera(plain, alpha)
    assert zoom > 0.1
    for place in far_apart(alpha, 4):
        x, y = np.rint(place * zoom + offset).astype(int)
        assert (plain[y, x] != plain[TOP, LEFT]).any(), "the raptor is where its picture says"
    assert_rescued(program, state, (x, y), lambda: program.process.send_signal(signal.SIGTERM))


def test_the_dialog_of_the_system_saves_cancels_and_opens_and_sighup_ends(
    start, picture, monkeypatch, tmp_path
):
    state = tmp_path / "state"
    monkeypatch.setenv("AKAP_EDITOR_STATE", str(state))
    folder = tmp_path / "bin"
    folder.mkdir()
    dialog = StandInDialog(folder, monkeypatch)
    program = start(picture)
    before = canvas(program.grab())

    def ask(chord):
        program.press(chord)
        program.until(lambda _: dialog.is_open, "the dialog is open")
        return dialog.arguments

    saved = tmp_path / "käse & co.akap"
    arguments = ask("ctrl+shift+s")
    assert "--save" in arguments
    assert f"--filename={picture.with_suffix('.akap')}" in arguments
    program.until(
        lambda screen: (canvas(screen) < before).any(axis=2).mean() > 0.8, "the canvas says that it waits"
    )
    dialog.answer(saved.with_suffix(""))
    program.until(lambda _: saved.is_file(), "the file is saved")

    kept = tmp_path / "kept.akap"
    kept.write_bytes(b"of somebody")
    ask("ctrl+shift+s")
    dialog.answer(kept.with_suffix(""))  # zenity has asked about this name, not about the one with an ending
    color = np.rint(255 * np.array(ACCENT[:3]))  # of the button that Enter presses; the note has none
    asked = program.until(
        lambda screen: (canvas(screen) == color).all(axis=2).sum() > 1000, "a question of the editor follows"
    )
    assert (canvas(asked) < before).any(axis=2).mean() > 0.9, "it dims the canvas"
    assert kept.read_bytes() == b"of somebody"
    program.press("Escape")
    program.until(lambda screen: (canvas(screen) == before).all(), "the question is gone")

    assert "--save" not in ask("ctrl+o")
    dialog.answer(None)
    program.until(lambda screen: (canvas(screen) == before).all(), "it is cancelled")
    ask("ctrl+o")
    dialog.answer(resource("assets", "drawings", "raptor.png"))

    def is_open(screen):
        is_bright = (canvas(screen)[0] == before[0]).all()  # no dialog dims the canvas
        return is_bright and (canvas(screen) != before).any(axis=2).mean() > 0.05

    program.until(is_open, "the raptor is open")
    alpha = read_image(resource("assets", "drawings", "raptor.png"))[..., 3]
    zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
    (pin,) = np.rint(far_apart(alpha, 1) * zoom + offset).astype(int).tolist()
    assert_rescued(program, state, pin, lambda: program.process.send_signal(signal.SIGHUP))
