"""Pictures and plots of a comparison, by matplotlib; they come back as bytes of PNG or text of SVG."""

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

# Colors that people with any color vision tell apart (Okabe and Ito 2008), then others by their lines.
_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
_LINES = ("-", "--", "-.", ":")
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
_DOTS = 110  # per inch, of pictures
_SIZE = 3.6  # inches: width of a picture, and most of its height
_LEAST = 1e-6  # of logarithmic axes

AREA, ANGLE = "area", "angle"
_MAPS = {AREA: "RdBu_r", ANGLE: "viridis_r"}
_LIMITS = {AREA: (-1.0, 1.0), ANGLE: (0.0, 1.0)}
_CAPTIONS = {
    AREA: "log₂ of the area of a face over its area at rest",
    ANGLE: "log₂ of the longer over the shorter principal stretch of a face",
}


def _styled(figure: Figure, kind: str) -> bytes:
    target = io.BytesIO()
    metadata = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
    figure.savefig(target, format=kind, metadata=metadata)
    return target.getvalue()


def _page(box: Box, face: str = "white") -> Figure:
    """A figure of one axes without frame that shows ``box`` of the drawing plane."""
    width, height = box[2] - box[0], box[3] - box[1]
    shrink = min(_SIZE / width, _SIZE / height)
    figure = Figure(figsize=(shrink * width, shrink * height), dpi=_DOTS, facecolor=face)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(box[0], box[2]), ylim=(box[3], box[1]), aspect="equal")
    axes.axis("off")
    return figure


def texture_png(run: Run, picture: NDArray[np.uint8], box: Box) -> bytes:
    """The bent drawing (h, w, 4) that fills ``box``, its pins, and their targets where they are not there."""
    figure = _page(box)
    axes = figure.axes[0]
    axes.imshow(picture, extent=(box[0], box[2], box[3], box[1]), interpolation="antialiased")
    places = run.drawing.mesh.evaluate(run.points, run.pose)
    for place, target in zip(places, run.targets, strict=True):
        axes.plot(*np.transpose([place, target]), color="#D55E00", linewidth=0.8)
    axes.scatter(places[:, 0], places[:, 1], s=16, c="#D55E00", edgecolors="white", linewidths=0.8, zorder=3)
    return _styled(figure, "png")


def map_png(run: Run, quantity: str, box: Box) -> bytes:
    """Area or angle distortion of each face in the pose, colors as in `scale_svg`; flipped faces in black."""
    mesh = run.drawing.mesh
    figure = _page(box)
    values, flipped = _face_values(run, quantity)
    colors = ScalarMappable(Normalize(*_LIMITS[quantity]), _MAPS[quantity]).to_rgba(values)
    colors[flipped] = (0, 0, 0, 1)
    faces = PolyCollection(list(run.pose[mesh.faces]), facecolors=colors, edgecolors=colors, linewidths=0.2)
    figure.axes[0].add_collection(faces)
    for loop in mesh.boundary_loops:
        figure.axes[0].plot(*run.pose[np.append(loop, loop[0])].T, color="#444444", linewidth=0.5)
    return _styled(figure, "png")


def _face_values(run: Run, quantity: str) -> tuple[Floats, NDArray[np.bool_]]:
    """What a map shows of each face (m,), and which faces are flipped.

    Of x + 1/x = d the solution above 1 is d/2 + √(d²/4 − 1).
    """
    mesh = run.drawing.mesh
    corners = run.pose[mesh.faces]
    (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    areas = 0.5 * (ax * by - ay * bx)
    if quantity == AREA:
        ratio = np.abs(areas) / mesh.rest_areas
    else:
        half = np.minimum(run.after.face_angle, 1e9) / 2
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
    return _styled(figure, "svg").decode()


def look(number: int) -> dict[str, Any]:
    """Color and line of a method in all plots."""
    return {
        "color": _COLORS[number % len(_COLORS)],
        "linestyle": _LINES[number // len(_COLORS) % len(_LINES)],
    }


def lines_svg(
    curves: Sequence[tuple[str, Floats, Floats]], across: str, up: str, logarithmic: bool = True
) -> str:
    """A plot of named curves (label, x, y); labels as in the legend, one look for each number of a curve."""
    with rc_context(_STYLE):
        figure = Figure(figsize=(3.1, 2.4), layout="constrained")
        axes = figure.add_subplot()
        for number, (label, x, y) in enumerate(curves):
            shown = np.maximum(y, _LEAST) if logarithmic else y
            marker = "o" if len(x) < 8 else ""
            axes.plot(x, shown, label=label, linewidth=1.2, marker=marker, markersize=3, **look(number))
        if logarithmic:
            axes.set_yscale("log")
        axes.set(xlabel=across, ylabel=up)
        return _styled(figure, "svg").decode()


def legend_svg(labels: Sequence[str]) -> str:
    """The legend of all plots."""
    with rc_context(_STYLE):
        rows = -(-len(labels) // 4)
        figure = Figure(figsize=(8, 0.2 * rows + 0.08))
        handles = [Line2D([], [], linewidth=1.6, **look(number)) for number in range(len(labels))]
        figure.legend(handles, labels, loc="center", ncols=min(4, len(labels)), frameon=False)
        return _styled(figure, "svg").decode()
