"""Motion paths of the selected pins: where the pins are at each frame, and what is drawn."""

import numpy as np
import pytest

from akap_editor.app.timeline.motion_paths import MotionPaths, dot_times
from akap_editor.editor.document.pin import pin_points


@pytest.fixture
def keyed(pinned):
    """Keyframes at 0 and 0.5 seconds, between which pin 3 moves; it is selected."""
    pinned.add_keyframes(0.5)
    pinned.editor.select({3})
    return pinned


def test_a_dot_for_each_frame_and_each_keyframe():
    assert len(dot_times((0.0, 1.0))) == 25
    assert dot_times((1.0, 1.01, 1.1)) == [1.0, 1.01, 1.042, 1.083, 1.1]
    assert dot_times((0.0,)) == dot_times(()) == []
    assert len(dot_times((0.0, 3600.0))) <= 1002


def test_dots_are_where_the_pin_is_at_their_times(keyed):
    paths, playback = MotionPaths(lambda: 0.0), keyed.state.timeline.keyframe_playback
    paths.update(keyed.state)
    assert paths.is_complete
    assert len(paths.points) == 13
    place = pin_points([pin for pin in keyed.session.state.pins if pin.id == 3])
    for time, points in zip(paths.times, paths.points, strict=True):
        expected = keyed.session.drawing.mesh.evaluate(place, playback.pose(time))
        np.testing.assert_array_equal(points, expected)
    assert np.ptp(np.stack(paths.points), axis=0).max() > 5, "it moves"


def test_paths_are_computed_beside_the_drawing_and_anew_after_a_change(keyed):
    now = iter(np.arange(1000.0))
    paths = MotionPaths(lambda: next(now))
    for count in (1, 2, 3):
        paths.update(keyed.state)
        assert len(paths.points) == count
    keyed.state.timeline.keyframe_playback.move_keyframe(0.5, 0.25)
    paths.update(keyed.state)
    assert len(paths.times) == 7
    assert len(paths.points) == 1
    keyed.state.editor.select(())
    paths.update(keyed.state)
    assert paths.times == paths.points == []


def test_the_window_draws_them(keyed):
    keyed.settle()
    before = keyed.screenshot()
    keyed.state.view.show_motion_paths = True
    keyed.settle()
    assert len(keyed.state.part(MotionPaths).points) == 13
    x, y = keyed.state.editor.camera.to_screen(keyed.state.part(MotionPaths).points[6][0].tolist())
    around = slice(int(y) - 3, int(y) + 4), slice(int(x) - 3, int(x) + 4)
    assert (keyed.screenshot()[around] != before[around]).any()


def test_a_key_of_a_path_is_dragged(keyed):
    state, playback = keyed.state, keyed.state.timeline.keyframe_playback
    state.view.show_motion_paths = True
    keyed.settle()
    depth, before = keyed.session.history.depth, playback.animation.keyframes
    x, y = state.editor.camera.to_screen(state.part(MotionPaths).points[0][0].tolist())
    keyed.drag((x, y), (x - 25, y + 15))
    keyed.settle()
    assert playback.time == 0.0
    first, last = keyed.session.present.animation.keyframes
    assert (first.time, last.time) == (0.0, 0.5)
    assert last.positions is before[1].positions
    place = pin_points([pin for pin in keyed.session.state.pins if pin.id == 3])
    (moved,) = keyed.session.drawing.mesh.evaluate(place, first.positions).tolist()
    np.testing.assert_allclose(state.editor.camera.to_screen(moved), (x - 25, y + 15), atol=2.0)
    assert keyed.session.history.depth == depth + 1
    assert not playback.auto_key.is_armed


def test_a_click_on_a_key_goes_there_and_edits_nothing(keyed):
    state, playback = keyed.state, keyed.state.timeline.keyframe_playback
    state.view.show_motion_paths = True
    keyed.settle()
    before = keyed.session.present
    keyed.click(state.editor.camera.to_screen(state.part(MotionPaths).points[0][0].tolist()))
    keyed.settle()
    assert playback.time == 0.0
    assert keyed.session.present.animation is before.animation
    assert not playback.auto_key.is_armed


def test_of_keys_at_one_place_the_one_at_the_playhead_is_taken(keyed):
    """Otherwise a click on a pin that stays where it was moved the playhead back."""
    state, playback = keyed.state, keyed.state.timeline.keyframe_playback
    playback.set_keyframe(0.8)
    state.view.show_motion_paths = True
    for time, expected in [(0.8, 0.8), (0.5, 0.5), (0.7, 0.8)]:
        playback.scrub(time)
        keyed.settle()
        keyed.click(state.editor.camera.to_screen(state.part(MotionPaths).points[-1][0].tolist()))
        keyed.settle()
        assert playback.time == expected
