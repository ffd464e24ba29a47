"""Steps that another thread computes: edits meanwhile, edits that wait, failures, and the recording."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.session.edits import (
    AddPose,
    PaintStiffness,
    ResetPose,
    SetKeyframe,
    SetRestPose,
    SetSettings,
)
from akap_editor.editor.session.pin_edits import add_pin, hold_angles, remove_pins, set_depths
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.stepper import INLINE, SETTLED_MOTION
from akap_editor.errors import SolverError
from tests.support.editor_driver import Driver, bits
from tests.support.executors import HeldExecutor

END, AWAY, FARTHER = (105.0, 40.0), (100.0, 30.0), (95.0, 22.0)


@pytest.fixture
def slow(drawing):
    """Three pins, the last of them dragged, and its first step under way with a slow worker."""
    driver = Driver(new_document(drawing), worker=HeldExecutor())
    for at in ((20.0, 40.0), (62.0, 40.0), END):
        driver.click(at)
    driver.before = driver.everything
    driver.press(END)
    driver.move(AWAY)
    driver.advance()
    return driver


def kinds(driver):
    return [event["do"] for event in driver.session.recording.events]


def test_until_a_step_is_done_the_pose_stays_and_the_pin_may_be_dragged_on(slow):
    rest = slow.session.drawing.mesh.vertices
    assert slow.session.has_pending_step
    assert not slow.session.step_is_ready()
    assert not slow.editor.advance(0.0)
    slow.move(FARTHER)
    assert slow.state.positions is rest
    np.testing.assert_allclose(slow.state.targets[2], FARTHER)

    slow.editor.worker.work()
    assert slow.session.step_is_ready()
    assert slow.editor.advance(0.0)
    assert slow.state.positions is not rest
    while slow.editor.moving:
        slow.advance()
        slow.editor.worker.work()
    np.testing.assert_allclose(slow.where(3), FARTHER, atol=0.25)


def test_a_step_is_recorded_when_it_starts_and_edits_follow_it(slow):
    assert kinds(slow)[-1] == "step"
    count = len(kinds(slow))
    slow.move(FARTHER)
    assert kinds(slow)[count:] == ["targets"]
    slow.editor.worker.work()
    slow.advance()
    assert kinds(slow)[count - 1 :] == ["step", "targets"]
    slow.editor.worker.work()
    slow.release(FARTHER)
    *_, moment = replay(slow.session.recording, slow.session.drawing)
    assert bits(moment.state) == bits(slow.state)


def test_a_step_that_came_to_rest_does_not_end_a_drag_that_went_on(slow):
    before = slow.session.last_step
    while True:
        slow.editor.worker.work()
        step = slow.editor.worker.last.result()
        if np.abs(step.positions - slow.state.positions).max() < SETTLED_MOTION:
            break
        slow.advance()
        slow.advance()
    assert slow.session.last_step is not before
    slow.move((100.2, 30.0))  # so near that no pin counts as being on its way
    slow.advance()
    assert slow.editor.moving


def test_escape_during_a_step_restores_to_the_last_bit(slow):
    slow.move(FARTHER)
    slow.editor.worker.work()
    slow.key("escape")
    assert slow.everything == slow.before
    assert not slow.session.has_pending_step
    assert not slow.editor.moving
    *_, moment = replay(slow.session.recording, slow.session.drawing)
    assert bits(moment.state) == bits(slow.state)


def failing(driver, monkeypatch):
    def fail(*_):
        raise SolverError("the linear system is singular")

    monkeypatch.setattr("akap_editor.deform.akap.deformer.AkapDeformer.step", fail)
    driver.editor.worker.work()


def test_a_step_that_fails_in_the_worker_takes_the_gesture_back(slow, monkeypatch):
    failing(slow, monkeypatch)
    with pytest.raises(SolverError, match="singular"):
        slow.editor.advance(0.0)
    assert slow.everything == slow.before
    assert slow.tool == "PinsIdle"


def test_escape_wins_over_a_step_that_fails(slow, monkeypatch):
    failing(slow, monkeypatch)
    slow.key("escape")
    assert slow.everything == slow.before


def test_a_release_does_not_wait_for_the_step(slow):
    count = len(kinds(slow))
    slow.move(FARTHER)
    slow.release(FARTHER)
    assert slow.tool == "PinsIdle"
    assert slow.session.has_pending_step
    assert not slow.session.step_is_ready()
    assert slow.session.history.undo_label == "Bend"
    slow.editor.worker.work()
    slow.advance()
    assert kinds(slow)[count - 1 :] == ["step", "targets", "commit"]
    while slow.editor.moving:
        slow.advance()
        slow.editor.worker.work()
    np.testing.assert_allclose(slow.where(3), FARTHER, atol=0.25)
    *_, moment = replay(slow.session.recording, slow.session.drawing)
    assert bits(moment.state) == bits(slow.state)
    slow.undo()
    assert slow.everything[0] == slow.before[0]


def test_a_step_that_fails_after_the_release_leaves_the_pose(slow, monkeypatch):
    pose = slow.state.positions
    failing(slow, monkeypatch)
    slow.release(AWAY)
    with pytest.raises(SolverError, match="singular"):
        slow.editor.advance(0.0)
    assert slow.state.positions is pose
    assert not slow.editor.moving


@pytest.mark.parametrize("after", ["cancelled", "released"])
def test_a_recording_with_a_failed_step_can_be_replayed(slow, monkeypatch, after):
    with monkeypatch.context() as patch:
        failing(slow, patch)
        slow.move(FARTHER)
        if after == "released":
            slow.release(FARTHER)
        with pytest.raises(SolverError, match="singular"):
            slow.editor.advance(0.0)
    *_, last = replay(slow.session.recording, slow.session.drawing)
    assert bits(last.state) == bits(slow.state)


EDITS = {
    "commit": lambda session: (session.commit(), session.stop_motion()),
    "add_pin": lambda session: add_pin(session, (45.0, 40.0)),
    "remove_pins": lambda session: remove_pins(session, {1}),
    "set_depths": lambda session: set_depths(session, {1: 2}),
    "hold_angles": lambda session: hold_angles(session, {1}),
    "settings": lambda session: session.apply(
        SetSettings(session.state.settings.with_parameter("memory", 0.5))
    ),
    "stiffness": lambda session: session.apply(PaintStiffness([(45.0, 40.0)], 10.0, 50.0)),
    "keep": lambda session: session.apply(AddPose("bent")),
    "key": lambda session: session.apply(SetKeyframe(0.5)),
    "reset": lambda session: session.apply(ResetPose()),
    "bake": lambda session: session.apply(SetRestPose()),
    "undo": lambda session: (session.commit(), session.undo(), session.redo()),
}


@pytest.mark.parametrize("edit", EDITS)
def test_other_edits_wait_for_the_step_and_follow_it(slow, edit):
    """As if the step had been done at once, in the state and in the recording."""
    twin = Driver(new_document(slow.session.drawing), worker=INLINE)
    for at in ((20.0, 40.0), (62.0, 40.0), END):
        twin.click(at)
    twin.press(END)
    twin.move(AWAY)
    twin.advance()
    slow.editor.worker.work()
    for driver in (slow, twin):
        EDITS[edit](driver.session)
        driver.check()
    assert bits(slow.state) == bits(twin.state)
    assert kinds(slow) == kinds(twin)


def test_fields_and_edits_wait_for_a_step_in_a_real_thread(drawing):
    with ThreadPoolExecutor(1) as thread:
        driver = Driver(new_document(drawing), worker=thread)
        for at in ((20.0, 40.0), (62.0, 40.0), END):
            driver.click(at)
        driver.press(END)
        for number in range(20):
            driver.move((105.0 - number, 40.0 - number))
            driver.advance()
            thread.submit(driver.session.vector_fields)
        driver.settle()
        found = thread.submit(driver.session.vector_fields).result()
        driver.release(driver.where(3))
        gestures.add_pin(driver.editor, (45.0, 40.0))
    assert found is not None
    assert found[0].shape == driver.state.positions.shape
    assert driver.session.vector_fields() is None, "of other pins"
