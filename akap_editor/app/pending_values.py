"""Values of fields and sliders while the user edits them; they are applied when the edit ends."""

from collections.abc import Callable, Hashable
from typing import TypeVar

from imgui_bundle import imgui

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
