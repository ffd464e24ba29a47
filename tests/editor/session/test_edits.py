"""Every edit in the table: a value that is applied, undone, redone, recorded and replayed."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import Drawing, Meshing, make_drawing
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.editor.document.rig.joint import make_joint
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import (
    EDITS,
    AddPose,
    Edit,
    KeyLayers,
    OrderLayers,
    PaintLoose,
    Remesh,
    RenamePose,
    ReorderPoses,
    ReplayTarget,
    SetJoints,
    SetKeyframe,
    SetLayers,
    SetPins,
    SetPose,
    SetSettings,
    SetTargets,
)
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import Replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.io.akap.project import decode_document, encode_document
from akap_editor.io.images import Picture
from akap_editor.meshing.meshers import MESHERS, PYTHONCDT, TRIANGLE
from tests.support.edit_examples import EDIT_EXAMPLES, LAYER_EDITS
from tests.support.editor_driver import Ticks, bits, replayed_state
from tests.support.meshers import EACH_MESHER, pretend_installed
from tests.support.puppets import puppet

CASES = {**EDIT_EXAMPLES, "another method": lambda _: SetSettings(Settings.parse("arap:iterations=3"))}
ONE_MESH = {"stiffness", "loose", "pose", "crossings"}  # edits with arrays that belong to vertices or faces


@pytest.fixture
def drawing(drawing: Drawing, request: pytest.FixtureRequest) -> Drawing:
    """The figure; for edits of layers the puppet."""
    callspec = getattr(request.node, "callspec", None)
    return puppet(150) if callspec and callspec.params.get("name") in LAYER_EDITS else drawing


@pytest.fixture
def finer(drawing: Drawing, image: Picture) -> Drawing:
    """The same drawing with another mesh."""
    return puppet(300) if drawing.layers else make_drawing(image, vertices=400, name="figure")


def folded_session(drawing: Drawing) -> Session:
    """A drawing folded over itself, with two pins, two named poses, two keyframes and a loose end."""
    session = Session(new_document(drawing), Ticks())
    session.begin("Add pins")
    add_pin(session, (80.0, 150.0) if drawing.layers else (20.0, 40.0))
    add_pin(session, (150.0, 118.0) if drawing.layers else (105.0, 40.0))
    session.apply(AddPose("bow"))
    session.apply(SetKeyframe(0.0))
    session.apply(SetTargets({2: (35.0, 48.0)}))
    session.settle()
    session.apply(AddPose("nod off"))
    session.apply(SetKeyframe(1.0))
    session.apply(PaintLoose([(150.0, 118.0) if drawing.layers else (105.0, 40.0)], 9.0))
    session.commit()
    assert drawing.layers or len(session.state.crossings)
    return session


unchanged_session = cache(folded_session)  # for tests that only look at it


@pytest.fixture
def session(drawing: Drawing) -> Session:
    return folded_session(drawing)


@pytest.fixture
def edit(session: Session, name: str) -> Edit:
    return CASES[name](session)


def apply_in_gesture(session: Session, edit: Edit) -> EditState:
    """Apply an edit in a gesture of its own, and settle; returns the state after it."""
    session.begin("Edit")
    session.apply(edit)
    session.settle()
    session.commit()
    return session.state


def test_the_table_holds_every_edit_and_the_examples_cover_it():
    assert set(EDIT_EXAMPLES) == set(EDITS)
    for name, edit in EDITS.items():
        assert edit.name == name

    def concrete_edits(edit: type[Edit]) -> set[type[Edit]]:
        below = {each for child in edit.__subclasses__() for each in concrete_edits(child)}
        return below or {edit}

    assert concrete_edits(Edit) == set(EDITS.values())


@pytest.mark.parametrize("name", CASES)
def test_an_edit_is_applied_without_changing_its_arguments(drawing, name):
    session = unchanged_session(drawing)
    edit, state, before = CASES[name](session), session.state, bits(session.state)
    after = edit.apply(state, session.drawing)
    assert bits(state) == before
    assert bits(after) != before
    assert bits(edit.apply(state, session.drawing)) == bits(after)


@pytest.mark.parametrize("name", CASES)
def test_json_there_and_back_gives_the_same_edit(drawing, name):
    session = unchanged_session(drawing)
    edit = CASES[name](session)
    after = edit.apply(session.state, session.drawing)
    edited = after.drawing or session.drawing
    event = json.loads(json.dumps(edit.to_json(edited)))
    assert set(edit.fields) <= set(event)
    target = ReplayTarget(session.drawing.mesh, True, 1.0)
    again = type(edit).from_json(event, target, session.drawing)
    assert again.to_json(drawing) == edit.to_json(edited)
    assert bits(again.apply(session.state, session.drawing)) == bits(after)


@pytest.mark.parametrize("name", CASES)
def test_undo_and_redo_are_exact_and_a_replay_on_the_same_mesh_gives_the_same_bits(session, edit, drawing):
    before = session.state
    after = apply_in_gesture(session, edit)
    assert after is not before
    session.undo()
    assert session.state is before
    session.redo()
    assert session.state is after
    assert bits(replayed_state(session.recording, drawing)) == bits(session.state)


@pytest.mark.parametrize("name", sorted(set(CASES) - ONE_MESH))
def test_a_replay_on_another_mesh_does_the_same(session, edit, finer):
    apply_in_gesture(session, edit)
    state, expected = replayed_state(session.recording, finer), session.state
    assert [pin.id for pin in state.pins] == [pin.id for pin in expected.pins]
    np.testing.assert_allclose(state.targets, expected.targets, atol=1.0)
    assert [pose.name for pose in state.poses] == [pose.name for pose in expected.poses]
    assert state.animation.times == expected.animation.times
    assert (state.animation.ease, state.animation.loop) == (expected.animation.ease, expected.animation.loop)
    eases = [[key.ease for key in each.animation.keyframes] for each in (state, expected)]
    assert eases[0] == eases[1]
    assert state.settings == expected.settings
    assert (state.stiffness is None) == (expected.stiffness is None)
    assert (state.drawing is None) == (expected.drawing is None)
    if expected.drawing is not None:
        assert state.drawing.layer_order == expected.drawing.layer_order
        names = [[layer.name for layer in each.drawing.layers] for each in (state, expected)]
        assert names[0] == names[1]


@pytest.mark.parametrize("name", sorted(ONE_MESH))
def test_arrays_of_one_mesh_are_refused_on_another(session, edit, finer):
    apply_in_gesture(session, edit)
    with pytest.raises(InputError, match=r"fits? only the mesh that"):
        replayed_state(session.recording, finer)


@pytest.mark.parametrize("name", ["reset", "bake"])
def test_an_edit_that_changes_nothing_is_not_recorded(drawing, name):
    session = Session(new_document(drawing), Ticks())
    session.begin("Nothing")
    count = len(session.recording.events)
    session.apply(EDIT_EXAMPLES[name](session))
    assert len(session.recording.events) == count
    session.commit()
    assert session.history.undo_label is None


@pytest.mark.parametrize(
    "edit",
    [
        RenamePose("bow", "nod off"),
        RenamePose("no such pose", "d"),
        RenamePose("bow", " "),
        ReorderPoses(["nod off"]),
        ReorderPoses(["bow", "bow"]),
    ],
)
def test_pose_names_that_do_not_fit_are_refused(session, edit):
    before = bits(session.state)
    session.begin("Edit")
    with pytest.raises(InputError, match="pose"):
        session.apply(edit)
    assert bits(session.state) == before


def test_a_prepared_mesh_is_taken_over(session):
    drawing = remesh_drawing(session.drawing, replace(session.drawing.meshing or Meshing(), vertices=200))
    apply_in_gesture(session, Remesh.from_drawing(drawing))
    assert session.drawing is drawing


@pytest.mark.parametrize("mesher", EACH_MESHER)
def test_a_recorded_mesh_is_made_by_the_same_mesher_again(session, drawing, mesher, monkeypatch):
    """Whichever is the default one there."""
    apply_in_gesture(session, Remesh(replace(drawing.meshing, vertices=200, mesher=mesher)))
    for order in (tuple(MESHERS), tuple(MESHERS)[::-1]):
        pretend_installed(monkeypatch, *order)
        assert bits(replayed_state(session.recording, drawing)) == bits(session.state)


def test_a_mesh_recorded_before_there_was_a_choice_is_one_of_triangle(session, drawing):
    apply_in_gesture(session, Remesh(replace(drawing.meshing, vertices=200, mesher=TRIANGLE)))
    recording = parse_recording(session.recording.to_text())
    for event in recording.events:
        event.pop("mesher", None)
    assert bits(replayed_state(recording, drawing)) == bits(session.state)


def test_without_the_recorded_mesher_pins_are_where_they_were(session, drawing, monkeypatch):
    apply_in_gesture(session, Remesh(replace(drawing.meshing, vertices=200, mesher=TRIANGLE)))
    session.begin("Add pin")
    add_pin(session, (62.0, 40.0))
    session.commit()
    expected, rest = (
        session.state,
        session.drawing.mesh.evaluate(session.state.points, session.drawing.mesh.vertices),
    )
    pretend_installed(monkeypatch, PYTHONCDT)
    state = replayed_state(session.recording, drawing)
    mesh = state.drawing.mesh
    assert state.drawing.meshing.mesher == PYTHONCDT
    assert [pin.id for pin in state.pins] == [pin.id for pin in expected.pins]
    np.testing.assert_allclose(mesh.evaluate(state.points, mesh.vertices), rest, atol=1e-6)


def test_without_the_recorded_mesher_arrays_of_its_mesh_are_refused(session, drawing, monkeypatch):
    apply_in_gesture(session, Remesh(replace(drawing.meshing, vertices=200, mesher=TRIANGLE)))
    apply_in_gesture(session, SetPose(session.state.positions + 1.0))
    pretend_installed(monkeypatch, PYTHONCDT)
    with pytest.raises(InputError, match=r"recording line \d+: .*a pose fits only the mesh that"):
        replayed_state(session.recording, drawing)


def test_pins_set_while_the_drawing_moves_are_fixed_at_the_pose(session):
    session.begin("Drag Pin")
    session.apply(SetTargets({2: (60.0, 75.0)}))
    session.step()
    positions = session.pin_positions()
    session.apply(SetPins(session.state.pins))
    np.testing.assert_array_equal(session.state.targets, positions)
    assert not session.is_moving


JUNK = [None, True, -1, 2**53, 10**400, 0.5, 1e155, "", "x" * 5000, "\ud800", [], [[]], [1e9, 1e9, 1e9], {}]


def broken_events(event):
    """The event with one of its values, or the first value inside one, replaced by each of `JUNK`."""
    for key, value in event.items():
        for junk in JUNK:
            yield {**event, key: junk}
            if isinstance(value, list) and value:
                yield {**event, key: [junk, *value[1:]]}
            if isinstance(value, dict) and value:
                first = next(iter(value))
                yield {**event, key: {**value, first: junk}}
            if isinstance(value, list) and value and isinstance(value[0], dict):
                for inner in value[0]:
                    yield {**event, key: [{**value[0], inner: junk}, *value[1:]]}


@pytest.mark.parametrize("name", EDIT_EXAMPLES)
def test_a_recorded_edit_with_any_bad_value_is_refused_or_leaves_what_can_be_saved(drawing, name):
    session = Session(new_document(drawing), Ticks())
    session.begin("Add pin")
    add_pin(session, (20.0, 40.0))
    for edit in (AddPose("bow"), AddPose("nod"), SetKeyframe(0.0), SetKeyframe(1.0)):
        session.apply(edit)
    session.commit()
    opening = Session(session.document, Ticks()).recording.to_text()
    opening += json.dumps({"t": 9, "do": "begin", "label": "Edit"}) + "\n"
    recorded = EDIT_EXAMPLES[name](session).to_json(drawing)
    messages = []
    for event in broken_events(recorded):
        try:
            replayed = Replay(parse_recording(opening + json.dumps({"t": 9, "do": name, **event})), drawing)
            for _ in replayed.events():
                pass
        except InputError as error:
            messages.append(str(error))
        else:
            encoded = encode_document(replayed.session.present_document)
            assert encode_document(decode_document(encoded)) == encoded
    assert messages or not recorded
    assert all(len(message) < 400 and "\n" not in message for message in messages)


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (SetLayers([5], visible=False), "layers: expected numbers from 0 to 4, got 5"),
        (SetLayers([True], visible=False), "layers: expected numbers from 0 to 4, got True"),
        (SetLayers([0], opacity=1.5), "opacity: expected a number from 0 to 1"),
        (SetLayers([0], " "), "name: expected a name of 1 to 255 characters"),
        (SetLayers([0], groups="head"), "group: expected the names of one around layers, got 'head'"),
        (SetLayers([0], groups=["head", ""]), "name: expected a name of 1 to 255 characters"),
        (SetLayers([0], groups=["a"] * 51), "expected groups in groups at most 50 deep"),
        (SetLayers([0], solo="yes"), "solo: expected True or False"),
        (OrderLayers([0, 1, 2, 3, 3]), "order: expected each of 5 layers once"),
        (OrderLayers([0, 1, 2]), "order: expected each of 5 layers once"),
    ],
)
def test_values_of_layers_that_do_not_fit_are_refused(edit, message):
    session = Session(new_document(puppet(150)), Ticks())
    before = session.state
    session.begin("Edit")
    with pytest.raises(InputError, match=message):
        session.apply(edit)
    assert session.state is before


def test_a_drawing_without_layers_has_none_to_change(drawing):
    for edit in (SetLayers([0], visible=False), OrderLayers([0])):
        session = Session(new_document(drawing), Ticks())
        session.begin("Edit")
        with pytest.raises(InputError, match="layers"):
            session.apply(edit)


def test_the_layer_list_changes_while_the_drawing_moves():
    session = Session(new_document(puppet(150)), Ticks())
    session.begin("Bend")
    for place in ((80.0, 150.0), (80.0, 40.0)):
        add_pin(session, place)
    session.apply(SetTargets({2: (95.0, 30.0)}))
    session.step()
    session.apply(SetLayers([2], visible=False))
    assert session.is_moving
    session.settle()
    assert session.pin_error() < 0.25


def test_joints_that_do_not_fit_are_refused():
    drawing = puppet(150)
    good = make_joint(drawing.mesh, 1, 1, 0, np.array([92.0, 118.0]))
    cases = {
        "expected each joint once": (good, good),
        "expected points on two layers": (replace(good, faces=(good.faces[0], good.faces[0])),),
        "expected faces from 0": (replace(good, faces=(0, 10**6)),),
        "weights from 0 to 1": (replace(good, weights=2 * good.weights),),
    }
    for message, joints in cases.items():
        session = Session(new_document(drawing), Ticks())
        session.begin("Edit")
        with pytest.raises(InputError, match=message):
            session.apply(SetJoints(joints))
    with pytest.raises(InputError, match="kind"):
        replace(good, kind="spring")
    with pytest.raises(InputError, match="expected a layer of the drawing"):
        make_joint(drawing.mesh, 1, 9, 0, np.array([92.0, 118.0]))


def test_a_new_joint_closes_its_gap_at_once():
    drawing = puppet(150)
    session = Session(new_document(drawing), Ticks())
    session.begin("Bend")
    add_pin(session, (66.0, 160.0))
    add_pin(session, (80.0, 95.0))
    add_pin(session, (150.0, 118.0))
    session.apply(SetTargets({3: (155.0, 112.0)}))
    session.settle()
    joint = make_joint(drawing.mesh, 1, 1, 0, np.array([92.0, 118.0]))

    def gap():
        places = joint.places(drawing.mesh, session.state.positions)
        return np.abs(places[0] - places[1]).max()

    assert gap() > 3
    session.apply(SetJoints((joint,)))
    session.settle()
    assert gap() < 0.05


def shown(session):
    """The numbers of the layers whose eye is open, and those in each keyframe."""
    keys = [key.layers.visible for key in session.present.animation.keyframes]
    views = [session.drawing.layer_view.visible, *keys]
    return [[number for number, on in enumerate(view) if on] for view in views]


@pytest.mark.parametrize("name", ["layers"])
def test_a_slot_shows_one_of_its_layers_in_keyframes_too(session, name):
    assert shown(session) == [[0, 1, 2, 3]] * 3
    session.begin("Slot")
    session.apply(SetLayers([0, 1, 4], slot="mouth"))
    assert shown(session) == [[1, 2, 3]] * 3
    session.apply(SetLayers([4], visible=True))
    assert shown(session)[0] == [2, 3, 4]
    session.apply(SetKeyframe(0.5))
    session.apply(KeyLayers([0], True))
    assert shown(session) == [[0, 2, 3]] * 4
    session.commit()
    state = replayed_state(session.recording, puppet(150))
    assert bits(state) == bits(session.state)
    assert [layer.slot for layer in state.drawing.layers] == ["mouth", "mouth", "", "", "mouth"]
