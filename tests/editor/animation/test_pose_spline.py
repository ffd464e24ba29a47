"""Motion through several poses: its speed is continuous, and nothing overshoots or crumples."""

from itertools import pairwise

import numpy as np
import pytest

from akap_editor.editor.animation.keyframe_poses import KeyframePoses
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import TriMesh

STEP = 0.01  # seconds between the frames of these tests


@pytest.fixture(scope="module")
def mesh():
    """A bar from (0, 0) to (40, 4) of unit squares, two faces each."""
    x, y = np.meshgrid(np.arange(41.0), np.arange(5.0))
    corner = (np.arange(40)[None, :] + 41 * np.arange(4)[:, None]).ravel()
    a, b, c, d = corner, corner + 1, corner + 42, corner + 41
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriMesh(np.stack([x.ravel(), y.ravel()], axis=1), faces)


def curled(mesh, turn, still=10.0):
    """A pose of the bar: at rest up to x = ``still``, then bent along a circle by ``turn`` radians."""
    x, y = mesh.vertices.T
    if not turn:
        return mesh.vertices.copy()
    radius = (x.max() - still) / turn
    angle, off = np.maximum(x - still, 0) / radius, y - 2
    bent_x = np.where(x <= still, x, still + (radius - off) * np.sin(angle))
    bent_y = np.where(x <= still, y, 2 + radius - (radius - off) * np.cos(angle))
    return np.stack([bent_x, bent_y], axis=1)


def rotated(mesh, angle, center=-30 + 5j, factor=1.0):
    z = mesh.vertices.view(np.complex128)[:, 0]
    z = center + factor * np.exp(1j * angle) * (z - center)
    return np.stack([z.real, z.imag], axis=1)


def moved(mesh, x, y):
    return mesh.vertices + np.array([x, y])


def played(mesh, keys, loop=False, ease="smooth"):
    """Times of frames, and the poses (f, n, 2) of an animation of (time, pose) there."""
    animation = Animation(tuple(Keyframe(*key) for key in keys), ease, loop)
    times = np.arange(0, animation.duration + STEP / 2, STEP)
    poses = KeyframePoses()
    return times, np.array([poses.moment(mesh, animation, time).pose for time in times])


MOTIONS = {
    "arm": lambda mesh: [(0, curled(mesh, 0)), (0.5, curled(mesh, 0.6)), (0.8, curled(mesh, 1.5))],
    "swing": lambda mesh: [
        *((0.4 * k, curled(mesh, turn)) for k, turn in enumerate((0, 0.9, 1.4, 0.3, -0.8, -0.2)))
    ],
    "growing turn": lambda mesh: [
        (0, mesh.vertices),
        (0.3, rotated(mesh, 1, factor=1.2)),
        (1, rotated(mesh, 2)),
    ],
    "way": lambda mesh: [(0, moved(mesh, 0, 0)), (0.5, moved(mesh, 30, 5)), (0.8, moved(mesh, 80, 0))],
    "way and arm": lambda mesh: [
        *((0.5 * k, curled(mesh, 0.6 * k) + np.array([9.0 * k, -3.0 * k * k])) for k in range(4))
    ],
    "jump": lambda mesh: [(0, mesh.vertices), (0.5, moved(mesh, 0, -40)), (1.1, curled(mesh, 0.5))],
}


def second_differences(poses):
    """Second differences (f - 2, n) of the vertices: those at frame k + 1 are in row k."""
    return np.linalg.norm(np.diff(poses, 2, axis=0), axis=2)


@pytest.mark.parametrize("name", MOTIONS)
def test_no_vertex_jerks_at_a_key(mesh, name):
    """Where the speed jumps, the second difference at the key is far above those of both neighbors."""
    keys = MOTIONS[name](mesh)
    smooth, linear = (second_differences(played(mesh, keys, ease=ease)[1]) for ease in ("smooth", "none"))
    spikes = []
    for time, _ in keys[1:-1]:
        index = round(time / STEP) - 1
        beside = np.maximum(smooth[index - 1], smooth[index + 1])
        assert (smooth[index] <= 1.05 * beside + 1e-3 * smooth.max()).all()
        spikes.append(linear[index].max() > 3 * linear[[index - 1, index + 1]].max())
    assert any(spikes), "intervals that ease on their own do jerk"


@pytest.mark.parametrize("name", ["way", "arm", "turn"])
def test_at_keys_of_a_steady_pace_second_differences_are_within_twice_the_median(mesh, name):
    change = {
        "way": lambda k: moved(mesh, 12.0 * k, -0.3 * k * k),
        "arm": lambda k: curled(mesh, 0.4 * k + 0.03 * k * k),
        "turn": lambda k: rotated(mesh, 0.5 * k + 0.02 * k * k, factor=1 + 0.05 * k),
    }[name]
    keys = [(0.4 * k, change(k)) for k in range(7)]
    second = second_differences(played(mesh, keys)[1])
    moves = second.max(axis=0) > 0.05 * second.max()
    median = np.median(second[:, moves], axis=0)
    for time, _ in keys[2:-2]:  # to and from its first and last key, the motion gathers speed and loses it
        assert (second[round(time / STEP) - 1, moves] <= 2 * median).all()


BACK_AND_FORTH = {
    "wave": lambda mesh: [(0.4 * k, curled(mesh, 0.8 * (k % 2))) for k in range(7)],
    "bounce": lambda mesh: [(0.4 * k, moved(mesh, 0, -40.0 * (k % 2))) for k in range(5)],
    "swing": MOTIONS["swing"],
    "growth": lambda mesh: [(0.4 * k, rotated(mesh, 0, factor=1 + 0.3 * (k % 2))) for k in range(5)],
    "more than half a turn": lambda mesh: [(0.5 * k, curled(mesh, 4.0 * (k % 2))) for k in range(4)],
}


@pytest.mark.parametrize("name", BACK_AND_FORTH)
def test_where_a_motion_turns_back_second_differences_are_within_twice_the_median(mesh, name):
    keys = BACK_AND_FORTH[name](mesh)
    second = second_differences(played(mesh, keys)[1])
    moves = second.max(axis=0) > 0.05 * second.max()
    median = np.median(second[:, moves], axis=0)
    for time, _ in keys[1:-1]:
        assert (second[round(time / STEP) - 1, moves] <= 2 * median).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_the_speed_at_a_key_is_the_same_on_both_sides(mesh, name):
    keys = MOTIONS[name](mesh)
    animation = Animation(tuple(Keyframe(*key) for key in keys), "smooth", False)
    poses, tiny = KeyframePoses(), 1e-5
    for time, pose in keys[1:-1]:
        before, after = (
            sign * (poses.moment(mesh, animation, time + sign * tiny).pose - pose) / tiny for sign in (-1, 1)
        )
        np.testing.assert_allclose(before, after, atol=1e-3 * np.abs(after).max() + 1e-2)


@pytest.mark.parametrize("name", [*MOTIONS, *BACK_AND_FORTH])
def test_no_face_is_worse_than_at_the_worse_end(mesh, name):
    keys = {**MOTIONS, **BACK_AND_FORTH}[name](mesh)
    times, poses = played(mesh, keys)
    for (start, first), (end, last) in pairwise(keys):
        worst = max(distortion(mesh, first).area, distortion(mesh, last).area)
        between = poses[(times > start) & (times < end)]
        assert max(distortion(mesh, pose).area for pose in between) <= 1.01 * worst
        assert max(distortion(mesh, pose).flipped for pose in between) == 0


def test_keys_are_exact(mesh):
    keys = MOTIONS["swing"](mesh)
    _, poses = played(mesh, keys)
    for time, pose in keys:
        np.testing.assert_allclose(poses[round(time / STEP)], pose, atol=1e-9)


def test_turns_of_more_than_half_are_kept_and_none_overshoots(mesh):
    keys = [
        (0, mesh.vertices),
        (0.5, curled(mesh, 1.9 * np.pi)),
        (1, curled(mesh, 2.0)),
        (1.4, curled(mesh, 4.0)),
    ]
    _, poses = played(mesh, keys)
    tip = poses[:, 40 + 41 * 2] - poses[:, 39 + 41 * 2]
    angle = np.unwrap(np.arctan2(tip[:, 1], tip[:, 0]))
    for (start, low), (end, high) in pairwise([(0, 0), (50, 1.9 * np.pi), (100, 2.0), (140, 4.0)]):
        part = angle[start : end + 1]
        assert min(low, high) - 0.15 <= part.min()
        assert part.max() <= max(low, high) + 0.15


def test_a_rotation_about_a_distant_point_stays_on_its_circle(mesh):
    center = -30 + 5j
    _, poses = played(mesh, [(0, mesh.vertices), (0.4, rotated(mesh, 0.5)), (0.7, rotated(mesh, 1.8))])
    rest = np.abs(mesh.vertices.view(np.complex128)[:, 0] - center)
    for pose in poses:
        radius = np.abs(np.ascontiguousarray(pose).view(np.complex128)[:, 0] - center)
        np.testing.assert_allclose(radius, rest, rtol=2e-3)


def test_what_stands_still_stays(mesh):
    _, poses = played(mesh, MOTIONS["swing"](mesh))
    still = mesh.vertices[:, 0] < 9
    assert np.abs(poses[:, still] - mesh.vertices[still]).max() < 0.03


def test_the_motion_starts_and_ends_at_rest_but_a_loop_flows_on(mesh):
    keys = [(0, curled(mesh, 0)), (0.4, curled(mesh, 0.8)), (0.8, curled(mesh, 0.1)), (1.2, curled(mesh, 0))]
    _, poses = played(mesh, keys)
    assert np.abs(poses[1] - poses[0]).max() < 0.1 * np.abs(np.diff(poses, axis=0)).max()
    # half of it again, shifted: the seam is an inner key, so it must look the same
    turns = 0.5, 0.9, 0.4, 0.1, 0.5
    around = [(0.3 * k, curled(mesh, turn)) for k, turn in enumerate(turns)]
    shifted = [(0.3 * k, curled(mesh, turn)) for k, turn in enumerate((*turns[2:], *turns[1:3]))]
    one, other = played(mesh, around, loop=True)[1], played(mesh, shifted, loop=True)[1]
    np.testing.assert_allclose(one[:-1], np.roll(other[:-1], 60, axis=0), atol=1e-6)


@pytest.mark.parametrize(("ease", "speed"), [("none", 1.0), ("out", 0.0), ("in", 2.0), ("hold", 0.0)])
def test_a_smooth_interval_takes_over_the_speed_of_a_neighbor_with_its_own_easing(mesh, ease, speed):
    keys = [(0, mesh.vertices, ease), (0.5, moved(mesh, 20, 0)), (1, moved(mesh, 40, 0))]
    animation, tiny = Animation(tuple(Keyframe(*key) for key in keys), "smooth", False), 1e-5
    pose = KeyframePoses().moment(mesh, animation, 0.5 + tiny).pose
    np.testing.assert_allclose((pose - keys[1][1])[:, 0] / tiny, 40 * speed, atol=0.1)
