"""Ties between layers: by overlap, not by the nearest rim."""

import numpy as np
import pytest

from akap_editor.geometry.mesh import TriMesh
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, puppet


def sheets(*boxes):
    """A mesh of rectangles (left, top, right, bottom) with a vertex in the middle, one on each layer."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)])
    triangles = np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    places = [np.array(box[:2]) + corners * (np.array(box[2:]) - box[:2]) for box in boxes]
    faces = [triangles + 5 * number for number in range(len(boxes))]
    layers = np.repeat(np.arange(len(boxes)), 5)
    return TriMesh(np.concatenate(places), np.concatenate(faces), True, layers)


def tied_layers(mesh):
    """Pairs of layers with the widths of their ties."""
    return {
        tuple(sorted(mesh.layers[[i, j]].tolist())): width
        for (i, j), width in zip(mesh.gaps.tolist(), mesh.gap_widths.tolist(), strict=True)
    }


def test_what_lies_on_a_layer_is_tied_to_the_foremost_one_below_and_not_to_the_nearest_rim():
    neck, head, eye = (40, 50, 60, 120), (0, 0, 100, 100), (45, 44, 55, 49)
    assert tied_layers(sheets(neck, head, eye)) == {(0, 1): pytest.approx(1 - 50 / 70), (1, 2): 0.0}


@pytest.mark.parametrize(
    ("boxes", "ties"),
    [
        ([(0, 0, 10, 10), (0, 0, 10, 10)], {(0, 1): 0.0}),  # a duplicated layer
        ([(0, 0, 10, 10), (14, 0, 20, 10)], {(0, 1): 5.0}),  # 4 pixels apart
        ([(0, 0, 9, 9), (20, 0, 29, 9), (8, 0, 21, 9)], {(0, 2): 1 - 1 / 9, (1, 2): 1 - 1 / 9}),
    ],
)
def test_all_layers_are_tied_with_the_widths_of_their_overlap(boxes, ties):
    found = tied_layers(sheets(*boxes))
    assert found.keys() == ties.keys()
    assert list(found.values()) == pytest.approx([ties[pair] for pair in found], abs=1e-9)


def test_a_puppet_hangs_together_with_both_eyes_on_the_head():
    mesh = puppet().mesh
    assert set(tied_layers(mesh)) == {(BODY, ARM), (BODY, SKULL), (SKULL, EYES), (SKULL, HAT)}
    components = int(mesh.component.max()) + 1
    assert components == 6
    assert len(mesh.gaps) == components - 1
    assert not np.isinf(np.asarray(mesh.bridged_edge_graph.sum(axis=1))).any()
