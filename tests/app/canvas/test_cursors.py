"""The cursors that the program draws in place of the system's."""

from imgui_bundle import imgui  # isort: skip
import glfw


def test_a_drawn_cursor_leaves_the_cursor_mode_as_it_is(pinned, monkeypatch):
    """When the mode changes, GLFW loses a motion to the present position that is queued behind a release."""
    shown, seen, set_cursor = [None], [], glfw.set_cursor

    def watch(handle, cursor):
        shown.append(cursor)
        set_cursor(handle, cursor)

    def look():
        mode = glfw.get_input_mode(pinned.window.handle, glfw.CURSOR)
        seen.append((pinned.editor.tool.cursor, mode, shown[-1]))

    monkeypatch.setattr(glfw, "set_cursor", watch)
    pinned.window.after_draw.append(look)
    pinned.bend()
    pinned.window.after_draw.clear()
    assert imgui.get_io().config_flags & imgui.ConfigFlags_.no_mouse_cursor_change, "by ImGui's backend"
    assert {mode for _, mode, _ in seen} == {glfw.CURSOR_NORMAL}
    blank = [each for cursor, _, each in seen if cursor == "grab"][-1]
    assert blank is not None
    assert [each for cursor, _, each in seen if cursor == "hand"][-1] is not blank
