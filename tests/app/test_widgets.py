"""Widgets that panels and dialogs share."""

import pytest
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from akap_editor.app.commands.registry import PIN_TOOL

ITEMS = {
    "Tools": f"{PIN_TOOL.icon}##{PIN_TOOL.label}",
    "Panel": "Remember rest shape",
    "Timeline": f"{icons.ICON_FA_REPEAT}##loop",
}


@pytest.mark.parametrize("bar", ITEMS)
def test_a_tooltip_covers_nothing_of_the_bar_that_it_belongs_to(pinned, bar):
    pinned.state.timeline.is_shown = True
    pinned.settle()
    seen = []

    def look():
        for window in imgui.get_current_context().windows:
            if window.name.startswith("##Tooltip") and window.active:
                seen.append((imgui.internal.find_window_by_name(bar).rect(), window.rect()))

    def rest(hand):
        hand.mouse_move(f"//{bar}/{ITEMS[bar]}")
        hand.sleep_no_skip(1.0, 1 / 30)
        pinned.on_main_thread(hand, look)

    pinned.do(rest)
    ((window, tooltip),) = seen
    assert not window.overlaps(tooltip), (window, tooltip)
