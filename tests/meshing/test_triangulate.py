"""Meshes from outlines: they fill them, have good angles and about the requested number of vertices."""

import numpy as np
import pytest
import shapely
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.meshing.outline import Outline, outlines
from akap_editor.meshing.triangulate import MAX_VERTICES, MIN_VERTICES, triangulate
from akap_editor.resources import bundled_drawings

pytestmark = pytest.mark.usefixtures("mesher")

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
CENTER = np.array([50.0, 50.0])
DIAMOND = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
DRAWINGS = {path.stem: path for path in bundled_drawings()}


def ring(scale: float) -> np.ndarray:
    """The square about its center, scaled."""
    return CENTER + scale * (SQUARE - CENTER)


PARTS = {
    "square": [Outline(SQUARE)],
    "square, turning the other way": [Outline(SQUARE[::-1])],
    "hole": [Outline(SQUARE, (ring(0.5),))],
    "two holes": [Outline(SQUARE, (CENTER - [25, 0] + 15 * DIAMOND, CENTER + [25, 0] + 15 * DIAMOND))],
    "two parts": [Outline(SQUARE), Outline(SQUARE + np.array([120, 10]))],
    "island in a hole": [Outline(SQUARE, (ring(0.7),)), Outline(ring(0.4))],
    "ring in a ring in a ring": [
        Outline(SQUARE, (ring(0.9),)),
        Outline(ring(0.7), (ring(0.6),)),
        Outline(ring(0.4), (ring(0.3),)),
        Outline(ring(0.1)),
    ],
    "island that fills its hole but for a slit": [Outline(SQUARE, (ring(0.52),)), Outline(ring(0.5))],
    "C-shaped hole": [
        Outline(SQUARE, ([[20, 20], [80, 20], [80, 40], [40, 40], [40, 60], [80, 60], [80, 80], [20, 80]],))
    ],
}


def angles(mesh: TriMesh) -> np.ndarray:
    """(m, 3) angles in degrees."""
    corners = mesh.vertices[mesh.faces]
    u = np.roll(corners, -1, axis=1) - corners
    v = np.roll(corners, -2, axis=1) - corners
    cosine = (u * v).sum(axis=2) / np.linalg.norm(u, axis=2) / np.linalg.norm(v, axis=2)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def assert_fills(mesh: TriMesh, parts: list[Outline]) -> None:
    """The faces are just the polygons: as much area, and none of it outside."""
    shape = shapely.union_all([part.polygon for part in parts])
    assert mesh.rest_areas.min() > 0
    assert mesh.rest_areas.sum() == pytest.approx(shape.area, rel=1e-9)
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    assert shapely.contains_xy(shape, *middles.T).all()
    assert mesh.component.max() == len(parts) - 1
    assert len(mesh.boundary_loops) == sum(1 + len(part.holes) for part in parts)


@pytest.mark.parametrize("case", PARTS)
def test_faces_fill_the_polygons_and_leave_holes_empty(case):
    mesh = triangulate(PARTS[case], 600)
    assert_fills(mesh, PARTS[case])
    assert angles(mesh).min() > 25


def test_outline_points_are_vertices():
    parts = PARTS["two holes"]
    vertices = {tuple(vertex) for vertex in triangulate(parts, 200).vertices.tolist()}
    for rim in (parts[0].outer, *parts[0].holes):
        assert {tuple(point) for point in rim.tolist()} <= vertices


@pytest.mark.parametrize("wanted", [30, 50, 200, 1000, 5000])
def test_number_of_vertices(wanted):
    for case in ("square", "two holes"):
        found = len(triangulate(PARTS[case], wanted).vertices)
        assert abs(found - wanted) <= max(0.06 * wanted, 8)


def needed(parts: list[Outline]) -> int:
    """Vertices that the outline makes Triangle use, however few are asked for."""
    return len(triangulate(parts, MIN_VERTICES).vertices)


@pytest.mark.parametrize("name", DRAWINGS)
def test_bundled_drawings(name):
    parts = outlines(np.array(Image.open(DRAWINGS[name]).convert("RGBA"))[..., 3])
    fewest = needed(parts)
    for wanted in (200, 2000):
        mesh = triangulate(parts, wanted)
        assert_fills(mesh, parts)
        assert abs(len(mesh.vertices) - wanted) <= 0.06 * wanted or len(mesh.vertices) <= 1.1 * fewest
        assert sharp_faces_away_from_corners(mesh, parts) == 0


def sharp_faces_away_from_corners(mesh: TriMesh, parts: list[Outline]) -> int:
    """Faces with an angle below 25° of which no vertex belongs to a segment at a corner sharper than 60°."""
    forced = []
    for part in parts:
        for rim in (part.outer, *part.holes):
            u, v = np.roll(rim, 1, axis=0) - rim, np.roll(rim, -1, axis=0) - rim
            cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            for i in np.flatnonzero(cosine > 0.5):
                forced.append(shapely.LineString([rim[i - 1], rim[i], rim[(i + 1) % len(rim)]]))
    sharp = mesh.vertices[mesh.faces[angles(mesh).min(axis=1) < 25]]
    near = shapely.union_all(forced).buffer(1e-6) if forced else shapely.Point()
    return sum(not shapely.intersects_xy(near, *face.T).any() for face in sharp)


def test_many_vertices():
    parts = outlines(np.array(Image.open(DRAWINGS["cat"]).convert("RGBA"))[..., 3])
    mesh = triangulate(parts, 10_000)
    assert_fills(mesh, parts)
    assert len(mesh.vertices) == pytest.approx(10_000, rel=0.06)


def test_the_same_outline_gives_the_same_mesh():
    first, second = triangulate(PARTS["hole"], 300), triangulate(PARTS["hole"], 300)
    assert first.vertices.tolist() == second.vertices.tolist()
    assert first.faces.tolist() == second.faces.tolist()


def test_moved_and_scaled_outline_gives_as_good_a_mesh():
    mesh = triangulate([Outline(1e4 * SQUARE - 3e5, (1e4 * ring(0.5) - 3e5,))], 300)
    assert len(mesh.vertices) == pytest.approx(300, rel=0.06)
    assert angles(mesh).min() > 25


def test_a_limb_is_drawn_over_the_body():
    """Faces are ordered by their distance from the middle: a bent limb passes in front as a whole."""
    arm = Outline([[0, 0], [100, 0], [100, 40], [300, 40], [300, 60], [100, 60], [100, 100], [0, 100]])
    mesh = triangulate([arm], 400)
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, 0]
    assert np.flatnonzero(middle > 270).min() > np.flatnonzero(middle < 90).max()


def test_repeated_point_counts_once():
    mesh = triangulate([Outline(np.repeat(SQUARE, 2, axis=0))], 100)
    assert mesh.vertices.tolist() == triangulate(PARTS["square"], 100).vertices.tolist()


REFUSED = {
    "no parts": ([], "outlines: expected at least one part, got none"),
    "bow tie": (
        [[[0, 0], [10, 10], [10, 0], [0, 10]]],
        "outlines: expected simple polygons, got Self-intersection",
    ),
    "no area": ([[[0, 0], [10, 10], [20, 20]]], "outlines: expected simple polygons"),
    "inside another": ([SQUARE, ring(0.5)], "outlines: expected parts and holes apart from one another"),
    "overlapping": ([SQUARE, SQUARE + 50], "outlines: expected parts and holes apart from one another"),
    "same twice": ([SQUARE, SQUARE], "outlines: expected parts and holes apart from one another"),
    "touching at a corner": (
        [SQUARE, SQUARE + 100],
        "outlines: expected parts and holes apart from one another",
    ),
    "touching at a side": (
        [SQUARE, SQUARE + np.array([100, 0])],
        "outlines: expected parts and holes apart from one another",
    ),
    "point on a side": (
        [SQUARE, [[100, 20], [150, 0], [150, 90]]],
        "outlines: expected parts and holes apart from one another",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_outlines_are_refused_in_one_sentence(case):
    rings, sentence = REFUSED[case]
    with pytest.raises(InputError, match=sentence):
        triangulate([Outline(rim) for rim in rings], 100)


@pytest.mark.parametrize(
    "hole",
    [
        SQUARE + 50,
        SQUARE + 200,
        SQUARE,
        [[0, 50], [20, 40], [20, 60]],
        [[0, 0], [20, 10], [10, 20]],
    ],
    ids=["crossing", "outside", "the same", "point on a side", "at a corner"],
)
def test_bad_holes_are_refused(hole):
    with pytest.raises(InputError, match="outlines: expected "):
        triangulate([Outline(SQUARE, (hole,))], 100)


@pytest.mark.parametrize(
    "vertices", [MIN_VERTICES - 1, MAX_VERTICES + 1, 0, -5, float("nan"), float("inf"), "100", None]
)
def test_bad_number_of_vertices_is_refused(vertices):
    with pytest.raises(
        InputError, match=f"vertices: expected a number from {MIN_VERTICES} to {MAX_VERTICES}, got"
    ):
        triangulate(PARTS["square"], vertices)


@pytest.mark.parametrize("vertices", [300, 3000])
def test_real_cartoons(shared_data, vertices):
    pictures = sorted((shared_data / "noto").glob("*.png"))
    assert pictures
    for path in pictures:
        parts = outlines(np.array(Image.open(path).convert("RGBA"))[..., 3])
        mesh = triangulate(parts, vertices)
        assert_fills(mesh, parts)
        assert len(mesh.vertices) <= max(1.06 * vertices, 1.1 * needed(parts))
        assert sharp_faces_away_from_corners(mesh, parts) == 0
