"""Just-in-time compilation of loops over faces and edges; the only importer of numba.

In numpy such a loop would write and read a dozen temporary arrays; compiled, it reads each face once.
Indices of vertices, edges and nonzeros are passed as uint32: for a signed type, each access would also handle
negative indices, which count from the end.
"""

from collections.abc import Callable
from typing import TypeVar

import numba

F = TypeVar("F", bound=Callable[..., object])


def compiled(function: F) -> F:
    """Compile a function of numbers and arrays when it is first called.

    The machine code is cached on disk if a folder for it is writable. Division by zero gives infinity or NaN,
    as in numpy. Other threads run meanwhile, because the function releases the global interpreter lock.
    """
    return _compile(function, False)


def compiled_with_fast_sums(function: F) -> F:
    """Like `compiled`, but sums may be reordered, which lets scalar products be vectorized."""
    return _compile(function, {"reassoc", "nsz", "contract"})


def _compile(function: F, fastmath: bool | set[str]) -> F:
    options = {"nogil": True, "error_model": "numpy", "fastmath": fastmath}
    try:
        machine_code: F = numba.njit(function, cache=True, **options)
    except RuntimeError:  # neither the package's folder nor the user's cache is writable
        machine_code = numba.njit(function, **options)
    return machine_code
