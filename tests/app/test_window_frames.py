"""From hand to picture: what one frame takes in is on the screen at its end."""

from imgui_bundle import imgui  # isort: skip
import time
from pathlib import Path
from threading import Event
from types import SimpleNamespace

import glfw
import numpy as np
import pytest

from akap_editor.app.commands.registry import SHORTCUTS
from akap_editor.app.commands.shortcuts_page import ShortcutsPage
from akap_editor.app.window import SETTLE_FRAMES
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor.editor import FRAME_BUDGET
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.stepper import INLINE
from tests.support.window_driver import DEADLINE
from tests.support.window_loop import WindowLoop


def one_frame(ui):
    """(h, w, 3): the picture of exactly one frame."""
    snapshots, frames = [], ui.window.frames
    ui.window.after_draw.append(lambda: snapshots.append(ui.window.screenshot()))
    ui.frame()
    ui.window.after_draw.clear()
    assert ui.window.frames == frames + 1
    return snapshots[0]


def canvas(ui, shot):
    left, top, right, bottom = map(round, ui.editor.canvas)
    return shot[top:bottom, left:right]


class Frames:
    """What each frame of a drag of pin 3 saw and showed: the pointer, the picture, the steps made so far."""

    def __init__(self, ui, way, steps=()):
        self.ui, self.steps, self.seen = ui, steps, []
        x, y = self.start = ui.to_screen(ui.pin_position(3))
        self.end = x, y + way
        ui.window.after_draw.append(self._look)
        ui.do(self._drag)
        ui.window.after_draw.clear()
        self.first = next(i for i, (pointer, *_) in enumerate(self.seen) if pointer == self.end)

    def _look(self):
        at = imgui.get_io().mouse_pos
        self.seen.append(
            ((at.x, at.y), self.ui.window.screenshot(), len(self.steps), self.ui.pin_position(3))
        )

    def _drag(self, hand):
        x, y = self.start
        self.ui.begin_drag(hand, self.start)
        hand.mouse_teleport_to_pos(imgui.ImVec2(x, y - 20))
        while self.ui.editor.is_moving:
            hand.yield_()
        hand.yield_(3)
        hand.mouse_teleport_to_pos(imgui.ImVec2(*self.end))
        hand.yield_(3)
        hand.mouse_up(0)


def test_a_moved_pin_is_seen_moved_in_the_very_frame_that_sees_the_pointer_move(pinned):
    pinned.editor.worker = INLINE  # however slow the machine is at the moment
    frames = Frames(pinned, -32)
    before, earlier, now = (frames.seen[frames.first + i] for i in (-2, -1, 0))
    np.testing.assert_array_equal(before[1], earlier[1])
    zoom = pinned.editor.camera.zoom
    assert np.linalg.norm(now[3] - earlier[3]) * zoom > 6, "most of the way already"
    x, y = map(round, frames.end)
    around = slice(y - 30, y + 30), slice(x - 30, x + 30)
    assert (now[1][around] != earlier[1][around]).any(axis=2).mean() > 0.05


def test_a_frame_stops_stepping_when_its_time_is_over(pinned, monkeypatch):
    """However many steps there are to go, the next frame comes when its time is over."""
    pinned.editor.worker = INLINE
    steps, now, step = [], [0.0], pinned.session.step

    def slow():
        steps.append(now[0])
        now[0] += 0.6 * FRAME_BUDGET
        return step()

    clock = SimpleNamespace(perf_counter=lambda: now[0], monotonic=time.monotonic)
    monkeypatch.setattr(pinned.session, "step", slow)
    monkeypatch.setattr("akap_editor.editor.editor.time", clock)
    frames = Frames(pinned, -300, steps)
    counts = [count for _, _, count, _ in frames.seen[frames.first - 1 :]]
    assert counts[1] - counts[0] in (1, 2)
    assert max(np.diff(counts)) == 2


@pytest.fixture
def loop(pinned, monkeypatch):
    return WindowLoop(pinned, monkeypatch)


def is_computing_a_step(ui):
    return ui.session.has_pending_step and not ui.session.step_is_ready()


@pytest.fixture
def held(pinned, monkeypatch):
    """A drag whose first step is computed until ``open`` is set."""
    gate, step = Event(), AkapDeformer.step

    def wait(*arguments):
        assert gate.wait(DEADLINE)
        return step(*arguments)

    monkeypatch.setattr(AkapDeformer, "step", wait)
    x, y = pinned.pin_position(3)
    pinned.session.begin("Drag Pin")
    pinned.session.apply(SetTargets({3: (x, y - 40)}))
    pinned.session.commit()
    yield SimpleNamespace(ui=pinned, open=gate, goal=(x, y - 40), pose=pinned.session.state.positions)
    gate.set()
    pinned.settle()


def test_menus_view_and_drags_answer_while_a_step_is_computed(held):
    ui, zoom = held.ui, held.ui.editor.camera.zoom

    def act(hand):
        hand.set_ref("##MainMenuBar")
        hand.menu_click("View")
        assert imgui.is_popup_open("", imgui.PopupFlags_.any_popup)
        hand.key_press(imgui.Key.escape)
        hand.mouse_move_to_pos(imgui.ImVec2(*ui.empty_point))
        hand.mouse_wheel_y(2.0)
        hand.yield_(2)
        assert ui.editor.camera.zoom > zoom
        assert is_computing_a_step(ui)
        assert ui.session.state.positions is held.pose

    ui.do(act, settle=False)
    held.open.set()
    ui.settle()
    np.testing.assert_allclose(ui.pin_position(3), held.goal, atol=0.25)


def test_nothing_is_drawn_until_the_step_is_there_or_the_hand_moves(held, loop):
    loop.waits_for_threads = False
    first, *later = [frames for _, frames in loop.run(6)]
    assert later == [first] * 5
    assert is_computing_a_step(held.ui)

    loop.on_sleep = lambda count: count == 1 and imgui.get_io().add_mouse_pos_event(300.0, 300.0)
    first, *later = [frames for _, frames in loop.run(4)]
    assert first == SETTLE_FRAMES
    assert later == [2 * SETTLE_FRAMES] * 3
    assert is_computing_a_step(held.ui)

    loop.waits_for_threads, loop.on_sleep = True, lambda count: False
    held.open.set()
    loop.run(1)
    assert not held.ui.state.is_busy
    np.testing.assert_allclose(held.ui.pin_position(3), held.goal, atol=0.25)


@pytest.mark.parametrize("before", range(SETTLE_FRAMES))
def test_a_question_about_dropped_files_is_seen_whenever_they_come(pinned, loop, before):
    """Also when they come with the last frame that is due, before the loop sleeps."""
    pinned.session.mark_unsaved()
    pinned.settle()
    window, first = pinned.window, pinned.window.frames
    loop.on_poll = lambda _: window.frames == first + before and window.drop([Path("other.png")])
    ((_, frames),) = loop.run(1)
    assert frames >= before + SETTLE_FRAMES
    (dialog,) = imgui.get_current_context().open_popup_stack
    assert dialog.window.active
    assert dialog.window.hidden_frames_can_skip_items == 0


@pytest.mark.parametrize("press", ["wheel", "key"])
def test_view_changes_are_seen_in_the_very_next_frame(ui, press):
    io = imgui.get_io()
    io.add_mouse_pos_event(*ui.empty_point)
    ui.settle()
    before = one_frame(ui)
    if press == "wheel":
        io.add_mouse_wheel_event(0.0, 1.0)
    else:
        io.add_key_event(imgui.Key.equal, True)
    after = one_frame(ui)
    io.add_key_event(imgui.Key.equal, False)
    assert (canvas(ui, after) != canvas(ui, before)).any(axis=2).mean() > 0.01


def test_a_key_that_closes_a_page_does_nothing_else(pinned):
    pinned.editor.select({2})
    SHORTCUTS.run(pinned.state)
    pinned.settle()
    pinned.key(SHORTCUTS.chords[0])
    assert not pinned.state.part(ShortcutsPage).is_open


@pytest.mark.parametrize("changed", [False, True])
def test_the_title_tells_what_is_open_and_whether_it_is_saved(pinned, changed):
    if changed:
        start = pinned.to_screen(pinned.pin_position(3))
        pinned.drag(start, (start[0], start[1] - 60))
    pinned.settle()
    assert glfw.get_window_title(pinned.window.handle) == f"figure{' *' if changed else ''} - akap-editor"
