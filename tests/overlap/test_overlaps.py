"""Laws of the decisions which sheet is in front, on random drags and on a rope."""

import numpy as np
import pytest

from akap_editor.deform.methods import make_deformer, method_names
from akap_editor.geometry.mesh import TriMesh, signed_areas
from akap_editor.overlap.circles import satisfies
from akap_editor.overlap.common_area import common_areas
from akap_editor.overlap.face_pairs import MAX_PAIRS_PER_FACE
from akap_editor.overlap.overlaps import (
    Overlaps,
    asked_overlaps,
    next_overlaps,
    no_overlaps,
    overlaps_by_depth,
    restored_overlaps,
)
from akap_editor.overlap.rules import Rules
from tests.support.bends import random_drag, trefoil
from tests.support.shapes import SHAPES, blocks, renumbered

CROSS = blocks(".#. ### .#.", 60.0, 5, 0.2)
ROPE = blocks("#" * 25, 40.0, 3, 0.2)
SEAM_TRAVEL = 3e-4  # share of size² that may turn over beside a seam


def decided(overlaps: Overlaps) -> set[tuple[int, int]]:
    """All pairs as (lower face, upper face)."""
    low, high = overlaps.low_and_high
    return set(zip(low.tolist(), high.tolist(), strict=True))


def has_seam(overlaps: Overlaps) -> bool:
    regions, signs = overlaps.pairs.regions, overlaps.signs
    return any(len(set(signs[regions == r].tolist())) > 1 for r in range(overlaps.pairs.region_count))


def turned_area(mesh: TriMesh, pose: np.ndarray, before: Overlaps, after: Overlaps) -> float:
    """Area of the pairs that turned over from one pose to the next, as a share of size²."""
    turned = sorted({(high, low) for low, high in decided(before)} & decided(after))
    if not turned:
        return 0.0
    first, second = np.array(turned, dtype=np.int32).T
    return common_areas(pose, mesh.faces, first, second).sum() / np.ptp(mesh.vertices, axis=0).max() ** 2


def rope_pose(share: float) -> np.ndarray:
    return trefoil(ROPE, 1000, 20, share)


def rolled_up(mesh: TriMesh = ROPE) -> Overlaps:
    overlaps = no_overlaps(mesh)
    for share in np.linspace(0, 1, 41)[1:]:
        overlaps = next_overlaps(mesh, rope_pose(share), overlaps)
    return overlaps


@pytest.mark.parametrize("name", ["bar", "L", "star", "ring", "islands"])
@pytest.mark.parametrize("seed", range(3))
def test_decisions_hold_and_last_in_random_drags(name: str, seed: int) -> None:
    mesh = SHAPES[name]
    overlaps = no_overlaps(mesh)
    for pose in random_drag(mesh, seed):
        if signed_areas(pose, mesh.faces).min() <= 0:
            break
        following = next_overlaps(mesh, pose, overlaps)
        if len(following):
            assert satisfies(following.levels, *following.low_and_high), "a circle is left"
            restored = restored_overlaps(mesh, pose, following.crossings)
            assert np.array_equal(restored.signs, following.signs)
            assert np.array_equal(restored.ages, following.ages)
            turned = turned_area(mesh, pose, overlaps, following)
            assert turned <= (SEAM_TRAVEL if has_seam(following) else 0.0)
        overlaps = following


@pytest.mark.parametrize("seed", range(3))
def test_renumbering_changes_nothing(seed: int) -> None:
    other, vertices, numbers = renumbered(CROSS, seed)
    faces = np.argsort(numbers)
    first, second = no_overlaps(CROSS), no_overlaps(other)
    for pose in random_drag(CROSS, seed):
        first, second = next_overlaps(CROSS, pose, first), next_overlaps(other, pose[vertices], second)
        there = {(int(faces[low]), int(faces[high])) for low, high in decided(second)}
        assert there == decided(first) or has_seam(first)


def test_a_rope_keeps_its_crossings_and_each_can_be_asked_for() -> None:
    overlaps, pose = rolled_up(), rope_pose(1.0)
    assert overlaps.pairs.region_count == 3
    assert not has_seam(overlaps)
    middles = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0]
    for region in range(3):
        mine = overlaps.pairs.regions == region
        low, high = (faces[mine] for faces in overlaps.low_and_high)
        limb = np.abs(middles - middles[low].mean()) < 60
        asked = asked_overlaps(ROPE, pose, overlaps, limb, to_front=True)
        turned = decided(overlaps) - decided(asked)
        assert turned == set(zip(low.tolist(), high.tolist(), strict=True)), "that region only, as a whole"
        assert satisfies(asked.levels, *asked.low_and_high)
        back = asked_overlaps(ROPE, pose, asked, limb, to_front=False)
        assert decided(back) == decided(overlaps)
        again = restored_overlaps(ROPE, pose, asked.crossings)
        assert decided(again) == decided(asked)


def test_depths_of_pins_decide_and_a_change_of_depths_turns_over() -> None:
    middles = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0]
    rising, falling = Rules(depths=middles / 10), Rules(depths=-middles / 10)
    pose = rope_pose(1.0)
    overlaps = restored_overlaps(ROPE, pose, np.zeros((0, 2), dtype=np.int32), lambda: rising)
    low, high = overlaps.low_and_high
    assert (middles[high] > middles[low]).all()
    same = overlaps_by_depth(ROPE, pose, overlaps, rising, Rules(depths=middles / 5))
    assert same is overlaps
    turned = overlaps_by_depth(ROPE, pose, overlaps, rising, falling)
    assert decided(turned) == {(high, low) for low, high in decided(overlaps)}


def test_the_dragged_limb_is_in_front_and_a_limb_before_the_trunk() -> None:
    drawing = blocks("######### ...###... ...###...", 60.0, 3, 0.1)
    middles = drawing.vertices[drawing.faces].mean(axis=1)
    arm = np.flatnonzero((middles[:, 0] < 60) & (middles[:, 1] < 60))
    other_arm = np.flatnonzero((middles[:, 0] > 480) & (middles[:, 1] < 60))
    trunk = np.flatnonzero((np.abs(middles[:, 0] - 270) < 30) & (np.abs(middles[:, 1] - 90) < 30))

    def sign(first: np.ndarray, second: np.ndarray, dragged: np.ndarray | None) -> int:
        count = min(len(first), len(second))
        distances = None
        if dragged is not None:
            distances = np.linalg.norm(middles - middles[dragged].mean(axis=0), axis=1)
        return Rules(None, distances).sign(drawing, first[:count], second[:count], np.ones(count))

    assert sign(arm, other_arm, arm) == sign(other_arm, arm, other_arm) == 1
    assert sign(arm, trunk, arm) == sign(arm, trunk, None) == 1
    assert sign(arm, trunk, trunk) == 1, "the trunk that is dragged over the hand stays behind it"
    assert sign(trunk, arm, trunk) == -1


def test_poses_with_flipped_faces_are_survived() -> None:
    rng = np.random.default_rng(5)
    for mesh in (CROSS, SHAPES["star"], SHAPES["islands"]):
        overlaps = no_overlaps(mesh)
        for spread in (3.0, 30.0, 300.0, 0.0):
            pose = mesh.vertices + rng.normal(0, spread, mesh.vertices.shape) if spread else mesh.vertices
            overlaps = next_overlaps(mesh, pose, overlaps)
        assert not len(overlaps)


@pytest.mark.parametrize("method", method_names())
@pytest.mark.parametrize("name", ["star", "islands"])
def test_no_method_crashes_or_stalls_the_search_in_wild_drags(method: str, name: str) -> None:
    """Some methods flip faces here; the decisions that are made hold nevertheless."""
    mesh, rng = SHAPES[name], np.random.default_rng(4)
    deformer = make_deformer(method, mesh)
    points = mesh.locate(mesh.vertices[mesh.faces[rng.choice(len(mesh.faces), 4)]].mean(axis=1))
    deformer.set_pins(points)
    pose, overlaps = mesh.vertices, no_overlaps(mesh)
    places, size = mesh.evaluate(points, pose), np.ptp(mesh.vertices, axis=0).max()
    met = 0
    for _ in range(25):
        pose = deformer.step(pose, places + rng.normal(0, 0.6 * size, places.shape)).positions
        overlaps = next_overlaps(mesh, pose, overlaps)
        assert len(overlaps) <= MAX_PAIRS_PER_FACE * len(mesh.faces)
        if len(overlaps):
            met += 1
            assert satisfies(overlaps.levels, *overlaps.low_and_high)
            again = restored_overlaps(mesh, pose, overlaps.crossings)
            assert np.array_equal(again.signs, overlaps.signs)
            assert np.array_equal(again.ages, overlaps.ages)
    assert met > 10, "the drags were wild"
