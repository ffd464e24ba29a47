"""Cutting the open picture out anew with a mask: a second picture that says what belongs to the drawing."""

from dataclasses import replace
from pathlib import Path

from ..editor.document.document import Document, new_document
from ..editor.document.drawing import apply_mask, remove_background_and_mesh
from ..errors import InputError
from ..io.images import read_mask
from ..io.open_document import PICTURE_SUFFIXES
from .app_state import AppState
from .dialogs.file_dialog import FileRequest


def can_mask(state: AppState) -> bool:
    """Whether the mesh was made of the picture, as those from mesh files are not."""
    return state.document is not None and state.document.drawing.meshing is not None


def ask_mask(state: AppState) -> None:
    """Ask for a mask, and about unsaved changes, as the drawing begins anew; then cut it out."""

    def use(path: Path) -> None:
        document = state.document
        if document is None:
            return

        def cut() -> None:
            state.show(cut_out(document, path))
            state.notice = f"Cut out with {path.name}"

        state.unless_unsaved(lambda: state.later(cut, f"Cutting out with {path.name} ..."))

    state.request = FileRequest("Choose mask", PICTURE_SUFFIXES, state.folder, use)


def cut_out(document: Document, mask: Path) -> Document:
    """The picture of ``document``, with its background if that was removed, seen only where a mask shows it.

    mask: a picture of the same size, bright, or opaque, where the picture is to be visible. Pins and pose are
    those of a new drawing. Raises InputError.
    """
    drawing = document.drawing
    assert drawing.meshing is not None
    picture = drawing.image if drawing.original is None else drawing.original
    shown = read_mask(mask)
    try:
        image = apply_mask(picture, shown)
        return new_document(
            remove_background_and_mesh(image, replace(drawing.meshing, background=None), drawing.name)
        )
    except InputError as error:
        raise InputError(f"{mask}: {error}") from error
