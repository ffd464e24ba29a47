import numpy as np
import pytest

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor import gestures
from akap_editor.editor.camera import Camera
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import SetPose
from akap_editor.errors import InputError, SolverError
from akap_editor.geometry.mesh import TriMesh
from tests.support.editor_driver import OUTSIDE, bits

NECK, END = (62.0, 40.0), (105.0, 40.0)


def test_without_a_drawing_nothing_happens():
    editor = Editor()
    for kind in ("press", "move", "release"):
        editor.handle_event(PointerEvent(kind, (50.0, 50.0)))
    for act in (editor.undo, editor.redo, editor.select_all, editor.fit, editor.cancel):
        act()
    gestures.reset_pose(editor)
    gestures.remove_pins(editor, [1])
    gestures.set_settings(editor, Settings("akap"))
    assert gestures.add_pin(editor, (1.0, 1.0)) is None
    assert not any([editor.is_moving, editor.advance(), editor.is_modified, editor.tool.markers.new_pin])
    assert editor.tool.markers.hovered_pin is None
    assert "Open" in editor.hint


def test_a_drawing_opens_in_full_view_without_selection(pinned, drawing):
    pinned.editor.select_all()
    pinned.editor.open(new_document(drawing))
    left, top, right, bottom = pinned.editor.canvas
    (x0, y0), (x1, y1) = (pinned.editor.camera.to_screen(corner) for corner in ((0.0, 0.0), drawing.size))
    assert left < x0 < x1 < right
    assert top < y0 < y1 < bottom
    assert pinned.editor.selection == frozenset()
    assert pinned.depth == 0


def test_opening_ends_the_gesture_of_the_old_drawing(pinned, drawing):
    old = pinned.session
    pinned.press(END)
    pinned.move((90.0, 60.0))
    pinned.editor.open(new_document(drawing))
    assert pinned.tool == "PinsIdle"
    assert not old.history.is_open
    assert not pinned.editor.is_busy


def test_a_drawing_that_cannot_be_opened_leaves_the_old_one(pinned, drawing):
    old, before = pinned.session, pinned.everything
    with pytest.raises(InputError):
        pinned.editor.open(new_document(drawing, Settings("no such method")))
    assert pinned.session is old
    assert pinned.everything == before


def test_fit_shows_all_of_the_pose(pinned):
    pinned.press(END)
    pinned.move((180.0, -60.0))
    pinned.settle()
    pinned.release((180.0, -60.0))
    pinned.editor.fit()
    screen = [pinned.editor.camera.to_screen(tuple(p)) for p in pinned.state.positions]
    left, top, right, bottom = pinned.editor.canvas
    assert (np.min(screen, axis=0) > (left, top)).all()
    assert (np.max(screen, axis=0) < (right, bottom)).all()


def test_zoom_is_about_the_middle_of_the_canvas(pinned):
    pinned.editor.canvas = (200.0, 100.0, 600.0, 500.0)
    middle = pinned.editor.camera.to_drawing((400.0, 300.0))
    pinned.editor.zoom(2.5)
    assert pinned.editor.camera.to_drawing((400.0, 300.0)) == pytest.approx(middle)


def test_the_wheel_zooms_about_the_pointer_and_back(pinned):
    camera = pinned.editor.camera
    screen = camera.to_screen(NECK)
    pinned.scroll(NECK, 3)
    assert pinned.editor.camera.zoom > camera.zoom
    assert pinned.editor.camera.to_screen(NECK) == pytest.approx(screen)
    pinned.scroll(NECK, -3)
    assert pinned.editor.camera.zoom == pytest.approx(camera.zoom)


def test_hover(pinned):
    pinned.move(NECK)
    assert pinned.hovered_pin == 2
    assert not pinned.would_add_pin
    pinned.move((45.0, 25.0))
    assert pinned.hovered_pin is None
    assert pinned.would_add_pin
    pinned.move(OUTSIDE)
    assert not pinned.would_add_pin
    pinned.move((45.0, 25.0))
    pinned.editor.chosen_tool = pinned.editor.hand_tool
    assert not pinned.would_add_pin
    pinned.editor.chosen_tool = pinned.editor.pins_tool
    pinned.press((45.0, 25.0))
    assert not pinned.would_add_pin
    pinned.key("escape")
    assert pinned.would_add_pin
    pinned.editor.pointer_left()
    assert pinned.hovered_pin is None
    assert not pinned.would_add_pin


@pytest.mark.parametrize("looked_elsewhere", [False, True])
def test_a_fitted_drawing_stays_fitted_when_the_canvas_changes(driver, looked_elsewhere):
    if looked_elsewhere:
        driver.scroll(NECK, 1)
    before = driver.editor.camera
    driver.editor.canvas = (100.0, 50.0, 500.0, 450.0)
    if looked_elsewhere:
        assert driver.editor.camera == before
    else:
        assert driver.editor.camera.to_screen((60.0, 40.0)) == pytest.approx((300.0, 250.0))


def test_the_hint_of_a_drag_says_why_nothing_bends(driver):
    driver.press(NECK)
    driver.move((70.0, 30.0))
    assert driver.tool == "DraggingPin"
    assert "all of it moves" in driver.editor.hint
    driver.release((70.0, 30.0))
    driver.move(OUTSIDE)
    assert "add another one that holds it in place" in driver.editor.hint


def test_the_hint_of_a_drag_that_bends_is_how_to_end_it(pinned):
    pinned.press((45.0, 25.0))
    pinned.move((45.0, 35.0))
    assert pinned.tool == "DraggingPin"
    assert pinned.editor.hint == "Release to keep this pose, Esc to cancel"


def test_the_hint_of_idle_says_what_a_press_would_do(driver):
    hints = []
    for at in (OUTSIDE, NECK):
        driver.move(at)
        hints.append(driver.editor.hint)
    driver.click(NECK)
    for at in (NECK, OUTSIDE):
        driver.move(at)
        hints.append(driver.editor.hint)
    driver.editor.chosen_tool = driver.editor.hand_tool
    hints.append(driver.editor.hint)
    assert len(set(hints)) == 5


def test_held_keys(pinned, drawing):
    for name in ("h", "alt"):
        pinned.key(name)
    assert pinned.editor.held == {"h", "alt"}
    pinned.key("alt", pressed=False)
    assert pinned.editor.held == {"h"}
    pinned.editor.open(new_document(drawing))
    assert pinned.editor.held == {"h"}


# -- edits -------------------------------------------------------------------------------------------------


def edit_add(d):
    assert gestures.add_pin(d.editor, (45.0, 45.0)) == 4
    return "Add Pin"


def edit_remove_one(d):
    gestures.remove_pins(d.editor, [2])
    return "Remove Pin"


def edit_remove_selected(d):
    d.editor.select({1, 3})
    gestures.remove_selected_pins(d.editor)
    assert d.ids == [2]
    return "Remove 2 Pins"


def edit_reset(d):
    gestures.reset_pose(d.editor)
    return "Reset Pose"


def edit_settings(d):
    gestures.set_settings(d.editor, d.state.settings.with_parameter("memory", 0.0))
    return "Change Settings"


@pytest.mark.parametrize("edit", [edit_add, edit_remove_one, edit_remove_selected, edit_reset, edit_settings])
def test_an_edit_is_one_entry_and_undo_and_redo_are_exact(pinned, edit):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    before, depth = bits(pinned.state), pinned.depth
    label = edit(pinned)
    pinned.check()
    after = bits(pinned.state)
    assert after != before
    assert (pinned.depth, pinned.session.history.undo_label) == (depth + 1, label)
    pinned.undo()
    assert bits(pinned.state) == before
    pinned.redo()
    assert bits(pinned.state) == after


def test_removed_pins_leave_the_selection_and_undo_does_not_select_them(pinned):
    pinned.editor.select({1, 2})
    gestures.remove_pins(pinned.editor, [2])
    assert pinned.editor.selection == {1}
    pinned.undo()
    assert pinned.ids == [1, 2, 3]
    assert pinned.editor.selection == {1}


@pytest.mark.parametrize("ids", [[], [99]])
def test_removing_nothing_is_no_edit(pinned, ids):
    before = pinned.everything
    gestures.remove_pins(pinned.editor, ids)
    assert pinned.everything == before


def test_a_pin_beside_the_drawing_is_no_edit(pinned):
    before = pinned.everything
    assert gestures.add_pin(pinned.editor, OUTSIDE) is None
    assert pinned.everything == before


def test_the_same_settings_again_are_no_edit(pinned):
    before = pinned.everything
    gestures.set_settings(pinned.editor, Settings())
    assert pinned.everything == before


@pytest.mark.parametrize(
    "bad",
    [
        lambda editor: gestures.add_pin(editor, (np.nan, 0.0)),
        lambda editor: gestures.set_settings(editor, Settings("no such method")),
        lambda editor: gestures.set_settings(editor, Settings("akap", (("no such parameter", 1),))),
    ],
)
def test_a_failed_edit_changes_nothing_and_leaves_no_gesture_open(pinned, bad):
    pinned.drag(END, (90.0, 60.0), steps=2)
    assert pinned.editor.is_moving
    before = pinned.everything
    with pytest.raises(InputError):
        bad(pinned.editor)
    assert pinned.everything == before
    assert not pinned.editor.is_busy
    assert pinned.editor.is_moving


def test_a_new_edit_ends_redo(pinned):
    pinned.undo()
    assert pinned.session.history.redo_label == "Add Pin"
    gestures.remove_pins(pinned.editor, [1])
    assert pinned.session.history.redo_label is None


def test_resetting_a_pose_that_is_at_rest_is_no_edit(pinned):
    before = pinned.everything
    gestures.reset_pose(pinned.editor)
    assert pinned.everything == before


def test_select_knows_only_pins_that_are_there(pinned):
    pinned.editor.select([2, 3, 99])
    assert pinned.editor.selection == {2, 3}
    pinned.editor.select_all()
    assert pinned.editor.selection == {1, 2, 3}


def test_modified_and_saved(pinned, tmp_path):
    pinned.editor.mark_saved(tmp_path / "a.akap")
    assert not pinned.editor.is_modified
    for act in (lambda: pinned.click(NECK), lambda: pinned.click(OUTSIDE), lambda: pinned.scroll(NECK, 2)):
        act()
        assert not pinned.editor.is_modified
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    assert pinned.editor.is_modified
    pinned.undo()
    assert not pinned.editor.is_modified


# -- motion ------------------------------------------------------------------------------------------------


def test_advance_without_budget_makes_exactly_one_step(pinned):
    pinned.press(END)
    pinned.move((80.0, 70.0))
    before = sum(event["do"] == "step" for event in pinned.session.recording.events)
    assert pinned.editor.advance(budget=0.0)
    assert sum(event["do"] == "step" for event in pinned.session.recording.events) == before + 1


def test_advance_with_time_makes_steps_until_the_pins_are_near(pinned):
    pinned.press(END)
    pinned.move((90.0, 60.0))
    assert pinned.editor.advance(budget=1e9)
    assert pinned.session.pin_error() < 1.0


def test_at_rest_advance_does_nothing(pinned):
    before, revision = pinned.everything, pinned.session.document.revision
    assert not pinned.editor.is_moving
    assert not pinned.editor.advance()
    assert (pinned.everything, pinned.session.document.revision) == (before, revision)


def test_the_drawing_settles_after_release_and_redo_returns_the_settled_pose(pinned):
    pinned.drag(END, (88.0, 66.0), steps=2)
    released = bits(pinned.state)
    pinned.settle()
    settled = bits(pinned.state)
    assert settled != released
    pinned.undo()
    pinned.redo()
    assert bits(pinned.state) == settled


def test_a_solver_error_cancels_the_gesture_and_is_raised(pinned, monkeypatch):
    pinned.editor.select({1})
    before = pinned.everything
    pinned.press(END)
    pinned.move((90.0, 60.0))
    pinned.advance()

    def fail(self, positions, targets):
        raise SolverError("on purpose")

    with monkeypatch.context() as patch:
        patch.setattr(AkapDeformer, "step", fail)
        with pytest.raises(SolverError, match="on purpose"):
            pinned.editor.advance()
    assert pinned.tool == "PinsIdle"
    assert pinned.everything == before
    assert not pinned.editor.is_moving
    pinned.drag(END, (95.0, 50.0))
    pinned.settle()
    assert np.hypot(*np.subtract(pinned.where(3), (95.0, 50.0))) < 0.25


def test_a_solver_error_after_release_keeps_the_last_good_pose(pinned, monkeypatch):
    pinned.drag(END, (90.0, 60.0), steps=2)
    before = pinned.everything

    def fail(self, positions, targets):
        raise SolverError("on purpose")

    monkeypatch.setattr(AkapDeformer, "step", fail)
    with pytest.raises(SolverError):
        pinned.editor.advance()
    assert pinned.everything == before
    assert not pinned.editor.is_moving


def test_camera_is_not_undoable(pinned):
    pinned.editor.camera = Camera(3.0, (1.0, 2.0))
    pinned.undo()
    assert pinned.editor.camera == Camera(3.0, (1.0, 2.0))


def test_the_drawing_under_the_pointer_is_looked_up_once_for_each_place_and_pose(pinned, monkeypatch):
    looked, find = [], TriMesh.find
    monkeypatch.setattr(TriMesh, "find", lambda mesh, *args: looked.append(args) or find(mesh, *args))
    editor = pinned.editor
    inside, outside = editor.camera.to_screen((84.0, 45.0)), editor.camera.to_screen((2.0, 2.0))
    for position, is_on_drawing in ((inside, True), (outside, False), (inside, True)):
        editor.handle_event(PointerEvent("move", position))
        assert [pinned.would_add_pin, pinned.would_add_pin] == [is_on_drawing, is_on_drawing]
    assert len(looked) == 3
    pinned.session.begin("Away")
    pinned.session.apply(SetPose(pinned.state.positions + 1000.0))
    pinned.session.commit()
    assert not pinned.would_add_pin
    assert len(looked) == 4
