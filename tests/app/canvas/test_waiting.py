"""The canvas takes no input while something else is going on, and says so."""

from threading import Event
from types import SimpleNamespace

import numpy as np
import pytest
from imgui_bundle import imgui

from akap_editor.app import files
from akap_editor.app.commands.command import CTRL, SHIFT
from akap_editor.app.dialogs import file_dialog
from akap_editor.app.dialogs.file_dialog import FileDialog
from akap_editor.app.jobs import task as task_module
from akap_editor.editor.document.drawing import Meshing
from akap_editor.io.open_document import open_document
from akap_editor.resources import resource
from tests.support.executors import HeldExecutor

DEADLINE = 60.0  # seconds
OTHER = resource("assets", "drawings", "bar.png")


@pytest.fixture
def held_opening(monkeypatch):
    """Lets files open only after `set`."""
    may_open = Event()

    def open_later(path, **options):
        assert may_open.wait(DEADLINE)
        return open_document(path, **options)

    monkeypatch.setattr(files, "open_document", open_later)
    yield may_open
    may_open.set()


def click(ui, point):
    """Click a point of the screen; the window stays busy."""

    def act(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*point))
        hand.mouse_click(0)

    ui.do(act, settle=False)


def drag(ui, point):
    def act(hand):
        ui.begin_drag(hand, point)
        hand.mouse_move_to_pos(imgui.ImVec2(point[0] + 30, point[1] + 40))
        hand.mouse_up(0)

    ui.do(act, settle=False)


def press(chord):
    return lambda ui, point: ui.do(lambda hand: hand.key_press(int(chord)), settle=False)


HANDS = {
    "click": click,
    "drag": drag,
    "remove": press(imgui.Key.delete),
    "remove the last": press(imgui.Key.backspace),
    "nudge": press(imgui.Key.right_arrow),
    "reset": press(CTRL | SHIFT | imgui.Key.r),
    "close": press(CTRL | imgui.Key.w),
    "drop": lambda ui, point: ui.window.drop([OTHER]),
}


@pytest.mark.parametrize("late", [False, True], ids=["before its dialog", "under its dialog"])
@pytest.mark.parametrize("hand", HANDS)
def test_nothing_reaches_a_drawing_while_another_one_is_opened(
    ui, pinned, held_opening, monkeypatch, hand, late
):
    monkeypatch.setattr(task_module, "LATE_SECONDS", 0.0 if late else 1e6)
    session, before = ui.session, ui.session.state
    ui.editor.select({3})
    point = ui.to_screen(ui.pin_position(3))
    files.open_path(ui.state, OTHER)
    ui.frame()
    HANDS[hand](ui, point)
    for _ in range(3):
        ui.frame()
    assert ui.session is session
    assert ui.session.state is before
    assert not ui.editor.is_busy
    held_opening.set()
    ui.settle()
    assert ui.document.drawing.name == "bar"
    assert ui.pins == ()


def test_opening_is_cancelled_and_the_drawing_stays(ui, held_opening, monkeypatch):
    monkeypatch.setattr(task_module, "LATE_SECONDS", 0.0)
    session = ui.session
    files.open_path(ui.state, OTHER)
    for _ in range(3):
        ui.frame()
    ui.dialog("Opening bar.png", "Cancel")
    held_opening.set()
    ui.settle()
    assert ui.session is session
    assert ui.state.notice == "Opening bar.png: cancelled"
    ui.click(ui.to_screen((130.0, 80.0)))
    assert len(ui.pins) == 1, "the canvas is free again"


def test_short_work_shows_no_dialog(ui, held_opening, monkeypatch):
    monkeypatch.setattr(task_module, "LATE_SECONDS", 1e6)
    before = ui.screenshot()
    files.open_path(ui.state, OTHER)
    for _ in range(10):
        ui.frame()
    shots = []
    ui.window.after_draw.append(lambda: shots.append(ui.window.screenshot()))
    ui.frame()
    ui.window.after_draw.clear()
    left, top, right, bottom = map(int, ui.editor.canvas)
    canvas = slice(top, bottom), slice(left, right)
    assert (shots[0][canvas] == before[canvas]).all()
    assert (shots[0] != before).any(), "the status bar names the file"


class FakeNativeDialog:
    """The system's dialog: not there yet, until it is answered."""

    def __init__(self):
        self.answer, self.was_killed = None, False

    def ready(self, _):
        return self.answer is not None

    def result(self):
        return self.answer

    def kill(self):
        self.was_killed = True


@pytest.fixture
def native(ui, monkeypatch):
    dialog = FakeNativeDialog()
    monkeypatch.setattr(
        file_dialog, "native", SimpleNamespace(open_file=lambda *_: dialog, save_file=lambda *_: dialog)
    )
    ui.state.part(FileDialog).uses_native = True
    return dialog


@pytest.mark.parametrize("hand", ["click", "drag", "remove", "nudge"])
def test_nothing_reaches_the_canvas_while_the_dialog_of_the_system_comes_up(ui, native, hand):
    files.choose_and_open(ui.state)
    before = ui.session.state
    HANDS[hand](ui, ui.to_screen((130.0, 80.0)))
    assert ui.session.state is before
    native.answer = [str(OTHER)]
    ui.settle()
    assert ui.document.drawing.name == "bar"
    assert ui.pins == ()


def test_a_dialog_of_the_system_that_never_appears_can_be_given_up(ui, native):
    files.choose_and_open(ui.state)
    ui.dialog("Open picture or drawing", "Cancel")
    assert native.was_killed
    assert not ui.state.part(FileDialog).is_open
    ui.click(ui.to_screen((130.0, 80.0)))
    assert len(ui.pins) == 1


@pytest.fixture
def held_mesh(pinned, monkeypatch):
    worker = HeldExecutor()
    monkeypatch.setattr(pinned.state.remesher, "_worker", worker)
    return worker


@pytest.mark.parametrize("hand", ["click", "drag"])
def test_nothing_reaches_the_canvas_while_a_mesh_is_made(pinned, held_mesh, hand):
    ui = pinned
    before = ui.session.state
    ui.state.remesher.request(Meshing(400))
    ui.frame()
    HANDS[hand](ui, ui.to_screen(ui.pin_position(3)))
    assert ui.session.state is before
    held_mesh.work()
    ui.settle()
    assert ui.document.drawing.meshing.vertices == 400
    np.testing.assert_allclose(ui.session.pin_positions(), before.targets, atol=0.5)


def test_making_a_mesh_is_cancelled_in_its_dialog_and_the_old_one_stays(pinned, held_mesh, monkeypatch):
    monkeypatch.setattr(task_module, "LATE_SECONDS", 0.0)
    ui, before = pinned, pinned.document
    ui.state.remesher.request(Meshing(400))
    for _ in range(4):
        ui.frame()
    ui.dialog("Making the mesh", "Cancel")
    assert not ui.state.remesher.is_busy
    held_mesh.work()
    ui.settle()
    assert ui.document.drawing is before.drawing
    assert ui.document.state is before.state


def test_a_drag_before_the_engine_is_prepared_says_so_and_follows_later(pinned, monkeypatch):
    """Only the first start after installation has to wait."""
    ui = pinned
    engine = SimpleNamespace(can_step=False, close=lambda: None)
    monkeypatch.setattr(ui.state, "engine", engine)
    before, pictures = ui.session.state.positions, [ui.screenshot()]
    drag(ui, ui.to_screen(ui.pin_position(3)))
    ui.window.after_draw.append(lambda: pictures.append(ui.window.screenshot()))
    ui.frame()
    ui.window.after_draw.clear()
    assert ui.editor.is_moving
    assert ui.session.state.positions is before
    left, top, right, _ = map(int, ui.editor.canvas)
    plate = slice(top, top + 60), slice((left + right) // 2 - 40, (left + right) // 2 + 40)
    assert (pictures[0][plate] != pictures[1][plate]).any()
    engine.can_step = True
    ui.settle()
    assert ui.session.state.positions is not before
    assert not ui.editor.is_moving
