"""The deformation method of a document, and its parameters."""

import math
import reprlib
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...deform.methods import DEFAULT_METHOD, get_method, parse_method
from ...errors import InputError
from ...geometry.json_numbers import MAX_INTEGER
from ...words import tr


def _document_defaults(method: str) -> tuple[tuple[str, Any], ...]:
    return tuple(sorted(get_method(method).document_defaults.items()))


@dataclass(frozen=True)
class Settings:
    """How the drawing deforms: a method's name and its parameters, see `deform.methods.make_deformer`.

    Parameters that are absent have the method's own defaults.
    """

    method: str = DEFAULT_METHOD
    parameters: tuple[tuple[str, Any], ...] = _document_defaults(DEFAULT_METHOD)

    def get(self, name: str, default: Any = None) -> Any:
        """The value of a parameter, ``default`` if it is absent."""
        return dict(self.parameters).get(name, default)

    def with_parameter(self, name: str, value: Any) -> "Settings":
        """These settings with one parameter changed or added."""
        return replace(self, parameters=tuple(sorted({**dict(self.parameters), name: value}.items())))

    @classmethod
    def parse(cls, spec: str) -> "Settings":
        """Read settings from a text such as "akap:memory=0.5", see `parse_method`.

        Parameters that are absent have the editor's defaults. Raises InputError.
        """
        name, parameters = parse_method(spec)
        settings = cls(name, _document_defaults(name))
        for parameter, value in parameters.items():
            settings = settings.with_parameter(parameter, value)
        return settings

    def check(self) -> None:
        """Check that the settings can be written to a file.

        Raises InputError on a parameter that occurs twice, or a value that is not a text, a finite number,
        true, false or None.
        """
        for name, value in self.parameters:
            _check_parameter(name, value)
        for name, count in Counter(name for name, _ in self.parameters).items():
            if count > 1:
                raise InputError(
                    tr(
                        "expected each parameter once, got parameter {name} {count} times",
                        name=reprlib.repr(name),
                        count=count,
                    )
                )

    def to_json(self) -> dict[str, Any]:
        """The settings as an object of a document or recording; docs/file-format.md describes it."""
        return {"method": self.method, "parameters": dict(self.parameters)}

    @classmethod
    def from_json(cls, record: Mapping[str, Any]) -> "Settings":
        """Read the object of `to_json`; sorts parameters by name. Raises KeyError, TypeError, ValueError."""
        return cls(str(record["method"]), tuple(sorted(dict(record["parameters"]).items())))


def _check_parameter(name: str, value: object) -> None:
    if not isinstance(name, str) or not isinstance(value, bool | int | float | str | None):
        actual = f"{type(value).__name__} for {reprlib.repr(name)}"
        raise InputError(
            tr(
                "parameters: expected names and numbers, texts, true, false or null, got {actual}",
                actual=actual,
            )
        )
    if isinstance(value, float) and not math.isfinite(value):
        raise InputError(
            tr(
                "parameter {name}: expected a finite number, got {value}",
                name=reprlib.repr(name),
                value=value,
            )
        )
    if isinstance(value, int) and abs(value) > MAX_INTEGER:
        expected, actual = (
            tr("an integer up to {most}", most=MAX_INTEGER),
            tr("one of {bits} bits", bits=value.bit_length()),
        )
        raise InputError(
            tr(
                "parameter {name}: expected {expected}, got {actual}",
                name=reprlib.repr(name),
                expected=expected,
                actual=actual,
            )
        )
