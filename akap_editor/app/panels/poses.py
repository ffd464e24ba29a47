"""The Poses section: thumbnails of the named poses, and a slider that blends two of them."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor import gestures
from ...editor.animation.pose_blend import PoseBlend
from ...editor.document.named_poses import NamedPose
from ...editor.framing import frame_box
from ...editor.session.edits import RenamePose, ReorderPoses
from ...io.images import Picture
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.command import context_menu_pressed
from ..pending_values import NameField
from ..theme import ACCENT, FRAME, HOVER, SECONDARY, packed
from ..timeline.keyframe_track import POSE_PAYLOAD
from . import parts

_MIN_SIDE, _GAP, _MARGIN = 60, 6, 4  # of a thumbnail, in design points
_TALL = 780  # design points: a panel of this height shows two rows of thumbnails, a lower one shows one
_NAME_SIZE = 0.86  # of the font, relative to that of other text


def pose_count(state: AppState) -> str:
    """The number of named poses for the section's title; empty if there are none."""
    count = len(state.document.state.poses) if state.document is not None else 0
    return str(count or "")


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    state.part(PosesSection).draw(state, scale)


class PosesSection:
    """Knows which pose is being renamed and which two are blended.

    name_field: its key is the name of the pose that is being renamed.
    """

    def __init__(self) -> None:
        self.name_field = NameField()
        self._blend = PoseBlend()

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        assert state.document is not None
        poses = state.document.state.poses
        self._draw_poses(state, poses, scale)
        if imgui.button(f"{icons.ICON_FA_PLUS}  {tr('Add to Poses')}", ImVec2(widgets.FULL, 0)):
            state.notice = ""
            state.run_reporting_errors(lambda: gestures.add_pose(state.editor))
        imgui.begin_disabled(len(poses) < 2)
        self._draw_blend(state, scale)
        imgui.end_disabled()

    def _draw_poses(self, state: AppState, poses: Sequence[NamedPose], scale: float) -> None:
        """Draw the thumbnails in a list of fixed height, so that nothing below it moves when one is added."""
        rows = 2 if imgui.get_window_height() >= _TALL * scale else 1
        spacing, padding = imgui.get_style().item_spacing.y, parts.well_padding()
        _, side = _columns(imgui.get_content_region_avail().x - 2 * padding, scale)
        row_height = side + _NAME_SIZE * imgui.get_text_line_height() + 2 * spacing
        parts.begin_well("##poses", rows * row_height + spacing)
        imgui.set_cursor_pos_y(spacing)
        if not poses:
            widgets.secondary_text(tr("None yet. Add a pose to return to it with a click."))
        columns, side = _columns(imgui.get_content_region_avail().x, scale)
        for number, pose in enumerate(poses):
            if number % columns:
                imgui.same_line(0, _GAP * scale)
            self._draw_pose(state, pose, side, scale)
        imgui.end_child()

    def _draw_pose(self, state: AppState, pose: NamedPose, side: int, scale: float) -> None:
        """Draw a thumbnail with its name: a click applies the pose, a right-click opens its menu.

        side: of the thumbnail in points.
        """
        corner = imgui.get_cursor_screen_pos()
        imgui.begin_group()
        if imgui.invisible_button(f"pose {pose.name}", ImVec2(side, side), imgui.ButtonFlags_.enable_nav):
            state.notice = ""
            state.run_reporting_errors(
                lambda: gestures.set_pose(state.editor, pose.positions, f"Apply {pose.name}", pose.crossings)
            )
        is_hovered, is_focused = imgui.is_item_hovered(), imgui.is_item_focused()
        widgets.show_tooltip(
            tr(
                "{name}: click to apply, drag to the timeline or to reorder, right-click for more",
                name=pose.name,
            )
        )
        if (is_hovered or is_focused) and imgui.is_key_pressed(imgui.Key.f2, False):
            self.name_field.begin(pose.name)
        _drag_and_drop(state, pose)
        if is_focused and context_menu_pressed():
            imgui.open_popup(f"menu {pose.name}")
        if imgui.begin_popup_context_item(f"menu {pose.name}"):
            self._draw_menu(state, pose)
            imgui.end_popup()
        _draw_thumbnail(state, pose, corner, side, is_hovered or is_focused, scale)
        imgui.push_font(None, imgui.get_style().font_size_base * _NAME_SIZE)
        if self.name_field.key == pose.name:
            name = self.name_field.draw("##name of pose", pose.name, side)
            if name:
                rename = RenamePose(pose.name, name)
                state.run_reporting_errors(lambda: state.editor.apply(f"Rename {pose.name}", rename))
        else:
            self._draw_name(pose, side)
        imgui.pop_font()
        imgui.end_group()

    def _draw_name(self, pose: NamedPose, width: float) -> None:
        imgui.text_colored(ImVec4(*SECONDARY), widgets.shortened(pose.name, width))
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0):
            self.name_field.begin(pose.name)
        widgets.show_tooltip(tr("{name}: double-click or F2 to rename", name=pose.name))

    def _draw_menu(self, state: AppState, pose: NamedPose) -> None:
        """Draw the content of a pose's context menu."""
        assert state.document is not None
        poses = state.document.state.poses
        index = poses.index(pose)
        if imgui.menu_item(tr("Rename"), "F2", False)[0]:
            self.name_field.begin(pose.name)
        if imgui.menu_item_simple(tr("Update from Current Pose")):
            state.run_reporting_errors(lambda: gestures.add_pose(state.editor, pose.name))
        if imgui.menu_item_simple(tr("Add as Keyframe")):
            state.run_reporting_errors(lambda: state.timeline.add_keyframe(pose))
        imgui.separator()
        for label, new_index in ((tr("Move Forward"), index - 1), (tr("Move Back"), index + 1)):
            if imgui.menu_item(label, "", False, 0 <= new_index < len(poses))[0]:
                _reorder(state, index, new_index)
        imgui.separator()
        if imgui.menu_item_simple(tr("Delete Pose")):
            gestures.delete_pose(state.editor, pose.name)

    def _draw_blend(self, state: AppState, scale: float) -> None:
        """Draw two lists of poses and a slider that previews their blend; its release applies the blend."""
        session, blend = state.editor.session, self._blend
        assert session is not None
        endpoints = blend.endpoints(session)  # None with fewer than two poses
        names = [pose.name for pose in session.state.poses]
        start, end = (0, 0) if endpoints is None else (names.index(pose.name) for pose in endpoints)
        gap = 8 * scale
        width = (imgui.get_content_region_avail().x - gap) / 2
        imgui.set_next_item_width(width)
        has_new_start, start = widgets.combo("##mix from", start, names)
        imgui.same_line(0, gap)
        imgui.set_next_item_width(width)
        has_new_end, end = widgets.combo("##mix to", end, names)
        if has_new_start or has_new_end:
            blend.start, blend.end, blend.share = names[start], names[end], 0.0
        tooltip = tr("Blends the two poses: every edge rotates and grows at a constant rate.")
        is_moved, percent, is_released = widgets.slider(
            "##mix", 100 * blend.share, (0, 100), "%.0f %%", tooltip=tooltip
        )
        if is_moved:
            blend.share = min(max(percent / 100, 0.0), 1.0)
            blend.preview(session)
        if is_released:
            session.end_preview()
            blended = blend.blend(session)
            if blended is not None:
                state.run_reporting_errors(
                    lambda: gestures.set_pose(state.editor, blended[0], mark("Apply Blend"), blended[1])
                )


def _columns(room: float, scale: float) -> tuple[int, int]:
    """How many thumbnails are in a row of ``room`` points, and their side, so that they fill it."""
    gap = _GAP * scale
    columns = max(1, int((room + gap) / (_MIN_SIDE * scale + gap)))
    return columns, max(1, int((room - (columns - 1) * gap) / columns))


def _draw_thumbnail(
    state: AppState, pose: NamedPose, corner: ImVec2, side: int, is_highlighted: bool, scale: float
) -> None:
    """Draw a pose in a square with rounded corners, with a frame if it is the current pose."""
    pixels = side - 2 * round(_MARGIN * scale)

    def picture() -> Picture:
        assert state.document is not None
        drawing = state.document.drawing
        box = frame_box(drawing, [pose.positions])
        return state.offscreen_renderer.render(
            drawing, pose.positions, box, pixels / max(box[2] - box[0], box[3] - box[1])
        )

    assert state.document is not None
    draw, end = imgui.get_window_draw_list(), ImVec2(corner.x + side, corner.y + side)
    draw.add_rect_filled(corner, end, packed(HOVER if is_highlighted else FRAME), 6 * scale)
    if imgui.is_rect_visible(corner, end):
        state.thumbnails.draw((pose, pixels), corner, side, picture)
    if pose.positions is state.document.state.positions:
        draw.add_rect(corner, end, packed(ACCENT), 6 * scale)


def _drag_and_drop(state: AppState, pose: NamedPose) -> None:
    """Let the last item be dragged to the timeline, or to another pose, whose place it takes."""
    assert state.document is not None
    poses = state.document.state.poses
    if imgui.begin_drag_drop_source(imgui.DragDropFlags_.source_no_preview_tooltip):
        imgui.set_drag_drop_payload_py_id(POSE_PAYLOAD, poses.index(pose))
        imgui.end_drag_drop_source()
    if imgui.begin_drag_drop_target():
        payload = imgui.accept_drag_drop_payload_py_id(POSE_PAYLOAD)
        if payload is not None and poses[payload.data_id] is not pose:
            _reorder(state, payload.data_id, poses.index(pose))
        imgui.end_drag_drop_target()


def _reorder(state: AppState, index: int, new_index: int) -> None:
    """Move a pose to another place in the order."""
    assert state.document is not None
    names = [pose.name for pose in state.document.state.poses]
    names.insert(new_index, names.pop(index))
    state.run_reporting_errors(lambda: state.editor.apply(mark("Reorder Poses"), ReorderPoses(names)))
