"""Checks of array arguments at the public border: what was expected, what came."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.signedinteger[Any]]  # int32 where public, int64 where it came out of numpy
Complexes = NDArray[np.complex128]


def _array(value: Any, name: str) -> NDArray[Any]:
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as error:
        raise InputError(f"{name}: expected an array of numbers, got {type(value).__name__}") from error


def as_points(value: ArrayLike, name: str, count: int | None = None, columns: int = 2) -> Floats:
    """A copy of ``value`` as a finite (n, columns) float64 array; n must equal ``count`` where given.

    Raises InputError on a wrong shape, a dtype that is not a real one, or NaN and infinity.
    """
    array = _array(value, name)
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


def as_indices(value: ArrayLike, name: str, columns: int | None, limit: int) -> Ints:
    """``value`` as int32 indices in [0, limit), shape (m, columns), or (m,) if ``columns`` is None.

    Raises InputError on a wrong shape, a dtype that is not an integer one, or an index out of range.
    """
    array = _array(value, name)
    wanted = "(m,)" if columns is None else f"(m, {columns})"
    if array.size == 0:
        array = array.reshape((0,) if columns is None else (0, columns)).astype(np.int32)
    if array.ndim != (1 if columns is None else 2) or (columns is not None and array.shape[1] != columns):
        raise InputError(f"{name}: expected shape {wanted}, got {array.shape}")
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: expected integer indices, got dtype {array.dtype}")
    if array.size and (array.min() < 0 or array.max() >= limit):
        bad = int(array.min() if array.min() < 0 else array.max())
        raise InputError(f"{name}: expected indices from 0 to {limit - 1}, got {bad}")
    return array.astype(np.int32)


def as_number(value: Any, name: str, low: float, high: float) -> float:
    """``value`` as a float from ``low`` to ``high``. Raises InputError."""
    if not isinstance(value, (int, float, np.integer, np.floating)) or not low <= value <= high:
        raise InputError(f"{name}: expected a number from {low:g} to {high:g}, got {value!r}")
    return float(value)


def frozen(array: NDArray[Any]) -> NDArray[Any]:
    """The array itself, made read-only and contiguous."""
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array
