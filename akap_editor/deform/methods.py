"""The table of deformation methods: class, presets, parameters and their words on the screen.

A new method is one module with a `Deformer` and one row of `METHODS`; the command line, the side panel,
comparisons and tests read the table.
"""

import inspect
import reprlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from types import MappingProxyType
from typing import Any

from ..errors import InputError
from ..geometry.joints import MeshJoints
from ..geometry.mesh import TriMesh
from ..geometry.validation import as_instance
from ..words import mark, tr
from .akap.deformer import AkapDeformer
from .deformer import Deformer
from .islands import IslandDeformer
from .layer_groups import LayerGroupDeformer
from .rivals.arap import ArapDeformer
from .rivals.cauchy_green import CauchyGreenDeformer
from .rivals.igarashi import IgarashiDeformer
from .rivals.moving_least_squares import MovingLeastSquaresDeformer

Parameters = dict[str, Any]  # values by the names of a constructor's arguments


@dataclass(frozen=True)
class Switch:
    """A parameter that is on or off."""


@dataclass(frozen=True)
class Choice:
    """A parameter with a few values, each with its label on the screen."""

    labels: Mapping[str, str]


@dataclass(frozen=True)
class NumberRange:
    """A number from ``low`` to ``high``. If the default is None, the method chooses the value itself.

    format: printf format on the screen; is_logarithmic: sliders show equal ratios as equal distances;
    is_whole: the value is an int.
    """

    low: float
    high: float
    format: str = "%.2f"
    is_logarithmic: bool = False
    is_whole: bool = False


@dataclass(frozen=True)
class Parameter:
    """One argument of a deformer's constructor, and how the side panel shows it.

    name: of the argument; tooltip: one or two sentences; kind: which values it may have.
    """

    name: str
    label: str
    tooltip: str
    kind: Switch | Choice | NumberRange


@dataclass(frozen=True)
class MethodPreset:
    """A method with parameters that has a name of its own.

    spec: in the notation of `parse_method`; label: for menus; short: for tables; note: one or two sentences;
    source: the publication.
    """

    spec: str
    label: str
    short: str
    note: str = ""
    source: str = ""

    @property
    def method(self) -> str:
        """The method's name in `METHODS`."""
        return self.spec.partition(":")[0]

    @cached_property
    def parameters(self) -> Parameters:
        """The parameters that differ from the method's defaults."""
        return parse_method(self.spec)[1]

    @property
    def description(self) -> str:
        """Note and source in one line, empty if there are none."""
        return f"{tr(self.note)} {self.source and self.source + '.'}".strip()


@dataclass(frozen=True)
class Method:
    """One row of the table.

    deformer: called with the rest mesh and, by keyword, with parameters; its defaults are the method's.
    presets: the plain method first; if there are none, it is listed under its name.
    parameters: those that the side panel shows, in its order.
    document_defaults: parameters of new documents where they differ from the constructor's defaults.
    compared: specs that a comparison of all methods runs; if there are none, the plain method.
    """

    deformer: type[Deformer]
    presets: tuple[MethodPreset, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    document_defaults: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    compared: tuple[str, ...] = ()


_SOLOMON = "Solomon, Ben-Chen, Butscher and Guibas 2011"

DEFAULT_METHOD = "akap"  # of new documents

METHODS: dict[str, Method] = {
    "akap": Method(
        AkapDeformer,
        presets=(
            MethodPreset(
                "akap",
                mark("As-Killing-as-possible (AKAP)"),
                "AKAP",
                mark("Moves the drawing along the vector field that is closest to a rigid motion."),
                _SOLOMON,
            ),
            MethodPreset(
                "akap:no-dirichlet",
                mark("AKAP, first solve only"),
                "AKAP, one solve",
                mark("Follows the field of the first solve, Fig. 8 (c): dents remain around pins."),
                _SOLOMON,
            ),
            MethodPreset(
                "akap:trajectory=linear",
                mark("AKAP, straight steps"),
                "AKAP, straight",
                mark("Both solves, but straight steps, Fig. 8 (b): parts that rotate also grow."),
                _SOLOMON,
            ),
            MethodPreset(
                "akap:no-dirichlet,trajectory=linear",
                mark("AKAP, straight steps, first solve only"),
                "AKAP, straight, one solve",
                mark(
                    "Straight steps along the field of the first solve, Fig. 8 (a): dents remain around "
                    "pins, "
                    "and parts that rotate also grow."
                ),
                _SOLOMON,
            ),
        ),
        parameters=(
            Parameter(
                "memory",
                mark("Memory"),
                mark(
                    "How strongly each step pulls the drawing back to its rest shape. 0 is the paper's "
                    "method: "
                    "the pose depends on how it was dragged there, as with clay."
                ),
                NumberRange(0, 1),
            ),
            Parameter(
                "dirichlet",
                mark("Second solve"),
                mark(
                    "Smooths the field inside the drawing while the outline moves as before, so that nothing "
                    "bulges around pins."
                ),
                Switch(),
            ),
            Parameter(
                "trajectory",
                mark("Trajectories"),
                mark(
                    "Spirals keep the size of parts that rotate. Straight lines, which make them grow, are "
                    "here for comparison."
                ),
                Choice({"spiral": mark("Spirals"), "linear": mark("Straight lines")}),
            ),
            Parameter(
                "pin_weight",
                mark("Pin strength"),
                mark(
                    "How strongly pins pull on the field. Higher values bring them closer to the pointer "
                    "in each "
                    "step."
                ),
                NumberRange(1, 10_000, "%.0f", is_logarithmic=True),
            ),
            Parameter(
                "max_step",
                mark("Maximum step"),
                mark(
                    "How far a pin moves along one field, as a share of the drawing's size. Shorter steps "
                    "distort less and cost more."
                ),
                NumberRange(0.001, 0.5, "%.3f", is_logarithmic=True),
            ),
            Parameter(
                "constraints",
                mark("Pin constraint"),
                mark("Soft pins may lag a little behind the pointer; hard pins have exactly its velocity."),
                Choice({"soft": mark("Soft"), "hard": mark("Hard")}),
            ),
            Parameter(
                "exact",
                mark("Exact solves"),
                mark(
                    "Factorizes the matrices anew in every step, as in the paper: several times slower, "
                    "without "
                    "a visible difference."
                ),
                Switch(),
            ),
        ),
        document_defaults={"memory": 1.0},
        compared=("akap", "akap:memory=1", "akap:no-dirichlet", "akap:trajectory=linear"),
    ),
    "arap": Method(
        ArapDeformer,
        presets=(
            MethodPreset(
                "arap",
                mark("As-rigid-as-possible (ARAP)"),
                "ARAP",
                mark(
                    "Keeps the shape of each triangle as well as it can, by alternating local and global "
                    "steps."
                ),
                "Liu, Zhang, Xu, Gotsman and Gortler 2008",
            ),
            MethodPreset(
                "arap:rotations=spokes-and-rims",
                mark("ARAP, spokes and rims"),
                "ARAP, spokes and rims",
                mark("Fits one rotation per vertex to all triangles around it, which makes bends smoother."),
                "Chao, Pinkall, Sanan and Schröder 2010",
            ),
        ),
        parameters=(
            Parameter(
                "iterations",
                mark("Iterations"),
                mark(
                    "Maximum number of local and global steps per frame. With more, the drawing settles "
                    "sooner."
                ),
                NumberRange(1, 200, "%.0f", is_logarithmic=True, is_whole=True),
            ),
            Parameter(
                "tolerance",
                mark("Tolerance"),
                mark("A step ends once no vertex moves farther than this share of the drawing's size."),
                NumberRange(1e-10, 1e-3, "%.1e", is_logarithmic=True),
            ),
            Parameter(
                "converge",
                mark("Until converged"),
                mark("Iterates until no vertex moves, however long that takes."),
                Switch(),
            ),
            Parameter(
                "rotations",
                mark("Rotations"),
                mark(
                    "Whether each triangle has a rotation of its own, or each vertex one for all triangles "
                    "around it."
                ),
                Choice({"faces": mark("Per triangle"), "spokes-and-rims": mark("Per vertex")}),
            ),
        ),
    ),
    "igarashi": Method(
        IgarashiDeformer,
        presets=(
            MethodPreset(
                "igarashi",
                mark("As-rigid-as-possible, two solves"),
                "Igarashi",
                mark(
                    "First every triangle may scale, then it gets its size back: two linear solves, no "
                    "iteration."
                ),
                "Igarashi, Moscovich and Hughes 2005",
            ),
        ),
        parameters=(
            Parameter(
                "pin_weight",
                mark("Pin strength"),
                mark("How strongly pins hold. Higher values bring them closer to the pointer."),
                NumberRange(1, 100_000, "%.0f", is_logarithmic=True),
            ),
        ),
    ),
    "cauchy-green": Method(
        CauchyGreenDeformer,
        presets=(
            MethodPreset(
                "cauchy-green",
                mark("Cauchy–Green coordinates"),
                "Cauchy–Green",
                mark(
                    "A conformal map: it keeps angles, but areas may grow or shrink a lot. Holes bend as if "
                    "filled."
                ),
                "Weber, Ben-Chen and Gotsman 2009",
            ),
        ),
        parameters=(
            Parameter(
                "cage",
                mark("Cage vertices"),
                mark(
                    "Maximum number of vertices of the cage around the drawing. More vertices follow its "
                    "outline "
                    "more closely and cost more."
                ),
                NumberRange(16, 1000, "%.0f", is_logarithmic=True, is_whole=True),
            ),
            Parameter(
                "smoothness",
                mark("Smoothness"),
                mark("Lower values bring pins closer to the pointer; higher values make the map smoother."),
                NumberRange(1e-6, 1.0, "%.1e", is_logarithmic=True),
            ),
        ),
    ),
    "mls": Method(
        MovingLeastSquaresDeformer,
        presets=(
            MethodPreset(
                "mls",
                mark("Moving least squares (MLS)"),
                "MLS",
                mark(
                    "Warps the plane around the pins. Limbs that are close pull on one another, because the "
                    "outline plays no role."
                ),
                "Schaefer, McPhail and Warren 2006",
            ),
        ),
        parameters=(
            Parameter(
                "transform",
                mark("Transform"),
                mark("What the map may do near a pin: rotate only, also scale, or also shear."),
                Choice(
                    {
                        "rigid": mark("Rotate"),
                        "similarity": mark("Rotate and scale"),
                        "affine": mark("Affine"),
                    }
                ),
            ),
            Parameter(
                "alpha",
                mark("Falloff"),
                mark(
                    "How fast the influence of a pin falls off with distance. Higher values make it more "
                    "local."
                ),
                NumberRange(0.1, 10, "%.1f", is_logarithmic=True),
            ),
        ),
    ),
}


def method_names() -> list[str]:
    """The names of all methods, as `make_deformer` takes them."""
    return list(METHODS)


def get_method(name: str) -> Method:
    """The row of the table with this name. Raises InputError if there is none."""
    if not isinstance(name, str) or name not in METHODS:
        raise InputError(f"method: expected one of {', '.join(METHODS)}, got {reprlib.repr(name)}")
    return METHODS[name]


def make_deformer(
    method: str, mesh: TriMesh, joints: MeshJoints | None = None, /, **parameters: Any
) -> Deformer:
    """Make the deformer of a method for a mesh at rest, with parameters by keyword.

    If the components of the mesh are tied, those without a pin move with the others (`IslandDeformer`). Of a
    mesh in layers, each component with pins is deformed on its own (`LayerGroupDeformer`), with those that
    ``joints`` connect it to, if the method takes them; what hangs on a joint and has no pins rides.
    Raises InputError for an unknown method or parameter, or a value out of range.
    """
    chosen, known = get_method(method), default_parameters(method)
    for name in parameters:
        _check_known(method, name, known)
    as_instance(mesh, "mesh", TriMesh)
    constructor: Callable[..., Deformer] = chosen.deformer
    if mesh.layers is not None:
        deformer: Deformer = LayerGroupDeformer(mesh, constructor, joints, **parameters)
    else:
        deformer = constructor(mesh, **parameters)
    return IslandDeformer(mesh, deformer, joints) if mesh.tied and mesh.component.any() else deformer


def default_parameters(method: str) -> Parameters:
    """All parameters of a method with the constructor's defaults. Raises InputError for an unknown method."""
    return dict(_constructor_defaults(get_method(method).deformer))


@cache  # panels ask in every frame
def _constructor_defaults(deformer: type[Deformer]) -> tuple[tuple[str, Any], ...]:
    """Names and default values of a deformer's arguments behind the mesh, without joints."""
    arguments = list(inspect.signature(deformer).parameters.values())[1:]
    return tuple((argument.name, argument.default) for argument in arguments if argument.name != "joints")


def presets() -> list[MethodPreset]:
    """The presets of all methods, at least one of each, in the order of the table."""
    return [preset for name in METHODS for preset in presets_of(name)]


def presets_of(method: str) -> tuple[MethodPreset, ...]:
    """The presets of one method, at least one. Raises InputError for an unknown method."""
    return get_method(method).presets or (MethodPreset(method, method, method),)


def nearest_preset(method: str, parameters: Parameters) -> MethodPreset:
    """The method's preset that shares most of its parameters with ``parameters`` and contradicts none.

    If every preset contradicts them, the method's first. Raises InputError for an unknown method.
    """
    candidates = presets_of(method)
    return max(
        (preset for preset in candidates if preset.parameters.items() <= parameters.items()),
        key=lambda preset: len(preset.parameters),
        default=candidates[0],
    )


def compared_methods() -> list[str]:
    """The specs that a comparison of all methods runs, in the notation of `parse_method`."""
    return [spec for name, method in METHODS.items() for spec in method.compared or (name,)]


def parse_method(text: str) -> tuple[str, Parameters]:
    """Parse a method and its parameters written as ``name`` or ``name:parameter=value,switch,no-switch``.

    E.g. "akap:memory=1,no-dirichlet" or "arap:converge". Returns the name and the parameters given. Raises
    InputError for an unknown method or parameter, or a value of another type than the parameter's default.
    """
    name, _, rest = text.strip().partition(":")
    defaults = default_parameters(name)
    parameters: Parameters = {}
    for part in filter(None, (part.strip() for part in rest.split(","))):
        key, equals, value = part.partition("=")
        if not equals:
            key, value = (key.removeprefix("no-"), "no") if key.startswith("no-") else (key, "yes")
        _check_known(name, key, defaults)
        parameters[key] = _parse_value(name, key, value, defaults[key])
    return name, parameters


def _check_known(method: str, name: str, known: Parameters) -> None:
    if name not in known:
        expected = f"parameters among {', '.join(known)}" if known else "no parameters"
        raise InputError(f"method {method}: expected {expected}, got {name!r}")


def _parse_value(method: str, name: str, text: str, default: Any) -> Any:
    if isinstance(default, bool):
        if text not in ("yes", "no"):
            raise InputError(f"method {method}: expected yes or no for {name}, got {text!r}")
        return text == "yes"
    if isinstance(default, str):
        return text
    try:
        return float(text) if default is None else type(default)(text)
    except ValueError as error:
        raise InputError(f"method {method}: expected a number for {name}, got {text!r}") from error
