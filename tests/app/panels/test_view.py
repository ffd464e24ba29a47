"""The View section of the side panel."""

import pytest


@pytest.mark.parametrize(
    ("label", "name"), [("Mesh", "show_mesh"), ("Pins", "show_pins"), ("Checkerboard", "show_checkerboard")]
)
def test_view_switches(pinned, label, name):
    pinned.tab("Mesh")
    before = getattr(pinned.state.view, name)
    picture = pinned.screenshot()
    pinned.panel(label)
    assert getattr(pinned.state.view, name) != before
    left, top, right, bottom = map(round, pinned.editor.canvas)
    assert (pinned.screenshot() != picture)[top:bottom, left:right].any()
    pinned.panel(label)
    assert getattr(pinned.state.view, name) == before
    assert not pinned.editor.is_modified
