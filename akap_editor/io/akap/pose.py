"""Reads and writes .pose.json files, which carry pins and pose to another session on the same drawing."""

import json
import reprlib
from dataclasses import dataclass
from pathlib import Path

from ...editor.document.document import Document, EditState
from ...editor.document.drawing import Drawing
from ...editor.document.pin import Pin
from ...editor.session.recording import drawing_header
from ...errors import InputError, file_errors
from ...geometry.validation import Floats, Ints
from ...words import mark, tr
from ..atomic import read_file, write_atomic
from .json_records import file_version, pairs, parse_record, program_name, refuse_newer, require
from .state_records import check_state, read_crossings, read_pins, write_crossings

POSE_SUFFIX = ".pose.json"
POSE_FORMAT = "akap-pose"
POSE_VERSION = 1
MAX_POSE_BYTES = 2**24  # enough for 400,000 vertices


@dataclass(frozen=True, eq=False)
class SavedPose:
    """Pins and pose of a file.

    positions: of the mesh's vertices, (n, 2) float64 pixels; crossings: see `EditState`.
    """

    pins: tuple[Pin, ...]
    positions: Floats
    crossings: Ints


def save_pose(document: Document, path: str | Path) -> None:
    """Write pins and pose of a document, whole or not at all.

    Raises FileError if the file cannot be written or could not be read again; then the old file stays.
    """
    with file_errors("save", path):
        data = encode_pose(document)
    write_atomic(path, data)


def load_pose(path: str | Path, drawing: Drawing) -> SavedPose:
    """The pose in a file, bit for bit as it was saved.

    Raises FileError, and nothing else, if the file is missing, damaged, malicious, of a newer version, or
    belongs to another mesh than that of ``drawing``.
    """
    data = read_file(path, mark("a pose"))
    with file_errors("open", path):
        return decode_pose(data, drawing)


def encode_pose(document: Document) -> bytes:
    """The bytes of a .pose.json file. Raises InputError if they could not be read again."""
    drawing, state = document.drawing, document.state
    check_state(state, len(drawing.mesh.vertices), len(drawing.mesh.faces))
    record = {
        "format": POSE_FORMAT,
        "version": POSE_VERSION,
        "program": program_name(),
        "drawing": drawing_header(drawing),
        "pins": [pin.to_json() for pin in state.pins],
        "positions": state.positions.tolist(),
        **write_crossings(state.crossings),
    }
    data = json.dumps(record, allow_nan=False, separators=(",", ":")).encode() + b"\n"
    _check_size(data)
    return data


def decode_pose(data: bytes, drawing: Drawing) -> SavedPose:
    """The pose in the bytes of a .pose.json file. Raises InputError, also for a pose of another mesh."""
    _check_size(data)
    record = parse_record(data)
    refuse_newer(file_version(record, POSE_FORMAT), POSE_VERSION)
    header, wanted = require(record, "drawing", dict), drawing_header(drawing)
    if require(header, "mesh", str) != wanted["mesh"]:
        name, count = require(header, "name", str), require(header, "vertices", int)
        raise InputError(
            tr(
                "expected a pose of this very mesh, with {vertices} vertices, got one of the drawing "
                "{name} with {count}",
                vertices=wanted["vertices"],
                name=reprlib.repr(name),
                count=count,
            )
        )
    vertices, faces = len(drawing.mesh.vertices), len(drawing.mesh.faces)
    positions = pairs(require(record, "positions", list), "positions")
    pins, crossings = read_pins(require(record, "pins", list)), read_crossings(record)
    state = EditState(pins, positions, crossings=crossings)
    check_state(state, vertices, faces)
    return SavedPose(state.pins, state.positions, state.crossings)


def _check_size(data: bytes) -> None:
    if len(data) > MAX_POSE_BYTES:
        raise InputError(
            tr("expected a pose of at most {most} bytes, got {count}", most=MAX_POSE_BYTES, count=len(data))
        )
