"""The picture that is seen behind the drawing, to be chosen."""

from pathlib import Path

from ..io.images import read_image
from ..io.open_document import PICTURE_SUFFIXES
from .app_state import AppState
from .dialogs.file_dialog import FileRequest


def ask(state: AppState) -> None:
    """Ask for its file."""

    def use(path: Path) -> None:
        state.attempt(lambda: state.view.set_reference(read_image(path), path))

    state.request = FileRequest("Choose reference picture", PICTURE_SUFFIXES, state.folder, use)
