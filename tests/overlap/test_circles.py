"""Circles of decisions are resolved, and what must stay stays."""

import numpy as np
import pytest

from akap_editor.overlap.circles import face_levels, low_and_high, satisfies, without_circles


@pytest.mark.parametrize("firm_share", [0.0, 0.3, 0.7])
@pytest.mark.parametrize("seed", range(8))
def test_no_circle_is_left_and_firm_signs_stay(seed: int, firm_share: float) -> None:
    rng = np.random.default_rng(seed)
    rank = rng.permutation(40)
    first, second = np.array([rng.choice(40, 2, replace=False) for _ in range(160)], dtype=np.int32).T
    signs = rng.choice([-1, 1], 160).astype(np.int8)
    is_firm = rng.random(160) < firm_share
    firm = np.where(is_firm, np.where(rank[first] > rank[second], 1, -1), 0).astype(np.int8)
    regions = np.sort(rng.integers(0, 6, 160)).astype(np.int32)
    low, high = low_and_high(first, second, signs)
    assert not face_levels(40, low, high)[1].all(), "there is a circle"
    found, levels = without_circles(40, first, second, regions, signs, rng.permutation(6), firm)
    assert satisfies(levels, *low_and_high(first, second, found))
    assert np.array_equal(found[is_firm], firm[is_firm])


def test_the_youngest_region_gives_way_as_a_whole() -> None:
    first = np.array([0, 1, 2, 3], dtype=np.int32)
    second = np.array([1, 2, 0, 4], dtype=np.int32)
    regions, signs = np.array([0, 1, 2, 2], dtype=np.int32), np.ones(4, dtype=np.int8)
    none = np.zeros(4, dtype=np.int8)
    for ages, turned in (([0, 1, 2], [2, 3]), ([1, 2, 0], [1]), ([2, 0, 1], [0])):
        found, _ = without_circles(5, first, second, regions, signs, np.array(ages), none)
        assert np.flatnonzero(found < 0).tolist() == turned
