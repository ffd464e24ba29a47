"""Laws of loose parts: they settle exactly, swing as set, never flip a face, and lose energy."""

from functools import cache

import numpy as np
import pytest

from akap_editor.deform.follow_through import STEP_SECONDS, FollowThrough, SwingState
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.geometry.mesh import TriMesh, signed_areas
from akap_editor.io.images import read_image
from akap_editor.resources import bundled_drawings
from tests.support.shapes import blocks

NO_ANCHORS = np.zeros(0, dtype=np.int64)
BAR = blocks("#" * 12, 10.0, 3, 0.1)


@cache
def cartoon(name: str) -> TriMesh:
    path = next(path for path in bundled_drawings() if path.stem == name)
    return make_drawing(read_image(path), vertices=400).mesh


def loose_faces(name: str) -> tuple[TriMesh, np.ndarray]:
    """Antennae of the alien, tail and trunk of the elephant, most of a bar."""
    mesh = BAR if name == "bar" else cartoon(name)
    x, y = mesh.vertices[mesh.faces].mean(axis=1).T
    return mesh, {"alien": y < 150, "elephant": (x > 760) | (x < 120), "bar": x > 20}[name]


def moved(mesh: TriMesh, shift: complex, angle: float = 0.0) -> np.ndarray:
    """The rest pose, rotated about its middle and shifted."""
    z = mesh.vertices @ [1, 1j]
    z = z.mean() + (z - z.mean()) * np.exp(1j * angle) + shift
    return np.stack([z.real, z.imag], axis=1)


def settled(follow: FollowThrough, state: SwingState, pose: np.ndarray) -> tuple[SwingState, int]:
    for count in range(1000):
        if state.is_settled:
            return state, count
        state = follow.step(state, pose)
    raise AssertionError("it does not settle")


@pytest.mark.parametrize(("name", "axis"), [("bar", 1), ("alien", 0), ("elephant", 1)])
def test_a_shaken_part_lags_swings_and_settles_exactly_on_the_pose(name: str, axis: int) -> None:
    mesh, loose = loose_faces(name)
    follow = FollowThrough(mesh, loose, NO_ANCHORS, speed=3.0, bounce=0.5)
    state, pose = follow.start(mesh.vertices), mesh.vertices
    assert follow.shown(state, pose) is pose
    side = 0.01 * mesh.length
    lag = 0.0
    for _ in range(12):
        pose = pose + side * np.eye(2)[axis]
        state = follow.step(state, pose)
        shown = follow.shown(state, pose)
        lag = max(lag, (pose - shown)[:, axis].max())
    held = np.setdiff1d(np.arange(len(pose)), mesh.faces[loose])
    np.testing.assert_array_equal(shown[held], pose[held])
    assert lag > side, "the loose part lags"
    overshoot = 0.0
    for _ in range(30):
        state = follow.step(state, pose)
        overshoot = max(overshoot, (follow.shown(state, pose) - pose)[:, axis].max())
    assert overshoot > 0.2 * side
    state, count = settled(follow, state, pose)
    assert 10 < count < 300
    assert follow.shown(state, pose) is pose


@pytest.mark.parametrize("name", ["alien", "elephant"])
def test_no_face_flips_in_a_violent_shake_and_the_same_comes_out_twice(name: str) -> None:
    mesh, loose = loose_faces(name)
    shown = []
    for _ in range(2):
        follow = FollowThrough(mesh, loose, NO_ANCHORS, speed=2.0, bounce=0.7)
        rng, state = np.random.default_rng(3), follow.start(mesh.vertices)
        for _ in range(60):
            shift = complex(*rng.normal(0, 0.12 * mesh.length, 2))
            pose = moved(mesh, shift, rng.normal(0, 0.2))
            state = follow.step(state, pose)
            shown.append(follow.shown(state, pose))
            assert signed_areas(shown[-1], mesh.faces).min() > 0
    np.testing.assert_array_equal(shown[:60], shown[60:])
    assert max(np.abs(each).max() for each in shown) < 5 * mesh.length


@pytest.mark.parametrize("bounce", [0.2, 0.5, 0.8])
def test_energy_decays_while_the_pose_rests(bounce: float) -> None:
    mesh, loose = loose_faces("alien")
    follow = FollowThrough(mesh, loose, NO_ANCHORS, speed=3.0, bounce=bounce)
    state = follow.step(follow.start(mesh.vertices), moved(mesh, 60.0))
    energies = []
    for _ in range(60):
        state = follow.step(state, moved(mesh, 60.0))
        energies.append(follow.energy(state))
    assert energies[0] > 0
    assert (np.diff(energies) <= 1e-9 * energies[0]).all()


@pytest.mark.parametrize(("speed", "bounce"), [(1.5, 0.3), (3.0, 0.5), (3.0, 0.2), (4.0, 0.5), (3.0, 0.7)])
def test_small_swings_have_the_speed_and_bounce_that_were_set(speed: float, bounce: float) -> None:
    mesh, loose = loose_faces("bar")
    follow = FollowThrough(mesh, loose, NO_ANCHORS, speed, bounce)
    state, tip = follow.start(mesh.vertices), int(np.argmax(mesh.vertices[:, 0]))
    path = []
    for k in range(90):
        pose = moved(mesh, 0.5j * min(k, 4))
        state = follow.step(state, pose)
        path.append((follow.shown(state, pose) - pose)[tip, 1])
    offsets = np.array(path[4:])
    turns = [k for k in range(1, 85) if abs(offsets[k]) >= max(abs(offsets[k - 1]), abs(offsets[k + 1]))]
    turns = [k for k in turns if abs(offsets[k]) > 0.05]
    assert len(turns) >= 2
    assert (turns[1] - turns[0]) * STEP_SECONDS * 2 * speed == pytest.approx(1.0, abs=0.2)
    assert abs(offsets[turns[1]] / offsets[turns[0]]) == pytest.approx(bounce, abs=0.12)


def test_a_part_that_nothing_holds_goes_with_the_pose() -> None:
    everything = np.ones(len(BAR.faces), dtype=bool)
    follow = FollowThrough(BAR, everything, NO_ANCHORS, 3.0, 0.5)
    assert follow.is_empty
    pose = moved(BAR, 5.0)
    state = follow.step(follow.start(BAR.vertices), pose)
    assert follow.shown(state, pose) is pose
    assert not FollowThrough(BAR, everything, np.array([0]), 3.0, 0.5).is_empty, "a pin holds it"
    assert FollowThrough(BAR, ~everything, NO_ANCHORS, 3.0, 0.5).is_empty


def test_a_pose_that_jumps_does_not_swing() -> None:
    mesh, loose = loose_faces("bar")
    follow = FollowThrough(mesh, loose, NO_ANCHORS, 3.0, 0.5)
    state = follow.step(follow.start(mesh.vertices), moved(mesh, 10 * mesh.length))
    assert state.is_settled
