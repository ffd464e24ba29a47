"""What other programs say to a window on an X server: a window manager, and one that gives a file."""

import time
from pathlib import Path

from Xlib import X
from Xlib.display import Display
from Xlib.protocol import event

DEADLINE = 30.0  # seconds
VERSION = 5  # of the XDND protocol


class Teller:
    """Connected to a display, to tell a window something. Use as a context manager."""

    def __init__(self, display: str, window: int) -> None:
        self._display = Display(display)
        self._window = self._display.create_resource_object("window", window)

    def __enter__(self) -> "Teller":
        return self

    def __exit__(self, *error: object) -> None:
        self._display.close()

    def tell(self, kind: str, *values: int) -> None:
        """Send a client message."""
        data = 32, [*values, 0, 0, 0, 0, 0][:5]
        message = event.ClientMessage(window=self._window, client_type=self.atom(kind), data=data)
        self._window.send_event(message)
        self._display.flush()

    def atom(self, name: str) -> int:
        """The number of a name."""
        number: int = self._display.intern_atom(name)
        return number

    def close(self) -> None:
        """As if the cross was clicked."""
        self.tell("WM_PROTOCOLS", self.atom("WM_DELETE_WINDOW"))
        self._display.sync()

    def drop(self, path: Path, at: tuple[int, int]) -> None:
        """Drag a file over the window and let it go at a place of the screen, by the XDND protocol."""
        source = self._display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        source.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)
        kind = self.atom("text/uri-list")
        self.tell("XdndEnter", source.id, VERSION << 24, kind)
        place, copy = at[0] << 16 | at[1], self.atom("XdndActionCopy")
        self.tell("XdndPosition", source.id, 0, place, X.CurrentTime, copy)
        answer = self._await(X.ClientMessage)
        assert answer.client_type == self.atom("XdndStatus")
        assert answer.data[1][1] & 1, "a file may be dropped here"
        self.tell("XdndDrop", source.id, 0, X.CurrentTime)
        asked = self._await(X.SelectionRequest)
        uris = f"{path.as_uri()}\r\n".encode()
        asked.requestor.change_property(asked.property, asked.target, 8, uris)
        names = ("requestor", "selection", "target", "property", "time")
        asked.requestor.send_event(event.SelectionNotify(**{name: getattr(asked, name) for name in names}))
        assert self._await(X.ClientMessage).client_type == self.atom("XdndFinished")

    def _await(self, kind: int) -> event.rq.Event:
        """The next event of a kind."""
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            while self._display.pending_events():
                found = self._display.next_event()
                if found.type == kind:
                    return found
            time.sleep(0.01)
        raise AssertionError(f"no event of kind {kind} within {DEADLINE:g} s")
