"""Pending steps: edits that overlap them, edits that wait for them, failures, and the recording."""

from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.editor import FRAME_BUDGET, STEP_WAIT
from akap_editor.editor.session.edits import EDITS
from akap_editor.editor.session.pin_edits import add_pin, hold_angles, remove_pins, set_depths
from akap_editor.editor.session.stepper import INLINE, SETTLED_MOTION
from akap_editor.errors import InputError, SolverError
from tests.support.edit_examples import EDIT_EXAMPLES
from tests.support.editor_driver import Driver, bits, replayed_state
from tests.support.executors import HeldExecutor

END, AWAY, FARTHER = (105.0, 40.0), (100.0, 30.0), (95.0, 22.0)


@pytest.fixture
def driver(drawing):
    """A driver that drags the last of three pins; the first step is pending until `worker.work`."""
    driver = Driver(new_document(drawing), worker=HeldExecutor())
    for place in ((20.0, 40.0), (62.0, 40.0), END):
        driver.click(place)
    driver.before = driver.everything
    driver.press(END)
    driver.move(AWAY)
    driver.advance()
    return driver


def event_names(driver):
    """The names of all recorded events."""
    return [event["do"] for event in driver.session.recording.events]


def assert_replay_is_exact(driver):
    session = driver.session
    assert bits(replayed_state(session.recording, session.drawing)) == bits(driver.state)


def test_while_a_step_is_pending_the_pose_stays_and_the_pin_can_be_dragged(driver):
    rest = driver.session.drawing.mesh.vertices
    assert driver.session.has_pending_step
    assert not driver.session.step_is_ready()
    assert not driver.editor.advance(0.0)
    driver.move(FARTHER)
    assert driver.state.positions is rest
    np.testing.assert_allclose(driver.state.targets[2], FARTHER)

    driver.editor.worker.work()
    assert driver.session.step_is_ready()
    assert driver.editor.advance(0.0)
    assert driver.state.positions is not rest
    while driver.editor.is_moving:
        driver.advance()
        driver.editor.worker.work()
    np.testing.assert_allclose(driver.where(3), FARTHER, atol=0.25)


@pytest.mark.parametrize(
    ("seconds", "patience"), [(0.001, STEP_WAIT), (0.9 * STEP_WAIT, STEP_WAIT), (STEP_WAIT, FRAME_BUDGET)]
)
def test_a_frame_waits_for_steps_that_take_hardly_longer(driver, monkeypatch, seconds, patience):
    """Without it, every second frame would show an old pose."""
    driver.editor.worker.work()
    driver.editor.advance(0.0)
    last, limits = driver.session.last_step, []
    report = replace(last.report, seconds=seconds)
    monkeypatch.setattr(type(driver.session), "last_step", replace(last, report=report))
    monkeypatch.setattr(
        type(driver.session), "step_is_ready", lambda _, limit=0.0: bool(limits.append(limit))
    )
    monkeypatch.setattr("akap_editor.editor.editor.time.perf_counter", lambda: 0.0)
    assert not driver.editor.advance()
    assert limits == [patience]


def test_a_step_is_recorded_when_it_starts_and_edits_follow_it(driver):
    assert event_names(driver)[-1] == "step"
    count = len(event_names(driver))
    driver.move(FARTHER)
    assert event_names(driver)[count:] == ["targets"]
    driver.editor.worker.work()
    driver.advance()
    assert event_names(driver)[count - 1 :] == ["step", "targets"]
    driver.editor.worker.work()
    driver.release(FARTHER)
    assert_replay_is_exact(driver)


def test_a_settled_step_does_not_stop_a_drag_that_has_moved_meanwhile(driver):
    before = driver.session.last_step
    while True:
        driver.editor.worker.work()
        step = driver.editor.worker.last.result()
        if np.abs(step.positions - driver.state.positions).max() < SETTLED_MOTION:
            break
        driver.advance()
        driver.advance()
    assert driver.session.last_step is not before
    driver.move((100.2, 30.0))  # less than the tolerance within which a pin has arrived
    driver.advance()
    assert driver.editor.is_moving


def test_escape_while_a_step_is_pending_restores_to_the_last_bit(driver):
    driver.move(FARTHER)
    driver.editor.worker.work()
    driver.key("escape")
    assert driver.everything == driver.before
    assert not driver.session.has_pending_step
    assert not driver.editor.is_moving
    assert_replay_is_exact(driver)


def fail_pending_step(driver, monkeypatch):
    """Run the pending step so that it raises SolverError; later ones fail, too."""

    def fail(*_):
        raise SolverError("the linear system is singular")

    monkeypatch.setattr("akap_editor.deform.akap.deformer.AkapDeformer.step", fail)
    driver.editor.worker.work()


def test_a_step_that_fails_in_the_worker_aborts_the_gesture(driver, monkeypatch):
    fail_pending_step(driver, monkeypatch)
    with pytest.raises(SolverError, match="singular"):
        driver.editor.advance(0.0)
    assert driver.everything == driver.before
    assert driver.tool == "PinsIdle"


def test_escape_ignores_a_step_that_failed(driver, monkeypatch):
    fail_pending_step(driver, monkeypatch)
    driver.key("escape")
    assert driver.everything == driver.before


def test_a_release_does_not_wait_for_the_step(driver):
    count = len(event_names(driver))
    driver.move(FARTHER)
    driver.release(FARTHER)
    assert driver.tool == "PinsIdle"
    assert driver.session.has_pending_step
    assert not driver.session.step_is_ready()
    assert driver.session.history.undo_label == "Drag Pin"
    driver.editor.worker.work()
    driver.advance()
    assert event_names(driver)[count - 1 :] == ["step", "targets", "commit"]
    while driver.editor.is_moving:
        driver.advance()
        driver.editor.worker.work()
    np.testing.assert_allclose(driver.where(3), FARTHER, atol=0.25)
    assert_replay_is_exact(driver)
    driver.undo()
    assert driver.everything[0] == driver.before[0]


def test_a_step_that_fails_after_the_release_leaves_the_pose(driver, monkeypatch):
    pose = driver.state.positions
    fail_pending_step(driver, monkeypatch)
    driver.release(AWAY)
    with pytest.raises(SolverError, match="singular"):
        driver.editor.advance(0.0)
    assert driver.state.positions is pose
    assert not driver.editor.is_moving


@pytest.mark.parametrize("after", ["cancelled", "released"])
def test_a_recording_with_a_failed_step_can_be_replayed(driver, monkeypatch, after):
    with monkeypatch.context() as patch:
        fail_pending_step(driver, patch)
        driver.move(FARTHER)
        if after == "released":
            driver.release(FARTHER)
        with pytest.raises(SolverError, match="singular"):
            driver.editor.advance(0.0)
    assert_replay_is_exact(driver)


@pytest.fixture
def inline_driver(drawing):
    """A driver that has done the same as `driver`, with the step computed at once."""
    driver = Driver(new_document(drawing), worker=INLINE)
    for place in ((20.0, 40.0), (62.0, 40.0), END):
        driver.click(place)
    driver.press(END)
    driver.move(AWAY)
    driver.advance()
    return driver


def assert_waits_for_step(driver, inline_driver, change):
    """State and recording must be as if the pending step had been computed at once."""
    driver.editor.worker.work()
    for each in (driver, inline_driver):
        each.editor.select(())
        change(each.session)
        each.check()
    assert bits(driver.state) == bits(inline_driver.state)
    assert event_names(driver) == event_names(inline_driver)


@pytest.mark.parametrize("name", [name for name, edit in EDITS.items() if not edit.may_overlap_step])
def test_other_edits_wait_for_the_step_and_follow_it(driver, inline_driver, name):
    edit = EDIT_EXAMPLES[name](inline_driver.session)

    def apply(session):
        with suppress(InputError):  # without named poses there is none to rename
            session.apply(edit)

    assert_waits_for_step(driver, inline_driver, apply)


CHANGES = {
    "commit": lambda session: (session.commit(), session.stop_motion()),
    "undo": lambda session: (session.commit(), session.undo(), session.redo()),
    "add_pin": lambda session: add_pin(session, (45.0, 40.0)),
    "remove_pins": lambda session: remove_pins(session, {1}),
    "set_depths": lambda session: set_depths(session, {1: 2}),
    "hold_angles": lambda session: hold_angles(session, {1}),
}


@pytest.mark.parametrize("name", CHANGES)
def test_other_changes_wait_for_the_step_and_follow_it(driver, inline_driver, name):
    assert_waits_for_step(driver, inline_driver, CHANGES[name])


def test_fields_and_edits_wait_for_a_step_in_a_real_thread(drawing):
    with ThreadPoolExecutor(1) as thread:
        driver = Driver(new_document(drawing), worker=thread)
        for place in ((20.0, 40.0), (62.0, 40.0), END):
            driver.click(place)
        driver.press(END)
        for number in range(20):
            driver.move((105.0 - number, 40.0 - number))
            driver.advance()
            thread.submit(driver.session.vector_fields)
        driver.settle()
        fields = thread.submit(driver.session.vector_fields).result()
        driver.release(driver.where(3))
        gestures.add_pin(driver.editor, (45.0, 40.0))
    assert fields is not None
    assert fields[0].shape == driver.state.positions.shape
    assert driver.session.vector_fields() is None, "the last motion had other pins"


def test_the_next_step_is_announced_with_each_change_of_the_pins(drawing, monkeypatch):
    announced = []
    monkeypatch.setattr(AkapDeformer, "prepare", lambda _, positions: announced.append(positions))
    driver = Driver(new_document(drawing))
    for change in (
        lambda: driver.click((20.0, 40.0)),
        lambda: gestures.set_settings(driver.editor, driver.state.settings.with_parameter("memory", 0.5)),
        driver.undo,
        lambda: driver.click(END),
    ):
        announced.clear()
        change()
        assert announced[-1] is driver.state.positions
    hold_angles(driver.session, {1})
    announced.clear()
    driver.click((62.0, 40.0))
    assert not announced, "the step itself changes what it needs"
