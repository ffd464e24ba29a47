"""Drives the whole window by labels, mouse and keys, through Dear ImGui's Test Engine."""

# imgui_bundle first: its import makes pyGLFW load the same libglfw that ImGui's backend is linked to
from imgui_bundle import imgui  # isort: skip
import ctypes
import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any

import glfw
import imgui_bundle._imgui_bundle as native
import numpy as np
import pytest
from numpy.typing import NDArray

from akap_editor.app import files
from akap_editor.app.app_state import AppState
from akap_editor.app.canvas.scene import Scene, SceneContent
from akap_editor.app.commands.command import Command
from akap_editor.app.dialogs.file_dialog import FileDialog, FileRequest
from akap_editor.app.frame import layout
from akap_editor.app.glfw_window import draw_imgui
from akap_editor.app.jobs.background_thread import BackgroundThread
from akap_editor.app.jobs.task import Task
from akap_editor.app.window import Window
from akap_editor.editor.document.document import Document, EditState
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.session import Session
from akap_editor.editor.tools.rotate import RING_RADIUS

te = imgui.test_engine
Point = tuple[float, float]
MAX_FRAMES, DEADLINE = 2000, 60.0  # frames and seconds for one action; it fails when it has taken both

# ImGui::Render waits for the thread of the Test Engine, which runs Python. Its binding keeps the interpreter
# locked, a deadlock; a call through ctypes releases the lock.
render_unlocked = ctypes.CDLL(native.__file__)._ZN5ImGui6RenderEv
render_unlocked.restype, render_unlocked.argtypes = None, []

_take_screenshot, _paint_scene = Window.screenshot, Scene.paint


class DeferredPainter:
    """Draws a frame with OpenGL only if a picture of the frame is taken; what it shows is always computed.

    With software OpenGL the drawing is the larger part of a test's cost, and most tests look at no picture.
    """

    def __init__(self) -> None:
        self._due: list[Callable[[], None]] = []

    @contextmanager
    def deferring(self) -> Iterator[None]:
        """While this lasts, the windows of the tests draw with this painter."""
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Scene, "paint", lambda scene, content: self._defer_scene(scene, content))
            patch.setattr("akap_editor.app.glfw_window.draw_imgui", self._defer_imgui)
            patch.setattr(Window, "screenshot", lambda window: self._screenshot(window))
            yield

    def _defer_scene(self, scene: Scene, content: SceneContent) -> None:
        self._due = [lambda: _paint_scene(scene, content)]

    def _defer_imgui(self) -> None:
        self._due.append(draw_imgui)

    def _screenshot(self, window: Window) -> NDArray[np.uint8]:
        for draw in self._due:
            draw()
        self._due = []
        return _take_screenshot(window)


def _patience() -> Iterator[None]:
    """Until an action has taken too many frames and too long: a thread may need thousands of fast frames."""
    deadline = time.monotonic() + DEADLINE
    for number in count():
        if number >= MAX_FRAMES and time.monotonic() > deadline:
            return
        yield


class WindowDriver:
    """A window with an artificial hand.

    Points of the screen are whole numbers, because the Test Engine rounds down; points of the drawing are in
    drawing units. Every action ends when the window is idle again.
    """

    def __init__(self, window: Window) -> None:
        self.window = window
        self._engine = te.create_context()
        io = te.get_io(self._engine)
        io.config_run_speed = te.TestRunSpeed.fast
        io.config_saved_settings = False
        io.config_mouse_draw_cursor = False
        io.config_fixed_delta_time = 1 / 60
        te.start(self._engine, imgui.get_current_context())
        self._count = 0
        self._main_thread_actions: list[Callable[[], None]] = []

    def close(self) -> None:
        """Close the window and end the Test Engine."""
        te.stop(self._engine)
        self.window.close()
        te.destroy_context(self._engine)  # only after ImGui's context

    def reset(self, document: Document, clock: Callable[[], float] = time.monotonic) -> None:
        """Put the window into the state of a new program with this document.

        clock: the editor's, in seconds.
        """
        if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
            imgui.internal.close_popup_to_level(0, False)
        self.state.end_work()
        wake = self.window.wake
        editor = Editor(clock, BackgroundThread("engine", wake))
        self.window.state = AppState(
            editor,
            wake,
            offscreen_renderer=self.window.state.offscreen_renderer,
            thumbnails=self.window.state.thumbnails,
        )
        self.editor.ui_scale = self.window.scale
        files.show_document(self.state, document)
        self.do(lambda hand: hand.mouse_move_to_pos(imgui.ImVec2(*self.empty_point)))
        assert not self.state.error

    # -- the state -----------------------------------------------------------------------------------------

    @property
    def state(self) -> AppState:
        return self.window.state

    @property
    def editor(self) -> Editor:
        return self.state.editor

    @property
    def session(self) -> Session:
        assert self.editor.session is not None
        return self.editor.session

    @property
    def document(self) -> Document:
        return self.session.document

    @property
    def pins(self) -> tuple[Pin, ...]:
        return self.session.state.pins

    @property
    def file_request(self) -> FileRequest | None:
        """The request that the file dialog shows."""
        return self.state.part(FileDialog).request

    @property
    def tool(self) -> str:
        """Name of the class of the active tool."""
        return type(self.editor.tool).__name__

    @property
    def empty_point(self) -> Point:
        """A point of the screen on the canvas beside the drawing."""
        left, top, _, _ = self.editor.canvas
        return left + 8, top + 8

    def to_screen(self, point: Point) -> Point:
        """The point of the screen nearest to a point of the drawing."""
        x, y = self.editor.camera.to_screen(point)
        return float(round(x)), float(round(y))

    def to_drawing(self, point: Point) -> Point:
        """The point of the drawing that is seen at a point of the screen."""
        return self.editor.camera.to_drawing(point)

    def pin_position(self, pin_id: int) -> NDArray[np.float64]:
        """(2,) where a pin is now, in the drawing."""
        ids = [pin.id for pin in self.pins]
        return self.session.pin_positions()[ids.index(pin_id)]

    def ring_points(self, pin: int, *degrees: float) -> list[Point]:
        """Points of the screen on the rotation ring of a pin, in directions clockwise from the right."""
        x, y = self.to_screen(self.pin_position(pin))
        angles = [math.radians(angle) for angle in degrees]
        return [(x + RING_RADIUS * math.cos(angle), y + RING_RADIUS * math.sin(angle)) for angle in angles]

    # -- frames --------------------------------------------------------------------------------------------

    def frame(self) -> None:
        """Draw one frame; the Test Engine does its next step."""
        glfw.poll_events()
        self.window.frame()
        te.post_swap(self._engine)

    def settle(self) -> None:
        """Draw frames until nothing moves and no thread computes; a thread that is done must wake it."""
        self.window.wake()
        for _ in _patience():
            if self.window.needs_frame:
                self.frame()
            elif self.state.is_busy:
                self.window.wait_for_events(DEADLINE)
                assert self.window.needs_frame, f"nothing has woken the window within {DEADLINE:g} s"
            else:
                return
        raise AssertionError(f"still busy after {MAX_FRAMES} frames")

    def frame_until(self, holds: Callable[[], bool]) -> None:
        """Draw frames until ``holds()``, for what a thread has to bring about while the window is busy."""
        deadline = time.monotonic() + DEADLINE
        while not holds():
            assert time.monotonic() < deadline, f"not within {DEADLINE:g} s"
            self.frame()

    def screenshot(self) -> NDArray[np.uint8]:
        """The idle window, (h, w, 3)."""
        snapshots: list[NDArray[np.uint8]] = []
        self.settle()
        self.window.after_draw.append(lambda: snapshots.append(self.window.screenshot()))
        self.frame()
        self.window.after_draw.clear()
        return snapshots[0]

    # -- actions -------------------------------------------------------------------------------------------

    def do(self, actions: Callable[[Any], None], settle: bool = True) -> None:
        """Run ``actions(hand)`` while frames are drawn; raises its exceptions.

        hand: a context of the Test Engine. It runs in another thread, where OpenGL and GLFW must not be
        called; see `on_main_thread`. settle: whether to wait until the window is idle.
        """
        failures: list[BaseException] = []

        def catching(hand: Any) -> None:
            try:
                actions(hand)
            except BaseException as error:
                failures.append(error)

        self._count += 1
        test = te.register_test(self._engine, "window", str(self._count))
        test.test_func = catching
        te.queue_test(self._engine, test)
        try:
            self._run_queue()
        except BaseException:
            te.abort_current_test(self._engine)
            with suppress(Exception):
                self._run_queue()
            raise
        log = test.output.log.get_text()
        assert te.is_test_queue_empty(self._engine), f"not done after {MAX_FRAMES} frames: {log}"
        if failures:
            raise failures[0]
        assert test.output.status == te.TestStatus.success, log
        if settle:
            self.settle()

    def _run_queue(self) -> None:
        """Draw frames until the Test Engine has nothing left to do."""
        for _ in _patience():
            if te.is_test_queue_empty(self._engine):
                return
            while self._main_thread_actions:
                self._main_thread_actions.pop(0)()
            self.frame()

    def on_main_thread(self, hand: Any, action: Callable[[], None], frames: int = 2) -> None:
        """From ``actions``: run ``action`` in the main thread between two frames."""
        self._main_thread_actions.append(action)
        hand.yield_(frames)

    def menu(self, *path: str) -> None:
        """Click a menu item, given the labels on the path to it."""
        self.do(lambda hand: self._menu(hand, path))

    @staticmethod
    def _menu(hand: Any, path: tuple[str, ...]) -> None:
        hand.set_ref("##MainMenuBar")
        hand.menu_click("/".join(path))

    def tool_button(self, command: Command) -> None:
        """Click a command's button in the tool bar."""
        self.do(lambda hand: hand.item_click(f"//Tools/{command.icon}##{command.label}"))

    def tab(self, tab: layout.Tab) -> None:
        """Click a tab of the side panel."""
        self.do(lambda hand: hand.item_click(f"//Tabs/###tab {tab}"))

    def unfold(self, tab: layout.Tab, *titles: str) -> None:
        """Show a tab of the side panel with these parts unfolded."""
        layout.show_tab(self.state, tab)
        self.state.preferences.put("sections", dict.fromkeys(titles, True))
        self.settle()

    def panel(self, label: str) -> None:
        """Click an item of the current tab of the side panel."""
        self.do(lambda hand: hand.item_click(f"//Panel/{label}"))

    def dialog(self, title: str, *labels: str) -> None:
        """Click items of a dialog, one after the other."""

        def click(hand: Any) -> None:
            for label in labels:
                hand.item_click(f"//{title}###dialog {title}/{label}")

        self.do(click)

    def type_name(self, title: str, text: str, enter: bool = True) -> None:
        """Replace the name in a file dialog."""

        def type_(hand: Any) -> None:
            hand.item_input(f"//{title}###dialog {title}/##name")
            (hand.key_chars_replace_enter if enter else hand.key_chars_replace)(text)

        self.do(type_)

    def key(self, *chords: int) -> None:
        """Press and release keys."""

        def press(hand: Any) -> None:
            for chord in chords:
                hand.key_press(int(chord))

        self.do(press)

    def keys(self, *chords: int, look: Callable[[], Any] | None = None) -> list[Any]:
        """Press keys in one go; returns what ``look`` finds after each of them.

        In one go, because Test Engine takes its mouse away at the end of its tests, which ends the crosshair.
        """
        seen: list[Any] = []

        def press(hand: Any) -> None:
            hand.yield_(2)
            self.editor.last_pointer = None  # so that the crosshair begins in the middle
            for chord in chords:
                hand.key_press(int(chord))
                hand.yield_(3)
                if look is not None:
                    self.on_main_thread(hand, lambda: seen.append(look()))

        self.do(press)
        return seen

    def walk_to(self, label: str, *chords: int) -> None:
        """Go to the side panel, through it with Tab to an item, and press keys there."""

        def act(hand: Any) -> None:
            wanted = hand.item_info(f"//Panel/{label}").id_
            hand.key_press(imgui.Key.f6)
            for _ in range(80):
                hand.yield_(2)
                if imgui.get_current_context().nav_id == wanted:
                    break
                hand.key_press(imgui.Key.tab)
            else:
                raise AssertionError(f"Tab never comes to {label}")
            for chord in chords:
                hand.key_press(int(chord))
                hand.yield_(3)
            hand.key_press(imgui.Key.escape)

        self.do(act)

    def enter_at(self, item: str) -> None:
        """Move the keyboard focus to an item and press Enter."""

        def press(hand: Any) -> None:
            hand.nav_move_to(item)
            hand.key_press(imgui.Key.enter)

        self.do(press)

    def bend(self) -> None:
        """Drag pin 3 upwards, as one undo entry."""
        start = self.to_screen(self.pin_position(3))
        self.drag(start, (start[0], start[1] - 120))
        assert self.session.is_posed

    def add_keyframes(self, end: float, by: Point = (-20.0, -80.0)) -> None:
        """Show keyframes, and add two, at 0 and ``end`` seconds, between which pin 3 is dragged.

        by: points of the screen. The playhead is at the end.
        """
        self.state.timeline.show_keyframes()
        self.settle()
        self.state.timeline.keyframe_playback.set_keyframe(0.0)
        start = self.to_screen(self.pin_position(3))
        self.drag(start, (start[0] + by[0], start[1] + by[1]))
        self.state.timeline.keyframe_playback.set_keyframe(end)
        self.settle()

    def click(self, point: Point, shift: bool = False) -> None:
        """Click a point of the screen."""

        def click(hand: Any) -> None:
            hand.mouse_move_to_pos(imgui.ImVec2(*point))
            if shift:
                hand.key_down(imgui.Key.mod_shift)
            hand.mouse_click(0)
            if shift:
                hand.key_up(imgui.Key.mod_shift)

        self.do(click)

    def drag(self, *path: Point, button: int = 0, held: int | None = None) -> None:
        """Press at the first point of the screen, move through the others, release at the last.

        button: of the mouse; held: a key that is held meanwhile.
        """

        def drag(hand: Any) -> None:
            self.begin_drag(hand, path[0], button, held)
            for point in path[1:]:
                hand.mouse_move_to_pos(imgui.ImVec2(*point))
            hand.mouse_up(button)
            if held is not None:
                hand.key_up(held)

        self.do(drag)

    @staticmethod
    def begin_drag(hand: Any, start: Point, button: int = 0, held: int | None = None) -> None:
        """From ``actions``: press and hold a button of the mouse, and a key."""
        hand.mouse_move_to_pos(imgui.ImVec2(*start))
        if held is not None:
            hand.key_down(held)
        hand.mouse_down(button)

    def wheel(self, point: Point, notches: float) -> None:
        """Turn the mouse wheel at a point of the screen."""

        def turn(hand: Any) -> None:
            hand.mouse_move_to_pos(imgui.ImVec2(*point))
            hand.mouse_wheel_y(notches)

        self.do(turn)

    def drop(self, *paths: Path) -> None:
        """Drop files on the window."""
        self.window.drop(list(paths))
        self.settle()


def one_step(task: Task) -> bool:
    """Replaces `Task.advance`, so that a frame follows each step of a task."""
    try:
        task.progress = next(task.steps)
    except StopIteration:
        return True
    return False


def state_bits(state: EditState) -> tuple[object, ...]:
    """Pins, pose and settings, to compare bit for bit."""
    pins = [(pin.id, pin.face, pin.weights.tobytes(), pin.target.tobytes()) for pin in state.pins]
    return state.positions.tobytes(), pins, state.settings
