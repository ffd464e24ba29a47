"""The Layers section: the layers of the drawing from front to back, with their switches."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor import gestures
from ...layers.drawing_layer import DrawingLayer, shown_layers
from ...layers.layer_view import slot_members, unused_slot_name
from ...words import mark, tr
from .. import widgets
from ..app_state import AppState
from ..commands.command import context_menu_pressed
from ..pending_values import NameField
from ..theme import SECONDARY, TEXT, packed
from . import parts
from .rig.layer_thumbnails import THUMBNAIL_SIDE, draw_thumbnail
from .rig.slots import SlotPickers, switch_to

LAYER_PAYLOAD = "LAYER"  # of drag and drop: the number of a layer
_ROWS = 8  # layers that are visible at once
_ICON_WIDTH = 1.7  # times the font size
_INDENT = 0.9  # of what is in a group, times the font size


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

    The selected layer is `ViewOptions.selected_layer`; Ctrl-click and Shift-click select more of them for the
    menu. A click on the canvas that selects a pin selects the pin's layer, too.
    """

    def __init__(self) -> None:
        self._name_field = NameField()
        self._slot_pickers = SlotPickers()
        self._more: set[int] = set()  # layers that are selected beside the one
        self._folded: set[tuple[str, ...]] = set()  # groups whose layers are not listed
        self._pin: int | None = None  # the one that chose the layer
        self._scroll_target: int | None = None  # the layer that the list is to be scrolled to

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        assert state.document is not None
        drawing = state.document.drawing
        self._follow_pins(state)
        shown = shown_layers(drawing.layers)
        step = THUMBNAIL_SIDE * scale + imgui.get_style().item_spacing.y
        rows = list(_rows(drawing.layers, drawing.layer_order))
        parts.begin_well("##layers", min(len(rows), _ROWS) * step)
        imgui.set_cursor_pos_y(0.5 * imgui.get_style().item_spacing.y)
        for index, (path, place) in enumerate(rows):
            if any(path[:depth] in self._folded for depth in range(1, len(path) + (place is not None))):
                continue
            if place is None:
                self._draw_group(state, index, path, scale)
                continue
            number = drawing.layer_order[place]
            imgui.indent(max(_INDENT * imgui.get_font_size() * len(path), 0.01))
            self._draw_row(state, number, place, bool(shown[number]), scale)
            imgui.unindent(max(_INDENT * imgui.get_font_size() * len(path), 0.01))
        parts.end_list()
        self._slot_pickers.draw(state, scale)
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
                number = int(state.document.drawing.face_layers[faces[pin]])
                state.view.selected_layer = self._scroll_target = number

    def _draw_group(self, state: AppState, index: int, path: tuple[str, ...], scale: float) -> None:
        """Draw the row of a group: its eye, and its name, a click on which folds it."""
        assert state.document is not None
        layers = state.document.drawing.layers
        first = next(layer for layer in layers if layer.groups[: len(path)] == path)
        is_open = len(path) - 1 not in first.closed_groups
        font_size, side = imgui.get_font_size(), round(THUMBNAIL_SIDE * scale)
        top, left = imgui.get_cursor_pos_y(), imgui.get_cursor_pos_x()
        indent = left + _INDENT * font_size * (len(path) - 1)
        middle = top + (side - imgui.get_text_line_height()) / 2
        imgui.set_cursor_pos(ImVec2(indent, middle))
        eye = icons.ICON_FA_EYE if is_open else icons.ICON_FA_EYE_SLASH
        if widgets.icon_switch(
            eye, f"eye of group {index}", is_open, tr("Show or hide the group"), _ICON_WIDTH
        ):
            state.notice = ""
            state.run_reporting_errors(lambda: gestures.show_group(state.editor, path, not is_open))
        imgui.set_cursor_pos(ImVec2(indent + _ICON_WIDTH * font_size, top))
        corner, is_folded = imgui.get_cursor_screen_pos(), path in self._folded
        room = imgui.get_content_region_avail().x
        if imgui.selectable(f"###group {index}", False, size=ImVec2(room, side))[0]:
            self._folded ^= {path}
        widgets.show_tooltip(" / ".join(path))
        dropped, order = _dropped_layer(), state.document.drawing.layer_order
        if dropped is not None:
            foremost = max(k for k, number in enumerate(order) if layers[number].groups[: len(path)] == path)
            _move(state, dropped, foremost + (order.index(dropped) > foremost), path)
        icon = icons.ICON_FA_FOLDER if is_folded else icons.ICON_FA_FOLDER_OPEN
        text = widgets.shortened(f"{icon}  {path[-1]}", room)
        place = ImVec2(corner.x + 0.3 * font_size, corner.y + middle - top)
        imgui.get_window_draw_list().add_text(place, packed(TEXT if is_open else SECONDARY), text)
        imgui.set_cursor_pos(ImVec2(left, top + side))
        imgui.dummy(ImVec2(0, 0))

    def _draw_row(self, state: AppState, number: int, place: int, shown: bool, scale: float) -> None:
        assert state.document is not None
        layer = state.document.drawing.layers[number]
        font_size, top = imgui.get_font_size(), imgui.get_cursor_pos_y()
        left, room = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
        side = round(THUMBNAIL_SIDE * scale)
        middle = top + (side - imgui.get_text_line_height()) / 2
        if selected_layer(state) == number or number in self._more:
            parts.draw_highlight(side)
        imgui.set_cursor_pos_y(middle)
        _draw_eye(state, layer, number)
        imgui.set_cursor_pos(ImVec2(left + _ICON_WIDTH * font_size, top))
        corner = imgui.get_cursor_screen_pos()
        name_left = left + _ICON_WIDTH * font_size + side + 0.5 * font_size
        name_width = room - (name_left - left) - (2 * _ICON_WIDTH + 0.2) * font_size
        if self._name_field.key == number:
            imgui.set_cursor_pos(ImVec2(name_left, middle))
            name = self._name_field.draw("##new name", layer.name, name_width)
            if name:
                _set(state, mark("Rename Layer"), number, title=name)
        else:
            width = room - (corner.x - imgui.get_window_pos().x - left) - (2 * _ICON_WIDTH + 0.2) * font_size
            self._draw_name(state, layer, number, place, ImVec2(width, side))
            color = TEXT if shown else SECONDARY
            text = ImVec2(corner.x + side + 0.5 * font_size, corner.y + middle - top)
            label = widgets.shortened(layer.name, name_width)
            imgui.get_window_draw_list().add_text(text, packed(color), label)
        draw_thumbnail(state, layer, corner, side, scale, layer.solo)
        imgui.set_cursor_pos(ImVec2(left + room - 2 * _ICON_WIDTH * font_size, middle))
        if widgets.icon_switch(
            icons.ICON_FA_STAR,
            f"solo {number}",
            layer.solo,
            tr("Solo: show only this and other such layers"),
            _ICON_WIDTH,
        ):
            _set(
                state, mark("Unsolo Layer") if layer.solo else mark("Solo Layer"), number, solo=not layer.solo
            )
        imgui.set_cursor_pos(ImVec2(left + room - _ICON_WIDTH * font_size, middle))
        lock = icons.ICON_FA_LOCK if layer.locked else icons.ICON_FA_LOCK_OPEN
        if widgets.icon_switch(
            lock,
            f"lock {number}",
            layer.locked,
            tr("Lock: clicks go through to the layers behind"),
            _ICON_WIDTH,
        ):
            _set(
                state,
                mark("Unlock Layer") if layer.locked else mark("Lock Layer"),
                number,
                locked=not layer.locked,
            )
        imgui.set_cursor_pos(ImVec2(left, top + side))
        imgui.dummy(ImVec2(0, 0))

    def _draw_name(self, state: AppState, layer: DrawingLayer, number: int, place: int, size: ImVec2) -> None:
        """Draw the part of a row that is clicked, dragged and has a menu."""
        flags = imgui.SelectableFlags_.allow_double_click
        if imgui.selectable(f"###layer {number}", False, flags, size)[0]:
            self._select(state, number)
            if imgui.is_mouse_double_clicked(0):
                self._name_field.begin(number)
        if number == self._scroll_target:
            self._scroll_target = None
            if not imgui.is_item_visible():
                imgui.set_scroll_here_y()
        is_at = imgui.is_item_hovered() or imgui.is_item_focused()
        if is_at and imgui.is_key_pressed(imgui.Key.f2, False):
            self._name_field.begin(number)
        widgets.show_tooltip(
            tr(
                "{layer}: drag to change the order, double-click or F2 to rename, Ctrl-click to select more",
                layer=" / ".join(layer.path),
            )
        )
        if imgui.begin_drag_drop_source(imgui.DragDropFlags_.source_no_preview_tooltip):
            imgui.set_drag_drop_payload_py_id(LAYER_PAYLOAD, number)
            imgui.end_drag_drop_source()
        dropped = _dropped_layer()
        if dropped is not None and dropped != number:
            _move(state, dropped, place, layer.groups)
        if imgui.is_item_focused() and context_menu_pressed():
            imgui.open_popup(f"menu of layer {number}")
        if imgui.begin_popup_context_item(f"menu of layer {number}"):
            self._draw_menu(state, number, place)
            imgui.end_popup()

    def _draw_menu(self, state: AppState, number: int, place: int) -> None:
        """Draw the content of a layer's context menu."""
        assert state.document is not None
        last = len(state.document.drawing.layers) - 1
        if imgui.menu_item(tr("Rename"), "F2", False)[0]:
            self._name_field.begin(number)
        imgui.separator()
        for label, new_place, possible in (
            (tr("Bring to Front"), last, place < last),
            (tr("Bring Forward"), place + 1, place < last),
            (tr("Send Backward"), place - 1, place > 0),
            (tr("Send to Back"), 0, place > 0),
        ):
            if imgui.menu_item(label, "", False, possible)[0]:
                _move(state, number, new_place)
        chosen = self._chosen(state, number)
        _draw_slot_items(state, chosen)
        if state.document.state.animation.keyframes:
            imgui.separator()
            for label, visible in ((tr("Show in All Keyframes"), True), (tr("Hide in All Keyframes"), False)):
                if imgui.menu_item(label, "", False)[0]:
                    _run(state, partial(gestures.key_layers, state.editor, chosen, visible))

    def _select(self, state: AppState, number: int) -> None:
        """Select a layer; with Ctrl one more or one less, with Shift all up to it."""
        assert state.document is not None
        selected, order = selected_layer(state), state.document.drawing.layer_order
        keys = imgui.get_io()
        if keys.key_ctrl and selected is not None and selected != number:
            self._more ^= {number}
            return
        if keys.key_shift and selected is not None:
            low, high = sorted((order.index(selected), order.index(number)))
            self._more = set(order[low : high + 1]) - {selected}
            return
        self._more = set()
        state.view.selected_layer = number

    def _chosen(self, state: AppState, number: int) -> list[int]:
        """The layers that the menu of a layer is for: all selected ones if it is one of them."""
        selected = selected_layer(state)
        all_selected = self._more | ({selected} if selected is not None else set())
        return sorted(all_selected) if number in all_selected else [number]


def _rows(
    layers: Sequence[DrawingLayer], order: Sequence[int]
) -> Iterator[tuple[tuple[str, ...], int | None]]:
    """The rows of the list from front to back.

    The path of a group and None, or the groups of a layer and its place among the layers.
    """
    open_path: tuple[str, ...] = ()
    for place in range(len(order) - 1, -1, -1):
        groups = layers[order[place]].groups
        common = 0
        while common < min(len(groups), len(open_path)) and groups[common] == open_path[common]:
            common += 1
        for depth in range(common + 1, len(groups) + 1):
            yield groups[:depth], None
        open_path = groups
        yield groups, place


def _draw_eye(state: AppState, layer: DrawingLayer, number: int) -> None:
    """Draw the eye of a layer; to open that of one in a slot closes those of the others."""
    icon = icons.ICON_FA_EYE if layer.visible else icons.ICON_FA_EYE_SLASH
    tooltip = tr("Show or hide")
    if layer.slot:
        tooltip = tr("Show it in place of the others of “{slot}”", slot=layer.slot)
    if widgets.icon_switch(icon, f"eye {number}", layer.visible, tooltip, _ICON_WIDTH):
        if layer.slot and not layer.visible:
            switch_to(state, number)
        else:
            label = mark("Hide Layer") if layer.visible else mark("Show Layer")
            _set(state, label, number, visible=not layer.visible)


def _draw_slot_items(state: AppState, chosen: list[int]) -> None:
    """Draw the items of a menu that put layers into slots and take them out."""
    assert state.document is not None
    layers = state.document.drawing.layers
    imgui.separator()

    def put(label: str, slot: str) -> None:
        _run(state, lambda: gestures.set_layers(state.editor, label, chosen, slot=slot))

    if imgui.menu_item(tr("Make Switch Layers"), "", False, len(chosen) > 1)[0]:
        put(mark("Make Switch Layers"), unused_slot_name(layers, chosen))
    widgets.show_tooltip(tr("One of the selected layers is shown at a time. Ctrl-click selects several."))
    for slot in slot_members(layers):
        name = widgets.as_label(slot)
        if (
            any(layers[number].slot != slot for number in chosen)
            and imgui.menu_item(tr("Add to “{slot}”", slot=name), "", False)[0]
        ):
            put(mark("Add to Switch Layers"), slot)
    slots = {layers[number].slot for number in chosen} - {""}
    if slots and imgui.menu_item(tr("Remove from Switch Layers"), "", False)[0]:
        put(mark("Remove from Switch Layers"), "")


def selected_layer(state: AppState) -> int | None:
    """The number of the layer that is selected in the list; None if there is none."""
    number, document = state.view.selected_layer, state.document
    is_there = number is not None and document is not None and number < len(document.drawing.layers)
    return number if is_there else None


def _set(state: AppState, label: str, number: int, join: bool = False, **values: object) -> None:
    _run(state, lambda: gestures.set_layers(state.editor, label, [number], join=join, **values))


def _move(state: AppState, number: int, place: int, groups: Sequence[str] | None = None) -> None:
    _run(state, lambda: gestures.move_layer(state.editor, number, place, groups))


def _run(state: AppState, work: Callable[[], None]) -> None:
    state.notice = ""
    state.run_reporting_errors(work)


def _dropped_layer() -> int | None:
    """The number of a layer that was just dropped on the last item."""
    if not imgui.begin_drag_drop_target():
        return None
    payload = imgui.accept_drag_drop_payload_py_id(LAYER_PAYLOAD)
    imgui.end_drag_drop_target()
    return payload.data_id if payload is not None else None


def _draw_opacity(state: AppState, layers: Sequence[DrawingLayer], selected: int | None) -> None:
    """Draw the opacity of the selected layer; a whole drag of the slider is one entry of the history."""
    value = 100.0 if selected is None else 100 * layers[selected].opacity
    widgets.label(tr("Opacity"), widgets.label_column(tr("Opacity")))
    begins = not imgui.is_mouse_dragging(0, 0.0)
    is_moved, percent, _ = widgets.slider("##layer opacity", value, (0, 100), "%.0f %%")
    if is_moved and selected is not None:
        opacity = round(percent) / 100
        _set(state, mark("Change Layer Opacity"), selected, join=not begins, opacity=opacity)
