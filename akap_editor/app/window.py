"""The window and its loop: GLFW, OpenGL and Dear ImGui around the editor."""

# imgui_bundle first: its import makes pyGLFW load the same libglfw that ImGui's backend is linked to
from imgui_bundle import imgui  # isort: skip
import ctypes
import math
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from threading import Event, Lock
from typing import Any

import glfw
import moderngl
import numpy as np
from numpy.typing import NDArray

from ..editor.document.document import Document
from ..errors import AkapError
from ..io.akap.autosave import Autosave
from ..render.offscreen import OffscreenRenderer
from . import files, glfw_window, start_page, theme, widgets
from .app_state import AppState, error_message
from .canvas import split_view
from .canvas.legend import draw_legend
from .canvas.pin_markers import draw_markers
from .canvas.pointer_input import Canvas
from .canvas.scene import Scene
from .canvas.waiting import WaitingPlate
from .commands.focus_navigation import handle_focus_keys
from .commands.palette import Palette
from .commands.registry import restore_keys, run_pressed
from .dialogs import dialogs
from .dialogs.file_dialog import FileDialog, has_native_dialogs
from .dialogs.recovery import RecoveryDialog
from .frame import frame
from .glfw_window import FullScreen, create_window, on_key, remembered_position, remembered_size, screens
from .jobs.engine_preparation import EnginePreparation
from .jobs.reload_artwork import notice_changed_artwork
from .preferences import Preferences
from .termination import TerminationSignals, rescue_on_lost_display
from .thumbnails import Thumbnails

MAX_FAILURES_IN_A_ROW = 3  # of the loop
SETTLE_FRAMES = 3  # ImGui needs this many frames after an event until every widget has its final place
IDLE_SECONDS, BLINK_SECONDS = 1.0, 0.4  # the longest sleep; half the period of a text caret
MINIMIZED_SECONDS = 0.25  # between two looks whether a minimized window can be drawn again
NATIVE_DIALOG_SECONDS = 0.1  # between two looks at a dialog of the system, see `FileDialog.native_is_open`


class Window:
    """The editor's window. Use it as a context manager, or call `close` in the end.

    null: use GLFW's null platform with EGL, which needs no display server; hidden: show no window; scale:
    points per design point, by default that of the monitor; size: in points, by default the remembered one;
    preferences: by default nothing is remembered; autosave: by default unsaved work is not protected;
    engine: whose preparation has begun; by default its machine code is compiled when it is needed.
    Raises DisplayError without a display, GraphicsError without OpenGL 3.3.

    frames: the number of frames drawn so far; after_draw: called in each frame when everything is drawn;
    wait_for_events: sleeps for a number of seconds at most; tests and benchmarks replace it.
    """

    def __init__(
        self,
        null: bool = False,
        hidden: bool = False,
        scale: float | None = None,
        size: tuple[int, int] | None = None,
        preferences: Preferences | None = None,
        autosave: Autosave | None = None,
        engine: EnginePreparation | None = None,
    ) -> None:
        self._woken, self._open_lock, self._is_open = Event(), Lock(), False
        self.state = AppState.from_preferences(preferences or Preferences(), self.wake, engine)
        restore_keys(self.state.preferences)
        self.state.autosave = autosave
        if autosave is not None:
            autosave.remove_leftovers()
            self.state.part(RecoveryDialog).copies = autosave.claim_lost_copies()
        self.state.part(FileDialog).uses_native = has_native_dialogs() and not null
        self.frames = 0
        self.after_draw: list[Callable[[], None]] = []
        self._fixed_scale, self._is_drawing, self._has_focus = scale, False, False
        self._failures_in_a_row, self._title = 0, ""
        self._drops_input = False  # whether events that came while a job blocked the loop are still queued
        self._frames_due = SETTLE_FRAMES
        self._dropped: list[list[Path]] = []
        # GLFW's null platform has no events to wait for and would return at once
        wait_for_wake: Callable[[float], object] = self._woken.wait
        self.wait_for_events = wait_for_wake if null else glfw.wait_events_timeout
        with ThreadPoolExecutor(1, "fonts") as thread:  # fontconfig takes as long as GLFW
            fonts = thread.submit(theme.system_fonts)
            self.handle = create_window(null, hidden, size or remembered_size(self.state.preferences))
        self._is_open, self._full_screen = True, FullScreen(self.handle)
        position = remembered_position(self.state.preferences, screens(), glfw.get_window_size(self.handle))
        if position is not None:
            glfw.set_window_pos(self.handle, *position)
        if self.state.preferences.get("maximized", False):
            glfw.maximize_window(self.handle)
        moderngl.init_context()  # `create_context` asks GLX, if there is another context already
        self.ctx = moderngl.get_context()
        self._scene = Scene(self.ctx, glfw.get_proc_address)
        self.state.offscreen_renderer = OffscreenRenderer(self.ctx)
        self.state.thumbnails = Thumbnails(self.ctx)
        self._canvas = Canvas()
        self._set_callbacks()
        self._start_imgui(fonts.result())

    def _set_callbacks(self) -> None:
        """Let GLFW call the window. ImGui's callbacks, which are set later, call these first.

        They must not raise, because their exception would come out of `glfw.poll_events`; so they only queue.
        """
        glfw.set_key_callback(self.handle, on_key)
        self._drop_callback = glfw_window.set_drop_callback(self.handle, self.drop)
        glfw.set_window_refresh_callback(self.handle, lambda _: self._on_refresh())
        glfw.set_window_content_scale_callback(self.handle, lambda *_: self._apply_scale())
        glfw.set_window_close_callback(self.handle, lambda _: self.request_close())

    def _start_imgui(self, system_fonts: list[tuple[Path, int]]) -> None:
        imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")
        io.config_flags |= imgui.ConfigFlags_.nav_enable_keyboard
        theme.load_fonts(system_fonts)
        self._apply_scale()
        address = ctypes.cast(self.handle, ctypes.c_void_p).value
        assert address is not None
        imgui.backends.glfw_init_for_opengl(address, True)
        imgui.backends.opengl3_init("#version 330")
        self._cursors = glfw_window.MouseCursors(self.handle)

    def __enter__(self) -> "Window":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Write the preferences and free everything."""
        with self._open_lock:  # a thread that is done later must not call GLFW
            self._is_open = False
        self.remember()
        self.state.end_work()
        self.state.pose_exports.close()
        self.state.offscreen_renderer.release()
        self.state.thumbnails.release()
        self._scene.release()
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context()
        self.ctx.release()
        glfw.destroy_window(self.handle)
        glfw.terminate()

    # -- the loop --------------------------------------------------------------------------------------------

    def run(self, document: Document | None = None) -> None:
        """Show a document, and run the loop until the window is closed."""
        lost_display_handler = rescue_on_lost_display(partial(files.rescue, self.state))
        if document is not None:
            files.show_when_prepared(self.state, document)
        try:
            with TerminationSignals(self.wake) as signals:
                while not self.state.is_closing:
                    self.loop_once()
                    signals.check()
        except BaseException:
            files.rescue(self.state)
            raise
        if self.state.autosave is not None:
            self.state.autosave.close()
        self.state.pose_exports.finish(self.state.offscreen_renderer)
        del lost_display_handler  # it had to live until here

    def loop_once(self) -> None:
        """Sleep if no frame is due; then draw one if it is due now.

        An exception becomes a message. Several in a row are raised: then not even the message can be drawn.
        """
        try:
            self._sleep_or_draw()
        except Exception as error:
            self._failures_in_a_row += 1
            if self._failures_in_a_row >= MAX_FAILURES_IN_A_ROW:
                raise
            self.state.error = error_message(error)
            if imgui.get_current_context().within_frame_scope:
                imgui.end_frame()
            self._frames_due = SETTLE_FRAMES
        else:
            self._failures_in_a_row = 0

    def _sleep_or_draw(self) -> None:
        files.autosave(self.state)
        if self.needs_frame:
            glfw.poll_events()
        else:
            self.remember()
            self._wait_until_needed()
        if self._is_animated:
            self._frames_due = SETTLE_FRAMES
        if self.needs_frame and not self.frame():
            self.wait_for_events(MINIMIZED_SECONDS)

    @property
    def needs_frame(self) -> bool:
        """Whether a frame is due now. A frame that is due later comes with an event or a `wake`."""
        has_dropped_files = bool(self._dropped) and not self.state.is_waiting
        return self._frames_due > 0 or self._woken.is_set() or self.state.needs_frame or has_dropped_files

    @property
    def _is_animated(self) -> bool:
        """Whether the next frame differs from the last one without any event."""
        context = imgui.get_current_context()
        is_dimming = 0 < context.dim_bg_ratio < 1  # behind a dialog that has just opened or closed
        has_queued_events = context.input_events_queue.size() > 0  # ImGui takes some only one per frame
        return is_dimming or has_queued_events or self.state.needs_frame

    def wake(self) -> None:
        """Draw the next few frames; end the sleep of the loop. May be called from any thread."""
        self._woken.set()
        with self._open_lock:
            if self._is_open:
                glfw.post_empty_event()

    def remember(self) -> None:
        """Write the preferences if they have changed. The loop calls it before it sleeps."""
        glfw_window.remember_place(self.handle, self._full_screen, self.scale, self.state.preferences)
        self.state.save_preferences()

    def _wait_until_needed(self) -> None:
        """Sleep until an event, a `wake`, a due tooltip, a blink of a caret, or the answer of a dialog."""
        is_typing, tooltip_delay = imgui.get_io().want_text_input, widgets.tooltip_due()
        limit = tooltip_delay or (BLINK_SECONDS if is_typing else IDLE_SECONDS)
        dialog_delay = self.state.task.seconds_until_shown if self.state.task is not None else 0.0
        limit = min(limit, dialog_delay or limit, self.state.frame_delay)
        if self.state.part(FileDialog).native_is_open:
            limit = min(limit, NATIVE_DIALOG_SECONDS)
        has_happened = self._wait(limit)
        if has_happened or tooltip_delay or dialog_delay or self.state.part(FileDialog).native_is_answered:
            self._frames_due = SETTLE_FRAMES
        elif is_typing or self.state.frame_delay <= limit:
            self._frames_due = 1

    def _wait(self, limit: float) -> bool:
        """Sleep for ``limit`` seconds at most; whether an event or a `wake` ended the sleep."""
        start = time.perf_counter()
        self.wait_for_events(limit)
        return self._woken.is_set() or time.perf_counter() - start < 0.98 * limit

    def frame(self) -> bool:
        """Draw one frame; False if the window is minimized, or a frame is being drawn already."""
        if self._is_drawing:
            return False
        if self._woken.is_set():
            self._woken.clear()  # before the frame looks at any result: a later one causes another frame
            self._frames_due = SETTLE_FRAMES
        self._frames_due = max(self._frames_due - 1, 0)
        framebuffer = glfw.get_framebuffer_size(self.handle)
        if 0 in framebuffer or glfw.get_window_attrib(self.handle, glfw.ICONIFIED):
            self._has_focus = False  # so that a window that comes back looks for changed artwork
            return False
        self._is_drawing = True
        try:
            self._draw(framebuffer)
        finally:
            self._is_drawing = False
        return True

    def _draw(self, framebuffer: tuple[int, int]) -> None:
        """Draw the panels, then the scene under them, and run what waits for the end of the frame."""
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()
        recovery = imgui.internal.ErrorRecoveryState()
        imgui.internal.error_recovery_store_state(recovery)
        try:
            self._build_interface()
        except Exception as error:
            self._recover(recovery, error_message(error))
            if not isinstance(error, AkapError):  # a bug must not cost unsaved work
                self.state.editor.cancel()
        self._cursors.update()
        glfw_window.render_imgui()
        self._scene.draw(self.state, framebuffer, glfw.get_window_size(self.handle), self.scale)
        glfw_window.draw_imgui()
        self.frames += 1
        for action in self.after_draw:
            action()
        glfw.swap_buffers(self.handle)
        self._update_title()
        self._full_screen.set(self.state.is_full_screen)
        self._drops_input |= self.state.is_waiting
        if self.state.run_pending():
            self._frames_due = SETTLE_FRAMES

    def _build_interface(self) -> None:
        """Build ImGui's part of the frame, take in the input, and step the drawing."""
        state = self.state
        state.frame_delay, state.offscreen_renderer.is_smooth = math.inf, state.view.smooth_bends
        self._watch_focus()
        while self._dropped and not state.is_waiting:
            files.open_dropped(state, self._dropped.pop(0))
        handle_focus_keys(state)
        is_modal = widgets.popup_is_open()  # before, too: the key that closes a dialog must do nothing else
        state.editor.canvas = split_view.draw(state, frame.draw(state, self.scale), self.scale)
        if state.document is None:
            start_page.draw(state, self.scale, self._density)
        state.part(Palette).draw(state, self.scale)
        dialogs.draw(state, self.scale)
        self._canvas.draw_popup(state, self.scale)
        is_modal = is_modal or widgets.popup_is_open() or state.is_waiting or self._drops_input
        self._drops_input = self._drops_input and imgui.get_current_context().input_events_queue.size() > 0
        if not imgui.get_io().want_text_input and not is_modal:
            run_pressed(state)
        if is_modal or state.is_canvas_waiting:
            self._canvas.cancel_input(state)
        else:
            self._canvas.read_input(state)
            self._canvas.choose_cursor(state)
        may_step = state.editor.is_moving and state.engine.can_step
        if may_step and state.editor.advance():
            self._frames_due = SETTLE_FRAMES
        state.notice = state.timeline.follow() or state.notice
        if may_step:
            state.editor.start_next_step()
        draw_markers(state, self.scale)
        draw_legend(state.view, state.editor, self.scale)
        state.part(WaitingPlate).draw(state, self.scale)

    def _recover(self, recovery: Any, message: str) -> None:
        """Show an error message; repair ImGui's stacks, or else the next frame would fail."""
        io = imgui.get_io()
        io.config_error_recovery_enable_assert = False
        imgui.internal.error_recovery_try_to_recover_state(recovery)
        io.config_error_recovery_enable_assert = True
        self.state.error = message
        self._frames_due = SETTLE_FRAMES

    # -- the window ------------------------------------------------------------------------------------------

    @property
    def scale(self) -> float:
        """Points of the window per design point: 2 on a 200 % monitor, 1 on a Retina display."""
        if self._fixed_scale is not None:
            return self._fixed_scale
        return float(glfw.get_window_content_scale(self.handle)[0] / self._density) or 1.0

    @property
    def _density(self) -> float:
        """Pixels per point of the window: 2 on a Retina display, else 1."""
        points, pixels = glfw.get_window_size(self.handle)[0], glfw.get_framebuffer_size(self.handle)[0]
        return max(pixels, 1) / max(points, 1)

    def screenshot(self) -> NDArray[np.uint8]:
        """The frame that is being drawn, (h, w, 3). To be called from `after_draw`."""
        width, height = glfw.get_framebuffer_size(self.handle)
        data = self.ctx.screen.read(viewport=(0, 0, width, height), components=3, alignment=1)
        return np.frombuffer(data, dtype=np.uint8).reshape(height, width, 3)[::-1].copy()

    def _apply_scale(self) -> None:
        if imgui.get_current_context() is not None:
            theme.apply(self.scale)
            self.state.editor.ui_scale = self.scale
            self._frames_due = SETTLE_FRAMES

    def _update_title(self) -> None:
        if self._title != self.state.title:
            self._title = self.state.title
            glfw.set_window_title(self.handle, self._title)

    def _watch_focus(self) -> None:
        """Cancel a gesture if another window gets the keyboard; look for changed artwork on the return."""
        has_focus = bool(glfw.get_window_attrib(self.handle, glfw.FOCUSED))
        if self._has_focus != has_focus:
            (notice_changed_artwork if has_focus else self._canvas.cancel_input)(self.state)
        self._has_focus = has_focus

    def drop(self, paths: list[Path]) -> None:
        """Open files that were dropped on the window, in the next frame."""
        self._dropped.append(paths)
        self._woken.set()  # it may be the last frame that is due, and a dialog takes several to appear

    def request_close(self) -> None:
        """Close the window after the next frame; ask about unsaved changes first."""
        glfw.set_window_should_close(self.handle, False)
        self.state.run_after_frame(lambda: files.quit_program(self.state))

    def _on_refresh(self) -> None:
        """Draw at once: while the user resizes a window, some systems do not return to the loop."""
        self._frames_due = SETTLE_FRAMES
        self.frame()
