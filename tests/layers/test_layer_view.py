"""Slots of layers, and what is shown of a layer list."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.layers.drawing_layer import shown_layers
from akap_editor.layers.layer_view import (
    LayerView,
    group_slots,
    slot_members,
    unused_slot_name,
    view_with_one_shown,
    with_one_shown,
)
from akap_editor.layers.layered_picture import Layer, LayerGroup
from tests.support.puppets import ARM, BODY, EYES, HAT, SKULL, puppet

ORDER = (BODY, ARM, SKULL, EYES, HAT)


def slotted(visible, slot="mouth"):
    """The puppet's layers with body, arm and skull in a slot, those in ``visible`` with an open eye."""
    return [
        replace(layer, visible=number in visible, slot=slot if number in (BODY, ARM, SKULL) else "")
        for number, layer in enumerate(puppet().layers)
    ]


@pytest.mark.parametrize(
    ("visible", "order", "preferred", "expected"),
    [
        ((), ORDER, (), ()),
        ((ARM,), ORDER, (), (ARM,)),
        ((BODY, ARM), ORDER, (), (ARM,)),
        ((BODY, ARM), (ARM, BODY, SKULL, EYES, HAT), (), (BODY,)),
        ((BODY, ARM, SKULL), ORDER, (BODY,), (BODY,)),
        ((BODY, ARM, SKULL), ORDER, (BODY, ARM), (ARM,)),
        ((BODY, EYES, HAT), ORDER, (EYES,), (BODY, EYES, HAT)),  # outside slots nothing changes
    ],
)
def test_of_a_slot_at_most_one_layer_is_visible(visible, order, preferred, expected):
    layers = with_one_shown(slotted(visible), order, preferred)
    assert tuple(number for number, layer in enumerate(layers) if layer.visible) == expected
    if not preferred:
        view = LayerView(tuple(number in visible for number in range(5)), order)
        assert view_with_one_shown(view, slotted(())).visible == tuple(n in expected for n in range(5))


def test_slots_are_named_after_what_their_layers_are_called_alike():
    layers = [replace(layer, name=name) for layer, name in zip(puppet().layers, "abcde", strict=True)]
    assert unused_slot_name(layers, [0, 1]) == "Slot 1"
    for first, second, expected in (
        ("mouth smile", "mouth o", "mouth"),
        ("Mouth_A", "mouth-B", "Mouth"),
        ("hand", "foot", "Slot 1"),
    ):
        layers[0], layers[1] = replace(layers[0], name=first), replace(layers[1], name=second)
        assert unused_slot_name(layers, [0, 1]) == expected
    taken = [replace(layers[0], name="mouth a", slot="mouth"), replace(layers[1], name="mouth b")]
    assert unused_slot_name(taken, [1, 1]) == "mouth b"
    assert slot_members(taken) == {"mouth": [0]}


def test_a_closed_group_hides_its_layers_and_their_eyes_stay():
    layers = [replace(layer, closed_groups=(0,) if layer.groups else ()) for layer in puppet().layers]
    assert shown_layers(layers).tolist() == [True, True, False, False, False]
    assert layers[SKULL].visible
    with pytest.raises(InputError, match="closed_groups: expected indices of 0 groups"):
        replace(layers[BODY], closed_groups=(0,))


def test_a_group_of_which_one_layer_is_visible_is_a_slot():
    picture = np.full((2, 2, 4), 255, np.uint8)
    outer = LayerGroup("head")
    mouths, eyes, hats = (LayerGroup(name) for name in ("mouths", "eyes", "hats"))
    layers = [
        Layer("skull", picture, groups=(outer,)),
        Layer("ear", picture, groups=(outer,), visible=False),
        Layer("smile", picture, groups=(outer, mouths)),
        Layer("sad", picture, groups=(outer, mouths), visible=False),
        Layer("left", picture, groups=(outer, eyes)),
        Layer("right", picture, groups=(outer, eyes)),
        Layer("cap", picture, groups=(hats,)),
        Layer("sun", picture),
    ]
    assert group_slots(layers) == ["", "", "mouths", "mouths", "", "", "", ""]
