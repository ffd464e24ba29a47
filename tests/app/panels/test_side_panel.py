"""The frame around the canvas."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.frame import layout
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


def test_a_scroll_bar_leaves_the_contents_their_width(pinned):
    """Otherwise it comes and goes where lower contents need none, and everything jumps."""
    seen = []

    def look(hand):
        scroll = imgui.internal.find_window_by_name("Panel").scroll_max.y
        seen.append((scroll > 0, hand.item_info("//Panel/###section Pins").rect_full.get_width()))

    for is_open in (False, True):
        layout.show_tab(pinned.state, "Pose")
        titles = (*(section.title for section in panels.SECTIONS), "Parameters")
        pinned.state.preferences.put("sections", dict.fromkeys(titles, is_open))
        pinned.settle()
        pinned.do(look)
    (first_scrolls, first), (second_scrolls, second) = seen
    assert (first_scrolls, second_scrolls) == (False, True)
    assert first == second
