"""Keys in the order in which they were pressed, also where a whole shortcut falls into one frame."""

from typing import Any

import glfw
from imgui_bundle import imgui

_MODIFIERS = range(glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SUPER + 1)
_UNUSED = imgui.Key.f24  # no command has it


def on_key(window: Any, key: int, scancode: int, action: int, mods: int) -> None:
    """GLFW's key callback, to be set before ImGui's, which calls it first.

    ImGui looks at the modifiers at the end of a frame: of Ctrl and D down, Ctrl up, it would see a D only.
    But it takes no second event of the same key into a frame, so that two of a key that means nothing end it.
    """
    if key in _MODIFIERS and action == glfw.RELEASE:
        io = imgui.get_io()
        io.add_key_event(_UNUSED, True)
        io.add_key_event(_UNUSED, False)
