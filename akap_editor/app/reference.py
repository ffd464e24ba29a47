"""The picture that is seen behind the drawing, to be chosen."""

from pathlib import Path

from ..io.images import read_image
from ..io.open_document import PICTURE_SUFFIXES
from .app_state import Workspace
from .dialogs.file_dialog import FileRequest


def ask(space: Workspace) -> None:
    """Ask for its file."""

    def use(path: Path) -> None:
        space.attempt(lambda: space.view.set_reference(read_image(path), path))

    space.request = FileRequest("Choose reference picture", PICTURE_SUFFIXES, space.folder, use)
