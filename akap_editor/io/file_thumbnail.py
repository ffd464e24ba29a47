"""Makes the thumbnails of drawings and recordings that file managers show."""

from pathlib import Path

import numpy as np
from PIL import Image

from ..errors import InputError, file_errors
from ..words import tr
from .akap.archive import Archive
from .akap.layer_entries import MAX_PICTURE_BYTES
from .akap.project import PROJECT_SUFFIX, THUMBNAIL_ENTRY
from .akap.recording import RECORDING_SUFFIX, bundled_drawing, decode_recording, drawing_inside
from .atomic import read_file
from .images import Picture, decode_image


def make_thumbnail(path: Path, side: int) -> Picture:
    """A picture (h, w, 4) of a drawing or recording, at most ``side`` pixels high and wide.

    Of a recording it shows the drawing. Raises InputError if the file is damaged or of another kind.
    """
    data = read_file(path, "a drawing or recording")
    with file_errors("open", path):
        match path.suffix.lower():
            case str(suffix) if suffix == PROJECT_SUFFIX:
                image = _thumbnail_inside(data)
            case str(suffix) if suffix == RECORDING_SUFFIX:
                image = _drawing_of_recording(data)
            case suffix:
                raise InputError(
                    tr("expected a drawing or recording, got {suffix}", suffix=suffix or tr("no ending"))
                )
    picture = Image.fromarray(image)
    picture.thumbnail((side, side))
    return np.asarray(picture)


def _thumbnail_inside(data: bytes) -> Picture:
    """The thumbnail that every .akap file contains. Raises InputError."""
    return decode_image(Archive(data).read(THUMBNAIL_ENTRY, MAX_PICTURE_BYTES), ("PNG",))


def _drawing_of_recording(data: bytes) -> Picture:
    """The picture of the drawing that a recording contains or names. Raises InputError."""
    header = decode_recording(data.partition(b"\n")[0] + b"\n").header
    if "akap" not in header:
        return decode_image(bundled_drawing(header).read_bytes())
    return _thumbnail_inside(drawing_inside(header))
