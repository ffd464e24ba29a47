"""Any file that can be worked on, as a document."""

from pathlib import Path

from ..editor.document.document import Document, new_document
from ..editor.document.drawing import make_drawing
from ..editor.session.replay import Replay
from ..errors import InputError, error_context
from .akap.project import PROJECT_SUFFIX, load
from .akap.recording import RECORDING_SUFFIX, read_recording, recorded_drawing
from .images import read_image, read_mask
from .mesh_files.mesh_drawing import read_mesh
from .mesh_files.obj_off import PARSERS

PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
MESH_SUFFIXES = tuple(PARSERS)


def open_document(path: str | Path, mask: str | Path | None = None) -> Document:
    """A posed drawing from an .akap file, or as a recording leaves it; a mesh from an OBJ or OFF file.

    Any other file is a picture, which is cut out along its alpha and meshed.

    mask: a picture that is bright, or opaque, where the picture is to be visible.
    Raises InputError in one sentence that names the file, SolverError where a recording cannot be done again.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if mask is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise InputError(f"{mask}: expected a picture to put the mask on, got {path.name}")
    if suffix == PROJECT_SUFFIX:
        return load(path)
    if suffix == RECORDING_SUFFIX:
        return _end_of(path)
    if suffix in MESH_SUFFIXES:
        return new_document(read_mesh(path))
    image = read_image(path)
    shown = read_mask(mask) if mask is not None else None
    try:
        return new_document(make_drawing(image, shown, name=path.stem))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _end_of(path: Path) -> Document:
    """What a recording leads to."""
    recording = read_recording(path)
    with error_context(path):
        done = Replay(recording, recorded_drawing(recording))
        for _ in done.events():
            pass
        if done.session is None:
            raise InputError("expected a recording of something that was done, got none")
        return done.end().document
