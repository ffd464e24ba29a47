"""Moving least squares: maps that the three transforms reproduce, and the paper's formulas."""

import numpy as np
import pytest

from akap_editor.deform.rivals.moving_least_squares import MovingLeastSquaresDeformer
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import MeshPoints
from tests.support import shapes

RIGID = np.array([[0.6, 0.8], [-0.8, 0.6]])
SIMILARITY = 1.7 * RIGID
AFFINE = np.array([[1.3, 0.4], [-0.2, 0.7]])
SHIFT = np.array([30.0, -80.0])
TRANSFORMS = ["rigid", "similarity", "affine"]


@pytest.fixture(params=TRANSFORMS)
def transform(request):
    return request.param


def moved(mesh, points, targets, **settings):
    deformer = MovingLeastSquaresDeformer(mesh, **settings)
    deformer.set_pins(points)
    return deformer.step(mesh.vertices, targets).positions


def some_targets(mesh, points, seed=1):
    rng = np.random.default_rng(seed)
    return mesh.evaluate(points, mesh.vertices) + rng.normal(scale=8.0, size=(len(points), 2))


def vertex_pins(mesh, each=4, seed=1):
    """Pins at vertices, ``each`` in every part (or all it has)."""
    rng = np.random.default_rng(seed)
    parts = [np.flatnonzero(mesh.component == part) for part in np.unique(mesh.component)]
    chosen = np.concatenate([rng.choice(part, min(each, len(part)), replace=False) for part in parts])
    return chosen, shapes.vertex_pins(mesh, chosen)


def least_squares(vertex, pins, targets, weights, transform):
    """Where the transform that fits best takes ``vertex``: the paper's eq. 1 by plain least squares.

    The rotation by singular value decomposition (Kabsch), which needs none of the paper's formulas.
    """
    middle, aim = weights @ pins / weights.sum(), weights @ targets / weights.sum()
    p, q, root = pins - middle, targets - aim, np.sqrt(weights)[:, None]
    if transform == "affine":
        return (vertex - middle) @ np.linalg.lstsq(root * p, root * q, rcond=None)[0] + aim
    left, _, right = np.linalg.svd((weights[:, None] * p).T @ q)
    turn = left @ np.diag([1.0, np.linalg.det(left @ right)]) @ right
    if transform == "similarity":
        turn = turn * (weights @ ((p @ turn) * q).sum(axis=1)) / (weights @ (p**2).sum(axis=1))
    return (vertex - middle) @ turn + aim


@pytest.mark.parametrize("alpha", [0.5, 1.0, 2.0])
def test_each_vertex_goes_where_its_least_squares_take_it(mesh, transform, alpha):
    points = shapes.random_pins(mesh, 1, 4)
    targets = some_targets(mesh, points)
    found = moved(mesh, points, targets, transform=transform, alpha=alpha)
    pins, owner = mesh.evaluate(points, mesh.vertices), mesh.component[mesh.faces[points.faces, 0]]
    for vertex, part, place in zip(mesh.vertices, mesh.component, found, strict=True):
        own = owner == part
        weights = ((pins[own] - vertex) ** 2).sum(axis=1) ** -alpha
        expected = least_squares(vertex, pins[own], targets[own], weights, transform)
        assert np.abs(place - expected).max() < 1e-7


@pytest.mark.parametrize("alpha", [0.5, 1.0, 4.0])
def test_pins_at_vertices_are_exactly_at_their_targets(mesh, transform, alpha):
    chosen, points = vertex_pins(mesh)
    targets = some_targets(mesh, points)
    found = moved(mesh, points, targets, transform=transform, alpha=alpha)
    assert np.abs(found[chosen] - targets).max() < 1e-10


@pytest.mark.parametrize(
    ("transform", "matrix"),
    [
        ("rigid", RIGID),
        ("similarity", RIGID),
        ("similarity", SIMILARITY),
        ("affine", RIGID),
        ("affine", SIMILARITY),
        ("affine", AFFINE),
    ],
)
def test_transforms_of_its_kind_are_reproduced(mesh, transform, matrix):
    points = shapes.random_pins(mesh, 2, 4)
    expected = mesh.vertices @ matrix + SHIFT
    found = moved(mesh, points, mesh.evaluate(points, expected), transform=transform)
    assert np.abs(found - expected).max() < 1e-8


def test_rigid_maps_do_not_follow_a_scaling():
    mesh = shapes.SHAPES["disc 2"]
    chosen, points = vertex_pins(mesh)
    targets = 2 * mesh.vertices[chosen]
    found = moved(mesh, points, targets)
    assert np.abs(found[chosen] - targets).max() < 1e-10
    assert np.abs(found - 2 * mesh.vertices).max() > 20.0


def test_two_pins_make_a_similarity_of_an_affine_map(mesh):
    points = shapes.random_pins(mesh, 3, 2)
    targets = some_targets(mesh, points)
    similar, affine = (moved(mesh, points, targets, transform=name) for name in ("similarity", "affine"))
    assert affine.tolist() == similar.tolist()


@pytest.mark.parametrize("nearness", [0.0, 1e-9])
def test_affine_maps_with_pins_on_a_line_are_similarities(nearness):
    mesh = shapes.SHAPES["bar"]
    points = mesh.locate([[20.0, 33.0], [150.0, 33.0 + nearness], [280.0, 33.0]])
    targets = mesh.evaluate(points, mesh.vertices) @ SIMILARITY
    found = moved(mesh, points, targets, transform="affine")
    assert np.abs(found - mesh.vertices @ SIMILARITY).max() < 1e-6


def test_pins_at_one_place_translate_by_their_mean(mesh, transform):
    points = MeshPoints([0, 0], [[0.2, 0.3, 0.5]] * 2)
    here = mesh.evaluate(points, mesh.vertices)
    found = moved(mesh, points, here + np.array([[12.0, 0.0], [0.0, -4.0]]), transform=transform)
    own = mesh.component == mesh.component[mesh.faces[0, 0]]
    assert np.abs(found - mesh.vertices - [6.0, -2.0])[own].max() < 1e-10


def test_targets_at_one_place_do_not_turn_a_rigid_map(mesh):
    """No rotation fits better than another."""
    points = shapes.random_pins(mesh, 2)
    targets = np.tile([40.0, 70.0], (len(points), 1))
    first = moved(mesh, points, targets)
    turned = moved(mesh, points, targets[:, ::-1].copy())
    assert np.abs(first - turned - [-30.0, 30.0]).max() < 1e-9


def test_the_pose_so_far_does_not_matter(mesh, transform):
    points = shapes.random_pins(mesh, 1)
    targets = some_targets(mesh, points)
    deformer = MovingLeastSquaresDeformer(mesh, transform)
    deformer.set_pins(points)
    from_rest = deformer.step(mesh.vertices, targets).positions
    assert deformer.step(mesh.vertices[::-1] * 3, targets).positions.tolist() == from_rest.tolist()


@pytest.mark.parametrize("alpha", [1.0, 10.0])
def test_hardly_separated_pins_and_vertices_stay_finite(transform, alpha):
    mesh = shapes.SHAPES["disc 1"]
    points = MeshPoints(
        [0, 0, 40, 60], [[1.0, 0.0, 0.0], [1 - 1e-12, 1e-12, 0.0], [0.2, 0.3, 0.5], [0, 1, 0]]
    )
    with np.errstate(all="raise", under="ignore"):
        found = moved(mesh, points, some_targets(mesh, points), transform=transform, alpha=alpha)
    assert np.isfinite(found).all()


@pytest.mark.parametrize("name", ["elephant", "cat", "noto/gecko"])
def test_pins_of_a_cartoon_nearly_arrive(cartoon_mesh, name, transform):
    mesh = cartoon_mesh(name)
    points = shapes.random_pins(mesh, 1, 4)
    size = mesh.length
    targets = mesh.evaluate(points, mesh.vertices)
    targets += np.random.default_rng(1).normal(scale=0.05 * size, size=targets.shape)
    found = moved(mesh, points, targets, transform=transform)
    off = np.hypot(*(mesh.evaluate(points, found) - targets).T)
    assert off.max() < 0.01 * size
    chosen, points = vertex_pins(mesh)
    targets = some_targets(mesh, points)
    assert np.abs(moved(mesh, points, targets, transform=transform)[chosen] - targets).max() < 1e-9


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (
            {"transform": "conformal"},
            "transform: expected 'rigid', 'similarity' or 'affine', got 'conformal'",
        ),
        ({"transform": None}, "transform: expected 'rigid'"),
        ({"alpha": 0}, "alpha: expected a number from 0.1 to 10, got 0"),
        ({"alpha": float("inf")}, "alpha: expected a number"),
    ],
)
def test_bad_settings_are_refused(settings, message):
    with pytest.raises(InputError, match=message):
        MovingLeastSquaresDeformer(shapes.SHAPES["triangle"], **settings)
