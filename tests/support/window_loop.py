"""Runs the window's own loop on a clock of the test, so that no test sleeps."""

from collections.abc import Callable
from types import SimpleNamespace

import glfw
import pytest

from akap_editor.app import window as window_module
from tests.support.window_driver import DEADLINE, WindowDriver


class WindowLoop:
    """Counts the sleeps of a window's loop; a sleep takes no time, only the clock of the test advances.

    While a thread computes, the window really waits for it, and that is not counted; the test fails if
    nothing wakes the window. With `waits_for_threads` False such a wait is a sleep like any other.

    sleeps: of each, its limit in seconds and the number of frames drawn before it; on_sleep: called with the
    number of sleeps, returns whether an event ends this one; on_poll: called with the number of polls.
    """

    def __init__(self, ui: WindowDriver, patch: pytest.MonkeyPatch) -> None:
        self.ui, self.now = ui, 0.0
        self.sleeps: list[tuple[float, int]] = []
        self.waits_for_threads = True
        self.on_sleep: Callable[[int], bool] = lambda count: False
        self.on_poll: Callable[[int], None] = lambda count: None
        self._polls, self._first_frame, self._most_sleeps = 0, 0, 0
        self._wait_for_wake = ui.window.wait_for_events
        patch.setattr(ui.window, "wait_for_events", self._sleep)
        patch.setattr(
            ui.state.engine, "start", lambda wake: None
        )  # it is loaded, and steps may start at once
        patch.setattr(glfw, "poll_events", self._poll)
        patch.setattr(window_module, "time", SimpleNamespace(perf_counter=lambda: self.now))

    def run(self, sleeps: int = 3) -> list[tuple[float, int]]:
        """Run the window until its loop has slept so often; returns the sleeps."""
        self.sleeps, self._most_sleeps, self._first_frame = [], sleeps, self.ui.window.frames
        self.ui.window.wake()
        self.ui.window.run()
        self.ui.state.is_closing = False
        return self.sleeps

    def _sleep(self, seconds: float) -> None:
        if self.waits_for_threads and self.ui.state.is_busy:
            self._wait_for_wake(DEADLINE)
            assert self.ui.window.needs_frame, f"nothing has woken the window within {DEADLINE:g} s"
            return
        self.sleeps.append((seconds, self.ui.window.frames - self._first_frame))
        if len(self.sleeps) == self._most_sleeps:
            self.ui.state.is_closing = True
        is_ended_by_event = self.on_sleep(len(self.sleeps))
        self.now += 0.1 * seconds if is_ended_by_event else seconds

    def _poll(self) -> None:
        self._polls += 1
        self.on_poll(self._polls)
