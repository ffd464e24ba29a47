"""Which sheet is in front where two meet that have not met before."""

from dataclasses import dataclass

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints
from .limbs import mesh_limbs

DEPTH_TOLERANCE = 0.5  # levels by which depths of two sheets must differ
_DRAG_TOLERANCE = 0.02  # share of the mesh's length by which one sheet must be nearer to what is dragged
TRUNK_SHARE = 0.4  # of the drawing: a larger branch is no limb
_LIMB_RATIO = 0.5  # a branch smaller than this share of the other one is the limb of the two


@dataclass(frozen=True, eq=False)
class Rules:
    """What decides on sheets that meet for the first time.

    depths: (m,) level of each face by the depths of pins; dragged: (m,) distance of each face from what is
    dragged, through the drawing, in pixels. None where that decides nothing.
    """

    depths: Floats | None = None
    dragged: Floats | None = None

    def sign(self, mesh: TriMesh, first: Ints, second: Ints, areas: Floats) -> int:
        """1 if the sheet of the faces ``first`` (q,) is to be in front of that of ``second``, else −1.

        areas: (q,) that the pairs have in common. The higher depth is in front; else what is dragged, unless
        that is the trunk and the other one a limb; else the smaller branch; else what is farther from the
        middle of the drawing.
        """
        by_depth = self.depth_sign(first, second, areas)
        if by_depth:
            return by_depth
        weights = areas + 1e-9 * mesh.length**2
        limbs = mesh_limbs(mesh)
        shares = [float(np.average(limbs.shares[faces], weights=weights)) for faces in (first, second)]
        limb = 0 if shares[0] <= shares[1] else 1
        is_limb = shares[limb] < _LIMB_RATIO * shares[1 - limb]
        if self.dragged is not None:
            nearer = float(np.average(self.dragged[second] - self.dragged[first], weights=weights))
            if abs(nearer) > _DRAG_TOLERANCE * mesh.length:
                dragged = 0 if nearer > 0 else 1
                is_trunk_over_limb = is_limb and dragged != limb and shares[dragged] > TRUNK_SHARE
                return 1 if (limb if is_trunk_over_limb else dragged) == 0 else -1
        if is_limb:
            return 1 if limb == 0 else -1
        farther = float(np.average(limbs.distances[first] - limbs.distances[second], weights=weights))
        return 1 if farther >= 0 else -1

    def depth_sign(self, first: Ints, second: Ints, areas: Floats) -> int:
        """1 or −1 as the depths of pins want it; 0 where they do not tell the sheets apart."""
        if self.depths is None:
            return 0
        difference = float(np.average(self.depths[first] - self.depths[second], weights=areas + 1e-12))
        return int(np.sign(difference)) if abs(difference) > DEPTH_TOLERANCE else 0
