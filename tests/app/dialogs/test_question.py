"""The question before something is lost."""

import pytest

from akap_editor.app.commands.command import CTRL, Key
from akap_editor.app.dialogs.question import QuestionDialog

UNSAVED = "Unsaved changes"


@pytest.mark.parametrize(("button", "left"), [("Don't Save", False), ("Cancel", True)])
def test_enter_uses_the_button_that_the_keyboard_is_at(bent, button, left):
    bent.key(CTRL | Key.w)
    assert bent.state.part(QuestionDialog).is_open
    bent.enter_at(f"//{UNSAVED}###dialog {UNSAVED}/{button}")
    assert not bent.state.part(QuestionDialog).is_open
    assert bent.file_request is None, "nothing is to be saved"
    assert (bent.state.document is not None) == left
