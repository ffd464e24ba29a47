"""The first steps for newcomers."""

import pytest

from akap_editor.app import files
from akap_editor.app.commands.command import CTRL, Key
from akap_editor.app.dialogs.first_steps import STEPS, FirstSteps
from akap_editor.app.preferences import Preferences


@pytest.fixture
def newcomer(ui, tmp_path):
    """The window of a first run."""
    ui.state.preferences = Preferences(tmp_path / "preferences.json")
    ui.state.part(FirstSteps).is_open = None
    ui.settle()
    return ui


def test_the_steps_follow_what_is_done(newcomer):
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0
    newcomer.click(newcomer.to_screen((60.0, 80.0)))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 1
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 2
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == len(STEPS) - 1


def test_the_steps_never_go_back(newcomer):
    newcomer.click(newcomer.to_screen((60.0, 80.0)))
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    seen = []
    for _ in range(2):
        newcomer.key(CTRL | Key.z)
        seen.append(newcomer.state.part(FirstSteps).step(newcomer.state))
    assert not newcomer.pins
    assert seen == [2, 2]


def test_they_wait_on_the_start_page_for_a_drawing(newcomer, document):
    files.close_document(newcomer.state)
    newcomer.settle()
    bottom = newcomer.editor.canvas[3]
    files.show_document(newcomer.state, document)
    newcomer.settle()
    assert newcomer.editor.canvas[3] < bottom
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0


def test_whoever_drags_the_only_pin_is_told_why_nothing_bends(newcomer):
    start = newcomer.to_screen((200.0, 80.0))
    newcomer.drag(start, (start[0], start[1] - 100))
    assert newcomer.session.is_posed
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 0
    newcomer.click(newcomer.to_screen((60.0, 20.0)))  # the head, where it is now
    assert len(newcomer.pins) == 2
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 1
    end = newcomer.to_screen(newcomer.pin_position(1))
    newcomer.drag(end, (end[0], end[1] + 100))
    assert newcomer.state.part(FirstSteps).step(newcomer.state) == 2


@pytest.mark.parametrize("steps", [0, 2])
def test_put_away_they_are_gone_for_good(newcomer, tmp_path, steps):
    if steps:
        newcomer.click(newcomer.to_screen((60.0, 80.0)))
        start = newcomer.to_screen((200.0, 80.0))
        newcomer.drag(start, (start[0], start[1] - 100))
    bottom = newcomer.editor.canvas[3]
    newcomer.do(lambda hand: hand.item_click("//First steps/###away"))
    assert not newcomer.state.part(FirstSteps).is_open
    assert newcomer.editor.canvas[3] > bottom, "the canvas has the room again"
    newcomer.window.remember()
    assert not FirstSteps.is_wanted(Preferences(tmp_path / "preferences.json"))


def test_whoever_has_no_preferences_to_keep_sees_no_first_steps():
    assert not FirstSteps.is_wanted(Preferences())
