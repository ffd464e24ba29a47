"""The bar over the canvas while pins are suggested."""

from akap_editor.app.commands import registry as commands


def test_the_pins_are_added_by_the_button_and_cancelled_by_the_other(ui):
    ui.menu("Edit", commands.SUGGEST_PINS.label)
    count = len(ui.editor.tool.ghosts)
    assert count > 1
    ui.do(lambda hand: hand.item_click("//Options/Cancel"))
    assert (ui.tool, ui.pins) == ("PinsIdle", ())
    ui.menu("Edit", commands.SUGGEST_PINS.label)
    ui.do(lambda hand: hand.item_click("//Options/Add Pins"))
    assert len(ui.pins) == count


def test_enter_adds_them(ui):
    ui.menu("Edit", commands.SUGGEST_PINS.label)
    count = len(ui.editor.tool.ghosts)
    ui.key(commands.FINISH.chords[0])
    assert len(ui.pins) == count


def test_ghosts_are_seen(ui):
    plain = ui.screenshot()
    ui.menu("Edit", commands.SUGGEST_PINS.label)
    x, y = map(round, ui.to_screen(ui.editor.tool.ghosts[0].position))
    assert (ui.screenshot()[y - 8 : y + 9, x - 8 : x + 9] != plain[y - 8 : y + 9, x - 8 : x + 9]).any()
