"""Any file that can be worked on, as a document."""

from pathlib import Path

from ..editor.document import Document, make_drawing, new_document
from ..errors import InputError
from . import mesh_files, project_file
from .images import read_image, read_mask

PROJECT_SUFFIX = ".akap"
PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
MESH_SUFFIXES = tuple(mesh_files.READERS)


def open_document(path: str | Path, mask: str | Path | None = None) -> Document:
    """A posed drawing from an .akap file, a mesh from an OBJ or OFF file; from any other file, a picture that
    is cut out along its alpha and meshed.

    mask: a picture that is bright, or opaque, where the picture is to be visible.
    Raises InputError in one sentence that names the file.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if mask is not None and suffix in (PROJECT_SUFFIX, *MESH_SUFFIXES):
        raise InputError(f"{mask}: expected a picture to put the mask on, got {path.name}")
    if suffix == PROJECT_SUFFIX:
        return project_file.load(path)
    if suffix in MESH_SUFFIXES:
        return new_document(mesh_files.read_mesh(path))
    image = read_image(path)
    shown = read_mask(mask) if mask is not None else None
    try:
        return new_document(make_drawing(image, shown, name=path.stem))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
