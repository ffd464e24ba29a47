"""Spine's JSON: read as its runtimes read it."""

import json

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.export.texture import bleed, y_up
from akap_editor.io.images import read_image


@pytest.fixture
def path(exported, bent):
    return exported(bent, "cat.spine.json")


@pytest.fixture
def record(path):
    return json.loads(path.read_text())


def parts_of(record):
    """Each slot's attachment with the deform offsets of the pose, in the order in which slots are drawn."""
    (skin,) = record["skins"]
    assert skin["name"] == "default"
    deform = record["animations"]["pose"]["attachments"]["default"]
    for slot in record["slots"]:
        name = slot["attachment"]
        (key,) = deform[slot["name"]][name]["deform"]
        yield skin["attachments"][slot["name"]][name], np.array(key["vertices"]).reshape(-1, 2)


def area(ring):
    x, y = ring.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_skeleton(record, drawn):
    assert record["bones"] == [{"name": "root"}]
    names = [slot["name"] for slot in record["slots"]]
    assert names == ["ring & disc", "ring & disc 2"]
    assert all(slot["bone"] == "root" for slot in record["slots"])
    skeleton = record["skeleton"]
    low, high = (f(y_up(drawn.drawing, drawn.drawing.mesh.vertices), axis=0) for f in (np.min, np.max))
    np.testing.assert_allclose([skeleton["x"], skeleton["y"]], low, atol=0.01)
    np.testing.assert_allclose([skeleton["width"], skeleton["height"]], high - low, atol=0.01)
    assert skeleton["spine"].startswith("4.2")


def test_attachments_have_what_the_format_asks_for(record):
    for mesh, offsets in parts_of(record):
        assert mesh["type"] == "mesh"
        count = len(mesh["uvs"]) // 2
        assert len(mesh["vertices"]) == 2 * count, "more would mean weights"
        assert len(offsets) == count
        assert len(mesh["triangles"]) % 3 == 0
        assert set(mesh["triangles"]) == set(range(count))
        assert all(0 <= value <= 1 for value in mesh["uvs"])
        assert 3 <= mesh["hull"] <= count
        assert (mesh["width"], mesh["height"]) == (140, 90)


def test_the_hull_comes_first_in_order_clockwise(record):
    """It is one closed line of edges that have one face, and everything is inside."""
    for mesh, _ in parts_of(record):
        hull, faces = mesh["hull"], np.array(mesh["triangles"]).reshape(-1, 3)
        points = np.array(mesh["vertices"]).reshape(-1, 2)
        half_edges = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()
        ring = [[i, (i + 1) % hull] for i in range(hull)]
        for edge in ring:
            assert half_edges.count(edge) == 1
            assert half_edges.count(edge[::-1]) == 0
        assert area(points[:hull]) < 0, "y is up, so clockwise is negative"
        assert abs(area(points[:hull])) >= abs(sum(area(points[face]) for face in faces)) - 0.1
        low, high = points[:hull].min(axis=0), points[:hull].max(axis=0)
        assert (points >= low).all()
        assert (points <= high).all()


def test_edges_are_those_of_the_mesh_once_each_hull_first(record):
    for mesh, _ in parts_of(record):
        edges = np.array(mesh["edges"]).reshape(-1, 2)
        assert (edges % 2 == 0).all(), "they are places in the list of coordinates"
        edges //= 2
        hull = mesh["hull"]
        assert edges[:hull].tolist() == [[i, (i + 1) % hull] for i in range(hull)]
        faces = np.array(mesh["triangles"]).reshape(-1, 3)
        of_faces = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        assert sorted(np.sort(edges, axis=1).tolist()) == np.unique(of_faces, axis=0).tolist()


def test_all_faces_rest_and_pose_are_there(record, bent):
    """As a set of triangles in space, whatever the numbering."""
    drawing = bent.drawing
    for points in (drawing.mesh.vertices, bent.state.positions):
        found = []
        for mesh, offsets in parts_of(record):
            at = np.array(mesh["vertices"]).reshape(-1, 2)
            at = at + offsets if points is bent.state.positions else at
            found += [at[face] for face in np.array(mesh["triangles"]).reshape(-1, 3)]
        expected = y_up(drawing, points)[drawing.mesh.faces]
        order = [np.lexsort(np.mean(each, axis=1).round(1).T) for each in (np.array(found), expected)]
        middles = [np.mean(each, axis=1) for each in (np.array(found), expected)]
        distance = np.linalg.norm(middles[0][order[0]][:, None] - middles[1][None], axis=2).min(axis=1)
        assert len(found) == len(expected)
        assert distance.max() < 2e-3


def test_texture_fits(record, path, bent):
    for mesh, _ in parts_of(record):
        texture = path.parent / record["skeleton"]["images"] / f"{mesh['path']}.png"
        np.testing.assert_array_equal(read_image(texture), bleed(bent.drawing.image))
        uv, at = (np.array(mesh[key]).reshape(-1, 2) for key in ("uvs", "vertices"))
        np.testing.assert_allclose(y_up(bent.drawing, uv * [140, 90]), at, atol=2e-3)


def test_too_fine_a_mesh_is_refused(exported, bent, monkeypatch, tmp_path):
    monkeypatch.setattr("akap_editor.io.export.spine.MAX_ATTACHMENT_VERTICES", 20)
    with pytest.raises(InputError, match="at most 20 vertices for Spine, got "):
        exported(bent, "a.spine.json")
    assert list(tmp_path.iterdir()) == []
