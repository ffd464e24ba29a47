"""The side panel's poses: kept by name, applied with a click, and mixed."""

from weakref import WeakKeyDictionary

import moderngl
from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ..editor.framing import frame_box
from ..editor.poses import NamedPose
from . import widgets
from .theme import ACCENT, FRAME, HOVER, QUIET, packed
from .workspace import Workspace

_SIDE = 66  # of a thumbnail, in design points
_COLUMNS = 3


class Thumbnails:
    """Textures of poses, made when they are first seen."""

    def __init__(self) -> None:
        self._textures: WeakKeyDictionary[NamedPose, moderngl.Texture] = WeakKeyDictionary()

    def of(self, space: Workspace, pose: NamedPose, pixels: int) -> moderngl.Texture:
        """The pose in at most ``pixels`` a side."""
        if pose not in self._textures:
            assert space.document is not None
            drawing = space.document.drawing
            box = frame_box(drawing, [pose.positions])
            scale = pixels / max(box[2] - box[0], box[3] - box[1])
            picture = space.exporter.render(drawing, pose.positions, box, scale)
            size = picture.shape[1], picture.shape[0]
            self._textures[pose] = moderngl.get_context().texture(size, 4, picture.tobytes(), alignment=1)
        return self._textures[pose]


_thumbnails = Thumbnails()


def pose_count(space: Workspace) -> str:
    """How many poses there are, in digits; nothing where there are none."""
    count = len(space.document.state.poses) if space.document is not None else 0
    return str(count or "")


def draw(space: Workspace, scale: float) -> None:
    """The poses of the drawing, and the pose between two of them."""
    assert space.document is not None
    poses = space.document.state.poses
    if not poses:
        widgets.quiet("None yet. Keep a pose here to come back to it with a click.")
    for number, pose in enumerate(poses):
        if number % _COLUMNS:
            imgui.same_line(0, 6 * scale)
        _pose(space, pose, scale)
    if imgui.button(f"{icons.ICON_FA_PLUS}  Keep this pose", ImVec2(-1, 0)):
        space.notice = ""
        space.attempt(space.editor.keep_pose)
    if len(poses) > 1:
        _mixer(space, scale)


def _pose(space: Workspace, pose: NamedPose, scale: float) -> None:
    """A thumbnail: a click applies it, a right click asks what else."""
    corner, side = imgui.get_cursor_screen_pos(), round(_SIDE * scale)
    drawer = imgui.get_window_draw_list()
    imgui.begin_group()
    if imgui.invisible_button(f"pose {pose.name}", ImVec2(side, side)):
        space.notice = ""
        space.attempt(lambda: space.editor.set_pose(pose.positions, f"Apply {pose.name}"))
    hovered = imgui.is_item_hovered() or imgui.is_item_focused()
    widgets.explain(f"{pose.name}: click to apply, right-click to forget")
    if imgui.begin_popup_context_item(f"menu {pose.name}"):
        if imgui.menu_item_simple("Take this pose anew"):
            space.attempt(lambda: space.editor.keep_pose(pose.name))
        if imgui.menu_item_simple("Forget"):
            space.editor.forget_pose(pose.name)
        imgui.end_popup()
    end = ImVec2(corner.x + side, corner.y + side)
    drawer.add_rect_filled(corner, end, packed(HOVER if hovered else FRAME), 6 * scale)
    texture = _thumbnails.of(space, pose, side - round(8 * scale))
    low = ImVec2(round(corner.x + (side - texture.width) / 2), round(corner.y + (side - texture.height) / 2))
    drawer.add_image(
        imgui.ImTextureRef(texture.glo), low, ImVec2(low.x + texture.width, low.y + texture.height)
    )
    assert space.document is not None
    if pose.positions is space.document.state.positions:
        drawer.add_rect(corner, end, packed(ACCENT), 6 * scale)
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    imgui.push_clip_rect(imgui.get_cursor_screen_pos(), ImVec2(end.x, end.y + 40 * scale), True)
    imgui.text_colored(ImVec4(*QUIET), pose.name)
    imgui.pop_clip_rect()
    imgui.pop_font()
    imgui.end_group()


def _mixer(space: Workspace, scale: float) -> None:
    """From one pose to another: the slider shows what is between, and takes it when it is let go."""
    session, mixer = space.editor.session, space.mixer
    assert session is not None
    chosen = mixer.chosen(session)
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
        mixer.start, mixer.end, mixer.share = names[start], names[end], 0.0
    tooltip = "The pose between the two: every edge turns and grows at a constant rate"
    moved, share, released = widgets.slider("##mix", 100 * mixer.share, (0, 100), "%.0f %%", tooltip=tooltip)
    if moved:
        mixer.share = min(max(share / 100, 0.0), 1.0)
        mixer.show(session)
    if released:
        session.leave()
        pose = mixer.pose(session)
        if pose is not None:
            space.attempt(lambda: space.editor.set_pose(pose, "In-between"))
