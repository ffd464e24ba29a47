"""Rescues unsaved work when the system ends the program: signals, and the loss of the display."""

import ctypes
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any

_LOST_DISPLAY = "akap-editor: the display is gone; unsaved work is kept for the next start"
_SIGNALS = ("SIGTERM", "SIGHUP")  # the second one is POSIX


class TerminationSignals:
    """While it is entered, SIGTERM and SIGHUP raise SystemExit in the main thread, also while that sleeps.

    Python runs a handler only between two of its own instructions, and the loop may sleep for minutes inside
    GLFW: so the system also writes to a socket, and a thread that reads from it calls ``wake``. An exception
    that is raised while GLFW calls Python back is lost: so the loop calls `check`, which raises it again.
    Does nothing outside the main thread, where Python accepts no handlers.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._is_active = threading.current_thread() is threading.main_thread()
        self._previous: dict[int, Any] = {}
        self._received: int | None = None

    def __enter__(self) -> "TerminationSignals":
        if not self._is_active:
            return self
        self._reader, self._writer = socket.socketpair()
        self._writer.setblocking(False)
        self._previous_descriptor = signal.set_wakeup_fd(self._writer.fileno(), warn_on_full_buffer=False)
        for name in _SIGNALS:
            number = getattr(signal, name, None)
            if number is not None:
                self._previous[number] = signal.signal(number, self._exit)
        threading.Thread(target=self._wake_on_signals, name="signals", daemon=True).start()
        return self

    def __exit__(self, *error: object) -> None:
        if not self._is_active:
            return
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._previous_descriptor)
        self._writer.close()  # which ends the thread

    def check(self) -> None:
        """Raise SystemExit if a signal has come."""
        if self._received is not None:
            raise SystemExit(128 + self._received)

    def _exit(self, number: int, _: FrameType | None) -> None:
        self._received = number
        self.check()

    def _wake_on_signals(self) -> None:
        with self._reader:
            while self._reader.recv(1):
                self._wake()


def rescue_on_lost_display(rescue: Callable[[], None]) -> Any:
    """Call ``rescue`` when the X server is gone, then end the process, as Xlib would anyway.

    Returns an object to keep as long as the window is open; None on systems without Xlib.
    """
    if sys.platform != "linux":
        return None
    try:
        xlib = ctypes.CDLL("libX11.so.6")
    except OSError:
        return None

    @ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
    def handle_lost_display(_: int) -> int:
        while True:
            try:
                print(_LOST_DISPLAY, file=sys.stderr, flush=True)
                rescue()
                os._exit(1)  # Xlib must not go on, and Python's own end would ask it to close the window
            except SystemExit:  # of a signal, which comes with the end of a desktop session
                continue

    xlib.XSetIOErrorHandler(handle_lost_display)
    return handle_lost_display
