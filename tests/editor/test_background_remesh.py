"""Meshes that are made while the user goes on."""

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.background_remesh import BackgroundRemesh
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Meshing, make_drawing
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.edits import SetTargets
from akap_editor.errors import InputError


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


def test_a_series_of_choices_is_one_entry_made_from_where_it_began(editor):
    """Coarse in between: nothing of that is left in the result."""
    session, remesher = editor.session, BackgroundRemesh(editor)
    session.begin("Bend")
    session.apply(SetTargets({3: (150.0, 100.0)}))
    session.settle()
    session.commit()
    before, depth = session.state, session.history.depth
    for vertices in (600, 30, 900):
        remesher.want(Meshing(vertices), held=True)
        assert remesher.meshing.vertices == vertices
        remesher.finish()
    remesher.let_go()
    assert session.history.depth == depth + 1
    assert session.drawing.meshing == Meshing(900)
    once = BackgroundRemesh(editor)
    found = session.state.positions
    session.undo()
    assert session.state is before
    once.want(Meshing(900))
    once.finish()
    assert session.state.positions.tolist() == found.tolist()


def test_only_the_last_of_many_choices_counts(editor):
    remesher = BackgroundRemesh(editor)
    for vertices in range(200, 400, 5):
        remesher.want(Meshing(vertices), held=True)
        remesher.advance()
    remesher.finish()
    assert editor.session.drawing.meshing == Meshing(395)
    assert not remesher.busy
    assert remesher.active
    remesher.let_go()
    assert not remesher.active


def test_choices_of_two_gestures_are_two_entries(editor):
    remesher, depth = BackgroundRemesh(editor), editor.session.history.depth
    remesher.want(Meshing(300))
    remesher.finish()
    remesher.want(Meshing(500))
    remesher.finish()
    assert editor.session.history.depth == depth + 2


def test_a_choice_made_before_the_last_is_there_is_not_lost(editor):
    remesher = BackgroundRemesh(editor)
    remesher.want(Meshing(300))
    remesher.advance()
    remesher.want(Meshing(remesher.meshing.vertices, 5.0))
    remesher.finish()
    assert editor.session.drawing.meshing == Meshing(300, 5.0)


def test_what_was_done_meanwhile_stays(editor):
    remesher = BackgroundRemesh(editor)
    remesher.want(Meshing(300))
    remesher.advance()
    gestures.add_pin(editor, (65.0, 60.0))
    remesher.finish()
    assert len(editor.session.state.pins) == 4
    assert editor.session.drawing.meshing == Meshing(300)
    editor.undo()
    assert len(editor.session.state.pins) == 4


def test_it_waits_for_a_gesture_to_end(editor):
    remesher = BackgroundRemesh(editor)
    remesher.want(Meshing(300))
    remesher.advance()
    editor.session.begin("Bend")
    remesher._job[2].result()
    assert not remesher.advance()
    editor.session.abort()
    assert remesher.advance()


def test_another_drawing_ends_it(editor):
    remesher = BackgroundRemesh(editor)
    remesher.want(Meshing(300))
    remesher.advance()
    other = new_document(make_drawing(np.full((30, 40, 4), 255, np.uint8), vertices=30))
    editor.open(other)
    remesher.finish()
    assert editor.session.document.drawing is other.drawing
    editor.close()
    assert remesher.meshing is None
    remesher.want(Meshing(100))
    assert not remesher.busy


def test_what_cannot_be_made_is_said_and_changes_nothing(editor):
    remesher, state = BackgroundRemesh(editor), editor.session.state
    remesher.want(Meshing(300, threshold=1.5))
    with pytest.raises(InputError, match=r"threshold: expected a share between 0 and 1, got 1\.5"):
        remesher.finish()
    assert editor.session.state is state
    assert not remesher.busy
