"""Reads untrusted JSON strictly: no duplicate keys, no type conversion, only finite numbers."""

import json
import reprlib
from importlib import metadata
from itertools import chain
from typing import Any, TypeVar

import numpy as np

from ...errors import InputError
from ...geometry.json_numbers import bounded_integer, finite_float, refuse_constant
from ...geometry.validation import Floats

Json = dict[str, Any]
T = TypeVar("T", bool, int, str, list[Any], Json)

_TYPE_NAMES = {bool: "true or false", int: "an integer", str: "a text", list: "a list", dict: "an object"}


def parse_record(text: bytes) -> Json:
    """The JSON object in a UTF-8 text.

    Raises InputError, and nothing else, also for duplicate keys, numbers that are not finite, and integers
    above `MAX_INTEGER`.
    """
    try:
        record = json.loads(
            text.decode(),
            object_pairs_hook=_object,
            parse_int=bounded_integer,
            parse_float=finite_float,
            parse_constant=refuse_constant,
        )
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputError("expected JSON in UTF-8, got something else") from error
    if not isinstance(record, dict):
        raise InputError(f"expected an object, got {reprlib.repr(record)}")
    return record


def optional(record: Json, name: str, kind: type[T], default: T) -> T:
    """The value of a key, of exactly this type; ``default`` if there is no such key. Raises InputError."""
    return require(record, name, kind) if name in record else default


def require(record: Json, name: str, kind: type[T]) -> T:
    """The value of a key, of exactly this type. Raises InputError if it is missing or of another type."""
    if name not in record:
        raise InputError(f"expected {name} to be {_TYPE_NAMES[kind]}, but it is missing")
    value = record[name]
    if type(value) is not kind:  # isinstance would take true for an integer
        raise InputError(f"expected {name} to be {_TYPE_NAMES[kind]}, got {reprlib.repr(value)}")
    return value


def numbers(values: Any, name: str) -> Floats:
    """A list of numbers as an array. Raises InputError."""
    if type(values) is not list or not all(type(value) in (int, float) for value in values):
        raise InputError(f"expected {name} to be numbers, got {reprlib.repr(values)}")
    return np.array(values, dtype=np.float64)


def pairs(values: list[Any], name: str) -> Floats:
    """A list of pairs of numbers as an array (n, 2). Raises InputError."""
    if not all(type(pair) is list and len(pair) == 2 for pair in values):
        raise InputError(f"expected {name} to be pairs of numbers, got {reprlib.repr(values)}")
    return numbers(list(chain.from_iterable(values)), name).reshape(-1, 2)


def file_version(record: Json, expected: str) -> int:
    """The version of a record in the format ``expected``. Raises InputError on one of another format."""
    if require(record, "format", str) != expected:
        raise InputError(f"expected format {expected!r}, got {reprlib.repr(record['format'])}")
    version = require(record, "version", int)
    if version < 1:
        raise InputError(f"expected a version from 1, got {version}")
    return version


def refuse_newer(version: int, newest: int) -> None:
    """Raise InputError if a file has a newer version than this program knows."""
    if version > newest:
        raise InputError(
            f"the file was written by a newer version of the program (file version {version}, "
            f"this program reads up to {newest}); update akap-editor to open it"
        )


def program_name() -> str:
    """Name and version of the program, for files; readers ignore it."""
    try:
        return f"akap-editor {metadata.version('akap-editor')}"
    except metadata.PackageNotFoundError:  # a checkout without installation
        return "akap-editor"


def _object(pairs: list[tuple[str, Any]]) -> Json:
    record = dict(pairs)
    if len(record) < len(pairs):
        raise InputError(f"expected each key once, got one of {reprlib.repr(list(record))} twice")
    return record
