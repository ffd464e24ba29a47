"""Triangle in a child process: one child for many jobs, crashes and time-outs are errors of one job only."""

from collections.abc import Iterator

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.meshing.triangle_process import TriangleProcess

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
GRAPH = {
    "vertices": SQUARE,
    "segments": np.array([[0, 1], [1, 2], [2, 3], [3, 0]], dtype=np.int32),
    "holes": np.zeros((0, 2)),
}
SWITCHES = "pq28a50"


@pytest.fixture
def process() -> Iterator[TriangleProcess]:
    """A child process that only the test uses."""
    process = TriangleProcess()
    yield process
    process.close()


def test_one_child_answers_one_job_after_another(process):
    child = process.start()
    first, faces = process.run(GRAPH, SWITCHES)
    second, _ = process.run(GRAPH, SWITCHES)
    assert process.start() is child
    assert child.poll() is None
    assert first.tolist() == second.tolist()
    assert faces.shape[1] == 3
    assert len(faces) > 100


@pytest.mark.parametrize(
    ("change", "switches"),
    [({"vertices": SQUARE[:0]}, SWITCHES), ({}, "a0.000")],
    ids=["no vertices", "area of zero"],
)
def test_crash_is_an_input_error_and_the_next_job_works(process, change, switches):
    with pytest.raises(InputError, match="cannot be triangulated: Triangle stopped without an answer"):
        process.run({**GRAPH, **change}, switches)
    assert len(process.run(GRAPH, SWITCHES)[1])


def test_time_out_is_an_input_error_and_the_next_job_works(process):
    with pytest.raises(InputError, match=r"cannot be triangulated: Triangle took longer than 0\.0001 s"):
        process.run(GRAPH, "pq28a0.001", limit=0.0001)
    assert len(process.run(GRAPH, SWITCHES)[1])


def test_killed_child_is_replaced(process):
    process.run(GRAPH, SWITCHES)
    child = process.start()
    child.kill()
    child.wait()
    assert len(process.run(GRAPH, SWITCHES)[1])


def test_child_that_dies_as_the_job_is_sent(process, monkeypatch):
    dead = process.start()
    dead.kill()
    dead.wait()
    with monkeypatch.context() as patch:
        patch.setattr(process, "start", lambda: dead)
        with pytest.raises(InputError, match="Triangle stopped without an answer"):
            process.run(GRAPH, SWITCHES)
    assert len(process.run(GRAPH, SWITCHES)[1])


def test_closing_ends_the_child(process):
    child = process.start()
    process.close()
    assert child.poll() is not None
    process.close()
    assert len(process.run(GRAPH, SWITCHES)[1])


@pytest.mark.parametrize("change", [{"segments": GRAPH["segments"] + 7}, {"vertices": SQUARE * [1, 0]}])
def test_no_faces_are_an_input_error(process, change):
    with pytest.raises(InputError, match="cannot be triangulated: Triangle returned no faces"):
        process.run({**GRAPH, **change}, SWITCHES)


def test_coordinates_that_are_not_finite_are_refused(process):
    with pytest.raises(InputError, match="outlines: expected finite coordinates"):
        process.run({**GRAPH, "vertices": SQUARE * np.nan}, SWITCHES)
