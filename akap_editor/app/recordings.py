"""The session's recording as a file of its own, to be replayed and animated."""

from functools import partial
from pathlib import Path

from ..io.akap.recording import RECORDING_SUFFIX, write_recording
from .app_state import Workspace
from .dialogs.file_dialog import FileRequest


def ask_save(space: Workspace) -> None:
    """Ask where the list of what was done goes."""
    if space.document is not None:
        name, use = f"{space.document.drawing.name}{RECORDING_SUFFIX}", partial(save, space)
        space.request = FileRequest(
            "Save recording", (RECORDING_SUFFIX,), space.folder, use, name, saving=True
        )


def save(space: Workspace, path: Path) -> None:
    """Write all that was done since the drawing was opened, and the drawing."""

    def write() -> None:
        session = space.editor.session
        assert session is not None
        write_recording(session.recording, path, session.drawing)
        space.notice = f"Saved {path.name}, {session.recording.duration:.0f} seconds"

    space.later(write, f"Saving {path.name} ...")
