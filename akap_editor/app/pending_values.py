"""Values while they are being edited: shown in their field, used once it is let go."""

from collections.abc import Callable, Hashable
from typing import TypeVar

from imgui_bundle import imgui

T = TypeVar("T")


class PendingValues:
    """Keeps what a field or slider shows until its edit ends, so that half a number moves nothing."""

    def __init__(self) -> None:
        self._values: dict[Hashable, object] = {}

    def edit(self, key: Hashable, value: T, item: Callable[[T], tuple[bool, T]]) -> T | None:
        """Draw ``item`` with its draft, or with ``value``; the new value in the frame in which an edit ends.

        key: names the draft, different for each thing that can be edited.
        """
        draft: T = self._values.get(key, value)  # type: ignore[assignment]
        changed, draft = item(draft)
        if changed and not imgui.is_item_active():  # a check box, a choice from a list
            return draft
        if changed:
            self._values[key] = draft
        if imgui.is_item_deactivated_after_edit():
            return self._values.pop(key, None)  # type: ignore[return-value]
        if not imgui.is_item_active():
            self._values.pop(key, None)
        return None
