"""Values of fields and sliders while the user edits them; they are applied when the edit ends."""

from collections.abc import Callable, Hashable
from typing import TypeVar

from imgui_bundle import ImVec2, imgui

T = TypeVar("T")


class PendingValues:
    """Keeps what fields and sliders show during an edit, so that a half-typed number changes nothing."""

    def __init__(self) -> None:
        self._values: dict[Hashable, object] = {}

    def edit(self, key: Hashable, value: T, item: Callable[[T], tuple[bool, T]]) -> T | None:
        """Draw an item; return the new value in the frame in which its edit ends, otherwise None.

        key: another one for each item; value: is shown unless an edit is under way; item: draws a value and
        returns whether it was changed, and the value.
        """
        pending: T = self._values.get(key, value)  # type: ignore[assignment]
        is_changed, pending = item(pending)
        if is_changed and not imgui.is_item_active():  # a check box, or a choice from a list
            return pending
        if is_changed:
            self._values[key] = pending
        if imgui.is_item_deactivated_after_edit():
            return self._values.pop(key, None)  # type: ignore[return-value]
        if not imgui.is_item_active():
            self._values.pop(key, None)
        return None


class NameField:
    """A field in place of one name in a list, while that is changed.

    key: of the entry whose name is changed, None if there is none.
    """

    def __init__(self) -> None:
        self.key: Hashable | None = None
        self._typed: str | None = None  # None until the field has the keyboard

    def begin(self, key: Hashable) -> None:
        """Change the name of an entry."""
        self.key, self._typed = key, None

    def draw(self, label: str, name: str, width: float) -> str | None:
        """Draw the field; return the new name in the frame in which Enter or a click elsewhere accepts it.

        Escape keeps ``name``. label: ImGui's; width: in points.
        """
        if self._typed is None:  # in every frame: a mouse button that is still down takes the focus away
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(width)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.2 * imgui.get_font_size(), 0))
        typed = name if self._typed is None else self._typed
        _, typed = imgui.input_text(label, typed, imgui.InputTextFlags_.auto_select_all)
        imgui.pop_style_var()
        if imgui.is_item_active():
            self._typed = typed
        if not imgui.is_item_deactivated():
            return None
        new_name, self.key = (name if self._typed is None else self._typed).strip(), None
        return None if new_name == name or imgui.is_key_pressed(imgui.Key.escape, False) else new_name
