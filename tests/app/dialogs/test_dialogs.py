"""The choice of the dialog that is drawn."""

import pytest

from akap_editor.app.commands.command import Key
from akap_editor.app.commands.shortcuts_page import ShortcutsPage
from akap_editor.app.dialogs.about import AboutDialog


@pytest.mark.parametrize(
    ("label", "page", "title"),
    [
        ("Keyboard Shortcuts", ShortcutsPage, "Keyboard shortcuts"),
        ("About akap-editor", AboutDialog, "About akap-editor"),
    ],
)
@pytest.mark.parametrize("close", ["Close", "escape", "enter"])
def test_help_opens_and_closes(pinned, label, page, title, close):
    pinned.menu("Help", label)
    assert pinned.state.part(page).is_open
    if close == "Close":
        pinned.dialog(title, "Close")
    else:
        pinned.key(Key.escape if close == "escape" else Key.enter)
    assert not pinned.state.part(page).is_open
    pinned.click(pinned.to_screen((100.0, 80.0)))
    assert len(pinned.pins) == 4, "the canvas is free again"
