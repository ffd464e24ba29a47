"""A slim timeline under the canvas: the whole session, to be played, gone back in, cut and exported."""

from functools import partial
from pathlib import Path

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ..editor.framing import frame_box
from ..io.frames import export_frames, export_kind
from . import widgets
from .requests import FileRequest
from .theme import ACCENT, FRAME, QUIET, TEXT, packed
from .workspace import Workspace

HEIGHT = 44  # design points, as all sizes here
EXPORT_FPS = 30
EXPORT_SIZE = 640
SUFFIXES = (".webp", ".gif", ".apng", ".mp4", ".webm", ".png")
_RED = (0.93, 0.33, 0.31, 1.0)


def draw(space: Workspace, scale: float) -> None:
    """The bar; nothing without a drawing, or where it is switched off."""
    player = space.player
    player.watch(space.editor.session)
    if space.document is None or not space.show_timeline:
        return
    player.advance()
    if widgets.side_bar("Timeline", imgui.Dir.down, HEIGHT * scale, ImVec2(10 * scale, 8 * scale)):
        _buttons(space, scale)
        imgui.same_line(0, 12 * scale)
        _track(space, scale)
    imgui.end()


def _buttons(space: Workspace, scale: float) -> None:
    player = space.player
    side = ImVec2(30 * scale, 28 * scale)
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(_RED if player.taking is None else ACCENT)))
    if imgui.button(f"{icons.ICON_FA_CIRCLE if player.taking is None else icons.ICON_FA_STOP}##record", side):
        player.take(player.taking is None)
    imgui.pop_style_color()
    widgets.explain("Record: what you do from here to the next click is the part that is played and exported")
    imgui.same_line(0, 4 * scale)
    if imgui.button(f"{icons.ICON_FA_PAUSE if player.playing else icons.ICON_FA_PLAY}##play", side):
        player.play()
    widgets.explain("Play")
    imgui.same_line(0, 4 * scale)
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(ACCENT if player.loop else QUIET)))
    if imgui.button(f"{icons.ICON_FA_REPEAT}##loop", side):
        player.loop = not player.loop
    imgui.pop_style_color()
    widgets.explain("Play over and over")
    imgui.same_line(0, 4 * scale)
    imgui.begin_disabled(player.range[1] <= player.range[0])
    if imgui.button(f"{icons.ICON_FA_FILM}##export", side):
        ask_export(space)
    imgui.end_disabled()
    widgets.explain("Export the part between the marks as an animation or a video")


def _track(space: Workspace, scale: float) -> None:
    """The time from start to end: what is played in amber, two marks that cut it, and where one is."""
    player, drawer = space.player, imgui.get_window_draw_list()
    label = f"{player.at if player.at is not None else player.duration:.1f} / {player.duration:.1f} s"
    room = imgui.calc_text_size("000.0 / 000.0 s").x + 12 * scale
    corner = imgui.get_cursor_screen_pos()
    width, height = max(imgui.get_content_region_avail().x - room, 10 * scale), 28 * scale
    imgui.invisible_button("##track", ImVec2(width, height))
    held, hovered = imgui.is_item_active(), imgui.is_item_hovered()
    length = player.duration or 1.0

    def x_of(moment: float) -> float:
        return corner.x + width * min(max(moment / length, 0.0), 1.0)

    moment = (imgui.get_mouse_pos().x - corner.x) / width * length
    if imgui.is_item_activated():
        near = 6 * scale
        start, end = (abs(imgui.get_mouse_pos().x - x_of(mark)) for mark in player.range)
        space.grip = "start" if start < near and start < end else "end" if end < near else "head"
    if held and player.shots:
        if space.grip == "head":
            player.scrub(moment)
        else:
            player.cut_to(**{space.grip: moment})
    middle = corner.y + height / 2
    low, high = (x_of(mark) for mark in player.range)
    drawer.add_rect_filled(
        ImVec2(corner.x, middle - 3 * scale),
        ImVec2(corner.x + width, middle + 3 * scale),
        packed(FRAME),
        3 * scale,
    )
    drawer.add_rect_filled(
        ImVec2(low, middle - 3 * scale), ImVec2(high, middle + 3 * scale), packed(ACCENT, 0.55), 3 * scale
    )
    for mark in (low, high):
        drawer.add_rect_filled(
            ImVec2(mark - 2 * scale, middle - 8 * scale),
            ImVec2(mark + 2 * scale, middle + 8 * scale),
            packed(ACCENT),
            2 * scale,
        )
    if player.taking is not None:
        drawer.add_rect_filled(
            ImVec2(x_of(player.taking), middle - 3 * scale),
            ImVec2(x_of(length), middle + 3 * scale),
            packed(_RED),
        )
    head = x_of(player.at if player.at is not None else length)
    drawer.add_line(
        ImVec2(head, corner.y),
        ImVec2(head, corner.y + height),
        packed(TEXT),
        (2.5 if held or hovered else 2) * scale,
    )
    imgui.same_line(0, 12 * scale)
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*QUIET), label)


def ask_export(space: Workspace) -> None:
    """Ask where the part between the marks goes."""
    if space.document is not None:
        use = partial(export, space)
        name = f"{space.document.drawing.name}{SUFFIXES[0]}"
        space.request = FileRequest("Export animation", SUFFIXES, space.folder, use, name, saving=True)


def export(space: Workspace, path: Path) -> None:
    """Write the part between the marks; the name's ending decides on the format."""

    def work() -> None:
        export_kind(path)
        frames = space.player.frames(EXPORT_FPS)
        boxes = np.array([frame_box(frame.drawing, [frame.pose]) for frame in frames])
        low, high = boxes.min(axis=0), boxes.max(axis=0)
        box = (int(low[0]), int(low[1]), int(high[2]), int(high[3]))
        scale = min(1.0, EXPORT_SIZE / max(box[2] - box[0], box[3] - box[1]))
        pictures = (
            space.exporter.render(frame.drawing, frame.pose, box, scale, order=frame.order)
            for frame in frames
        )
        written = export_frames(path, pictures, EXPORT_FPS)
        space.notice = f"Exported {path.name}, {len(frames)} frames, {written}"

    space.later(work, f"Exporting {path.name} ...")
