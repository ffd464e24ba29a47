"""An animation to run commands on."""

import pytest

from akap_editor.editor import gestures
from tests.support.window_driver import WindowDriver


@pytest.fixture
def keyed(pinned: WindowDriver) -> WindowDriver:
    """The window with keyframes at 0 and at 1 second."""
    playback = pinned.state.timeline.keyframe_playback
    pinned.state.timeline.is_shown, pinned.state.timeline.mode = True, "keyframes"
    pinned.settle()
    playback.set_keyframe(0.0)
    gestures.move_pin(pinned.editor, 3, (210.0, 50.0))
    pinned.settle()
    playback.set_keyframe(1.0)
    playback.scrub(0.0)
    pinned.editor.select(())
    pinned.settle()
    return pinned
