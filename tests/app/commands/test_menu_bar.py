"""The menus, by keys alone."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app import files
from akap_editor.app.commands.command import ALT, Command, Key, Submenu
from akap_editor.app.commands.registry import MENUS


def open_menus():
    """Names of the popups that are open, the outermost first."""
    stack = imgui.get_current_context().open_popup_stack
    return [popup.window.name.partition("###")[0] for popup in stack if popup.window is not None]


def after_each(ui, *chords):
    """The open menus after each of the keys; in one go, since Test Engine closes menus between its tests."""
    seen = []

    def press(hand):
        for chord in chords:
            hand.key_press(int(chord))
            hand.yield_(2)
            seen.append(open_menus())

    ui.do(press)
    return seen


def test_every_menu_has_a_letter_of_its_own():
    letters = [name[0].lower() for name, _ in MENUS]
    assert len(set(letters)) == len(letters)


@pytest.mark.parametrize("name", [name for name, _ in MENUS])
def test_alt_and_a_letter_open_a_menu(pinned, name):
    (menus,) = after_each(pinned, ALT | Key[name[0].lower()])
    assert menus == [name]


def test_arrows_walk_through_all_menus(pinned):
    names = [name for name, _ in MENUS]
    seen = after_each(pinned, Key.f10, *[Key.right_arrow] * len(names), Key.left_arrow, Key.escape)
    assert seen == [[name] for name in (*names, names[0], names[-1])] + [[]]


def test_a_command_is_run_from_a_menu_by_keys(pinned):
    assert not pinned.state.view.show_mesh
    place = [
        item.label for item in dict(MENUS)["View"] if isinstance(item, Command) and item.enabled(pinned.state)
    ]
    down = [Key.down_arrow] * place.index("Show Mesh")
    seen = after_each(pinned, ALT | Key.v, *down, Key.enter)
    assert seen[-2:] == [["View"], []]
    assert pinned.state.view.show_mesh


def test_arrows_in_a_menu_of_files_stay_there(pinned):
    """File > Open Bundled Drawing > ...: right goes in, left comes back, both without leaving File."""
    submenus = [item.label for item in dict(MENUS)["File"] if isinstance(item, Submenu)]
    name = submenus[-1]
    seen = after_each(pinned, ALT | Key.f, Key.down_arrow, Key.right_arrow, Key.left_arrow, Key.right_arrow)
    assert seen == [["File"], ["File"], ["File", name], ["File"], ["File", name]]


def test_while_a_name_is_typed_alt_opens_nothing(pinned):
    files.choose_and_open(pinned.state)
    pinned.settle()
    (menus,) = after_each(pinned, Key.f10)
    assert menus == ["Open picture or drawing"]
