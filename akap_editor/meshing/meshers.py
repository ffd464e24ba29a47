"""The programs that triangulate outlines, and which of them are installed."""

import reprlib
from functools import cache
from importlib.util import find_spec
from typing import Any

from ..errors import InputError
from ..words import tr

TRIANGLE, PYTHONCDT = "triangle", "pythoncdt"
MESHERS = {TRIANGLE: "Triangle", PYTHONCDT: "PythonCDT"}  # in order of preference, with their titles


@cache
def installed_meshers() -> tuple[str, ...]:
    """The names of the installed meshers, the default one first."""
    return tuple(name for name in MESHERS if find_spec(name) is not None)


def default_mesher() -> str:
    """The mesher of new drawings: Triangle where it is installed, else PythonCDT.

    Raises InputError if neither is.
    """
    if not installed_meshers():
        raise InputError(tr("no mesher is installed; install one with: pip install pythoncdt"))
    return installed_meshers()[0]


def check_known(name: Any) -> str:
    """Return the name of a mesher, installed or not. Raises InputError on other values."""
    if not isinstance(name, str) or name not in MESHERS:
        raise InputError(
            tr(
                "mesher: expected one of {names}, got {name}",
                names=", ".join(MESHERS),
                name=reprlib.repr(name),
            )
        )
    return name


def check_mesher(name: str | None) -> str:
    """Return the name of an installed mesher, the default one for None. Raises InputError."""
    if name is None:
        return default_mesher()
    if check_known(name) not in installed_meshers():
        raise InputError(
            tr(
                "{mesher} is not installed; install it with: pip install {name}",
                mesher=MESHERS[name],
                name=name,
            )
        )
    return name


def nearest_mesher(name: str) -> str:
    """The mesher of that name if it is installed, else the default one."""
    return name if name in installed_meshers() else default_mesher()
