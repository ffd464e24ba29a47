"""Draws the pictures (PNG) and plots (SVG) of a comparison with matplotlib."""

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from ..editor.framing import Box
from ..geometry.validation import Floats
from .run import Run

# Distinguishable with any color vision (Okabe and Ito 2008); beyond them, line styles differ.
_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
_LINE_STYLES = ("-", "--", "-.", ":")
_STYLE = {
    "font.family": "sans-serif",
    "font.size": 8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "grid.linewidth": 0.4,
    "grid.color": "#dddddd",
    "svg.fonttype": "none",
    "svg.hashsalt": "akap-editor",
}
_DPI = 110
_MAX_INCHES = 3.6  # largest width and height of a picture
_MIN_LOG_VALUE = 1e-6  # on logarithmic axes

AREA, ANGLE = "area", "angle"
_MAPS = {AREA: "RdBu_r", ANGLE: "viridis_r"}
_LIMITS = {AREA: (-1.0, 1.0), ANGLE: (0.0, 1.0)}
_CAPTIONS = {
    AREA: "log₂ of the area of a face over its area at rest",
    ANGLE: "log₂ of the longer over the shorter principal stretch of a face",
}


def _save(figure: Figure, kind: str) -> bytes:
    """The bytes of a figure as "png" or "svg", without date, so that equal figures give equal bytes."""
    target = io.BytesIO()
    metadata = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
    figure.savefig(target, format=kind, metadata=metadata)
    return target.getvalue()


def _plane_figure(box: Box, background: str = "white") -> Figure:
    """A figure without frame that shows ``box`` of the drawing plane."""
    width, height = box[2] - box[0], box[3] - box[1]
    inches_per_pixel = min(_MAX_INCHES / width, _MAX_INCHES / height)
    figure = Figure(
        figsize=(inches_per_pixel * width, inches_per_pixel * height), dpi=_DPI, facecolor=background
    )
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(box[0], box[2]), ylim=(box[3], box[1]), aspect="equal")
    axes.axis("off")
    return figure


def texture_png(run: Run, picture: NDArray[np.uint8], box: Box) -> bytes:
    """The picture (h, w, 4) of the final pose, which fills ``box``; its pins, and lines to missed targets."""
    figure = _plane_figure(box)
    axes = figure.axes[0]
    axes.imshow(picture, extent=(box[0], box[2], box[3], box[1]), interpolation="antialiased")
    pins = run.drawing.mesh.evaluate(run.points, run.pose)
    for pin, target in zip(pins, run.targets, strict=True):
        axes.plot(*np.transpose([pin, target]), color="#D55E00", linewidth=0.8)
    axes.scatter(pins[:, 0], pins[:, 1], s=16, c="#D55E00", edgecolors="white", linewidths=0.8, zorder=3)
    return _save(figure, "png")


def map_png(run: Run, quantity: str, box: Box) -> bytes:
    """The map of area or angle distortion in the final pose, see `scale_svg`; flipped faces are black."""
    mesh = run.drawing.mesh
    figure = _plane_figure(box)
    values, flipped = _face_values(run, quantity)
    colors = ScalarMappable(Normalize(*_LIMITS[quantity]), _MAPS[quantity]).to_rgba(values)
    colors[flipped] = (0, 0, 0, 1)
    faces = PolyCollection(list(run.pose[mesh.faces]), facecolors=colors, edgecolors=colors, linewidths=0.2)
    figure.axes[0].add_collection(faces)
    for loop in mesh.boundary_loops:
        figure.axes[0].plot(*run.pose[np.append(loop, loop[0])].T, color="#444444", linewidth=0.5)
    return _save(figure, "png")


def _face_values(run: Run, quantity: str) -> tuple[Floats, NDArray[np.bool_]]:
    """The mapped value of each face, and whether it is flipped; (m,) each.

    The angle distortion d of a face with stretch ratio x is x + 1/x, so x = d/2 + √(d²/4 − 1).
    """
    mesh = run.drawing.mesh
    corners = run.pose[mesh.faces]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    areas = 0.5 * (ax * by - ay * bx)
    if quantity == AREA:
        ratio = np.abs(areas) / mesh.rest_areas
    else:
        half = np.minimum(run.final_distortion.face_angle, 1e9) / 2
        ratio = half + np.sqrt(np.maximum(half**2 - 1, 0))
    return np.log2(np.maximum(ratio, 1e-9)), areas <= 0


def scale_svg(quantity: str) -> str:
    """The color scale of all maps of a quantity."""
    figure = Figure(figsize=(3.6, 0.62))
    axes = figure.add_axes((0.05, 0.62, 0.9, 0.3))
    mappable = ScalarMappable(Normalize(*_LIMITS[quantity]), _MAPS[quantity])
    bar = figure.colorbar(
        mappable, cax=axes, orientation="horizontal", extend="both" if quantity == AREA else "max"
    )
    bar.outline.set_linewidth(0.5)
    bar.set_ticks(list(np.linspace(*_LIMITS[quantity], 5)))
    bar.ax.tick_params(labelsize=7, width=0.5, length=2)
    figure.text(0.5, 0.06, _CAPTIONS[quantity], ha="center", fontsize=7)
    return _save(figure, "svg").decode()


def line_style(number: int) -> dict[str, Any]:
    """Color and line style of a method in all plots."""
    return {
        "color": _COLORS[number % len(_COLORS)],
        "linestyle": _LINE_STYLES[number // len(_COLORS) % len(_LINE_STYLES)],
    }


def lines_svg(
    curves: Sequence[tuple[str, Floats, Floats]], across: str, up: str, logarithmic: bool = True
) -> str:
    """A plot of curves (label, x, y), in the line styles of the legend. across, up: labels of the axes."""
    with rc_context(_STYLE):
        figure = Figure(figsize=(3.1, 2.4), layout="constrained")
        axes = figure.add_subplot()
        for number, (label, x, y) in enumerate(curves):
            shown = np.maximum(y, _MIN_LOG_VALUE) if logarithmic else y
            marker = "o" if len(x) < 8 else ""
            axes.plot(x, shown, label=label, linewidth=1.2, marker=marker, markersize=3, **line_style(number))
        if logarithmic:
            axes.set_yscale("log")
        axes.set(xlabel=across, ylabel=up)
        return _save(figure, "svg").decode()


def legend_svg(labels: Sequence[str]) -> str:
    """The legend of all plots."""
    with rc_context(_STYLE):
        rows = -(-len(labels) // 4)
        figure = Figure(figsize=(8, 0.2 * rows + 0.08))
        handles = [Line2D([], [], linewidth=1.6, **line_style(number)) for number in range(len(labels))]
        figure.legend(handles, labels, loc="center", ncols=min(4, len(labels)), frameon=False)
        return _save(figure, "svg").decode()
