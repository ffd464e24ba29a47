"""The preview in the dialog that exports an animation."""

import math

import numpy as np
import pytest

from akap_editor.app.dialogs.export.animation import AnimationExportOptions, ExportAnimationDialog
from akap_editor.app.dialogs.export.animation_size import AnimationSize
from akap_editor.app.dialogs.export.preview import AnimationPreview

PREVIEW = slice(780, 1120)  # columns of the window


class Clock:
    seconds = 0.0

    def __call__(self):
        return self.seconds


@pytest.fixture
def playing(pinned):
    """The dialog of two keyframes, 0.5 s apart, with a preview whose clock stands still; and the clock."""
    state, clock = pinned.state, Clock()
    state.timeline.show_keyframes()
    playback = state.timeline.keyframe_playback
    playback.set_keyframe(0.0)
    pinned.bend()
    playback.set_keyframe(0.5)
    pinned.settle()
    dialog = state.part(ExportAnimationDialog)
    dialog._preview = AnimationPreview(clock)
    AnimationExportOptions("APNG", fps=10).remember(state.preferences)
    dialog.open(state)
    pinned.settle()
    return pinned, clock


def test_it_plays_over_and_over_and_asks_for_the_next_frame(playing):
    ui, clock = playing
    pictures = []
    for seconds in (0.0, 0.05, 0.25, 0.45, 0.6, 0.65):  # 6 frames in 0.6 s
        clock.seconds = seconds
        pictures.append(ui.screenshot()[:, PREVIEW])
    assert (pictures[0] == pictures[1]).all(), "a frame lasts a tenth of a second"
    assert (pictures[0] != pictures[2]).any()
    assert (pictures[2] != pictures[3]).any()
    assert (pictures[4] == pictures[0]).all()
    assert ui.state.frame_delay == pytest.approx(0.05)
    ui.dialog("Export animation", "Cancel")
    assert ui.state.frame_delay == math.inf


def test_the_last_frame_is_the_pose_that_is_written(playing):
    ui, clock = playing
    clock.seconds = 0.55
    ui.settle()
    preview = ui.state.part(ExportAnimationDialog)._preview
    frame = ui.state.timeline.frame(0.5)
    times = [number / 10 for number in range(6)]
    box, scale = AnimationSize(lambda: 0.0).framing(ui.state, times, 640, False)
    written = ui.state.offscreen_renderer.render(frame.drawing, frame.pose, box, scale, None, frame.order)
    shown = preview._pictures[0.5]
    assert np.abs(shown.astype(int) - written).mean() < 1.0
