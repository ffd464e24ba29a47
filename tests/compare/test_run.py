"""What a comparison measures: the run of a method over a recording."""

from functools import cache

import numpy as np
import pytest

from akap_editor.compare.report import PAPER
from akap_editor.compare.run import replay_method, run
from akap_editor.deform.methods import make_deformer
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.geometry.distortion import distortion
from akap_editor.io.akap.recording import read_recording, recorded_drawing
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.meshers import needs_triangle
from tests.support.recorded_drag import plank_drawing, plank_recording, record_drag

SPECS = ["akap", "akap:memory=1", "arap", "igarashi", "cauchy-green", "mls"]


@pytest.fixture(scope="module")
def drawing():
    return plank_drawing()


@pytest.fixture(scope="module")
def recording():
    return plank_recording()


@pytest.fixture(scope="module")
def ran(recording, drawing):
    """The run of a method, made once."""
    return cache(lambda spec: run(recording, drawing, spec))


@pytest.mark.parametrize("spec", SPECS)
def test_a_run_ends_at_rest_under_its_pins(ran, drawing, spec):
    found = ran(spec)
    assert found.pin_error < (3.0 if spec == "mls" else 0.25)  # whose map is evaluated at vertices only
    measured = distortion(drawing.mesh, found.pose)
    assert (found.final_distortion.area, found.final_distortion.angle) == (measured.area, measured.angle)
    assert len(found.times) == len(found.trace.area) == len(found.step_seconds) == 12
    assert (np.diff(found.times) > 0).all()
    assert found.trace.area[-1] > found.trace.area[0] >= 2
    assert found.setup_seconds > 0


@pytest.mark.parametrize("spec", ["igarashi", "cauchy-green", "mls"])
def test_methods_without_iterations_are_one_step_away(ran, drawing, spec):
    """So their curves of convergence are flat, and they come home exactly."""
    found = ran(spec)
    assert found.jump.area[0] == pytest.approx(2.0, abs=1e-12)
    assert np.ptp(found.jump.area[1:]) == 0
    name, _, _ = spec.partition(":")
    deformer = make_deformer(name, drawing.mesh)
    deformer.set_pins(found.points)
    assert np.abs(deformer.step(drawing.mesh.vertices, found.targets).positions - found.pose).max() < 1e-9
    assert found.return_error < 1e-9


def test_the_way_back_shows_who_remembers(ran):
    back = {spec: ran(spec).return_error for spec in ("akap", "akap:memory=1", "arap")}
    assert back["akap:memory=1"] < 1e-3
    assert back["arap"] < 1e-3
    assert back["akap"] > 10 * back["akap:memory=1"]


def test_iterations_converge(ran):
    curve, end = ran("arap").jump, ran("arap").final_distortion.area
    assert abs(curve.area[-1] - end) < 0.01 * abs(curve.area[1] - end)
    assert (curve.pin_error[1:] < 1e-9).all()


@needs_triangle
def test_bar_of_the_paper_gives_its_figures():
    """Table 1, first row: the bundled recording is the bend at which conformal maps and ARAP agree."""
    recording = read_recording(resource("assets", "recordings", "bar.akaprec"))
    drawing = recorded_drawing(recording)
    found = {spec: replay_method(recording, drawing, spec).pose for spec in ("cauchy-green", "arap", "mls")}
    after = {spec: distortion(drawing.mesh, pose) for spec, pose in found.items()}
    area, angle = PAPER["bar"]["cauchy-green"]
    assert after["cauchy-green"].area == pytest.approx(area, abs=0.01)
    assert after["cauchy-green"].angle == pytest.approx(angle, abs=0.002)
    area, angle = PAPER["bar"]["arap"]
    assert after["arap"].area == pytest.approx(area, abs=0.005)
    assert after["arap"].angle == pytest.approx(angle, abs=0.01)
    assert min(after["mls"].area, after["mls"].angle) > 3.0


@pytest.mark.parametrize("name", ["dancer", "gecko"])
def test_real_cartoons(shared_data, name):
    """The order of Table 1 holds: conformal maps keep angles best and areas worst."""
    drawing = make_drawing(read_image(shared_data / "noto" / f"{name}.png"), vertices=400, name=name)
    mesh = drawing.mesh
    low, high = mesh.vertices.argmin(axis=0)[1], mesh.vertices.argmax(axis=0)[1]
    left, right = mesh.vertices.argmin(axis=0)[0], mesh.vertices.argmax(axis=0)[0]
    faces = [
        int(np.flatnonzero((mesh.faces == corner).any(axis=1))[0]) for corner in (low, high, left, right)
    ]
    points = mesh.vertices[mesh.faces[faces]].mean(axis=1)
    size = mesh.length
    offsets = size * np.array([[0.2, 0.1], [0.0, 0.0], [0.1, -0.25], [-0.1, 0.2]])
    recording = record_drag(drawing, [tuple(point) for point in points.tolist()], 0.5 * offsets, moves=6)
    after = {
        spec: distortion(mesh, replay_method(recording, drawing, spec).pose)
        for spec in ("akap:memory=1", "arap", "cauchy-green")
    }
    assert after["cauchy-green"].area > max(after["arap"].area, after["akap:memory=1"].area)
    assert after["cauchy-green"].angle < min(after["arap"].angle, after["akap:memory=1"].angle)
