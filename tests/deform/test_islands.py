"""Islands: components without a pin move rigidly with the nearest component that has one."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.deformer import Deformer, StepReport, StepResult
from akap_editor.deform.islands import IslandDeformer
from akap_editor.deform.methods import make_deformer, method_names
from akap_editor.geometry.mesh import MeshPoints
from akap_editor.io.images import read_image
from akap_editor.meshing.outline import outlines
from akap_editor.meshing.triangulate import triangulate
from tests.support import shapes

STEP = StepReport(0.0, 1, 0.0, 0, 0.0)


class Puppeteer(Deformer):
    """A deformer that moves straight to the pose that the test has set."""

    def __init__(self) -> None:
        self.pose = None

    def set_pins(self, points):
        pass

    def step(self, positions, targets):
        del targets
        field = self.pose - positions
        return StepResult(self.pose, field, STEP, lambda t: positions + t * field)


@pytest.fixture
def comb():
    """A body with an arm, and two islands below the arm; the outer one is nearest to the inner one."""
    return replace(shapes.blocks("######### ##....... ##......# ##......# ##....###", 20, 3, 0.15), tied=True)


@pytest.fixture
def row():
    """A body and two islands in a row next to it."""
    return replace(shapes.blocks("###.#.# ###.#.. ###...#", 40, 3, 0.2), tied=True)


def part_at(mesh, x, y):
    return mesh.component == mesh.component[np.argmin(((mesh.vertices - [x, y]) ** 2).sum(axis=1))]


def pin_on(mesh, *places):
    return mesh.locate(places)


def shift_by(x, y):
    """A translation (2,), pixels."""
    return np.array([x, y], dtype=float)


def bent(mesh, angle):
    """A pose: each vertex rotated about the origin by an angle that grows with x, rigid nowhere."""
    z = mesh.vertices @ [1, 1j]
    z = z * np.exp(1j * angle * mesh.vertices[:, 0] / 200)
    return np.stack([z.real, z.imag], axis=1)


def rigid_motion(before, after):
    """The rotation and translation from points to points; the test fails if there is none."""
    a, b = before @ [1, 1j], after @ [1, 1j]
    turn = np.vdot(a - a.mean(), b - b.mean())
    turn /= abs(turn)
    shift = b.mean() - turn * a.mean()
    assert np.abs(turn * a + shift - b).max() < 1e-9 * 300
    return turn, shift


def pose_after(mesh, points, poses, start=None):
    """The pose after steps that move the pinned components to ``poses``, from ``start`` or from rest."""
    puppeteer = Puppeteer()
    deformer = IslandDeformer(mesh, puppeteer)
    deformer.set_pins(points)
    pose = mesh.vertices if start is None else start
    pinned = np.isin(mesh.component, mesh.component[mesh.faces[points.faces, 0]])[:, None]
    for target in poses:
        puppeteer.pose = np.where(pinned, target, pose)
        pose = deformer.step(pose, np.zeros((len(points), 2))).positions
    return pose


@pytest.mark.parametrize("method", method_names())
def test_islands_move_with_the_body(row, method):
    """The pins rotate the body by 90° about a point far away."""
    points = pin_on(row, (20, 20), (100, 30), (50, 100))
    deformer = make_deformer(method, row)
    deformer.set_pins(points)
    pose, z = row.vertices, row.evaluate(points, row.vertices) @ [1, 1j]
    for angle in np.linspace(0, np.pi / 2, 16)[1:]:
        turned = np.exp(1j * angle) * (z - 300) + 300
        pose = deformer.step(pose, np.stack([turned.real, turned.imag], axis=1)).positions
    islands = ~part_at(row, 20, 20)
    turn, shift = rigid_motion(row.vertices[islands], pose[islands])
    assert abs(turn - np.exp(1j * angle)) < 0.02
    assert abs(turn * 300 + shift - 300) < 0.02 * 300


@pytest.mark.parametrize("method", method_names())
def test_untied_islands_stay(row, method):
    free = replace(row, tied=False)
    points = pin_on(free, (20, 20), (100, 100))
    deformer = make_deformer(method, free)
    deformer.set_pins(points)
    pose = deformer.step(free.vertices, free.evaluate(points, free.vertices) + 9.0).positions
    islands = ~part_at(free, 20, 20)
    assert pose[islands].tolist() == free.vertices[islands].tolist()


def test_island_depends_on_the_patch_and_not_on_its_path(row):
    points = pin_on(row, (20, 20))
    end, other, far = (bent(row, angle) for angle in (0.9, -0.4, 2.5))
    at_once = pose_after(row, points, [end])
    assert np.abs(at_once - row.vertices).max() > 30
    assert np.abs(pose_after(row, points, [other, far, other, end]) - at_once).max() < 1e-9 * 300
    back = pose_after(row, points, [end, far, row.vertices])
    assert np.abs(back - row.vertices).max() < 1e-9 * 300


def test_a_chain_moves_as_one_body(row):
    moved = pose_after(row, pin_on(row, (20, 20)), [bent(row, 0.8)])
    islands = ~part_at(row, 20, 20)
    rigid_motion(row.vertices[islands], moved[islands])


def test_a_chain_begins_at_the_nearest_pin(row):
    """With the inner island pinned, the outer one moves with it and no longer with the body."""
    inner, outer = part_at(row, 180, 60), part_at(row, 260, 20)
    points = pin_on(row, (20, 20), (180, 60))
    pose = np.where(inner[:, None], row.vertices + shift_by(0, 50), row.vertices - shift_by(70, 0))
    moved = pose_after(row, points, [pose])
    assert np.abs(moved[outer] - row.vertices[outer] - shift_by(0, 50)).max() < 1e-9 * 300


def test_island_follows_the_limb_next_to_it_and_not_the_body(comb):
    """The islands are near the tip of the arm, and only the tip is rotated."""
    tip, islands = comb.vertices[:, 0] > 140, ~part_at(comb, 10, 10)
    z = comb.vertices @ [1, 1j]
    turned = np.exp(0.5j) * (z - 140) + 140
    pose = np.where(tip[:, None], np.stack([turned.real, turned.imag], axis=1), comb.vertices)
    moved = pose_after(comb, pin_on(comb, (10, 10)), [pose])
    turn, _ = rigid_motion(comb.vertices[islands], moved[islands])
    assert np.angle(turn) > 0.35


def test_removing_a_pin_moves_nothing_and_the_island_moves_on_from_its_pose(row):
    inner = part_at(row, 180, 60)
    both = pin_on(row, (20, 20), (180, 60))
    apart = pose_after(row, both, [np.where(inner[:, None], row.vertices + shift_by(15, 40), row.vertices)])
    body = both.faces[:1], both.weights[:1]
    still = pose_after(row, MeshPoints(*body), [apart], start=apart)
    assert np.abs(still - apart).max() < 1e-9 * 300
    shifted = pose_after(row, MeshPoints(*body), [apart + shift_by(8, 3)], start=apart)
    assert np.abs(shifted - apart - shift_by(8, 3)).max() < 1e-9 * 300


def test_a_collapsed_patch_moves_its_island_without_rotating_it(row):
    points = pin_on(row, (20, 20))
    moved = pose_after(row, points, [np.full_like(row.vertices, 500.0)])
    inner = part_at(row, 180, 60)
    turn, _ = rigid_motion(row.vertices[inner], moved[inner])
    assert turn == pytest.approx(1)


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_flow_leads_from_one_pose_to_the_other(row, memory):
    points = pin_on(row, (20, 20), (100, 30), (50, 100))
    deformer = make_deformer("akap", row, memory=memory)
    deformer.set_pins(points)
    targets = row.evaluate(points, row.vertices) + np.array([[0, 9], [4, -3], [-8, 1]])
    result = deformer.step(row.vertices, targets)
    islands = ~part_at(row, 20, 20)
    assert np.abs(result.at(0) - row.vertices).max() < 1e-9
    assert np.abs(result.at(1)[islands] - result.positions[islands]).max() < 0.05
    for t in (0.2, 0.7):
        rigid_motion(row.vertices[islands], result.at(t)[islands])


def test_field_at_the_islands_is_their_initial_velocity(row):
    """By finite differences, from a bent pose along a field that is rigid nowhere."""
    body, puppeteer = part_at(row, 20, 20)[:, None], Puppeteer()
    deformer = IslandDeformer(row, puppeteer)
    deformer.set_pins(pin_on(row, (20, 20)))
    start = bent(row, 0.6)
    puppeteer.pose = np.where(body, bent(row, 0.7) + shift_by(20, 0), start)
    result = deformer.step(start, np.zeros((1, 2)))
    slope = (result.at(1e-6) - start) / 1e-6
    assert np.abs(slope - result.field).max() < 1e-3
    assert np.abs(result.field[~body[:, 0]]).max() > 10


def test_rigid_velocities_of_the_pins_are_those_of_every_part(row):
    points = pin_on(row, (20, 20), (100, 30), (50, 100))
    deformer = make_deformer("akap", row)
    deformer.set_pins(points)
    x, y = row.vertices.T
    spinning = np.stack([5 - 0.3 * y, 0.3 * x - 2], axis=1)
    found = deformer.vector_field(row.vertices, row.evaluate(points, spinning))
    assert np.abs(found - spinning).max() < 1e-6 * 300


def test_many_islands_move_together():
    mesh = replace(shapes.blocks("#.#.# ..... #.#.# ..... #.#.#", 20, 2, 0.2), tied=True)
    moved = pose_after(mesh, pin_on(mesh, (50, 50)), [mesh.vertices + shift_by(30, 40)])
    assert np.abs(moved - mesh.vertices - shift_by(30, 40)).max() < 1e-9 * 300


def test_nails_of_a_gopher_move_with_its_feet(shared_data):
    """Pins bend the body; the gap between a nail and the skin next to it hardly changes."""
    picture = read_image(shared_data / "gophers" / "gopher-42.png")[::5, ::5]
    mesh = replace(triangulate(outlines(picture[..., 3]), 1500), tied=True)
    body = mesh.component == np.bincount(mesh.component).argmax()
    nails = [pair for pair in mesh.gaps.tolist() if body[pair].any()]
    assert len(nails) == 4
    skins = [skin if body[skin] else nail for skin, nail in nails]
    points = shapes.vertex_pins(mesh, [*skins, np.flatnonzero(body)[np.argmin(mesh.vertices[body][:, 1])]])
    deformer = make_deformer("akap", mesh, memory=1.0)
    deformer.set_pins(points)
    targets = mesh.evaluate(points, mesh.vertices)
    targets[:4] += [0, -150]
    pose = mesh.vertices
    for _ in range(8):
        pose = deformer.step(pose, targets).positions
    for pair in nails:
        before, after = (np.linalg.norm(np.subtract(*p[pair])) for p in (mesh.vertices, pose))
        assert abs(after - before) < 0.35 * before + 2
    for part in np.unique(mesh.component[~body]):
        rigid_motion(mesh.vertices[mesh.component == part], pose[mesh.component == part])


def test_meshes_of_one_component_have_no_islands():
    mesh = replace(shapes.SHAPES["square"], tied=True)
    assert not isinstance(make_deformer("akap", mesh), IslandDeformer)
