"""Speeds over the time of the keyframes or of the session."""

import numpy as np
import pytest

from akap_editor.app.timeline.speed_samples import SpeedSamples, sample_times


@pytest.fixture
def keyed(pinned):
    """Keyframes at 0 and 1 second, between which the drawing moves steadily by (30, 40) pixels."""
    state = pinned.state
    state.timeline.is_shown, state.timeline.mode = True, "keyframes"
    pinned.settle()
    playback, rest = state.timeline.keyframe_playback, pinned.session.drawing.mesh.vertices
    playback.set_keyframe(0.0, rest)
    playback.set_keyframe(1.0, rest + np.array([30.0, 40.0]))
    playback.set_default_easing("none")
    return pinned


def test_times_are_few_for_long_motions():
    assert sample_times(1.0) == pytest.approx(np.arange(61) / 60)
    assert len(sample_times(3600.0)) == 601
    assert len(sample_times(0.01)) == 3


@pytest.mark.parametrize("pins", [(), (1,), (1, 3)])
def test_speeds_are_those_of_the_selected_pins_or_of_the_drawing(keyed, pins):
    keyed.state.editor.select(pins)
    samples = SpeedSamples(lambda: 0.0)
    samples.update(keyed.state, keyed.state.timeline.keyframe_playback)
    assert samples.is_complete
    assert samples.pin_count == len(pins)
    np.testing.assert_allclose(samples.speeds, np.full((60, max(len(pins), 1)), 50.0), rtol=1e-6)
    assert samples.highest == pytest.approx(50.0)


def test_they_are_computed_in_slices_and_the_scale_stays_until_all_are_known(keyed):
    now = iter(np.arange(1000.0))
    samples, playback = SpeedSamples(lambda: next(now)), keyed.state.timeline.keyframe_playback
    for count in (1, 2, 3):
        samples.update(keyed.state, playback)
        assert len(samples.speeds) == count
    playback.move_keyframe(1.0, 2.0)
    samples.update(keyed.state, playback)
    assert (len(samples.times), len(samples.speeds)) == (121, 1)
    assert samples.highest == pytest.approx(50.0)
    while not samples.is_complete:
        samples.update(keyed.state, playback)
    assert samples.highest == pytest.approx(25.0)


def test_the_session_has_speeds_too_and_nothing_moves_in_an_empty_one(pinned):
    samples, playback = SpeedSamples(lambda: 0.0), pinned.state.timeline.session_playback
    samples.update(pinned.state, playback)
    assert samples.times == samples.speeds == []
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0] - 20, start[1] - 80))
    samples.update(pinned.state, playback)
    assert samples.is_complete
    assert samples.highest > 0
