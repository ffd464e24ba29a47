"""The GLFW window: its remembered size and position, and computers that cannot show it."""

import glfw
import pytest

from akap_editor.app.glfw_window import (
    DEFAULT_SIZE,
    MIN_SIZE,
    FullScreen,
    fitting_size,
    remembered_position,
    remembered_size,
)
from akap_editor.app.preferences import Preferences
from akap_editor.app.window import Window
from akap_editor.errors import DisplayError, GraphicsError


@pytest.mark.parametrize(
    ("remembered", "size"),
    [
        ([1000, 700], (1000, 700)),
        ([10, -5], MIN_SIZE),
        ([10**12, 700], (16384, 700)),
        ([1000], DEFAULT_SIZE),
        (["wide", 3], DEFAULT_SIZE),
        ("large", DEFAULT_SIZE),
    ],
)
def test_the_remembered_size_of_the_window(remembered, size):
    preferences = Preferences()
    preferences.put("window", remembered)
    assert remembered_size(preferences) == size


@pytest.mark.parametrize(
    ("remembered", "position"),
    [
        ([100, 80], (100, 80)),
        ([-900, 40], (-900, 40)),
        ([1900, 40], None),
        ([100, 5000], None),
        ([100], None),
        (["left", 3], None),
        (None, None),
    ],
)
def test_the_remembered_position_is_used_if_it_is_still_on_a_screen(remembered, position):
    preferences = Preferences()
    preferences.put("place", remembered)
    screens = [(0, 24, 1920, 1056), (-1280, 0, 1280, 800)]
    assert remembered_position(preferences, screens, (64, 64)) == position
    assert remembered_position(preferences, [], (64, 64)) is None


@pytest.mark.parametrize(
    ("place", "size", "expected"),
    [
        ((960, 607), (1280, 800), (960, 607)),
        ((960, 607), (2560, 1600), (640, 400)),  # as large on a screen of 200 %
        ((960, 607), (4000, 2400), (0, 0)),
        ((3100, 1900), (1280, 800), (1920, 1200)),
    ],
)
def test_a_remembered_window_is_wholly_on_its_screen(place, size, expected):
    preferences = Preferences()
    preferences.put("place", list(place))
    assert remembered_position(preferences, [(0, 0, 3200, 2000)], size) == expected


@pytest.mark.parametrize(
    ("size", "room", "fitting"),
    [
        ((1280, 800), (1920, 1080), (1280, 800)),
        ((1280, 800), (1280, 800), (1280, 800)),
        ((2560, 1600), (1920, 1053), (1872, 1005)),
        ((1280, 800), (1024, 2000), (976, 800)),
    ],
)
def test_a_window_that_is_larger_than_the_screen_gets_smaller_so_that_its_frame_fits(size, room, fitting):
    assert fitting_size(size, room) == fitting


def test_the_monitors_are_asked_for_only_when_the_window_covers_one_or_returns(monkeypatch):
    calls = []
    monkeypatch.setattr(glfw, "get_monitors", lambda: calls.append(1) or [])
    full_screen = FullScreen(None)
    full_screen.set(False)
    assert not calls, "the loop calls it in every frame"
    full_screen.set(True)
    assert calls
    assert not full_screen.is_on


def test_no_display_is_said_in_one_sentence(monkeypatch):
    monkeypatch.setattr(glfw, "init", lambda: False)
    with pytest.raises(DisplayError, match="no display"):
        Window()


def test_no_opengl_is_said_in_one_sentence(monkeypatch):
    monkeypatch.setattr(glfw, "init", lambda: True)
    monkeypatch.setattr(glfw, "window_hint", lambda hint, value: None)
    monkeypatch.setattr(glfw, "create_window", lambda *args: None)
    monkeypatch.setattr(glfw, "terminate", lambda: None)
    with pytest.raises(GraphicsError, match=r"OpenGL 3\.3"):
        Window()
