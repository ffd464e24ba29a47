"""Whole drags of `AkapDeformer`, on cartoons."""

import numpy as np
import pytest

from akap_editor.deform.akap import deformer
from akap_editor.deform.akap.deformer import AkapDeformer
from akap_editor.deform.akap.preconditioned_cholesky import PreconditionedCholesky
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import MeshPoints, TriMesh
from akap_editor.resources import bundled_drawings
from tests.support.arap_reference import converged_arap

BUNDLED = [path.stem for path in bundled_drawings()]
SHARED = [f"noto/{name}" for name in ("cat", "dancer", "elephant", "gecko", "t-rex")] + [
    "gophers/gopher-8",
    "gophers/gopher-42",
    "drawings/char1-mask",
    "drawings/char4-mask",
]
ARRIVED = 0.25  # pixels


def far_apart(mesh, count=5):
    """Pins far from one another, inside faces: the first in the middle, the others at the ends of limbs."""
    centers = mesh.vertices[mesh.faces].mean(axis=1)
    chosen = [int(np.argmin(((centers - centers.mean(axis=0)) ** 2).sum(axis=1)))]
    for _ in range(count - 1):
        to_chosen = ((centers[:, None] - centers[chosen]) ** 2).sum(axis=2).min(axis=1)
        chosen.append(int(np.argmax(to_chosen)))
    return MeshPoints(np.array(chosen), np.tile([0.5, 0.3, 0.2], (count, 1)))


def largest_part(mesh):
    """Alone, since ARAP leaves a part without pins undetermined."""
    part = mesh.component[mesh.faces[:, 0]]
    used, faces = np.unique(mesh.faces[part == np.bincount(part).argmax()], return_inverse=True)
    return TriMesh(mesh.vertices[used], faces.reshape(-1, 3))


class Drag:
    """A drawing whose last pin is dragged while the others are to stay."""

    def __init__(self, mesh, pins=5, **settings):
        self.mesh, self.points = mesh, far_apart(mesh, pins)
        self.rest = mesh.evaluate(self.points, mesh.vertices)
        self.deformer = AkapDeformer(mesh, **settings)
        self.deformer.set_pins(self.points)
        self.pose, self.goals = mesh.vertices, self.rest.copy()

    def to(self, goal):
        """One frame."""
        self.goals[-1] = goal
        self.result = self.deformer.step(self.pose, self.goals)
        self.pose = self.result.positions

    def settle(self, most=30, still=1e-4):
        """Further steps until nothing moves, at most ``most``."""
        for _ in range(most):
            before = self.pose
            self.to(self.goals[-1].copy())
            if np.abs(self.pose - before).max() < still:
                break

    def misses(self):
        """How far each pin is from where it should be."""
        return np.hypot(*(self.mesh.evaluate(self.points, self.pose) - self.goals).T)

    def aside(self, far):
        """A place beside the last pin, across the direction to the middle of the drawing."""
        x, y = (self.rest[0] - self.rest[-1]) / np.linalg.norm(self.rest[0] - self.rest[-1])
        return self.rest[-1] + far * np.array([-y, x])

    def inward(self, far):
        """A place between the last pin and the middle of the drawing."""
        way = self.rest[0] - self.rest[-1]
        return self.rest[-1] + far * way / np.linalg.norm(way)

    def turned(self, degrees, share):
        """The place of the last pin turned about the first one, and nearer to it."""
        cos, sin = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
        return self.rest[0] + share * (self.rest[-1] - self.rest[0]) @ [[cos, sin], [-sin, cos]]


# -- bundling ------------------------------------------------------------------------------------------------


def beyond_isometry(mesh, pose):
    quality = distortion(mesh, pose)
    return np.array([quality.area - 2, quality.angle - 2])


@pytest.mark.parametrize("memory", [0.0, 1.0])
@pytest.mark.parametrize(("name", "pins"), [("bar", 3), ("elephant", 5), ("cat", 5), ("gingerbread", 5)])
def test_one_event_comes_to_the_same_as_sixty(cartoon_mesh, name, pins, memory):
    """A mouse that is asked seldom bends the drawing as one that is asked often.

    The bar is held in the middle and at one end: between more pins it would buckle, one way or the other.
    """
    mesh = cartoon_mesh(name)
    found = []
    for events in (1, 60):
        drag = Drag(mesh, pins, memory=memory)
        for far in np.linspace(0, 200, events + 1)[1:]:
            drag.to(drag.aside(far))
        drag.settle()
        found.append(beyond_isometry(mesh, drag.pose))
    assert found[0] == pytest.approx(found[1], rel=0.01)


# -- creep ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("memory", [0.0, 1.0])
def test_pins_that_hold_do_not_creep(cartoon_mesh, memory):
    """One pin of the gingerbread man is deep inside, where the second solve is blind to it."""
    drag = Drag(cartoon_mesh("gingerbread", 600), memory=memory)
    worst = np.zeros(len(drag.points))
    for turn in np.linspace(0, 8 * np.pi, 1001)[1:]:
        drag.to(drag.rest[-1] + 150 * np.array([np.sin(turn), np.sin(2 * turn) / 2]))
        worst = np.maximum(worst, drag.misses())
        assert not drag.result.report.blocked
    assert worst[:-1].max() < ARRIVED
    assert worst[-1] < ARRIVED


def test_without_corrections_the_inner_pin_would_creep(cartoon_mesh, monkeypatch):
    """What the law above is worth."""
    monkeypatch.setattr(deformer, "MAX_CORRECTIONS", 0)
    drag = Drag(cartoon_mesh("gingerbread", 600))
    worst = 0.0
    for far in range(0, 150, 5):
        drag.to(drag.inward(far))
        worst = max(worst, drag.misses()[0])
    assert worst > 2 * ARRIVED


# -- rest memory ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "direction"),
    [(name, "inward") for name in BUNDLED + SHARED] + [("bar", "aside"), ("raptor", "aside")],
)
def test_memory_comes_back_to_rest(cartoon_mesh, name, direction):
    drag = Drag(cartoon_mesh(name), memory=1.0)
    there = np.linspace(0, 150, 61)
    for far in np.concatenate([there[1:], there[-2::-1]]):
        drag.to(getattr(drag, direction)(far))
    drag.settle()
    assert np.abs(drag.pose - drag.mesh.vertices).max() < 0.01


@pytest.mark.parametrize(("degrees", "share"), [(40, 0.9), (80, 0.85)])
@pytest.mark.parametrize("name", BUNDLED + SHARED)
def test_memory_distorts_no_more_than_converged_arap(cartoon_mesh, name, degrees, share):
    drag = Drag(largest_part(cartoon_mesh(name)), memory=1.0)
    for t in np.linspace(0, 1, 61)[1:]:
        drag.to(drag.turned(degrees * t, 1 + (share - 1) * t))
    drag.settle()
    ours = distortion(drag.mesh, drag.pose)
    assert ours.flipped == 0
    assert drag.misses().max() < ARRIVED
    rival = distortion(drag.mesh, converged_arap(drag.mesh, drag.points, drag.goals, drag.pose))
    assert ours.area + ours.angle <= rival.area + rival.angle


@pytest.mark.parametrize("name", ["raptor", "elephant"])
def test_pose_with_memory_does_not_depend_on_the_way(cartoon_mesh, name):
    poses = []
    for frames in (12, 120):
        drag = Drag(cartoon_mesh(name), memory=1.0)
        for t in np.linspace(0, 1, frames + 1)[1:]:
            drag.to(drag.turned(60 * t, 1.0))
        drag.settle()
        poses.append(drag.pose)
    assert np.abs(poses[0] - poses[1]).max() < 0.01


# -- reuse of factorizations ---------------------------------------------------------------------------------


def wave(drag, t):
    """Places of the last pin for t from 0 to 1."""
    return drag.rest[-1] + 150 * np.array([np.sin(np.pi * t), (1 - np.cos(np.pi * t)) / 2])


@pytest.fixture
def factorizations(monkeypatch):
    """How often the matrix of a field was factorized."""
    count = [0]
    original = PreconditionedCholesky.factorize

    def counted(self):
        count[0] += 1
        original(self)

    monkeypatch.setattr(PreconditionedCholesky, "factorize", counted)
    return count


@pytest.mark.parametrize("memory", [0.0, 1.0])
@pytest.mark.parametrize("name", ["gingerbread", "elephant"])
def test_reuse_of_factorizations_is_not_seen(cartoon_mesh, factorizations, name, memory):
    mesh, counts, ends = cartoon_mesh(name), [], []
    exact = Drag(mesh, memory=memory, exact=True)
    for drag in (exact, Drag(mesh, memory=memory)):
        factorizations[0] = 0
        for t in np.linspace(0, 1, 101)[1:]:
            drag.to(wave(drag, t))
        counts.append(factorizations[0])
        drag.settle()
        ends.append(beyond_isometry(mesh, drag.pose))
    assert counts[1] < counts[0] / 5
    assert np.abs(ends[0] - ends[1]).max() < 5e-5


@pytest.mark.parametrize("name", ["gingerbread", "elephant"])
def test_each_step_with_reuse_is_the_exact_one(cartoon_mesh, name):
    """Without memory, whose descent depends on the preconditioner and is the same only where it ends."""
    mesh = cartoon_mesh(name)
    drag, exact = Drag(mesh), Drag(mesh, exact=True)
    for t in np.linspace(0, 1, 101)[1:]:
        exact.pose = drag.pose
        for one in (drag, exact):
            one.to(wave(one, t))
        assert np.abs(drag.pose - exact.pose).max() < 0.01
