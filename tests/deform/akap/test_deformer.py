"""`AkapDeformer`: one step against the equations, pins arrive, memory, and stiffness."""

import numpy as np
import pytest
from PIL import Image

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.errors import InputError, SolverError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import MeshPoints, TriMesh
from akap_editor.geometry.operators import to_complex, to_points
from akap_editor.meshing.outline import outlines
from akap_editor.meshing.triangulate import triangulate
from akap_editor.resources import bundled_drawings
from tests.support import dense, shapes
from tests.support.deformers import akap_with_pins, bent_pose
from tests.support.dense import killing_energy

DRAWINGS = {path.stem: path for path in bundled_drawings()}
WHOLE = float("inf")  # max_step: one field for the whole step


@pytest.mark.parametrize("trajectory", ["spiral", "linear"])
@pytest.mark.parametrize("dirichlet", [True, False])
def test_step_without_memory_is_that_of_the_paper(mesh, dirichlet, trajectory):
    points, pose = shapes.random_pins(mesh, 1), bent_pose(mesh)
    # so small that the pins are not corrected after the step
    velocities = np.random.default_rng(1).normal(scale=1e-3, size=(len(points), 2))
    settings = {"dirichlet": dirichlet, "trajectory": trajectory, "max_step": WHOLE, "exact": True}
    deformer = akap_with_pins(mesh, points, **settings)
    result = deformer.step(pose, mesh.evaluate(points, pose) + velocities)
    field = dense.smooth_field(mesh, pose, points, velocities, 100.0)
    if dirichlet:
        field = dense.dirichlet_field(mesh, pose, field)
    moved = dense.spiral_flow(mesh, pose, field) if trajectory == "spiral" else pose + field
    assert (result.report.substeps, result.report.blocked) == (1, False)
    assert np.abs(result.field - field).max() < 1e-8 * np.abs(field).max()
    assert np.abs(result.positions - moved).max() < 1e-8 * np.abs(field).max()
    assert np.abs(deformer.vector_field(pose, velocities) - field).max() < 1e-8 * np.abs(field).max()


def test_long_step_is_divided_into_equal_substeps(mesh):
    points = shapes.random_pins(mesh, 2)
    start = mesh.evaluate(points, mesh.vertices)
    goals = start + np.array([7.0, -3.0])
    length = np.hypot(7.0, 3.0) / 3.5 / mesh.length
    result = akap_with_pins(mesh, points, max_step=length).step(mesh.vertices, goals)
    assert result.report.substeps == 4
    single, pose = akap_with_pins(mesh, points, max_step=WHOLE), mesh.vertices
    for index in range(1, 5):
        pose = single.step(pose, start + index / 4 * (goals - start)).positions
    assert np.abs(result.positions - pose).max() < 1e-9


def test_report(mesh):
    points = shapes.random_pins(mesh, 3)
    offsets = 0.1 * np.random.default_rng(3).normal(size=(len(points), 2))
    goals = mesh.evaluate(points, mesh.vertices) + offsets
    result = akap_with_pins(mesh, points).step(mesh.vertices, goals)
    offsets = mesh.evaluate(points, result.positions) - goals
    report = result.report
    assert report.pin_error == pytest.approx(np.hypot(*offsets.T).max(), rel=1e-9)
    assert report.flipped == distortion(mesh, result.positions).flipped
    assert report.substeps == 1
    assert report.energy == pytest.approx(killing_energy(mesh.vertices, mesh.faces, result.field), abs=1e-9)
    assert report.seconds > 0


def rotated(points, angle):
    """Points (k, 2) rotated about their mean."""
    center = points.mean(axis=0)
    cos, sin = np.cos(angle), np.sin(angle)
    return (points - center) @ [[cos, sin], [-sin, cos]] + center


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_pins_rotated_together_rotate_the_drawing(memory):
    """By targets, not velocities: exact only in the limit of small steps."""
    mesh = shapes.SHAPES["bar"]
    points = shapes.random_pins(mesh, 4, 3)
    deformer, pose = akap_with_pins(mesh, points, memory=memory), mesh.vertices
    for angle in np.linspace(0, np.pi / 2, 46)[1:]:
        pose = deformer.step(pose, rotated(mesh.evaluate(points, mesh.vertices), angle)).positions
    quality = distortion(mesh, pose)
    assert quality.area == pytest.approx(2, abs=1e-3)
    assert quality.angle == pytest.approx(2, abs=1e-3)


def settle(deformer, pose, goals, steps=40):
    """Step until nothing moves by more than a thousandth of a pixel."""
    for _ in range(steps):
        result = deformer.step(pose, goals)
        still = np.abs(result.positions - pose).max() < 1e-3
        pose = result.positions
        if still:
            break
    return result


@pytest.mark.parametrize("memory", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("dirichlet", [True, False])
def test_pins_arrive(mesh, memory, dirichlet):
    points = shapes.random_pins(mesh, 5)
    goals = mesh.evaluate(points, bent_pose(mesh)) + np.array([12.0, -20.0])
    result = settle(akap_with_pins(mesh, points, memory=memory, dirichlet=dirichlet), mesh.vertices, goals)
    assert result.report.pin_error < 0.25
    assert result.report.flipped == 0


def bar_ends(mesh):
    """Pins on the vertices of both ends of the bar; those of the right end come last."""
    x = mesh.vertices[:, 0]
    left, right = np.flatnonzero(x == x.min()), np.flatnonzero(x == x.max())
    return shapes.vertex_pins(mesh, np.concatenate([left, right])), len(right)


def bend_and_back(mesh, memory):
    """Poses of the bar: its right end rotated by 90° about the middle, and rotated back."""
    points, count = bar_ends(mesh)
    deformer = akap_with_pins(mesh, points, memory=memory)
    rest = mesh.evaluate(points, mesh.vertices)
    center = mesh.vertices.mean(axis=0)
    poses, pose = [], mesh.vertices
    angles = np.linspace(0, np.pi / 2, 31)
    for path in (angles[1:], angles[-2::-1]):
        for angle in path:
            goals = rest.copy()
            turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            goals[-count:] = (rest[-count:] - center) @ turn + center
            pose = deformer.step(pose, goals).positions
        pose = settle(deformer, pose, goals, 300).positions
        poses.append(pose)
    return poses


def test_memory_brings_the_bar_back_to_rest():
    mesh = shapes.SHAPES["bar"]
    there, back = bend_and_back(mesh, 1.0)
    assert distortion(mesh, there).flipped == 0
    assert np.abs(there - mesh.vertices).max() > 100
    assert np.abs(back - mesh.vertices).max() < 0.01


def test_without_memory_the_path_leaves_a_trace():
    """As in section 3.2; memory leaves less than a tenth of it."""
    mesh = shapes.SHAPES["bar"]
    _, back = bend_and_back(mesh, 0.0)
    assert np.abs(back - mesh.vertices).max() > 0.1


def test_memory_lowers_distortion():
    mesh = shapes.SHAPES["bar"]
    plain, with_memory = (distortion(mesh, bend_and_back(mesh, memory)[0]) for memory in (0.0, 1.0))
    assert with_memory.area < plain.area
    assert with_memory.angle < plain.angle


def wild_drag(mesh, points, memory, seed, moves=2):
    """A few steps to random targets, as far from the pins as the drawing is large."""
    rng = np.random.default_rng(seed)
    size = mesh.length
    deformer, pose = akap_with_pins(mesh, points, memory=memory, max_step=0.05), mesh.vertices
    for _ in range(moves):
        goals = mesh.evaluate(points, mesh.vertices) + rng.normal(scale=size, size=(len(points), 2))
        result = deformer.step(pose, goals)
        pose = result.positions
        assert np.isfinite(pose).all()
        assert result.report.flipped == 0
        assert distortion(mesh, pose).flipped == 0


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_no_face_flips_however_wild_the_drag(mesh, memory):
    wild_drag(mesh, shapes.random_pins(mesh, 2), memory, 2)


@pytest.mark.parametrize("memory", [0.0, 1.0])
@pytest.mark.parametrize("name", DRAWINGS)
def test_no_face_of_a_bundled_drawing_flips(name, memory):
    mesh = triangulate(outlines(np.array(Image.open(DRAWINGS[name]).convert("RGBA"))[..., 3]), 500)
    wild_drag(mesh, shapes.random_pins(mesh, 1), memory, 1, moves=1)


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_pins_brought_to_one_place_stay_there(memory):
    """The bar becomes a ring, which could rotate freely about the point where its pins meet."""
    mesh = shapes.SHAPES["bar"]
    middles = [np.argmin(np.abs(mesh.vertices - end).sum(axis=1)) for end in ([0, 30], [300, 30])]
    deformer = akap_with_pins(mesh, shapes.vertex_pins(mesh, np.array(middles)), memory=memory)
    goals = np.array([[150.0, 100.0]] * 2)
    pose = deformer.step(mesh.vertices, goals).positions
    for _ in range(60):
        result = deformer.step(pose, goals)
        change, pose = np.abs(result.positions - pose).max(), result.positions
    assert change < 1e-3
    assert result.report.pin_error < 0.01
    apart = deformer.step(pose, goals + np.array([[-100.0, 0.0], [100.0, 0.0]]))
    assert apart.report.pin_error < 0.25


def test_pose_that_is_flipped_already_can_be_dragged():
    """Another method, or a file, may leave such a pose."""
    mesh = shapes.SHAPES["square"]
    inner = int(np.setdiff1d(np.arange(len(mesh.vertices)), mesh.boundary_vertices)[5])
    pose = mesh.vertices.copy()
    pose[inner] += [45.0, 0.0]
    assert distortion(mesh, pose).flipped
    points = shapes.random_pins(mesh, 1)
    goals = mesh.evaluate(points, pose) + np.array([30.0, 10.0])
    for memory in (0.0, 1.0):
        assert akap_with_pins(mesh, points, memory=memory).step(pose, goals).report.pin_error < 0.25


def test_single_vertex_of_an_interior_pin_gets_no_singularity():
    """Fig. 3: the first field alone dents the drawing at the pin, the second solve does not."""
    mesh = shapes.SHAPES["disc 2"]
    inner = np.setdiff1d(np.arange(len(mesh.vertices)), mesh.boundary_vertices)[[3, 60]]
    points = shapes.vertex_pins(mesh, inner)
    velocities = [[4.0, 0.0], [-4.0, 0.0]]
    fields = akap_with_pins(mesh, points).vector_fields(mesh.vertices, velocities)
    worst = [distortion(mesh, mesh.vertices + field).face_angle.max() for field in fields]
    assert worst[0] < worst[1]


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        ("memory", -0.1),
        ("memory", 1.1),
        ("memory", float("nan")),
        ("memory", "all"),
        ("memory", None),
        ("trajectory", "cubic"),
        ("trajectory", None),
        ("pin_weight", 0.0),
        ("pin_weight", -1.0),
        ("pin_weight", float("inf")),
        ("pin_weight", "strong"),
        ("max_step", 0.0),
        ("max_step", float("nan")),
        ("max_step", [1]),
    ],
)
def test_settings_out_of_range_are_refused(setting, value):
    with pytest.raises(InputError, match=f"^{setting}: expected .*, got "):
        AkapDeformer(shapes.SHAPES["triangle"], **{setting: value})


def test_collapsed_pose_is_a_solver_error(mesh):
    points = shapes.random_pins(mesh, 1)
    with pytest.raises(SolverError), np.errstate(all="ignore"):
        akap_with_pins(mesh, points).step(np.zeros_like(mesh.vertices), np.zeros((len(points), 2)) + 1.0)


def test_velocities_of_another_number_of_pins_are_refused(mesh):
    deformer = akap_with_pins(mesh, MeshPoints([0], [[1.0, 0.0, 0.0]]))
    with pytest.raises(InputError, match=r"velocities: expected shape \(1, 2\), got \(2, 2\)"):
        deformer.vector_field(mesh.vertices, [[0.0, 0.0], [1.0, 1.0]])


def test_denser_mesh_moves_nearly_alike():
    """Energies are weighted by area, so that λ means the same on a finer mesh."""
    coarse = shapes.SHAPES["bar"]
    fine = TriMesh(*shapes.subdivide(coarse.vertices, coarse.faces))
    where = np.array([[5.0, 30.0], [155.0, 20.0], [290.0, 35.0]])
    goals = where + np.array([[0.0, 0.0], [0.0, 15.0], [0.0, 0.0]])
    poses = []
    for mesh in (coarse, fine):
        pose = akap_with_pins(mesh, mesh.locate(where)).step(mesh.vertices, goals).positions
        poses.append(mesh.evaluate(mesh.locate(coarse.vertices), pose))
    assert np.abs(poses[0] - poses[1]).max() < 1.0


@pytest.mark.parametrize("parameters", [{}, {"memory": 1.0}, {"trajectory": "linear"}])
def test_a_long_step_of_all_pins_together_is_one_exact_rigid_motion(parameters):
    mesh = shapes.SHAPES["bar"]
    points = shapes.random_pins(mesh, 3)
    angle = 0.0 if "trajectory" in parameters else 2.5
    moved = to_points(np.exp(1j * angle) * to_complex(mesh.vertices) + (3e6 - 1e6j))
    deformer = akap_with_pins(mesh, points, **parameters)
    result = deformer.step(mesh.vertices, mesh.evaluate(points, moved))
    np.testing.assert_allclose(result.positions, moved, atol=1e-6)
    assert result.report.substeps <= 2
    assert not result.report.unfinished
    halfway = to_complex(result.at(0.5))
    edges = mesh.edges.T
    lengths = np.abs(halfway[edges[0]] - halfway[edges[1]])
    rest = np.abs(np.subtract(*to_complex(mesh.vertices)[edges]))
    np.testing.assert_allclose(lengths, rest, rtol=1e-6)


def test_a_step_that_cannot_reach_its_targets_says_so():
    mesh = shapes.SHAPES["bar"]
    points = shapes.random_pins(mesh, 3)
    targets = mesh.evaluate(points, mesh.vertices)
    targets[0] += 1e4 * mesh.length
    report = akap_with_pins(mesh, points).step(mesh.vertices, targets).report
    assert report.unfinished
    assert report.pin_error > 1e3 * mesh.length
    assert report.flipped == 0


# -- stiffness -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_stiff_parts_bend_less(memory):
    mesh = shapes.SHAPES["bar"]
    points = mesh.locate([[10.0, 30.0], [290.0, 30.0]])
    places = mesh.evaluate(points, mesh.vertices)
    stiff = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] < 150
    goals = places + np.array([[100.0, 0.0], [-100.0, 60.0]])
    worst = []
    for factor in (1.0, 1000.0):
        deformer = akap_with_pins(mesh, points, memory=memory, stiffness=np.where(stiff, factor, 1.0))
        pose = mesh.vertices
        for share in np.linspace(0, 1, 30)[1:]:
            pose = deformer.step(pose, places + share * (goals - places)).positions
        quality = distortion(mesh, pose)
        worst.append((quality.face_area + quality.face_angle - 4)[stiff].max())
        assert quality.flipped == 0
    assert worst[1] < 0.05 * worst[0]


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_equal_stiffness_everywhere_changes_little(mesh, memory):
    """Only against the pins, which are stiff themselves."""
    points = shapes.random_pins(mesh, 2)
    goals = mesh.evaluate(points, mesh.vertices) + np.random.default_rng(2).normal(
        scale=2, size=(len(points), 2)
    )
    one, two = (
        akap_with_pins(mesh, points, memory=memory, stiffness=np.full(len(mesh.faces), factor))
        .step(mesh.vertices, goals)
        .positions
        for factor in (1.0, 2.0)
    )
    none = akap_with_pins(mesh, points, memory=memory).step(mesh.vertices, goals).positions
    assert np.abs(one - none).max() < 1e-9
    assert np.abs(two - none).max() < 0.2


@pytest.mark.parametrize("stiffness", [[1.0, 1.0], [0.0], [-1.0], [np.nan], [1e9], "hard"])
def test_bad_stiffness_is_refused(stiffness):
    with pytest.raises(InputError, match=r"^stiffness: expected 1 numbers"):
        AkapDeformer(shapes.SHAPES["triangle"], stiffness=stiffness)
