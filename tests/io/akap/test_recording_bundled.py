"""The recordings that come with the program."""

from itertools import islice

import numpy as np
import pytest

from akap_editor.editor.session.recording import mesh_digest
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.recording import read_recording, recorded_drawing
from akap_editor.meshing.meshers import PYTHONCDT
from akap_editor.resources import resource
from tests.support.meshers import needs_triangle, pretend_installed

RECORDINGS = sorted(resource("assets", "recordings").glob("*.akaprec"))


@pytest.mark.parametrize("path", RECORDINGS, ids=lambda path: path.stem)
def test_each_names_a_bundled_drawing_and_bends_it(path):
    """The first moves; all of them would take minutes."""
    recording = read_recording(path)
    drawing = recorded_drawing(recording)
    first = next(n for n, event in enumerate(recording.events) if event["do"] == "step")
    *_, last = islice(replay(recording, drawing), first + 3)
    assert np.abs(last.state.positions - drawing.mesh.vertices).max() > 0.1


@pytest.mark.parametrize(
    "path", [path for path in RECORDINGS if path.stem != "robot"], ids=lambda path: path.stem
)
def test_each_is_replayed_where_there_is_no_triangle(path, monkeypatch):
    """On meshes of PythonCDT: the first moves. The robot's recording carries its mesh."""
    pretend_installed(monkeypatch, PYTHONCDT)
    recording = read_recording(path)
    drawing = recorded_drawing(recording)
    assert drawing.meshing.mesher == PYTHONCDT
    first = next(n for n, event in enumerate(recording.events) if event["do"] == "step")
    *_, last = islice(replay(recording, drawing), first + 3)
    assert np.abs(last.state.positions - drawing.mesh.vertices).max() > 0.1


@needs_triangle
def test_the_paper_s_experiments_are_on_the_meshes_that_they_were_made_on():
    """So that their figures are those of docs/experiments.md."""
    for name in ("fig5-rotating-head", "fig8-variants", "there-and-back"):
        recording = read_recording(resource("assets", "recordings", f"{name}.akaprec"))
        assert recording.header["mesh"] == mesh_digest(recorded_drawing(recording).mesh)
