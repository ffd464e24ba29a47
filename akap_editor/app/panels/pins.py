"""The Pins section: a list of the pins with eye, padlock, name and depth."""

from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor import gestures
from ...editor.document.pin import MAX_DEPTH, Pin
from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..pending_values import NameField, PendingValues
from . import parts

_ROWS = 6  # pins that are visible at once
_ICON_WIDTH, _NAME_GAP, _DEPTH_WIDTH = 1.7, 0.3, 3.0  # times the font size


def pin_count(state: AppState) -> str:
    """The number of pins for the section's title; empty if there are none."""
    count = len(state.document.state.pins) if state.document is not None else 0
    return str(count or "")


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    state.part(PinList).draw(state)


class PinList:
    """The list; a double click on a name, or F2, renames the pin there."""

    def __init__(self) -> None:
        self._name_field = NameField()

    def draw(self, state: AppState) -> None:
        """Draw the list, which has the same height for any number of pins."""
        assert state.document is not None
        pins = state.document.state.pins
        parts.begin_list("##pins", _ROWS)
        if not pins:
            widgets.secondary_text(tr("None yet. Click on the drawing where it should hold still."))
        for index, pin in enumerate(pins):
            self._draw_row(state, pin, index)
        parts.end_list()

    def _draw_row(self, state: AppState, pin: Pin, index: int) -> None:
        editor, font_size = state.editor, imgui.get_font_size()
        left, room = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
        if pin.id in editor.selection:
            parts.draw_highlight(imgui.get_text_line_height())
        eye = icons.ICON_FA_EYE_SLASH if pin.is_hidden else icons.ICON_FA_EYE
        if widgets.icon_switch(
            eye,
            f"eye {pin.id}",
            not pin.is_hidden,
            tr("Hide on the canvas; it still holds the drawing"),
            _ICON_WIDTH,
        ):
            state.run_reporting_errors(lambda: gestures.set_pin_hidden(editor, pin.id, not pin.is_hidden))
        imgui.same_line(left + _ICON_WIDTH * font_size)
        lock = icons.ICON_FA_LOCK if pin.is_locked else icons.ICON_FA_LOCK_OPEN
        if widgets.icon_switch(
            lock,
            f"lock {pin.id}",
            pin.is_locked,
            tr("Lock: it cannot be moved or removed by hand"),
            _ICON_WIDTH,
        ):
            state.run_reporting_errors(lambda: gestures.set_pin_locked(editor, pin.id, not pin.is_locked))
        imgui.same_line(left + (2 * _ICON_WIDTH + _NAME_GAP) * font_size)
        name_width = room - (2 * _ICON_WIDTH + _NAME_GAP + _DEPTH_WIDTH + 0.4) * font_size
        if self._name_field.key == pin.id:
            name = self._name_field.draw("##new name", pin.label, name_width)
            if name is not None:
                state.run_reporting_errors(lambda: gestures.rename_pin(editor, pin.id, name))
        else:
            self._draw_name(state, pin, name_width)
        if editor.selection == {pin.id}:
            parts.scroll_to_row(index, _ROWS)
        imgui.same_line(left + room - _DEPTH_WIDTH * font_size)
        _draw_depth(state, pin)

    def _draw_name(self, state: AppState, pin: Pin, width: float) -> None:
        editor = state.editor
        label = widgets.shortened(pin.label, width)
        flags = imgui.SelectableFlags_.allow_double_click
        if imgui.selectable(f"{label}###name {pin.id}", False, flags, ImVec2(width, 0))[0]:
            if imgui.is_mouse_double_clicked(0):
                self._name_field.begin(pin.id)
            extends = imgui.get_io().key_shift
            editor.select(editor.selection ^ {pin.id} if extends else {pin.id})
        is_at = imgui.is_item_hovered() or imgui.is_item_focused()
        if is_at and imgui.is_key_pressed(imgui.Key.f2, False):
            self._name_field.begin(pin.id)
        target = f"{pin.target[0]:.0f}, {pin.target[1]:.0f}"
        widgets.show_tooltip(
            tr("{pin} at {target}. Double-click or F2 to rename.", pin=pin.label, target=target)
        )


def _draw_depth(state: AppState, pin: Pin) -> None:
    """Draw the depth as a number that is dragged or typed."""
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.2 * imgui.get_font_size(), 0))
    imgui.push_style_color(imgui.Col_.frame_bg, ImVec4(0, 0, 0, 0))
    imgui.set_next_item_width(_DEPTH_WIDTH * imgui.get_font_size())
    depth = state.part(PendingValues).edit(
        ("depth in list", pin.id),
        pin.depth,
        lambda value: imgui.drag_int(
            f"###depth {pin.id}", value, 0.05, -MAX_DEPTH, MAX_DEPTH, "%+d" if value else "%d"
        ),
    )
    imgui.pop_style_color()
    imgui.pop_style_var()
    widgets.show_tooltip(
        tr("Depth: where limbs overlap, the higher number is in front. Drag, or double-click.")
    )
    if depth is not None and depth != pin.depth:
        state.run_reporting_errors(lambda: gestures.set_depth(state.editor, pin.id, depth))
