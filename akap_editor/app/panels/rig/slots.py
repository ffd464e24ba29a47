"""The slots of switch layers below the layer list: a row of pictures each, of which a click chooses one."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ....editor import gestures
from ....layers.layer_view import slot_members
from ....words import mark, tr
from ... import widgets
from ...app_state import AppState
from ...pending_values import NameField
from ...theme import SECONDARY
from .layer_thumbnails import THUMBNAIL_SIDE, draw_thumbnail


class SlotPickers:
    """The rows; a double click on the name of a slot, or F2, renames it."""

    def __init__(self) -> None:
        self._name_field = NameField()

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        assert state.document is not None
        for slot, members in slot_members(state.document.drawing.layers).items():
            self._draw_slot(state, slot, members, scale)

    def _draw_slot(self, state: AppState, slot: str, members: list[int], scale: float) -> None:
        side, left = round(THUMBNAIL_SIDE * scale), imgui.get_cursor_pos_x()
        label_width, gap = widgets.label_column(tr("Opacity")) - left, 4 * scale  # as the slider below
        top, right = imgui.get_cursor_pos_y(), left + imgui.get_content_region_avail().x
        imgui.set_cursor_pos_y(top + (side - imgui.get_text_line_height()) / 2)
        self._draw_name(state, slot, members, label_width - gap)
        x, y = left + label_width, top
        for number in members:
            if x + side > right:
                x, y = left + label_width, y + side + gap
            imgui.set_cursor_pos(ImVec2(x, y))
            _draw_choice(state, slot, number, side, scale)
            x += side + gap
        imgui.set_cursor_pos(ImVec2(left, y + side + imgui.get_style().item_spacing.y))
        imgui.dummy(ImVec2(0, 0))
        imgui.set_cursor_pos(ImVec2(left, y + side + imgui.get_style().item_spacing.y))

    def _draw_name(self, state: AppState, slot: str, members: list[int], width: float) -> None:
        if self._name_field.key == slot:
            name = self._name_field.draw("##new slot name", slot, width)
            if name:
                state.run_reporting_errors(
                    lambda: gestures.set_layers(state.editor, mark("Rename Slot"), members, slot=name)
                )
            return
        imgui.push_style_color(imgui.Col_.text, ImVec4(*SECONDARY))
        flags, size = imgui.SelectableFlags_.allow_double_click, ImVec2(width, 0)
        label = widgets.shortened(widgets.as_label(slot), width)
        is_clicked = imgui.selectable(f"{label}###slot {slot}", False, flags, size)[0]
        imgui.pop_style_color()
        is_at = imgui.is_item_hovered() or imgui.is_item_focused()
        if (is_clicked and imgui.is_mouse_double_clicked(0)) or (
            is_at and imgui.is_key_pressed(imgui.Key.f2, False)
        ):
            self._name_field.begin(slot)
        widgets.show_tooltip(
            tr("Switch layers “{slot}”: one of them is shown. Double-click or F2 to rename.", slot=slot)
        )


def _draw_choice(state: AppState, slot: str, number: int, side: int, scale: float) -> None:
    """Draw the picture of a layer of a slot; a click shows it in place of the others."""
    assert state.document is not None
    layer, corner = state.document.drawing.layers[number], imgui.get_cursor_screen_pos()
    if imgui.invisible_button(f"choose {number}", ImVec2(side, side)):
        state.notice = ""
        state.view.selected_layer = number
        if not layer.visible:
            switch_to(state, number)
    widgets.show_tooltip(layer.name)
    draw_thumbnail(state, layer, corner, side, scale, layer.visible)


def switch_to(state: AppState, number: int) -> None:
    """Show a layer of a slot in place of the others."""
    state.run_reporting_errors(
        lambda: gestures.set_layers(state.editor, mark("Switch Layer"), [number], visible=True)
    )
