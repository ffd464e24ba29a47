"""An X server of our own, never the user's screen, with or without a window manager."""

import os
import shlex
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from Xlib import X
from Xlib.display import Display

from tests.support.running_program import DEADLINE, PAUSE, SIZE

MANAGER_VARIABLE = "AKAP_TEST_WINDOW_MANAGER"  # environment variable: a command
FRAME = 160  # pixels that the screen of a window manager is larger than the window


@dataclass(frozen=True)
class XServer:
    """A running X server: its process and the name of its display."""

    process: subprocess.Popen[bytes]
    display: str


@contextmanager
def x_server() -> Iterator[XServer]:
    """Start Xvfb, and a window manager if `MANAGER_VARIABLE` names one; end them afterwards."""
    for tool in ("Xvfb", "xdotool"):
        assert shutil.which(tool), f"{tool} is missing: install the packages xvfb and xdotool"
    manager = shlex.split(os.environ.get(MANAGER_VARIABLE, ""))
    width, height = np.add(SIZE, FRAME if manager else 0)  # a managed window has a frame
    read, write = os.pipe()
    command = [
        "Xvfb",
        "-displayfd",
        str(write),
        "-screen",
        "0",
        f"{width}x{height}x24",
        "-nolisten",
        "tcp",
        "-noreset",
    ]
    processes = [subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)]
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    try:
        if manager:
            processes.append(_start_manager(manager, f":{number}"))
        yield XServer(processes[0], f":{number}")
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait(DEADLINE)


def _start_manager(command: list[str], display: str) -> subprocess.Popen[bytes]:
    """Start a window manager and wait until it manages the display."""
    connection = Display(display)
    is_managed = connection.intern_atom("_NET_SUPPORTING_WM_CHECK")
    root = connection.screen().root
    environment = {**os.environ, "DISPLAY": display}
    manager = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + DEADLINE
    while root.get_full_property(is_managed, X.AnyPropertyType) is None:
        assert manager.poll() is None, f"{command[0]} has ended with {manager.returncode}"
        assert time.monotonic() < deadline, f"{command[0]} does not manage the display"
        time.sleep(PAUSE)
    connection.close()
    return manager
