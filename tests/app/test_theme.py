"""Contrast by the formulas of WCAG 2.2, and colors as those see them who see fewer."""

import itertools
from pathlib import Path

import imgui_bundle
import numpy as np
import pytest
from imgui_bundle import imgui
from PIL import ImageFont

from akap_editor.app import theme
from akap_editor.app.canvas import legend, vector_field_arrows, view_options
from akap_editor.app.panels import measurements
from akap_editor.app.timeline import track
from akap_editor.render import colormaps

GROUNDS = ("PANEL", "DARK", "WELL", "POPUP", "FRAME", "HOVER", "ACTIVE")
TEXT_AA, PARTS_AA = 4.5, 3.0  # success criteria 1.4.3 and 1.4.11
APART = 0.15  # in OKLab, where black is 1 from white: thin lines of two colors are told apart

# Machado, Oliveira and Fernandes 2009, severity 1: linear RGB as seen without one kind of cones.
DEFICIENCIES = {
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}


def linear(color):
    values = np.asarray(color[:3])
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def luminance(rgb):
    return float(np.clip(rgb, 0, 1) @ (0.2126, 0.7152, 0.0722))


def contrast(one, other):
    low, high = sorted((luminance(linear(one)), luminance(linear(other))))
    return (high + 0.05) / (low + 0.05)


def over(color, ground):
    """What is seen of a color that lets some of the ground through."""
    return tuple(color[3] * c + (1 - color[3]) * g for c, g in zip(color[:3], ground[:3], strict=True))


def of(name):
    return getattr(theme, name)


def test_black_on_white_is_21_to_1():
    assert contrast((0, 0, 0), (1, 1, 1)) == pytest.approx(21)
    assert contrast(theme._hex("#767676"), (1, 1, 1)) == pytest.approx(4.54, abs=0.005)


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("text", ["TEXT", "SECONDARY", "ACCENT"])
def test_text(text, ground):
    assert contrast(of(text), of(ground)) >= TEXT_AA


@pytest.mark.parametrize("ground", ["PANEL", "WELL", "POPUP"])
def test_text_on_a_chosen_line(ground):
    chosen = over(theme._COLORS[imgui.Col_.header], of(ground))
    for text in ("TEXT", "SECONDARY"):
        assert contrast(of(text), chosen) >= TEXT_AA


@pytest.mark.parametrize("accent", ["ACCENT", "ACCENT_HOVER", "ACCENT_ACTIVE"])
def test_text_on_the_button_that_enter_presses(accent):
    assert contrast(theme.DARK, of(accent)) >= TEXT_AA


def test_keys_in_menus_which_imgui_writes_as_disabled_text():
    for ground in ("POPUP", "HOVER"):
        assert contrast(theme._COLORS[imgui.Col_.text_disabled], of(ground)) >= TEXT_AA


@pytest.mark.parametrize("canvas", ["#FFFFFF", "#FFB43A", "#000000"])
@pytest.mark.parametrize("text", ["TEXT", "SECONDARY"])
def test_text_on_a_plate_over_any_drawing(text, canvas):
    plate = over((*theme.DARK[:3], legend.PLATE_OPACITY), theme._hex(canvas))
    assert contrast(of(text), plate) >= TEXT_AA


@pytest.mark.parametrize("part", [imgui.Col_.check_mark, imgui.Col_.slider_grab, imgui.Col_.nav_cursor])
def test_parts_that_show_a_state(part):
    ground = theme.ACCENT if part == imgui.Col_.check_mark else theme.FRAME
    assert contrast(theme._COLORS[part], ground) >= PARTS_AA


@pytest.mark.parametrize("ground", ["PANEL", "DARK", "WELL", "POPUP", "FRAME"])
def test_lines_that_alone_show_where_something_is(ground):
    assert contrast(theme.STRONG_LINE, of(ground)) >= PARTS_AA
    assert contrast(theme._COLORS[imgui.Col_.scrollbar_grab], of(ground)) >= PARTS_AA


@pytest.mark.parametrize("name", DEFICIENCIES)
def test_what_is_on_differs_from_what_is_off_for_everybody(name):
    """A chosen pin from another one, a tool or a box that is on from one that is off."""
    seen = np.array(DEFICIENCIES[name])
    pairs = itertools.product(["ACCENT"], ["DARK", "FRAME", "PANEL"])
    for on, off in pairs:
        low, high = sorted(luminance(seen @ linear(of(color))) for color in (on, off))
        assert (high + 0.05) / (low + 0.05) >= PARTS_AA


TOGETHER = {
    "fields of the drag": (vector_field_arrows.U_OPT_COLOR, vector_field_arrows.U_SMOOTH_COLOR),
    "trails and followed field": (view_options.TRAIL_COLOR, vector_field_arrows.U_OPT_COLOR),
    "trails and other field": (view_options.TRAIL_COLOR, vector_field_arrows.U_SMOOTH_COLOR),
    "trails and chosen pins": (view_options.TRAIL_COLOR, theme.ACCENT),
    "energies": (measurements.AREA_COLOR, measurements.ANGLE_COLOR),
    "poses before and after": (view_options.BEFORE_TINT, view_options.AFTER_TINT),
    "shrunk and grown": tuple(colormaps.diverging()[[0, -1]]),
    "recorded and rest of a timeline": (track.RED, theme.ACCENT),
    "chosen keyframes and others": (theme.ACCENT, theme.TEXT),
}


def oklab(rgb):
    roots = np.cbrt(np.clip(rgb, 0, 1) @ np.linalg.inv(colormaps._TO_LINEAR).T)
    return roots @ np.linalg.inv(colormaps._TO_ROOTS).T


@pytest.mark.parametrize("pair", TOGETHER)
@pytest.mark.parametrize("name", DEFICIENCIES)
def test_colors_that_are_seen_together_are_told_apart_by_everybody(name, pair):
    one, other = (oklab(np.array(DEFICIENCIES[name]) @ linear(color)) for color in TOGETHER[pair])
    assert np.linalg.norm(one - other) >= APART


@pytest.mark.parametrize(
    "program", [None, "exit 1", "echo no font", r"printf '/none.ttf\n0\n'", r"printf '\377\n'"]
)
def test_without_fonts_of_the_system_there_are_none(monkeypatch, tmp_path, program):
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setenv("PATH", str(tmp_path))
    if program is not None:
        (tmp_path / "fc-match").write_text(f"#!/bin/sh\n{program}\n")
        (tmp_path / "fc-match").chmod(0o755)
    assert theme.system_fonts() == []


def test_characters_of_the_system_s_fonts_are_shown(ui):
    """Chinese and Korean, if the system has a font for them, in the font of the interface."""
    font = imgui.get_io().fonts.fonts[0]
    assert font.is_glyph_in_font(ord("a"))
    names = [path.name for path, _ in theme.system_fonts()]
    if not any("CJK" in name for name in names):
        pytest.skip(f"the system has no font for Chinese, only {names}")
    assert all(font.is_glyph_in_font(ord(character)) for character in "猫と한")
    roboto = Path(imgui_bundle.__path__[0]) / "assets" / "fonts" / "Roboto" / "Roboto-Regular.ttf"
    em = 1000 * theme.FONT_SIZE / sum(ImageFont.truetype(roboto, 1000).getmetrics())
    width = font.get_font_baked(theme.FONT_SIZE).get_char_advance(ord("猫"))
    assert width == pytest.approx(em, abs=0.5), "a Chinese character is an em wide, of the em of Roboto"
