"""The tabs and the width of the side panel, and the parts of the frame that are hidden."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.app_state import AppState
from akap_editor.app.frame import layout
from akap_editor.app.frame.layout import DEFAULT_WIDTH, MAX_WIDTH, MIN_WIDTH
from akap_editor.app.preferences import Preferences

MOVED = 60.0  # points


def border(ui):
    """A point on the left border of the side panel."""
    right, top = ui.editor.canvas[2], ui.editor.canvas[1]
    return right + 2.0, top + 300.0


def width(ui):
    return 1280 - ui.editor.canvas[2]


def test_each_tab_shows_its_sections_and_only_these(pinned):
    seen = {}

    def look(hand):
        names = ("Pins", "Poses", "Bending", "History", "Keyframes", "Onion skin", "Playback", "Mesh", "View")
        return [name for name in names if hand.item_exists(f"//Panel/###section {name}")]

    for tab in layout.TABS:
        pinned.tab(tab)
        pinned.do(lambda hand, tab=tab: seen.update({tab: look(hand)}))
    assert seen == {
        "Pose": ["Pins", "Poses", "Bending", "History"],
        "Animate": ["Keyframes", "Onion skin", "Playback"],
        "Mesh": ["Mesh", "View"],
    }


def test_the_border_resizes_the_panel_and_a_double_click_resets_it(pinned):
    assert width(pinned) == DEFAULT_WIDTH
    x, y = border(pinned)
    pinned.drag((x, y), (x - MOVED / 2, y), (x - MOVED, y))
    assert width(pinned) == pytest.approx(DEFAULT_WIDTH + MOVED, abs=4)

    def double_click(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*border(pinned)))
        hand.mouse_double_click(0)

    pinned.do(double_click)
    assert width(pinned) == DEFAULT_WIDTH


@pytest.mark.parametrize(("x", "expected"), [(1270.0, MIN_WIDTH), (100.0, MAX_WIDTH)])
def test_the_panel_gets_neither_too_narrow_nor_too_wide(pinned, x, expected):
    start = border(pinned)
    pinned.drag(start, (x, start[1]))
    assert width(pinned) == expected


@pytest.mark.parametrize("stored", [1e9, -5, float("nan"), float("inf"), "wide", None, True])
def test_a_remembered_width_is_one_that_there_is(stored):
    preferences = Preferences()
    preferences.put("side panel width", stored)
    state = AppState(preferences=preferences)
    assert MIN_WIDTH <= layout.side_panel_width(state, 1.0, 1280.0) <= MAX_WIDTH


def test_what_is_chosen_comes_back(tmp_path):
    path = tmp_path / "preferences.json"
    state = AppState(preferences=Preferences(path))
    layout.show_tab(state, "Mesh")
    layout.resize_side_panel(state, 640.0, 2.0)
    layout.toggle(state, "toolbar")
    state.save_preferences()
    again = AppState(preferences=Preferences(path))
    assert layout.current_tab(again) == "Mesh"
    assert layout.side_panel_width(again, 1.0, 1280.0) == 320.0
    assert not layout.is_shown(again, "toolbar")
    assert layout.is_shown(again, "side panel")


def test_a_tab_that_is_asked_for_shows_the_hidden_panel(pinned):
    pinned.state.panels_are_hidden = True
    pinned.menu("View", "Panels", "Mesh Tab")
    assert width(pinned) == DEFAULT_WIDTH
    pinned.menu("View", "Panels", "Show Side Panel")
    assert width(pinned) == 0
    pinned.menu("View", "Panels", "Animate Tab")
    assert width(pinned) == DEFAULT_WIDTH
