"""The history: stacks of whole states, gestures, and their limits."""

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState
from akap_editor.editor.session import history as history_module
from akap_editor.editor.session.history import History


@pytest.fixture
def states():
    return [EditState((), np.full((3, 2), float(number))) for number in range(4)]


@pytest.fixture
def history(states):
    """A history of three gestures, from state 0 to state 3."""
    history = History()
    for number in range(3):
        history.begin(f"gesture {number}", states[number])
        history.commit()
    return history


def test_a_new_history_has_nothing_to_undo():
    history = History()
    assert (history.depth, history.undo_label, history.redo_label, history.is_open) == (0, None, None, False)
    for method in (history.undo, history.redo):
        with pytest.raises(IndexError):
            method(EditState((), np.zeros((3, 2))))


def test_undo_and_redo_return_the_very_states(history, states):
    state = states[3]
    for number in (2, 1, 0):
        assert history.undo_label == f"gesture {number}"
        state = history.undo(state)
        assert state is states[number]
        assert history.depth == number
    for number in (1, 2, 3):
        assert history.redo_label == f"gesture {number - 1}"
        state = history.redo(state)
        assert state is states[number]
    assert history.redo_label is None


def test_redo_returns_the_state_at_the_time_of_undo_not_that_of_commit(history, states):
    settled = EditState((), np.full((3, 2), 9.0))
    history.undo(settled)
    assert history.redo(states[2]) is settled


def test_a_committed_gesture_clears_redo_and_an_aborted_one_does_not(history, states):
    state = history.undo(states[3])
    history.begin("aborted", state)
    assert history.abort() is state
    assert history.redo_label == "gesture 2"
    history.begin("committed", state)
    history.commit()
    assert history.redo_label is None
    assert history.depth == 3


def test_an_open_gesture_knows_whether_it_changed_anything(history, states):
    assert not history.is_unchanged(states[3])
    history.begin("open", states[3])
    assert history.is_open
    assert history.is_unchanged(states[3])
    assert not history.is_unchanged(states[2])


def test_rename_keeps_the_state(history, states):
    history.begin("one", states[3])
    history.rename("another")
    history.commit()
    assert history.undo_label == "another"
    assert history.undo(states[0]) is states[3]


def test_gestures_do_not_nest_and_end_only_once(history, states):
    for end in (history.commit, history.abort, lambda: history.rename("x")):
        with pytest.raises(AssertionError, match="no gesture"):
            end()
    history.begin("open", states[3])
    with pytest.raises(AssertionError, match="already open"):
        history.begin("second", states[3])


@pytest.mark.parametrize(("limit", "value", "count"), [("MAX_ENTRIES", 3, 3), ("MAX_BYTES", 5 * 32, 5)])
def test_the_oldest_gestures_are_dropped(monkeypatch, limit, value, count):
    monkeypatch.setattr(history_module, limit, value)
    history = History()
    states = [EditState((), np.full((2, 2), float(number))) for number in range(9)]
    for number, state in enumerate(states[:-1]):
        history.begin(f"gesture {number}", state)
        history.commit()
        assert history.depth == min(number + 1, count)
    current = states[-1]
    for state in reversed(states[:-1][-count:]):
        current = history.undo(current)
        assert current is state
    assert history.undo_label is None


def test_one_gesture_can_always_be_undone(monkeypatch):
    monkeypatch.setattr(history_module, "MAX_BYTES", 0)
    history, state = History(), EditState((), np.zeros((2, 2)))
    history.begin("large", state)
    history.commit()
    assert history.undo(state) is state
