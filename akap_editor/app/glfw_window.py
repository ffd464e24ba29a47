"""The GLFW window: creation, remembered size and position, key callback, mouse cursors, ImGui's drawing."""

# imgui_bundle first: its import makes pyGLFW load the same libglfw that ImGui's backend is linked to
from imgui_bundle import imgui  # isort: skip
import math
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import glfw
from PIL import Image

from ..errors import DisplayError, GraphicsError
from ..resources import resource
from ..words import tr
from .preferences import Preferences

_MODIFIERS = range(glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SUPER + 1)
_UNUSED_KEY = imgui.Key.f24  # no command has it
_SHAPES = {  # of the system's mouse cursor; the arrow for all others
    imgui.MouseCursor_.text_input: glfw.IBEAM_CURSOR,
    imgui.MouseCursor_.resize_all: glfw.RESIZE_ALL_CURSOR,
    imgui.MouseCursor_.resize_ns: glfw.RESIZE_NS_CURSOR,
    imgui.MouseCursor_.resize_ew: glfw.RESIZE_EW_CURSOR,
    imgui.MouseCursor_.resize_nesw: glfw.RESIZE_NESW_CURSOR,
    imgui.MouseCursor_.resize_nwse: glfw.RESIZE_NWSE_CURSOR,
    imgui.MouseCursor_.hand: glfw.POINTING_HAND_CURSOR,
    imgui.MouseCursor_.not_allowed: glfw.NOT_ALLOWED_CURSOR,
}

Area = tuple[int, int, int, int]  # left, top, width, height in screen coordinates

DEFAULT_SIZE, MIN_SIZE = (1280, 800), (640, 400)  # design points
MAX_SIDE = 16384  # of a remembered size, design points
ICON_SIDES = (16, 32, 48, 128)  # pixels
FRAME_ROOM = 48  # screen coordinates beside a window for its frame and title
BLANK_SIDE = 16  # pixels of the cursor that is seen through; systems may enlarge a smaller one
GRIP = 64  # screen coordinates of the window's upper left corner that must be on a screen, to drag it by


def create_window(null: bool, hidden: bool, size: tuple[int, int]) -> Any:
    """A GLFW window whose OpenGL 3.3 context is current. See `Window` for the arguments.

    Raises DisplayError without a display, GraphicsError without OpenGL 3.3.
    """
    if null:
        glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_NULL)
    elif sys.platform.startswith("linux") and os.environ.get("DISPLAY"):
        # Under Wayland through XWayland: otherwise a window has no icon and cannot be put where it was.
        glfw.init_hint(glfw.PLATFORM, glfw.PLATFORM_X11)
    if not glfw.init():
        raise DisplayError(tr("there is no display: expected an X11 or Wayland session to open a window in"))
    if null:
        glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
    for hint, value in (
        (glfw.CONTEXT_VERSION_MAJOR, 3),
        (glfw.CONTEXT_VERSION_MINOR, 3),
        (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
        (glfw.OPENGL_FORWARD_COMPAT, True),
        (glfw.DEPTH_BITS, 0),
        (glfw.STENCIL_BITS, 0),
        (glfw.SCALE_TO_MONITOR, True),
        (glfw.VISIBLE, not hidden),
    ):
        glfw.window_hint(hint, value)
    handle = glfw.create_window(*size, "akap-editor", None, None)
    if not handle:
        glfw.terminate()
        raise GraphicsError(tr("this computer offers no OpenGL 3.3 core profile, which the window needs"))
    if not null and sys.platform != "darwin":  # macOS takes the icon from the bundle
        icons: list[Any] = [
            Image.open(resource("assets", "icons", f"akap-editor-{side}.png")) for side in ICON_SIDES
        ]
        glfw.set_window_icon(handle, len(icons), icons)
    if not null:  # the null platform takes the smallest height for the largest
        glfw.set_window_size_limits(handle, *MIN_SIZE, glfw.DONT_CARE, glfw.DONT_CARE)
    if not null:
        _fit_into_screen(handle)
    glfw.make_context_current(handle)
    glfw.swap_interval(1)
    return handle


def set_drop_callback(handle: Any, on_drop: Callable[[list[Path]], None]) -> object:
    """Let GLFW call ``on_drop`` with the files that are dropped; the result must live as long as the window.

    `glfw.set_drop_callback` raises an exception for names that are not UTF-8.
    """

    def pass_on(_: object, count: int, names: Any) -> None:
        on_drop([Path(os.fsdecode(names[index])) for index in range(count)])

    callback: object = glfw._GLFWdropfun(pass_on)  # type: ignore[attr-defined]  # not in its stubs
    glfw._glfw.glfwSetDropCallback(handle, callback)  # type: ignore[attr-defined]
    return callback


def _fit_into_screen(handle: Any) -> None:
    """Make a window smaller that is larger than the largest screen, for example on one of 200 %."""
    size, rooms = glfw.get_window_size(handle), [area[2:] for area in screens()]
    if rooms:
        fitting = fitting_size(size, max(rooms, key=lambda room: room[0] * room[1]))
        if fitting != size:
            glfw.set_window_size(handle, *fitting)


def fitting_size(size: tuple[int, int], room: tuple[int, int]) -> tuple[int, int]:
    """A window's size, or if it is larger than a screen, one that leaves `FRAME_ROOM` there for its frame."""
    if size[0] <= room[0] and size[1] <= room[1]:
        return size
    return min(size[0], room[0] - FRAME_ROOM), min(size[1], room[1] - FRAME_ROOM)


class FullScreen:
    """Lets a window cover the monitor that it is on, and return to its size and position."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle
        self._windowed: Area | None = None  # None while it covers none

    @property
    def is_on(self) -> bool:
        """Whether the window covers a monitor."""
        return self._windowed is not None

    def set(self, is_on: bool) -> None:
        """Cover the monitor, or return; nothing if it is so already, or if there is no monitor."""
        if is_on == self.is_on:
            return
        monitors = glfw.get_monitors()
        if not monitors:
            return
        if self._windowed is not None:
            area, self._windowed = self._windowed, None
            glfw.set_window_monitor(self._handle, None, *area, glfw.DONT_CARE)  # type: ignore[arg-type]
            return
        x, y = glfw.get_window_pos(self._handle)
        width, height = glfw.get_window_size(self._handle)
        self._windowed = x, y, width, height
        center = x + width / 2, y + height / 2
        monitor = min(monitors, key=lambda each: math.dist(glfw.get_monitor_pos(each), center))
        mode = glfw.get_video_mode(monitor)
        glfw.set_window_monitor(self._handle, monitor, 0, 0, *mode.size, mode.refresh_rate)


class MouseCursors:
    """Gives the mouse pointer the cursor that ImGui requests, in place of ImGui's backend.

    The backend hides the cursor by GLFW's cursor mode. When the mode changes, GLFW takes the pointer's
    position for one that it has reported, and does not report a motion to it that is still queued behind
    other events, for example the release of a button. So the mode stays; a hidden cursor is a blank one.
    """

    def __init__(self, handle: Any) -> None:
        self._handle, self._shown = handle, int(imgui.MouseCursor_.arrow)
        self._made: dict[int, Any] = {}
        imgui.get_io().config_flags |= imgui.ConfigFlags_.no_mouse_cursor_change

    def update(self) -> None:
        """Show the cursor that was requested in this frame."""
        wanted = int(imgui.get_mouse_cursor())
        if wanted != self._shown:
            self._shown = wanted
            if wanted not in self._made:
                self._made[wanted] = self._make(wanted)
            glfw.set_cursor(self._handle, self._made[wanted])

    @staticmethod
    def _make(wanted: int) -> Any:
        """A cursor of GLFW; None, which shows the arrow, for the arrow and for what the system lacks."""
        if wanted == imgui.MouseCursor_.none:
            blank = [[(0, 0, 0, 0)] * BLANK_SIDE] * BLANK_SIDE
            image: Any = BLANK_SIDE, BLANK_SIDE, blank
            return glfw.create_cursor(image, 0, 0) or None
        shape = _SHAPES.get(imgui.MouseCursor_(wanted))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", glfw.GLFWError)
            return None if shape is None else glfw.create_standard_cursor(shape) or None


def remembered_size(preferences: Preferences) -> tuple[int, int]:
    """Width and height in design points, within limits."""
    match preferences.get("window", [*DEFAULT_SIZE]):
        case [int(width), int(height)]:
            return min(max(width, MIN_SIZE[0]), MAX_SIDE), min(max(height, MIN_SIZE[1]), MAX_SIDE)
    return DEFAULT_SIZE


def remembered_position(
    preferences: Preferences, screens: Sequence[Area], size: tuple[int, int]
) -> tuple[int, int] | None:
    """The upper left corner of the window; None if it is not on one of the screens any more.

    size: of the window in screen coordinates. It may have grown because the screen has another scale now; the
    corner is then moved so that the window is wholly on its screen.
    """
    remembered: list[object] = preferences.get("place", [])
    match remembered:
        case [int(x), int(y)]:
            for left, top, width, height in screens:
                if left <= x <= left + width - GRIP and top <= y <= top + height - GRIP:
                    return _shifted(x, left, width, size[0]), _shifted(y, top, height, size[1])
    return None


def remember_place(handle: Any, full_screen: FullScreen, scale: float, preferences: Preferences) -> None:
    """Store size and position of the window, and whether it is maximized. scale: points per design point."""
    is_maximized = bool(glfw.get_window_attrib(handle, glfw.MAXIMIZED))
    preferences.put("maximized", is_maximized)
    if not (is_maximized or full_screen.is_on or glfw.get_window_attrib(handle, glfw.ICONIFIED)):
        width, height = glfw.get_window_size(handle)
        preferences.put("window", [round(width / scale), round(height / scale)])
        preferences.put("place", list(glfw.get_window_pos(handle)))


def _shifted(start: int, screen_start: int, screen_length: int, length: int) -> int:
    """The start of an interval, moved so that it ends on the screen; at the earliest that of the screen."""
    return max(min(start, screen_start + screen_length - length), screen_start)


def screens() -> list[Area]:
    """The part of each monitor that windows may cover."""
    return [glfw.get_monitor_workarea(monitor) for monitor in glfw.get_monitors()]


def on_key(window: Any, key: int, scancode: int, action: int, mods: int) -> None:
    """GLFW's key callback: gives ImGui the keys of one frame in the order in which they were pressed.

    It must be set before ImGui's callback, which calls it first.
    ImGui reads the modifiers at the end of a frame: of Ctrl down, D down, Ctrl up in one frame it would see
    only D. But it takes only one event of a key into a frame, so two events of a key without meaning, queued
    before the release of a modifier, leave this release to the next frame.
    """
    if key in _MODIFIERS and action == glfw.RELEASE:
        io = imgui.get_io()
        io.add_key_event(_UNUSED_KEY, True)
        io.add_key_event(_UNUSED_KEY, False)


def render_imgui() -> None:
    """End ImGui's frame. A function, so that tests can replace it by one that works with the Test Engine."""
    imgui.render()


def draw_imgui() -> None:
    """Draw ImGui's part of the frame with OpenGL."""
    imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())
