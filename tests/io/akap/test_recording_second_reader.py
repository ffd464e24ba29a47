"""A reader that was written from the page of the format alone replays recordings to the last bit."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import (
    ResetPose,
    SetAngles,
    SetPins,
    SetPose,
    SetSettings,
    SetStiffness,
    SetTargets,
)
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from tests.support.recorded_drag import plank_drawing
from tests.support.recording_reader import RecordingReader


@pytest.fixture
def session():
    """The plank with three pins."""
    session = Session(new_document(plank_drawing()), clock=iter(np.arange(1e4) / 30).__next__)
    session.begin("Add Pins")
    for point in ((20.0, 20.0), (20.0, 32.0), (130.0, 25.0)):
        add_pin(session, point)
    session.commit()
    return session


def drag(session, offset, steps=8, angle=None):
    pin = session.state.pins[-1]
    session.begin("Drag Pin")
    for step in range(1, steps + 1):
        session.apply(SetTargets({pin.id: tuple(pin.target + np.multiply(offset, step / steps))}))
        if angle is not None:
            session.apply(SetAngles({pin.id: angle * step / steps}))
        session.step()
    session.commit()


def bend(session):
    drag(session, (-15, 30))
    session.settle()


def leap(session):
    """Far beyond the reach of a step."""
    drag(session, (-90, 60), steps=1)
    for _ in range(12):
        session.step()


def turn(session):
    first = session.state.pins[-1]
    session.begin("Hold Angle")
    session.apply(SetPins((*session.state.pins[:-1], replace(first, angle=0.0))))
    session.commit()
    drag(session, (-10, 10), angle=4.5)
    for _ in range(25):
        session.step()


def undo_and_redo(session):
    drag(session, (-15, 30))
    drag(session, (5, -50))
    session.undo()
    session.undo()
    session.redo()
    drag(session, (0, 9))


def another_method(session):
    drag(session, (-15, 30))
    session.begin("Change Method")
    session.apply(SetSettings(Settings.parse("arap")))
    session.commit()
    drag(session, (9, 9))
    session.undo()
    session.undo()
    drag(session, (3, 3))


def stiffness(session):
    session.begin("Paint")
    session.apply(SetStiffness(np.linspace(1, 60, len(session.drawing.mesh.faces)).round(2)))
    session.commit()
    drag(session, (-15, 30))
    session.undo()
    session.undo()
    drag(session, (-15, 30))


def cancel(session):
    session.begin("Drag Pin")
    session.apply(SetTargets({session.state.pins[-1].id: (90.0, 60.0)}))
    session.step()
    session.abort()
    drag(session, (-15, 30))


def pose(session):
    session.begin("Apply Pose")
    session.apply(SetPose(session.drawing.mesh.vertices * 1.1))
    session.commit()
    drag(session, (-15, 30))


def reset(session):
    drag(session, (-15, 30))
    session.begin("Reset Pose")
    session.apply(ResetPose())
    session.commit()
    drag(session, (5, 30))


@pytest.mark.parametrize(
    "act", [bend, leap, turn, undo_and_redo, another_method, stiffness, cancel, pose, reset]
)
def test_the_page_is_enough_to_replay_a_recording_bit_for_bit(session, act):
    act(session)
    text = session.recording.to_text()
    ours = [moment.state.positions for moment in replay(session.recording, session.drawing)]
    theirs = list(RecordingReader(session.drawing.mesh).poses(text))
    assert len(theirs) == len(ours)
    for mine, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(other, mine)
    np.testing.assert_array_equal(theirs[-1], session.state.positions)
    assert (theirs[-1] != session.drawing.mesh.vertices).any()
