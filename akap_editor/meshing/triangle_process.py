"""The child process that runs Triangle, see `triangle_worker`."""

import atexit
import contextlib
import io
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..geometry.validation import Floats, Ints
from .triangle_worker import read_message, write_message

TIME_LIMIT = 30.0  # seconds for one run of Triangle


class TriangleProcess:
    """A child process for Triangle; a job that crashes or hangs ends only the child.

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
                script = Path(__file__).with_name("triangle_worker.py")
                self._process = subprocess.Popen(
                    [sys.executable, str(script)],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                )
            return self._process

    def run(
        self, graph: dict[str, np.ndarray], switches: str, limit: float = TIME_LIMIT
    ) -> tuple[Floats, Ints]:
        """Triangulate a planar graph: vertices (n, 2) and faces (m, 3).

        graph: "vertices" (p, 2), "segments" (s, 2) indices, "holes" (h, 2), a point in each; switches: of
        Triangle's command line. Raises InputError if Triangle crashes, needs more than ``limit`` seconds, or
        finds no faces.
        """
        if not np.isfinite(graph["vertices"]).all():
            raise InputError("outlines: expected finite coordinates")
        answer = self._exchange({**graph, "switches": np.array(switches)}, limit)
        if not len(answer["triangles"]) or not np.isfinite(answer["vertices"]).all():
            raise InputError("the outline cannot be triangulated: Triangle returned no faces")
        return answer["vertices"], answer["triangles"]

    def _exchange(self, job: dict[str, np.ndarray], limit: float) -> dict[str, np.ndarray]:
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
                reason = (
                    f"took longer than {limit:g} s" if timed_out.is_set() else "stopped without an answer"
                )
                raise InputError(f"the outline cannot be triangulated: Triangle {reason}")
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


TRIANGLE = TriangleProcess()  # of the program
atexit.register(TRIANGLE.close)
