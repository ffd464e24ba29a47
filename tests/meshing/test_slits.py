"""Strokes of the knife as slits of a mesh: both meshers, by the laws of meshes without slits."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.meshing.picture_mesh import mesh_picture
from akap_editor.meshing.quality import smallest_angles
from akap_editor.meshing.slits import check_cuts, simplified_cut
from tests.support.meshers import EACH_MESHER

SIDE = 100
ALPHA = np.zeros((SIDE, SIDE), np.uint8)
ALPHA[10:90, 10:90] = 255
ALPHA[40:60, 60:80] = 0  # a hole

# Strokes, and how many parts and loops of the rim there are then.
CUTS = {
    "from outside": ([((30, 0), (30, 50))], 1, 2),
    "inside": ([((25, 30), (25, 70))], 1, 3),
    "through": ([((30, 0), (33, 100))], 2, 3),
    "into the hole": ([((70, 0), (70, 50))], 1, 1),
    "through the hole": ([((0, 50), (100, 50))], 2, 2),
    "around a piece": ([((20, 20), (40, 20), (40, 40), (20, 40), (20, 20))], 2, 4),
    "a cross": ([((20, 20), (45, 45)), ((45, 20), (20, 45))], 1, 3),
    "to the visible rim": ([((30, 10), (30, 50))], 1, 2),
    "twice the same": ([((30, 0), (30, 50)), ((30, 0), (30, 50))], 1, 2),
    "along the rim": ([((10, 8), (90, 8))], 1, 2),
    "beside it": ([((0, 0), (5, 95))], 1, 2),
    "a dot": ([((30, 30), (30, 30.2))], 1, 2),
}


@pytest.mark.parametrize("mesher", EACH_MESHER)
@pytest.mark.parametrize("name", CUTS)
def test_a_stroke_opens_the_mesh_and_takes_nothing_away(name, mesher):
    cuts, parts, loops = CUTS[name]
    plain = mesh_picture(ALPHA, 300, mesher=mesher).mesh
    mesh = mesh_picture(ALPHA, 300, mesher=mesher, cuts=cuts).mesh
    assert (int(mesh.component.max()) + 1, len(mesh.boundary_loops)) == (parts, loops)
    assert abs(mesh.rest_areas.sum() / plain.rest_areas.sum() - 1) < 2e-4
    assert abs(len(mesh.vertices) - 300) < 40
    assert smallest_angles(mesh).min() > 15  # only corners between outline and slit force smaller ones


@pytest.mark.parametrize("mesher", EACH_MESHER)
def test_the_lips_lie_on_one_another(mesher):
    """Each edge of one lip is one of the other lip, in the other direction and at the same bits."""
    mesh = mesh_picture(ALPHA, 300, mesher=mesher, cuts=[((30, 0), (30, 50), (45, 70))]).mesh
    assert mesh.is_cut
    edges = np.concatenate([np.stack([loop, np.roll(loop, -1)], axis=1) for loop in mesh.boundary_loops])
    places = {tuple(mesh.vertices[edge].ravel().tolist()) for edge in edges}
    assert len(places) == len(edges)
    on_slit = {place for place in places if (*place[2:], *place[:2]) in places}
    length = sum(np.hypot(x - u, y - v) for x, y, u, v in on_slit)
    assert length == pytest.approx(2 * (42 + 25), abs=0.5)  # from the margin to the end, both lips


def test_without_strokes_the_mesh_is_the_same_to_the_bit():
    for cuts in ((), [((0, 0), (5, 95))]):
        a, b = mesh_picture(ALPHA, 300).mesh, mesh_picture(ALPHA, 300, cuts=cuts).mesh
        assert a.vertices.tobytes() == b.vertices.tobytes()
        assert a.faces.tobytes() == b.faces.tobytes()
        assert not b.is_cut


@pytest.mark.parametrize(
    ("cuts", "message"),
    [
        ([[(0, 0)]], "cuts: expected 2 to 2000 points, got 1"),
        ([[(0, 0), (float("nan"), 1)]], "cuts"),
        ([[(0, 0), (1, 2, 3)]], "cuts"),
        ([[(0, 0), (1, 1)]] * 201, "cuts: expected at most 200, got 201"),
        ([[(0, 0)] * 2001], "cuts: expected 2 to 2000 points, got 2001"),
    ],
)
def test_bad_strokes_are_refused(cuts, message):
    with pytest.raises(InputError, match=message):
        check_cuts(cuts)


def test_strokes_are_simplified_and_dots_are_none():
    line = [(x / 10, (x % 2) / 1000) for x in range(300)]
    assert simplified_cut(line) == ((0.0, 0.0), (29.9, 0.0))
    assert simplified_cut([(5.0, 5.0), (5.5, 5.5)]) is None
    assert simplified_cut([(5.0, 5.0)]) is None
