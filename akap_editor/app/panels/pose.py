"""The side panel's poses: kept by name, applied with a click, and mixed."""

from collections.abc import Sequence
from weakref import WeakKeyDictionary

import moderngl
from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor import gestures
from ...editor.document.named_poses import NamedPose
from ...editor.framing import frame_box
from ...editor.session.edits import RenamePose, ReorderPoses
from .. import widgets
from ..app_state import AppState
from ..commands.command import menu_key
from ..theme import ACCENT, FRAME, HOVER, QUIET, packed
from ..timeline.keyframe_track import POSE_PAYLOAD

_SIDE = 66  # of a thumbnail, in design points
_COLUMNS, _ROWS = 3, 4  # of thumbnails that are seen at once


class Thumbnails:
    """Textures of poses, made when they are first seen."""

    def __init__(self) -> None:
        self._textures: WeakKeyDictionary[NamedPose, moderngl.Texture] = WeakKeyDictionary()

    def of(self, state: AppState, pose: NamedPose, pixels: int) -> moderngl.Texture:
        """The pose in at most ``pixels`` a side."""
        if pose not in self._textures:
            assert state.document is not None
            drawing = state.document.drawing
            box = frame_box(drawing, [pose.positions])
            scale = pixels / max(box[2] - box[0], box[3] - box[1])
            picture = state.exporter.render(drawing, pose.positions, box, scale)
            size = picture.shape[1], picture.shape[0]
            self._textures[pose] = moderngl.get_context().texture(size, 4, picture.tobytes(), alignment=1)
        return self._textures[pose]


_thumbnails = Thumbnails()


def pose_count(state: AppState) -> str:
    """How many poses there are, in digits; nothing where there are none."""
    count = len(state.document.state.poses) if state.document is not None else 0
    return str(count or "")


def draw(state: AppState, scale: float) -> None:
    """The poses of the drawing, and the pose between two of them."""
    assert state.document is not None
    poses = state.document.state.poses
    if not poses:
        widgets.secondary_text("None yet. Keep a pose here to come back to it with a click.")
    _all_poses(state, poses, scale)
    if imgui.button(f"{icons.ICON_FA_PLUS}  Keep this pose", ImVec2(widgets.FULL, 0)):
        state.notice = ""
        state.run_reporting_errors(lambda: gestures.add_pose(state.editor))
    if len(poses) > 1:
        _mixer(state, scale)


def _all_poses(state: AppState, poses: Sequence[NamedPose], scale: float) -> None:
    """The thumbnails in rows; where there are many, the rest are to be scrolled to."""
    scrolls = len(poses) > _COLUMNS * _ROWS
    if scrolls:
        gaps = 2 * imgui.get_style().item_spacing.y
        row = round(_SIDE * scale) + 0.86 * imgui.get_text_line_height() + gaps
        height = (_ROWS + 0.5) * row  # half a row says that there are more
        imgui.begin_child("##poses", ImVec2(0, height), widgets.NAV_FLATTENED)
    for number, pose in enumerate(poses):
        if number % _COLUMNS:
            imgui.same_line(0, 6 * scale)
        _pose(state, pose, scale)
    if scrolls:
        imgui.end_child()


def _pose(state: AppState, pose: NamedPose, scale: float) -> None:
    """A thumbnail: a click applies it, a right click asks what else."""
    corner, side = imgui.get_cursor_screen_pos(), round(_SIDE * scale)
    drawer = imgui.get_window_draw_list()
    imgui.begin_group()
    if imgui.invisible_button(f"pose {pose.name}", ImVec2(side, side), imgui.ButtonFlags_.enable_nav):
        state.notice = ""
        state.run_reporting_errors(
            lambda: gestures.set_pose(state.editor, pose.positions, f"Apply {pose.name}", pose.crossings)
        )
    hovered = imgui.is_item_hovered() or imgui.is_item_focused()
    widgets.show_tooltip(
        f"{pose.name}: click to apply, drag to the timeline or another place, right-click for more"
    )
    if hovered and imgui.is_key_pressed(imgui.Key.f2, False):
        _begin_renaming(state, pose)
    _dragging(state, pose)
    if imgui.is_item_focused() and menu_key():
        imgui.open_popup(f"menu {pose.name}")
    if imgui.begin_popup_context_item(f"menu {pose.name}"):
        _menu(state, pose)
        imgui.end_popup()
    end = ImVec2(corner.x + side, corner.y + side)
    drawer.add_rect_filled(corner, end, packed(HOVER if hovered else FRAME), 6 * scale)
    texture = _thumbnails.of(state, pose, side - round(8 * scale))
    low = ImVec2(round(corner.x + (side - texture.width) / 2), round(corner.y + (side - texture.height) / 2))
    drawer.add_image(
        imgui.ImTextureRef(texture.glo), low, ImVec2(low.x + texture.width, low.y + texture.height)
    )
    assert state.document is not None
    if pose.positions is state.document.state.positions:
        drawer.add_rect(corner, end, packed(ACCENT), 6 * scale)
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    if state.renaming == pose.name:
        _rename(state, pose, side)
    else:
        imgui.text_colored(ImVec4(*QUIET), widgets.shortened(pose.name, side))
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0):
            _begin_renaming(state, pose)
        widgets.show_tooltip(f"{pose.name}: double-click or F2 to rename")
    imgui.pop_font()
    imgui.end_group()


def _menu(state: AppState, pose: NamedPose) -> None:
    if imgui.menu_item("Rename", "F2", False)[0]:
        _begin_renaming(state, pose)
    if imgui.menu_item_simple("Change to the Present Pose"):
        state.run_reporting_errors(lambda: gestures.add_pose(state.editor, pose.name))
    if imgui.menu_item_simple("Keyframe of It"):
        state.timeline.set_mode("keyframes")
        state.timeline.is_shown = True
        state.run_reporting_errors(
            lambda: state.timeline.keyframe_playback.set_keyframe(None, pose.positions, pose.crossings)
        )
    imgui.separator()
    assert state.document is not None
    last = len(state.document.state.poses) - 1
    at = state.document.state.poses.index(pose)
    for label, to in (("Move Forward", at - 1), ("Move Back", at + 1)):
        if imgui.menu_item(label, "", False, 0 <= to <= last)[0]:
            _order(state, at, to)
    imgui.separator()
    if imgui.menu_item_simple("Forget"):
        gestures.delete_pose(state.editor, pose.name)


def _begin_renaming(state: AppState, pose: NamedPose) -> None:
    state.renaming, state.new_name = pose.name, ""


def _rename(state: AppState, pose: NamedPose, width: float) -> None:
    """A field in place of the name: Enter or a click elsewhere takes what is in it, Escape nothing."""
    if not state.new_name:  # again and again: a mouse that is still pressed takes the focus away
        imgui.set_keyboard_focus_here()
    imgui.set_next_item_width(width)
    flags = imgui.InputTextFlags_.auto_select_all
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.2 * imgui.get_font_size(), 0))
    _, text = imgui.input_text("##name of pose", state.new_name or pose.name, flags)
    imgui.pop_style_var()
    if imgui.is_item_active():
        state.new_name = text or " "  # which is no name, and not the sign that the field is new
    if imgui.is_item_deactivated():
        name, state.renaming = state.new_name.strip(), None
        if name and name != pose.name and not imgui.is_key_pressed(imgui.Key.escape, False):
            label = f"Rename {pose.name}"
            state.run_reporting_errors(lambda: state.editor.apply(label, RenamePose(pose.name, name)))


def _dragging(state: AppState, pose: NamedPose) -> None:
    """A thumbnail goes to the timeline, or where another one is, which makes room."""
    assert state.document is not None
    names = [each.name for each in state.document.state.poses]
    if imgui.begin_drag_drop_source(imgui.DragDropFlags_.source_no_preview_tooltip):
        imgui.set_drag_drop_payload_py_id(POSE_PAYLOAD, names.index(pose.name))
        imgui.end_drag_drop_source()
    if imgui.begin_drag_drop_target():
        payload = imgui.accept_drag_drop_payload_py_id(POSE_PAYLOAD)
        if payload is not None and names[payload.data_id] != pose.name:
            _order(state, payload.data_id, names.index(pose.name))
        imgui.end_drag_drop_target()


def _order(state: AppState, old: int, new: int) -> None:
    """Bring a pose to another place among the others."""
    assert state.document is not None
    names = [each.name for each in state.document.state.poses]
    names.insert(new, names.pop(old))
    state.run_reporting_errors(lambda: state.editor.apply("Reorder Poses", ReorderPoses(names)))


def _mixer(state: AppState, scale: float) -> None:
    """From one pose to another: the slider shows what is between, and takes it when it is let go."""
    session, pose_blend = state.editor.session, state.pose_blend
    assert session is not None
    chosen = pose_blend.endpoints(session)
    assert chosen is not None
    names = [pose.name for pose in session.state.poses]
    width = (imgui.get_content_region_avail().x - 8 * scale) / 2
    start, end = (names.index(pose.name) for pose in chosen)
    imgui.set_next_item_width(width)
    changed, start = imgui.combo("##mix from", start, names)
    imgui.same_line(0, 8 * scale)
    imgui.set_next_item_width(width)
    other, end = imgui.combo("##mix to", end, names)
    if changed or other:
        pose_blend.start, pose_blend.end, pose_blend.share = names[start], names[end], 0.0
    tooltip = "The pose between the two: every edge turns and grows at a constant rate"
    moved, share, released = widgets.slider(
        "##mix", 100 * pose_blend.share, (0, 100), "%.0f %%", tooltip=tooltip
    )
    if moved:
        pose_blend.share = min(max(share / 100, 0.0), 1.0)
        pose_blend.preview(session)
    if released:
        session.end_preview()
        blended = pose_blend.blend(session)
        if blended is not None:
            state.run_reporting_errors(
                lambda: gestures.set_pose(state.editor, blended[0], "Apply Blend", blended[1])
            )
