"""Loose parts in .akap files: an entry with a byte for each face, and how they swing in document.json."""

import numpy as np

from ...editor.document.document import EditState
from ...editor.document.rig.loose_parts import LooseParts, make_loose_parts
from ...errors import InputError, error_context
from ...words import tr
from .archive import Archive, ArchiveEntry
from .json_records import Json, numbers, require

LOOSE_ENTRY = "loose"


def loose_entries(state: EditState) -> list[ArchiveEntry]:
    """The entry that marks the loose faces; none without any."""
    loose = state.loose
    return [] if loose is None else [(LOOSE_ENTRY, loose.faces.astype("u1").tobytes(), True)]


def describe_loose(state: EditState) -> Json:
    """How loose parts swing, for document.json; empty without any."""
    loose = state.loose
    return {} if loose is None else {"loose": {"speed": loose.speed, "bounce": loose.bounce}}


def read_loose(archive: Archive, record: Json, faces: int) -> LooseParts | None:
    """The loose parts of a file whose document.json is ``record``. Raises InputError."""
    if LOOSE_ENTRY not in archive:
        return None
    marks = archive.read_array(LOOSE_ENTRY, "u1", faces, 1)[:, 0]
    if marks.max(initial=0) > 1:
        raise InputError(tr("loose: expected a byte 0 or 1 for each face, got {value}", value=marks.max()))
    with error_context("document.json"):
        swing = require(record, "loose", dict)
        speed, bounce = (numbers([require_number(swing, name)], name)[0] for name in ("speed", "bounce"))
        return make_loose_parts(np.flatnonzero(marks), faces, float(speed), float(bounce))


def require_number(record: Json, name: str) -> object:
    """A value that must be there, whatever its type is. Raises InputError."""
    if name not in record:
        raise InputError(tr("expected {name}, got nothing", name=name))
    return record[name]
