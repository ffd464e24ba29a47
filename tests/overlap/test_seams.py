"""Seams are straight lines: faces are cut along them, and nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.geometry.mesh import signed_areas
from akap_editor.overlap.overlaps import Overlaps
from akap_editor.overlap.seams import CutMesh, cut_along_seams
from tests.overlap.test_overlaps import ROPE, rolled_up, rope_pose

POSE = rope_pose(1.0)


def with_seam(overlaps: Overlaps) -> Overlaps:
    """The same overlaps, with a ragged seam across the first region."""
    middles = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0]
    signs, first = overlaps.signs.copy(), overlaps.pairs.first
    mine = overlaps.pairs.regions == 0
    signs[mine] = np.where(middles[first[mine]] < np.median(middles[first[mine]]), 1, -1)
    return replace(overlaps, signs=signs)


@pytest.fixture(scope="module")
def cut() -> CutMesh:
    overlaps = with_seam(rolled_up())
    assert overlaps.has_seam
    result = cut_along_seams(ROPE, overlaps, np.arange(len(ROPE.faces)))
    assert result is not None
    return result


def test_overlaps_without_a_seam_are_not_cut() -> None:
    overlaps = rolled_up()
    assert not overlaps.has_seam
    assert cut_along_seams(ROPE, overlaps, np.arange(len(ROPE.faces))) is None


def test_the_parts_of_a_cut_face_cover_it_exactly(cut: CutMesh) -> None:
    for pose in (ROPE.vertices, POSE):
        areas = signed_areas(cut.values(pose), cut.faces)
        assert areas.min() > 0
        sums = np.bincount(cut.sources, areas, len(ROPE.faces))
        np.testing.assert_allclose(sums, signed_areas(pose, ROPE.faces), rtol=1e-9)


def test_only_faces_beside_the_seam_are_cut(cut: CutMesh) -> None:
    counts = np.bincount(cut.sources, minlength=len(ROPE.faces))
    assert set(counts.tolist()) == {1, 3}
    assert 2 <= (counts == 3).sum() <= 12
    assert len(cut.edges) == (counts == 3).sum() + 1, "one line across neighboring faces"


def test_both_sides_of_the_line_are_arranged(cut: CutMesh) -> None:
    """Of a cut face one part is drawn before the faces of the other sheet, and one after them."""
    rank = np.empty(len(cut.faces), dtype=np.int64)
    overlaps = with_seam(rolled_up())
    first, second = overlaps.pairs.first, overlaps.pairs.second
    rank = np.arange(len(cut.faces))
    for face in np.flatnonzero(np.bincount(cut.sources) == 3):
        partners = second[(first == face) & (overlaps.pairs.regions == 0)]
        parts = rank[cut.sources == face]
        others = rank[np.isin(cut.sources, partners)]
        assert parts.min() < others.min()
        assert parts.max() > others.max()
