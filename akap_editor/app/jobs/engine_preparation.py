"""Loads the engine's machine code beside the window. At the first start, child processes compile it.

Compilation takes many seconds and holds Python's lock, so that in a thread it would stop the window.
"""

import gc
import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread

from ...deform import precompile as solver
from ...geometry.jit import NotCompiledError, keeps_machine_code, only_compiled, yielding_lock
from ...overlap import precompile as overlaps
from ...progress import announce
from ...words import mark, tr
from .background_thread import Wake, no_window

COMMAND = "compile-engine"  # hidden command of a bundle, which has no Python to run modules with
TEXT = mark("Preparing the engine, only at the first start")

_NICENESS = 5  # that child processes add with each stage: the window goes first, then the stages before
_USUAL_SECONDS = 15.0  # that all takes on a slow machine, for the progress bar
_WAIT_SECONDS = 0.25  # between two looks whether an opening that waits was cancelled; each draws frames


Stage = Callable[[], None]
Child = subprocess.Popen[bytes]


def _nothing() -> None:
    pass


# What each child process compiles: what opening a drawing needs, what most steps need, and the rest.
PARTS: dict[str, tuple[Stage, Stage, Stage]] = {
    "mesh": (solver.precompile_new_mesh, solver.precompile_loops, solver.precompile_exact_steps),
    "factors": (_nothing, solver.precompile_factors, _nothing),
    "overlaps": (overlaps.precompile_rest, overlaps.precompile_crossings, overlaps.precompile),
}


def compile_part(name: str) -> None:
    """Compile one of the `PARTS` into the cache on disk; writes a line to stdout after each stage."""
    gc.disable()  # it would take a tenth of the time, and the process ends soon
    for stage in PARTS[name]:
        if hasattr(os, "nice"):
            os.nice(_NICENESS)
        stage()
        print(flush=True)


def start_child(part: str) -> Child:
    """Start the child process that compiles one of the `PARTS`."""
    command = [COMMAND] if getattr(sys, "frozen", False) else ["-m", __spec__.name]
    root = str(Path(__file__).resolve().parents[3])  # of this package, which may not be installed
    paths = [root, *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(
        [sys.executable, *command, part],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)},
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),  # no console on Windows
    )


class _ClosedError(Exception):
    """The window was closed before the engine was prepared."""


class EnginePreparation:
    """Whether the engine's machine code is there: until `start` is called, it counts as prepared.

    As a context manager it starts, and ends its child processes at the exit.

    parts: the stages of each child process; start_child: starts the process of a part; wake: is called in
    a thread when steps may start that had to wait, the window sets it.
    """

    def __init__(
        self,
        parts: dict[str, tuple[Stage, Stage, Stage]] = PARTS,
        start_child: Callable[[str], Child] = start_child,
    ) -> None:
        self._parts, self._start_child = parts, start_child
        self._is_known, self._can_open, self._can_step = Event(), Event(), Event()
        for event in self._events:
            event.set()
        self._is_awaited = self._is_closed = False
        self.wake: Wake = no_window
        self._children: list[Child] = []
        self._started = 0.0

    def __enter__(self) -> "EnginePreparation":
        self.start()
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    @property
    def _events(self) -> tuple[Event, ...]:
        return self._is_known, self._can_open, self._can_step

    @property
    def can_step(self) -> bool:
        """Whether steps may start: most compile nothing. If not, the window is woken when they may."""
        self._is_awaited = True  # before the look, so that no wake is missed
        self._is_awaited = not self._can_step.is_set()
        return not self._is_awaited

    @property
    def can_open(self) -> bool:
        """Whether drawings may be opened. Waits until it is known whether the engine has to be compiled."""
        self._is_known.wait()
        return self._can_open.is_set()

    def start(self) -> None:
        """Begin to load or compile in a thread."""
        for event in self._events:
            event.clear()
        self._started = time.perf_counter()
        Thread(target=self._prepare, name="preparation", daemon=True).start()

    def wait_to_open(self, and_to_step: bool = False) -> None:
        """Wait, in a thread of a task, until drawings can be opened, or until steps can start, too."""
        event = self._can_step if and_to_step else self._can_open
        while not event.wait(_WAIT_SECONDS):
            elapsed = time.perf_counter() - self._started
            announce(min(elapsed / _USUAL_SECONDS, 1.0), tr(TEXT))

    def close(self) -> None:
        """End the child processes."""
        self._is_closed = True
        for child in self._children:
            child.terminate()

    def _prepare(self) -> None:
        try:
            with yielding_lock(), suppress(_ClosedError):
                self._load_or_compile()
        finally:
            self._reach(*self._events)

    def _load_or_compile(self) -> None:
        try:
            with only_compiled():
                self._load()
        except NotCompiledError:
            self._is_known.set()
            self._compile()

    def _load(self, wait: Callable[[], object] = lambda: None) -> None:
        """Call all that is compiled, by stages. wait: called before each."""
        wait()
        for part in self._parts.values():
            part[0]()
        self._reach(self._can_open, self._is_known)
        wait()
        for part in self._parts.values():
            part[1]()
        self._reach(self._can_step)
        wait()
        for part in self._parts.values():
            part[2]()

    def _reach(self, *events: Event) -> None:
        for event in events:
            event.set()
        if self._is_awaited and self._can_step.is_set():
            self.wake()

    def _compile(self) -> None:
        """Let child processes compile each stage before it is loaded; or compile in this thread."""
        if keeps_machine_code():
            self._children = [self._start_child(name) for name in self._parts]

        def wait() -> None:
            for child in self._children:
                assert child.stdout is not None
                child.stdout.readline()
            if self._is_closed:
                self.close()
                raise _ClosedError

        self._load(wait)
        for child in self._children:
            child.communicate()


if __name__ == "__main__":
    compile_part(sys.argv[1])
