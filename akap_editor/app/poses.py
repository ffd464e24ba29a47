"""Poses as files of their own, to be carried from one session to another on the same drawing."""

from functools import partial
from pathlib import Path

from ..io.akap.pose import POSE_SUFFIX, load_pose, save_pose
from .app_state import Workspace
from .dialogs.file_dialog import FileRequest


def ask_save(space: Workspace) -> None:
    """Ask where pins and pose go."""
    if space.document is not None:
        name = f"{space.document.drawing.name}{POSE_SUFFIX}"
        use = partial(save, space)
        space.request = FileRequest("Save pose", (POSE_SUFFIX,), space.folder, use, name, saving=True)


def save(space: Workspace, path: Path) -> None:
    """Write pins and pose."""
    if space.document is not None and space.attempt(partial(save_pose, space.document, path)):
        space.notice = f"Saved {path.name}"


def ask_apply(space: Workspace) -> None:
    """Ask for a pose that was saved on this drawing."""
    if space.document is not None:
        space.request = FileRequest("Apply pose", (POSE_SUFFIX,), space.folder, partial(apply, space))


def apply(space: Workspace, path: Path) -> None:
    """Take over pins and pose from a file, as one gesture."""

    def take() -> None:
        assert space.document is not None
        pose = load_pose(path, space.document.drawing)
        space.editor.apply_pose(pose.pins, pose.positions)
        space.notice = f"Applied {path.name}"

    space.attempt(take)
