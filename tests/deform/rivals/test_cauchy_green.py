"""Point-to-point Cauchy-Green coordinates: Cauchy's formula, conformal maps, pins."""

import numpy as np
import pytest
import shapely

from akap_editor.deform.rivals.cauchy_green import (
    CAGE_OFFSET,
    CauchyGreenDeformer,
    coordinates,
    make_cage,
    second_derivatives,
)
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import MeshPoints, TriMesh
from tests.support import shapes

CAGE = np.array([0, 2 + 0.3j, 3 - 0.5j, 3.4 + 2j, 1.8 + 1.1j, 0.2 + 1.9j])  # not convex
INSIDE = np.array([0.4 + 0.5j, 1.7 + 0.8j, 3.0 + 1.2j, 0.3 + 1.5j])


def moved(mesh, points, targets, cage=60, **settings):
    deformer = CauchyGreenDeformer(mesh, cage, **settings)
    deformer.set_pins(points)
    return deformer.step(mesh.vertices, targets).positions


def some_targets(mesh, points, scale=8.0, seed=1):
    rng = np.random.default_rng(seed)
    return mesh.evaluate(points, mesh.vertices) + rng.normal(scale=scale, size=(len(points), 2))


# -- the coordinates -----------------------------------------------------------------------------------------


def cauchy_integral(cage, values, z, power=1):
    """(power − 1)! / 2πi ∮ h(w) / (w − z)^power dw by Gauss's quadrature, h linear along edges."""
    nodes, weights = np.polynomial.legendre.leggauss(80)
    t = (nodes + 1) / 2
    total = 0
    for j in range(len(cage)):
        a, b, f, g = cage[j - 1], cage[j], values[j - 1], values[j]
        w = a + t * (b - a)
        total += (weights / 2 * (f + t * (g - f)) / (w - z) ** power).sum() * (b - a)
    return {1: 1, 3: 2}[power] * total / (2j * np.pi)


def test_coordinates_are_cauchys_integrals_of_linear_values():
    values = np.random.default_rng(1).normal(size=(6, 2)).view(complex)[:, 0]
    found = coordinates(CAGE, INSIDE) @ values
    expected = [cauchy_integral(CAGE, values, z) for z in INSIDE]
    assert np.abs(found - expected).max() < 1e-10
    found = second_derivatives(CAGE, INSIDE) @ values
    expected = [cauchy_integral(CAGE, values, z, power=3) for z in INSIDE]
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


def test_coordinates_reproduce_similarities_and_nothing_outside():
    a, b = 1.5 - 0.7j, 20 + 3j
    assert np.abs(coordinates(CAGE, INSIDE) @ (a * CAGE + b) - a * INSIDE - b).max() < 1e-12
    assert np.abs(second_derivatives(CAGE, INSIDE) @ (a * CAGE + b)).max() < 1e-12
    outside = np.array([1.8 + 1.8j, -1.0, 4 + 4j])
    assert np.abs(coordinates(CAGE, outside) @ CAGE).max() < 1e-12


# -- the cage ------------------------------------------------------------------------------------------------


def ragged(teeth):
    """A gear with so many corners that a cage of few vertices has to leave some out."""
    angles = np.arange(4 * teeth) * 2 * np.pi / (4 * teeth)
    radius = np.repeat(np.tile([0.55, 0.62], teeth), 2) + 0.01 * np.sin(5 * angles)
    return shapely.Polygon(np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1))


@pytest.mark.parametrize("size", [16, 40, 200])
@pytest.mark.parametrize(
    "outline",
    [
        shapely.box(0, 0, 10, 0.1),
        shapely.Polygon([(0, 0), (1, 0), (0, 0.02)]),
        shapely.Polygon([(0, 0), (2, 0), (2, 1), (1.02, 1), (1.02, 0.1), (1, 0.1), (1, 1), (0, 1)]),
        ragged(10),
        ragged(60),
    ],
    ids=["needle", "thorn", "slot", "gear", "file"],
)
def test_cage_is_a_simple_polygon_of_few_vertices_around_the_outline(outline, size):
    cage = make_cage(outline, size)
    around = shapely.Polygon(np.stack([cage.real, cage.imag], axis=1))
    assert len(cage) <= size
    assert around.is_valid
    assert around.exterior.is_ccw
    assert around.contains(outline)
    assert around.exterior.distance(outline) > 0.4 * CAGE_OFFSET


def test_what_is_left_out_does_not_depend_on_where_a_ring_begins():
    """Nor on its rotation."""
    outline = ragged(60)
    points = np.array(outline.exterior.coords)[:-1]
    other = shapely.Polygon(np.roll(points, 17, axis=0) @ [[0.6, 0.8], [-0.8, 0.6]])
    first, second = (make_cage(polygon, 60) for polygon in (outline, other))
    turned = first * (0.6 + 0.8j)
    assert np.abs(turned[:, None] - second).min(axis=1).max() < 1e-9


@pytest.mark.parametrize("smoothness", [1e-4, 1e-2])
@pytest.mark.parametrize("shape_name", ["L", "star", "strip"])
def test_a_finer_cage_makes_hardly_a_difference(mesh, smoothness):
    points = shapes.random_pins(mesh, 1, 4)
    targets = some_targets(mesh, points)
    coarse, fine = (moved(mesh, points, targets, cage=size, smoothness=smoothness) for size in (60, 250))
    assert np.abs(coarse - fine).max() < 0.02 * np.abs(fine - mesh.vertices).max()


# -- laws ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("smoothness", [1e-6, 1e-4, 1.0])
@pytest.mark.parametrize("factor", [np.exp(0.9j), 0.3 - 0.4j])
def test_similarities_are_reproduced(mesh, factor, smoothness):
    points = shapes.random_pins(mesh, 1, 4)
    z = factor * (mesh.vertices[:, 0] + 1j * mesh.vertices[:, 1]) + (30 - 80j)
    expected = np.stack([z.real, z.imag], axis=1)
    found = moved(mesh, points, mesh.evaluate(points, expected), smoothness=smoothness)
    assert np.abs(found - expected).max() < 1e-7


def test_two_pins_make_a_similarity(mesh):
    points = shapes.random_pins(mesh, 3, 2)
    found = moved(mesh, points, some_targets(mesh, points))
    assert distortion(mesh, found).face_angle == pytest.approx(2.0, abs=1e-7)


def test_angle_distortion_vanishes_as_the_mesh_is_refined():
    """With its square, as the map is holomorphic and the mesh shows it linear on each face."""
    mesh = shapes.SHAPES["L"]
    chosen = np.random.default_rng(3).choice(len(mesh.vertices), 4, replace=False)
    targets = mesh.vertices[chosen] + np.random.default_rng(3).normal(scale=4.0, size=(4, 2))
    points, faces, excess, areas = mesh.vertices, mesh.faces, [], []
    for _ in range(4):
        mesh = TriMesh(points, faces)
        found = moved(mesh, shapes.vertex_pins(mesh, chosen), targets)
        after = distortion(mesh, found)
        excess.append(after.angle - 2)
        areas.append(after.area - 2)
        points, faces = shapes.subdivide(points, faces)
    ratios = np.divide(excess[:-1], excess[1:])
    assert (ratios > 3).all()
    assert excess[-1] < 1e-3 < areas[-1]


def test_smaller_smoothness_brings_pins_nearer():
    mesh = shapes.SHAPES["disc 2"]
    points = shapes.random_pins(mesh, 1, 5)
    targets = some_targets(mesh, points)
    errors, bends = [], []
    for smoothness in (1.0, 1e-1, 1e-2, 1e-4):
        found = moved(mesh, points, targets, smoothness=smoothness)
        errors.append(np.hypot(*(mesh.evaluate(points, found) - targets).T).max())
        bends.append(distortion(mesh, found).area)
    assert errors == sorted(errors, reverse=True)
    assert bends == sorted(bends)
    assert errors[-1] < 0.01


def test_pins_at_one_place_translate_by_their_mean(mesh):
    points = MeshPoints([0, 0], [[0.2, 0.3, 0.5]] * 2)
    here = mesh.evaluate(points, mesh.vertices)
    found = moved(mesh, points, here + np.array([[12.0, 0.0], [0.0, -4.0]]))
    own = mesh.component == mesh.component[mesh.faces[0, 0]]
    assert np.abs(found - mesh.vertices - [6.0, -2.0])[own].max() < 1e-10


def test_a_hole_is_bent_as_if_filled():
    ring = shapes.blocks("### #.# ###", 50, 3)
    whole = shapes.blocks("### ### ###", 50, 3)
    places = np.array([[20.0, 30.0], [120.0, 25.0], [130.0, 140.0], [30.0, 120.0]])
    targets = places + np.array([[8.0, 3.0], [-2.0, 9.0], [4.0, -6.0], [0.0, 0.0]])
    bent, filled = (moved(shape, shape.locate(places), targets) for shape in (ring, whole))
    same = (ring.vertices[:, None] == whole.vertices).all(axis=2)
    assert (same.sum(axis=1) == 1).all()
    assert np.abs(bent - filled[same.argmax(axis=1)]).max() < 1e-6


def test_the_pose_so_far_does_not_matter(mesh):
    points = shapes.random_pins(mesh, 1)
    targets = some_targets(mesh, points)
    deformer = CauchyGreenDeformer(mesh, cage=40)
    deformer.set_pins(points)
    from_rest = deformer.step(mesh.vertices, targets).positions
    assert deformer.step(mesh.vertices[::-1] * 3, targets).positions.tolist() == from_rest.tolist()


@pytest.mark.parametrize("name", ["elephant", "cat", "noto/gecko"])
def test_pins_of_a_cartoon_arrive(cartoon_mesh, name):
    mesh = cartoon_mesh(name)
    points = shapes.random_pins(mesh, 1, 5)
    size = mesh.length
    targets = mesh.evaluate(points, mesh.vertices)
    targets += np.random.default_rng(1).normal(scale=0.03 * size, size=targets.shape)
    found = moved(mesh, points, targets, cage=200)
    assert np.hypot(*(mesh.evaluate(points, found) - targets).T).max() < 1e-3 * size
    assert distortion(mesh, found).angle < 2.1


def test_rest_pose_that_overlaps_itself_is_refused():
    """Faces along a spiral of more than one turn."""
    turn = np.linspace(0, 2.6 * np.pi, 40)
    rim = [[r * np.cos(turn), r * np.sin(turn)] for r in (40.0, 80.0)]
    vertices = np.concatenate([np.transpose(side) for side in rim])
    i = np.arange(39)
    faces = np.concatenate([np.stack([i, i + 40, i + 41], axis=1), np.stack([i, i + 41, i + 1], axis=1)])
    with pytest.raises(InputError, match="mesh: expected a rest pose that does not overlap itself"):
        CauchyGreenDeformer(TriMesh(vertices, faces))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"cage": 3}, "cage: expected a number from 16 to 1000, got 3"),
        ({"cage": None}, "cage: expected a number"),
        ({"smoothness": 0}, r"smoothness: expected a number from 1e-06 to 1e\+06, got 0"),
    ],
)
def test_bad_settings_are_refused(settings, message):
    with pytest.raises(InputError, match=message):
        CauchyGreenDeformer(shapes.SHAPES["triangle"], **settings)
