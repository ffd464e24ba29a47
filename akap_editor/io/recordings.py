"""The .akaprec file: a recorded session as text, described in docs/file-format.md."""

from pathlib import Path

from ..editor.recording import Recording, parse_recording
from ..errors import InputError
from .atomic import read_file, write_atomic


def read_recording(path: str | Path) -> Recording:
    """The recording in a file. Raises InputError with the file's name and the number of the bad line."""
    data = read_file(path, "a recording")
    try:
        return parse_recording(data.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: expected a recording, which is text, got other bytes") from error
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def write_recording(recording: Recording, path: str | Path) -> None:
    """Write a recording, whole or not at all. Raises InputError where that is not possible."""
    write_atomic(path, recording.to_text().encode("utf-8"))
