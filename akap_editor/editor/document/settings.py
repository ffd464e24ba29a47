"""The deformation method of a drawing, and its parameters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...deform.methods import parse_method


@dataclass(frozen=True)
class Settings:
    """How the drawing bends: the method's name and its parameters (see `deform.deformer.make_deformer`)."""

    method: str = "akap"
    parameters: tuple[tuple[str, Any], ...] = (("memory", 1.0),)

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
        settings = cls() if name == cls.method else cls(name, ())
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
