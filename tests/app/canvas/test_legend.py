"""The legend of the overlays."""

from akap_editor.app.canvas.view_options import DISTORTION_RANGES


def test_a_click_on_the_scale_chooses_another_range(pinned):
    pinned.state.view.distortion_measure = "angle"
    pinned.settle()
    before = pinned.state.view.distortion_range
    pinned.do(lambda hand: hand.item_click("//##legend/##range"))
    assert pinned.state.view.distortion_range == (before + 1) % len(DISTORTION_RANGES)
