"""The overlaps of a pose, each with the decision which of its two sheets is in front."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry.mesh import TriMesh
from ..geometry.validation import Floats, Ints, freeze, read_only
from .circles import face_levels, low_and_high, satisfies, without_circles
from .common_area import common_areas
from .face_pairs import FacePairs, no_face_pairs, overlapping_faces
from .least_cut import cut_signs, spread_signs
from .memory import carried_signs, deciding_pairs, recalled_signs, tally
from .rules import Rules, RulesSource, signs_after_drag, size_squared
from .topology import Topology, face_centers, mesh_topology

_JUMP = 0.15  # share of the mesh's length: a region that moved less far on both sheets is the same one
_NEGLIGIBLE = 1e-4  # share of the mesh's area on which decisions may be dropped where regions grow together
_SEAM_TRAVEL = 2e-4  # share of the mesh's area that seams may pass over in one step
_PULL = 50.0  # a pair turned over costs its area over this part of the mesh's length
_GUESS = 0.3  # firmness of a sign that was inferred from a neighbor
_TRAVEL = 3e-4  # share of size² that may turn over in one step
_WEAK = 0.1  # firmness of signs beside a limb that is brought to the front
NO_CROSSINGS: Ints = freeze(np.zeros((0, 2), dtype=np.int32))


@dataclass(frozen=True, eq=False)
class Overlaps:
    """The overlapping pairs of faces of one pose and which face of each is in front.

    pairs: see `FacePairs`; signs: (p,) int8, 1 where the first face is in front, else −1; ages: (r,) rank of
    each region, the oldest 0; levels: (m,) int32, faces of a higher level are drawn later, None without
    overlaps; crossings: (s, 2) int32 upper and lower faces, from which `restored_overlaps` finds all signs
    again: one pair of each region, the oldest first, and of a region with a seam all pairs along it.
    """

    pairs: FacePairs
    signs: Ints
    ages: Ints
    levels: Ints | None
    crossings: Ints

    def __len__(self) -> int:
        return len(self.pairs)

    @cached_property
    def has_seam(self) -> bool:
        """Whether there is a region in which not all pairs have the same sign."""
        if not len(self):
            return False
        begins = np.searchsorted(self.pairs.regions, np.arange(self.pairs.region_count))
        least, most = (choose.reduceat(self.signs, begins) for choose in (np.minimum, np.maximum))
        return bool((least != most).any())

    @property
    def low_and_high(self) -> tuple[Ints, Ints]:
        """The lower and the upper face of each pair, (p,) int32 each."""
        low, high = low_and_high(self.pairs.first, self.pairs.second, self.signs)
        return low, high


def no_overlaps(mesh: TriMesh, crossings: Ints = NO_CROSSINGS) -> Overlaps:
    """The overlaps of a pose that does not overlap, or that is crumpled beyond any order."""
    none = np.zeros(0, dtype=np.int8)
    return Overlaps(no_face_pairs(len(mesh.faces)), none, none.astype(np.int64), None, crossings)


def next_overlaps(
    mesh: TriMesh, pose: Floats, before: Overlaps, rules: RulesSource = Rules, other: Overlaps | None = None
) -> Overlaps:
    """The overlaps of a pose (n, 2) that follows another one, whose decisions stay.

    A region takes the sign that its pairs had ``before``; where overlaps with different decisions have grown
    together, both stay, with a seam between them. ``rules`` decide on regions that were not there; ``other``,
    overlaps of a third pose of the mesh, goes before them. All but the levels depends on the arguments only,
    and not on the levels ``before``.
    """
    topology = mesh_topology(mesh)
    pairs = overlapping_faces(topology, pose, len(before))
    if not len(pairs):
        return no_overlaps(mesh)
    if not pairs.is_complete:
        return no_overlaps(mesh, before.crossings)
    decision = _Decision(mesh, topology, pose, pairs)
    decision.carry_over(before, mesh)
    if other is not None:
        decision.carry_over(other, mesh)
    decision.decide_new(before, rules)
    decision.part_contradictions()
    arguments = mesh, decision.pose, pairs, decision.signs, decision.known, decision.ages, rules
    swept = signs_after_drag(*arguments, _TRAVEL * size_squared(mesh) - _SEAM_TRAVEL * mesh.length**2)
    return decision.result(before, swept)


def transferred_overlaps(
    mesh: TriMesh, pose: Floats, old: Overlaps, old_mesh: TriMesh, faces: Ints, rules: RulesSource = Rules
) -> Overlaps:
    """The overlaps of a pose (n, 2) with the decisions of a like pose of another mesh of the drawing.

    faces: (m,) int32 the face of ``old_mesh`` at the center of each face of ``mesh``.
    """
    topology = mesh_topology(mesh)
    pairs = overlapping_faces(topology, pose, len(old))
    if not len(pairs) or not pairs.is_complete:
        return no_overlaps(mesh)
    decision = _Decision(mesh, topology, pose, pairs)
    decision.carry_over(old, old_mesh, faces)
    decision.decide_new(no_overlaps(mesh), rules)
    decision.part_contradictions()
    return decision.result(no_overlaps(mesh))


def restored_overlaps(mesh: TriMesh, pose: Floats, crossings: Ints, rules: RulesSource = Rules) -> Overlaps:
    """The overlaps of a pose (n, 2) with the decisions ``crossings`` (s, 2) of `Overlaps`.

    ``rules`` decide on regions of which ``crossings`` has no pair.
    """
    topology = mesh_topology(mesh)
    pairs = overlapping_faces(topology, pose)
    crossings = freeze(crossings[((crossings >= 0) & (crossings < len(mesh.faces))).all(axis=1)])
    if not len(pairs) or not pairs.is_complete:
        return no_overlaps(mesh, crossings if len(pairs) else NO_CROSSINGS)
    decision = _Decision(mesh, topology, pose, pairs)
    decision.take_over(crossings)
    decision.decide_new(no_overlaps(mesh), rules)
    return decision.result(no_overlaps(mesh, crossings))


def asked_overlaps(mesh: TriMesh, pose: Floats, overlaps: Overlaps, limb: Ints, to_front: bool) -> Overlaps:
    """The same overlaps with a limb in front of, or behind, all that it overlaps.

    limb: (m,) whether each face belongs to it. A region turns over as a whole if it only concerns the limb on
    one of its sheets; else it is cut where the seam is seen least. The regions that changed count as the
    oldest from now on, so that others give way to them.
    """
    pairs = overlaps.pairs
    if not len(pairs):
        return overlaps
    decision = _Decision(mesh, mesh_topology(mesh), pose, pairs)
    decision.signs = overlaps.signs.copy()
    on_first, on_second = limb[pairs.first], limb[pairs.second]
    wanted = (on_first.astype(np.int8) - on_second) * (1 if to_front else -1)
    decision.ages = 1 + overlaps.ages
    for region in range(decision.count):
        members = decision.members(region)
        asked = wanted[members]
        if not asked.any():
            continue
        decision.ages[region] = 0
        if asked.min() >= 0 or asked.max() <= 0:
            decision.signs[members] = 1 if asked.max() > 0 else -1
            continue
        signs = decision.signs.copy()
        signs[members] = np.where(asked, asked, signs[members])
        firmness = np.where(wanted, 1.0, _WEAK) * _PULL / mesh.length
        hidden = decision.hidden(region)
        steps = len(members)  # the seam may be anywhere
        decision.signs = cut_signs(
            decision.topology, decision.pose, pairs, members, signs, firmness, hidden, steps
        )
    decision.firm = np.where(decision.signs == wanted, wanted, 0).astype(np.int8)
    return overlaps if np.array_equal(decision.signs, overlaps.signs) else decision.result(overlaps)


def overlaps_by_depth(
    mesh: TriMesh, pose: Floats, overlaps: Overlaps, before: Rules, after: Rules
) -> Overlaps:
    """The overlaps after depths of pins have changed: regions on which they say otherwise turn over."""
    if not len(overlaps):
        return overlaps
    pairs = overlaps.pairs
    decision = _Decision(mesh, mesh_topology(mesh), pose, pairs)
    decision.signs, decision.ages = overlaps.signs.copy(), 1 + overlaps.ages
    for region in range(decision.count):
        members = decision.members(region)
        sheets = pairs.first[members], pairs.second[members], decision.areas(members)
        sign = after.depth_sign(*sheets)
        if sign and sign != before.depth_sign(*sheets):
            decision.signs[members] = sign
            decision.ages[region] = 0
    return overlaps if np.array_equal(decision.signs, overlaps.signs) else decision.result(overlaps)


class _Decision:
    """The signs of one pose's pairs while they are decided.

    known: (p,) whether the pair was there in a pose that decides; firm: (p,) int8 signs that no circle turns
    over, 0 for none. Those of one pose never contradict one another.
    """

    def __init__(self, mesh: TriMesh, topology: Topology, pose: Floats, pairs: FacePairs) -> None:
        self.mesh, self.topology, self.pose, self.pairs = mesh, topology, read_only(pose), pairs
        self.count = pairs.region_count
        self.signs = np.zeros(len(pairs), dtype=np.int8)
        self.known = np.zeros(len(pairs), dtype=bool)
        self.firm = np.zeros(len(pairs), dtype=np.int8)
        self.ages = np.full(self.count, np.iinfo(np.int64).max)  # no region is younger than a new one
        self.contradictory: list[int] = []  # regions with both signs
        self.ends = np.searchsorted(pairs.regions, np.arange(self.count + 1))

    def members(self, region: int) -> Ints:
        """Indices of the pairs of a region."""
        return np.arange(self.ends[region], self.ends[region + 1])

    @property
    def arrays(self) -> tuple[Ints, Ints, Ints, Ints, Ints, Ints]:
        """What the compiled functions read of the pairs."""
        pairs = self.pairs
        return pairs.first, pairs.second, self.topology.neighbors, pairs.heads, pairs.starts, pairs.links

    def areas(self, members: Ints) -> Floats:
        """The area that each of some pairs has in common, square pixels."""
        first, second = self.pairs.first[members], self.pairs.second[members]
        return common_areas(self.pose, self.topology.faces, first, second)

    def carry_over(self, before: Overlaps, mesh: TriMesh, faces: Ints | None = None) -> None:
        """Give each region without a sign that of its pairs in another pose, of this mesh or another one.

        faces: (m,) the face of the other mesh at each face of this one.
        """
        old = before.pairs
        if not len(before):
            return
        first, second = self.pairs.first, self.pairs.second
        if faces is not None:
            first, second = faces[first], faces[second]
        signs, sources, known = carried_signs(
            first,
            second,
            old.first,
            old.second,
            old.regions,
            before.signs,
            old.heads,
            old.starts,
            old.links,
            face_centers(mesh),
            mesh.length,
        )
        votes, guesses, ages = tally(self.pairs.regions, signs, known, sources, before.ages, self.count)
        if not self.known.any():
            self.firm[known] = signs[known]
        is_open = self.signs[self.ends[:-1]] == 0
        negligible = _NEGLIGIBLE * self.mesh.length**2
        self.ages[is_open] = ages[is_open]
        self.known |= known
        for region in np.flatnonzero(is_open).tolist():
            # Pairs that were there outvote all others; guesses speak where none was.
            counts = votes[region] if votes[region].any() else guesses[region]
            if not counts.any():
                continue
            begin, end = self.ends[region], self.ends[region + 1]
            if not votes[region].min() and not guesses[region].min():
                self.signs[begin:end] = 1 if counts[0] else -1
                continue
            mine = signs[begin:end]
            minority = 1 if counts[0] < counts[1] else -1
            members = begin + np.flatnonzero(mine == minority)
            dissent = guesses[region, 0 if minority > 0 else 1]
            is_unanimous = not votes[region].min() and 2 * votes[region].max() >= dissent
            area = 0.0 if is_unanimous else self.areas(members).sum()
            if area <= negligible:
                self.signs[begin:end] = -minority
                negligible -= area
            else:
                self.signs[begin:end] = mine
                self.contradictory.append(region)

    def take_over(self, crossings: Ints) -> None:
        """Give each pair the sign of the rows of ``crossings`` that are nearest to it within its region."""
        self.signs, self.ages = recalled_signs(self.topology, self.pairs, crossings)

    def decide_new(self, before: Overlaps, rules: RulesSource) -> None:
        """Give the regions without a sign one: of an old region nearby, else by the rules."""
        fresh = [r for r in range(self.count) if not self.signs[self.ends[r] : self.ends[r + 1]].any()]
        if not fresh:
            return
        old_sheets = _sheet_centers(self.mesh, before)
        given = None
        for region in fresh:
            members = self.members(region)
            first, second = self.pairs.first[members], self.pairs.second[members]
            self.signs[members] = 1
            centers = [face_centers(self.mesh)[np.unique(faces)].mean(axis=0) for faces in (first, second)]
            near = [
                (float(np.abs(np.stack(centers) - sheets[::step]).max()), step)
                for sheets in old_sheets
                for step in (1, -1)
            ]
            if near and min(near)[0] < _JUMP * self.mesh.length:
                self.signs[members] = min(near)[1]
                continue
            given = rules() if given is None else given
            self.signs[members] = given.sign(self.mesh, first, second, self.areas(members))

    def by_age(self) -> Ints:
        """The regions, the oldest first and of one age the largest."""
        return np.lexsort((-np.diff(self.ends), self.ages))

    def part_contradictions(self) -> None:
        """Cut the regions in which two decisions have met, along the least visible seams."""
        if not self.contradictory:
            return
        allowed = _SEAM_TRAVEL * self.mesh.length**2 / len(self.contradictory)
        for region in self.contradictory:
            members = self.members(region)
            spread_signs(members, self.signs, *self.arrays, bool(self.pairs.exchanged[region]))
            hidden = self.hidden(region)
            wanted = self.signs
            firmness = np.full(len(self.pairs), _PULL / self.mesh.length)
            firmness[~self.known] *= _GUESS
            for _ in range(4):
                signs = cut_signs(self.topology, self.pose, self.pairs, members, wanted, firmness, hidden)
                turned = np.flatnonzero((signs != wanted) & self.known)
                if self.areas(turned).sum() <= allowed:
                    self.signs = signs
                    break
                firmness[self.known] *= 16.0

    def hidden(self, region: int) -> Ints:
        """Whether each pair is below a third sheet."""
        low, high = low_and_high(self.pairs.first, self.pairs.second, self.signs)
        covered = np.zeros(len(self.topology.faces), dtype=bool)
        covered[low[self.pairs.regions != region]] = True
        hidden: Ints = covered[high]
        return hidden

    def result(self, before: Overlaps, swept: Ints | None = None) -> Overlaps:
        """The decisions without circles, with the pairs that restore them.

        swept: signs (p,) that are preferred if no circle arises.
        """
        pairs, m = self.pairs, len(self.topology.faces)
        order = self.by_age()
        ages = np.empty(self.count, dtype=np.int64)
        ages[order] = np.arange(self.count)
        for signs in (self.signs,) if swept is None else (swept, self.signs):
            low, high = low_and_high(pairs.first, pairs.second, signs)
            levels = before.levels
            if levels is not None and satisfies(levels, low, high):
                placed = np.ones(m, dtype=bool)
            else:
                levels, placed = face_levels(m, low, high)
            if placed.all():
                self.signs = signs
                break
        else:
            self.signs, levels = without_circles(
                m, pairs.first, pairs.second, pairs.regions, self.signs, ages, self.firm
            )
        old = before.crossings
        crossings = deciding_pairs(self.topology, self.pose, pairs, self.signs, order, old)
        return Overlaps(pairs, freeze(self.signs), ages, levels, crossings)


def _sheet_centers(mesh: TriMesh, overlaps: Overlaps) -> list[Floats]:
    """For each region the middles of its upper and its lower sheet at rest, (2, 2)."""
    if not len(overlaps):
        return []
    low, high = overlaps.low_and_high
    result = []
    for region in range(overlaps.pairs.region_count):
        mine = overlaps.pairs.regions == region
        sheets = [face_centers(mesh)[np.unique(faces[mine])].mean(axis=0) for faces in (high, low)]
        result.append(np.stack(sheets))
    return result
