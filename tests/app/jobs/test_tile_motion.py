"""The motions of the tiles of the start page."""

import math

import numpy as np
import pytest

from akap_editor.app.jobs.background_thread import no_window
from akap_editor.app.jobs.tile_motion import FRAMES_PER_SECOND, TileMotion, TileMotions, recorded_motion
from akap_editor.geometry.mesh import signed_areas
from akap_editor.layers.drawing_layer import shown_layers
from akap_editor.resources import bundled_files, resource

PATHS = {path.stem: path for path in bundled_files()}


@pytest.fixture(scope="module")
def raptor():
    return PATHS["raptor"]


@pytest.fixture(scope="module", params=["raptor", "robot", "rope"])
def motion(request):
    return recorded_motion(PATHS[request.param])


def test_every_bundled_drawing_has_a_recording():
    recordings = {path.stem for path in resource("assets", "recordings").glob("*.akaprec")}
    assert set(PATHS) <= recordings


def test_the_robot_talks():
    frames = recorded_motion(PATHS["robot"]).frames
    shown = {tuple(shown_layers(frame.drawing.layers).tolist()) for frame in frames}
    assert len(shown) == 4  # mouths


def test_it_starts_at_rest_moves_and_flips_nothing(motion):
    first, poses = motion.frames[0], np.array([frame.pose for frame in motion.frames])
    assert (first.pose == first.drawing.mesh.vertices).all()
    assert np.abs(poses - first.pose).max() > 0.05 * max(first.drawing.size)
    for frame in motion.frames[:: len(motion.frames) // 8]:
        assert (signed_areas(frame.pose, frame.drawing.mesh.faces) > 0).all()


def test_it_plays_forwards_and_back(motion):
    count = len(motion.frames)
    ids = [id(frame) for frame in motion.frames]
    numbers = [
        ids.index(id(motion.frame(number / FRAMES_PER_SECOND + 1e-6))) for number in (0, 1, count - 1, count)
    ]
    assert numbers == [0, 1, count - 1, count - 2]
    assert TileMotion(motion.frames[:1]).frame(1.0) is motion.frames[0]


def test_without_a_recording_there_is_no_motion(tmp_path):
    assert recorded_motion(tmp_path / "unknown.png").frames == ()
    assert TileMotions().frame(tmp_path / "unknown.png", no_window) is None


def test_it_starts_anew_when_the_pointer_comes_back(raptor):
    clock = iter((0.0, 0.0, 5.0, 7.0, 7.0))
    motions = TileMotions(lambda: next(clock))
    while (first := motions.frame(raptor, no_window)) is None:
        pass
    later = motions.frame(raptor, no_window)
    motions.stop(raptor)
    again = motions.frame(raptor, no_window)
    assert again is first
    assert later is not first
    assert math.isfinite(later.pose.sum())
