"""Just-in-time compilation of loops over faces and edges; the only importer of numba.

In numpy such a loop would write and read a dozen temporary arrays; compiled, it reads each face once.
Indices of vertices, edges and nonzeros are passed as uint32: for a signed type, each access would also handle
negative indices, which count from the end.
"""

import platform
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import numba
from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba.core import event, types
from numba.extending import intrinsic

F = TypeVar("F", bound=Callable[..., object])

_FAST_SUMS = {"reassoc", "nsz", "contract"}
_has_cache = threading.Event()
_has_cache.set()


def compiled(function: F) -> F:
    """Compile a function of numbers and arrays when it is first called.

    The machine code is cached on disk if a folder for it is writable. Division by zero gives infinity or NaN,
    as in numpy. Other threads run meanwhile, because the function releases the global interpreter lock.
    """
    return _compile(function)


def compiled_with_fast_sums(function: F) -> F:
    """Like `compiled`, but sums may be reordered, which lets scalar products be vectorized.

    Compiled functions that call this one inline it. Otherwise it would have two copies in the run that
    compiles it, one of its own and one in the caller that is cached; optimized apart, they may sum in other
    orders. So functions between this one and one that Python calls must be compiled like this, too.
    """
    return _compile(function, fastmath=_FAST_SUMS, forceinline=True)


def _compile(function: F, **options: Any) -> F:
    options |= {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    try:
        machine_code: F = numba.njit(function, cache=True, **options)
    except RuntimeError:  # neither the package's folder nor the user's cache is writable
        _has_cache.clear()
        machine_code = numba.njit(function, **options)
    return machine_code


class NotCompiledError(Exception):
    """A function is not in the cache on disk, and would have to be compiled."""


@contextmanager
def only_compiled() -> Iterator[None]:
    """Raise NotCompiledError in the block, in this thread, instead of compiling a function."""
    thread = threading.get_ident()

    class Refusal(event.Listener):
        def on_start(self, event: event.Event) -> None:
            if threading.get_ident() == thread:
                raise NotCompiledError

        def on_end(self, event: event.Event) -> None:
            pass

    with event.install_listener("numba:compile", Refusal()):
        yield


def keeps_machine_code() -> bool:
    """Whether there is a folder in which compiled functions are kept for other processes."""
    return _has_cache.is_set()


@contextmanager
def yielding_lock(seconds: float = 5e-4) -> Iterator[None]:
    """Let threads that compute in the block pass on Python's lock that soon, so that a window can go on."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(seconds)
    try:
        yield
    finally:
        sys.setswitchinterval(before)


_MIN_HALF = 2.0**-14  # smallest half that is not denormal
_BIAS = 112  # difference between the biases of the exponents of float32 and halves
_WORD, _SINGLE = ir.IntType(32), ir.FloatType()


@intrinsic
def packed(_: Any, value: Any, array: Any) -> Any:
    """A number in the form in which ``array`` keeps it: float32 in an array of uint16 as an IEEE half.

    Halves have 11 bits of precision. Numbers below 6e-5 become zero; those above 65504 must not occur.
    """
    if array.dtype != types.uint16:
        return value(value, array), lambda _, __, ___, arguments: arguments[0]

    def generate(_: Any, builder: Any, __: Any, arguments: Any) -> Any:
        bits = builder.bitcast(arguments[0], _WORD)
        magnitude = builder.and_(bits, _WORD(0x7FFFFFFF))
        sign = builder.lshr(builder.xor(bits, magnitude), _WORD(16))
        is_zero = builder.fcmp_ordered("<", builder.bitcast(magnitude, _SINGLE), _SINGLE(_MIN_HALF))
        rounded = builder.add(magnitude, _WORD(0x1000 - (_BIAS << 23)))
        half = builder.select(is_zero, _WORD(0), builder.lshr(rounded, _WORD(13)))
        return builder.trunc(builder.or_(sign, half), ir.IntType(16))

    return types.uint16(types.float32, array), generate


def make_unpacked(by_hardware: bool) -> Any:
    """`unpacked`, with the processor's own conversion or, on any processor, with integer operations."""

    @intrinsic
    def unpacked(_: Any, value: Any) -> Any:
        """The number that an array keeps as ``value``: float32 if that is a half, see `packed`."""
        if value != types.uint16:
            return value(value), lambda _, __, ___, arguments: arguments[0]

        def generate(_: Any, builder: Any, __: Any, arguments: Any) -> Any:
            if by_hardware:
                return builder.fpext(builder.bitcast(arguments[0], ir.HalfType()), _SINGLE)
            bits = builder.zext(arguments[0], _WORD)
            sign = builder.shl(builder.and_(bits, _WORD(0x8000)), _WORD(16))
            magnitude = builder.shl(builder.and_(bits, _WORD(0x7FFF)), _WORD(13))
            return builder.fmul(builder.bitcast(builder.or_(sign, magnitude), _SINGLE), _SINGLE(2.0**_BIAS))

        return types.float32(types.uint16), generate

    return unpacked


# All processors since 2013 convert halves; a missing instruction would be a call of a missing function.
unpacked = make_unpacked(
    platform.machine().lower() in ("arm64", "aarch64") or get_host_cpu_features().get("f16c", False)
)
