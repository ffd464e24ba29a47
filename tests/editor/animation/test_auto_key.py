"""Auto-key: gestures that change the pose leave keyframes, and nothing else does."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.animation.keyframe_playback import KeyframePlayback
from tests.support.editor_driver import replayed_state

END = (105.0, 40.0)


@pytest.fixture
def playback(pinned, clock):
    """No keyframes; auto-key is on, the playhead at 0.5 seconds."""
    playback = KeyframePlayback(pinned.editor, clock)
    playback.auto_key.is_on = True
    playback.update()
    playback.scrub(0.5)
    return playback


def times(pinned):
    return pinned.session.present.animation.times


def drag(pinned, playback, to):
    pinned.drag(END, to)
    playback.update()
    pinned.settle()
    playback.update()


def test_a_drag_becomes_a_keyframe_of_the_settled_pose_at_the_playhead(playback, pinned):
    drag(pinned, playback, (90.0, 60.0))
    (keyframe,) = pinned.session.present.animation.keyframes
    assert keyframe.time == 0.5
    np.testing.assert_array_equal(keyframe.positions, pinned.session.present.positions)
    assert pinned.session.present.animation.ease == "smooth"


def test_the_keyframe_is_undone_with_its_drag_and_undo_and_redo_make_none(playback, pinned):
    depth = pinned.session.history.depth
    drag(pinned, playback, (90.0, 60.0))
    assert pinned.session.history.depth == depth + 1
    pinned.undo()
    playback.update()
    assert times(pinned) == ()
    playback.time = 1.0
    pinned.editor.redo()
    playback.update()
    playback.update()
    assert times(pinned) == (0.5,)


def test_a_drag_at_another_time_adds_a_keyframe_and_one_at_the_same_time_updates_it(playback, pinned):
    drag(pinned, playback, (90.0, 60.0))
    first = pinned.session.present.animation.keyframes[0].positions
    playback.scrub(1.5)
    for target in ((80.0, 70.0), (85.0, 30.0)):
        pinned.drag(pinned.where(3), target)
        playback.update()
        pinned.settle()
        playback.update()
        assert times(pinned) == (0.5, 1.5)
        start, end = pinned.session.present.animation.keyframes
        np.testing.assert_array_equal(start.positions, first)
        np.testing.assert_array_equal(end.positions, pinned.session.present.positions)


def test_what_does_not_change_the_pose_makes_no_keyframe(playback, pinned):
    pinned.click((40.0, 40.0))
    playback.update()
    playback.update()
    assert times(pinned) == ()


def test_what_was_done_while_it_was_off_makes_no_keyframe(playback, pinned):
    playback.auto_key.is_on = False
    drag(pinned, playback, (90.0, 60.0))
    playback.auto_key.is_on = True
    playback.update()
    playback.update()
    assert times(pinned) == ()


def test_a_recording_with_automatic_keyframes_replays(playback, pinned):
    drag(pinned, playback, (90.0, 60.0))
    replayed = replayed_state(pinned.session.recording, pinned.session.drawing)
    assert replayed.animation.times == (0.5,)


def test_another_order_of_limbs_becomes_a_keyframe(playback, pinned):
    drag(pinned, playback, (22.0, 46.0))
    playback.scrub(1.5)
    pinned.editor.select({3})
    gestures.order_limb(pinned.editor, False)
    for _ in range(2):
        playback.update()
    assert times(pinned) == (0.5, 1.5)
    first, last = pinned.session.present.animation.keyframes
    assert not np.array_equal(first.crossings, last.crossings)
