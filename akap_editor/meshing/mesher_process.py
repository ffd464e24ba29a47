"""The child process that runs the meshers, see `mesher_worker`."""

import atexit
import contextlib
import io
import subprocess
import sys
import threading
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..errors import InputError
from ..geometry.validation import Floats, Ints
from ..words import mark, tr
from .mesher_worker import read_message, write_message
from .meshers import MESHERS

TIME_LIMIT = 30.0  # seconds for one run of a mesher
WORKER_COMMAND = "mesher-worker"  # hidden command of a bundle, which has no Python to run scripts with


class Refinement(NamedTuple):
    """How a mesher refines a mesh.

    mesher: its name in `MESHERS`; min_angle: of the faces, in degrees; max_area: of a face, in square pixels;
    most: number of vertices above which PythonCDT removes vertices that it inserted, as angles allow.
    """

    mesher: str
    min_angle: float
    max_area: float
    most: int = 2**31


class MesherProcess:
    """A child process for meshers; a job that crashes or hangs ends only the child.

    It stays alive between jobs, because its start takes longer than most of them. May be used by several
    threads: jobs run one after the other.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.RLock()

    def start(self) -> subprocess.Popen[bytes]:
        """Start the child unless it is running, and return it without waiting until it is ready."""
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                is_bundle = getattr(sys, "frozen", False)
                worker = WORKER_COMMAND if is_bundle else str(Path(__file__).with_name("mesher_worker.py"))
                self._process = subprocess.Popen(
                    [sys.executable, worker],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                    creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),  # no console on Windows
                )
            return self._process

    def run(
        self, graph: dict[str, np.ndarray], refinement: Refinement, limit: float = TIME_LIMIT
    ) -> tuple[Floats, Ints]:
        """Triangulate a planar graph: vertices (n, 2) and faces (m, 3).

        graph: "vertices" (p, 2), "segments" (s, 2) indices, "holes" (h, 2), a point in each; optionally
        "slits" (s,), which segments lie inside, with faces on both sides.
        Raises InputError if the mesher crashes, needs more than ``limit`` seconds, or finds no faces.
        """
        if not np.isfinite(graph["vertices"]).all():
            raise InputError(tr("outlines: expected finite coordinates"))
        job = {name: np.array(value) for name, value in refinement._asdict().items()}
        title = MESHERS[refinement.mesher]
        answer = self._exchange({**graph, **job}, title, limit)
        if not len(answer["triangles"]) or not np.isfinite(answer["vertices"]).all():
            raise InputError(tr("the outline cannot be triangulated: {title} returned no faces", title=title))
        return answer["vertices"], answer["triangles"]

    def _exchange(self, job: dict[str, np.ndarray], title: str, limit: float) -> dict[str, np.ndarray]:
        """Send a job and wait for the answer."""
        with self._lock:
            process = self.start()
            assert isinstance(process.stdin, io.BufferedWriter)
            assert isinstance(process.stdout, io.BufferedReader)
            timed_out = threading.Event()

            def kill() -> None:
                timed_out.set()
                process.kill()

            timer = threading.Timer(limit, kill)
            timer.start()
            try:
                write_message(process.stdin, **job)
                answer = read_message(process.stdout)
            except OSError:
                answer = None
            finally:
                timer.cancel()
            if answer is None:
                self.close()
                if timed_out.is_set():
                    reason = mark("the outline cannot be triangulated: {title} took longer than {limit:g} s")
                else:
                    reason = mark("the outline cannot be triangulated: {title} stopped without an answer")
                raise InputError(tr(reason, title=title, limit=limit))
            return answer

    def close(self) -> None:
        """End the child, if it is running."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    with contextlib.suppress(OSError):  # flushing what a dead child has not read
                        pipe.close()


MESHER_PROCESS = MesherProcess()  # of the program
atexit.register(MESHER_PROCESS.close)
