"""Signals that end the program: raised at once, and again if the exception was lost."""

import ctypes
import os
import signal

import pytest

from akap_editor.app.termination import TerminationSignals, rescue_on_lost_display

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")


def do_nothing():
    """Wakes nothing."""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_the_program_with_the_code_of_shells(number):
    before = signal.getsignal(number)
    with TerminationSignals(do_nothing) as signals:
        signals.check()
        with pytest.raises(SystemExit) as caught:
            os.kill(os.getpid(), number)
    assert caught.value.code == 128 + number
    assert signal.getsignal(number) is before


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_signal_that_comes_while_a_library_calls_back_is_not_lost():
    """As GLFW does when the window is to be drawn again: ctypes drops the exceptions of such calls."""
    callback = ctypes.CFUNCTYPE(None)(lambda: os.kill(os.getpid(), signal.SIGTERM))
    with TerminationSignals(do_nothing) as signals:
        callback()
        with pytest.raises(SystemExit):
            signals.check()


def test_work_is_rescued_also_if_a_signal_comes_with_the_loss_of_the_display(monkeypatch, capsys):
    rescued = []

    def rescue():
        rescued.append(len(rescued))
        if len(rescued) == 1:
            raise SystemExit(143)

    class EndedError(BaseException):
        """Takes the place of the end of the process."""

    def end(code):
        raise EndedError(code)

    monkeypatch.setattr(os, "_exit", end)
    handlers = []
    xlib = type("Xlib", (), {"XSetIOErrorHandler": staticmethod(handlers.append)})
    monkeypatch.setattr(ctypes, "CDLL", lambda _: xlib)
    monkeypatch.setattr(ctypes, "CFUNCTYPE", lambda *_: lambda function: function)
    monkeypatch.setattr("sys.platform", "linux")
    handler = rescue_on_lost_display(rescue)
    assert handlers == [handler]
    with pytest.raises(EndedError):
        handler(0)
    assert rescued == [0, 1]
    assert "unsaved work is kept" in capsys.readouterr().err
