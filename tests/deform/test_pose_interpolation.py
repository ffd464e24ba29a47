"""Interpolated poses: arcs instead of chords, nothing shrinks, and the ends are exact."""

import numpy as np
import pytest

from akap_editor.deform.pose_interpolation import InterpolationCache, PoseInterpolation
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io.images import read_image

TIMES = np.linspace(0, 1, 17)


def bar(length=40, width=4):
    """(mesh) A long bar from (0, 0) of unit squares, two faces each."""
    x, y = np.meshgrid(np.arange(length + 1.0), np.arange(width + 1.0))
    corner = (np.arange(length)[None, :] + (length + 1) * np.arange(width)[:, None]).ravel()
    a, b, c, d = corner, corner + 1, corner + length + 2, corner + length + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriMesh(np.stack([x.ravel(), y.ravel()], axis=1), faces)


def curled(mesh, turn, still=10.0):
    """A pose of the bar: at rest up to x = ``still``, then bent along a circle by ``turn`` radians."""
    x, y = mesh.vertices.T
    middle = y.max() / 2
    length = x.max() - still
    radius = length / turn
    angle = np.maximum(x - still, 0) / radius
    off = y - middle
    bent_x = np.where(x <= still, x, still + (radius - off) * np.sin(angle))
    bent_y = np.where(x <= still, y, middle + radius - (radius - off) * np.cos(angle))
    return np.stack([bent_x, bent_y], axis=1)


@pytest.fixture(scope="module")
def mesh():
    return bar()


def test_the_ends_are_exact_and_neighbors_are_near(mesh):
    start, end = mesh.vertices, curled(mesh, 2.5)
    pose = PoseInterpolation(mesh).between(start, end)
    np.testing.assert_array_equal(pose(0.0), start)
    np.testing.assert_array_equal(pose(1.0), end)
    np.testing.assert_allclose(pose(1e-9), start, atol=1e-6)
    np.testing.assert_allclose(pose(1 - 1e-9), end, atol=1e-6)


def test_the_way_back_is_the_way(mesh):
    start, end = curled(mesh, -1.0), curled(mesh, 2.5)
    there, back = PoseInterpolation(mesh).between(start, end), PoseInterpolation(mesh).between(end, start)
    for t in (0.2, 0.5, 0.9):
        np.testing.assert_allclose(there(t), back(1 - t), atol=1e-9)


@pytest.mark.parametrize("angle", [0.7, 3.0, -2.9])
def test_a_similarity_goes_along_its_log_spiral(mesh, angle):
    factor, center = 1.5 * np.exp(1j * angle), 7 - 3j
    start = mesh.vertices.view(np.complex128)[:, 0]
    end = center + factor * (start - center)
    pose = PoseInterpolation(mesh).between(mesh.vertices, end.view(np.float64).reshape(-1, 2))
    for t in TIMES:
        expected = center + np.exp(t * np.log(factor)) * (start - center)
        np.testing.assert_allclose(pose(t).view(np.complex128)[:, 0], expected, atol=1e-8)


def test_a_translation_goes_straight(mesh):
    pose = PoseInterpolation(mesh).between(mesh.vertices, mesh.vertices + np.array([30.0, -7.0]))
    np.testing.assert_allclose(pose(0.3), mesh.vertices + np.array([9.0, -2.1]), atol=1e-8)


@pytest.mark.parametrize("turn", [np.pi, 1.5 * np.pi, 1.95 * np.pi])
def test_an_arm_sweeps_an_arc_also_beyond_half_a_turn(mesh, turn):
    """Halfway it is bent by half, the part at rest does not move, and areas do not change."""
    end = curled(mesh, turn)
    pose = PoseInterpolation(mesh).between(mesh.vertices, end)
    np.testing.assert_allclose(pose(0.5), curled(mesh, turn / 2), atol=0.25)
    still = mesh.vertices[:, 0] < 9
    assert max(np.abs(pose(t) - mesh.vertices)[still].max() for t in TIMES) < 0.02
    most = distortion(mesh, end).area
    assert max(distortion(mesh, pose(t)).area for t in TIMES) <= 1.001 * most
    assert max(distortion(mesh, pose(t)).flipped for t in TIMES) == 0


def test_a_straight_mix_of_the_two_poses_would_shrink(mesh):
    """The reason for spirals."""
    end = curled(mesh, np.pi)
    mixed = distortion(mesh, 0.5 * (mesh.vertices + end)).area
    spiral = distortion(mesh, PoseInterpolation(mesh).between(mesh.vertices, end)(0.5)).area
    assert mixed > 2.2
    assert spiral < 2.01


def test_pairs_are_prepared_once_and_interpolated_as_without_the_cache(mesh, monkeypatch):
    start, end, other = mesh.vertices, curled(mesh, 1.0), curled(mesh, -1.0)
    cache, prepared = InterpolationCache(max_pairs=2), []
    original = PoseInterpolation.between
    monkeypatch.setattr(
        PoseInterpolation,
        "between",
        lambda self, a, b: prepared.append((id(a), id(b))) or original(self, a, b),
    )
    for t in (0.2, 0.5):
        np.testing.assert_array_equal(
            cache.pose(mesh, start, end, t), original(PoseInterpolation(mesh), start, end)(t)
        )
    assert cache.pose(mesh, start, end, 0) is start
    assert cache.pose(mesh, start, end, 1) is end
    assert len(prepared) == 1
    for pair in ((end, other), (start, other), (start, end)):
        cache.pose(mesh, *pair, 0.5)
    assert len(prepared) == 4, "only the last two pairs are kept"


def test_parts_move_each_on_their_own():
    one = bar(6, 2)
    shift = [0.0, 10.0]
    n = len(one.vertices)
    both = TriMesh(
        np.concatenate([one.vertices, one.vertices + shift]), np.concatenate([one.faces, one.faces + n])
    )
    end = both.vertices.copy()
    end[n:] += [5.0, 1.0]
    middle = PoseInterpolation(both).between(both.vertices, end)(0.5)
    np.testing.assert_allclose(middle[:n], both.vertices[:n], atol=1e-9)
    np.testing.assert_allclose(middle[n:], both.vertices[n:] + np.array([2.5, 0.5]), atol=1e-9)


def test_a_collapsed_pose_gives_finite_in_betweens(mesh):
    flat = mesh.vertices * [1.0, 0.0]
    assert np.isfinite(PoseInterpolation(mesh).between(mesh.vertices, flat)(0.5)).all()
    assert np.isfinite(PoseInterpolation(mesh).between(mesh.vertices * 0.0, mesh.vertices)(0.5)).all()


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (lambda between, v: between(v[1:], v), "start: expected"),
        (lambda between, v: between(v, v * np.nan), "end: expected"),
        (lambda between, v: between(v, v)(2.5), "t: expected"),
        (lambda between, v: between(v, v)(float("nan")), "t: expected"),
    ],
)
def test_bad_arguments_are_named(mesh, bad, message):
    with pytest.raises(InputError, match=message):
        bad(PoseInterpolation(mesh).between, mesh.vertices)


@pytest.mark.parametrize("name", ["cat", "elephant", "t-rex", "gecko", "dancer"])
def test_real_cartoons_are_distorted_no_more_than_at_the_worse_end(shared_data, name):
    """Between two random poses, areas are distorted at most 1 % more than in the worse of the two."""
    drawing = make_drawing(read_image(shared_data / "noto" / f"{name}.png"), vertices=600, name=name)
    mesh = drawing.mesh
    session = Session(new_document(drawing))
    body = np.flatnonzero(mesh.component == np.bincount(mesh.component).argmax())
    middle = mesh.vertices[body].mean(axis=0)
    chosen = [int(body[np.abs(mesh.vertices[body] - middle).sum(axis=1).argmin()])]
    for _ in range(4):  # each as far as can be from those before
        away = np.linalg.norm(mesh.vertices[body][:, None] - mesh.vertices[chosen], axis=2).min(axis=1)
        chosen.append(int(body[away.argmax()]))
    session.begin("Pose")
    pins = [add_pin(session, tuple(0.99 * mesh.vertices[v] + 0.01 * middle)) for v in chosen]
    dice = np.random.default_rng(3)
    poses = [mesh.vertices]
    for _ in range(2):
        moves = 0.25 * mesh.length * dice.normal(size=(len(pins), 2))
        targets = {
            p: tuple(session.state.pin(p).target + move) for p, move in zip(pins, moves, strict=True) if p
        }
        session.apply(SetTargets(targets))
        for _ in range(60):
            session.step()
        poses.append(session.state.positions)
    inbetween = PoseInterpolation(mesh)
    for start, end in ((poses[0], poses[1]), (poses[1], poses[2])):
        pose = inbetween.between(start, end)
        measured = [distortion(mesh, pose(t)) for t in TIMES]
        ends = max(measured[0].area, measured[-1].area)
        assert ends > 2.001, "the pin was pulled"
        assert max(each.area for each in measured) <= 1.01 * ends
        worst = [each.face_area.max() for each in measured]
        assert max(worst) <= 1.01 * max(worst[0], worst[-1]), "also that of the worst single face"
        assert max(each.flipped for each in measured) == 0


def test_beyond_its_ends_the_motion_goes_on_and_no_face_flips(mesh):
    between = PoseInterpolation(mesh).between(mesh.vertices, 1.4 * mesh.vertices)
    for t in (-0.5, 1.5):
        np.testing.assert_allclose(
            np.ptp(between(t), axis=0), 1.4**t * np.ptp(mesh.vertices, axis=0), rtol=1e-6
        )
    with pytest.raises(InputError, match="t: expected"):
        between(2.1)
