"""The deformation method of a drawing, and its parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...deform.methods import DEFAULT_METHOD, get_method, parse_method


def _document_defaults(method: str) -> tuple[tuple[str, Any], ...]:
    return tuple(sorted(get_method(method).document_defaults.items()))


@dataclass(frozen=True)
class Settings:
    """How the drawing bends: the method's name and its parameters (see `deform.methods.make_deformer`)."""

    method: str = DEFAULT_METHOD
    parameters: tuple[tuple[str, Any], ...] = _document_defaults(DEFAULT_METHOD)

    def get(self, name: str, default: Any = None) -> Any:
        """The value of one parameter, or ``default`` where it is left to the method."""
        return dict(self.parameters).get(name, default)

    def with_parameter(self, name: str, value: Any) -> "Settings":
        """These settings with one parameter changed."""
        return replace(self, parameters=tuple(sorted({**dict(self.parameters), name: value}.items())))

    @classmethod
    def of(cls, spec: str) -> "Settings":
        """The editor's settings of a method, with what ``spec`` says of it (see `parse_method`).

        Raises InputError.
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
        """Read what `to_json` wrote; parameters in the order of their names. Raises KeyError, TypeError."""
        return cls(str(record["method"]), tuple(sorted(dict(record["parameters"]).items())))
