"""Meshes of pictures: the number of vertices, and outlines that are simplified to reach it."""

import numpy as np
import pytest
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.meshing.outline import MIN_STROKE_WIDTH, cut_out
from akap_editor.meshing.picture_mesh import mesh_picture
from akap_editor.meshing.quality import mesh_quality
from akap_editor.resources import bundled_drawings

pytestmark = pytest.mark.usefixtures("mesher")

DRAWINGS = {path.stem: path for path in bundled_drawings()}


def alpha_of(path):
    return np.ascontiguousarray(np.asarray(Image.open(path).convert("RGBA"))[..., 3])


@pytest.mark.parametrize("wanted", [200, 700, 2000, 20_000])
@pytest.mark.parametrize("name", DRAWINGS)
def test_number_of_vertices_and_coverage_of_bundled_drawings(name, wanted):
    alpha = alpha_of(DRAWINGS[name])
    quality = mesh_quality(mesh_picture(alpha, wanted).mesh, alpha)
    assert quality.vertices == pytest.approx(wanted, rel=0.1)
    assert quality.covered >= 0.999
    assert quality.worst_angle > 25


def test_fifty_thousand():
    made = mesh_picture(alpha_of(DRAWINGS["cat"]), 50_000)
    assert len(made.mesh.vertices) == pytest.approx(50_000, rel=0.1)


@pytest.mark.parametrize("wanted", [200, 2000])
def test_shared_cartoons(shared_data, wanted):
    paths = [*sorted((shared_data / "noto").glob("*.png")), shared_data / "gophers" / "gopher-42.png"]
    for path in paths:
        alpha = alpha_of(path)
        made = mesh_picture(alpha, wanted)
        quality = mesh_quality(made.mesh, alpha)
        assert quality.vertices == pytest.approx(wanted, rel=0.1), path.name
        assert quality.covered >= 0.999, path.name
        assert quality.worst_angle > 25, path.name
        assert quality.parts == len(cut_out(alpha).parts), path.name


def test_graded_fine_at_the_outline_and_coarser_inside():
    alpha = np.zeros((300, 300), dtype=np.uint8)
    alpha[20:280, 20:280] = 255
    mesh = mesh_picture(alpha, 2000).mesh
    lengths = np.linalg.norm(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]], axis=1)
    middles = mesh.vertices[mesh.edges].mean(axis=1)
    inside = np.abs(middles - 150).max(axis=1) < 90
    loops = np.concatenate(mesh.boundary_loops)
    rim = np.isin(mesh.edges, loops).all(axis=1)
    assert 1.3 < np.median(lengths[inside]) / np.median(lengths[rim]) < 2.0


def test_specks_are_counted():
    alpha = np.zeros((200, 200), dtype=np.uint8)
    alpha[50:150, 50:150] = 255
    alpha[10:13, 10:13] = alpha[180, 20:26] = alpha[30, 100] = 255  # alone
    alpha[100, 152] = 255  # near enough to join
    made = mesh_picture(alpha, 300)
    assert (made.parts, made.holes, made.specks) == (1, 0, 3)
    assert made.speck_area == pytest.approx(9 + 6 + 1 - 3 * 0.5)  # each loses its corners
    assert made.mesh.vertices[:, 0].max() > 153


def test_dots_that_the_expansion_joins_are_no_specks():
    alpha = np.zeros((60, 200), dtype=np.uint8)
    alpha[30:33, 10:190:6] = alpha[30:33, 11:190:6] = 255
    with pytest.raises(InputError, match=r"too small to bend: .*, in 30 pieces"):
        mesh_picture(alpha, 200, expand=0)
    made = mesh_picture(alpha, 200, expand=2.5)
    assert (made.parts, made.specks) == (1, 0)


@pytest.mark.parametrize("expand", [0.0, 0.3, 2.0])
def test_a_line_of_one_pixel_can_be_bent(expand):
    alpha = np.zeros((60, 200), dtype=np.uint8)
    alpha[30, 10:190] = 255
    mesh = mesh_picture(alpha, 400, expand).mesh
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert mesh.component.max() == 0
    assert MIN_STROKE_WIDTH <= high[1] - low[1] <= 1 + 2 * max(expand, MIN_STROKE_WIDTH / 2) + 0.1
    assert high[0] - low[0] >= 178


def test_where_few_vertices_are_wanted_no_parts_join():
    alpha = np.zeros((220, 220), dtype=np.uint8)
    y, x = np.mgrid[0:220, 0:220] + 0.5
    for column in (60, 110, 160):  # three flowers with twenty petals, nearly touching
        turn = np.arctan2(y - 110, x - column)
        alpha[np.hypot(x - column, y - 110) < 20 + 2 * np.cos(20 * turn)] = 255
    for wanted in (60, 200):
        made = mesh_picture(alpha, wanted, expand=1)
        assert (made.parts, made.mesh.component.max()) == (3, 2)
        assert mesh_quality(made.mesh, alpha).covered >= 0.999
