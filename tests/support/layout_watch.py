"""Watches what a frame of the window draws, and finds texts that are cut off or lie over each other."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import combinations
from typing import Any, NamedTuple

import pytest
from imgui_bundle import ImVec2, imgui

# Items of ImGui whose first argument is their label, with the place of the label in the item.
_CENTERED = ("button", "small_button")
_LEFT = ("selectable", "menu_item", "menu_item_simple", "begin_menu")
_AT_THE_END = ("checkbox", "radio_button", "input_int", "input_float")
_TEXTS = ("text", "text_unformatted", "text_colored", "text_wrapped")
_FIELDS = ("drag_float", "drag_int")
_TOLERANCE = 1.0  # points


class Box(NamedTuple):
    """A rectangle of the screen, points."""

    left: float
    top: float
    right: float
    bottom: float

    @classmethod
    def of(cls, low: ImVec2, high: ImVec2) -> "Box":
        return cls(low.x, low.y, high.x, high.y)

    def overlaps(self, other: "Box") -> bool:
        """Whether two rectangles have more in common than a rim."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.bottom, other.bottom) - max(self.top, other.top)
        return width > _TOLERANCE and height > 0.2 * (self.bottom - self.top)


class Drawn(NamedTuple):
    """A text that was drawn. clip: the rectangle outside of which nothing of it is seen."""

    text: str
    window: str
    box: Box
    clip: Box

    @property
    def is_seen(self) -> bool:
        """Whether its middle line is in the part of the window that is seen; not scrolled away."""
        middle = (self.box.top + self.box.bottom) / 2
        return self.clip.top <= middle <= self.clip.bottom and self.clip.left < self.clip.right

    @property
    def is_cut(self) -> bool:
        """Whether a part of it is beyond the left or right edge."""
        return self.box.left < self.clip.left - _TOLERANCE or self.box.right > self.clip.right + _TOLERANCE


class LayoutWatch:
    """The texts of the frame that was drawn last.

    faults: what is wrong with them, a sentence each.
    """

    def __init__(self) -> None:
        self.texts: list[Drawn] = []
        self.narrow: list[str] = []

    def begin_frame(self) -> None:
        """Forget the texts of earlier frames."""
        self.texts, self.narrow = [], []

    @property
    def faults(self) -> list[str]:
        """What is wrong, once each."""
        seen = [drawn for drawn in self.texts if drawn.is_seen and drawn.text.strip()]
        cut = [f"{each.window}: “{each.text}” is cut off at the edge" for each in seen if each.is_cut]
        over = [
            f"{one.window}: “{one.text}” and “{other.text}” lie over each other"
            for one, other in combinations(seen, 2)
            if one.window == other.window and one.box.overlaps(other.box)
        ]
        return sorted({*self.narrow, *cut, *over})

    def note(self, text: str, box: Box, clip: Box | None = None) -> None:
        """Note a text that the current window draws."""
        window = imgui.internal.get_current_window_read()
        if window.hidden or window.skip_items:
            return
        shown = clip or Box.of(window.clip_rect.min, window.clip_rect.max)
        self.texts.append(Drawn(text, window.name, box, shown))

    def note_narrow(self, text: str, room: float) -> None:
        """Note a label if its item, which has ``room`` points, is narrower."""
        width = imgui.calc_text_size(text).x
        if width > room + _TOLERANCE:
            window = imgui.internal.get_current_window_read().name
            self.narrow.append(f"{window}: “{text}” needs {width:.0f} points and has {room:.0f}")


def _shown(label: str) -> str:
    """What ImGui shows of a label."""
    return label.partition("##")[0]


def _watched(watch: LayoutWatch, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of ImGui that also notes the text of its item."""

    def call(*args: Any, **options: Any) -> Any:
        result = function(*args, **options)
        label = str(args[1] if name == "text_colored" else args[0])
        text = label if name in _TEXTS else _shown(label)
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        size, padding = imgui.calc_text_size(text), imgui.get_style().frame_padding
        if name in _TEXTS:
            watch.note(text, Box.of(low, high))
        elif name in _FIELDS:
            number = args[1] if len(args) > 1 else options["v"]
            text_format = next((arg for arg in args[2:] if isinstance(arg, str)), "")
            if text_format:
                watch.note_narrow(text_format % number, high.x - low.x - 2 * padding.x)
        elif name == "begin_combo":
            watch.note_narrow(args[1], high.x - low.x - (high.y - low.y) - 2 * padding.x)
        elif text:
            top = (low.y + high.y - size.y) / 2
            left = low.x
            if name in _CENTERED:
                left = max(low.x, (low.x + high.x - size.x) / 2)
                watch.note_narrow(text, high.x - low.x - min(padding.x, 2) * 2)
            elif name in _AT_THE_END:
                left = high.x - size.x
            watch.note(text, Box(left, top, left + size.x, top + size.y))
        return result

    return call


@contextmanager
def watching() -> Iterator[LayoutWatch]:
    """While this lasts, all texts that the window draws are noted."""
    watch = LayoutWatch()
    draw_text = imgui.ImDrawList.add_text

    def add_text(draw_list: Any, *args: Any) -> None:
        draw_text(draw_list, *args)
        if len(args) == 3:
            corner, _, text = args
            size = imgui.calc_text_size(text)
            clip = Box.of(draw_list.get_clip_rect_min(), draw_list.get_clip_rect_max())
            watch.note(text, Box(corner.x, corner.y, corner.x + size.x, corner.y + size.y), clip)

    with pytest.MonkeyPatch.context() as patch:
        for name in (*_CENTERED, *_LEFT, *_AT_THE_END, *_TEXTS, *_FIELDS, "begin_combo"):
            patch.setattr(imgui, name, _watched(watch, name, getattr(imgui, name)))
        patch.setattr(imgui.ImDrawList, "add_text", add_text)
        yield watch
