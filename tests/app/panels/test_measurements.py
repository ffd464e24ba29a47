"""What is measured while the window runs, and that it takes no time that frames need."""

import pytest

from akap_editor.app.panels.measurements import HISTORY_LENGTH, Measurements
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.edits import SetTargets
from akap_editor.geometry.distortion import distortion


@pytest.fixture
def session(drawing):
    editor = Editor()
    editor.open(new_document(drawing))
    gestures.add_pin(editor, (50.0, 80.0))
    gestures.add_pin(editor, (210.0, 80.0))
    return editor.session


def measuring(session, clock, cost):
    calls = []

    def measure():
        clock.now += cost
        calls.append(clock.now)
        return distortion(session.drawing.mesh, session.state.positions)

    return calls, measure


def frames(measurements, session, clock, measure, count, step=1 / 60):
    for _ in range(count):
        session.step()
        session.apply(SetTargets({2: session.state.pin(2).target}))  # goes on moving, wherever the pins are
        measurements.update(session, measure)
        clock.now += step


def test_measuring_takes_a_tenth_of_the_time_at_most_while_something_moves(session, clock):
    calls, measure = measuring(session, clock, cost=0.03)
    measurements, start = Measurements(clock), clock.now
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (190.0, 60.0)}))
    frames(measurements, session, clock, measure, 120)
    assert len(calls) >= 3
    assert 0.03 * len(calls) <= 0.1 * (clock.now - start) + 0.03


def test_the_pose_at_rest_is_measured_at_once_and_only_once(session, clock):
    calls, measure = measuring(session, clock, cost=0.03)
    measurements = Measurements(clock)
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (190.0, 60.0)}))
    frames(measurements, session, clock, measure, 3)
    session.stop_motion()
    before = len(calls)
    for _ in range(5):
        measurements.update(session, measure)
    assert len(calls) == before + 1
    expected = distortion(session.drawing.mesh, session.state.positions)
    assert measurements.distortion.area == expected.area
    assert measurements.angles[-1] == expected.angle


def test_rates_leave_out_sleep(session, clock):
    _, measure = measuring(session, clock, cost=0.0)
    measurements = Measurements(clock)
    assert (measurements.frame_rate, measurements.step_seconds) == (None, None)
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (190.0, 60.0)}))
    frames(measurements, session, clock, measure, 10, step=0.02)
    clock.now += 60.0
    frames(measurements, session, clock, measure, 10, step=0.02)
    assert measurements.frame_rate == pytest.approx(50)
    assert measurements.step_seconds > 0


def test_it_forgets_what_is_old_and_begins_anew_with_a_drawing(session, clock, drawing):
    _, measure = measuring(session, clock, cost=0.0)
    measurements = Measurements(clock)
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (190.0, 60.0)}))
    frames(measurements, session, clock, measure, HISTORY_LENGTH + 9)
    assert len(measurements.areas) == len(measurements.angles) == HISTORY_LENGTH
    other = Editor()
    other.open(new_document(drawing))
    measurements.update(other.session, measure)
    assert len(measurements.areas) == 1
    assert measurements.frame_rate is None
