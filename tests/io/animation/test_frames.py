"""Frames in memory on their way into a file."""

import tracemalloc

import numpy as np
import pytest

from akap_editor.io.animation.formats import write_animation
from akap_editor.io.animation.frames import PackedFrames, bounding_box

COUNT, SIDE = 60, 160


def moving_square():
    """Frames of one size, all in one array."""
    canvas = np.zeros((SIDE, SIDE, 4), np.uint8)
    for number in range(COUNT):
        canvas[...] = 0
        canvas[number : number + 60, 40:120] = (200, 4 * number, 30, 255)
        yield canvas


@pytest.mark.parametrize("dtype", [np.uint8, np.int32])
def test_packed_frames_come_back_as_they_were(dtype):
    frames = [np.random.default_rng(seed).integers(0, 200, (7, 5, 4)).astype(dtype) for seed in range(3)]
    packed = PackedFrames()
    for frame in frames:
        packed.append(frame[:, ::-1])  # in no order of its own
    assert len(packed) == 3
    for came, frame in zip(packed, frames, strict=True):
        assert came.dtype == dtype
        np.testing.assert_array_equal(came, frame[:, ::-1])
    np.testing.assert_array_equal(packed[1:], [frame[:, ::-1] for frame in frames[1:]])


@pytest.mark.parametrize(
    ("suffix", "share"), [(".webp", 0.2), (".apng", 0.2), (".png", 0.4), (".mp4", 0.2), (".webm", 0.2)]
)
def test_few_frames_are_in_memory_at_once(tmp_path, suffix, share):
    """Otherwise 200 frames of 1000 x 1000 pixels would take gigabytes. Of a sheet it is a row of sprites."""
    if suffix in (".mp4", ".webm"):
        pytest.importorskip("av")
    write_animation(tmp_path / f"a{suffix}", moving_square(), 25, sheet=suffix == ".png")  # imports
    tracemalloc.start()
    try:
        write_animation(tmp_path / f"a{suffix}", moving_square(), 25, sheet=suffix == ".png", overwrite=True)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < share * COUNT * SIDE * SIDE * 4


def test_the_bounding_box_of_a_mask():
    mask = np.zeros((9, 7), dtype=bool)
    assert bounding_box(mask) == (0, 0, 1, 1)
    mask[2, 3] = mask[5, 1] = True
    assert bounding_box(mask) == (1, 2, 4, 6)
