"""The deformation method of a document, and its parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...deform.methods import parse_method


@dataclass(frozen=True)
class Settings:
    """How the drawing deforms: a method's name and its parameters, see `deform.deformer.make_deformer`.

    Parameters that are absent have the method's own defaults.
    """

    method: str = "akap"
    parameters: tuple[tuple[str, Any], ...] = (("memory", 1.0),)

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
        settings = cls() if name == cls.method else cls(name, ())
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
