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
from ...words import mark, tr

Json = dict[str, Any]
T = TypeVar("T", bool, int, str, list[Any], Json)

_TYPE_NAMES = {
    bool: mark("true or false"),
    int: mark("an integer"),
    str: mark("a text"),
    list: mark("a list"),
    dict: mark("an object"),
}


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
        raise InputError(tr("expected JSON in UTF-8, got something else")) from error
    if not isinstance(record, dict):
        raise InputError(tr("expected an object, got {value}", value=reprlib.repr(record)))
    return record


def optional(record: Json, name: str, kind: type[T], default: T) -> T:
    """The value of a key, of exactly this type; ``default`` if there is no such key. Raises InputError."""
    return require(record, name, kind) if name in record else default


def require(record: Json, name: str, kind: type[T]) -> T:
    """The value of a key, of exactly this type. Raises InputError if it is missing or of another type."""
    if name not in record:
        raise InputError(
            tr("expected {name} to be {kind}, but it is missing", name=name, kind=tr(_TYPE_NAMES[kind]))
        )
    value = record[name]
    if type(value) is not kind:  # isinstance would take true for an integer
        raise InputError(
            tr(
                "expected {name} to be {kind}, got {value}",
                name=name,
                kind=tr(_TYPE_NAMES[kind]),
                value=reprlib.repr(value),
            )
        )
    return value


def numbers(values: Any, name: str) -> Floats:
    """A list of numbers as an array. Raises InputError."""
    if type(values) is not list or not all(type(value) in (int, float) for value in values):
        raise InputError(
            tr("expected {name} to be numbers, got {value}", name=name, value=reprlib.repr(values))
        )
    return np.array(values, dtype=np.float64)


def pairs(values: list[Any], name: str) -> Floats:
    """A list of pairs of numbers as an array (n, 2). Raises InputError."""
    if not all(type(pair) is list and len(pair) == 2 for pair in values):
        raise InputError(
            tr("expected {name} to be pairs of numbers, got {value}", name=name, value=reprlib.repr(values))
        )
    return numbers(list(chain.from_iterable(values)), name).reshape(-1, 2)


def file_version(record: Json, expected: str) -> int:
    """The version of a record in the format ``expected``. Raises InputError on one of another format."""
    if require(record, "format", str) != expected:
        raise InputError(
            tr(
                "expected format {expected!r}, got {value}",
                expected=expected,
                value=reprlib.repr(record["format"]),
            )
        )
    version = require(record, "version", int)
    if version < 1:
        raise InputError(tr("expected a version from 1, got {version}", version=version))
    return version


def refuse_newer(version: int, newest: int) -> None:
    """Raise InputError if a file has a newer version than this program knows."""
    if version > newest:
        raise InputError(
            tr(
                "the file was written by a newer version of the program (file version {version}, "
                "this program reads up to {newest}); update akap-editor to open it",
                version=version,
                newest=newest,
            )
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
        raise InputError(
            tr("expected each key once, got one of {value} twice", value=reprlib.repr(list(record)))
        )
    return record
