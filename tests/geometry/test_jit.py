"""Compiled functions: the same results with and without a cache on disk."""

import numba
import numpy as np
import pytest

from akap_editor.geometry import jit


def quotients(above, below):
    result = np.empty(len(above))
    for k in range(len(above)):
        result[k] = above[k] / below[k]
    return result


ABOVE, BELOW = np.array([1.0, -3.0, 2.0]), np.array([4.0, 2.0, 0.0])


@pytest.fixture
def unwritable(monkeypatch):
    """No folder for what is compiled, as for a program of root's that runs without a home."""
    original = numba.njit

    def refuse(function, cache=False, **options):
        if cache:
            raise RuntimeError(f"cannot cache function {function.__name__!r}: no locator available")
        return original(function, **options)

    monkeypatch.setattr(numba, "njit", refuse)


def test_compiled_loops_give_the_same_numbers_and_divide_by_zero_as_numpy_does():
    assert jit.compiled(quotients)(ABOVE, BELOW).tolist() == [0.25, -1.5, np.inf]


def test_loops_are_compiled_where_nothing_can_be_kept(unwritable):
    assert jit.compiled(quotients)(ABOVE, BELOW).tolist() == [0.25, -1.5, np.inf]
