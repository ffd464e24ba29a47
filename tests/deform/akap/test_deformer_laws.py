"""Laws of `AkapDeformer` on any mesh: hard pins, fields beside steps, the path of a step, no flips."""

import numpy as np
import pytest

from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.akap.killing_field import KillingSystem
from akap_editor.deform.deformer import StepReport, StepResult
from akap_editor.errors import InputError, SolverError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import NO_POINTS, MeshPoints, signed_areas
from akap_editor.geometry.operators import to_complex, to_points
from tests.support import dense, shapes
from tests.support.deformers import akap_with_pins, bent_pose
from tests.support.dense import killing_energy

WHOLE = float("inf")  # max_step: one field for the whole step


def scene(mesh, seed=1, each=3):
    """A pose, pins and velocities."""
    points = shapes.random_pins(mesh, seed, each)
    return bent_pose(mesh), points, np.random.default_rng(seed).normal(scale=5.0, size=(len(points), 2))


# -- hard constraints ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("dirichlet", [True, False])
@pytest.mark.parametrize("seed", [1, 2])
def test_hard_pins_have_exactly_their_velocities(mesh, seed, dirichlet):
    pose, points, velocities = scene(mesh, seed)
    deformer = akap_with_pins(mesh, points, constraints="hard", dirichlet=dirichlet)
    _, smooth = deformer.vector_fields(pose, velocities)
    assert np.abs(mesh.evaluate(points, smooth) - velocities).max() < 1e-9 * np.abs(smooth).max()


def hard_field(mesh, pose, points, velocities):
    """Least ‖P u‖ among the u with W u = ũ, by an orthonormal basis of the null space of W."""
    rows, pins = dense.killing_rows(pose, mesh.faces), dense.pin_rows(mesh, points)
    particular = np.linalg.lstsq(pins, velocities.ravel(), rcond=1e-12)[0]
    _, sizes, turned = np.linalg.svd(pins)
    free = turned[(sizes > 1e-12).sum() :].T
    if free.shape[1]:
        particular += free @ np.linalg.lstsq(rows @ free, -rows @ particular, rcond=1e-13)[0]
    return particular.reshape(-1, 2), free


@pytest.mark.parametrize("dirichlet", [True, False])
def test_hard_fields_are_those_of_the_dense_implementation(mesh, dirichlet):
    pose, points, velocities = scene(mesh)
    deformer = akap_with_pins(mesh, points, constraints="hard", dirichlet=dirichlet)
    optimal, smooth = deformer.vector_fields(pose, velocities)
    expected, _ = hard_field(mesh, pose, points, velocities)
    size = np.abs(expected).max()
    assert np.abs(smooth - expected).max() < 1e-8 * size
    second = dense.dirichlet_field(mesh, pose, expected) if dirichlet else expected
    assert np.abs(optimal - second).max() < 1e-8 * size


def test_hard_field_has_the_least_energy(mesh):
    pose, points, velocities = scene(mesh)
    _, smooth = akap_with_pins(mesh, points, constraints="hard").vector_fields(pose, velocities)
    least = killing_energy(pose, mesh.faces, smooth)
    _, free = hard_field(mesh, pose, points, velocities)
    rng = np.random.default_rng(3)
    for size in (1e-3, 0.1, 10.0):
        change = size * (free @ rng.normal(size=free.shape[1])).reshape(-1, 2)
        assert np.abs(mesh.evaluate(points, change)).max() < 1e-10
        assert killing_energy(pose, mesh.faces, smooth + change) >= least * (1 - 1e-12)


def test_soft_pins_approach_hard_ones(mesh):
    pose, points, velocities = scene(mesh)
    _, limit = akap_with_pins(mesh, points, constraints="hard").vector_fields(pose, velocities)
    differences = []
    for weight in (10.0, 100.0, 1e3, 1e4):
        _, smooth = akap_with_pins(mesh, points, pin_weight=weight).vector_fields(pose, velocities)
        differences.append(np.abs(smooth - limit).max() / np.abs(limit).max())
    assert differences == sorted(differences, reverse=True)
    assert differences[-1] < 1e-4


def test_hard_pins_may_say_the_same_twice_or_contradict_one_another(mesh):
    pose, points, velocities = scene(mesh, each=2)
    twice = MeshPoints(np.tile(points.faces, 2), np.tile(points.weights, (2, 1)))
    _, once = akap_with_pins(mesh, points, constraints="hard").vector_fields(pose, velocities)
    deformer = akap_with_pins(mesh, twice, constraints="hard")
    for spread in (np.zeros_like(velocities), velocities[:, ::-1]):  # the mean is what counts
        wanted = np.concatenate([velocities + spread, velocities - spread])
        _, smooth = deformer.vector_fields(pose, wanted)
        assert np.abs(smooth - once).max() < 1e-7 * np.abs(once).max()


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_steps_with_hard_pins_arrive(mesh, memory):
    points = shapes.random_pins(mesh, 5)
    goals = mesh.evaluate(points, bent_pose(mesh)) + np.array([12.0, -20.0])
    deformer, pose = akap_with_pins(mesh, points, constraints="hard", memory=memory), mesh.vertices
    for _ in range(20):
        result = deformer.step(pose, goals)
        pose = result.positions
    assert result.report.pin_error < 0.25
    assert result.report.flipped == 0


def test_fields_of_steps_with_hard_pins_have_exactly_their_velocities(mesh):
    """Whatever steps came before: every pose is factorized."""
    points = shapes.random_pins(mesh, 5)
    deformer = akap_with_pins(mesh, points, constraints="hard", dirichlet=False, max_step=WHOLE)
    pose = mesh.vertices
    for way in ([0.2, 0.1], [-0.1, 0.3]):
        here = mesh.evaluate(points, pose)
        velocities = np.random.default_rng(6).normal(scale=0.1, size=here.shape) + way
        result = deformer.step(pose, here + velocities)
        assert np.abs(mesh.evaluate(points, result.field) - velocities).max() < 1e-9
        pose = result.positions


# -- the field beside the step -------------------------------------------------------------------------------


def drag(mesh, points, memory, between):
    """Poses of ten steps, with ``between`` called before each."""
    deformer, pose, poses = akap_with_pins(mesh, points, memory=memory), mesh.vertices, []
    start = mesh.evaluate(points, pose)
    for index in range(1, 11):
        between(deformer, pose, start)
        goals = start.copy()
        goals[-1] += index * np.array([1.0, -2.0])
        pose = deformer.step(pose, goals).positions
        poses.append(pose)
    return np.array(poses)


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_asking_for_fields_changes_no_step(mesh, memory):
    points = shapes.random_pins(mesh, 4)

    def ask(deformer, pose, start):
        deformer.vector_field(pose, start[::-1])
        deformer.vector_fields(pose, 3 * start)

    silent = drag(mesh, points, memory, lambda *_: None)
    assert drag(mesh, points, memory, ask).tolist() == silent.tolist()


def test_fields_are_exact_whatever_steps_came_before(mesh):
    points = shapes.random_pins(mesh, 4)

    def compare(deformer, pose, start):
        velocities = np.random.default_rng(1).normal(size=start.shape)
        system = KillingSystem(mesh, 100.0)
        system.set_pins(points)
        system.prepare(pose)
        expected = [to_points(field) for field in system.field(to_complex(velocities))]
        found = deformer.vector_fields(pose, velocities)
        for one, other in zip(found, expected, strict=True):
            assert np.abs(one - other).max() < 1e-9 * np.abs(other).max()
        assert deformer.vector_field(pose, velocities).tolist() == found[0].tolist()

    drag(mesh, points, 0.0, compare)


# -- the path of a step --------------------------------------------------------------------------------------


@pytest.fixture(params=[0.0, 1.0])
def long_step(request, mesh):
    """A step of several substeps: where it began, and its result."""
    points = shapes.random_pins(mesh, 2)
    goals = mesh.evaluate(points, mesh.vertices)
    goals[-1] += 0.12 * mesh.length * np.array([0.8, -0.6])
    result = akap_with_pins(mesh, points, memory=request.param, max_step=0.05).step(mesh.vertices, goals)
    assert result.report.substeps == 3
    return mesh.vertices, result


def test_path_begins_and_ends_exactly(long_step):
    start, result = long_step
    assert result.at(0).tolist() == start.tolist()
    assert result.at(1).tolist() == result.positions.tolist()
    end = result.at(1)
    result.positions[:] += 5.0  # the caller's own
    assert result.at(1).tolist() == end.tolist()


def test_path_is_continuous(long_step):
    start, result = long_step
    size = np.abs(result.positions - start).max()
    for border in (1 / 3, 2 / 3, 0.5):
        assert np.abs(result.at(border + 1e-9) - result.at(border - 1e-9)).max() < 1e-6 * size


def test_no_face_flips_on_the_path(mesh, long_step):
    _, result = long_step
    for t in np.linspace(0, 1, 21):
        assert (signed_areas(result.at(t), mesh.faces) > 0).all()


@pytest.mark.parametrize("t", [0.0, 0.3, 0.5, 1.0])
def test_path_of_a_rotation_is_the_rotation(mesh, t):
    angle = 0.005  # so small that the ends of the velocities are as good as on the circle
    points = shapes.random_pins(mesh, 3)
    here, center = to_complex(mesh.evaluate(points, mesh.vertices)), to_complex(mesh.vertices).mean()
    goals = to_points(here + 1j * angle * (here - center))
    result = akap_with_pins(mesh, points, max_step=WHOLE).step(mesh.vertices, goals)
    expected = center + np.exp(1j * angle * t) * (to_complex(mesh.vertices) - center)
    assert np.abs(result.at(t) - to_points(expected)).max() < 1e-9


def test_without_pins_nothing_moves_at_any_time(mesh):
    result = akap_with_pins(mesh, NO_POINTS).step(mesh.vertices, np.zeros((0, 2)))
    assert result.at(0.5).tolist() == mesh.vertices.tolist()


@pytest.mark.parametrize("t", [-1e-9, 1 + 1e-9, float("nan"), "half", None])
def test_time_beyond_the_step_is_refused(t):
    mesh = shapes.SHAPES["square"]
    points = shapes.random_pins(mesh, 1)
    result = akap_with_pins(mesh, points).step(mesh.vertices, mesh.evaluate(points, mesh.vertices))
    with pytest.raises(InputError, match=r"^t: expected a number from 0 to 1, got "):
        result.at(t)


def test_result_of_a_method_without_trajectories_says_so():
    result = StepResult(np.zeros((3, 2)), None, StepReport(0.0, 1, 0.0, 0, 0.0))
    with pytest.raises(InputError, match="expected the result of a method that moves along trajectories"):
        result.at(0.5)


# -- no flips ------------------------------------------------------------------------------------------------


def check(mesh, result):
    assert np.isfinite(result.positions).all()
    assert result.report.flipped == 0
    assert distortion(mesh, result.positions).flipped == 0


@pytest.mark.parametrize(("memory", "share"), [(0.0, 0.8), (1.0, 0.2)])
@pytest.mark.parametrize(
    ("name", "count"),
    [("triangle", 4000), ("strip", 3000), ("square", 1500), ("star", 750), ("islands", 750)],
)
def test_no_face_flips_in_many_random_gestures(name, count, memory, share):
    """Each from where the last one ended: 10,000 gestures in all cases, pins chosen anew after every ten."""
    mesh = shapes.SHAPES[name]
    rng = np.random.default_rng(len(name))
    size = mesh.length
    deformer, pose = AkapDeformer(mesh, memory=memory, max_step=0.5), mesh.vertices
    for gesture in range(int(share * count)):
        if gesture % 50 == 0:
            pose = mesh.vertices
        if gesture % 10 == 0:
            points = shapes.random_pins(mesh, gesture, 1 + gesture // 10 % 4)
            deformer.set_pins(points)
        goals = mesh.evaluate(points, pose)
        goals[-1] += rng.normal(scale=0.3 * size, size=2)
        result = deformer.step(pose, goals)
        check(mesh, result)
        pose = result.positions


def ends(mesh):
    """Pins in the middle of both ends of the bar."""
    low, high = mesh.vertices[:, 0].min(), mesh.vertices[:, 0].max()
    return shapes.vertex_pins(
        mesh, [np.argmin(np.abs(mesh.vertices - end).sum(axis=1)) for end in ([low, 30], [high, 30])]
    )


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_bar_tied_into_a_loop(memory):
    """One end is led around, through the bar and on."""
    mesh = shapes.SHAPES["bar"]
    points = ends(mesh)
    start = mesh.evaluate(points, mesh.vertices)
    deformer, pose = akap_with_pins(mesh, points, memory=memory), mesh.vertices
    for turn in np.linspace(0, 3 * np.pi, 91)[1:]:
        radius = 150 * (1 - turn / (4 * np.pi))
        middle = start.mean(axis=0)
        result = deformer.step(pose, [start[0], middle + radius * np.array([np.cos(turn), np.sin(turn)])])
        check(mesh, result)
        pose = result.positions


def pulled_away_and_back(mesh, memory, way, steps):
    """The results of a pin's jump by ``way`` and of the steps back, at most so many."""
    points = shapes.random_pins(mesh, 3)
    home = mesh.evaluate(points, mesh.vertices)
    away = home.copy()
    away[-1] += way
    deformer = akap_with_pins(mesh, points, memory=memory, max_step=0.5)
    results = [deformer.step(mesh.vertices, away)]
    while len(results) == 1 or (results[-1].report.pin_error > 0.25 and len(results) <= steps):
        results.append(deformer.step(results[-1].positions, home))
    return results


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_absurd_jump_flips_nothing_and_says_where_it_is_cut(mesh, memory):
    results = pulled_away_and_back(mesh, memory, [5000.0, -300.0], 5)
    for result in results:
        check(mesh, result)
    assert results[0].report.blocked or results[0].report.pin_error < 1


@pytest.mark.parametrize(("memory", "far"), [(0.0, 1.0), (1.0, 1.0), (0.0, 3.0), (1.0, 3.0)])
def test_going_back_frees_a_blocked_drag(mesh, memory, far):
    way = far * mesh.length * np.array([1.0, -0.06])
    results = pulled_away_and_back(mesh, memory, way, 80)
    for result in results:
        check(mesh, result)
    assert results[-1].report.pin_error < 0.25


def test_some_of_these_drags_are_blocked():
    """Without memory, which opens faces again before they are in the way."""
    results = pulled_away_and_back(shapes.SHAPES["ring"], 0.0, [140.0, -8.0], 80)
    assert results[0].report.blocked
    assert results[0].report.pin_error > 1


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_contradicting_pins_flip_nothing(mesh, memory):
    """Pins of one face, two of which are to change places."""
    face = len(mesh.faces) // 2
    points = MeshPoints([face] * 3, 0.8 * np.eye(3) + 0.2 / 3)
    goals = mesh.evaluate(points, mesh.vertices)[[1, 0, 2]]
    deformer, pose = akap_with_pins(mesh, points, memory=memory), mesh.vertices
    for _ in range(3):
        result = deformer.step(pose, goals)
        check(mesh, result)
        pose = result.positions
    assert result.report.pin_error > 1


# -- recovery ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("memory", [0.0, 1.0])
@pytest.mark.parametrize("constraints", ["soft", "hard"])
def test_deformer_works_after_a_solver_error(mesh, constraints, memory):
    pose, points, _ = scene(mesh)
    goals = mesh.evaluate(points, pose) + 1.0
    settings = {"memory": memory, "constraints": constraints}
    expected = akap_with_pins(mesh, points, **settings).step(pose, goals).positions
    deformer = akap_with_pins(mesh, points, **settings)
    collapsed = np.zeros_like(pose)
    for before in (
        mesh.vertices,
        collapsed,
        pose,
    ):  # an error where the factors are old, and where they are new
        with np.errstate(all="ignore"):
            if before is collapsed:
                with pytest.raises(SolverError):
                    deformer.step(collapsed, goals)
            else:
                deformer.step(before, goals)
            with pytest.raises(SolverError):
                deformer.step(collapsed, goals)
            with pytest.raises(SolverError):
                deformer.vector_field(collapsed, goals)
        found = deformer.step(pose, goals).positions
        assert np.abs(found - expected).max() < 1e-5 * mesh.length


def test_memory_of_nothing_is_the_method_without_memory(mesh):
    """Bit for bit, and in the limit."""
    pose, points, _ = scene(mesh)
    goals = mesh.evaluate(points, pose) + 0.5
    plain = akap_with_pins(mesh, points).step(pose, goals).positions
    assert akap_with_pins(mesh, points, memory=0).step(pose, goals).positions.tolist() == plain.tolist()
    nearly = akap_with_pins(mesh, points, memory=1e-9).step(pose, goals).positions
    assert np.abs(nearly - plain).max() < 1e-3
