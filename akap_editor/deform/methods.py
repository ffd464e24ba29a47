"""Names for methods with settings: what a person types, and the choices that are worth one of their own."""

import inspect
from dataclasses import dataclass
from typing import Any

from ..errors import InputError
from .deformer import method_class

Parameters = dict[str, Any]


@dataclass(frozen=True)
class MethodPreset:
    """One way of bending that has a name.

    spec: as `parse_method` reads it; label: a few words; short: for tables; note: a sentence or two; source:
    who published it.
    """

    spec: str
    label: str
    short: str
    note: str
    source: str

    @property
    def method(self) -> str:
        """The method's name for `make_deformer`."""
        return self.spec.partition(":")[0]

    @property
    def settings(self) -> Parameters:
        """What differs from the method's defaults."""
        return parse_method(self.spec)[1]


_PAPER = "Solomon, Ben-Chen, Butscher and Guibas 2011"
PRESETS = (
    MethodPreset(
        "akap",
        "As Killing as possible",
        "AKAP",
        "The drawing flows along a vector field that is as near to a rigid motion as it can be.",
        _PAPER,
    ),
    MethodPreset(
        "akap:no-dirichlet",
        "As Killing, without second solve",
        "AKAP, one solve",
        "Spirals along the first field alone, Fig. 8 (c): dents stay around pins.",
        _PAPER,
    ),
    MethodPreset(
        "akap:trajectory=linear",
        "As Killing, straight steps",
        "AKAP, straight",
        "Both solves, but straight steps, Fig. 8 (b): what turns also grows.",
        _PAPER,
    ),
    MethodPreset(
        "akap:no-dirichlet,trajectory=linear",
        "As Killing, straight, one solve",
        "AKAP, straight, one solve",
        "Straight steps along the first field, Fig. 8 (a): dents around pins, and what turns grows.",
        _PAPER,
    ),
    MethodPreset(
        "arap",
        "As rigid as possible",
        "ARAP",
        "Each triangle keeps its shape as well as it can; found by repeated local and global steps.",
        "Liu, Zhang, Xu, Gotsman and Gortler 2008",
    ),
    MethodPreset(
        "arap:rotations=spokes-and-rims",
        "As rigid, spokes and rims",
        "ARAP, spokes and rims",
        "One rotation for each vertex and all faces around it, which makes bends smoother.",
        "Chao, Pinkall, Sanan and Schröder 2010",
    ),
    MethodPreset(
        "igarashi",
        "As rigid, in two steps",
        "Igarashi",
        "First every triangle may scale, then it gets its size back: two linear solves, no iteration.",
        "Igarashi, Moscovich and Hughes 2005",
    ),
    MethodPreset(
        "cauchy-green",
        "Cauchy-Green",
        "Cauchy–Green",
        "A conformal map: angles stay, areas may swell or shrink a lot. Holes are bent as if filled.",
        "Weber, Ben-Chen and Gotsman 2009",
    ),
    MethodPreset(
        "mls",
        "Moving least squares",
        "MLS",
        "Bends the plane around the pins; near limbs pull on one another, because outlines do not count.",
        "Schaefer, McPhail and Warren 2006",
    ),
)


def default_settings(method: str) -> Parameters:
    """All settings of a method with their defaults. Raises InputError on an unknown one."""
    parameters = list(inspect.signature(method_class(method)).parameters.items())[1:]
    return {key: parameter.default for key, parameter in parameters}


def parse_method(text: str) -> tuple[str, Parameters]:
    """A method and its settings written as ``name``, or ``name:setting=value,switch,no-switch``.

    E.g. "akap:memory=1,no-dirichlet" or "arap:converge". Raises InputError where there is no such method or
    setting, or a value is of another kind than the setting's default.
    """
    name, _, rest = text.strip().partition(":")
    defaults = default_settings(name)
    settings: Parameters = {}
    for part in filter(None, (part.strip() for part in rest.split(","))):
        key, given, value = part.partition("=")
        if not given:
            key, value = (key.removeprefix("no-"), "no") if key.startswith("no-") else (key, "yes")
        if key not in defaults:
            raise InputError(f"method {name}: expected settings among {', '.join(defaults)}, got {key!r}")
        settings[key] = _value(name, key, value, defaults[key])
    return name, settings


def preset_of(method: str, settings: Parameters) -> MethodPreset:
    """The variant that a method with these settings is nearest to: the one that shares most of them."""
    same = [variant for variant in PRESETS if variant.method == method]
    return max(
        (variant for variant in same if variant.settings.items() <= settings.items()),
        key=lambda variant: len(variant.settings),
        default=same[0],
    )


def _value(method: str, key: str, text: str, default: Any) -> Any:
    if isinstance(default, bool):
        if text not in ("yes", "no"):
            raise InputError(f"method {method}: expected yes or no for {key}, got {text!r}")
        return text == "yes"
    if isinstance(default, str):
        return text
    try:
        return type(default)(text)
    except ValueError as error:
        raise InputError(f"method {method}: expected a number for {key}, got {text!r}") from error
