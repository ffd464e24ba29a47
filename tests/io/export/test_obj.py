"""OBJ, MTL and texture, read back by trimesh."""

import numpy as np
import pytest
import trimesh

from akap_editor.io.export.texture import bleed, y_up


@pytest.fixture
def load(exported):
    """Exports and lets trimesh read it, in the file's own order."""
    return lambda document, name="a.obj", **options: trimesh.load(
        exported(document, name, **options), process=False, maintain_order=True
    )


@pytest.mark.parametrize("rest", [False, True])
def test_mesh_of_the_pose(load, bent, rest):
    mesh = load(bent, rest=rest)
    drawing = bent.drawing
    pose = drawing.mesh.vertices if rest else bent.state.positions
    np.testing.assert_allclose(mesh.vertices[:, :2], y_up(drawing, pose), rtol=1e-8, atol=1e-6)
    assert not mesh.vertices[:, 2].any()
    np.testing.assert_array_equal(mesh.faces, drawing.mesh.faces[:, ::-1])


def test_faces_look_to_the_viewer(load, drawn):
    mesh = load(drawn)
    np.testing.assert_allclose(mesh.face_normals, np.tile([0, 0, 1], (len(mesh.faces), 1)), atol=1e-9)
    assert mesh.area == pytest.approx(drawn.drawing.mesh.rest_areas.sum())


@pytest.mark.parametrize("name", ["a.obj", "my old cat.obj"])
def test_texture_is_found_and_fits(load, bent, name):
    mesh = load(bent, name)
    texture = np.asarray(mesh.visual.material.image.convert("RGBA"))
    np.testing.assert_array_equal(texture, bleed(bent.drawing.image))
    width, height = bent.drawing.size
    where = mesh.visual.uv * [width, -height] + [0, height]  # v points up in OBJ files
    np.testing.assert_allclose(where, bent.drawing.mesh.vertices, atol=1e-3)


def test_a_color_is_where_it_was(load, drawn):
    """Sampled by trimesh, at the nearest pixel, in the middle of opaque faces."""
    mesh = load(drawn)
    colors = mesh.visual.material.to_color(mesh.visual.uv[mesh.faces].mean(axis=1))
    middle = drawn.drawing.mesh.vertices[drawn.drawing.mesh.faces].mean(axis=1).astype(int)
    expected = drawn.drawing.image[middle[:, 1], middle[:, 0]]
    opaque = expected[:, 3] == 255
    assert opaque.sum() > 100
    assert np.abs(colors.astype(int) - expected)[opaque, :3].max() <= 3


def test_vertices_keep_their_order_in_all_poses(exported, bent):
    lines = [exported(bent, "a.obj", rest=rest).read_text().splitlines() for rest in (False, True)]
    faces = [[line for line in each if line.startswith(("f ", "vt "))] for each in lines]
    assert faces[0] == faces[1]
    assert lines[0] != lines[1]
