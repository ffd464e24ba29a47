"""Entries of document.json: how the mesh was made from the picture, and where the picture is."""

import os
import re
import reprlib
from pathlib import Path
from typing import Any

from ...editor.document.document import ArtworkFile
from ...editor.document.drawing import Drawing, Meshing
from ...errors import InputError
from ...geometry.validation import MAX_COORDINATE, as_number
from ...meshing.meshers import TRIANGLE, check_known
from ...meshing.slits import Cut, check_cuts
from ...resources import bundled_files
from ...words import tr
from ..atomic import resolved
from .json_records import Json, numbers, optional, require

MAX_DOCUMENT_VERTICES = 1_000_000
MAX_PATH_LENGTH = 1000  # characters


def check_meshing(meshing: Meshing) -> None:
    """Raise InputError if what is wanted of a mesh is out of range."""
    as_number(meshing.vertices, "vertices wanted", 0, MAX_DOCUMENT_VERTICES)
    as_number(meshing.expand, "expand", 0.0, MAX_COORDINATE)
    as_number(meshing.threshold, "threshold", 0.0, 1.0)
    if meshing.background is not None:
        as_number(meshing.background, "background", 0.0, 1.0)


def describe_meshing(drawing: Drawing) -> Json:
    """How the mesh was made; the tolerance of a removed background only with the original picture."""
    meshing = drawing.meshing
    assert meshing is not None
    is_background_removed = meshing.background is not None and drawing.original is not None
    return {
        "vertices": int(meshing.vertices),
        "expand": float(meshing.expand),
        "threshold": float(meshing.threshold),
        "mesher": meshing.mesher,
        **({"background": float(meshing.background or 0.0)} if is_background_removed else {}),
        **({"cuts": [list(map(list, cut)) for cut in meshing.cuts]} if meshing.cuts else {}),
    }


def read_meshing(record: Json) -> Meshing:
    """What `describe_meshing` wrote. Raises InputError on other values."""
    expand, threshold = numbers([record.get("expand"), record.get("threshold")], "expand and threshold")
    background = numbers([record["background"]], "background")[0] if "background" in record else None
    vertices = require(record, "vertices", int)
    meshing = Meshing(
        vertices,
        float(expand),
        float(threshold),
        None if background is None else float(background),
        check_known(record.get("mesher", TRIANGLE)),
        _read_cuts(optional(record, "cuts", list, [])),
    )
    check_meshing(meshing)
    return meshing


def _read_cuts(records: list[Any]) -> tuple[Cut, ...]:
    """The strokes of the knife. Raises InputError on values of other kinds."""
    for record in records:
        if type(record) is not list or any(type(point) is not list or len(point) != 2 for point in record):
            raise InputError(tr("cuts: expected lists of points, got {value}", value=reprlib.repr(record)))
    return check_cuts([[numbers(point, "cuts").tolist() for point in record] for record in records])


def describe_source(artwork: ArtworkFile | None, folder: Path | None) -> Json:
    """The entry of document.json for the artwork of a drawing whose file is in ``folder``.

    Empty if either is not known, and for bundled drawings.
    """
    if artwork is None or folder is None or artwork.path in map(resolved, bundled_files()):
        return {}
    path = _relative(artwork.path, resolved(folder))
    if not _is_storable(path):
        return {}
    return {"source": {"path": path, **({"digest": artwork.digest} if artwork.digest else {})}}


def read_source(record: Json, folder: Path) -> ArtworkFile | None:
    """What `describe_source` wrote, None if absent; paths begin at ``folder``. Raises InputError."""
    if "source" not in record:
        return None
    source = require(record, "source", dict)
    path, digest = require(source, "path", str), optional(source, "digest", str, "")
    if not _is_storable(path):
        raise InputError(tr("source: expected a relative path, got {value}", value=reprlib.repr(path)))
    if not re.fullmatch(r"([0-9a-f]{64})?", digest):
        value = reprlib.repr(digest)
        raise InputError(tr("source: expected a digest of 64 hexadecimal digits, got {value}", value=value))
    return ArtworkFile(Path(os.path.normpath(folder / path)), digest)


def _relative(path: Path, folder: Path) -> str:
    """The path from a folder, with slashes; the name alone on another drive.

    The same where only the path, and not the folder, leads through the user's own folder, whose name it
    would tell.
    """
    home = Path(os.path.expanduser("~"))
    if path.is_relative_to(home) and not folder.is_relative_to(home):
        return path.name
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:  # on Windows, another drive
        return path.name


def _is_storable(path: str) -> bool:
    """Whether a document may refer to a path: relative, without a server, a drive or a stream of Windows."""
    parts = path.split("/")
    while len(parts) > 1 and parts[0] == "..":
        parts.pop(0)
    is_plain = path.isprintable() and not re.search(r"[\\:]", path)
    return is_plain and len(path) <= MAX_PATH_LENGTH and not {"", ".", ".."} & set(parts)
