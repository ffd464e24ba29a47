"""The Joints section of the side panel, and the joint tool on the canvas."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app import widgets
from akap_editor.app.canvas.rig_markers import are_shown
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.rig.suggestion import suggest_joints
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import SetJoints
from tests.support.puppets import ARM, BODY, SKULL, puppet

WITHOUT_JOINTS = "With the current method, joints carry only layers without pins."


@pytest.fixture
def rigged(ui):
    """The window with the puppet and its proposed joints."""
    drawing = puppet()
    document = new_document(drawing)
    ui.reset(document.with_state(SetJoints(suggest_joints(drawing)).apply(document.state, drawing)))
    return ui


def joints(ui):
    return ui.session.state.joints


def labels(ui):
    return ui.session.history.labels


def place(ui, joint):
    session = ui.session
    return ui.to_screen(tuple(joint.places(session.drawing.mesh, session.state.positions).mean(axis=0)))


def test_proposals_are_shown_accepted_and_cleared_in_one_step_each(rigged):
    count = len(joints(rigged))
    assert count == 2
    assert are_shown(rigged.state)
    rigged.panel("###Accept Proposed")
    assert not any(joint.is_proposed for joint in joints(rigged))
    assert not are_shown(rigged.state)
    rigged.session.undo()
    assert all(joint.is_proposed for joint in joints(rigged))
    rigged.panel("###Clear Proposed")
    assert joints(rigged) == ()
    rigged.panel("###Propose Joints")
    assert len(joints(rigged)) == count
    assert labels(rigged) == ["Clear Proposed Joints", "Propose Joints"]


def test_a_method_without_joints_says_so(rigged, monkeypatch):
    said, draw = set(), widgets.secondary_text
    monkeypatch.setattr(widgets, "secondary_text", lambda text: (said.add(text), draw(text)))
    rigged.settle()
    assert WITHOUT_JOINTS not in said
    rigged.state.change_settings(Settings("arap", ()))
    rigged.settle()
    assert WITHOUT_JOINTS in said


def test_kind_and_removal_of_the_selected_joint(rigged):
    joint = joints(rigged)[0]
    rigged.do(lambda hand: hand.item_click(f"//Panel/**/###joint {joint.id}"))
    assert rigged.editor.joint_tool.selected == joint.id

    def choose(combo, index):
        def run(hand):
            hand.set_ref("//Panel")
            hand.combo_click(f"##{combo}/{index}")

        rigged.do(run)

    choose("joint kind", "Weld")
    assert joints(rigged)[0].kind == "weld"
    assert not joints(rigged)[0].is_proposed
    rigged.panel("###Remove Joint")
    assert joint.id not in {each.id for each in joints(rigged)}
    assert labels(rigged) == ["Make Weld", "Remove Joint"]


def test_the_joint_tool_adds_moves_and_removes_joints(rigged):
    editor = rigged.editor
    rigged.panel("###Clear Proposed")
    editor.chosen_tool = editor.joint_tool
    rigged.click(rigged.to_screen((92.0, 118.0)))
    (joint,) = joints(rigged)
    assert joint.layers(rigged.session.drawing.mesh) == (ARM, BODY)
    assert editor.joint_tool.selected == joint.id
    for press in (rigged.click, lambda start: rigged.drag(start, (start[0] - 6, start[1]))):
        editor.joint_tool.selected = None
        press(place(rigged, joint))
        assert editor.joint_tool.selected == joint.id
    start = place(rigged, joint)
    rigged.drag(start, (start[0] - 6, start[1]), rigged.to_screen((88.0, 119.0)))
    moved = place(rigged, joints(rigged)[0])
    assert moved == pytest.approx(rigged.to_screen((88.0, 119.0)), abs=1.5)
    rigged.drag(place(rigged, joints(rigged)[0]), held=imgui.Key.mod_alt)
    assert joints(rigged) == ()
    assert labels(rigged)[-3:] == ["Move Joint", "Move Joint", "Remove Joint"]
    rigged.click(rigged.to_screen((66.0, 165.0)))  # one layer only
    assert joints(rigged) == ()


def test_a_new_parent_keeps_the_place(rigged):
    joint = next(j for j in joints(rigged) if j.layers(rigged.session.drawing.mesh)[0] == ARM)
    before = place(rigged, joint)
    gestures.hang_joint(rigged.editor, joint.id, SKULL)
    after = next(each for each in joints(rigged) if each.id == joint.id)
    assert after.layers(rigged.session.drawing.mesh) == (ARM, SKULL)
    mesh = rigged.session.drawing.mesh
    assert rigged.to_screen(tuple(after.places(mesh, mesh.vertices)[0])) == pytest.approx(before, abs=1.5)
