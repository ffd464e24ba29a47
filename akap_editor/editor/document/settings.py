"""The deformation method of a document, and its parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...deform.methods import DEFAULT_METHOD, get_method, parse_method


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

    def to_json(self) -> dict[str, Any]:
        """The settings as an object of a document or recording; docs/file-format.md describes it."""
        return {"method": self.method, "parameters": dict(self.parameters)}

    @classmethod
    def from_json(cls, record: Mapping[str, Any]) -> "Settings":
        """Read the object of `to_json`; sorts parameters by name. Raises KeyError, TypeError, ValueError."""
        return cls(str(record["method"]), tuple(sorted(dict(record["parameters"]).items())))
