"""The graph below the timeline: handles of an easing, selection of an interval, the playhead."""

import numpy as np
import pytest
from imgui_bundle import imgui

from akap_editor.app.timeline.easing_handles import OVERSHOOT
from akap_editor.editor.document.easing import curve_like, easing_curve


@pytest.fixture
def keyed(pinned):
    """Keyframes at 0, 1 and 2 seconds, and the graph."""
    state = pinned.state
    state.timeline.is_shown, state.timeline.mode, state.view.show_speed_graph = True, "keyframes", True
    pinned.settle()
    playback, rest = state.timeline.keyframe_playback, pinned.session.drawing.mesh.vertices
    for time in range(3):
        playback.set_keyframe(float(time), rest + np.array([30.0 * time * time, 0.0]))
    playback.set_default_easing("in-out")
    playback.selected = frozenset()
    playback.scrub(0.0)
    pinned.settle()
    return pinned


def on_graph(ui, time, progress, start=0.0, end=1.0):
    """The place of a time on the graph, and of a share of the motion."""
    found = {}
    ui.do(lambda hand: found.setdefault("rect", hand.item_info("//Timeline/##speed").rect_full))
    rect, view = found["rect"], ui.state.timeline.keyframe_playback.visible_range
    left, width = rect.min.x + 8, rect.max.x - rect.min.x - 16
    unit = (rect.max.y - rect.min.y - 12) / (1 + 2 * OVERSHOOT)
    y = rect.max.y - 6 - OVERSHOOT * unit - progress * unit
    return round(left + width * (time - view.start) / view.seconds), round(y)


def test_a_press_selects_an_interval_and_moves_the_playhead(keyed):
    playback = keyed.state.timeline.keyframe_playback
    keyed.click(on_graph(keyed, 1.5, 1.2))
    assert playback.selected == {1.0}
    assert playback.time == pytest.approx(1.5, abs=0.02)
    keyed.drag(on_graph(keyed, 1.5, 1.2), on_graph(keyed, 0.5, 1.2))
    assert playback.time == pytest.approx(0.5, abs=0.03)


def test_a_handle_makes_the_easing_a_curve_in_one_undo_step(keyed):
    playback, depth = keyed.state.timeline.keyframe_playback, keyed.session.history.depth
    keyed.click(on_graph(keyed, 0.5, 1.2))
    keyed.drag(on_graph(keyed, 1 / 3, 0), on_graph(keyed, 0.6, 0.5))
    first, second, _ = keyed.session.present.animation.keyframes
    curve = easing_curve(first.ease)
    assert (curve.x1, curve.y1) == pytest.approx((0.6, 0.5), abs=0.03)
    assert (curve.x2, curve.y2) == pytest.approx((2 / 3, 1), abs=1e-3)
    assert second.ease is None
    assert keyed.session.history.depth == depth + 1
    keyed.drag(on_graph(keyed, 2 / 3, 1), on_graph(keyed, 0.8, 1.3))
    curve = easing_curve(keyed.session.present.animation.keyframes[0].ease)
    assert curve.y2 == pytest.approx(1.3, abs=0.03)
    assert curve.value(0.9) > 1, "it overshoots"
    keyed.editor.undo()
    keyed.editor.undo()
    assert keyed.session.present.animation.keyframes[0].ease is None
    assert playback.selected == {0.0}


def test_a_held_pose_has_no_handles_and_escape_takes_a_drag_back(keyed):
    playback = keyed.state.timeline.keyframe_playback
    before = keyed.session.present.animation
    keyed.click(on_graph(keyed, 0.5, 1.2))
    place, handle = on_graph(keyed, 0.6, 0.5), on_graph(keyed, 1 / 3, 0)

    def drag(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*handle))
        hand.mouse_down(0)
        hand.mouse_move_to_pos(imgui.ImVec2(*place))
        hand.key_press(imgui.Key.escape)
        hand.mouse_up(0)

    keyed.do(drag)
    assert keyed.session.present.animation is before
    playback.set_easing("hold")
    keyed.drag(on_graph(keyed, 1 / 3, 0), on_graph(keyed, 0.6, 0.5))
    assert keyed.session.present.animation.keyframes[0].ease == "hold"


def test_curve_in_the_menu_begins_with_the_same_motion(keyed):
    playback = keyed.state.timeline.keyframe_playback
    keyed.click(on_graph(keyed, 0.5, 1.2))
    playback.set_easing("in")
    keyed.state.timeline.keyframe_menu_requested = True
    keyed.settle()
    keyed.do(lambda hand: hand.item_click("//$FOCUSED/Curve"))
    assert keyed.session.present.animation.keyframes[0].ease == curve_like("in").name
