"""A comparison as one HTML page with everything in it, and as JSON."""

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

# Table 1 of the paper, E_area and E_angle by model and method, and its figure for moving least squares.
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
_PIXELS = 440  # longest side of a picture
_MARGIN = 0.03  # of a picture around the poses
_WILD = 3.0  # times its picture: a pose that is larger does not choose the frame
_HUGE = 1000.0  # a measure above this says no more than that


@dataclass(frozen=True, eq=False)
class Model:
    """One recording bent by all methods.

    name: of the drawing; title: of the recording; runs: in the order of the methods; finer: for each method
    the number of vertices, E_area and E_angle of the same drags on other meshes, coarse to fine, (q, 3).
    """

    name: str
    title: str
    runs: Sequence[Run]
    finer: Sequence[np.ndarray[Any, Any]]


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
                    _numbers(run) | {"finer": _listed(finer)}
                    for run, finer in zip(model.runs, model.finer, strict=True)
                ],
            }
            for model in models
        ],
    }
    return json.dumps(document, indent=1, allow_nan=False) + "\n"


def _numbers(run: Run) -> dict[str, Any]:
    """What the tables show of one run, and its curves."""
    method, settings = parse_method(run.spec)
    return {
        "spec": run.spec,
        "method": method,
        "settings": settings,
        "E_area": _finite(run.after.area),
        "E_angle": _finite(run.after.angle),
        "worst_area": _finite(run.after.face_area.max()),
        "worst_angle": _finite(run.after.face_angle.max()),
        "flipped": run.after.flipped,
        "most_flipped": int(run.trace.flipped.max()),
        "pin_error_pixels": run.pin_error,
        "pin_error": run.pin_error / run.drawing.mesh.length,
        "frame_ms": 1e3 * float(np.median(run.step_seconds)),
        "slowest_frame_ms": 1e3 * float(run.step_seconds.max()),
        "setup_ms": 1e3 * run.setup_seconds,
        "pins_ms": 1e3 * run.pins_seconds,
        "there_and_back": run.back,
        "there_and_back_E_area": _finite(run.back_after.area),
        "there_and_back_E_angle": _finite(run.back_after.angle),
        "times": _listed(run.times),
        "frames": _trace(run.trace),
        "jump": _trace(run.jump),
    }


def _trace(trace: Any) -> dict[str, Any]:
    return {name: _listed(getattr(trace, name)) for name in ("area", "angle", "flipped", "pin_error")}


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _listed(values: np.ndarray[Any, Any]) -> list[Any]:
    rounded: list[Any] = np.where(np.isfinite(values), np.round(values, 6), np.array(None)).tolist()
    return rounded


def to_html(models: Sequence[Model], renderer: OffscreenRenderer) -> str:
    """The page; ``renderer`` draws the pictures. Raises GraphicsError without OpenGL 3.3."""
    runs = models[0].runs
    page = Template(resource("assets", "report.html").read_text("utf-8"))
    return page.substitute(
        program=f"akap-editor {__version__}",
        table=_table(models),
        models="\n".join(_section(model, renderer) for model in models),
        methods="\n".join(_method(run) for run in runs),
    )


def _label(run: Run) -> str:
    """The name of a run's preset, with the parameters that the preset does not set."""
    method, settings = parse_method(run.spec)
    preset = nearest_preset(method, settings)
    rest = [f"{key} {_word(value)}" for key, value in settings.items() if key not in preset.parameters]
    return ", ".join([preset.short, *rest])


def _word(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _method(run: Run) -> str:
    method, settings = parse_method(run.spec)
    preset = nearest_preset(method, settings)
    escape = html.escape
    source = f" <cite>{escape(preset.source)}.</cite>" if preset.source else ""
    return (
        f"<dt>{escape(_label(run))} <code>{escape(run.spec)}</code></dt>"
        f"<dd>{escape(f'{preset.label}. {preset.note}'.strip())}{source}"
        f"<br><span>{escape(_parameters(method, settings))}</span></dd>"
    )


def _parameters(method: str, settings: dict[str, Any]) -> str:
    values = {**default_parameters(method), **settings}
    return ", ".join(f"{key} {_word(value)}" for key, value in values.items())


def _number(value: float, digits: int = 3) -> str:
    if not np.isfinite(value) or value > _HUGE:
        return f"&gt; {_HUGE:g}"
    return f"{value:.{digits}f}"


def _row(head: str, cells: Sequence[str], kind: str = "") -> str:
    opening = f'<tr class="{kind}">' if kind else "<tr>"
    return f"{opening}<th>{head}</th>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _table(models: Sequence[Model]) -> str:
    """Table 1: both measures by model and method, the paper's own below ours."""
    runs = models[0].runs
    heads = "".join(f"<th>{html.escape(_label(run))}</th>" for run in runs)
    rows = []
    for column, symbol in enumerate(("E<sub>area</sub>", "E<sub>angle</sub>")):
        rows.append(f"<tr><th>{symbol}</th>{heads}</tr>")
        for model in models:
            ours = [(run.after.area, run.after.angle)[column] for run in model.runs]
            best = min(ours)
            cells = [f"<b>{_number(value)}</b>" if value == best else _number(value) for value in ours]
            rows.append(_row(html.escape(model.title), cells))
            printed = _printed(model)
            if any(printed):
                cells = [_number(pair[column]) if pair else "" for pair in printed]
                rows.append(_row("in the paper", cells, "paper"))
    return f'<table class="fixed">{"".join(rows)}</table>'


def _printed(model: Model) -> list[tuple[float, float] | None]:
    """The paper's figures for each run: of each of its methods once, the first that is near to it."""
    left = dict(PAPER.get(model.name, {}))
    found = []
    for run in model.runs:
        method, settings = parse_method(run.spec)
        plain = nearest_preset(method, settings).spec == method and not settings.get("memory")
        found.append(left.pop(method, None) if plain else None)
    return found


def _section(model: Model, renderer: OffscreenRenderer) -> str:
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
    """Texture and both maps of all methods in one frame and on one scale."""
    drawing = model.runs[0].drawing
    sane = [run.pose for run in model.runs if np.ptp(run.pose, axis=0).max() < _WILD * max(drawing.size)]
    box = _box(np.concatenate(sane or [drawing.mesh.vertices]))
    scale = _PIXELS / max(box[2] - box[0], box[3] - box[1])
    cards = []
    for run in model.runs:
        picture = renderer.render(drawing, run.pose, box, scale)
        images = (
            _image(plots.texture_png(run, picture, box), "bent drawing with its pins"),
            _image(plots.map_png(run, plots.AREA, box), "map of area distortion"),
            _image(plots.map_png(run, plots.ANGLE, box), "map of angle distortion"),
        )
        numbers = f"{_number(run.after.area)} / {_number(run.after.angle)}"
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
    heads = (
        "method",
        "E<sub>area</sub>",
        "E<sub>angle</sub>",
        "worst face, area",
        "worst face, angle",
        "flipped faces",
        "pins off, px",
        "ms a step",
        "slowest",
        "set-up, ms",
        "new pins, ms",
        "there and back",
    )
    rows = [
        _row(
            html.escape(_label(run)),
            [
                _number(run.after.area),
                _number(run.after.angle),
                _number(run.after.face_area.max(), 2),
                _number(run.after.face_angle.max(), 2),
                str(run.after.flipped),
                _number(run.pin_error, 2),
                _number(1e3 * float(np.median(run.step_seconds)), 1),
                _number(1e3 * float(run.step_seconds.max()), 1),
                _number(1e3 * run.setup_seconds, 1),
                _number(1e3 * run.pins_seconds, 1),
                f"{100 * run.back:.2f} %",
            ],
        )
        for run in model.runs
    ]
    head = "".join(f"<th>{text}</th>" for text in heads)
    return f'<table class="measures"><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table>'


def _plots(model: Model) -> str:
    """Over the drags, from a jump, and on finer meshes."""
    labels, runs = [_label(run) for run in model.runs], model.runs
    excess, steps = "E − 4, both measures", np.arange(len(runs[0].jump.area), dtype=np.float64)

    def sums(trace: Any) -> Any:
        return trace.area + trace.angle - 4

    drags = [(label, run.times, sums(run.trace)) for label, run in zip(labels, runs, strict=True)]
    jumps = [(label, steps[1:], sums(run.jump)[1:]) for label, run in zip(labels, runs, strict=True)]
    figures = [
        (
            plots.lines_svg(drags, "seconds of the recording", excess),
            "Distortion in the course of the drags.",
        ),
        (
            plots.lines_svg(jumps, "steps", excess),
            "Convergence: distortion after each step from the rest pose with the last targets given at once.",
        ),
    ]
    if len(model.finer[0]) > 1:
        for column, name in ((1, "area"), (2, "angle")):
            curves = [
                (label, finer[:, 0], finer[:, column] - 2)
                for label, finer in zip(labels, model.finer, strict=True)
            ]
            caption = f"Convergence of the {name} distortion as the mesh is refined."
            figures.append((plots.lines_svg(curves, "vertices", f"E_{name} − 2"), caption))
    cells = "".join(f"<figure>{svg}<figcaption>{caption}</figcaption></figure>" for svg, caption in figures)
    return f'<div class="legend">{plots.legend_svg(labels)}</div><div class="plots">{cells}</div>'
