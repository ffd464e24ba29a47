"""Checks at the public border: what passes comes out as promised, what does not is named in one sentence."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.validation import as_indices, as_number, as_points, frozen


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


def test_frozen_arrays_cannot_be_written():
    array = frozen(np.zeros((2, 4))[:, ::2])
    assert array.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1.0
