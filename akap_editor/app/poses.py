"""Poses as files of their own, to be carried from one session to another on the same drawing."""

from functools import partial
from pathlib import Path

from ..editor import gestures
from ..io.akap.pose import POSE_SUFFIX, load_pose, save_pose
from .app_state import AppState
from .dialogs.file_dialog import FileRequest


def ask_save(state: AppState) -> None:
    """Ask where pins and pose go."""
    if state.document is not None:
        name = f"{state.document.drawing.name}{POSE_SUFFIX}"
        use = partial(save, state)
        state.request = FileRequest("Save pose", (POSE_SUFFIX,), state.folder, use, name, saving=True)


def save(state: AppState, path: Path) -> None:
    """Write pins and pose."""
    if state.document is not None and state.attempt(partial(save_pose, state.document, path)):
        state.notice = f"Saved {path.name}"


def ask_apply(state: AppState) -> None:
    """Ask for a pose that was saved on this drawing."""
    if state.document is not None:
        state.request = FileRequest("Apply pose", (POSE_SUFFIX,), state.folder, partial(apply, state))


def apply(state: AppState, path: Path) -> None:
    """Take over pins and pose from a file, as one gesture."""

    def take() -> None:
        assert state.document is not None
        pose = load_pose(path, state.document.drawing)
        gestures.apply_pose(state.editor, pose.pins, pose.positions)
        state.notice = f"Applied {path.name}"

    state.attempt(take)
