"""The session's recording as a file of its own, to be replayed and animated."""

from functools import partial
from pathlib import Path

from ..io.akap.recording import RECORDING_SUFFIX, write_recording
from .app_state import AppState
from .dialogs.file_dialog import FileRequest


def ask_save(state: AppState) -> None:
    """Ask where the list of what was done goes."""
    if state.document is not None:
        name, use = f"{state.document.drawing.name}{RECORDING_SUFFIX}", partial(save, state)
        state.request = FileRequest(
            "Save recording", (RECORDING_SUFFIX,), state.folder, use, name, saving=True
        )


def save(state: AppState, path: Path) -> None:
    """Write all that was done since the drawing was opened, and the drawing."""

    def write() -> None:
        session = state.editor.session
        assert session is not None
        write_recording(session.recording, path, session.drawing)
        state.notice = f"Saved {path.name}, {session.recording.duration:.0f} seconds"

    state.later(write, f"Saving {path.name} ...")
