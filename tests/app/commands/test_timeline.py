"""The commands of the Animation menu, by keys."""

from akap_editor.app.commands.command import SHIFT, Key
from akap_editor.editor import gestures


def test_keyframes_are_chosen_and_retimed_by_keys(keyed):
    keyed.keys(Key.home, Key.period, SHIFT | Key.period, SHIFT | Key.period)
    assert keyed.session.present.animation.times == (0.0, 1.1)


def test_the_menu_of_a_keyframe_changes_its_easing(keyed):
    keyed.keys(Key.period, SHIFT | Key.f10, *[Key.down_arrow] * 2, Key.enter)
    eases = [key.ease for key in keyed.session.present.animation.keyframes]
    assert eases[0] is None
    assert eases[1] is not None


def test_stepping_stops_what_plays(keyed):
    keyed.state.timeline.playback.toggle_playing()
    keyed.keys(Key.page_down)
    assert not keyed.state.timeline.playback.is_playing


def test_the_session_is_looked_back_at_by_keys(pinned):
    pinned.state.timeline.is_shown = True
    gestures.move_pin(pinned.editor, 3, (210.0, 50.0))
    pinned.settle()
    playback = pinned.state.timeline.session_playback
    pinned.keys(Key.home)
    assert playback.time == 0.0
    assert pinned.session.is_previewing
    pinned.keys(Key.end)
    assert playback.time is None
