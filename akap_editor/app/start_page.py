"""The start page, in place of the canvas while nothing is open: open a file, a bundled or a recent one."""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from PIL import Image

from ..display_text import display_name, display_text
from ..editor.animation.clips.clip import Clip
from ..io.akap.clip import clips_for
from ..io.images import Picture, read_image
from ..io.layers.ora import ora_thumbnail
from ..resources import PUPPET_SUFFIX, bundled_files, drawing_title
from ..words import tr
from . import files, widgets
from .app_state import AppState
from .commands.registry import OPEN
from .dialogs.clips import play_clip
from .jobs.file_thumbnails import FileThumbnails
from .jobs.tile_motion import FRAMES_PER_SECOND, TileMotions
from .theme import ACCENT, DARK, FRAME, HOVER, PANEL, SECONDARY, STRONG_LINE, TEXT, packed

_WINDOW = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_bring_to_front_on_focus
) & ~imgui.WindowFlags_.no_scrollbar
_BUTTON = imgui.ButtonFlags_.enable_nav  # the keyboard can press it
_WIDTH, _MAX_WIDTH = 720, 960  # of the column in the middle, in design points, as all sizes here
_SHARE = 0.6  # of the page's width, between these two
_DROP_HEIGHT, _MIN_DROP_HEIGHT = 132, 84
_DROP_SHARE = 0.22  # of the page's height, between these two
_GAP = 12
_MARGIN = 12  # around a thumbnail
_DASH = 7
_CLIP_BUTTON = 26
_MIN_RECENT = 3  # files
_ROW_HEIGHT = 40  # of a recent file


def draw(state: AppState, scale: float, pixels_per_point: float) -> None:
    """Draw the page over the whole canvas. scale: points per design point."""
    left, top, right, bottom = state.editor.canvas
    imgui.set_next_window_pos(ImVec2(left, top))
    imgui.set_next_window_size(ImVec2(right - left, bottom - top))
    width = right - left
    column = min(max(_SHARE * width, _WIDTH * scale), _MAX_WIDTH * scale, width - 48 * scale)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.push_style_var(
        imgui.StyleVar_.window_padding, ImVec2((right - left - column) / 2, 0.06 * (bottom - top))
    )
    imgui.push_style_color(imgui.Col_.window_bg, ImVec4(*DARK))
    imgui.begin("Start", None, _WINDOW)
    imgui.pop_style_color()
    imgui.pop_style_var(3)
    _draw_title()
    _draw_drop_zone(state, scale, column)
    _draw_heading(tr("Bundled drawings"))
    _draw_bundled(state, scale, column, pixels_per_point)
    _draw_heading(tr("Recent files"))
    _draw_recent(state, column, scale, pixels_per_point)
    imgui.end()


def _draw_bundled(state: AppState, scale: float, column: float, pixels_per_point: float) -> None:
    """Draw a row of buttons that open the bundled drawings, each with its thumbnail and name."""
    paths = bundled_files()
    side = int((column - _GAP * scale * (len(paths) - 1)) / len(paths))
    corner, step = imgui.get_cursor_pos(), (column - side) / (len(paths) - 1)
    for number, path in enumerate(paths):
        imgui.set_cursor_pos(ImVec2(corner.x + round(number * step), corner.y))  # the last one ends the row
        imgui.begin_group()
        _draw_button(state, path, side, scale, pixels_per_point)
        imgui.end_group()


def _draw_button(state: AppState, path: Path, side: int, scale: float, pixels_per_point: float) -> None:
    """Draw a button that opens a drawing. side: of its square in points."""
    corner, draw = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    name_height = imgui.get_text_line_height() + 8 * scale
    imgui.set_next_item_allow_overlap()
    if imgui.invisible_button(path.stem, ImVec2(side, side + name_height), _BUTTON):
        _open(state, path)
    is_hovered = imgui.is_item_hovered() or imgui.is_item_focused()
    end = ImVec2(corner.x + side, corner.y + side)
    draw.add_rect_filled(corner, end, packed(HOVER if is_hovered else PANEL), 8 * scale)
    pixels = max(16, round((side - 2 * round(_MARGIN * scale)) * pixels_per_point))
    if not (is_hovered and _draw_motion(state, path, corner, side, pixels, pixels_per_point)):
        state.part(TileMotions).stop(path)
        state.thumbnails.draw(
            (path, pixels), corner, side, lambda: _scaled_picture(path, pixels), pixels_per_point
        )
    clips = clips_for(path.stem)
    if clips:
        _draw_clip_button(state, path, clips[0], ImVec2(end.x, corner.y), scale)
    name = drawing_title(path)
    name_corner = ImVec2(corner.x + (side - imgui.calc_text_size(name).x) / 2, end.y + 6 * scale)
    draw.add_text(name_corner, packed(TEXT if is_hovered else SECONDARY), name)


def _draw_motion(
    state: AppState, path: Path, corner: ImVec2, side: int, pixels: int, pixels_per_point: float
) -> bool:
    """Draw the present frame of a drawing that moves; False as long as there is none.

    pixels: of the thumbnail, which the first frame equals; the motion may leave its frame up to the tile's.
    """
    frame = state.part(TileMotions).frame(path, state.wake)
    if frame is None:
        return False
    state.frame_delay = min(state.frame_delay, 1 / FRAMES_PER_SECOND)
    width, height = frame.drawing.size
    zoom = pixels / max(width, height)
    reach = round(side * pixels_per_point) / zoom / 2  # of the tile, from the middle of the drawing
    left, top = math.floor(width / 2 - reach), math.floor(height / 2 - reach)
    box = left, top, math.ceil(width / 2 + reach), math.ceil(height / 2 + reach)
    key = ("tile", id(frame.pose), pixels)
    state.thumbnails.draw(
        key,
        corner,
        side,
        lambda: state.offscreen_renderer.render(frame.drawing, frame.pose, box, zoom, None, frame.order),
        pixels_per_point,
    )
    return True


def _draw_clip_button(state: AppState, path: Path, clip: Clip, corner: ImVec2, scale: float) -> None:
    """Draw a small button that opens a drawing and plays a clip. corner: at the top right of the drawing.

    Arrow keys pass it by, so that they go from tile to tile; the menu has the clips for the keyboard.
    """
    size = _CLIP_BUTTON * scale
    low = ImVec2(corner.x - size, corner.y)
    imgui.set_cursor_screen_pos(low)
    if imgui.invisible_button(f"{path.stem} clip", ImVec2(size, size)):
        _open(state, path, partial(play_clip, state, clip))
    is_hovered = imgui.is_item_hovered()
    widgets.show_tooltip(tr("Open and play the clip “{clip}”", clip=tr(clip.name)))
    draw, half = imgui.get_window_draw_list(), imgui.calc_text_size(icons.ICON_FA_PLAY)
    place = ImVec2(low.x + (size - half.x) / 2, low.y + (size - half.y) / 2)
    draw.add_text(place, packed(ACCENT if is_hovered else SECONDARY), icons.ICON_FA_PLAY)


def _scaled_picture(path: Path, pixels: int) -> Picture:
    """The picture file, at most ``pixels`` a side."""
    picture = Image.fromarray(ora_thumbnail(path) if path.suffix == PUPPET_SUFFIX else read_image(path))
    picture.thumbnail((pixels, pixels), Image.Resampling.LANCZOS)
    return np.asarray(picture)


def _open(state: AppState, path: Path, then: Callable[[], None] | None = None) -> None:
    """Open a file and give the keyboard focus to the canvas. then: see `files.open_path`."""
    files.open_path(state, path, then=then)
    imgui.set_window_focus(None)
    imgui.set_nav_cursor_visible(False)


def _draw_title() -> None:
    imgui.push_font(None, imgui.get_style().font_size_base * 2.0)
    imgui.text("akap-editor")
    imgui.pop_font()
    imgui.text_colored(ImVec4(*SECONDARY), tr("Pin a drawing, drag a pin, and the drawing bends."))
    imgui.spacing()
    imgui.spacing()


def _draw_heading(title: str) -> None:
    imgui.dummy(ImVec2(0, 0.6 * imgui.get_font_size()))
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    imgui.text_colored(ImVec4(*SECONDARY), title.upper())
    imgui.pop_font()


def _draw_drop_zone(state: AppState, scale: float, width: float) -> None:
    """Draw the area that invites to drop a file; a click on it runs File > Open."""
    corner, share = imgui.get_cursor_screen_pos(), _DROP_SHARE * imgui.get_window_height()
    height = min(max(share, _MIN_DROP_HEIGHT * scale), _DROP_HEIGHT * scale)
    if imgui.invisible_button("Drop a picture here", ImVec2(width, height), _BUTTON):
        widgets.run(state, OPEN)
    is_highlighted = imgui.is_item_hovered() or imgui.is_item_focused()
    if imgui.is_item_hovered():
        imgui.set_mouse_cursor(imgui.MouseCursor_.hand)
    draw, end = imgui.get_window_draw_list(), ImVec2(corner.x + width, corner.y + height)
    draw.add_rect_filled(corner, end, packed(FRAME if is_highlighted else PANEL), 8 * scale)
    _draw_dashed_frame(corner, end, scale, packed(ACCENT if is_highlighted else STRONG_LINE))
    lines = (
        (icons.ICON_FA_IMAGE, 1.7, ACCENT),
        (tr("Drop a picture here"), 1.2, TEXT),
        (tr("or click to choose a file ({key})", key=OPEN.key_name), 1.0, SECONDARY),
    )
    gap, line_height = min(8 * scale, 0.06 * height), imgui.get_font_size()
    y = corner.y + (height - line_height * sum(size for _, size, _ in lines) - 2 * gap) / 2
    for text, size, color in lines:
        imgui.push_font(None, imgui.get_style().font_size_base * size)
        x = corner.x + (width - imgui.calc_text_size(text).x) / 2
        draw.add_text(ImVec2(round(x), round(y)), packed(color), text)
        imgui.pop_font()
        y += size * line_height + gap


def _draw_dashed_frame(low: ImVec2, high: ImVec2, scale: float, color: int) -> None:
    """Draw a rectangle of dashes, with a dash at both ends of each side."""
    draw, thickness = imgui.get_window_draw_list(), max(1.0, round(1.2 * scale))
    for start, end in (
        (low, ImVec2(high.x, low.y)),
        (ImVec2(low.x, high.y), high),
        (low, ImVec2(low.x, high.y)),
        (ImVec2(high.x, low.y), high),
    ):
        side = ImVec2(end.x - start.x, end.y - start.y)
        pieces = 2 * max(1, round((side.x + side.y) / (2 * _DASH * scale))) + 1  # dashes and gaps
        for index in range(0, pieces, 2):
            first, last = index / pieces, (index + 1) / pieces
            draw.add_line(
                ImVec2(start.x + first * side.x, start.y + first * side.y),
                ImVec2(start.x + last * side.x, start.y + last * side.y),
                color,
                thickness,
            )


def _draw_recent(state: AppState, width: float, scale: float, pixels_per_point: float) -> None:
    """Draw as many recent files as there is room for, at least three; each with a thumbnail."""
    recent = state.preferences.recent
    if not recent:
        widgets.secondary_text(tr("None yet. Files that you open or save are listed here."))
        return
    height = round(_ROW_HEIGHT * scale)
    spacing = imgui.get_style().item_spacing.y
    room = int((imgui.get_content_region_avail().y + spacing) / (height + spacing))
    for index, path in enumerate(recent[: max(room, _MIN_RECENT)]):
        _draw_recent_file(state, index, path, width, height, scale, pixels_per_point)


def _draw_recent_file(
    state: AppState,
    index: int,
    path: Path,
    width: float,
    height: int,
    scale: float,
    pixels_per_point: float,
) -> None:
    """Draw a row: a thumbnail, the name, and the folder at the right."""
    corner, draw = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    if imgui.selectable(f"##recent {index}", False, 0, ImVec2(0, height))[0]:
        _open(state, path)
    widgets.show_tooltip(display_text(path))
    pixels = round((height - 4 * scale) * pixels_per_point)
    picture = state.part(FileThumbnails).picture(path, pixels, state.wake)
    if picture is not None:
        key = ("recent", path, id(picture))
        state.thumbnails.draw(key, corner, height, lambda: picture, pixels_per_point)
    middle = corner.y + (height - imgui.get_text_line_height()) / 2
    left = corner.x + height + 10 * scale
    if picture is None:
        icon = icons.ICON_FA_FILE_IMAGE
        at = corner.x + (height - imgui.calc_text_size(icon).x) / 2
        draw.add_text(ImVec2(at, middle), packed(SECONDARY), icon)
    name = widgets.shortened(display_name(path), 0.4 * width)
    draw.add_text(ImVec2(left, middle), packed(TEXT), name)
    folder = widgets.shortened(display_text(path.parent), 0.45 * width, keeps_end=True)
    right = corner.x + width - imgui.calc_text_size(folder).x - 6 * scale
    draw.add_text(ImVec2(right, middle), packed(SECONDARY), folder)
