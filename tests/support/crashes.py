"""Saves that are stopped, run by test_atomic_crashes.py in a process of its own, because it forks and kills.

Each case saves a new version of the file named on the command line over an old one and is stopped at its n-th
chance, for n = 1, 2, ... until it gets through. Each time the file must hold one of the two versions, whole.
Prints how often each case was stopped before, and how often after the new file was in place.
"""

import json
import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from akap_editor.errors import InputError
from akap_editor.io import atomic
from akap_editor.io.akap.project import encode_document, load, save

NOBODY = 65534
REFUSED, BROKEN = 1, 2
PIECES = 8


class Piecewise:
    """A file that is written in pieces, so that there are moments between them."""

    def __init__(self, path: Path, mode: str) -> None:
        self.file = open(path, mode, buffering=0)  # noqa: SIM115

    def __enter__(self) -> "Piecewise":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def write(self, data: bytes) -> None:
        size = len(data) // PIECES + 1
        for start in range(0, len(data), size):
            self.file.write(data[start : start + size])

    def flush(self) -> None:
        self.file.flush()

    def fileno(self) -> int:
        return self.file.fileno()


def kill_at(chance: int) -> None:
    """SIGKILL to this process at its n-th line of the code that writes files."""
    atomic.open_new = lambda path, _: Piecewise(path, "xb")
    left = chance
    code = {atomic.__file__, __file__}

    def trace(frame, event, _):
        nonlocal left
        if frame.f_code.co_filename not in code:
            return None
        if event == "line":
            left -= 1
            if left == 0:
                os.kill(os.getpid(), signal.SIGKILL)
        return trace

    sys.settrace(trace)


def limit_size(chance: int) -> None:
    """No file can grow beyond n pieces: the system's own refusal, as of a full disk."""
    size = len(encode_document(new))
    resource.setrlimit(resource.RLIMIT_FSIZE, (chance * size // PIECES, resource.RLIM_INFINITY))


def no_folder(_: int) -> None:
    """The folder may no longer be written to."""
    path.parent.chmod(0o555)
    become_nobody()


def no_file(_: int) -> None:
    """The file may no longer be written to."""
    path.parent.chmod(0o777)
    path.chmod(0o444)
    become_nobody()


def become_nobody() -> None:
    if os.getuid() == 0:  # to whom permissions mean nothing
        os.setgroups([])
        os.setgid(NOBODY)
        os.setuid(NOBODY)


def save_is_stopped(prepare: Callable[[int], None], chance: int) -> bool:
    """Save in a child process; whether it was stopped or refused."""
    child = os.fork()
    if child == 0:
        code = BROKEN
        try:
            prepare(chance)
            save(new, path)
            code = 0
        except InputError:
            code = REFUSED
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    status = os.waitpid(child, 0)[1]
    assert not os.WIFEXITED(status) or os.WEXITSTATUS(status) != BROKEN
    return status != 0


def save_until_killed() -> int:
    """Save one version after the other until a signal comes from outside; how often that came too soon."""
    versions = [old, new]
    for wait in range(40):
        child = os.fork()
        if child == 0:
            while True:
                versions.reverse()
                save(versions[0], path)
        time.sleep(0.001 * wait)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        assert path.read_bytes() in (old_bytes, new_bytes)
    return len(list(path.parent.glob(".akap-*.tmp")))


def run(prepare: Callable[[int], None], most: int) -> dict[str, int]:
    counts = {"before": 0, "after": 0, "done": 0, "left": 0}
    for chance in range(1, most + 1):
        path.parent.chmod(0o777)
        path.unlink(missing_ok=True)
        path.write_bytes(old_bytes)
        path.chmod(0o666)
        was_stopped = save_is_stopped(prepare, chance)
        path.parent.chmod(0o777)
        found = path.read_bytes()
        assert found in (old_bytes, new_bytes), f"{prepare.__name__} {chance}: {len(found)} bytes"
        load(path)
        for temporary in path.parent.glob(".akap-*.tmp"):
            temporary.unlink()
            counts["left"] += 1
        if not was_stopped:
            assert found == new_bytes
            counts["done"] += 1
            break
        counts["before" if found == old_bytes else "after"] += 1
    return counts


path = Path(sys.argv[1])
old = load(path)
old_bytes = path.read_bytes()
new = old.with_state(replace(old.state, positions=old.state.positions + 1))
new_bytes = encode_document(new)
cases = {kill_at: 1000, limit_size: 1000, no_folder: 1, no_file: 1}
counts = {case.__name__: run(case, most) for case, most in cases.items()}
print(json.dumps({**counts, "left": save_until_killed()}))
