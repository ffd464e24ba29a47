"""The OpenGL context of the window."""

from akap_editor.render.offscreen import standalone_context


def test_a_window_opens_beside_a_context_that_needs_no_window(new_window):
    """As in a program that has rendered before."""
    other = standalone_context()
    try:
        window = new_window()
        window.settle()
        assert window.window.ctx is not other
        assert window.window.ctx.version_code >= 330
    finally:
        other.release()
