"""The Layers section of the side panel."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.panels import layers
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.session.edits import OrderLayers
from tests.support.puppets import ARM, BODY, HAT, SKULL, puppet


@pytest.fixture
def layered(ui):
    """The window with the puppet."""
    ui.reset(new_document(puppet()))
    return ui


def row(layer, item):
    return f"//Panel/**/###{item} {layer}"


def click(ui, layer, item, act=lambda hand: None, double=False):
    def run(hand):
        (hand.item_double_click if double else hand.item_click)(row(layer, item))
        hand.yield_(3)
        act(hand)

    ui.do(run)


def layer(ui, number):
    return ui.session.drawing.layers[number]


def labels(ui):
    return ui.session.history.labels


def test_eye_solo_and_lock_are_undoable_switches(layered):
    for item, name, first, second in (
        ("eye", "visible", "Hide Layer", "Show Layer"),
        ("solo", "solo", "Solo Layer", "Unsolo Layer"),
        ("lock", "locked", "Lock Layer", "Unlock Layer"),
    ):
        before = getattr(layer(layered, SKULL), name)
        click(layered, SKULL, item)
        assert getattr(layer(layered, SKULL), name) is not before
        click(layered, SKULL, item)
        assert getattr(layer(layered, SKULL), name) is before
        assert labels(layered)[-2:] == [first, second]
    layered.session.undo()
    assert layer(layered, SKULL).locked


def test_a_hidden_layer_is_gone_on_the_canvas(layered):
    shown = layered.screenshot()
    click(layered, SKULL, "eye")
    assert (layered.screenshot() != shown).any()
    layered.session.undo()
    click(layered, BODY, "layer")
    assert layered.state.view.selected_layer == BODY


def test_layers_that_are_made_switch_layers_are_chosen_by_their_pictures(layered):
    def select_second(hand):
        hand.key_down(imgui.Key.mod_ctrl)
        hand.item_click(row(ARM, "layer"))
        hand.key_up(imgui.Key.mod_ctrl)
        hand.item_click(row(ARM, "layer"), imgui.MouseButton_.right)
        hand.yield_(3)
        hand.item_click("**/Make Switch Layers")

    click(layered, BODY, "layer", select_second)
    assert labels(layered)[-1] == "Make Switch Layers"
    assert [layer(layered, each).visible for each in (BODY, ARM)] == [False, True]
    layered.do(lambda hand: hand.item_click(f"//Panel/**/choose {BODY}"))
    assert [layer(layered, each).visible for each in (BODY, ARM)] == [True, False]
    assert labels(layered)[-1] == "Switch Layer"
    layered.session.undo()
    assert [layer(layered, each).visible for each in (BODY, ARM)] == [False, True]


def test_the_eye_of_a_group_hides_its_layers(layered):
    shown = layered.screenshot()
    layered.do(lambda hand: hand.item_click("//Panel/**/###eye of group 0"))
    assert labels(layered)[-1] == "Hide Group"
    assert layer(layered, SKULL).visible
    assert (layered.screenshot() != shown).any()
    layered.session.undo()
    layered.do(lambda hand: hand.item_click("//Panel/**/###group 0"))  # folds it
    found = []
    layered.do(lambda hand: found.append(hand.item_exists(row(SKULL, "layer"))))
    assert found == [False]


def test_a_double_click_or_f2_renames_a_layer(layered):
    def type_name(hand):
        hand.key_chars_replace_enter("trunk")

    click(layered, BODY, "layer", type_name, double=True)
    assert layer(layered, BODY).name == "trunk"
    assert labels(layered)[-1] == "Rename Layer"

    def press_f2(hand):
        hand.key_press(imgui.Key.f2)
        hand.yield_(3)
        hand.key_chars_replace_enter("tummy")

    click(layered, BODY, "layer", press_f2)
    assert layer(layered, BODY).name == "tummy"


def test_a_layer_takes_the_place_of_the_one_it_is_dragged_to(layered):
    layered.do(lambda hand: hand.item_drag_and_drop(row(BODY, "layer"), row(SKULL, "layer")))
    assert layered.session.drawing.layer_order == (ARM, SKULL, BODY, 3, HAT)
    assert layer(layered, BODY).groups == ("head",)
    assert labels(layered)[-1] == "Reorder Layers"
    layered.session.undo()
    assert layered.session.drawing.layer_order == (0, 1, 2, 3, 4)
    assert layer(layered, BODY).groups == ()
    layered.do(lambda hand: hand.item_drag_and_drop(row(SKULL, "layer"), row(BODY, "layer")))
    assert layered.session.drawing.layer_order == (SKULL, BODY, ARM, 3, HAT)
    assert layer(layered, SKULL).groups == ()


@pytest.mark.parametrize("before", [(0, 1, 2, 3, 4), (2, 3, 4, 0, 1)])
@pytest.mark.parametrize("is_open", [True, False])
def test_a_layer_dropped_on_a_group_is_put_in_front_in_it(layered, before, is_open):
    gestures.show_group(layered.editor, ("head",), is_open)
    layered.session.begin("Reorder Layers")
    layered.session.apply(OrderLayers(before))
    layered.session.commit()
    layered.settle()
    group = next(index for index, number in enumerate(before[::-1]) if number in (SKULL, 3, HAT))
    layered.do(lambda hand: hand.item_drag_and_drop(row(ARM, "layer"), row(group, "group")))
    order = layered.session.drawing.layer_order
    assert order[order.index(HAT) + 1] == ARM
    assert layer(layered, ARM).groups == ("head",)
    assert layer(layered, ARM).closed_groups == (() if is_open else (0,))
    assert [number for number in order if number != ARM] == [number for number in before if number != ARM]


def test_the_menu_moves_a_layer(layered):
    def choose(label):
        def run(hand):
            hand.item_click(row(ARM, "layer"), imgui.MouseButton_.right)
            hand.yield_(3)
            hand.item_click(f"//$FOCUSED/{label}")

        layered.do(run)
        return layered.session.drawing.layer_order

    assert choose("Bring to Front") == (0, 2, 3, 4, 1)
    assert choose("Send Backward") == (0, 2, 3, 1, 4)
    assert choose("Bring Forward") == (0, 2, 3, 4, 1)
    assert choose("Send to Back") == (1, 0, 2, 3, 4)


def test_a_drag_of_the_opacity_is_one_entry_of_the_history(layered):
    click(layered, BODY, "layer")
    count = len(labels(layered))

    def drag(hand):
        hand.mouse_move("//Panel/**/##layer opacity")
        hand.mouse_down()
        for _ in range(4):
            hand.mouse_move_to_pos(imgui.get_io().mouse_pos + imgui.ImVec2(-8, 0))
            hand.yield_(2)
        hand.mouse_up()

    layered.do(drag)
    assert layer(layered, BODY).opacity < 0.9
    assert labels(layered)[count:] == ["Change Layer Opacity"]
    layered.session.undo()
    assert layer(layered, BODY).opacity == 1


def test_a_pin_selects_its_layer_which_is_outlined(layered):
    plain = layered.screenshot()
    layered.click(layered.to_screen((80, 150)))
    assert layered.state.view.selected_layer == BODY
    layered.editor.select(())
    layered.settle()
    assert (layered.screenshot() != plain).any()


def test_the_list_scrolls_to_the_layer_of_a_pin(layered, monkeypatch):
    scrolls, draw = [], layers.draw_thumbnail
    monkeypatch.setattr(layers, "_ROWS", 2)
    monkeypatch.setattr(
        layers, "draw_thumbnail", lambda *args: (scrolls.append(imgui.get_scroll_y()), draw(*args))
    )
    layered.settle()
    assert scrolls[-1] == 0
    layered.click(layered.to_screen((80, 150)))
    assert layered.state.view.selected_layer == BODY
    layered.settle()
    assert scrolls[-1] > 0


def test_a_flat_drawing_has_no_such_section(pinned):
    assert pinned.state.view.selected_layer is None
    assert not pinned.state.document.drawing.layers
