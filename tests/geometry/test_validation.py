"""Checks at the public border: what passes comes out as promised, what does not is named in one sentence."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.validation import (
    as_channel,
    as_choice,
    as_indices,
    as_number,
    as_numbers,
    as_picture,
    as_points,
    freeze,
)


@pytest.mark.parametrize(
    "value", [[[1, 2], [3, 4]], np.array([[1, 2], [3, 4]], dtype=np.uint8), ((1.0, 2), (3, 4))]
)
def test_points_become_float64(value):
    points = as_points(value, "points")
    assert points.dtype == np.float64
    assert points.tolist() == [[1.0, 2.0], [3.0, 4.0]]


def test_points_are_a_copy():
    value = np.zeros((3, 2))
    assert not np.shares_memory(as_points(value, "points"), value)


@pytest.mark.parametrize("empty", [[], np.zeros((0, 2)), np.zeros((0, 3))])
def test_no_points(empty):
    assert as_points(empty, "points").shape == (0, 2)
    assert as_points(empty, "weights", 0, columns=3).shape == (0, 3)
    with pytest.raises(InputError, match=r"points: expected shape \(2, 2\), got "):
        as_points(empty, "points", 2)


@pytest.mark.parametrize("value", [None, 3.0, "points", [[1, 2], [3]], [[True, False]], [[1j, 0]], {"x": 1}])
def test_what_is_no_array_of_points_is_refused(value):
    with pytest.raises(InputError, match=r"^handles: expected "):
        as_points(value, "handles")


def test_indices_become_int32():
    for value in ([0, 4], np.array([0, 4], dtype=np.uint64), (0, 4)):
        indices = as_indices(value, "faces", None, 5)
        assert indices.dtype == np.int32
        assert indices.tolist() == [0, 4]
    assert as_indices([], "faces", 3, 0).shape == (0, 3)
    assert as_indices([], "faces", None, 0).shape == (0,)


@pytest.mark.parametrize("bad", [5, -1, 2**40])
def test_first_and_last_index_are_the_limits(bad):
    with pytest.raises(InputError, match=f"faces: expected indices from 0 to 4, got {bad}"):
        as_indices([0, bad, 4], "faces", None, 5)


def test_numbers():
    for value in (0, 1, 0.5, np.float32(0.25), np.int64(1)):
        assert as_number(value, "share", 0, 1) == value
        assert type(as_number(value, "share", 0, 1)) is float


@pytest.mark.parametrize("value", [-1e-9, 1.1, np.nan, np.inf, None, "0.5", [0.5], 1j])
def test_what_is_no_number_in_the_range_is_refused(value):
    with pytest.raises(InputError, match="share: expected a number from 0 to 1, got "):
        as_number(value, "share", 0, 1)


def test_arrays_of_numbers_are_copied_to_float64():
    value = np.array([1, 5, 3], dtype=np.int16)
    numbers = as_numbers(value, "stiffness", 3, 1, 5)
    assert numbers.dtype == np.float64
    assert numbers.tolist() == [1.0, 5.0, 3.0]
    same = np.array([1.0, 2.0])
    assert not np.shares_memory(as_numbers(same, "stiffness", 2), same)
    assert as_numbers([], "angles", 0).shape == (0,)
    assert np.isnan(as_numbers([0.5, None, np.nan], "angles", 3, allow_nan=True)).tolist() == [
        False,
        True,
        True,
    ]


@pytest.mark.parametrize("value", [[1.0], [1, 2, 3], [[1, 2]], [0.5, 2], [1, 5.5], [1, np.nan], [1, np.inf]])
def test_numbers_of_another_count_or_out_of_range_are_refused(value):
    with pytest.raises(InputError, match=r"^stiffness: expected 2 numbers from 1 to 5, got "):
        as_numbers(value, "stiffness", 2, 1, 5)


@pytest.mark.parametrize("value", ["many", [1, "a"], [1, [2, 3]], 1j, {"x": 1}, [np.inf, 0.0]])
def test_what_are_no_finite_numbers_is_refused(value):
    with pytest.raises(InputError, match=r"^angles: expected 2 numbers or NaN, got "):
        as_numbers(value, "angles", 2, allow_nan=True)


@pytest.mark.parametrize(
    "value", [np.zeros((2, 3, 3), np.uint8), np.zeros((2, 3, 4)), np.zeros((0, 3, 4), np.uint8), [[1]], "a"]
)
def test_pictures_have_four_channels_of_bytes(value):
    picture = np.zeros((2, 3, 4), dtype=np.uint8)
    assert as_picture(picture, "image") is picture
    with pytest.raises(InputError, match=r"^image: expected shape \(h, w, 4\) uint8, got \("):
        as_picture(value, "image")


@pytest.mark.parametrize("value", [np.zeros((2, 3)), np.zeros((0, 3), np.uint8), np.zeros(3, np.uint8), None])
def test_channels_are_two_dimensional_bytes(value):
    channel = np.zeros((2, 3), dtype=np.uint8)
    assert as_channel(channel, "mask") is channel
    with pytest.raises(InputError, match=r"^mask: expected shape \(h, w\) uint8, got \("):
        as_channel(value, "mask")


def test_frozen_arrays_cannot_be_written():
    array = freeze(np.zeros((2, 4))[:, ::2])
    assert array.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1.0


@pytest.mark.parametrize(
    ("choices", "expected"),
    [(["soft"], "'soft'"), (["soft", "hard"], "'soft' or 'hard'"), (["a", "b", "c"], "'a', 'b' or 'c'")],
)
def test_words_outside_a_choice_are_refused_with_all_of_them(choices, expected):
    assert as_choice(choices[-1], "kind", choices) == choices[-1]
    for value in ("other", None, 3, [choices[0]]):
        with pytest.raises(InputError, match=f"^kind: expected {expected}, got "):
            as_choice(value, "kind", choices)
