"""Limbs of meshes: their ends, their forks and the middle of the body."""

import numpy as np
import pytest
import shapely

from akap_editor.geometry.limbs import find_limbs
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io.open_document import open_document
from akap_editor.meshing.outline import Outline
from akap_editor.meshing.triangulate import triangulate
from akap_editor.resources import resource
from tests.support.meshers import needs_triangle


def star(arms: int, first_angle: float = 0.2) -> tuple[TriMesh, np.ndarray]:
    """A disc with straight arms, and the ends of the arms."""
    angles = first_angle + 2 * np.pi * np.arange(arms) / arms
    ends = 300 + 250 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    lines = [shapely.LineString([(300, 300), end]).buffer(22, cap_style="flat") for end in ends]
    shape = shapely.union_all([shapely.Point(300, 300).buffer(80), *lines])
    return triangulate([Outline(np.array(shape.exterior.coords)[:-1], ())], 900), ends


@pytest.mark.parametrize("arms", [3, 4, 5, 7])
def test_each_arm_of_a_star_ends_in_a_tip(arms):
    mesh, ends = star(arms)
    limbs = find_limbs(mesh)
    assert len(limbs.tips) == arms
    gaps = np.linalg.norm(mesh.vertices[limbs.tips][:, None] - ends, axis=2)
    assert sorted(gaps.argmin(axis=1)) == list(range(arms))
    assert gaps.min(axis=1).max() < 60
    (middle,) = mesh.vertices[limbs.middles]
    assert np.linalg.norm(middle - 300) < 25


def test_a_disc_has_no_limbs_beyond_its_farthest_point():
    ring = np.array(shapely.Point(100, 100).buffer(80).exterior.coords)[:-1]
    limbs = find_limbs(triangulate([Outline(ring, ())], 400))
    assert (len(limbs.middles), len(limbs.tips), len(limbs.forks)) == (1, 1, 0)


def test_a_bar_has_two_ends():
    ring = np.array([(0.0, 0.0), (400.0, 0.0), (400.0, 40.0), (0.0, 40.0)])
    mesh = triangulate([Outline(ring, ())], 400)
    limbs = find_limbs(mesh)
    ends = np.sort(mesh.vertices[limbs.tips][:, 0])
    assert len(ends) == 2
    assert ends[0] < 60
    assert ends[1] > 340


def test_specks_have_no_limbs():
    mesh, _ = star(3)
    speck = np.array([(560.0, 10.0), (580.0, 10.0), (580.0, 30.0), (560.0, 30.0)])
    small = triangulate([Outline(speck, ())], 20)
    both = TriMesh(
        np.concatenate([mesh.vertices, small.vertices]),
        np.concatenate([mesh.faces, small.faces + len(mesh.vertices)]),
    )
    limbs = find_limbs(both)
    assert (np.concatenate([limbs.middles, limbs.tips, limbs.forks]) < len(mesh.vertices)).all()


# Where hands, feet, heads and tails are in the bundled drawings, in pixels.
EXPECTED = {
    "alien": [(849, 346), (76, 642), (331, 925), (718, 927), (278, 126), (622, 86), (470, 346)],
    "gingerbread": [(147, 530), (850, 283), (347, 850), (710, 865), (444, 208), (504, 557)],
    "elephant": [(120, 802), (289, 781), (442, 786), (659, 793), (913, 189), (428, 456)],
}


@needs_triangle
@pytest.mark.parametrize("name", EXPECTED)
def test_hands_feet_heads_and_trunks_of_bundled_drawings(name):
    mesh = open_document(resource("assets", "drawings", f"{name}.png")).drawing.mesh
    limbs = find_limbs(mesh)
    places = mesh.vertices[np.concatenate([limbs.tips, limbs.middles])]
    for expected in EXPECTED[name]:
        assert np.linalg.norm(places - expected, axis=1).min() < 0.05 * mesh.length, expected
    assert len(limbs.tips) + len(limbs.middles) <= 14
