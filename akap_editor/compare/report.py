"""Writes a comparison as one self-contained HTML page, and as JSON."""

import base64
import html
import json
from collections.abc import Sequence
from dataclasses import dataclass
from string import Template
from typing import Any

import numpy as np

from .. import __version__
from ..deform.methods import default_parameters, nearest_preset, parse_method
from ..editor.framing import Box
from ..geometry.validation import Floats
from ..render.offscreen import OffscreenRenderer
from ..resources import resource
from . import plots
from .run import Run

# E_area and E_angle by model and method: Table 1 of the paper, and section 3.3 for moving least squares.
PAPER: dict[str, dict[str, tuple[float, float]]] = {
    "bar": {
        "cauchy-green": (2.356, 2.001),
        "arap": (2.042, 2.036),
        "akap": (2.070, 2.062),
        "mls": (4.951, 8.158),
    },
    "elephant": {"cauchy-green": (4.605, 2.151), "arap": (2.019, 2.033), "akap": (2.030, 2.054)},
    "alien": {"cauchy-green": (2.596, 2.004), "arap": (2.012, 2.013), "akap": (2.016, 2.017)},
}
_MAX_PIXELS = 440  # longest side of a picture
_MARGIN = 0.03  # around the poses, as a share of their size
_MAX_SPREAD = 3.0  # times the drawing's size: larger poses are cut off
_MAX_MEASURE = 1000.0  # larger measures are shown as “> 1000”


@dataclass(frozen=True, eq=False)
class Model:
    """A recording replayed with all methods.

    name: of the drawing; title: of the recording; runs: in the order of the methods; refinements: for each
    method (q, 3): number of vertices, E_area and E_angle on meshes of other sizes, from coarse to fine.
    """

    name: str
    title: str
    runs: Sequence[Run]
    refinements: Sequence[np.ndarray[Any, Any]]


def to_json(models: Sequence[Model]) -> str:
    """All numbers of a comparison; a number that is not finite is null."""
    document = {
        "format": "akap-comparison",
        "version": 1,
        "program": f"akap-editor {__version__}",
        "models": [
            {
                "drawing": model.name,
                "recording": model.title,
                "vertices": len(model.runs[0].drawing.mesh.vertices),
                "faces": len(model.runs[0].drawing.mesh.faces),
                "frames": len(model.runs[0].times),
                "paper": {
                    method: {"E_area": area, "E_angle": angle}
                    for method, (area, angle) in PAPER.get(model.name, {}).items()
                },
                "methods": [
                    _numbers(run) | {"finer": _finite_list(refinement)}
                    for run, refinement in zip(model.runs, model.refinements, strict=True)
                ],
            }
            for model in models
        ],
    }
    return json.dumps(document, indent=1, allow_nan=False) + "\n"


def _numbers(run: Run) -> dict[str, Any]:
    """The measures and curves of one run."""
    method, parameters = parse_method(run.spec)
    return {
        "spec": run.spec,
        "method": method,
        "settings": parameters,
        "E_area": _finite(run.final_distortion.area),
        "E_angle": _finite(run.final_distortion.angle),
        "worst_area": _finite(run.final_distortion.face_area.max()),
        "worst_angle": _finite(run.final_distortion.face_angle.max()),
        "flipped": run.final_distortion.flipped,
        "most_flipped": int(run.trace.flipped.max()),
        "pin_error_pixels": run.pin_error,
        "pin_error": run.pin_error / run.drawing.mesh.length,
        "frame_ms": 1e3 * float(np.median(run.step_seconds)),
        "slowest_frame_ms": 1e3 * float(run.step_seconds.max()),
        "setup_ms": 1e3 * run.setup_seconds,
        "pins_ms": 1e3 * run.pins_seconds,
        "there_and_back": run.return_error,
        "there_and_back_E_area": _finite(run.return_distortion.area),
        "there_and_back_E_angle": _finite(run.return_distortion.angle),
        "times": _finite_list(run.times),
        "frames": _trace(run.trace),
        "jump": _trace(run.jump),
    }


def _trace(trace: Any) -> dict[str, Any]:
    return {name: _finite_list(getattr(trace, name)) for name in ("area", "angle", "flipped", "pin_error")}


def _finite(value: float) -> float | None:
    """The value; None if it is not finite, as JSON has no such numbers."""
    return float(value) if np.isfinite(value) else None


def _finite_list(values: np.ndarray[Any, Any]) -> list[Any]:
    """The values as nested lists, rounded; None for those that are not finite."""
    rounded: list[Any] = np.where(np.isfinite(values), np.round(values, 6), np.array(None)).tolist()
    return rounded


def to_html(models: Sequence[Model], renderer: OffscreenRenderer) -> str:
    """The HTML page; ``renderer`` draws the pictures. Raises GraphicsError without OpenGL 3.3."""
    runs = models[0].runs
    page = Template(resource("assets", "report.html").read_text("utf-8"))
    return page.substitute(
        program=f"akap-editor {__version__}",
        table=_table(models),
        models="\n".join(_section(model, renderer) for model in models),
        methods="\n".join(_method_entry(run) for run in runs),
    )


def _label(run: Run) -> str:
    """The name of a run's preset, with the parameters that the preset does not set."""
    method, parameters = parse_method(run.spec)
    preset = nearest_preset(method, parameters)
    rest = [
        f"{key} {_format_value(value)}" for key, value in parameters.items() if key not in preset.parameters
    ]
    return ", ".join([preset.short, *rest])


def _format_value(value: Any) -> str:
    """The value of a parameter."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _method_entry(run: Run) -> str:
    """The entry of a method in the list at the end of the page."""
    method, parameters = parse_method(run.spec)
    preset = nearest_preset(method, parameters)
    escape = html.escape
    source = f" <cite>{escape(preset.source)}.</cite>" if preset.source else ""
    return (
        f"<dt>{escape(_label(run))} <code>{escape(run.spec)}</code></dt>"
        f"<dd>{escape(f'{preset.label}. {preset.note}'.strip())}{source}"
        f"<br><span>{escape(_parameter_list(method, parameters))}</span></dd>"
    )


def _parameter_list(method: str, parameters: dict[str, Any]) -> str:
    values = {**default_parameters(method), **parameters}
    return ", ".join(f"{key} {_format_value(value)}" for key, value in values.items())


def _format_measure(value: float, digits: int = 3) -> str:
    """A measure as HTML."""
    if not np.isfinite(value) or value > _MAX_MEASURE:
        return f"&gt; {_MAX_MEASURE:g}"
    return f"{value:.{digits}f}"


def _row(head: str, cells: Sequence[str], kind: str = "") -> str:
    """A row of a table; kind: its CSS class."""
    opening = f'<tr class="{kind}">' if kind else "<tr>"
    return f"{opening}<th>{head}</th>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _table(models: Sequence[Model]) -> str:
    """Table 1: both measures by model and method; those of the paper below ours."""
    runs = models[0].runs
    heads = "".join(f"<th>{html.escape(_label(run))}</th>" for run in runs)
    rows = []
    for column, symbol in enumerate(("E<sub>area</sub>", "E<sub>angle</sub>")):
        rows.append(f"<tr><th>{symbol}</th>{heads}</tr>")
        for model in models:
            ours = [(run.final_distortion.area, run.final_distortion.angle)[column] for run in model.runs]
            best, cells = min(ours), [_format_measure(value) for value in ours]
            cells = [f"<b>{cell}</b>" if ours[i] == best else cell for i, cell in enumerate(cells)]
            rows.append(_row(html.escape(model.title), cells))
            theirs = _paper_measures(model)
            if any(theirs):
                cells = [_format_measure(pair[column]) if pair else "" for pair in theirs]
                rows.append(_row("in the paper", cells, "paper"))
    return f'<table class="fixed">{"".join(rows)}</table>'


def _paper_measures(model: Model) -> list[tuple[float, float] | None]:
    """The paper's measures for each run. Each is used once, for the first run with its method's defaults."""
    unused = dict(PAPER.get(model.name, {}))
    measures = []
    for run in model.runs:
        method, parameters = parse_method(run.spec)
        is_default = nearest_preset(method, parameters).spec == method and not parameters.get("memory")
        measures.append(unused.pop(method, None) if is_default else None)
    return measures


def _section(model: Model, renderer: OffscreenRenderer) -> str:
    """The pictures, measures and plots of one recording."""
    first = model.runs[0]
    facts = (
        f"{len(first.drawing.mesh.vertices):,} vertices, {len(first.drawing.mesh.faces):,} faces, "
        f"{len(first.points)} pins, {len(first.times)} steps over {first.times[-1]:.1f} s"
    )
    return (
        f"<section><h2>{html.escape(model.title)}</h2><p>{facts}.</p>{_pictures(model, renderer)}"
        f"{_measures(model)}{_plots(model)}</section>"
    )


def _pictures(model: Model, renderer: OffscreenRenderer) -> str:
    """Pictures and maps of all methods, all with one frame and scale."""
    drawing = model.runs[0].drawing
    most = _MAX_SPREAD * max(drawing.size)
    framed = [run.pose for run in model.runs if np.ptp(run.pose, axis=0).max() < most]
    box = _box(np.concatenate(framed or [drawing.mesh.vertices]))
    scale = _MAX_PIXELS / max(box[2] - box[0], box[3] - box[1])
    cards = []
    for run in model.runs:
        picture = renderer.render(drawing, run.pose, box, scale)
        images = (
            _image(plots.texture_png(run, picture, box), "deformed drawing with its pins"),
            _image(plots.map_png(run, plots.AREA, box), "map of area distortion"),
            _image(plots.map_png(run, plots.ANGLE, box), "map of angle distortion"),
        )
        area, angle = run.final_distortion.area, run.final_distortion.angle
        numbers = f"{_format_measure(area)} / {_format_measure(angle)}"
        caption = f"<figcaption>{html.escape(_label(run))}<br><span>{numbers}</span></figcaption>"
        cards.append(f"<figure>{caption}{''.join(images)}</figure>")
    scales = plots.scale_svg(plots.AREA) + plots.scale_svg(plots.ANGLE)
    return (
        f'<div class="cards">{"".join(cards)}</div><div class="scales">{scales}</div>'
        '<p class="caption">From top to bottom: the drawing with its pins, change of area, stretch. '
        "Below the name: E<sub>area</sub> / E<sub>angle</sub>. Lines lead from pins to targets that they do "
        "not reach; flipped faces are black.</p>"
    )


def _box(points: Floats) -> Box:
    """The rectangle around points (q, 2), with a margin."""
    margin = _MARGIN * np.ptp(points, axis=0).max()
    x0, y0 = np.floor(points.min(axis=0) - margin).astype(int).tolist()
    x1, y1 = np.ceil(points.max(axis=0) + margin).astype(int).tolist()
    return x0, y0, x1, y1


def _image(data: bytes, text: str) -> str:
    return f'<img alt="{text}" src="data:image/png;base64,{base64.b64encode(data).decode("ascii")}">'


def _measures(model: Model) -> str:
    """The table with the measures of all methods."""
    heads = (
        "method",
        "E<sub>area</sub>",
        "E<sub>angle</sub>",
        "worst face, area",
        "worst face, angle",
        "flipped faces",
        "pin error, px",
        "ms per step",
        "slowest step",
        "setup, ms",
        "new pins, ms",
        "return error",
    )
    rows = [
        _row(
            html.escape(_label(run)),
            [
                _format_measure(run.final_distortion.area),
                _format_measure(run.final_distortion.angle),
                _format_measure(run.final_distortion.face_area.max(), 2),
                _format_measure(run.final_distortion.face_angle.max(), 2),
                str(run.final_distortion.flipped),
                _format_measure(run.pin_error, 2),
                _format_measure(1e3 * float(np.median(run.step_seconds)), 1),
                _format_measure(1e3 * float(run.step_seconds.max()), 1),
                _format_measure(1e3 * run.setup_seconds, 1),
                _format_measure(1e3 * run.pins_seconds, 1),
                f"{100 * run.return_error:.2f} %",
            ],
        )
        for run in model.runs
    ]
    head = "".join(f"<th>{text}</th>" for text in heads)
    return f'<table class="measures"><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table>'


def _plots(model: Model) -> str:
    """Plots of distortion during the drags, after a jump of the targets, and on finer meshes."""
    labels, runs = [_label(run) for run in model.runs], model.runs
    excess, steps = "E − 4, both measures", np.arange(len(runs[0].jump.area), dtype=np.float64)

    def sums(trace: Any) -> Any:
        return trace.area + trace.angle - 4

    drags = [(label, run.times, sums(run.trace)) for label, run in zip(labels, runs, strict=True)]
    jumps = [(label, steps[1:], sums(run.jump)[1:]) for label, run in zip(labels, runs, strict=True)]
    figures = [
        (
            plots.lines_svg(drags, "seconds of the recording", excess),
            "Distortion during the drags.",
        ),
        (
            plots.lines_svg(jumps, "steps", excess),
            "Convergence: distortion after each step from the rest pose with the last targets set at once.",
        ),
    ]
    if len(model.refinements[0]) > 1:
        for column, name in ((1, "area"), (2, "angle")):
            curves = [
                (label, refinement[:, 0], refinement[:, column] - 2)
                for label, refinement in zip(labels, model.refinements, strict=True)
            ]
            caption = f"Convergence of the {name} distortion as the mesh is refined."
            figures.append((plots.lines_svg(curves, "vertices", f"E_{name} − 2"), caption))
    cells = "".join(f"<figure>{svg}<figcaption>{caption}</figcaption></figure>" for svg, caption in figures)
    return f'<div class="legend">{plots.legend_svg(labels)}</div><div class="plots">{cells}</div>'
