"""Which part of the time a timeline shows."""

import pytest

from akap_editor.editor.animation.playback import MIN_VISIBLE_SECONDS, VisibleRange


def test_zoom_keeps_its_moment_in_place_and_ends_at_all_there_is():
    view = VisibleRange(10.0)
    view.zoom(2.0, 4.0)
    assert (view.start, view.seconds) == (2.0, 5.0)
    assert view.is_zoomed
    view.zoom(2.0, 2.0)
    assert (view.start, view.seconds) == (2.0, 2.5)
    view.zoom(1000.0, 3.0)
    assert view.seconds == MIN_VISIBLE_SECONDS
    assert (3.0 - view.start) / view.seconds == pytest.approx(0.4)
    view.zoom(0.001, 3.0)
    assert (view.start, view.seconds) == (0.0, 10.0)
    assert not view.is_zoomed


def test_it_goes_along_to_both_ends_and_to_a_moment():
    view = VisibleRange(10.0)
    view.pan(3.0)
    assert view.start == 0.0
    view.zoom(5.0, 0.0)
    view.pan(3.0)
    assert (view.start, view.seconds) == (3.0, 2.0)
    view.reveal(4.0)
    assert view.start == 3.0
    view.reveal(7.0)
    assert view.start == 6.0
    view.pan(99.0)
    assert view.start == 8.0
    view.pan(-99.0)
    assert view.start == 0.0


def test_all_grows_and_what_is_shown_stays_unless_it_was_all():
    view = VisibleRange(2.0)
    view.fit(4.0)
    assert (view.start, view.seconds) == (0.0, 4.0)
    view.zoom(2.0, 4.0)
    view.fit(8.0)
    assert (view.start, view.seconds) == (2.0, 2.0)
    view.fit(3.0)
    assert (view.start, view.seconds) == (1.0, 2.0)
    view.fit(1.5)
    assert (view.start, view.seconds) == (0.0, 1.5)
