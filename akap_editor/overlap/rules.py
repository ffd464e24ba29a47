"""Which sheet is in front where two meet that have not met before."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints
from .common_area import common_areas
from .face_pairs import FacePairs
from .limbs import mesh_limbs
from .topology import mesh_topology

DEPTH_TOLERANCE = 0.5  # levels by which depths of two sheets must differ
_DRAG_TOLERANCE = 0.02  # share of the mesh's length by which one sheet must be nearer to what is dragged
_BRUSH = 6e-3  # share of size²: where less of a sheet is in front of what is dragged, they have not met yet
_LARGEST_BRUSH = 24e-3  # share of size² of the region in which that is so
_PAIRS_PER_FACE = 16  # of a region, at most
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
        by_drag = self.drag_sign(mesh, first, second, areas)
        if by_drag:
            return by_drag
        weights = areas + 1e-9 * mesh.length**2
        limb = self._limb(mesh, first, second, weights)
        if limb:
            return limb
        distances = mesh_limbs(mesh).distances
        farther = float(np.average(distances[first] - distances[second], weights=weights))
        return 1 if farther >= 0 else -1

    def drag_sign(self, mesh: TriMesh, first: Ints, second: Ints, areas: Floats) -> int:
        """1 or −1 as depths of pins or a drag want it; 0 where they do not tell the sheets apart."""
        by_depth = self.depth_sign(first, second, areas)
        if by_depth or self.dragged is None:
            return by_depth
        weights = areas + 1e-9 * mesh.length**2
        nearer = float(np.average(self.dragged[second] - self.dragged[first], weights=weights))
        if abs(nearer) <= _DRAG_TOLERANCE * mesh.length:
            return 0
        dragged = 1 if nearer > 0 else -1
        shares = mesh_limbs(mesh).shares
        if np.average(shares[first if dragged > 0 else second], weights=weights) <= TRUNK_SHARE:
            return dragged
        return self._limb(mesh, first, second, weights) or dragged

    @staticmethod
    def _limb(mesh: TriMesh, first: Ints, second: Ints, weights: Floats) -> int:
        """1 if the first sheet is the limb of the two, −1 if the second is, else 0."""
        shares = mesh_limbs(mesh).shares
        on_first, on_second = (float(np.average(shares[faces], weights=weights)) for faces in (first, second))
        if max(on_first, on_second) * _LIMB_RATIO <= min(on_first, on_second):
            return 0
        return 1 if on_first < on_second else -1

    def depth_sign(self, first: Ints, second: Ints, areas: Floats) -> int:
        """1 or −1 as the depths of pins want it; 0 where they do not tell the sheets apart."""
        if self.depths is None:
            return 0
        difference = float(np.average(self.depths[first] - self.depths[second], weights=areas + 1e-12))
        return int(np.sign(difference)) if abs(difference) > DEPTH_TOLERANCE else 0


RulesSource = Callable[[], Rules]


def signs_after_drag(
    mesh: TriMesh,
    pose: Floats,
    pairs: FacePairs,
    signs: Ints,
    known: Ints,
    ages: Ints,
    rules: RulesSource,
    budget: float,
) -> Ints | None:
    """Signs (p,) that bring what is dragged to the front in small regions; None if nothing changes.

    Where two limbs begin to touch, their outlines decide whether the overlap is the fringe of an older
    region, whose sign it has, or a new one. So a small part that is no longer connected to the rest of its
    region takes the sign of a new one, gradually. Other regions stay as they were, or were asked to be.

    signs: (p,) int8; known: (p,) whether each pair was there before; ages: (r,) rank of each region before,
    that of the same one for parts of it; budget: area of known pairs that may turn over, square pixels.
    """
    if len(ages) < 2:
        return None
    result, size2, given = signs.copy(), size_squared(mesh), None
    ends = np.searchsorted(pairs.regions, np.arange(pairs.region_count + 1))
    by_age = np.lexsort((-np.diff(ends), ages))
    has_split = np.zeros(len(ages), dtype=bool)
    has_split[by_age[1:]] = ages[by_age[1:]] == ages[by_age[:-1]]
    faces = mesh_topology(mesh).faces
    most_pairs = _PAIRS_PER_FACE * _LARGEST_BRUSH * size2 / mesh.rest_areas.mean()
    for region in by_age.tolist():
        members = np.arange(ends[region], ends[region + 1])
        own = signs[members]
        is_turning = region != by_age[0] and own.min() != own.max()
        if len(members) > most_pairs or not (has_split[region] or is_turning):
            continue
        given = rules() if given is None else given
        if given.dragged is None:
            return None
        first, second = pairs.first[members], pairs.second[members]
        areas = common_areas(pose, faces, first, second)
        if areas.sum() > _LARGEST_BRUSH * size2:
            continue
        sign = given.drag_sign(mesh, first, second, areas)
        is_wrong = own == -sign
        if not sign or not is_wrong.any() or areas[is_wrong].sum() > _BRUSH * size2:
            continue
        is_new = ~known[members]
        centers = pose[faces[np.stack([first, second])]].mean(axis=(0, 2))
        swept = _swept(centers, areas, is_wrong & ~is_new, budget)
        budget -= areas[swept].sum()
        result[members[is_wrong & is_new]] = sign
        result[members[swept]] = sign
    return None if np.array_equal(result, signs) else result


@lru_cache(maxsize=8)
def size_squared(mesh: TriMesh) -> float:
    """The square of the larger side of a mesh's box at rest, square pixels; cached."""
    return float(np.ptp(mesh.vertices, axis=0).max()) ** 2


def _swept(centers: Floats, areas: Floats, chosen: Ints, budget: float) -> Ints:
    """Indices of the pairs over which a straight line has moved when it has spent a budget.

    centers: (q, 2) of all pairs; areas: (q,) cost of each; chosen: (q,) whether the line moves over it, from
    the side where the others are.
    """
    indices = np.flatnonzero(chosen)
    if not len(indices):
        return indices
    away = centers[indices].mean(axis=0) - centers.mean(axis=0)
    along = centers[indices] @ (away if away.any() else np.array([1.0, 0.0]))
    indices = indices[np.argsort(along, kind="stable")]
    return indices[np.cumsum(areas[indices]) <= budget]
