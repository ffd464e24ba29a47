"""Loops over faces and edges as machine code; the only caller of numba.

Where numpy would stream a dozen temporary arrays through the caches, a loop reads each face once. Functions
are compiled at their first call, and kept on disk for later runs where a folder for that can be written.
"""

from collections.abc import Callable
from typing import TypeVar

import numba

F = TypeVar("F", bound=Callable[..., object])


def compiled(function: F) -> F:
    """The same function of numbers and arrays, compiled; as in numpy, a division by zero raises nothing.

    Other threads go on meanwhile.
    """
    options = {"nogil": True, "error_model": "numpy"}
    try:
        made: F = numba.njit(function, cache=True, **options)
    except RuntimeError:  # neither the package's folder nor the user's cache can be written
        made = numba.njit(function, **options)
    return made
