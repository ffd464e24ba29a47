"""The Pins section of the side panel."""

from imgui_bundle import imgui  # isort: skip


def pin_in_list(ui, pin, shift=False):
    """Click a line of the pin list."""

    def click(hand):
        if shift:
            hand.key_down(imgui.Key.mod_shift)
        hand.item_click(f"//Panel/**/  Pin {pin}##pin")
        if shift:
            hand.key_up(imgui.Key.mod_shift)

    ui.do(click)


def test_the_pin_list_selects(pinned):
    pin_in_list(pinned, 2)
    assert pinned.editor.selection == {2}
    pin_in_list(pinned, 3, shift=True)
    assert pinned.editor.selection == {2, 3}
    pin_in_list(pinned, 2, shift=True)
    assert pinned.editor.selection == {3}
    pin_in_list(pinned, 1)
    assert pinned.editor.selection == {1}
    assert not pinned.editor.is_modified
    pinned.panel("Remove Selected")
    assert [pin.id for pin in pinned.pins] == [2, 3]
