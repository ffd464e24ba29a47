"""The parameters of methods, with what each means in plain words."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from imgui_bundle import ImVec4, imgui

from ...deform.methods import default_settings
from ...editor.document.settings import Settings
from .. import widgets
from ..app_state import AppState
from ..theme import QUIET

_TITLE = "Parameters"
_LABELS = 8.3  # times the font's size: width of the labels

Draw = Callable[[Any], tuple[bool, Any]]


def _switch() -> Draw:
    def draw(value: Any) -> tuple[bool, Any]:
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
        return widgets.switch("##value", bool(value))

    return draw


def _choice(**labels: str) -> Draw:
    names = [name.replace("_", "-") for name in labels]

    def draw(value: Any) -> tuple[bool, Any]:
        changed, index = imgui.combo("##value", names.index(value), list(labels.values()))
        return changed, names[index]

    return draw


def _slider(low: float, high: float, form: str = "%.2f", even: bool = True) -> Draw:
    """even: equal ways for equal differences; otherwise for equal ratios. None is left to the method."""
    flags = imgui.SliderFlags_.always_clamp | (0 if even else imgui.SliderFlags_.logarithmic)

    def draw(value: Any) -> tuple[bool, Any]:
        if value is None:
            return widgets.slider("##value", low, (low, high), form, flags, word="auto")[:2]
        return widgets.slider("##value", float(value), (low, high), form, flags)[:2]

    return draw


def _whole(low: int, high: int) -> Draw:
    def draw(value: Any) -> tuple[bool, Any]:
        flags = imgui.SliderFlags_.logarithmic
        changed, chosen, _ = widgets.slider("##value", float(value), (low, high), "%.0f", flags)
        return changed, round(chosen)

    return draw


@dataclass(frozen=True)
class Parameter:
    """A parameter of a method: its name there, a label, what to know about it, the item that edits it."""

    name: str
    label: str
    tooltip: str
    draw: Draw


PARAMETERS: dict[str, tuple[Parameter, ...]] = {
    "akap": (
        Parameter(
            "memory",
            "Memory",
            "How strongly each step springs back towards the drawing's own shape. 0 is the paper's method, "
            "which keeps what each drag did, as clay would.",
            _slider(0, 1),
        ),
        Parameter(
            "dirichlet",
            "Second solve",
            "Smooths the inside of the field while the outline moves as before, so that nothing bulges near "
            "pins.",
            _switch(),
        ),
        Parameter(
            "trajectory",
            "Paths",
            "Spirals carry what turns around without swelling it; straight lines are for comparison.",
            _choice(spiral="Spirals", linear="Straight lines"),
        ),
        Parameter(
            "pin_weight",
            "Pull of pins",
            "How strongly pins pull at the field. More brings them nearer to the pointer in each step.",
            _slider(1, 10_000, "%.0f", even=False),
        ),
        Parameter(
            "max_step",
            "Longest step",
            "How far a pin moves along one field, as a share of the drawing's size. Shorter steps distort "
            "less and cost more.",
            _slider(0.001, 0.5, "%.3f", even=False),
        ),
        Parameter(
            "constraints",
            "Pins are",
            "Soft pins may lag a little behind; hard ones have exactly the speed of the pointer.",
            _choice(soft="Soft", hard="Hard"),
        ),
        Parameter(
            "exact",
            "Exact solves",
            "Solves anew for every step, as in the paper: several times slower, and it looks the same.",
            _switch(),
        ),
    ),
    "arap": (
        Parameter(
            "iterations",
            "Iterations",
            "Most pairs of a local and a global step in one frame. More settles sooner.",
            _whole(1, 200),
        ),
        Parameter(
            "tolerance",
            "Tolerance",
            "Once nothing moves farther than this share of the drawing's size, a step ends.",
            _slider(1e-10, 1e-3, "%.1e", even=False),
        ),
        Parameter(
            "converge", "Until at rest", "Iterate until nothing moves, however long it takes.", _switch()
        ),
        Parameter(
            "rotations",
            "Rigid are",
            "What is to keep its shape: each triangle, or each corner with all triangles around it.",
            _choice(faces="Triangles", spokes_and_rims="Corners"),
        ),
    ),
    "igarashi": (
        Parameter(
            "pin_weight",
            "Pull of pins",
            "How strongly pins hold. More brings them nearer to the pointer.",
            _slider(1, 100_000, "%.0f", even=False),
        ),
    ),
    "cauchy-green": (
        Parameter(
            "cage",
            "Cage",
            "Most corners of the outline that the map is made of. More follows the drawing closer and costs "
            "more.",
            _whole(16, 1000),
        ),
        Parameter(
            "smoothness",
            "Smoothness",
            "Less brings pins nearer to the pointer; more keeps the map calmer.",
            _slider(1e-6, 1.0, "%.1e", even=False),
        ),
    ),
    "mls": (
        Parameter(
            "transform",
            "Around pins",
            "What the drawing may do around pins: turn only, also grow and shrink, or also shear.",
            _choice(rigid="Turn", similarity="Turn and scale", affine="Anything linear"),
        ),
        Parameter(
            "alpha",
            "Reach",
            "How fast the pull of a pin fades with the distance. More makes it more local.",
            _slider(0.1, 10, "%.1f", even=False),
        ),
    ),
}


def default(method: str, name: str) -> Any:
    """What a parameter is in a new drawing, or where it is left to the method."""
    if method == Settings().method and Settings().get(name) is not None:
        return Settings().get(name)
    return default_settings(method)[name]


def defaults(settings: Settings) -> Settings:
    """All parameters of a method as in a new drawing."""
    for parameter in PARAMETERS[settings.method]:
        settings = settings.with_parameter(parameter.name, default(settings.method, parameter.name))
    return settings


def draw(state: AppState) -> None:
    """The parameters of the current method, folded away at first."""
    assert state.document is not None
    settings = state.document.state.settings
    remembered: dict[str, object] = state.preferences.get("sections", {})
    was_open = remembered.get(_TITLE) is True
    imgui.set_next_item_open(was_open)
    imgui.push_style_var(imgui.StyleVar_.indent_spacing, 0.0)
    is_open = imgui.tree_node_ex(_TITLE, imgui.TreeNodeFlags_.span_avail_width)
    if is_open != was_open:
        state.preferences.put("sections", {**remembered, _TITLE: is_open})
    if is_open:
        for parameter in PARAMETERS[settings.method]:
            _parameter(state, settings, parameter)
        imgui.tree_pop()
    imgui.pop_style_var()


def _parameter(state: AppState, settings: Settings, parameter: Parameter) -> None:
    """Its label, which resets it on a double click, and its item. A value is used once the item is let go."""
    standard = default(settings.method, parameter.name)
    value = settings.get(parameter.name, standard)
    imgui.push_id(parameter.name)
    imgui.align_text_to_frame_padding()
    if value == standard:
        imgui.text_colored(ImVec4(*QUIET), parameter.label)
    else:
        imgui.text(parameter.label)
    widgets.show_tooltip(f"{parameter.tooltip} Double-click for the default.")
    reset = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0)
    imgui.same_line(_LABELS * imgui.get_font_size())
    imgui.set_next_item_width(widgets.FULL)
    edited = state.pending_values.edit((settings.method, parameter.name), value, parameter.draw)
    imgui.pop_id()
    if reset and value != standard:
        widgets.change(state, settings.with_parameter(parameter.name, standard))
    elif edited is not None and edited != value:
        widgets.change(state, settings.with_parameter(parameter.name, edited))
