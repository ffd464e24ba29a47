"""The Layers section: the layers of the drawing from front to back, with their switches."""

from collections.abc import Sequence

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui
from imgui_bundle import icons_fontawesome_6 as icons
from PIL import Image

from ...editor import gestures
from ...io.images import Picture
from ...layers.drawing_layer import DrawingLayer, shown_layers
from .. import widgets
from ..app_state import AppState
from ..commands.command import context_menu_pressed
from ..pending_values import NameField
from ..theme import ACCENT, FRAME, HOVER, SECONDARY, TEXT, packed

LAYER_PAYLOAD = "LAYER"  # of drag and drop: the number of a layer
_ROWS = 8  # layers that are visible at once
_SIDE = 26  # of a thumbnail, in design points
_ICON_WIDTH = 1.7  # times the font size
_LABEL_WIDTH = 4.6  # times the font size


def layer_count(state: AppState) -> str:
    """The number of layers for the section's title."""
    return str(len(state.document.drawing.layers)) if state.document is not None else ""


def is_shown(state: AppState) -> bool:
    """Whether the drawing has layers."""
    return state.document is not None and bool(state.document.drawing.layers)


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    state.part(LayerList).draw(state, scale)


class LayerList:
    """The list; a double click on a name, or F2, renames the layer there.

    The selected layer is `ViewOptions.selected_layer`. A click on the canvas that selects a pin selects the
    pin's layer, too.
    """

    def __init__(self) -> None:
        self._name_field = NameField()
        self._pin: int | None = None  # the one that chose the layer

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        assert state.document is not None
        drawing = state.document.drawing
        self._follow_pins(state)
        shown = shown_layers(drawing.layers)
        step = _SIDE * scale + imgui.get_style().item_spacing.y
        imgui.begin_child("##layers", ImVec2(0, min(len(shown), _ROWS) * step), widgets.NAV_FLATTENED)
        for place in range(len(shown) - 1, -1, -1):
            number = drawing.layer_order[place]
            self._draw_row(state, number, place, bool(shown[number]), scale)
        imgui.end_child()
        selected = selected_layer(state)
        imgui.begin_disabled(selected is None)
        _draw_opacity(state, drawing.layers, selected)
        imgui.end_disabled()

    def _follow_pins(self, state: AppState) -> None:
        """Select the layer of a pin that has just been selected."""
        editor = state.editor
        pin = next(iter(editor.selection)) if len(editor.selection) == 1 else None
        if pin != self._pin:
            self._pin = pin
            faces = {each.id: each.face for each in state.document.state.pins} if state.document else {}
            if pin in faces and state.document is not None:
                state.view.selected_layer = int(state.document.drawing.face_layers[faces[pin]])

    def _draw_row(self, state: AppState, number: int, place: int, shown: bool, scale: float) -> None:
        assert state.document is not None
        layer = state.document.drawing.layers[number]
        font_size, top = imgui.get_font_size(), imgui.get_cursor_pos_y()
        left, room = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
        side = round(_SIDE * scale)
        middle = top + (side - imgui.get_text_line_height()) / 2
        imgui.set_cursor_pos_y(middle)
        eye = icons.ICON_FA_EYE if layer.visible else icons.ICON_FA_EYE_SLASH
        if widgets.icon_switch(eye, f"eye {number}", layer.visible, "Show or hide", _ICON_WIDTH):
            label = "Hide Layer" if layer.visible else "Show Layer"
            _set(state, label, number, visible=not layer.visible)
        imgui.set_cursor_pos(ImVec2(left + _ICON_WIDTH * font_size, top))
        corner = imgui.get_cursor_screen_pos()
        name_left = left + _ICON_WIDTH * font_size + side + 0.5 * font_size
        name_width = room - (name_left - left) - (2 * _ICON_WIDTH + 0.2) * font_size
        if self._name_field.key == number:
            imgui.set_cursor_pos(ImVec2(name_left, middle))
            name = self._name_field.draw("##new name", layer.name, name_width)
            if name:
                _set(state, "Rename Layer", number, title=name)
        else:
            width = room - (corner.x - imgui.get_window_pos().x - left) - (2 * _ICON_WIDTH + 0.2) * font_size
            self._draw_name(state, layer, number, place, ImVec2(width, side))
            color = TEXT if shown else SECONDARY
            text = ImVec2(corner.x + side + 0.5 * font_size, corner.y + middle - top)
            label = widgets.shortened(layer.name, name_width)
            imgui.get_window_draw_list().add_text(text, packed(color), label)
        _draw_thumbnail(state, layer, corner, side, scale)
        imgui.set_cursor_pos(ImVec2(left + room - 2 * _ICON_WIDTH * font_size, middle))
        if widgets.icon_switch(
            icons.ICON_FA_STAR,
            f"solo {number}",
            layer.solo,
            "Solo: show only this and other such layers",
            _ICON_WIDTH,
        ):
            _set(state, "Unsolo Layer" if layer.solo else "Solo Layer", number, solo=not layer.solo)
        imgui.set_cursor_pos(ImVec2(left + room - _ICON_WIDTH * font_size, middle))
        lock = icons.ICON_FA_LOCK if layer.locked else icons.ICON_FA_LOCK_OPEN
        if widgets.icon_switch(
            lock, f"lock {number}", layer.locked, "Lock: clicks go through to the layers behind", _ICON_WIDTH
        ):
            _set(state, "Unlock Layer" if layer.locked else "Lock Layer", number, locked=not layer.locked)
        imgui.set_cursor_pos(ImVec2(left, top + side + imgui.get_style().item_spacing.y))
        imgui.dummy(ImVec2(0, 0))
        imgui.set_cursor_pos(ImVec2(left, top + side + imgui.get_style().item_spacing.y))

    def _draw_name(self, state: AppState, layer: DrawingLayer, number: int, place: int, size: ImVec2) -> None:
        """Draw the part of a row that is clicked, dragged and has a menu."""
        flags = imgui.SelectableFlags_.allow_double_click
        is_selected = selected_layer(state) == number
        if imgui.selectable(f"###layer {number}", is_selected, flags, size)[0]:
            state.view.selected_layer = number
            if imgui.is_mouse_double_clicked(0):
                self._name_field.begin(number)
        is_at = imgui.is_item_hovered() or imgui.is_item_focused()
        if is_at and imgui.is_key_pressed(imgui.Key.f2, False):
            self._name_field.begin(number)
        widgets.show_tooltip(
            f"{' / '.join(layer.path)}: drag to change the order, double-click or F2 to rename"
        )
        _drag_and_drop(state, number, place)
        if imgui.is_item_focused() and context_menu_pressed():
            imgui.open_popup(f"menu of layer {number}")
        if imgui.begin_popup_context_item(f"menu of layer {number}"):
            self._draw_menu(state, number, place)
            imgui.end_popup()

    def _draw_menu(self, state: AppState, number: int, place: int) -> None:
        """Draw the content of a layer's context menu."""
        assert state.document is not None
        last = len(state.document.drawing.layers) - 1
        if imgui.menu_item("Rename", "F2", False)[0]:
            self._name_field.begin(number)
        imgui.separator()
        for label, new_place, possible in (
            ("Bring to Front", last, place < last),
            ("Bring Forward", place + 1, place < last),
            ("Send Backward", place - 1, place > 0),
            ("Send to Back", 0, place > 0),
        ):
            if imgui.menu_item(label, "", False, possible)[0]:
                _move(state, number, new_place)


def selected_layer(state: AppState) -> int | None:
    """The number of the layer that is selected in the list; None if there is none."""
    number, document = state.view.selected_layer, state.document
    is_there = number is not None and document is not None and number < len(document.drawing.layers)
    return number if is_there else None


def _set(state: AppState, label: str, number: int, join: bool = False, **values: object) -> None:
    state.notice = ""
    state.run_reporting_errors(
        lambda: gestures.set_layers(state.editor, label, [number], join=join, **values)
    )


def _move(state: AppState, number: int, place: int) -> None:
    state.notice = ""
    state.run_reporting_errors(lambda: gestures.move_layer(state.editor, number, place))


def _drag_and_drop(state: AppState, number: int, place: int) -> None:
    """Let the last item be dragged to another layer, whose place it takes."""
    if imgui.begin_drag_drop_source(imgui.DragDropFlags_.source_no_preview_tooltip):
        imgui.set_drag_drop_payload_py_id(LAYER_PAYLOAD, number)
        imgui.end_drag_drop_source()
    if imgui.begin_drag_drop_target():
        payload = imgui.accept_drag_drop_payload_py_id(LAYER_PAYLOAD)
        if payload is not None and payload.data_id != number:
            _move(state, payload.data_id, place)
        imgui.end_drag_drop_target()


def _draw_opacity(state: AppState, layers: Sequence[DrawingLayer], selected: int | None) -> None:
    """Draw the opacity of the selected layer; a whole drag of the slider is one entry of the history."""
    value = 100.0 if selected is None else 100 * layers[selected].opacity
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*SECONDARY), "Opacity")
    imgui.same_line(_LABEL_WIDTH * imgui.get_font_size())
    begins = not imgui.is_mouse_dragging(0, 0.0)
    is_moved, percent, _ = widgets.slider("##layer opacity", value, (0, 100), "%.0f %%")
    if is_moved and selected is not None:
        opacity = round(percent) / 100
        _set(state, "Change Layer Opacity", selected, join=not begins, opacity=opacity)


def _draw_thumbnail(state: AppState, layer: DrawingLayer, corner: ImVec2, side: int, scale: float) -> None:
    """Draw the picture of a layer in a square."""
    draw, end = imgui.get_window_draw_list(), ImVec2(corner.x + side, corner.y + side)
    is_hovered = imgui.is_mouse_hovering_rect(corner, end)
    draw.add_rect_filled(corner, end, packed(HOVER if is_hovered else FRAME), 4 * scale)
    if layer.solo:
        draw.add_rect(corner, end, packed(ACCENT), 4 * scale)
    pixels = side - 4
    if imgui.is_rect_visible(corner, end):
        state.thumbnails.draw((layer.artwork, pixels), corner, side, lambda: _small(layer, pixels))


def _small(layer: DrawingLayer, pixels: int) -> Picture:
    """The picture of a layer, at most ``pixels`` wide and high."""
    picture = layer.artwork.picture
    step = 1 + max(picture.shape[:2]) // (8 * pixels)
    image = Image.fromarray(np.ascontiguousarray(picture[::step, ::step]))
    image.thumbnail((pixels, pixels))
    return np.asarray(image)
