"""The Joints section: a list of the joints with their layers, proposals, kind and parent."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ....deform.methods import get_method
from ....editor import gestures
from ....editor.document.rig.joint import KINDS, Joint
from ....editor.document.rig.suggestion import suggest_joints
from ....words import mark, tr
from ... import widgets
from ...app_state import AppState
from ...commands.command import Command
from ...theme import SECONDARY
from .. import parts

_ROWS = 5  # joints that are visible at once
_KIND_LABELS = {"hinge": mark("Hinge"), "weld": mark("Weld")}


def joint_count(state: AppState) -> str:
    """The number of joints for the section's title; empty if there are none."""
    return str(len(state.document.state.joints) or "") if state.document is not None else ""


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    assert state.document is not None
    joints = state.document.state.joints
    if joints and not get_method(state.document.state.settings.method).deformer.takes_joints:
        widgets.secondary_text(tr("With the current method, joints carry only layers without pins."))
    parts.begin_list("##joints", _ROWS)
    if not joints:
        widgets.secondary_text(tr("None. With the joint tool, click where two layers overlap."))
    for index, joint in enumerate(joints):
        _draw_row(state, joint, index)
    parts.end_list()
    selected = next((joint for joint in joints if joint.id == state.editor.joint_tool.selected), None)
    imgui.begin_disabled(selected is None)
    _draw_values(state, selected)
    imgui.end_disabled()
    _draw_buttons(state, selected)


def _names(state: AppState, joint: Joint) -> tuple[str, str]:
    assert state.document is not None
    drawing = state.document.drawing
    limb, carrier = joint.layers(drawing.mesh)
    return drawing.layers[limb].name, drawing.layers[carrier].name


def _draw_row(state: AppState, joint: Joint, index: int) -> None:
    limb, carrier = _names(state, joint)
    is_selected = joint.id == state.editor.joint_tool.selected
    text = f"{limb}  {icons.ICON_FA_ARROW_RIGHT}  {carrier}"
    label = widgets.shortened(widgets.as_label(text), imgui.get_content_region_avail().x)
    if joint.is_proposed:
        imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
    if imgui.selectable(f"{label}###joint {joint.id}", is_selected)[0]:
        state.editor.joint_tool.selected = joint.id
    if joint.is_proposed:
        imgui.pop_style_color()
    is_weld = joint.kind == "weld"
    hangs = (
        mark("“{limb}” hangs on “{carrier}” by a weld.")
        if is_weld
        else mark("“{limb}” hangs on “{carrier}” by a hinge.")
    )
    proposed = tr("Proposed: it holds already; accept, move or remove it.") if joint.is_proposed else ""
    widgets.show_tooltip(f"{tr(hangs, limb=limb, carrier=carrier)} {proposed}".strip())
    if is_selected:
        parts.scroll_to_row(index, _ROWS)


def _draw_values(state: AppState, joint: Joint | None) -> None:
    """Draw kind and parent of the selected joint."""
    assert state.document is not None
    drawing = state.document.drawing
    width = widgets.label_column(tr("Kind"), tr("Parent"))
    widgets.label(tr("Kind"), width)
    imgui.set_next_item_width(widgets.FULL)
    kind = 0 if joint is None else KINDS.index(joint.kind)
    is_changed, kind = widgets.combo("##joint kind", kind, [tr(_KIND_LABELS[each]) for each in KINDS])
    if is_changed and joint is not None:
        state.run_reporting_errors(lambda: gestures.set_joint_kind(state.editor, joint.id, KINDS[kind]))
    widgets.label(tr("Parent"), width)
    imgui.set_next_item_width(widgets.FULL)
    limb, carrier = (-1, -1) if joint is None else joint.layers(drawing.mesh)
    others = [number for number in reversed(drawing.layer_order) if number != limb]
    names = [widgets.as_label(drawing.layers[number].name) for number in others]
    current = others.index(carrier) if carrier in others else -1
    is_changed, current = widgets.combo("##joint parent", current, names)
    if is_changed and joint is not None:
        state.run_reporting_errors(lambda: gestures.hang_joint(state.editor, joint.id, others[current]))


def _draw_buttons(state: AppState, selected: Joint | None) -> None:
    """Draw the buttons: remove the selected joint, accept or clear proposals, or propose joints anew."""
    editor = state.editor
    gap = imgui.get_style().item_spacing.x
    half = ImVec2((imgui.get_content_region_avail().x - gap) / 2, 0)
    imgui.begin_disabled(not _has_proposals(state))
    if imgui.button(tr("Accept") + "###Accept Proposed", half):
        widgets.run(state, ACCEPT_JOINTS)
    widgets.show_tooltip(tr("Keeps the proposed joints."))
    imgui.same_line()
    if imgui.button(tr("Reject") + "###Clear Proposed", half):
        state.run_reporting_errors(lambda: gestures.clear_proposed_joints(editor))
    widgets.show_tooltip(tr("Removes the joints that are proposed and not accepted."))
    imgui.end_disabled()
    imgui.begin_disabled(selected is None)
    if imgui.button(tr("Remove") + "###Remove Joint", half) and selected is not None:
        state.run_reporting_errors(lambda: gestures.remove_joints(editor, {selected.id}))
    imgui.end_disabled()
    imgui.same_line()
    if imgui.button(tr("Propose") + "###Propose Joints", half):
        widgets.run(state, PROPOSE_JOINTS)
    widgets.show_tooltip(tr("Replaces all joints by proposals, from how the layers overlap and their names."))


def _propose(state: AppState) -> None:
    assert state.document is not None
    gestures.set_joints(state.editor, mark("Propose Joints"), suggest_joints(state.document.drawing))


def _has_proposals(state: AppState) -> bool:
    return state.document is not None and any(joint.is_proposed for joint in state.document.state.joints)


def _has_layers(state: AppState) -> bool:
    return state.document is not None and bool(state.document.drawing.layers)


PROPOSE_JOINTS = Command("Propose Joints", _propose, enabled=_has_layers)
ACCEPT_JOINTS = Command(
    "Accept Proposed Joints", lambda state: gestures.accept_joints(state.editor), enabled=_has_proposals
)
