"""Draws the joints and the strokes of the knife over the drawing.

Joints are rings for hinges, squares for welds, and broken rings for proposals.
"""

import math
from collections.abc import Sequence

from imgui_bundle import ImVec2, imgui

from ...editor.camera import Point
from ...editor.document.rig.joint import Joint
from ...editor.tools.joints import joints_on_screen
from ...editor.tools.knife import cuts_on_screen
from ..app_state import AppState
from ..theme import ACCENT, DARK, packed

_RADIUS = 8.0  # design points
_COLOR = (0.35, 0.78, 1.0, 1.0)
_CUT_COLOR = (1.0, 0.35, 0.35, 1.0)
_DASHES = 8  # of a proposal's ring


def are_shown(state: AppState) -> bool:
    """Whether joints are drawn: with the joint tool, and as long as there are proposals."""
    editor = state.editor
    if editor.session is None or state.timeline.playback.is_playing:
        return False
    has_proposals = any(joint.is_proposed for joint in editor.session.state.joints)
    return editor.chosen_tool is editor.joint_tool or (has_proposals and state.view.show_pins)


def draw_joints(state: AppState, scale: float) -> None:
    """Draw all joints, if they are shown, on the canvas."""
    editor = state.editor
    if not are_shown(state) or editor.session is None:
        return
    draw, markers = imgui.get_background_draw_list(), editor.tool.markers
    draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
    centers = joints_on_screen(editor)
    for joint in editor.session.state.joints:
        is_hovered = joint.id == markers.hovered_joint
        center = centers[joint.id]
        if is_hovered and markers.new_joint is not None:
            center = markers.new_joint
        is_selected = editor.joint_tool.selected == joint.id
        _draw_joint(draw, joint, center, scale, is_hovered, is_selected)
    draw.pop_clip_rect()


def _draw_joint(
    draw: imgui.ImDrawList, joint: Joint, center: Point, scale: float, is_hovered: bool, is_selected: bool
) -> None:
    middle, radius = ImVec2(*center), (_RADIUS + 1.5 * is_hovered) * scale
    color = packed(ACCENT if is_selected else _COLOR)
    if joint.kind == "weld":
        low = ImVec2(middle.x - 0.8 * radius, middle.y - 0.8 * radius)
        high = ImVec2(middle.x + 0.8 * radius, middle.y + 0.8 * radius)
        draw.add_rect(low, high, packed(DARK, 0.75), 0.0, 5.0 * scale)
        draw.add_rect(low, high, color, 0.0, 2.2 * scale)
    elif joint.is_proposed:
        for number in range(_DASHES):
            start = 2 * math.pi * number / _DASHES
            for width, stroke in ((5.0, packed(DARK, 0.6)), (2.2, color)):
                draw.path_arc_to(middle, radius, start, start + math.pi / _DASHES, 6)
                draw.path_stroke(stroke, width * scale)
    else:
        draw.add_circle(middle, radius, packed(DARK, 0.75), 0, 5.0 * scale)
        draw.add_circle(middle, radius, color, 0, 2.2 * scale)
    draw.add_circle_filled(middle, 2.2 * scale, color)


def draw_cuts(state: AppState, scale: float) -> None:
    """Draw all strokes while the knife is chosen, or one that the list points at, and the one under way."""
    editor = state.editor
    knife = editor.knife_tool
    is_chosen = editor.chosen_tool is knife
    if editor.session is None or not (is_chosen or knife.highlighted is not None):
        return
    draw, markers = imgui.get_background_draw_list(), editor.tool.markers
    hovered = markers.hovered_cut if is_chosen else knife.highlighted
    draw.push_clip_rect(ImVec2(*editor.canvas[:2]), ImVec2(*editor.canvas[2:]))
    for index, lips in enumerate(cuts_on_screen(editor)):
        for lip in lips if is_chosen or index == hovered else ():
            _draw_line(draw, lip, scale, index == hovered)
    if markers.cut_stroke:
        _draw_line(draw, markers.cut_stroke, scale, True)
    draw.pop_clip_rect()


def _draw_line(draw: imgui.ImDrawList, line: Sequence[Point], scale: float, is_hovered: bool) -> None:
    color = packed(ACCENT if is_hovered else _CUT_COLOR)
    for stroke, width in ((packed(DARK, 0.6), 4.0), (color, 1.8)):
        for point in line:
            draw.path_line_to(ImVec2(*point))
        draw.path_stroke(stroke, width * scale)
