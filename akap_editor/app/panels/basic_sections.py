"""The side panel's own sections: the drawing, its pins, how it bends, what is seen, how far it is bent."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ...deform.methods import VARIANTS, variant_of
from ...editor.document.settings import Settings
from .. import widgets
from ..app_state import Workspace
from ..canvas.view_options import RANGES
from ..commands import registry as commands
from ..theme import QUIET
from . import method_parameters as settings_panel

_ROWS = 6  # of pins that are seen at once
_SWITCHES = (
    *(commands.SHOW_MESH, commands.SHOW_PINS, commands.CHECKER),
    *(*commands.OVERLAYS, commands.SHOW_REFERENCE),
)


def drawing(space: Workspace, scale: float) -> None:
    """Name and size."""
    assert space.document is not None
    shown = space.document.drawing
    widgets.row("Name", shown.name)
    widgets.row("Picture", f"{shown.size[0]} × {shown.size[1]} px")


def pin_count(space: Workspace) -> str:
    """How many pins there are, in digits; nothing where there are none."""
    count = len(space.document.state.pins) if space.document is not None else 0
    return str(count or "")


def pins(space: Workspace, scale: float) -> None:
    """The list of pins, which selects."""
    assert space.document is not None
    state, editor = space.document.state, space.editor
    if not state.pins:
        widgets.quiet("None yet. Click on the drawing where it should hold still.")
        return
    widgets.begin_list("##pins", len(state.pins), _ROWS)
    for index, pin in enumerate(state.pins):
        label = f"  Pin {pin.id}##pin"
        chosen = pin.id in editor.selection
        if imgui.selectable(label, chosen)[0]:
            if imgui.get_io().key_shift:
                editor.select(editor.selection ^ {pin.id})
            else:
                editor.select({pin.id})
        if editor.selection == {pin.id}:
            widgets.keep_seen(index, _ROWS)
        place = f"{pin.target[0]:.0f}, {pin.target[1]:.0f}"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(place).x - 6 * scale)
        imgui.text_colored(ImVec4(*QUIET), place)
    imgui.end_child()
    imgui.begin_disabled(not editor.selection)
    if imgui.button("Remove selected", ImVec2(widgets.FULL, 0)):
        widgets.run(space, commands.REMOVE)
    imgui.end_disabled()


def bending(space: Workspace, scale: float) -> None:
    """The method and its settings."""
    assert space.document is not None
    settings = space.document.state.settings
    variant = variant_of(settings.method, dict(settings.parameters))
    imgui.set_next_item_width(widgets.FULL)
    labels = [each.label for each in VARIANTS]
    changed, index = imgui.combo("##method", VARIANTS.index(variant), labels, len(labels))
    widgets.explain(f"{variant.note} {variant.source}.")
    if changed:
        chosen = Settings.of(VARIANTS[index].spec)
        if chosen.method == settings.method == Settings().method:
            chosen = chosen.with_parameter("memory", settings.get("memory", 0.0))
        widgets.change(space, chosen)
    imgui.begin_disabled(not commands.REMEMBER.enabled(space))
    remember = (
        "On: the drawing springs back towards its own shape as you drag, so that going there and back "
        "leaves no trace. Off: it keeps what each drag did to it, as clay would."
    )
    if widgets.switch("Remember the rest shape", commands.remembers(space), remember)[0]:
        widgets.run(space, commands.REMEMBER)
    imgui.end_disabled()
    settings_panel.draw(space)
    imgui.begin_disabled(not commands.RESET.enabled(space))
    if imgui.button("Reset pose", ImVec2(widgets.FULL, 0)):
        widgets.run(space, commands.RESET)
    imgui.end_disabled()


def view(space: Workspace, scale: float) -> None:
    """What is seen besides the drawing."""
    for command in _SWITCHES:
        on = command.checked is not None and command.checked(space)
        label = command.label.removeprefix("Show ").capitalize()
        if command.enabled(space) and widgets.switch(label, on, f"Key: {command.key_name}")[0]:
            widgets.run(space, command)
    if space.view.heat is not None:
        imgui.align_text_to_frame_padding()
        imgui.text("Scale ends at")
        imgui.same_line()
        imgui.set_next_item_width(-1)
        ends = [f"× {limit:g}" for limit in RANGES]
        _, space.view.heat_range = imgui.combo("##range", space.view.heat_range, ends)
        widgets.explain("The change of area or shape at the ends of the colors. R for the next one.")
