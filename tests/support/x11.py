"""`X11Client`: sends a window the messages of a window manager and of a program that drops a file."""

import select
import time
from pathlib import Path

from Xlib import X
from Xlib.display import Display
from Xlib.protocol import event

DEADLINE = 30.0  # seconds
XDND_VERSION = 5


class X11Client:
    """A connection to a display, for messages to one of its windows. Use as a context manager."""

    def __init__(self, display: str, window: int) -> None:
        self._display = Display(display)
        self._window = self._display.create_resource_object("window", window)

    def __enter__(self) -> "X11Client":
        return self

    def __exit__(self, *error: object) -> None:
        self._display.close()

    def send(self, kind: str, *values: int) -> None:
        """Send a client message."""
        data = 32, [*values, 0, 0, 0, 0, 0][:5]
        message = event.ClientMessage(window=self._window, client_type=self.atom(kind), data=data)
        self._window.send_event(message)
        self._display.flush()

    def atom(self, name: str) -> int:
        """The number of an atom, which may be new."""
        number: int = self._display.intern_atom(name)
        return number

    def close(self) -> None:
        """Ask the window to close, as its close button does."""
        self.send("WM_PROTOCOLS", self.atom("WM_DELETE_WINDOW"))
        self._display.sync()

    def drop(self, path: Path, at: tuple[int, int]) -> None:
        """Drag a file over the window and drop it at a point of the screen, by the XDND protocol."""
        source = self._display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        source.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)
        kind = self.atom("text/uri-list")
        self.send("XdndEnter", source.id, XDND_VERSION << 24, kind)
        point, copy = at[0] << 16 | at[1], self.atom("XdndActionCopy")
        self.send("XdndPosition", source.id, 0, point, X.CurrentTime, copy)
        answer = self._await(X.ClientMessage)
        assert answer.client_type == self.atom("XdndStatus")
        assert answer.data[1][1] & 1, "the window refused the drop"
        self.send("XdndDrop", source.id, 0, X.CurrentTime)
        request = self._await(X.SelectionRequest)
        uris = f"{path.as_uri()}\r\n".encode()
        request.requestor.change_property(request.property, request.target, 8, uris)
        names = ("requestor", "selection", "target", "property", "time")
        request.requestor.send_event(
            event.SelectionNotify(**{name: getattr(request, name) for name in names})
        )
        assert self._await(X.ClientMessage).client_type == self.atom("XdndFinished")

    def _await(self, kind: int) -> event.rq.Event:
        """Wait for the next event of a kind; AssertionError after `DEADLINE`."""
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            while self._display.pending_events():
                received = self._display.next_event()
                if received.type == kind:
                    return received
            select.select([self._display], [], [], max(deadline - time.monotonic(), 0.0))
        raise AssertionError(f"no event of kind {kind} within {DEADLINE:g} s")
