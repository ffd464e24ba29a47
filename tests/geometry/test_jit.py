"""Compiled functions: the same results with and without a cache on disk; numbers kept as halves."""

import sys
from concurrent.futures import ThreadPoolExecutor

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


def test_nothing_is_compiled_where_it_must_not_be(unwritable):
    function = jit.compiled(quotients)
    with jit.only_compiled(), pytest.raises(jit.NotCompiledError):
        function(ABOVE, BELOW)
    with jit.only_compiled(), ThreadPoolExecutor(1) as other_thread:
        assert other_thread.submit(function, ABOVE, BELOW).result()[0] == 0.25
    with jit.only_compiled():
        assert function(ABOVE, BELOW)[0] == 0.25, "it is compiled by now"


def test_threads_pass_on_the_lock_sooner_only_for_a_while():
    before = sys.getswitchinterval()
    with jit.yielding_lock():
        assert sys.getswitchinterval() < before
    assert sys.getswitchinterval() == before


@jit.compiled
def pack(values, result):
    for k in range(len(values)):
        result[k] = jit.packed(values[k], result)


by_hardware, by_integers = jit.unpacked, jit.make_unpacked(False)


@jit.compiled
def unpack(values, result):
    for k in range(len(values)):
        result[k] = by_hardware(values[k])


@jit.compiled
def unpack_by_integers(values, result):
    for k in range(len(values)):
        result[k] = by_integers(values[k])


@pytest.mark.parametrize("unpack", [unpack, unpack_by_integers])
def test_halves_are_those_of_numpy(unpack):
    generator = np.random.default_rng(1)
    sizes = 10 ** generator.uniform(np.log10(6.2e-5), np.log10(65000), 1000)
    values = (sizes * generator.choice([-1, 1], 1000)).astype(np.float32)
    halves, result = np.zeros(1000, np.uint16), np.zeros(1000, np.float32)
    pack(values, halves)
    unpack(halves, result)
    expected = values.astype(np.float16).astype(np.float32)
    assert (np.abs(result - values) <= 2.0**-11 * np.abs(values)).all()
    assert (result == expected).mean() > 0.99  # ties are rounded away from zero


@pytest.mark.parametrize("unpack", [unpack, unpack_by_integers])
def test_what_is_too_small_becomes_zero(unpack):
    halves, result = np.ones(4, np.uint16), np.ones(4, np.float32)
    pack(np.array([0, 1e-9, -6e-5, 1e-40], np.float32), halves)
    unpack(halves, result)
    assert (result == 0).all()


def test_other_numbers_are_kept_as_they_are():
    values, kept, result = np.array([1 / 3, -1e-300, 1e300]), np.zeros(3), np.zeros(3)
    pack(values, kept)
    unpack(kept, result)
    assert (kept == values).all()
    assert (result == values).all()


def long_sum(values, factors):
    """Too long to be inlined without being asked for."""
    total = 0.0
    for k in range(len(values)):
        total += values[k] * factors[k]
    for k in range(1, len(values)):
        total += values[k] * factors[k - 1]
    for k in range(2, len(values)):
        total += np.sqrt(values[k]) * factors[k - 2] + np.exp(values[k - 1] * factors[k])
    for k in range(3, len(values)):
        total += np.sin(values[k]) * factors[k - 3] + np.cos(values[k - 2] * factors[k - 1])
    return total


def test_calls_are_inlined_so_that_a_first_run_sums_as_later_ones(unwritable):
    """Otherwise a function has a copy of its own and one in its caller, optimized differently."""
    called = jit.compiled_with_fast_sums(long_sum)

    def three_sums(values, factors):
        return called(values, factors) + 2 * called(factors, values) + 3 * called(values, values)

    caller = jit.compiled(three_sums)
    assert np.isfinite(caller(ABOVE, BELOW + 1))
    (machine_code,) = caller.inspect_asm().values()
    uses = [line for line in machine_code.splitlines() if "long_sum" in line and "NumbaEnv" not in line]
    assert not uses
