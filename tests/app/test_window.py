"""The loop: when it draws and when it sleeps; sizes, scales, and windows that cannot be."""

from imgui_bundle import imgui  # isort: skip
import threading
from pathlib import Path

import glfw
import numpy as np
import pytest

from akap_editor.app import files, widgets
from akap_editor.app.canvas.scene import Scene
from akap_editor.app.commands.registry import COMMANDS, SHORTCUTS
from akap_editor.app.dialogs.about import AboutDialog
from akap_editor.app.frame import frame
from akap_editor.app.jobs.task import Progress, Task
from akap_editor.app.window import IDLE_SECONDS, SETTLE_FRAMES
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor.session.edits import SetTargets
from akap_editor.errors import SolverError
from tests.support.window_loop import WindowLoop


@pytest.fixture
def loop(pinned, monkeypatch):
    return WindowLoop(pinned, monkeypatch)


def test_a_window_with_nothing_to_do_sleeps(loop):
    assert loop.run() == [(IDLE_SECONDS, SETTLE_FRAMES)] * 3
    assert not loop.ui.window.needs_frame
    assert not loop.ui.state.is_busy


def bend(ui):
    start = ui.to_screen(ui.pin_position(3))
    ui.drag(start, (start[0] - 30, start[1] - 90))


def overlays(ui):
    bend(ui)
    view = ui.state.view
    view.show_vector_fields = view.show_rest_pose = view.show_pin_trails = ui.state.view.show_mesh = True
    view.distortion_measure = "area"
    view.set_reference(np.full((30, 30, 4), 200, dtype=np.uint8))


def session_timeline(ui):
    ui.state.timeline.session_playback.follow(ui.session)
    bend(ui)
    ui.state.timeline.is_shown = True


def keyframe_timeline(ui):
    ui.state.timeline.show_keyframes()
    ui.state.timeline.keyframe_playback.set_keyframe(0.0)
    bend(ui)
    ui.state.timeline.keyframe_playback.set_keyframe(1.0)
    ui.state.timeline.keyframe_playback.onion_skin.is_shown = True


def unsaved_question(ui):
    bend(ui)
    files.quit_program(ui.state)


IDLE = {
    "start page": lambda ui: ui.editor.close(),
    "pose": bend,
    "overlays": overlays,
    "two methods": lambda ui: setattr(ui.state.view, "is_split", True),
    "session timeline": session_timeline,
    "keyframe timeline": keyframe_timeline,
    "message": lambda ui: setattr(ui.state, "error", "The file is damaged."),
    "question": unsaved_question,
    "about": lambda ui: ui.state.part(AboutDialog).open(),
    "shortcuts": lambda ui: SHORTCUTS.run(ui.state),
    "export": lambda ui: ui.menu("File", "Export..."),
}


@pytest.mark.parametrize("shown", IDLE)
def test_a_window_that_is_at_rest_draws_nothing(loop, shown):
    IDLE[shown](loop.ui)
    loop.run(1)
    assert loop.run(4) == [(IDLE_SECONDS, SETTLE_FRAMES)] * 4


def test_a_step_that_fails_in_its_thread_is_reported_and_the_window_sleeps_again(loop, monkeypatch):
    ui = loop.ui
    start = ui.to_screen(ui.pin_position(3))
    targets, pose = ui.session.state.targets, ui.session.state.positions
    threads, step = [], AkapDeformer.step

    def fail(*arguments):
        thread = threading.current_thread()
        if not thread.name.startswith("engine"):  # the window compiles the engine in a thread of its own
            return step(*arguments)
        threads.append(thread)
        raise SolverError("the linear system is singular")

    with monkeypatch.context() as patch:
        patch.setattr(AkapDeformer, "step", fail)
        io = imgui.get_io()
        io.add_mouse_pos_event(*start)
        io.add_mouse_button_event(0, True)
        io.add_mouse_pos_event(start[0], start[1] - 60)
        loop.run(3)
    assert threads
    assert ui.state.error == "the linear system is singular"
    assert not ui.editor.is_busy
    assert not ui.editor.is_moving
    np.testing.assert_array_equal(ui.session.state.targets, targets)
    assert ui.session.state.positions is pose
    assert loop.run(4) == [(IDLE_SECONDS, SETTLE_FRAMES)] * 4, (
        "the message is shown, and nothing else happens"
    )

    io.add_mouse_button_event(0, False)
    ui.dialog("Error", "OK")
    bend(ui)
    assert ui.session.is_posed
    assert not ui.state.error


def test_after_an_event_it_draws_until_the_layout_is_final(loop):
    loop.on_sleep = lambda count: count == 2
    frames = [frames for _, frames in loop.run(4)]
    assert frames == [SETTLE_FRAMES, SETTLE_FRAMES, 2 * SETTLE_FRAMES, 2 * SETTLE_FRAMES]


def test_a_caret_blinks(loop):
    files.choose_and_open(loop.ui.state)
    waits = loop.run(4)
    assert {seconds for seconds, _ in waits} == {0.4}
    assert np.diff([frames for _, frames in waits]).tolist() == [1, 1, 1]


def test_it_wakes_for_a_tooltip(loop):
    """A mouse that rests sends nothing, so no event comes when the tooltip is due."""
    tools = imgui.internal.find_window_by_name("Tools")
    glfw.set_cursor_pos(loop.ui.window.handle, tools.pos.x + tools.size.x / 2, tools.pos.y + 20)
    waits = loop.run(2)
    assert imgui.get_current_context().hover_item_delay_id != 0
    assert all(0 < seconds <= imgui.get_style().hover_delay_normal + 0.02 for seconds, _ in waits)
    assert waits[1][1] == waits[0][1] + SETTLE_FRAMES
    glfw.set_cursor_pos(loop.ui.window.handle, *loop.ui.empty_point)
    loop.ui.settle()
    assert widgets.tooltip_due() == 0.0


def test_a_key_pressed_and_released_in_the_last_frame_is_handled(loop):
    """ImGui takes one change of a key per frame, so a quick press and release needs two."""
    io = imgui.get_io()

    def press(count):
        if count == SETTLE_FRAMES:
            io.add_key_event(imgui.Key.b, True)
            io.add_key_event(imgui.Key.b, False)

    loop.on_poll = press
    loop.run()
    assert loop.ui.editor.chosen_tool is loop.ui.editor.brush_tool
    assert not imgui.is_key_down(imgui.Key.b)


def test_it_does_not_sleep_until_a_dialog_has_dimmed_the_rest(loop):
    loop.ui.state.part(AboutDialog).open()
    loop.run(1)
    assert imgui.get_current_context().dim_bg_ratio == 1.0


def test_it_draws_until_the_drawing_has_settled_and_shows_the_last_pose(loop):
    """The last frame before the sleep shows, in the panel's numbers too, what any later frame would."""
    ui, snapshots = loop.ui, []
    x, y = ui.pin_position(3)
    ui.session.begin("Drag Pin")
    ui.session.apply(SetTargets({3: (x, y - 40)}))
    ui.session.commit()
    ui.window.after_draw.append(lambda: snapshots.append(ui.window.screenshot()))
    waits = loop.run(1)
    ui.window.after_draw.clear()
    assert waits[0][1] > SETTLE_FRAMES
    assert not ui.session.is_moving
    assert ui.session.pin_error() < 0.25
    np.testing.assert_array_equal(snapshots[-1], ui.screenshot())


def test_a_minimized_window_is_not_drawn(loop, monkeypatch):
    monkeypatch.setattr(glfw, "get_framebuffer_size", lambda handle: (0, 0))
    seconds = {seconds for seconds, _ in loop.run()}
    assert loop.sleeps[-1][1] == 0
    assert seconds <= {0.25, IDLE_SECONDS}


def test_the_fitted_drawing_follows_the_size_of_the_window(ui):
    handle = ui.window.handle
    before = ui.editor.camera
    try:
        glfw.set_window_size(handle, 900, 700)
        ui.settle()
        left, _, right, _ = ui.editor.canvas
        assert (left, right) == (48.0, 900.0 - 288.0)
        assert ui.editor.camera.zoom < before.zoom
        ui.editor.camera = moved = ui.editor.camera.panned(5, 5)
        glfw.set_window_size(handle, 1280, 800)
        ui.settle()
        assert ui.editor.camera == moved, "the user's own view is kept"
    finally:
        glfw.set_window_size(handle, 1280, 800)
        ui.settle()
    assert ui.screenshot().shape == (800, 1280, 3)


def test_without_a_document_the_window_shows_how_to_begin(ui):
    ui.editor.session = None
    ui.settle()
    assert ui.state.title == "akap-editor"
    assert "Open" in ui.editor.hint
    for label in ("Save", "Export...", "Fit in Window"):
        command = next(c for c in COMMANDS if c.label == label)
        assert not command.enabled(ui.state)
    ui.click(ui.empty_point)
    ui.wheel(ui.empty_point, 1.0)
    assert not ui.state.error


# -- exceptions ----------------------------------------------------------------------------------------------


def fail_once(patch, owner, name):
    """Let a method raise a bug's exception at its next call; later calls work."""
    original, calls = getattr(owner, name), []

    def method(*arguments, **options):
        calls.append(name)
        if len(calls) == 1:
            raise ValueError("a bug")
        return original(*arguments, **options)

    patch.setattr(owner, name, method)


class BrokenAutosave:
    def watch(self, *_):
        raise ValueError("a bug")


def broken_task():
    yield Progress(0.5, "Working")
    raise ValueError("a bug")


def deferred_job(ui, patch):
    ui.state.run_after_frame(lambda: [][0])


def task(ui, patch):
    ui.state.task = Task("Work", broken_task())


def autosave(ui, patch):
    patch.setattr(ui.state, "autosave", BrokenAutosave())


def remeshing(ui, patch):
    fail_once(patch, ui.state.remesher, "advance")


def background_export(ui, patch):
    fail_once(patch, ui.state.pose_exports, "advance")


def dropped_file(ui, patch):
    fail_once(patch, files, "open_path")
    ui.window.drop([Path("drawing.akap")])


def panel(ui, patch):
    fail_once(patch, frame, "draw")


def dialog(ui, patch):
    ui.state.part(AboutDialog).open()
    patch.setattr(AboutDialog, "draw", lambda *_: [][0])


def scene(ui, patch):
    fail_once(patch, Scene, "draw")


def preferences(ui, patch):
    fail_once(patch, ui.state, "save_preferences")


FAILURES = [
    *(deferred_job, task, autosave, remeshing, background_export),
    *(dropped_file, panel, dialog, scene, preferences),
]


@pytest.mark.parametrize("fail", FAILURES)
def test_an_exception_becomes_a_message_and_the_drawing_stays(pinned, monkeypatch, capfd, fail):
    ui, state = pinned, pinned.session.state
    monkeypatch.setattr(ui.window, "wait_for_events", lambda _: None)  # the loop of the test never sleeps
    ui.settle()
    with monkeypatch.context() as patch:
        fail(ui, patch)
        frames = 0
        ui.window.wake()
        while not (ui.state.error or "went wrong" in ui.state.notice):
            ui.window.loop_once()
            frames += 1
            assert frames < 20, "nothing was said"
        for _ in range(5):  # it goes on, and says so only once
            ui.window.wake()
            ui.window.loop_once()
        message = ui.state.error or ui.state.notice
        assert "Your drawing is still open" in message
        assert ui.session.state is state
    monkeypatch.undo()
    if ui.state.error:
        ui.dialog("Error", "OK")
    assert not ui.state.error
    assert not ui.state.part(AboutDialog).is_open
    assert "Traceback" in capfd.readouterr().err, "for a bug report"
    ui.click(ui.to_screen(ui.pin_position(1)))
    assert ui.editor.selection == {1}


def test_a_window_that_cannot_draw_at_all_ends_with_a_rescue(pinned, monkeypatch, capfd):
    rescued = []
    monkeypatch.setattr(Scene, "draw", lambda *_: [][0])
    monkeypatch.setattr(files, "rescue", rescued.append)
    monkeypatch.setattr(pinned.window, "wait_for_events", lambda _: None)
    pinned.window.wake()
    with pytest.raises(IndexError):
        pinned.window.run()
    assert rescued == [pinned.state]
    monkeypatch.undo()
    pinned.state.error = ""
    pinned.settle()
