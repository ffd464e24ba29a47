"""Meshers in a child process: one child for many jobs, crashes and time-outs are errors of one job only."""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.meshing import mesher_worker
from akap_editor.meshing.mesher_process import MesherProcess, Refinement
from akap_editor.meshing.meshers import MESHERS, PYTHONCDT, TRIANGLE, installed_meshers
from tests.support.meshers import EACH_MESHER, needs_triangle

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
GRAPH = {
    "vertices": SQUARE,
    "segments": np.array([[0, 1], [1, 2], [2, 3], [3, 0]], dtype=np.int32),
    "holes": np.zeros((0, 2)),
}
FINE = {mesher: Refinement(mesher, 28.0, 50.0) for mesher in MESHERS}


@pytest.fixture(params=EACH_MESHER)
def refinement(request) -> Refinement:
    """A refinement by each mesher."""
    return FINE[request.param]


@pytest.fixture
def process() -> Iterator[MesherProcess]:
    """A child process that only the test uses."""
    process = MesherProcess()
    yield process
    process.close()


def test_one_child_answers_one_job_after_another(process, refinement):
    child = process.start()
    first, faces = process.run(GRAPH, refinement)
    second, _ = process.run(GRAPH, refinement)
    assert process.start() is child
    assert child.poll() is None
    assert first.tolist() == second.tolist()
    assert faces.shape[1] == 3
    assert len(faces) > 100


def test_one_child_runs_all_meshers(process):
    child = process.start()
    each = installed_meshers()
    counts = [len(process.run(GRAPH, FINE[mesher])[0]) for mesher in (*each, *each)]
    assert counts[: len(each)] == counts[len(each) :]
    assert process.start() is child


@pytest.mark.parametrize(
    ("change", "refinement"),
    [
        pytest.param({"vertices": SQUARE[:0]}, FINE[TRIANGLE], marks=needs_triangle),
        pytest.param({}, FINE[TRIANGLE]._replace(max_area=0.0), marks=needs_triangle),
        ({"vertices": SQUARE[:0]}, FINE[PYTHONCDT]),
        ({"segments": GRAPH["segments"] + 7}, FINE[PYTHONCDT]),
    ],
    ids=["Triangle: no vertices", "Triangle: area of zero", "PythonCDT: no vertices", "PythonCDT: no such"],
)
def test_crash_is_an_input_error_and_the_next_job_works(process, change, refinement):
    title = MESHERS[refinement.mesher]
    with pytest.raises(InputError, match=f"cannot be triangulated: {title} stopped without an answer"):
        process.run({**GRAPH, **change}, refinement)
    assert len(process.run(GRAPH, FINE[refinement.mesher])[1])


def test_time_out_is_an_input_error_and_the_next_job_works(process, refinement):
    title = MESHERS[refinement.mesher]
    with pytest.raises(InputError, match=rf"cannot be triangulated: {title} took longer than 0\.0001 s"):
        process.run(GRAPH, refinement._replace(max_area=0.001), limit=0.0001)
    assert len(process.run(GRAPH, refinement)[1])


def test_killed_child_is_replaced(process, refinement):
    process.run(GRAPH, refinement)
    child = process.start()
    child.kill()
    child.wait()
    assert len(process.run(GRAPH, refinement)[1])


def test_child_that_dies_as_the_job_is_sent(process, monkeypatch):
    dead = process.start()
    dead.kill()
    dead.wait()
    with monkeypatch.context() as patch:
        patch.setattr(process, "start", lambda: dead)
        with pytest.raises(InputError, match="PythonCDT stopped without an answer"):
            process.run(GRAPH, FINE[PYTHONCDT])
    assert len(process.run(GRAPH, FINE[PYTHONCDT])[1])


def test_closing_ends_the_child(process, refinement):
    child = process.start()
    process.close()
    assert child.poll() is not None
    process.close()
    assert len(process.run(GRAPH, refinement)[1])


@pytest.mark.parametrize(
    ("change", "mesher"),
    [
        pytest.param({"segments": GRAPH["segments"] + 7}, TRIANGLE, marks=needs_triangle),
        pytest.param({"vertices": SQUARE * [1, 0]}, TRIANGLE, marks=needs_triangle),
        ({"segments": GRAPH["segments"][:2]}, PYTHONCDT),
    ],
    ids=["Triangle: no such segments", "Triangle: on a line", "PythonCDT: open outline"],
)
def test_no_faces_are_an_input_error(process, change, mesher):
    with pytest.raises(InputError, match=f"cannot be triangulated: {MESHERS[mesher]} returned no faces"):
        process.run({**GRAPH, **change}, FINE[mesher])


def test_coordinates_that_are_not_finite_are_refused(process, refinement):
    with pytest.raises(InputError, match="outlines: expected finite coordinates"):
        process.run({**GRAPH, "vertices": SQUARE * np.nan}, refinement)


def test_the_child_of_a_bundle_is_the_program_with_a_hidden_command(process, tmp_path, monkeypatch):
    """A bundle has no Python that could run a script; `tools/bundle/start.py` is what it starts."""
    program = tmp_path / "akap-editor"
    folder = Path(mesher_worker.__file__).parent
    start = Path(__file__).parents[2] / "tools" / "bundle" / "start.py"
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{folder}" exec "{sys.executable}" "{start}" "$@"\n')
    program.chmod(0o755)
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(sys, "executable", str(program))
    assert len(process.run(GRAPH, FINE[PYTHONCDT])[1])


def angles(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(m, 3) angles in degrees."""
    corners = vertices[faces]
    u, v = np.roll(corners, -1, axis=1) - corners, np.roll(corners, -2, axis=1) - corners
    cosine = (u * v).sum(axis=2) / np.linalg.norm(u, axis=2) / np.linalg.norm(v, axis=2)
    return np.degrees(np.arccos(cosine))


@pytest.mark.parametrize("most", [100, 60, 4])
def test_pythoncdt_removes_vertices_that_it_inserted_as_angles_allow(process, most):
    """The outline stays and the mesh stays a constrained Delaunay mesh of it."""
    fine, _ = process.run(GRAPH, FINE[PYTHONCDT])
    vertices, faces = process.run(GRAPH, FINE[PYTHONCDT]._replace(most=most))
    assert len(fine) > 100
    assert len(vertices) == most or (most == 4 and len(vertices) < 60)  # 4 would have too small angles
    assert {tuple(corner) for corner in SQUARE.tolist()} <= {tuple(vertex) for vertex in vertices.tolist()}
    mesh = TriMesh(vertices, faces)
    assert mesh.rest_areas.sum() == pytest.approx(1e4)
    assert angles(vertices, faces).min() >= 28
    opposite = {}
    for (i, j, k), of_face in zip(faces.tolist(), angles(vertices, faces), strict=True):
        for edge, angle in (((j, k), of_face[0]), ((k, i), of_face[1]), ((i, j), of_face[2])):
            opposite.setdefault(frozenset(edge), []).append(angle)
    assert max(sum(each) for each in opposite.values() if len(each) == 2) <= 180 + 1e-6
