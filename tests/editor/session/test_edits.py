"""Every edit in the table: a value that is applied, undone, redone, recorded and replayed."""

import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import Drawing, Meshing, make_drawing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import (
    EDITS,
    AddPose,
    DeleteKeyframes,
    DeletePose,
    Edit,
    MoveKeyframes,
    PaintStiffness,
    Remesh,
    RenamePose,
    ReorderPoses,
    ReplayTarget,
    ResetPose,
    SetAngles,
    SetEasing,
    SetKeyframe,
    SetLoop,
    SetPins,
    SetPose,
    SetRestPose,
    SetSettings,
    SetStiffness,
    SetTargets,
)
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from tests.support.editor_driver import Ticks, bits

# One edit of each kind for the state of `session`; some hold arrays of one mesh and do not fit another.
EXAMPLES: dict[str, Callable[[Session], Edit]] = {
    "pins": lambda session: SetPins(
        (replace(session.state.pins[0], depth=2), Pin(7, 5, [0.2, 0.3, 0.5], [60.0, 50.0], angle=0.5))
    ),
    "targets": lambda session: SetTargets({2: (90.0, 65.0)}),
    "angles": lambda session: SetAngles({1: 0.25}),
    "settings": lambda session: SetSettings(Settings.parse("arap:iterations=3")),
    "stiffness": lambda session: SetStiffness(np.linspace(1, 1000, len(session.drawing.mesh.faces))),
    "paint": lambda session: PaintStiffness([(45.0, 40.0), (50.0, 41.0)], 12.0, 50.0),
    "pose": lambda session: SetPose(session.state.positions + np.array([3.0, -2.0])),
    "reset": lambda session: ResetPose(),
    "bake": lambda session: SetRestPose(),
    "mesh": lambda session: Remesh(replace(session.drawing.meshing or Meshing(), vertices=200)),
    "keep": lambda session: AddPose("wave"),
    "forget": lambda session: DeletePose("bow"),
    "rename": lambda session: RenamePose("bow", "nod"),
    "order": lambda session: ReorderPoses(["nod off", "bow"]),
    "key": lambda session: SetKeyframe(0.5, ease="hold"),
    "unkey": lambda session: DeleteKeyframes([1.0]),
    "rekey": lambda session: MoveKeyframes({1.0: 2.0}, copy=True),
    "ease": lambda session: SetEasing([1.0], "out"),
    "loop": lambda session: SetLoop(False),
}
ONE_MESH = {"stiffness", "pose"}


def posed(drawing: Drawing) -> Session:
    """A bent drawing with two pins, two named poses and two keyframes."""
    session = Session(new_document(drawing), Ticks())
    session.begin("Add pins")
    add_pin(session, (20.0, 40.0))
    add_pin(session, (105.0, 40.0))
    session.apply(AddPose("bow"))
    session.apply(SetKeyframe(0.0))
    session.apply(SetTargets({2: (98.0, 52.0)}))
    session.settle()
    session.apply(AddPose("nod off"))
    session.apply(SetKeyframe(1.0))
    session.commit()
    return session


@pytest.fixture
def session(drawing: Drawing) -> Session:
    return posed(drawing)


@pytest.fixture
def edit(session: Session, name: str) -> Edit:
    return EXAMPLES[name](session)


def gesture(session: Session, edit: Edit) -> EditState:
    """Apply an edit in a gesture of its own, and settle; returns the state after it."""
    session.begin("Edit")
    session.apply(edit)
    session.settle()
    session.commit()
    return session.state


def everything(state: EditState) -> tuple[object, ...]:
    """What `bits` compares, and the mesh."""
    vertices = None if state.drawing is None else state.drawing.mesh.vertices.tobytes()
    return bits(state), vertices


def test_the_table_holds_every_edit_and_the_examples_cover_it():
    assert set(EXAMPLES) == set(EDITS)
    for name, edit in EDITS.items():
        assert edit.name == name

    def concrete(kind: type[Edit]) -> set[type[Edit]]:
        below = {each for child in kind.__subclasses__() for each in concrete(child)}
        return below or {kind}

    assert concrete(Edit) == set(EDITS.values())


@pytest.mark.parametrize("name", EDITS)
def test_an_edit_is_applied_without_changing_what_it_was_given(session, edit):
    state, before = session.state, everything(session.state)
    after = edit.apply(state, session.drawing)
    assert everything(state) == before
    assert everything(after) != before
    assert everything(edit.apply(state, session.drawing)) == everything(after)


@pytest.mark.parametrize("name", EDITS)
def test_json_there_and_back_gives_the_same_edit(session, edit):
    after = edit.apply(session.state, session.drawing)
    drawing = after.drawing or session.drawing
    event = json.loads(json.dumps(edit.to_json(drawing)))
    assert set(edit.fields) <= set(event)
    target = ReplayTarget(session.drawing.mesh, True, 1.0)
    again = type(edit).from_json(event, target, session.drawing)
    assert again.to_json(drawing) == edit.to_json(drawing)
    assert everything(again.apply(session.state, session.drawing)) == everything(after)


@pytest.mark.parametrize("name", EDITS)
def test_undo_and_redo_are_exact(session, edit):
    before = session.state
    after = gesture(session, edit)
    assert after is not before
    session.undo()
    assert session.state is before
    session.redo()
    assert session.state is after


@pytest.mark.parametrize("name", EDITS)
def test_a_replay_on_the_same_mesh_gives_the_same_bits(session, edit, drawing):
    gesture(session, edit)
    session.undo()
    session.redo()
    recording = parse_recording(session.recording.to_text())
    *_, last = replay(recording, drawing)
    assert everything(last.state) == everything(session.state)


@pytest.mark.parametrize("name", sorted(set(EDITS) - ONE_MESH))
def test_a_replay_on_another_mesh_does_the_same(session, edit, image):
    gesture(session, edit)
    finer = make_drawing(image, vertices=400, name="figure")
    *_, last = replay(session.recording, finer)
    state, expected = last.state, session.state
    assert [pin.id for pin in state.pins] == [pin.id for pin in expected.pins]
    np.testing.assert_allclose(state.targets, expected.targets, atol=1.0)
    assert [pose.name for pose in state.poses] == [pose.name for pose in expected.poses]
    assert state.animation.times == expected.animation.times
    assert (state.animation.ease, state.animation.loop) == (expected.animation.ease, expected.animation.loop)
    assert [key.ease for key in state.animation.keyframes] == [
        key.ease for key in expected.animation.keyframes
    ]
    assert state.settings == expected.settings
    assert (state.stiffness is None) == (expected.stiffness is None)
    assert (state.drawing is None) == (expected.drawing is None)


@pytest.mark.parametrize("name", sorted(ONE_MESH))
def test_arrays_of_one_mesh_are_refused_on_another(session, edit, image):
    gesture(session, edit)
    with pytest.raises(InputError, match="fits only the mesh that it was made on"):
        list(replay(session.recording, make_drawing(image, vertices=400, name="figure")))


@pytest.mark.parametrize("name", ["reset", "bake"])
def test_an_edit_that_changes_nothing_is_not_recorded(drawing, name):
    session = Session(new_document(drawing), Ticks())
    session.begin("Nothing")
    count = len(session.recording.events)
    session.apply(EXAMPLES[name](session))
    assert len(session.recording.events) == count
    session.commit()
    assert session.history.undo_label is None


def test_a_mesh_that_was_made_before_is_taken_over(session):
    made = remesh_drawing(session.drawing, replace(session.drawing.meshing or Meshing(), vertices=200))
    gesture(session, Remesh.to(made))
    assert session.drawing is made


def test_fixed_at_pose_keeps_pins_of_a_moving_drawing_where_they_are(session):
    session.begin("Bend")
    session.apply(SetTargets({2: (60.0, 75.0)}))
    session.step()
    here = session.pin_positions()
    session.apply(SetPins(session.state.pins))
    np.testing.assert_array_equal(session.state.targets, here)
    assert not session.is_moving
