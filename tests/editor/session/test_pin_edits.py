"""Adding, removing and holding pins of a session."""

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.pin import MAX_DEPTH
from akap_editor.editor.session.edits import SetAngles, SetTargets
from akap_editor.editor.session.pin_edits import (
    add_pin,
    hold_angles,
    hold_stopped_pins,
    remove_pins,
    set_depths,
)
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from tests.support.editor_driver import Ticks


@pytest.fixture
def session(drawing):
    """A session with pins 1 and 2, and an open gesture."""
    session = Session(new_document(drawing), Ticks())
    session.begin("Edit")
    assert add_pin(session, (20.0, 40.0)) == 1
    assert add_pin(session, (105.0, 40.0)) == 2
    return session


def test_a_new_pin_is_at_its_position_with_the_next_id_and_the_depth_of_its_surroundings(session):
    set_depths(session, {2: 4})
    assert add_pin(session, (103.0, 45.0)) == 3
    assert session.state.pin(3).depth == 4
    np.testing.assert_allclose(session.pin_positions()[2], (103.0, 45.0))
    np.testing.assert_array_equal(session.state.pin(3).target, (103.0, 45.0))


def test_no_pin_is_added_outside_the_drawing(session):
    state = session.state
    assert add_pin(session, (2.0, 2.0)) is None
    assert session.state is state


def test_removing_pins_ignores_unknown_ids(session):
    remove_pins(session, [2, 99])
    assert [pin.id for pin in session.state.pins] == [1]


def test_pins_that_stay_while_the_drawing_settles_stay_where_they_are(session):
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.step()
    position = session.pin_positions()[1]
    remove_pins(session, [1])
    assert not session.is_moving
    np.testing.assert_array_equal(session.state.targets, [position])


def test_depths_out_of_range_change_nothing(session):
    state = session.state
    with pytest.raises(InputError, match="depth of pin 2: expected a whole number from -999 to 999"):
        set_depths(session, {2: MAX_DEPTH + 1})
    assert session.state is state


def test_pins_hold_their_current_angles_until_they_are_released(session):
    session.apply(SetAngles({1: 0.3}))
    session.settle()
    hold_angles(session, [1, 2])
    angles = [session.pin_angle(1), session.pin_angle(2)]
    np.testing.assert_allclose(session.state.angles, angles)
    hold_angles(session, [1, 2], hold=False)
    assert np.isnan(session.state.angles).all()


def test_stopped_pins_hold_where_they_are_but_moving_and_arrived_ones_keep_their_targets(session):
    hold_stopped_pins(session)
    np.testing.assert_array_equal(session.state.targets, [(20.0, 40.0), (105.0, 40.0)])
    session.apply(SetTargets({2: (90.0, 65.0)}))
    session.step()
    hold_stopped_pins(session)
    np.testing.assert_array_equal(session.state.targets[1], (90.0, 65.0))
    session.stop_motion()
    hold_stopped_pins(session)
    np.testing.assert_allclose(session.state.targets, session.pin_positions())


@pytest.mark.parametrize("value", [1e155, -1e300, 1e7])
def test_targets_that_no_drawing_reaches_are_refused(drawing, value):
    session = Session(new_document(drawing), Ticks())
    session.begin("Add pin")
    add_pin(session, (20.0, 40.0))
    state = session.state
    with pytest.raises(InputError, match=r"targets: expected points within .* pixels"):
        session.apply(SetTargets({1: (value, 40.0)}))
    assert session.state is state
