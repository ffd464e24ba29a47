"""The Bending section of the side panel."""

import pytest

from akap_editor.app.commands.command import CTRL, Key
from akap_editor.deform.methods import get_method, method_names, nearest_preset, presets


def test_the_rest_shape_switch_is_an_edit(pinned):
    pinned.panel("Remember rest shape")
    assert pinned.session.state.settings.get("memory") == 0.0
    pinned.panel("Remember rest shape")
    assert pinned.session.state.settings.get("memory") == 1.0
    pinned.key(CTRL | Key.z)
    assert pinned.session.state.settings.get("memory") == 0.0


def test_reset_pose_by_the_panel(pinned):
    pinned.bend()
    pinned.panel("Reset Pose")
    assert not pinned.session.is_posed


def test_every_method_can_be_chosen():
    assert {preset.method for preset in presets()} == set(method_names())


@pytest.mark.parametrize(
    "preset", [each for each in presets() if each.parameters], ids=lambda each: each.spec
)
def test_a_preset_is_chosen_and_keeps_its_memory(pinned, preset):
    def choose(hand):
        hand.set_ref("Panel")
        hand.combo_click(f"##method/{preset.label}")

    pinned.do(choose)
    settings = pinned.session.state.settings
    assert settings.method == preset.method
    memory = {"memory": 1.0} if get_method(preset.method).deformer.has_memory else {}
    assert dict(settings.parameters) == {**preset.parameters, **memory}
    assert nearest_preset(settings.method, dict(settings.parameters)) is preset


def test_choosing_a_method_in_mid_pose_moves_nothing_and_is_undone(pinned):
    pinned.bend()
    pose = pinned.session.state.positions

    def choose(hand):
        hand.set_ref("Panel")
        hand.combo_click("##method/As-rigid-as-possible (ARAP)")

    pinned.do(choose)
    assert pinned.session.state.settings.method == "arap"
    assert pinned.session.state.positions is pose
    pinned.menu("Edit", "Undo")
    assert pinned.session.state.settings.method == "akap"
    assert pinned.session.state.positions is pose
