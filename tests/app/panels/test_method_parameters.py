"""The parameters of the current method, in the Bending section."""

import pytest

from akap_editor.app.panels import method_parameters as settings_panel
from akap_editor.app.panels.method_parameters import default_value
from akap_editor.deform.methods import get_method, make_deformer, method_names
from akap_editor.editor.document.settings import Settings
from tests.support.toy_method import TOY, add_toy_method

TREE = "Advanced"


@pytest.mark.parametrize("method", method_names())
def test_defaults_are_those_of_new_drawings(drawing, method):
    values = {each.name: default_value(method, each.name) for each in get_method(method).parameters}
    make_deformer(method, drawing.mesh, **values)
    assert default_value("akap", "memory") == Settings().get("memory") == 1.0


def labels_at(ui, hand):
    hand.set_ref("Panel")
    hand.item_click(TREE)
    hand.yield_(2)


def test_a_switch_changes_at_once_and_a_double_click_on_its_label_resets(pinned, monkeypatch):
    places = {}
    explain = settings_panel.widgets.show_tooltip

    def noting(text):
        from imgui_bundle import imgui

        if text.startswith("Smooths the field inside"):
            low = imgui.get_item_rect_min()
            places["label"] = imgui.ImVec2(low.x + 5, low.y + 5)
        explain(text)

    monkeypatch.setattr(settings_panel.widgets, "show_tooltip", noting)
    seen = []

    def act(hand):
        labels_at(pinned, hand)
        hand.item_click("**/dirichlet/##value")
        hand.yield_(2)
        seen.append(pinned.session.state.settings.get("dirichlet"))
        hand.mouse_move_to_pos(places["label"])
        hand.mouse_double_click(0)
        hand.yield_(2)
        seen.append(pinned.session.state.settings.get("dirichlet"))

    pinned.do(act)
    assert seen == [False, True]
    assert pinned.session.history.labels == ["Change Settings", "Change Settings"]


def test_a_slider_changes_once_when_it_is_let_go(pinned):
    def act(hand):
        labels_at(pinned, hand)
        hand.item_input("**/memory/##value")
        hand.key_chars_replace_enter("0.25")
        hand.yield_(2)

    pinned.do(act)
    assert pinned.session.state.settings.get("memory") == pytest.approx(0.25)
    assert pinned.session.history.labels == ["Change Settings"]


def test_a_method_without_parameters_has_no_section_of_them(pinned, monkeypatch):
    add_toy_method(monkeypatch)
    sections = []

    def choose(hand):
        hand.set_ref("Panel")
        sections.append(hand.item_exists(TREE))
        hand.combo_click(f"##method/{TOY}")
        hand.yield_(2)
        sections.append(hand.item_exists(TREE))

    pinned.do(choose)
    assert sections == [True, False]
    assert pinned.session.state.settings == Settings(TOY, ())
    start = pinned.to_screen(pinned.pin_position(3))
    rest = pinned.session.state.positions
    pinned.drag(start, (start[0], start[1] - 40))
    assert pinned.session.state.positions.tobytes() != rest.tobytes()
    pinned.menu("Edit", "Undo")
    assert pinned.session.state.positions.tobytes() == rest.tobytes()
