"""Thumbnails of files, read in a thread."""

from concurrent.futures import Future
from pathlib import Path

import numpy as np
from PIL import Image

from ...errors import AkapError
from ...io.akap.project import PROJECT_SUFFIX
from ...io.akap.recording import RECORDING_SUFFIX
from ...io.file_thumbnail import make_thumbnail
from ...io.images import Picture, read_image
from .background_thread import BackgroundThread, Wake

_MAX_BYTES = 64 * 2**20  # of a file whose thumbnail is made
_OWN_SUFFIXES = (PROJECT_SUFFIX, RECORDING_SUFFIX)
_PICTURE_SUFFIXES = (".png", ".webp", ".bmp", ".jpg", ".jpeg")


class FileThumbnails:
    """The pictures of files that were asked for, each made once in a run."""

    def __init__(self) -> None:
        self._pictures: dict[tuple[Path, int], Future[Picture | None]] = {}
        self._thread: BackgroundThread | None = None

    def picture(self, path: Path, side: int, wake: Wake) -> Picture | None:
        """A picture (h, w, 4) of at most ``side`` pixels a side; None until it is made, or if that fails."""
        key = path, side
        if key not in self._pictures:
            if self._thread is None:
                self._thread = BackgroundThread("thumbnails", wake)
            self._pictures[key] = self._thread.submit(file_thumbnail, path, side)
        future = self._pictures[key]
        return future.result() if future.done() else None


def file_thumbnail(path: Path, side: int) -> Picture | None:
    """The thumbnail of a drawing, recording or picture; None if it is another file, or cannot be read."""
    suffix = path.suffix.lower()
    try:
        if suffix in _OWN_SUFFIXES:
            return make_thumbnail(path, side)
        if suffix not in _PICTURE_SUFFIXES or path.stat().st_size > _MAX_BYTES:
            return None
        picture = Image.fromarray(read_image(path))
    except (AkapError, OSError):
        return None
    picture.thumbnail((side, side), Image.Resampling.LANCZOS)
    return np.asarray(picture)
