"""Widgets that panels and dialogs share."""

import pytest
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from akap_editor.app import widgets
from akap_editor.app.commands.registry import PIN_TOOL
from akap_editor.words import use_language

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


@pytest.mark.parametrize(
    ("value", "text_format", "english", "german"),
    [
        (1.25, "%.1f px", "1.2 px", "1,2 px"),
        (1.25, "%+.2f°", "+1.25°", "+1,25°"),
        (23.976, "%.4g fps", "23.98 fps", "23,98 fps"),
        (24.0, "%.4g fps", "24 fps", "24 fps"),
        (12.5, "%.1f %%", "12.5 %", "12,5 %"),
        (3, "%+d", "+3", "+3"),
    ],
)
def test_numbers_of_fields_and_sliders_are_in_the_language(value, text_format, english, german):
    assert widgets.number_with_unit(value, text_format) == text_format % value == english
    use_language("de")
    try:
        assert widgets.number_with_unit(value, text_format) == german
    finally:
        use_language("en")
