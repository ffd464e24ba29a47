"""Opens any file that can be edited as a document."""

from pathlib import Path

from ..editor.document.document import Document, new_document
from ..editor.document.drawing import make_drawing
from ..editor.session.replay import Replay
from ..errors import FileError, InputError, file_errors
from .akap.project import PROJECT_SUFFIX, load
from .akap.recording import RECORDING_SUFFIX, read_recording, recorded_drawing
from .atomic import as_path
from .images import read_image, read_mask
from .mesh_files.mesh_drawing import read_mesh
from .mesh_files.obj_off import PARSERS

PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
MESH_SUFFIXES = tuple(PARSERS)


def open_document(path: str | Path, mask: str | Path | None = None) -> Document:
    """Open a file as a document; the ending of its name decides how.

    .akap: the saved document; .akaprec: the document at the end of the recording; .obj, .off: a flat mesh,
    see `read_mesh`; any other: a picture, which is cut out along its alpha and meshed.
    mask: a picture that is bright, or opaque, where the picture is to be visible.
    Raises InputError, which names the file, or SolverError if a recording cannot be replayed.
    """
    path = as_path(path)
    suffix = path.suffix.lower()
    if mask is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise FileError("use", mask, f"a mask needs a picture, but {path.name} is none")
    if suffix == PROJECT_SUFFIX:
        return load(path)
    if suffix == RECORDING_SUFFIX:
        return _open_recording(path)
    if suffix in MESH_SUFFIXES:
        return new_document(read_mesh(path))
    image = read_image(path)
    shown = read_mask(mask) if mask is not None else None
    with file_errors("open", path):
        return new_document(make_drawing(image, shown, name=path.stem))


def _open_recording(path: Path) -> Document:
    """The document at the end of a recording."""
    recording = read_recording(path)
    with file_errors("open", path):
        replay = Replay(recording, recorded_drawing(recording))
        for _ in replay.events():
            pass
        if replay.session is None:
            raise InputError("the recording is empty")
        return replay.end().document
