"""From a picture's alpha channel to its mesh, in one step."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.mesh import TriMesh
from .outline import cut_out
from .triangulate import start_worker, triangulate

OUTLINE_SHARE = 0.35  # of the wanted vertices may be corners of the outline
COUNT_TOLERANCE = 0.08  # share above the wanted number from which on the outline is made coarser
MAX_TRIES = 4


@dataclass(frozen=True, eq=False)
class PictureMesh:
    """The mesh of a picture and what was left out of it.

    parts, holes: of the outline; specks: islands left out as too small; speck_area: theirs in square pixels.
    """

    mesh: TriMesh
    parts: int
    holes: int
    specks: int
    speck_area: float


def mesh_picture(
    alpha: NDArray[np.uint8], vertices: int = 2000, expand: float = 2.0, threshold: float = 0.5
) -> PictureMesh:
    """Cut a picture out along its alpha (h, w) uint8 and triangulate it.

    vertices: the wanted number; expand: pixels by which the outline moves outwards; threshold: share of full
    opacity at which the picture ends. Where so few vertices are wanted that a contour true to half a pixel
    would need more, the outline becomes coarser, outwards, as long as no parts join and no hole larger than
    a face closes.
    Raises InputError where there is nothing to cut out, or Triangle fails.
    """
    start_worker()  # starts while the outline is made
    most_points, reached = OUTLINE_SHARE * vertices, np.inf
    for _ in range(MAX_TRIES):
        cut = cut_out(alpha, threshold, expand, most_points=most_points)
        if cut.points >= reached:
            break
        reached = cut.points
        mesh = triangulate(cut.parts, vertices)
        if len(mesh.vertices) <= (1 + COUNT_TOLERANCE) * vertices:
            break
        most_points = 0.8 * reached
    return PictureMesh(mesh, len(cut.parts), cut.holes, cut.specks, cut.speck_area)
