"""The side panel's own sections: the drawing, its pins, how it bends, what is seen, how far it is bent."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ...deform.methods import get_method, nearest_preset, presets
from ...editor.document.settings import Settings
from .. import widgets
from ..app_state import AppState
from ..canvas.view_options import DISTORTION_RANGES
from ..commands import registry as commands
from ..theme import QUIET
from . import method_parameters

_ROWS = 6  # of pins that are seen at once
_SWITCHES = (
    *(commands.SHOW_MESH, commands.SHOW_PINS, commands.CHECKER),
    *(*commands.OVERLAYS, commands.SHOW_REFERENCE),
)


def drawing(state: AppState, scale: float) -> None:
    """Name and size."""
    assert state.document is not None
    shown = state.document.drawing
    widgets.row("Name", shown.name)
    widgets.row("Picture", f"{shown.size[0]} × {shown.size[1]} px")


def pin_count(state: AppState) -> str:
    """How many pins there are, in digits; nothing where there are none."""
    count = len(state.document.state.pins) if state.document is not None else 0
    return str(count or "")


def pins(state: AppState, scale: float) -> None:
    """The list of pins, which selects."""
    assert state.document is not None
    edit_state, editor = state.document.state, state.editor
    if not edit_state.pins:
        widgets.secondary_text("None yet. Click on the drawing where it should hold still.")
        return
    widgets.begin_list("##pins", len(edit_state.pins), _ROWS)
    for index, pin in enumerate(edit_state.pins):
        label = f"  Pin {pin.id}##pin"
        chosen = pin.id in editor.selection
        if imgui.selectable(label, chosen)[0]:
            if imgui.get_io().key_shift:
                editor.select(editor.selection ^ {pin.id})
            else:
                editor.select({pin.id})
        if editor.selection == {pin.id}:
            widgets.scroll_to_row(index, _ROWS)
        place = f"{pin.target[0]:.0f}, {pin.target[1]:.0f}"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(place).x - 6 * scale)
        imgui.text_colored(ImVec4(*QUIET), place)
    imgui.end_child()
    imgui.begin_disabled(not editor.selection)
    if imgui.button("Remove selected", ImVec2(widgets.FULL, 0)):
        widgets.run(state, commands.REMOVE)
    imgui.end_disabled()


def bending(state: AppState, scale: float) -> None:
    """The method and its settings."""
    assert state.document is not None
    settings = state.document.state.settings
    choices, current = presets(), nearest_preset(settings.method, dict(settings.parameters))
    imgui.set_next_item_width(widgets.FULL)
    labels = [preset.label for preset in choices]
    changed, index = imgui.combo("##method", choices.index(current), labels, len(labels))
    widgets.show_tooltip(current.description)
    if changed:
        chosen = Settings.parse(choices[index].spec)
        if chosen.method == settings.method and get_method(chosen.method).deformer.has_memory:
            chosen = chosen.with_parameter("memory", settings.get("memory", 0.0))
        widgets.change(state, chosen)
    imgui.begin_disabled(not commands.REMEMBER.enabled(state))
    remember = (
        "On: the drawing springs back towards its own shape as you drag, so that going there and back "
        "leaves no trace. Off: it keeps what each drag did to it, as clay would."
    )
    if widgets.switch("Remember the rest shape", commands.remembers(state), remember)[0]:
        widgets.run(state, commands.REMEMBER)
    imgui.end_disabled()
    method_parameters.draw(state)
    imgui.begin_disabled(not commands.RESET_POSE.enabled(state))
    if imgui.button("Reset pose", ImVec2(widgets.FULL, 0)):
        widgets.run(state, commands.RESET_POSE)
    imgui.end_disabled()


def view(state: AppState, scale: float) -> None:
    """What is seen besides the drawing."""
    for command in _SWITCHES:
        on = command.checked is not None and command.checked(state)
        label = command.label.removeprefix("Show ").capitalize()
        if command.enabled(state) and widgets.switch(label, on, f"Key: {command.key_name}")[0]:
            widgets.run(state, command)
    if state.view.distortion_measure is not None:
        imgui.align_text_to_frame_padding()
        imgui.text("Scale ends at")
        imgui.same_line()
        imgui.set_next_item_width(-1)
        ends = [f"× {limit:g}" for limit in DISTORTION_RANGES]
        _, state.view.distortion_range = imgui.combo("##range", state.view.distortion_range, ends)
        widgets.show_tooltip("The change of area or shape at the ends of the colors. R for the next one.")
