"""Runs Triangle in a process of its own, because bad input can crash it or make it loop forever.

`triangulate` starts this file as a script. It reads jobs from stdin and answers on stdout; each message is an
.npz archive after its length in eight bytes. It imports nothing of the package, so that it starts fast.
"""

import io
import os
import struct
import sys
from typing import BinaryIO

import numpy as np


def read_message(stream: BinaryIO) -> dict[str, np.ndarray] | None:
    """Read the next message; None at the end of the stream."""
    head = stream.read(8)
    if len(head) < 8:
        return None
    (length,) = struct.unpack("<Q", head)
    body = stream.read(length)
    if len(body) < length:
        return None
    with np.load(io.BytesIO(body), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def write_message(stream: BinaryIO, **arrays: np.ndarray) -> None:
    """Write named arrays as one message."""
    body = io.BytesIO()
    np.savez(body, **arrays)  # type: ignore[arg-type]
    stream.write(struct.pack("<Q", body.tell()) + body.getvalue())
    stream.flush()


def main() -> None:
    """Answer jobs until stdin closes."""
    import triangle

    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what Triangle prints must not mix with the answers
    while (job := read_message(sys.stdin.buffer)) is not None:
        switches = str(job.pop("switches"))
        if not len(job["holes"]):
            del job["holes"]
        result = triangle.triangulate(job, switches)
        write_message(
            answers,
            vertices=np.asarray(result["vertices"], dtype=np.float64).reshape(-1, 2),
            triangles=np.asarray(result.get("triangles", []), dtype=np.int32).reshape(-1, 3),
        )


if __name__ == "__main__":
    main()
