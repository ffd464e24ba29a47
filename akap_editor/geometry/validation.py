"""Array types, and validators of array arguments.

A validator returns the argument as an array of its type, or raises InputError with the argument's name, what
was expected and what came.
"""

import reprlib
from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError, join_with_or

MAX_COORDINATE = 1e9  # pixels; areas of anything farther away could overflow

T = TypeVar("T")

Floats = NDArray[np.float64]
Ints = NDArray[np.signedinteger[Any]]  # int32 in public arrays, int64 where numpy made them
Indices = NDArray[np.uint32]  # in compiled loops, see `geometry.jit`
Complexes = NDArray[np.complex128]


def as_points(value: ArrayLike, name: str, count: int | None = None, columns: int = 2) -> Floats:
    """Copy ``value`` to a finite (n, columns) float64 array; if ``count`` is given, n must equal it.

    Raises InputError on another shape, a dtype that is not real, NaN or infinity.
    """
    array = _as_array(value, name)
    rows = "n" if count is None else str(count)
    if array.size == 0 and count in (None, 0):
        array = array.reshape(0, columns)
    if array.ndim != 2 or array.shape[1] != columns or (count is not None and len(array) != count):
        raise InputError(f"{name}: expected shape ({rows}, {columns}), got {array.shape}")
    if array.dtype.kind not in "fiu":
        raise InputError(f"{name}: expected real numbers, got dtype {array.dtype}")
    array = array.astype(np.float64)
    if not np.isfinite(array).all():
        row = int(np.argmin(np.isfinite(array).all(axis=1)))
        raise InputError(f"{name}: expected finite numbers, got {array[row].tolist()} in row {row}")
    return array


def as_numbers(
    value: ArrayLike,
    name: str,
    count: int,
    low: float = -np.inf,
    high: float = np.inf,
    allow_nan: bool = False,
) -> Floats:
    """Copy ``value`` to a (count,) float64 array of finite numbers from ``low`` to ``high``.

    allow_nan: NaN is valid, too; so is None, which becomes NaN. Raises InputError.
    """
    bounds = "" if np.isinf([low, high]).all() else f" from {low:g} to {high:g}"
    expected = f"{name}: expected {count} numbers{bounds}{' or NaN' if allow_nan else ''}"
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{expected}, got {type(value).__name__}") from error
    if array.shape != (count,):
        raise InputError(f"{expected}, got shape {array.shape}")
    valid = np.isfinite(array) & (array >= low) & (array <= high)
    if allow_nan:
        valid |= np.isnan(array)
    if not valid.all():
        raise InputError(f"{expected}, got {array[~valid][0]:g}")
    return array


def as_number(value: Any, name: str, low: float, high: float) -> float:
    """Return ``value`` as a float from ``low`` to ``high``. Raises InputError."""
    try:
        if isinstance(value, (int, float, np.integer, np.floating)) and low <= value <= high:
            return float(value)
    except OverflowError:  # an integer of hundreds of digits
        pass
    raise InputError(f"{name}: expected a number from {low:g} to {high:g}, got {reprlib.repr(value)}")


def as_choice(value: Any, name: str, choices: Sequence[str]) -> str:
    """Return ``value`` if it is one of the words ``choices``. Raises InputError."""
    if not isinstance(value, str) or value not in choices:
        expected = join_with_or([repr(choice) for choice in choices])
        raise InputError(f"{name}: expected {expected}, got {reprlib.repr(value)}")
    return value


def as_switch(value: Any, name: str) -> bool:
    """Return ``value`` as true or false; 0 and 1 count. Raises InputError."""
    if not isinstance(value, (bool, np.bool_)) and not (isinstance(value, int) and value in (0, 1)):
        raise InputError(f"{name}: expected True or False, got {reprlib.repr(value)}")
    return bool(value)


def as_instance(value: Any, name: str, kind: type[T]) -> T:
    """Return ``value`` if it is an instance of a class. Raises InputError."""
    if not isinstance(value, kind):
        raise InputError(f"{name}: expected a {kind.__name__}, got {reprlib.repr(value)}")
    return value


def as_floats(value: Any, name: str) -> Floats:
    """Return ``value`` as a read-only float64 array of any shape; the same object if it is one.

    Raises InputError if it holds anything but numbers.
    """
    try:
        array = np.asarray(value, dtype=np.float64)
        return freeze(array.copy() if array is value and array.flags.writeable else array)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{name}: expected an array of numbers, got {reprlib.repr(value)}") from error


def as_pixels(value: ArrayLike, name: str, count: int | None = None) -> Floats:
    """`as_points` (n, 2) with coordinates up to `MAX_COORDINATE` pixels. Raises InputError."""
    points = as_points(value, name, count)
    if points.size and np.abs(points).max() > MAX_COORDINATE:
        raise InputError(
            f"{name}: expected coordinates up to {MAX_COORDINATE:g} pixels, got {np.abs(points).max():g}"
        )
    return points


def as_indices(value: ArrayLike, name: str, columns: int | None, limit: int) -> Ints:
    """Copy ``value`` to int32 indices in [0, limit), shape (m, columns), or (m,) if ``columns`` is None.

    Raises InputError on another shape, a dtype that is not an integer one, or an index out of range.
    """
    array = _as_array(value, name)
    expected = "(m,)" if columns is None else f"(m, {columns})"
    if array.size == 0:
        array = array.reshape((0,) if columns is None else (0, columns)).astype(np.int32)
    if array.ndim != (1 if columns is None else 2) or (columns is not None and array.shape[1] != columns):
        raise InputError(f"{name}: expected shape {expected}, got {array.shape}")
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: expected integer indices, got dtype {array.dtype}")
    if array.size and (array.min() < 0 or array.max() >= limit):
        index = int(array.min() if array.min() < 0 else array.max())
        raise InputError(f"{name}: expected indices from 0 to {limit - 1}, got {index}")
    return array.astype(np.int32)


def as_picture(value: Any, name: str) -> NDArray[np.uint8]:
    """Return ``value`` as an RGBA picture (h, w, 4) uint8 with at least one pixel. Raises InputError."""
    image = _as_array(value, name)
    if image.ndim != 3 or image.shape[2] != 4 or image.dtype != np.uint8 or not image.size:
        raise InputError(f"{name}: expected shape (h, w, 4) uint8, got {image.shape} {image.dtype}")
    return image


def as_channel(value: Any, name: str) -> NDArray[np.uint8]:
    """Return ``value`` as one channel (h, w) uint8 with at least one pixel. Raises InputError."""
    channel = _as_array(value, name)
    if channel.ndim != 2 or channel.dtype != np.uint8 or not channel.size:
        raise InputError(f"{name}: expected shape (h, w) uint8, got {channel.shape} {channel.dtype}")
    return channel


def read_only(array: Floats) -> Floats:
    """A view of an array that cannot be written to.

    Compiled functions have a version for arrays that can and one for those that cannot; each is compiled.
    """
    view = array.view()
    view.flags.writeable = False
    return view


def freeze(array: NDArray[Any]) -> NDArray[Any]:
    """Make an array read-only, and contiguous if it is not (then the result is a copy)."""
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array


def _as_array(value: Any, name: str) -> NDArray[Any]:
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as error:
        raise InputError(f"{name}: expected an array of numbers, got {type(value).__name__}") from error
