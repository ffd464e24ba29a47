"""Meshes the visible part of a picture."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.mesh import TriMesh
from ..geometry.validation import as_number
from ..progress import announce
from ..words import tr
from .mesher_process import MESHER_PROCESS
from .meshers import check_mesher
from .outline import cut_out
from .slits import Cut
from .triangulate import MAX_VERTICES, MIN_VERTICES, triangulate

OUTLINE_SHARE = 0.35  # of the requested vertices that may be corners of the outline
EXCESS_TOLERANCE = 0.08  # share of vertices too many above which the outline is simplified further
MAX_OUTLINES = 4
CUT_REACH = 2.0  # pixels: a stroke that ends so near to the visible rim cuts through it


@dataclass(frozen=True, eq=False)
class PictureMesh:
    """The mesh of a picture.

    parts, holes: their numbers in the outline; specks: number of parts left out as too small; speck_area:
    their total area in square pixels.
    """

    mesh: TriMesh
    parts: int
    holes: int
    specks: int
    speck_area: float


def mesh_picture(
    alpha: NDArray[np.uint8],
    vertices: int = 2000,
    expand: float = 2.0,
    threshold: float = 0.5,
    mesher: str | None = None,
    cuts: Sequence[Cut] = (),
) -> PictureMesh:
    """Triangulate the visible part of a picture with the alpha channel ``alpha`` (h, w) uint8.

    vertices: the requested number; expand: pixels by which the outline moves outwards; threshold: share of
    full opacity at which the picture ends; mesher: see `triangulate`; cuts: strokes, in pixels, along which
    the mesh is open, see `slits`. If an outline that is exact to half a
    pixel would need more vertices, it is simplified, outwards, as long as no parts join and no hole larger
    than a face closes.
    Raises InputError if nothing is visible, for arguments out of range, or if the mesher fails.
    """
    as_number(vertices, "vertices", MIN_VERTICES, MAX_VERTICES)
    mesher = check_mesher(mesher)
    MESHER_PROCESS.start()  # it starts while the outline is computed
    max_points, fewest = OUTLINE_SHARE * vertices, np.inf
    for number in range(MAX_OUTLINES):
        share = 1 - 0.5**number  # an unknown number of rounds, each less likely than the one before
        announce(share, tr("Finding the outline"))
        cut = cut_out(alpha, threshold, expand, max_points=max_points)
        if cut.points >= fewest:
            break
        fewest = cut.points
        announce(
            share + 0.25 * 0.5**number,
            tr("Triangulating {points:,} points of the outline", points=cut.points),
        )
        mesh = triangulate(cut.parts, vertices, mesher, cuts, expand + CUT_REACH)
        if len(mesh.vertices) <= (1 + EXCESS_TOLERANCE) * vertices:
            break
        max_points = 0.8 * fewest
    return PictureMesh(mesh, len(cut.parts), cut.holes, cut.specks, cut.speck_area)
