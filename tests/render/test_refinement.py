"""A mesh that is refined for drawing: no gaps, exact for linear maps, nearer to smooth ones."""

import numpy as np
import pytest

from akap_editor.geometry.mesh import TriMesh, signed_areas
from akap_editor.render.refinement import MAX_FACES, MAX_PARTS, TOLERANCE, refinement, suitable_parts
from tests.support.shapes import SHAPES


@pytest.fixture(params=[2, 3, 4])
def parts(request):
    return request.param


def bend(points):
    """A strip rolled into a part of a ring."""
    angle, radius = points[:, 0] / 3.0, 4.0 + points[:, 1]
    return np.column_stack([radius * np.sin(angle), radius * np.cos(angle)])


def grid_mesh(count: int) -> TriMesh:
    """Squares cut into two triangles each, over (0, 4) × (0, 1)."""
    x, y = np.meshgrid(np.linspace(0, 4, 4 * count + 1), np.linspace(0, 1, count + 1))
    corners = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (
        each.ravel() for each in (corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:])
    )
    faces = np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])
    return TriMesh(np.column_stack([x.ravel(), y.ravel()]), faces)


@pytest.mark.parametrize("name", SHAPES)
def test_at_rest_and_for_linear_maps_nothing_is_curved(name, parts):
    mesh = SHAPES[name]
    made = refinement(mesh, parts)
    pose = mesh.vertices @ np.array([[1.2, 0.3], [-0.4, 0.9]]) + (5.0, -2.0)
    for positions in (mesh.vertices, pose):
        np.testing.assert_allclose(made.smooth @ positions, made.linear @ positions, atol=1e-9)


@pytest.mark.parametrize("name", SHAPES)
def test_the_small_faces_cover_the_mesh_without_gaps(name, parts):
    mesh = SHAPES[name]
    made = refinement(mesh, parts)
    rest, small = made.linear @ mesh.vertices, made.faces.reshape(-1, 3)
    areas = signed_areas(rest, small).reshape(len(mesh.faces), parts**2)
    np.testing.assert_allclose(
        areas, np.repeat(mesh.rest_areas[:, None] / parts**2, parts**2, axis=1), rtol=1e-6
    )
    refined = TriMesh(rest, small)
    assert len(refined.boundary_loops) == len(mesh.boundary_loops)
    assert sum(map(len, refined.boundary_loops)) == parts * sum(map(len, mesh.boundary_loops))
    assert refined.component.max() == mesh.component.max()


def test_vertices_stay_where_the_pose_has_them(parts):
    mesh = grid_mesh(3)
    made, pose = refinement(mesh, parts), bend(mesh.vertices)
    np.testing.assert_allclose((made.smooth @ pose)[: len(pose)], pose)


def test_a_bend_is_followed_better_the_more_so_the_finer_the_mesh():
    errors = []
    for count in (2, 4, 8):
        mesh = grid_mesh(count)
        made, pose = refinement(mesh, MAX_PARTS), bend(mesh.vertices)
        exact = bend(made.linear @ mesh.vertices)
        flat, smooth = (np.abs(each @ pose - exact).max() for each in (made.linear, made.smooth))
        errors.append((flat, smooth))
        inner = np.linalg.norm(made.smooth @ pose - exact, axis=1).mean()
        assert inner < 0.45 * np.linalg.norm(made.linear @ pose - exact, axis=1).mean()
    assert all(smooth < 0.8 * flat for flat, smooth in errors)
    assert errors[2][1] < 0.3 * errors[0][1]


@pytest.mark.parametrize(("count", "expected"), [(10, 4), (MAX_FACES // 9, 3), (MAX_FACES, 1), (10**7, 1)])
def test_a_fine_mesh_is_divided_less(count, expected):
    class Mesh:
        faces = range(count)

    assert suitable_parts(Mesh()) == expected


@pytest.mark.parametrize("scale", [0.1, 1.0, 4.0, 16.0, 40.0])
def test_the_coarsest_refinement_is_taken_whose_lines_are_near_the_curves(scale):
    mesh = grid_mesh(3)
    fine, pose = refinement(mesh, 16), bend(mesh.vertices)
    fitting = fine.fitting(scale * fine.bend(pose))
    start, end = (pose[each][:, None] for each in mesh.edges.T)
    inner = (fine.smooth @ pose)[len(pose) : len(pose) + 15 * len(mesh.edges)].reshape(-1, 15, 2)
    curves = scale * np.concatenate([start, inner, end], axis=1)  # in pixels

    def distance(parts: int) -> float:
        knots = curves[:, :: 16 // parts]
        t = np.arange(17) * parts / 16
        left = np.minimum(t.astype(int), parts - 1)
        lines = knots[:, left] + (t - left)[:, None] * (knots[:, left + 1] - knots[:, left])
        return float(np.linalg.norm(lines - curves, axis=2).max())

    assert distance(fitting.parts) <= TOLERANCE
    if fitting.parts > 1:
        assert distance(fitting.parts // 2) > 0.3 * TOLERANCE, "it is hardly finer than needed"


def test_coarser_refinements_have_the_same_points():
    mesh = grid_mesh(2)
    fine = refinement(mesh, MAX_PARTS)
    assert [each.parts for each in fine.coarser] == [1, 2]
    assert fine.coarser[0].faces.reshape(-1, 3).tolist() == mesh.faces.tolist()
    for each in fine.coarser:
        own = refinement(mesh, each.parts)
        rest, expected = fine.linear @ mesh.vertices, own.linear @ mesh.vertices
        np.testing.assert_allclose(rest[each.faces], expected[own.faces], atol=1e-12)


def test_a_linear_map_needs_flat_faces_only():
    mesh = grid_mesh(2)
    fine = refinement(mesh, MAX_PARTS)
    pose = mesh.vertices @ np.array([[1.2, 0.3], [-0.4, 0.9]])
    assert fine.fitting(1000 * fine.bend(pose)).parts == 1
