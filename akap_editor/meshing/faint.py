"""Faint parts of pictures: thresholds that suit faint drawings, and how much of a picture is left out."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from ..geometry.mesh import TriMesh

MIN_VISIBLE = 10  # of 255: fainter pixels are not seen on any background
DEFAULT_THRESHOLD = 0.5


def fitting_threshold(alpha: NDArray[np.uint8], threshold: float = DEFAULT_THRESHOLD) -> float:
    """``threshold``, or half the opacity of the most opaque pixel if all of ``alpha`` (h, w) is below it."""
    most = int(alpha.max(initial=0))
    if most > 255 * threshold or most < MIN_VISIBLE:
        return threshold
    return round(most / 255 / 2, 3)


def faint_share(alpha: NDArray[np.uint8], mesh: TriMesh, threshold: float) -> float:
    """Share of the visible pixels of ``alpha`` (h, w) that are fainter than a threshold and outside a mesh.

    Visible are pixels of at least `MIN_VISIBLE`.
    """
    visible = alpha >= MIN_VISIBLE
    count = int(visible.sum())
    if not count:
        return 0.0
    faint = visible & (alpha <= 255 * threshold) & ~_covered_pixels(mesh, alpha.shape)
    return int(faint.sum()) / count


def _covered_pixels(mesh: TriMesh, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Whether the rest mesh covers each pixel, (h, w)."""
    picture = Image.new("1", (shape[1], shape[0]))
    draw = ImageDraw.Draw(picture)
    rings = [mesh.vertices[loop] for loop in mesh.boundary_loops]
    areas = [float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum()) for x, y in (ring.T for ring in rings)]
    for number in np.argsort(-np.abs(areas)).tolist():  # what is inside a hole is drawn after it
        draw.polygon([tuple(point) for point in (rings[number] - 0.5).tolist()], fill=int(areas[number] > 0))
    return np.asarray(picture)
