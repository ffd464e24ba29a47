"""The frame around the canvas."""

import pytest

from akap_editor.app.panels import side_panel as panels
from akap_editor.errors import SolverError


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (SolverError("the numbers are not finite"), "the numbers are not finite"),
        (
            KeyError("oops"),
            "Something went wrong in the program (KeyError: 'oops'). Your drawing is still open.",
        ),
    ],
)
def test_an_error_in_a_panel_leaves_the_window_usable(pinned, monkeypatch, capfd, error, message):
    def fail(state, scale):
        raise error

    with monkeypatch.context() as patch:
        patch.setattr(panels, "SECTIONS", (*panels.SECTIONS, panels.Section("Broken", fail, "Pose")))
        pinned.frame()
        assert pinned.state.error == message
    assert ("Traceback" in capfd.readouterr().err) == isinstance(error, KeyError)
    pinned.settle()
    pinned.dialog("Error", "OK")
    assert not pinned.state.error
    pinned.bend()
    pinned.menu("Edit", "Undo")
    assert not pinned.session.is_posed
