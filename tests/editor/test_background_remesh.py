"""Meshes that are made in a thread while the user moves the sliders."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.background_remesh import BackgroundRemesh
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Meshing, make_drawing
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.stepper import INLINE
from akap_editor.errors import InputError
from akap_editor.progress import Cancelled
from tests.support.executors import HeldExecutor


@pytest.fixture
def editor():
    """A pinned bar."""
    image = np.zeros((120, 200, 4), np.uint8)
    image[40:80, 20:180] = [200, 40, 30, 255]
    result = Editor()
    result.open(new_document(make_drawing(image, vertices=150)))
    for at in [(30.0, 60.0), (100.0, 60.0), (170.0, 60.0)]:
        gestures.add_pin(result, at)
    return result


@pytest.fixture(params=["inline", "thread"])
def remesher(editor, request):
    if request.param == "inline":
        yield BackgroundRemesh(editor, INLINE)
        return
    with ThreadPoolExecutor(1) as thread:
        yield BackgroundRemesh(editor, thread)


@pytest.fixture
def thread():
    """Makes a mesh when `work` is called."""
    return HeldExecutor()


@pytest.fixture
def held(editor, thread):
    return BackgroundRemesh(editor, thread)


def test_the_values_of_one_gesture_are_one_entry_made_from_where_it_began(editor, remesher):
    """Coarse in between: nothing of that is left in the result."""
    session = editor.session
    session.begin("Drag Pin")
    session.apply(SetTargets({3: (150.0, 100.0)}))
    session.settle()
    session.commit()
    before, depth = session.state, session.history.depth
    for vertices in (600, 30, 900):
        remesher.request(Meshing(vertices), dragging=True)
        assert remesher.meshing.vertices == vertices
        remesher.finish()
    remesher.end_drag()
    assert session.history.depth == depth + 1
    assert session.drawing.meshing == Meshing(900)
    positions = session.state.positions
    session.undo()
    assert session.state is before
    once = BackgroundRemesh(editor)
    once.request(Meshing(900))
    once.finish()
    assert session.state.positions.tolist() == positions.tolist()


def test_only_the_last_of_many_requests_is_made(editor, held, thread):
    for vertices in range(200, 400, 5):
        held.request(Meshing(vertices), dragging=True)
        held.advance()
    thread.work()
    held.advance()
    assert editor.session.drawing.meshing == Meshing(200)
    thread.work()
    held.advance()
    assert editor.session.drawing.meshing == Meshing(395)
    assert thread.count == 2
    assert not held.is_busy
    assert held.is_active
    held.end_drag()
    assert not held.is_active


def test_two_gestures_are_two_entries(editor, remesher):
    depth = editor.session.history.depth
    remesher.request(Meshing(300))
    remesher.finish()
    remesher.request(Meshing(500))
    remesher.finish()
    assert editor.session.history.depth == depth + 2


def test_a_gesture_includes_the_request_of_one_that_is_not_made_yet(editor, held, thread):
    held.request(Meshing(300))
    held.advance()
    held.request(Meshing(held.meshing.vertices, 5.0))
    while held.is_busy:
        thread.work()
        held.advance()
    assert editor.session.drawing.meshing == Meshing(300, 5.0)


def test_edits_made_meanwhile_stay(editor, held, thread):
    held.request(Meshing(300))
    held.advance()
    gestures.add_pin(editor, (65.0, 60.0))
    thread.work()
    assert held.advance()
    assert len(editor.session.state.pins) == 4
    assert editor.session.drawing.meshing == Meshing(300)
    editor.undo()
    assert len(editor.session.state.pins) == 4


def test_a_mesh_waits_for_a_gesture_of_the_editor_to_end(editor, held, thread):
    held.request(Meshing(300))
    held.advance()
    editor.session.begin("Drag Pin")
    thread.work()
    assert not held.advance()
    editor.session.abort()
    assert held.advance()


def test_another_drawing_cancels_the_request(editor, held, thread):
    held.request(Meshing(300))
    held.advance()
    other = new_document(make_drawing(np.full((30, 40, 4), 255, np.uint8), vertices=30))
    editor.open(other)
    thread.work()
    held.finish()
    assert editor.session.document.drawing is other.drawing
    editor.close()
    assert held.meshing is None
    held.request(Meshing(100))
    assert not held.is_busy


def test_a_mesh_that_cannot_be_made_is_an_error_and_changes_nothing(editor, remesher):
    state = editor.session.state
    remesher.request(Meshing(300, threshold=1.5))
    with pytest.raises(InputError, match=r"threshold: expected a number from 0 to 1, got 1\.5"):
        remesher.finish()
    assert editor.session.state is state
    assert not remesher.is_busy


def test_a_cancelled_mesh_is_never_shown_and_those_before_it_are_undone(editor, held, thread):
    before = editor.session.state
    held.request(Meshing(300), dragging=True)
    held.advance()
    thread.work()
    held.advance()
    assert editor.session.state is not before
    held.request(Meshing(600), dragging=True)
    held.advance()
    held.cancel()
    assert not held.is_active
    assert editor.session.state is before
    thread.work()
    assert isinstance(thread.last.exception(), Cancelled), "it ended at its first stage"
    assert not held.advance()
    assert editor.session.state is before


def test_progress_grows_while_a_mesh_is_made(editor):
    heard = []
    remesher = BackgroundRemesh(editor, INLINE, lambda: heard.append(remesher.progress))
    remesher.request(Meshing(300))
    remesher.finish()
    shares = [share for share, _ in heard]
    assert shares == sorted(shares)
    assert len({text for _, text in heard}) > 2
