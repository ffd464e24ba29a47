"""Laws of `TriMesh` and of points on it."""

import math
from collections import Counter

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components

from akap_editor.errors import InputError
from akap_editor.geometry.mesh import MeshPoints, TriMesh, barycentric, signed_areas
from tests.support import shapes

TRIANGLE = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
FACE = np.array([[0, 1, 2]])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
FAN = np.array([[0.0, 0.0], [1.0, 0.0], [0.4, 1.0], [0.5, 0.8], [0.6, 0.9]])
TWO_AT_A_POINT = np.array([[0.0, 0.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]])

BAD_MESHES = {
    "three coordinates": (np.zeros((3, 3)), FACE, r"vertices: expected shape \(n, 2\), got \(3, 3\)"),
    "flat vertices": (np.arange(6.0), FACE, r"vertices: expected shape \(n, 2\), got \(6,\)"),
    "ragged": ([[0.0, 1.0], [2.0]], FACE, "vertices: expected an array of numbers, got list"),
    "text": ([["0", "1"]] * 3, FACE, "vertices: expected real numbers, got dtype <U1"),
    "complex": (TRIANGLE + 0j, FACE, "vertices: expected real numbers, got dtype complex128"),
    "not a number": (
        [[0, 0], [1, 0], [0, np.nan]],
        FACE,
        r"vertices: expected finite .*\[0.0, nan\] in row 2",
    ),
    "infinite": ([[0, 0], [np.inf, 0], [0, 1]], FACE, r"vertices: expected finite .*\[inf, 0.0\] in row 1"),
    "quads": (SQUARE, [[0, 1, 2, 3]], r"faces: expected shape \(m, 3\), got \(1, 4\)"),
    "flat faces": (TRIANGLE, [0, 1, 2], r"faces: expected shape \(m, 3\), got \(3,\)"),
    "float faces": (TRIANGLE, [[0.0, 1.0, 2.0]], "faces: expected integer indices, got dtype float64"),
    "too large": (TRIANGLE, [[0, 1, 3]], "faces: expected indices from 0 to 2, got 3"),
    "negative": (TRIANGLE, [[0, 1, -1]], "faces: expected indices from 0 to 2, got -1"),
    "no faces": (TRIANGLE, np.zeros((0, 3), int), "mesh: expected vertices and faces, got 3 and 0"),
    "nothing": (np.zeros((0, 2)), np.zeros((0, 3), int), "mesh: expected vertices and faces, got 0 and 0"),
    "flipped": (TRIANGLE, [[0, 2, 1]], r"faces: .*face 0 is flipped \(-0.5\)"),
    "no area": ([[0, 0], [1, 1], [2, 2]], FACE, r"faces: .*face 0 has no area"),
    "corner twice": (TRIANGLE, [[0, 1, 2], [0, 1, 1]], "faces: .*face 1 has no area"),
    "unused": (SQUARE, FACE, "vertices: expected each to belong to a face, but vertex 3 does not"),
    "same place": (
        np.array([[0, 0], [1, 0], [1, 1], [1, 0], [2, 0], [1.5, 1]]),
        [[0, 1, 2], [3, 4, 5]],
        "vertices: 1 and 3 are at the same place",
    ),
    "three at an edge": (
        FAN,
        [[0, 1, 2], [0, 1, 3], [0, 1, 4]],
        r"faces: edge \[0, 1\] .*one face on each side",
    ),
    "two on one side": (FAN[:4], [[0, 1, 2], [0, 1, 3]], r"faces: edge \[0, 1\] .*one face on each side"),
    "face twice": (TRIANGLE, [[0, 1, 2], [1, 2, 0]], r"faces: edge \[0, 1\] .*one face on each side"),
    "joined at one vertex": (
        TWO_AT_A_POINT,
        [[0, 1, 2], [0, 3, 4]],
        "faces: expected parts to meet along edges, but at vertex 0 they meet in one point only",
    ),
}


@pytest.mark.parametrize("case", BAD_MESHES)
def test_bad_mesh_is_refused_in_one_sentence(case):
    vertices, faces, sentence = BAD_MESHES[case]
    with pytest.raises(InputError, match=sentence):
        TriMesh(vertices, faces)


def test_arrays_are_copied_and_read_only():
    vertices, faces = TRIANGLE.copy(), FACE.copy()
    mesh = TriMesh(vertices, faces)
    vertices[0], faces[0] = 7.0, [2, 1, 0]
    assert mesh.vertices.tolist() == TRIANGLE.tolist()
    assert mesh.faces.tolist() == FACE.tolist()
    assert mesh.vertices.dtype == np.float64
    assert mesh.faces.dtype == np.int32
    for array in (
        mesh.vertices,
        mesh.faces,
        mesh.edges,
        mesh.component,
        mesh.rest_areas,
        *mesh.boundary_loops,
    ):
        assert not array.flags.writeable


def test_faces_are_positive_with_y_down():
    assert signed_areas(TRIANGLE, FACE).tolist() == [0.5]
    assert signed_areas(TRIANGLE, FACE[:, ::-1]).tolist() == [-0.5]


def sides(mesh: TriMesh) -> Counter:
    """How many faces each undirected edge belongs to, counted one by one."""
    return Counter(
        (min(a, b), max(a, b)) for f in mesh.faces.tolist() for a, b in zip(f, f[1:] + f[:1], strict=True)
    )


def test_edges_are_those_of_the_faces(mesh):
    assert [tuple(edge) for edge in mesh.edges.tolist()] == sorted(sides(mesh))
    sides_of_faces = np.stack([mesh.faces, mesh.faces[:, [1, 2, 0]]], axis=2)
    assert (mesh.edges[mesh.face_edges] == np.sort(sides_of_faces, axis=2)).all()


def test_loops_cover_each_boundary_edge_once(mesh):
    boundary = sorted(edge for edge, count in sides(mesh).items() if count == 1)
    walked = [
        (min(a, b), max(a, b))
        for loop in mesh.boundary_loops
        for a, b in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)
    ]
    assert sorted(walked) == boundary
    assert mesh.boundary_vertices.tolist() == sorted({vertex for edge in boundary for vertex in edge})


def test_no_loop_visits_a_vertex_twice(mesh):
    visited = np.concatenate(mesh.boundary_loops)
    assert len(np.unique(visited)) == len(visited)


def test_outer_loops_turn_with_the_faces_and_holes_against(mesh):
    loops = [mesh.vertices[loop] for loop in mesh.boundary_loops]
    areas = [0.5 * np.linalg.det(np.stack([p, np.roll(p, -1, axis=0)], axis=1)).sum() for p in loops]
    assert sum(areas) == pytest.approx(mesh.rest_areas.sum(), rel=1e-12)


def test_components_and_holes(mesh, shape_name):
    parts, holes = shapes.PARTS.get(shape_name, 1), shapes.HOLES.get(shape_name, 0)
    assert len(mesh.boundary_loops) == parts + holes
    assert sorted(set(mesh.component.tolist())) == list(range(parts))
    euler = len(mesh.vertices) - len(mesh.edges) + len(mesh.faces)
    assert euler == parts - holes


def test_component_joins_what_edges_join(mesh):
    label = list(range(len(mesh.vertices)))
    for _ in label:
        before = label.copy()
        for a, b in mesh.edges.tolist():
            label[a] = label[b] = min(label[a], label[b])
        if label == before:
            break
    same = np.equal.outer(label, label)
    assert (np.equal.outer(mesh.component, mesh.component) == same).all()


def test_edge_graph_holds_the_length_of_every_rest_edge(mesh):
    n = len(mesh.vertices)
    expected = np.zeros((n, n))
    for a, b in mesh.edges.tolist():
        expected[a, b] = expected[b, a] = math.dist(mesh.vertices[a], mesh.vertices[b])
    found = mesh.edge_graph.toarray()
    assert (found > 0).tolist() == (expected > 0).tolist()
    assert found == pytest.approx(expected, rel=1e-15)


def test_bridged_edge_graph_adds_the_gaps_and_connects_all(mesh):
    bridges = (mesh.bridged_edge_graph - mesh.edge_graph).toarray()
    expected = sorted(sorted(gap) for gap in mesh.gaps.tolist())
    assert np.argwhere(np.triu(bridges)).tolist() == expected
    for a, b in mesh.gaps.tolist():
        assert bridges[a, b] == bridges[b, a] == pytest.approx(math.dist(mesh.vertices[a], mesh.vertices[b]))
    assert connected_components(mesh.bridged_edge_graph)[0] == 1


def test_length_is_the_square_root_of_the_rest_area(mesh):
    assert mesh.length == pytest.approx(math.sqrt(mesh.rest_areas.sum()), rel=1e-15)


def random_points(mesh: TriMesh, seed: int, count: int = 40) -> MeshPoints:
    rng = np.random.default_rng(seed)
    return MeshPoints(rng.integers(0, len(mesh.faces), count), rng.dirichlet([1, 1, 1], count))


def test_locate_inverts_evaluate(mesh):
    points = random_points(mesh, 3)
    where = mesh.evaluate(points, mesh.vertices)
    found = mesh.locate(where)
    assert found.faces.tolist() == points.faces.tolist()
    assert np.abs(found.weights - points.weights).max() < 1e-12
    assert np.abs(mesh.evaluate(found, mesh.vertices) - where).max() < 1e-12 * 500


def test_locate_in_a_pose(mesh):
    pose = mesh.vertices @ [[0.6, 0.9], [-1.1, 0.4]] + [30, -5]
    points = random_points(mesh, 4)
    found = mesh.locate(mesh.evaluate(points, pose), pose)
    assert found.faces.tolist() == points.faces.tolist()
    assert np.abs(found.weights - points.weights).max() < 1e-12


def test_vertices_and_edges_belong_to_the_drawing(mesh):
    """Also on the boundary, although rounding may move a point outside."""
    rng = np.random.default_rng(5)
    share = rng.uniform(0, 1, (len(mesh.edges), 1))
    start, end = mesh.vertices[mesh.edges[:, 0]], mesh.vertices[mesh.edges[:, 1]]
    for where in (mesh.vertices, share * start + (1 - share) * end):
        found = mesh.locate(where)
        assert np.abs(mesh.evaluate(found, mesh.vertices) - where).max() < 1e-9


def test_weights_at_a_vertex_are_one_and_zeros():
    assert TriMesh(TRIANGLE, FACE).locate(TRIANGLE).weights.tolist() == np.eye(3).tolist()


def test_outside_is_refused_with_the_nearest_vertex():
    mesh = TriMesh(100 * TRIANGLE, FACE)
    assert mesh.find([60.0, 60.0]) is None
    sentence = r"point 1 at \(104, 3\) lies outside the drawing; the nearest vertex is at \(100.0, 0.0\)"
    with pytest.raises(InputError, match=sentence):
        mesh.locate([[10.0, 10.0], [104.0, 3.0]])


def test_hole_is_outside():
    ring = shapes.SHAPES["ring"]
    assert ring.find([75.0, 75.0]) is None
    assert ring.find([25.0, 75.0]) is not None


def test_where_faces_overlap_the_one_drawn_last_is_seen():
    below, above = TRIANGLE, TRIANGLE + 0.1
    mesh = TriMesh(np.concatenate([below, above]), [[0, 1, 2], [3, 4, 5]])
    assert mesh.locate([[0.3, 0.3], [0.05, 0.05]]).faces.tolist() == [1, 0]
    assert TriMesh(mesh.vertices, mesh.faces[::-1]).locate([[0.3, 0.3]]).faces.tolist() == [1]


def test_in_a_folded_pose_the_last_of_all_faces_that_hold_a_point_is_found(mesh):
    rng = np.random.default_rng(12)
    pose = mesh.vertices + rng.normal(0, 0.1 * np.ptp(mesh.vertices), mesh.vertices.shape)
    order = rng.permutation(len(mesh.faces))
    for point in rng.uniform(pose.min(axis=0), pose.max(axis=0), (30, 2)):
        is_hit = barycentric(pose[mesh.faces[order]], point).min(axis=1) >= 0
        found = mesh.find(point, pose, order)
        assert ([] if found is None else found.faces.tolist()) == order[is_hit][-1:].tolist()


@pytest.mark.parametrize("shift", [0.1, 1 / 3, 1000.7])
def test_rounding_puts_no_boundary_point_outside(shift):
    mesh = TriMesh(SQUARE + shift, [[0, 1, 2], [0, 2, 3]])
    share = np.random.default_rng(10).uniform(0, 1, (200, 1))
    for start, end in zip(mesh.vertices, np.roll(mesh.vertices, -1, axis=0), strict=True):
        assert len(mesh.locate(share * start + (1 - share) * end)) == 200


@pytest.mark.parametrize(
    "point", [[1.0, 2.0, 3.0], [1.0], [[0.0, 0.0], [1.0, 1.0]], "ab", [np.nan, 0.0], None]
)
def test_find_refuses_what_is_not_a_point(point):
    with pytest.raises(InputError, match="point: expected"):
        TriMesh(TRIANGLE, FACE).find(point)


@pytest.mark.parametrize("pose", [TRIANGLE[:2], TRIANGLE * np.nan])
def test_locate_refuses_a_bad_pose(pose):
    with pytest.raises(InputError, match="positions: expected"):
        TriMesh(TRIANGLE, FACE).locate([[0.1, 0.1]], pose)


def test_no_points():
    mesh = TriMesh(TRIANGLE, FACE)
    points = mesh.locate(np.zeros((0, 2)))
    assert len(points) == 0
    assert mesh.evaluate(points, mesh.vertices).shape == (0, 2)


@pytest.mark.parametrize(
    ("faces", "weights", "sentence"),
    [
        ([0], [[0.5, 0.5]], r"weights: expected shape \(1, 3\), got \(1, 2\)"),
        ([0, 1], [[1.0, 0.0, 0.0]], r"weights: expected shape \(2, 3\), got \(1, 3\)"),
        ([0, 1], [1.0, 0.0, 0.0, 0.0, 0.0, 1.0], r"weights: expected shape \(2, 3\), got \(6,\)"),
        ([0], [["a", "b", "c"]], "weights: expected real numbers"),
        ([0, 1], [[1.0], [1.0, 2.0]], "weights: expected an array of numbers"),
        ([0], [[0.5, 0.5, 0.5]], "weights: expected barycentric weights that sum to 1"),
        ([0], [[np.nan, 0.5, 0.5]], "weights: expected finite numbers"),
        ([-1], [[1.0, 0.0, 0.0]], "faces: expected indices from 0"),
        ([0.0], [[1.0, 0.0, 0.0]], "faces: expected integer indices"),
    ],
)
def test_bad_mesh_points_are_refused(faces, weights, sentence):
    with pytest.raises(InputError, match=sentence):
        MeshPoints(faces, weights)


def test_points_of_another_mesh_are_refused():
    points = MeshPoints([1], [[1.0, 0.0, 0.0]])
    with pytest.raises(InputError, match="faces: expected indices from 0 to 0, got 1"):
        TriMesh(TRIANGLE, FACE).evaluate(points, TRIANGLE)


def test_barycentric_weights_reproduce_the_point_and_reject_flat_triangles():
    corners = np.array([[[0.0, 0.0], [3.0, 1.0], [1.0, 4.0]], [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]])
    weights = barycentric(corners, np.array([1.0, 1.5]))
    assert weights[0] @ corners[0] == pytest.approx([1.0, 1.5], abs=1e-15)
    assert weights[0].sum() == pytest.approx(1.0, abs=1e-15)
    assert weights[1].max() < 0


@pytest.mark.parametrize("seed", range(6))
def test_gaps_have_the_way_of_least_widths_between_parts(seed):
    """Parts at random places: the narrowest gaps that join all of them are those of comparing every pair."""
    rng = np.random.default_rng(seed)
    centers = 40 * np.stack(np.divmod(rng.choice(49, 12, replace=False), 7), axis=1)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    vertices = np.concatenate(
        [center + rng.uniform(8, 30) * corners + rng.normal(size=2) for center in centers]
    )
    faces = (4 * np.arange(12)[:, None, None] + [[0, 1, 2], [0, 2, 3]]).reshape(-1, 3)
    mesh = TriMesh(vertices, faces)
    ways = np.linalg.norm(vertices[:, None] - vertices, axis=2)
    between = [
        (ways[mesh.component == a][:, mesh.component == b].min(), a, b) for a in range(12) for b in range(a)
    ]
    found = [(ways[i, j], *sorted(mesh.component[[i, j]], reverse=True)) for i, j in mesh.gaps]
    assert joining(found) == pytest.approx(joining(between))
    assert [width for width, _, _ in found] == sorted(width for width, _, _ in found)
    assert len({gap[1:] for gap in found}) == len(found)


def joining(gaps):
    """Widths of the narrowest gaps that make one of all parts, by Kruskal's algorithm."""
    group, widths = {}, []
    for width, a, b in sorted(gaps):
        first, second = group.setdefault(a, {a}), group.setdefault(b, {b})
        if first is not second:
            widths.append(width)
            first |= second
            group.update(dict.fromkeys(first, first))
    return widths


def test_one_part_has_no_gaps():
    assert TriMesh(TRIANGLE, FACE).gaps.shape == (0, 2)


def test_renumbered_mesh_is_that_made_anew(mesh):
    generator = np.random.default_rng(5)
    vertex_order, face_order = (generator.permutation(len(part)) for part in (mesh.vertices, mesh.faces))
    found = mesh.renumber(vertex_order, face_order)
    anew = TriMesh(found.vertices, found.faces)
    assert (found.edges == anew.edges).all()
    assert (found.face_edges == anew.face_edges).all()
    assert (found.boundary_vertices == anew.boundary_vertices).all()
    assert {frozenset(loop.tolist()) for loop in found.boundary_loops} == {
        frozenset(loop.tolist()) for loop in anew.boundary_loops
    }
    together = found.component[:, None] == found.component
    assert (together == (anew.component[:, None] == anew.component)).all()
    assert (found.component == mesh.component[vertex_order]).all()


@pytest.mark.parametrize("chosen", [(0,), (2,), (0, 1), (1, 2), (0, 1, 2)])
def test_part_of_a_mesh_is_that_made_anew(chosen):
    triangles = [TRIANGLE + offset for offset in ((0.0, 0.0), (9.0, 0.0), (0.0, 9.0))]
    fourth_corner = np.array([(10.0, 1.0)])  # of the second one, whose faces are the first and the last
    faces = np.array([(3, 4, 5), (6, 7, 8), (0, 1, 2), (4, 9, 5)])
    whole = TriMesh(np.concatenate([*triangles, fourth_corner]), faces)
    component = whole.component
    vertices = np.flatnonzero(np.isin(component, chosen))
    own = np.flatnonzero(np.isin(component[whole.faces[:, 0]], chosen))
    found = whole.part(vertices, own)
    layers = component[vertices] if len(chosen) > 1 else None
    anew = TriMesh(whole.vertices[vertices], np.searchsorted(vertices, whole.faces[own]), layers=layers)
    for name in ("vertices", "faces", "edges", "face_edges", "component", "boundary_vertices", "face_layers"):
        got, expected = getattr(found, name), getattr(anew, name)
        assert got.dtype == expected.dtype
        assert np.array_equal(got, expected)
    assert [loop.tolist() for loop in found.boundary_loops] == [loop.tolist() for loop in anew.boundary_loops]


# --- layers ---

TWO = np.array([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)] * 2)
ONE_FACE_EACH = np.array([(0, 1, 2), (3, 4, 5)])


def test_vertices_of_different_layers_may_be_at_one_place():
    mesh = TriMesh(TWO, ONE_FACE_EACH, layers=[0, 0, 0, 1, 1, 1])
    assert mesh.face_layers.tolist() == [0, 1]
    with pytest.raises(InputError, match="at the same place"):
        TriMesh(TWO, ONE_FACE_EACH)


@pytest.mark.parametrize(
    ("layers", "message"),
    [
        ([0, 0, 0, 1, 1], "expected one for each of 6 vertices, got 5"),
        ([0, 0, 1, 1, 1, 0], "expected faces on one layer, but face 0 is on two"),
        ([0, 0, 0, -1, -1, -1], "expected indices from 0 to 5, got -1"),
        ([0.0] * 6, "expected integer indices"),
    ],
)
def test_layers_that_do_not_fit_are_refused(layers, message):
    with pytest.raises(InputError, match=message):
        TriMesh(TWO, ONE_FACE_EACH, layers=layers)


def test_points_are_located_on_the_layer_that_is_asked_for():
    mesh = TriMesh(TWO + np.array([(0, 0)] * 3 + [(1, 0)] * 3), ONE_FACE_EACH, layers=[0, 0, 0, 1, 1, 1])
    points = [(1.5, 1.0)] * 3
    assert mesh.locate(points, layers=[0, 1, -1]).faces.tolist() == [0, 1, 1]
    with pytest.raises(InputError, match="lies outside the drawing"):
        mesh.locate([(0.1, 0.1)], layers=[1])


@pytest.mark.parametrize(("order", "found"), [(None, [0, 1]), ([1, 0], [1, 0]), ([0], [0]), ([], [])])
def test_all_faces_at_a_point_are_found_from_back_to_front_without_those_that_are_not_drawn(order, found):
    mesh = TriMesh(TWO, ONE_FACE_EACH, layers=[0, 0, 0, 1, 1, 1])
    order = None if order is None else np.array(order, dtype=np.int64)
    assert mesh.find_all((1.0, 1.0), order=order).faces.tolist() == found
    front = mesh.find((1.0, 1.0), order=order)
    assert (front is None) == (not found)
    assert front is None or front.faces.tolist() == found[-1:]
