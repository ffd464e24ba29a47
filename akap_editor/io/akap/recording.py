"""Reads and writes .akaprec files, which hold a recorded session as text; see docs/file-format.md."""

import base64
from pathlib import Path
from typing import Any

from ...editor.document.document import new_document
from ...editor.document.drawing import Drawing, make_drawing
from ...editor.session.recording import Recording, mesh_digest, parse_recording
from ...errors import InputError, file_errors
from ...meshing.meshers import TRIANGLE, nearest_mesher
from ...resources import bundled_files
from ...words import mark, tr
from ..atomic import read_file, write_atomic
from ..images import read_image
from .project import decode_document, encode_document

RECORDING_SUFFIX = ".akaprec"


def read_recording(path: str | Path) -> Recording:
    """The recording in a file. Raises FileError with the number of the bad line."""
    data = read_file(path, mark("a recording"))
    with file_errors("open", path):
        return decode_recording(data)


def decode_recording(data: bytes) -> Recording:
    """The recording in the bytes of a file. Raises InputError, and nothing else."""
    try:
        return parse_recording(_decode_text(data))
    except UnicodeDecodeError as error:
        raise InputError(tr("expected a recording, which is text, got other bytes")) from error


def _decode_text(data: bytes) -> str:
    """Decode UTF-8; if the file was cut off inside a character, the text ends before it."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        if error.end < len(data) or error.start < data.rfind(b"\n"):
            raise
        return data[: error.start].decode("utf-8")


def write_recording(recording: Recording, path: str | Path, drawing: Drawing | None = None) -> None:
    """Write a recording, whole or not at all. Raises FileError if that is not possible.

    drawing: stored in the file as well, so that the recording can be replayed on another computer.
    """
    if drawing is not None:
        data = encode_document(new_document(drawing))
        header = {**recording.header, "akap": base64.b64encode(data).decode("ascii")}
        recording = Recording(header, recording.events)
    write_atomic(path, recording.to_text().encode("utf-8"))


def recorded_drawing(recording: Recording) -> Drawing:
    """The drawing of a recording: the one inside it, or the bundled one that it names.

    Raises InputError if there is neither, or if the one inside is damaged.
    """
    header = recording.header
    if "akap" in header:
        try:
            return decode_document(drawing_inside(header)).drawing
        except InputError as error:
            raise InputError(
                tr("recording line 1: the drawing inside is damaged, {error}", error=error)
            ) from error
    path = bundled_drawing(header)
    image, name = read_image(path), path.stem
    mesher = nearest_mesher(header.get("mesher", TRIANGLE))
    drawing = make_drawing(image, name=name, mesher=mesher)
    count = header.get("wanted", header.get("vertices"))
    if header.get("mesh") != mesh_digest(drawing.mesh) and type(count) is int:
        drawing = make_drawing(image, vertices=count, name=name, mesher=mesher)
    return drawing


def drawing_inside(header: dict[str, Any]) -> bytes:
    """The bytes of the .akap file in the header of a recording. Raises InputError if they are damaged."""
    try:
        return base64.b64decode(header["akap"], validate=True)
    except (TypeError, ValueError) as error:
        raise InputError(str(error)) from error


def bundled_drawing(header: dict[str, Any]) -> Path:
    """The path of the bundled drawing that the header of a recording names. Raises InputError."""
    bundled = {path.stem: path for path in bundled_files()}
    name = header.get("name")
    if name not in list(bundled):
        raise InputError(
            tr(
                "recording line 1: expected a drawing inside, or the name of a bundled one "
                "({names}), got {name!r}; name its file with --drawing",
                names=", ".join(bundled),
                name=name,
            )
        )
    return bundled[str(name)]
