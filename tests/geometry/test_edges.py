"""Pairs of vertices that edges and links couple."""

import numpy as np
import pytest

from akap_editor.geometry.edges import coupled_pairs


@pytest.mark.parametrize(
    "links", [[], [(0, 3)], [(2, 4), (0, 3), (0, 3)], [(0, 1), (3, 4)], [(0, 2), (1, 2), (2, 3)]]
)
def test_coupled_pairs_are_edges_and_links_each_once_in_order(links):
    edges = np.array([(0, 1), (1, 3), (2, 3)], dtype=np.int32)
    found = coupled_pairs(edges, np.array(links, dtype=np.int64).reshape(-1, 2), 5)
    assert [tuple(pair) for pair in found.tolist()] == sorted({*map(tuple, edges.tolist()), *links})
