"""Meshes of layers: shared vertices, small and faint layers, places on the canvas."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.meshing.layer_mesh import MIN_LAYER_VERTICES, mesh_layers, shared_counts
from tests.support.puppets import disc


def meshed(*layers, vertices=300, threshold=0.5):
    """A mesh of (alpha, offset) pairs."""
    alphas, offsets = zip(*layers, strict=True)
    return mesh_layers(alphas, offsets, vertices, 2.0, threshold)


def full(width, height, alpha=255):
    return np.full((height, width), alpha, np.uint8)


def test_vertices_are_shared_by_visible_area_with_a_floor_for_small_layers():
    assert shared_counts([900, 90, 9], 1000) == [901, 90, MIN_LAYER_VERTICES]
    mesh = meshed((full(100, 90), (0, 0)), (full(90, 100), (200, 0)), (full(6, 6), (30, 30)))
    large, other, small = np.bincount(mesh.layers).tolist()
    assert abs(large - other) < 0.2 * large
    assert 5 <= small < 60
    assert np.diff(mesh.layers).min() >= 0


def test_a_layer_lies_where_it_is_on_the_canvas_also_beyond_it():
    mesh = meshed((full(40, 30), (-25, -10)), (full(40, 30), (5, 20)))
    low, high = mesh.vertices[mesh.layers == 0].min(axis=0), mesh.vertices[mesh.layers == 0].max(axis=0)
    np.testing.assert_allclose(low, [-27, -12], atol=0.6)
    np.testing.assert_allclose(high, [17, 22], atol=0.6)


def test_equal_layers_make_a_mesh():
    mesh = meshed((full(40, 30), (0, 0)), (full(40, 30), (0, 0)))
    assert np.bincount(mesh.layers).tolist()[0] == np.bincount(mesh.layers).tolist()[1]


@pytest.mark.parametrize("alpha", [full(40, 30, 60), disc(12, 0, 0, 0)[..., 3] // 6], ids=["flat", "soft"])
def test_a_faint_layer_is_cut_out_at_half_its_opacity(alpha):
    mesh = meshed((full(60, 60), (0, 0)), (alpha, (10, 10)))
    own = mesh.rest_areas[mesh.face_layers == 1].sum()
    assert own > 0.8 * (alpha > alpha.max() / 2).sum()


@pytest.mark.parametrize("size", [(1, 1), (2, 1), (1, 3)])
def test_a_layer_without_an_outline_gets_a_rectangle(size):
    mesh = meshed((full(60, 60), (0, 0)), (full(*size), (10, 20)))
    own = mesh.vertices[mesh.layers == 1]
    assert (own.min(axis=0) < [10, 20]).all()
    assert (own.max(axis=0) > np.array([10, 20]) + size).all()


@pytest.mark.parametrize(("vertices", "threshold"), [(2, 0.5), (300, 0.0), (300, 1.5)])
def test_options_out_of_range_are_refused(vertices, threshold):
    with pytest.raises(InputError, match="expected"):
        meshed((full(60, 60), (0, 0)), vertices=vertices, threshold=threshold)
