"""Nested dissection: a permutation whose separators separate, with little fill."""

import numpy as np
import pytest

from akap_editor.deform.dissection import dissect
from akap_editor.deform.fronts import SymbolicCholesky
from akap_editor.geometry.killing_matrix import VertexBlocks
from tests.support import shapes


def factor_size(mesh, order, starts):
    blocks = VertexBlocks(mesh.renumber(order, np.arange(len(mesh.faces))))
    return SymbolicCholesky(blocks.rows, blocks.columns, 2, starts).factor_size


@pytest.mark.parametrize("name", shapes.SHAPES)
@pytest.mark.parametrize("smallest", [1, 10])
def test_every_vertex_is_eliminated_once(name, smallest):
    mesh = shapes.SHAPES[name]
    order, starts = dissect(mesh.vertices, mesh.edges, smallest)
    assert sorted(order.tolist()) == list(range(len(mesh.vertices)))
    assert starts[0] == 0
    assert starts[-1] == len(order)
    assert (np.diff(starts) > 0).all()


def test_last_group_separates_the_others():
    mesh = shapes.blocks("#########\n#########\n#########", 40.0, 4)
    order, starts = dissect(mesh.vertices, mesh.edges)
    separator = order[starts[-2] :]
    assert len(separator) <= 13 + 1  # a line across the bar, which is 13 vertices wide
    left = np.isin(mesh.edges, separator).any(axis=1)
    inside = mesh.edges[~left]
    reached = np.zeros(len(order), dtype=bool)
    reached[order[0]] = True
    for _ in range(len(order)):
        touched = reached[inside].any(axis=1)
        if reached[inside[touched]].all():
            break
        reached[inside[touched]] = True
    share = reached.sum() / len(order)
    assert 0.2 < share < 0.8


def test_factors_are_a_fraction_of_those_in_the_order_of_rows():
    mesh = shapes.blocks("\n".join(["#" * 12] * 12), 40.0, 4)
    n = len(mesh.vertices)
    dissected = factor_size(mesh, *dissect(mesh.vertices, mesh.edges))
    by_rows = factor_size(mesh, np.arange(n), np.append(np.arange(0, n, 8), n))
    assert dissected < 0.4 * by_rows


def test_result_is_a_function_of_the_arguments():
    mesh = shapes.random_disc(3, 200)
    first, second = (dissect(mesh.vertices, mesh.edges) for _ in range(2))
    assert all((a == b).all() for a, b in zip(first, second, strict=True))
