"""Pins and the markers of tools on the canvas."""

from imgui_bundle import imgui  # isort: skip
import numpy as np

from akap_editor.editor.editor import PICK_RADIUS

Key = imgui.Key


def test_h_hides_the_pins_while_it_is_held(pinned):
    shown = pinned.screenshot()
    snapshots = []

    def hold(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*pinned.empty_point))
        hand.key_down(Key.h)
        hand.yield_(2)
        pinned.on_main_thread(hand, lambda: pinned.window.after_draw.append(shoot))
        hand.yield_(2)
        hand.key_up(Key.h)

    def shoot():
        snapshots.append(pinned.window.screenshot())
        pinned.window.after_draw.clear()

    pinned.do(hold)
    pinned.state.view.show_pins = False
    hidden = pinned.screenshot()
    canvas = slice(0, round(pinned.editor.canvas[2]))
    assert (snapshots[0][:, canvas] == hidden[:, canvas]).all()
    pinned.state.view.show_pins = True
    assert (pinned.screenshot() == shown).all()


def test_pins_are_hidden_while_the_timeline_plays(pinned):
    timeline, shots = pinned.state.timeline, []
    timeline.show_keyframes()
    timeline.keyframe_playback.update()
    timeline.keyframe_playback.set_keyframe(0.0)
    timeline.keyframe_playback.set_keyframe(60.0)
    pinned.editor.select(())
    timeline.keyframe_playback.scrub(0.0)
    pinned.state.view.show_pins = False
    hidden = pinned.screenshot()
    pinned.state.view.show_pins = True
    timeline.playback.toggle_playing()
    pinned.window.after_draw.append(lambda: shots.append(pinned.window.screenshot()))
    pinned.frame()
    pinned.window.after_draw.clear()
    left, top, right, bottom = map(round, pinned.editor.canvas)
    assert timeline.playback.is_playing
    assert (shots[0][top:bottom, left:right] == hidden[top:bottom, left:right]).all()
    timeline.playback.stop()
    assert (pinned.screenshot()[top:bottom, left:right] != hidden[top:bottom, left:right]).any()


def marker_pixels(shot, at, radius):
    """The part of a screenshot around a point."""
    x, y = map(round, at)
    return shot[y - radius : y + radius + 1, x - radius : x + radius + 1].astype(int)


def test_pins_are_drawn_where_they_are_and_only_when_shown(pinned):
    at = pinned.to_screen(pinned.pin_position(2))
    shown = pinned.screenshot()
    pinned.state.view.show_pins = False
    hidden = pinned.screenshot()
    on_canvas = slice(0, round(pinned.editor.canvas[2]))
    changed = np.argwhere((shown != hidden).any(axis=2)[:, on_canvas])
    around = [pinned.to_screen(pinned.pin_position(pin)) for pin in (1, 2, 3)]
    distances = np.min([np.hypot(*(changed[:, ::-1] + 0.5 - place).T) for place in around], axis=0)
    assert distances.max() < PICK_RADIUS
    across = marker_pixels(shown, at, 9)[9, 13:18]  # from the middle of the dot to beyond the ring
    assert across.min(axis=1).max() > 240, "a white ring around the dot"
    disc = changed[np.hypot(*(changed[:, ::-1] + 0.5 - at).T) < 2 * PICK_RADIUS]
    np.testing.assert_allclose(
        disc.mean(axis=0)[::-1] + 0.5, pinned.editor.camera.to_screen(pinned.pin_position(2)), atol=0.5
    )


def test_the_ring_is_seen_while_alt_is_held(pinned):
    snapshots, places = [], pinned.ring_points(2, 0)

    def look(hand):
        hand.mouse_move_to_pos(imgui.ImVec2(*places[0]))
        for held in (False, True):
            if held:
                hand.key_down(Key.mod_alt)
            hand.yield_(2)
            pinned.on_main_thread(hand, lambda: pinned.window.after_draw.append(shoot))
            hand.yield_(2)
        hand.key_up(Key.mod_alt)

    def shoot():
        ring = pinned.editor.tool.markers.ring
        snapshots.append((ring.pin if ring is not None else None, pinned.window.screenshot()))
        pinned.window.after_draw.clear()

    pinned.do(look)
    (no_pin, before), (pin, after) = snapshots
    assert (no_pin, pin) == (None, 2)
    for x, y in pinned.ring_points(2, 90, 180, 270):
        near = slice(round(y) - 1, round(y) + 2), slice(round(x) - 1, round(x) + 2)
        assert (after != before)[near].any()
