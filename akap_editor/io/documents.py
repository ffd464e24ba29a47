"""Any file that can be worked on, as a document."""

from pathlib import Path

from ..editor.document import Document, make_drawing, new_document
from ..errors import InputError
from . import project_file
from .images import read_image

PROJECT_SUFFIX = ".akap"
PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp")


def open_document(path: str | Path) -> Document:
    """A posed drawing from an .akap file; from any other file, a picture cut out along its alpha and meshed.

    Raises InputError in one sentence that names the file.
    """
    path = Path(path)
    if path.suffix.lower() == PROJECT_SUFFIX:
        return project_file.load(path)
    image = read_image(path)
    try:
        return new_document(make_drawing(image, name=path.stem))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
