"""Numbers of JSON that is not to be trusted: finite, and integers that a float64 holds exactly."""

import math
import reprlib
from typing import NoReturn

from ..errors import InputError

MAX_INTEGER = 2**53


def bounded_integer(digits: str) -> int:
    """Read an integer of up to `MAX_INTEGER`, for ``parse_int`` of `json.loads`. Raises InputError."""
    if len(digits) > 17 or abs(int(digits)) > MAX_INTEGER:
        raise InputError(f"expected integers up to {MAX_INTEGER}, got {reprlib.repr(digits)}")
    return int(digits)


def finite_float(digits: str) -> float:
    """Read a finite number, for ``parse_float`` of `json.loads`. Raises InputError, e.g. on 1e999."""
    value = float(digits)
    if not math.isfinite(value):
        raise InputError(f"expected finite numbers, got {reprlib.repr(digits)}")
    return value


def refuse_constant(name: str) -> NoReturn:
    """Refuse NaN and Infinity, for ``parse_constant`` of `json.loads`. Raises InputError."""
    raise InputError(f"expected finite numbers, got {name}")
