"""Menu bar, tool bar, side panel and status bar; they show the workspace and hold nothing themselves."""

from imgui_bundle import ImVec2, ImVec4, imgui

from ..editor.document import Settings
from ..resources import bundled_drawings
from . import commands
from .commands import MENUS, Command
from .theme import ACCENT, QUIET, packed
from .workspace import Workspace

_BAR = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_docking
)
_TOOLS: tuple[Command | None, ...] = (
    commands.PIN_TOOL,
    commands.HAND_TOOL,
    None,
    commands.UNDO,
    commands.REDO,
    commands.REMOVE,
    None,
    commands.FIT,
    commands.SHOW_MESH,
)

# Label and what to know about it, by the method's name.
METHODS = {
    "akap": (
        "As Killing as possible",
        "The drawing flows along a vector field that is as near to a rigid motion as it can be.",
    ),
    "arap": (
        "As rigid as possible",
        "Each triangle keeps its shape as well as it can; found by repeated local and global steps.",
    ),
    "cauchy-green": (
        "Cauchy-Green",
        "A conformal map: angles stay, areas may swell or shrink a lot. Holes are bent as if filled.",
    ),
    "mls": (
        "Moving least squares",
        "Bends the plane around the pins; near limbs pull on one another, because outlines do not count.",
    ),
}


def draw(space: Workspace, scale: float) -> tuple[float, float, float, float]:
    """Draw the frame around the canvas; returns the canvas as (left, top, right, bottom) in window points."""
    _menu_bar(space)
    _status_bar(space, scale)
    _tool_bar(space, scale)
    _side_panel(space, scale)
    viewport = imgui.get_main_viewport()
    left, top = viewport.work_pos.x, viewport.work_pos.y
    return left, top, left + viewport.work_size.x, top + viewport.work_size.y


def _run(space: Workspace, command: Command) -> None:
    space.notice = ""
    space.attempt(lambda: command.run(space))


def _change(space: Workspace, settings: Settings) -> None:
    space.notice = ""
    space.attempt(lambda: space.editor.set_settings(settings))


def _menu_bar(space: Workspace) -> None:
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    shown = imgui.begin_main_menu_bar()
    imgui.pop_style_var()
    if not shown:
        return
    for name, group in MENUS:
        if imgui.begin_menu(name):
            for command in group:
                if command is None:
                    imgui.separator()
                    continue
                checked = command.checked(space) if command.checked is not None else False
                if imgui.menu_item(command.label, command.key_name, checked, command.enabled(space))[0]:
                    _run(space, command)
                if command is commands.OPEN and imgui.begin_menu("Open Bundled Drawing"):
                    for path in bundled_drawings():
                        if imgui.menu_item_simple(path.stem.capitalize()):
                            space.open_path(path)
                    imgui.end_menu()
            imgui.end_menu()
    imgui.end_main_menu_bar()


def _side_bar(name: str, side: imgui.Dir, size: float, padding: ImVec2, scrolls: bool = False) -> bool:
    fixed = imgui.WindowFlags_.no_scrollbar | imgui.WindowFlags_.no_scroll_with_mouse
    imgui.push_style_var(imgui.StyleVar_.window_padding, padding)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    shown = imgui.internal.begin_viewport_side_bar(
        name, imgui.get_main_viewport(), side, size, _BAR | (0 if scrolls else fixed)
    )
    imgui.pop_style_var(3)
    return bool(shown)


def _tool_bar(space: Workspace, scale: float) -> None:
    size = 36 * scale
    if _side_bar("Tools", imgui.Dir.left, size + 12 * scale, ImVec2(6 * scale, 8 * scale)):
        imgui.push_style_var(imgui.StyleVar_.item_spacing, ImVec2(4 * scale, 4 * scale))
        for command in _TOOLS:
            if command is None:
                imgui.dummy(ImVec2(size, 1 * scale))
                at = imgui.get_cursor_screen_pos()
                imgui.get_window_draw_list().add_line(
                    ImVec2(at.x + 6 * scale, at.y),
                    ImVec2(at.x + size - 6 * scale, at.y),
                    packed((1, 1, 1, 0.12)),
                )
                imgui.dummy(ImVec2(size, 3 * scale))
            else:
                _tool_button(space, command, size)
        imgui.pop_style_var()
    imgui.end()


def _tool_button(space: Workspace, command: Command, size: float) -> None:
    on = command.checked is not None and command.checked(space)
    imgui.push_style_color(imgui.Col_.button, ImVec4(*ACCENT[:3], 0.18) if on else ImVec4(0, 0, 0, 0))
    imgui.push_style_color(imgui.Col_.text, ImVec4(*(ACCENT if on else (0.91, 0.91, 0.925, 1.0))))
    imgui.begin_disabled(not command.enabled(space))
    if imgui.button(f"{command.icon}##{command.label}", ImVec2(size, size)):
        _run(space, command)
    imgui.end_disabled()
    imgui.pop_style_color(2)
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal | imgui.HoveredFlags_.allow_when_disabled):
        imgui.set_tooltip(command.label.rstrip(".") + (f"  ({command.key_name})" if command.chords else ""))


def _side_panel(space: Workspace, scale: float) -> None:
    padding = ImVec2(16 * scale, 6 * scale)
    if _side_bar("Panel", imgui.Dir.right, 268 * scale, padding, scrolls=True) and space.document:
        _about_drawing(space)
        _pins(space, scale)
        _bending(space)
        _view(space)
        _numbers(space)
    imgui.end()


def _switch(label: str, on: bool) -> tuple[bool, bool]:
    """A check box of the height of its text; whether it was clicked, and whether it is on."""
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0.18, 0.18) * imgui.get_font_size())
    clicked, on = imgui.checkbox(label, on)
    imgui.pop_style_var()
    return clicked, on


def _section(title: str) -> None:
    imgui.spacing()
    imgui.spacing()
    imgui.push_font(None, imgui.get_style().font_size_base * 0.86)
    imgui.text_colored(ImVec4(*QUIET), title.upper())
    imgui.pop_font()
    imgui.separator()


def _row(label: str, value: str, tooltip: str = "") -> None:
    """A label on the left, its value on the right."""
    imgui.text_colored(ImVec4(*QUIET), label)
    if tooltip and imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        _tooltip(tooltip)
    imgui.same_line(
        imgui.get_content_region_avail().x - imgui.calc_text_size(value).x + imgui.get_cursor_pos_x()
    )
    imgui.text(value)


def _tooltip(text: str) -> None:
    imgui.begin_tooltip()
    imgui.push_text_wrap_pos(imgui.get_font_size() * 22)
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()
    imgui.end_tooltip()


def _about_drawing(space: Workspace) -> None:
    assert space.document is not None
    drawing = space.document.drawing
    _section("Drawing")
    _row("Name", drawing.name)
    _row("Picture", f"{drawing.size[0]} × {drawing.size[1]} px")
    _row("Mesh", f"{len(drawing.mesh.vertices):,} vertices", "The drawing bends at the vertices of its mesh.")


def _pins(space: Workspace, scale: float) -> None:
    assert space.document is not None
    state, editor = space.document.state, space.editor
    _section(f"Pins ({len(state.pins)})" if state.pins else "Pins")
    if not state.pins:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored(ImVec4(*QUIET), "None yet. Click on the drawing where it should hold still.")
        imgui.pop_text_wrap_pos()
        return
    line = imgui.get_text_line_height_with_spacing()
    imgui.begin_child("##pins", ImVec2(0, min(len(state.pins), 6) * line + 6 * scale))
    for pin in state.pins:
        label = f"  Pin {pin.id}##pin"
        chosen = pin.id in editor.selection
        if imgui.selectable(label, chosen)[0]:
            if imgui.get_io().key_shift:
                editor.select(editor.selection ^ {pin.id})
            else:
                editor.select({pin.id})
        place = f"{pin.target[0]:.0f}, {pin.target[1]:.0f}"
        imgui.same_line(imgui.get_content_region_avail().x - imgui.calc_text_size(place).x - 6 * scale)
        imgui.text_colored(ImVec4(*QUIET), place)
    imgui.end_child()
    imgui.begin_disabled(not editor.selection)
    if imgui.button("Remove selected", ImVec2(-1, 0)):
        _run(space, commands.REMOVE)
    imgui.end_disabled()


def _bending(space: Workspace) -> None:
    assert space.document is not None
    _section("Bending")
    settings = space.document.state.settings
    names = list(METHODS)
    imgui.set_next_item_width(-1)
    labels = [label for label, _ in METHODS.values()]
    changed, index = imgui.combo("##method", names.index(settings.method), labels)
    if changed:
        chosen = names[index]
        _change(space, Settings() if chosen == Settings().method else Settings(chosen, ()))
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        _tooltip(METHODS[settings.method][1])
    imgui.begin_disabled(not commands.REMEMBER.enabled(space))
    if _switch("Remember the rest shape", commands.remembers(space))[0]:
        _run(space, commands.REMEMBER)
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        _tooltip(
            "On: the drawing springs back towards its own shape as you drag, so that going there and back "
            "leaves no trace. Off: it keeps what each drag did to it, as clay would."
        )
    imgui.end_disabled()
    imgui.begin_disabled(not commands.RESET.enabled(space))
    if imgui.button("Reset pose", ImVec2(-1, 0)):
        _run(space, commands.RESET)
    imgui.end_disabled()


def _view(space: Workspace) -> None:
    _section("View")
    _, space.show_mesh = _switch("Mesh", space.show_mesh)
    _, space.show_pins = _switch("Pins##view", space.show_pins)
    _, space.checker = _switch("Checkerboard", space.checker)


def _numbers(space: Workspace) -> None:
    session, distortion = space.editor.session, space.measure()
    assert session is not None
    assert distortion is not None
    _section("Distortion")
    _row(
        "Area",
        f"{distortion.area:.4f}",
        "How much areas change, on average over the drawing. 2 means not at all.",
    )
    _row("Angle", f"{distortion.angle:.4f}", "How much shapes are sheared or stretched. 2 means not at all.")
    _row("Pins off target", f"{session.pin_error():.2f} px", "How far the farthest pin is from its place.")


def _status_bar(space: Workspace, scale: float) -> None:
    height = imgui.get_frame_height() + 2 * scale
    if _side_bar("Status", imgui.Dir.down, height, ImVec2(14 * scale, 4 * scale)):
        imgui.align_text_to_frame_padding()
        if space.notice:
            imgui.text_colored(ImVec4(*ACCENT), space.notice)
        else:
            imgui.text_unformatted(space.editor.hint)
        if space.document is not None:
            facts = f"{space.editor.camera.zoom * 100:.0f} %"
            imgui.same_line(imgui.get_window_width() - imgui.calc_text_size(facts).x - 16 * scale)
            imgui.text_colored(ImVec4(*QUIET), facts)
    imgui.end()
