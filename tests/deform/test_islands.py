"""Parts without a pin ride with the part nearest to them."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.deformer import Deformer, StepReport, StepResult
from akap_editor.deform.islands import IslandDeformer
from akap_editor.deform.methods import make_deformer, method_names
from akap_editor.geometry.mesh import MeshPoints, TriMesh
from akap_editor.io.images import read_image
from akap_editor.meshing.outline import outlines
from akap_editor.meshing.triangulate import triangulate
from tests.support import shapes

STEP = StepReport(0.0, 1, 0.0, 0, 0.0)


class Puppeteer(Deformer):
    """A deformer that puts the parts with pins where the test says, straight along."""

    def __init__(self) -> None:
        self.pose = None

    def set_pins(self, points):
        pass

    def step(self, positions, targets):
        del targets
        way = self.pose - positions
        return StepResult(self.pose, way, STEP, lambda t: positions + t * way)


@pytest.fixture
def comb():
    """A body with an arm below which there are two islands, the outer one nearer to the inner than to it."""
    return replace(shapes.blocks("######### ##....... ##......# ##......# ##....###", 20, 3, 0.15), tied=True)


@pytest.fixture
def row():
    """A body and two islands beside it, one behind the other."""
    return replace(shapes.blocks("###.#.# ###.#.. ###...#", 40, 3, 0.2), tied=True)


def part_at(mesh, x, y):
    return mesh.component == mesh.component[np.argmin(((mesh.vertices - [x, y]) ** 2).sum(axis=1))]


def pin_on(mesh, *places):
    return mesh.locate(places)


def by(x, y):
    """A shift, in pixels."""
    return np.array([x, y], dtype=float)


def bent(mesh, angle):
    """Each vertex turned about the origin by an angle that grows with x: no rigid motion anywhere."""
    z = mesh.vertices @ [1, 1j]
    z = z * np.exp(1j * angle * mesh.vertices[:, 0] / 200)
    return np.stack([z.real, z.imag], axis=1)


def rigid_motion(before, after):
    """Rotation and translation that take points to points; fails where no rigid motion does."""
    a, b = before @ [1, 1j], after @ [1, 1j]
    turn = np.vdot(a - a.mean(), b - b.mean())
    turn /= abs(turn)
    shift = b.mean() - turn * a.mean()
    assert np.abs(turn * a + shift - b).max() < 1e-9 * 300
    return turn, shift


def ridden(mesh, points, poses, start=None):
    """Where a rider's drawing is after its pinned parts were in ``poses``, one after the other."""
    puppeteer = Puppeteer()
    deformer = IslandDeformer(mesh, puppeteer)
    deformer.set_pins(points)
    pose = mesh.vertices if start is None else start
    pinned = np.isin(mesh.component, mesh.component[mesh.faces[points.faces, 0]])[:, None]
    for wanted in poses:
        puppeteer.pose = np.where(pinned, wanted, pose)
        pose = deformer.step(pose, np.zeros((len(points), 2))).positions
    return pose


@pytest.mark.parametrize("method", method_names())
def test_islands_go_where_the_body_goes(row, method):
    """A quarter turn of the body about a point far away, by its pins."""
    points = pin_on(row, (20, 20), (100, 30), (50, 100))
    deformer = make_deformer(method, row)
    deformer.set_pins(points)
    pose, z = row.vertices, row.evaluate(points, row.vertices) @ [1, 1j]
    for angle in np.linspace(0, np.pi / 2, 16)[1:]:
        turned = np.exp(1j * angle) * (z - 300) + 300
        pose = deformer.step(pose, np.stack([turned.real, turned.imag], axis=1)).positions
    turn, shift = rigid_motion(row.vertices[~part_at(row, 20, 20)], pose[~part_at(row, 20, 20)])
    body, _ = np.exp(1j * angle), None
    assert abs(turn - body) < 0.02
    assert abs(turn * 300 + shift - 300) < 0.02 * 300


@pytest.mark.parametrize("method", method_names())
def test_untied_islands_stay(row, method):
    free = replace(row, tied=False)
    points = pin_on(free, (20, 20), (100, 100))
    deformer = make_deformer(method, free)
    deformer.set_pins(points)
    pose = deformer.step(free.vertices, free.evaluate(points, free.vertices) + 9.0).positions
    comparison = ~part_at(free, 20, 20)
    assert pose[comparison].tolist() == free.vertices[comparison].tolist()


def test_island_is_where_the_patch_is_whatever_the_way(row):
    points = pin_on(row, (20, 20))
    there, aside, far = (bent(row, angle) for angle in (0.9, -0.4, 2.5))
    at_once = ridden(row, points, [there])
    assert np.abs(at_once - row.vertices).max() > 30
    assert np.abs(ridden(row, points, [aside, far, aside, there]) - at_once).max() < 1e-9 * 300
    back = ridden(row, points, [there, far, row.vertices])
    assert np.abs(back - row.vertices).max() < 1e-9 * 300


def test_a_chain_rides_as_one_body(row):
    moved = ridden(row, pin_on(row, (20, 20)), [bent(row, 0.8)])
    comparison = ~part_at(row, 20, 20)
    rigid_motion(row.vertices[comparison], moved[comparison])


def test_a_chain_begins_at_the_nearest_pin(row):
    """With the inner island pinned, the outer one rides with it, and with the body no more."""
    inner, outer = part_at(row, 180, 60), part_at(row, 260, 20)
    points = pin_on(row, (20, 20), (180, 60))
    pose = np.where(inner[:, None], row.vertices + by(0, 50), row.vertices - by(70, 0))
    moved = ridden(row, points, [pose])
    assert np.abs(moved[outer] - row.vertices[outer] - by(0, 50)).max() < 1e-9 * 300


def test_island_follows_the_limb_next_to_it_and_not_the_body(comb):
    """The island is near the tip of the arm, and the tip alone is turned."""
    tip, island = comb.vertices[:, 0] > 140, ~part_at(comb, 10, 10)
    z = comb.vertices @ [1, 1j]
    turned = np.exp(0.5j) * (z - 140) + 140
    pose = np.where(tip[:, None], np.stack([turned.real, turned.imag], axis=1), comb.vertices)
    moved = ridden(comb, pin_on(comb, (10, 10)), [pose])
    turn, _ = rigid_motion(comb.vertices[island], moved[island])
    assert np.angle(turn) > 0.35


def test_a_pin_taken_off_moves_nothing_and_the_island_rides_on_from_there(row):
    inner = part_at(row, 180, 60)
    both = pin_on(row, (20, 20), (180, 60))
    apart = ridden(row, both, [np.where(inner[:, None], row.vertices + by(15, 40), row.vertices)])
    body = both.faces[:1], both.weights[:1]
    still = ridden(row, MeshPoints(*body), [apart], start=apart)
    assert np.abs(still - apart).max() < 1e-9 * 300
    shifted = ridden(row, MeshPoints(*body), [apart + by(8, 3)], start=apart)
    assert np.abs(shifted - apart - by(8, 3)).max() < 1e-9 * 300


def test_a_patch_that_has_collapsed_takes_its_island_along_without_turning_it(row):
    points = pin_on(row, (20, 20))
    moved = ridden(row, points, [np.full_like(row.vertices, 500.0)])
    inner = part_at(row, 180, 60)
    turn, _ = rigid_motion(row.vertices[inner], moved[inner])
    assert turn == pytest.approx(1)


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_in_betweens_lead_from_one_pose_to_the_other(row, memory):
    points = pin_on(row, (20, 20), (100, 30), (50, 100))
    deformer = make_deformer("akap", row, memory=memory)
    deformer.set_pins(points)
    targets = row.evaluate(points, row.vertices) + np.array([[0, 9], [4, -3], [-8, 1]])
    result = deformer.step(row.vertices, targets)
    comparison = ~part_at(row, 20, 20)
    assert np.abs(result.at(0) - row.vertices).max() < 1e-9
    assert np.abs(result.at(1)[comparison] - result.positions[comparison]).max() < 0.05
    for t in (0.2, 0.7):
        rigid_motion(row.vertices[comparison], result.at(t)[comparison])


def test_field_at_the_islands_is_the_velocity_that_they_start_with(row):
    """By differences, from a bent pose along a field that is rigid nowhere."""
    body, puppeteer = part_at(row, 20, 20)[:, None], Puppeteer()
    deformer = IslandDeformer(row, puppeteer)
    deformer.set_pins(pin_on(row, (20, 20)))
    start = bent(row, 0.6)
    puppeteer.pose = np.where(body, bent(row, 0.7) + by(20, 0), start)
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


def test_many_islands_are_all_taken_along():
    mesh = replace(shapes.blocks("#.#.# ..... #.#.# ..... #.#.#", 20, 2, 0.2), tied=True)
    moved = ridden(mesh, pin_on(mesh, (50, 50)), [mesh.vertices + by(30, 40)])
    assert np.abs(moved - mesh.vertices - by(30, 40)).max() < 1e-9 * 300


def test_nails_around_a_gopher_ride_with_its_feet(shared_data):
    """The body bent by pins: a nail is about as far from the skin next to it as before."""
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


def test_meshes_of_one_part_need_no_rider():
    mesh = replace(shapes.SHAPES["square"], tied=True)
    assert not isinstance(make_deformer("akap", mesh), IslandDeformer)
    assert isinstance(mesh, TriMesh)
