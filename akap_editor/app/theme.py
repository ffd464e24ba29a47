"""The theme: dark colors with one accent color, fonts, and sizes for the monitor's scale."""

import shutil
import subprocess
import sys
from pathlib import Path

import imgui_bundle
from imgui_bundle import ImVec2, ImVec4, imgui
from PIL import ImageFont

from ..render.overlays import Rgba
from ..words import current_language

FONT_SIZE = 15.0
_SAMPLES = {"猫": "zh-cn", "한": "ko", "\N{CAT}": ""}  # characters, and the language of which they are
_HAN = "猫"  # has other shapes in Japanese
_QUERY_SECONDS = 5.0
_FOLDERS = {"win32": Path("C:/Windows/Fonts"), "darwin": Path("/System/Library/Fonts")}
_NAMES = {
    "win32": ("msyh.ttc", "malgun.ttf", "seguisym.ttf"),
    "darwin": ("Hiragino Sans GB.ttc", "AppleSDGothicNeo.ttc", "Apple Symbols.ttf"),
}
_JAPANESE_NAMES = {"win32": "YuGothM.ttc", "darwin": "ヒラギノ角ゴシック W3.ttc"}


def _hex(color: str, alpha: float = 1.0) -> Rgba:
    red, green, blue = (int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
    return red, green, blue, alpha


ACCENT = _hex("#FFB43A")
ACCENT_HOVER = _hex("#FFC461")
ACCENT_ACTIVE = _hex("#E69E33")
TEXT = _hex("#E8E9EC")
SECONDARY = _hex("#B4B8C0")
PANEL = _hex("#212328")
DARK = _hex("#18191C")
WELL = _hex("#1B1D21")  # of lists in panels
POPUP = _hex("#26282E")
FRAME = _hex("#2E3138")
HOVER = _hex("#3A3E47")
ACTIVE = _hex("#434853")
LINE = _hex("#34373E")
STRONG_LINE = _hex("#767B86")  # of items that only their line shows

_COLORS: dict[imgui.Col_, Rgba] = {
    imgui.Col_.text: TEXT,
    imgui.Col_.text_disabled: _hex("#A6AAB3"),
    imgui.Col_.window_bg: PANEL,
    imgui.Col_.child_bg: (0, 0, 0, 0),
    imgui.Col_.popup_bg: POPUP,
    imgui.Col_.border: LINE,
    imgui.Col_.frame_bg: FRAME,
    imgui.Col_.frame_bg_hovered: HOVER,
    imgui.Col_.frame_bg_active: ACTIVE,
    imgui.Col_.title_bg: POPUP,
    imgui.Col_.title_bg_active: POPUP,
    imgui.Col_.title_bg_collapsed: POPUP,
    imgui.Col_.menu_bar_bg: PANEL,
    imgui.Col_.scrollbar_bg: (0, 0, 0, 0),
    imgui.Col_.scrollbar_grab: STRONG_LINE,
    imgui.Col_.scrollbar_grab_hovered: SECONDARY,
    imgui.Col_.scrollbar_grab_active: SECONDARY,
    imgui.Col_.check_mark: DARK,
    imgui.Col_.checkbox_selected_bg: ACCENT,
    imgui.Col_.slider_grab: ACCENT,
    imgui.Col_.slider_grab_active: ACCENT,
    imgui.Col_.button: FRAME,
    imgui.Col_.button_hovered: HOVER,
    imgui.Col_.button_active: ACTIVE,
    imgui.Col_.header: _hex("#FFB43A", 0.20),
    imgui.Col_.header_hovered: HOVER,
    imgui.Col_.header_active: ACTIVE,
    imgui.Col_.separator: LINE,
    imgui.Col_.separator_hovered: LINE,
    imgui.Col_.separator_active: LINE,
    imgui.Col_.text_selected_bg: _hex("#FFB43A", 0.35),
    imgui.Col_.nav_cursor: ACCENT,
    imgui.Col_.modal_window_dim_bg: (0, 0, 0, 0.5),
    imgui.Col_.input_text_cursor: ACCENT,
}


def load_fonts(others: list[tuple[Path, int]]) -> None:
    """Load Roboto for text and Font Awesome for icons, and others for what these lack, see `system_fonts`.

    May be called again, between two frames, when the language has changed.
    """
    folder = Path(imgui_bundle.__path__[0]) / "assets" / "fonts"
    fonts = imgui.get_io().fonts
    fonts.clear_fonts()
    roboto = folder / "Roboto" / "Roboto-Regular.ttf"
    fonts.add_font_from_file_ttf(str(roboto), FONT_SIZE)
    icons = imgui.ImFontConfig()
    icons.merge_mode = True
    icons.glyph_offset = ImVec2(0, 1)
    icons.glyph_min_advance_x = FONT_SIZE  # names beside icons are aligned
    fonts.add_font_from_file_ttf(str(folder / "Font_Awesome_6_Free-Solid-900.otf"), FONT_SIZE - 1, icons)
    for path, number in others:
        other = imgui.ImFontConfig()
        other.merge_mode, other.font_no = True, number
        other.flags |= imgui.ImFontFlags_.no_load_error
        # ImGui's size is that of a line, which in Chinese fonts is higher: their characters would be small
        size = FONT_SIZE * _line_height(path, number) / _line_height(roboto, 0)
        fonts.add_font_from_file_ttf(str(path), size, other)


def _line_height(path: Path, number: int) -> float:
    """The height of a line of text in a font, times its nominal size; 1 if the file cannot be read."""
    try:
        return sum(ImageFont.truetype(path, 1000, number).getmetrics()) / 1000
    except OSError:
        return 1.0


def system_fonts() -> list[tuple[Path, int]]:
    """The files of fonts with many characters, and the number of the font in each; none if there are none."""
    if sys.platform in _FOLDERS:
        names = list(_NAMES[sys.platform])
        if current_language() == "ja":
            names.insert(0, _JAPANESE_NAMES[sys.platform])
        candidates = [(_FOLDERS[sys.platform] / name, 0) for name in names]
    elif shutil.which("fc-match"):
        samples = {**_SAMPLES, _HAN: "ja"} if current_language() == "ja" else _SAMPLES
        candidates = [found for each in samples.items() if (found := _match(*each)) is not None]
    else:
        candidates = []
    return [(path, number) for path, number in dict.fromkeys(candidates) if path.is_file()]


def _match(character: str, language: str) -> tuple[Path, int] | None:
    """The font that fontconfig has for a character, as it is written in a language; empty: in any.

    A scalable one, as color bitmaps cannot be loaded.
    """
    pattern = f":charset={ord(character):x}:scalable=true:color=false" + (language and f":lang={language}")
    command = ["fc-match", "-f", "%{file}\n%{index}\n", pattern]
    try:
        run = subprocess.run(command, capture_output=True, timeout=_QUERY_SECONDS, check=True)
        file, number = run.stdout.decode(errors="surrogateescape").splitlines()[:2]
        return Path(file), int(number) & 0xFFFF  # the upper half is of a variable font's instance
    except (OSError, ValueError, subprocess.SubprocessError):
        return None


def apply(scale: float) -> None:
    """Set ImGui's style. scale: points per design point."""
    style = imgui.Style()
    imgui.style_colors_dark(style)
    for name, color in _COLORS.items():
        style.set_color_(name, ImVec4(*color))
    style.window_padding = ImVec2(14, 12)
    style.frame_padding = ImVec2(9, 5)
    style.item_spacing = ImVec2(8, 8)
    style.item_inner_spacing = ImVec2(8, 6)
    style.window_rounding = 8
    style.child_rounding = 6
    style.frame_rounding = 5
    style.popup_rounding = 6
    style.grab_rounding = 5
    style.scrollbar_rounding = 6
    style.scrollbar_size = 11
    style.grab_min_size = 9
    style.window_border_size = 1
    style.popup_border_size = 1
    style.frame_border_size = 0
    style.window_title_align = ImVec2(0.0, 0.5)
    style.scale_all_sizes(scale)
    style.font_size_base = FONT_SIZE
    style.font_scale_dpi = scale
    imgui.get_current_context().style = style


def packed(color: Rgba, alpha: float = 1.0) -> int:
    """A color for draw lists, with its opacity multiplied by ``alpha``."""
    return int(imgui.get_color_u32(ImVec4(*color[:3], color[3] * alpha)))
