"""Parameters of methods in the panel, the list of steps, and what is remembered for new drawings."""

import json

import pytest

from akap_editor.app import files
from akap_editor.app.app_state import AppState
from akap_editor.app.panels import method_parameters as settings_panel
from akap_editor.app.panels.method_parameters import default_value
from akap_editor.app.preferences import Preferences
from akap_editor.deform.methods import get_method, make_deformer, method_names
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.editor import Editor
from tests.support.toy_method import TOY, add_toy_method

TREE = "Parameters"


@pytest.mark.parametrize("method", method_names())
def test_defaults_are_those_of_new_drawings(drawing, method):
    values = {each.name: default_value(method, each.name) for each in get_method(method).parameters}
    make_deformer(method, drawing.mesh, **values)
    assert default_value("akap", "memory") == Settings().get("memory") == 1.0


def labels_at(ui, hand):
    hand.set_ref("Panel")
    hand.item_open(TREE)
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


# -- history ------------------------------------------------------------------------------------------------


def click(hand, label):
    hand.set_ref("Panel")
    hand.item_click(label)


def test_a_click_on_a_step_goes_there_and_back(pinned):
    poses = [pinned.session.state]
    for pin, dy in ((3, -60), (3, 40), (1, 30)):
        start = pinned.to_screen(pinned.pin_position(pin))
        pinned.drag(start, (start[0], start[1] + dy))
        poses.append(pinned.session.state)
    pinned.state.notice = "Saved figure.akap"
    for index in (1, 0, 3, 2):
        name = "Drag Pin" if index else "Open"
        pinned.do(lambda hand, label=f"**/  {name}##step {index}": click(hand, label))
        assert pinned.session.history.depth == index
        assert not pinned.state.notice, "it is about something else"
        assert pinned.session.state.positions.tobytes() == poses[index].positions.tobytes()
    assert pinned.session.history.labels == ["Drag Pin"] * 3


def test_there_is_no_going_beyond_the_ends(drawing):
    editor = Editor()
    editor.undo_or_redo_to(3)
    editor.open(new_document(drawing))
    gestures.add_pin(editor, (50.0, 80.0))
    for depth, expected in ((-2, 0), (9, 1)):
        editor.undo_or_redo_to(depth)
        assert editor.session.history.depth == expected


# -- between runs -------------------------------------------------------------------------------------------


def test_a_new_drawing_bends_as_was_chosen_last_also_in_another_run(tmp_path, document):
    path = tmp_path / "preferences.json"
    first = AppState(preferences=Preferences(path))
    files.show_document(first, document)
    assert first.document.state.settings == Settings()
    chosen = Settings("arap", (("iterations", 7),))
    first.change_settings(chosen)
    first.preferences.write()
    second = AppState(preferences=Preferences(path))
    files.show_document(second, document)
    assert second.document.state.settings == chosen
    assert second.editor.session.history.depth == 0
    assert not second.editor.is_modified


def test_a_drawing_with_settings_of_its_own_keeps_them(document, drawing):
    state = AppState()
    files.show_document(state, document)
    state.change_settings(Settings("arap", ()))
    files.show_document(state, new_document(drawing, Settings("mls", ())))
    assert state.document.state.settings.method == "mls"


@pytest.mark.parametrize(
    "remembered",
    [
        {"method": "no such", "parameters": {}},
        {"method": "akap", "parameters": {"no such": 1}},
        {"method": "akap", "parameters": {"memory": 7}},
        {"method": "akap", "parameters": {"memory": "much"}},
        {"method": 3},
        {"parameters": []},
    ],
)
def test_remembered_settings_that_make_no_sense_are_ignored(tmp_path, document, remembered):
    path = tmp_path / "preferences.json"
    path.write_text(json.dumps({"settings": remembered}))
    state = AppState(preferences=Preferences(path))
    files.show_document(state, document)
    assert state.document.state.settings == Settings()
