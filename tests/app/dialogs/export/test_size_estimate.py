"""The estimated size of an animation's file beside the real one."""

import pytest

from akap_editor.app.dialogs.export.animation import (
    DIALOG_FORMATS,
    AnimationExportOptions,
    export_animation,
    frame_times_in_order,
)
from akap_editor.app.dialogs.export.animation_size import AnimationSize
from akap_editor.app.dialogs.export.size_estimate import SizeEstimate, WrittenAnimation, size_in_words


@pytest.fixture
def keyed(pinned):
    pinned.add_keyframes(1.0, (0.0, -120.0))
    return pinned


def estimated(ui, options):
    state = ui.state
    times = options.frame_times(*state.timeline.playback.played_range)
    framing = AnimationSize(lambda: 0.0).framing(state, times, options.size, options.chosen_format.is_video)
    order = tuple(frame_times_in_order(state, options))
    animation = WrittenAnimation(
        options.chosen_format, order, framing, options.written_fps, options.plays, options.visible_background
    )
    estimate = SizeEstimate()
    sizes = []
    ui.frame_until(lambda: sizes.append(estimate.advance(state, animation)) or not estimate.is_rough)
    estimate.close()
    return [size for size in sizes if size is not None]


@pytest.mark.parametrize("kind", DIALOG_FORMATS, ids=[each.label for each in DIALOG_FORMATS])
def test_the_estimate_is_near_the_size_of_the_file(keyed, tmp_path, kind):
    if kind.is_video:
        pytest.importorskip("av")
    options = AnimationExportOptions(kind.label, fps=24, size=120)
    path = tmp_path / f"out{kind.suffix}"
    export_animation(keyed.state, options, path)
    keyed.settle()
    files = [path, path.with_suffix(".json")] if path.is_file() else list(path.iterdir())
    size = sum(each.stat().st_size for each in files if each.exists())
    first, *_, last = estimated(keyed, options)
    assert last == pytest.approx(size, rel=0.35)
    assert size / 3 < first < 3 * size, "known after few frames"


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (340, "0.34 kB"),
        (12_345, "12 kB"),
        (994_000, "990 kB"),
        (999_999, "1 MB"),
        (34_567_890, "35 MB"),
        (2_340_000_000, "2.3 GB"),
    ],
)
def test_sizes_in_words(size, words):
    assert size_in_words(size) == words
