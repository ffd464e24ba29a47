"""Copy and paste through the clipboard of the system: pictures, and poses as text."""

from collections.abc import Callable
from functools import partial

import copykitten
import numpy as np
from numpy.typing import NDArray

from ...editor import gestures
from ...editor.document.document import Document, new_document
from ...editor.document.drawing import make_drawing
from ...errors import InputError
from ...geometry.validation import freeze
from ...io.akap.pose import POSE_FORMAT, decode_pose, encode_pose
from ...io.images import MAX_PIXELS
from ...meshing.faint import fitting_threshold
from ...words import tr
from .. import files
from ..app_state import AppState
from ..jobs.background_task import background_task
from .command import CTRL, SHIFT, Command, Key, has_drawing

_NAME = "clipboard"  # of the drawing


def copied_picture() -> NDArray[np.uint8] | None:
    """The picture (h, w, 4) uint8, straight alpha, in the clipboard; None if there is none."""
    try:
        data, width, height = copykitten.paste_image()
    except copykitten.CopykittenError:
        return None
    if not 0 < width * height <= MAX_PIXELS:
        raise InputError(
            tr(
                "Couldn't open the picture in the clipboard. It has {width} × {height} pixels; "
                "up to {most:,} are possible.",
                width=width,
                height=height,
                most=MAX_PIXELS,
            )
        )
    return freeze(np.frombuffer(data, np.uint8).reshape(height, width, 4).copy())


def copied_text() -> str:
    """The text in the clipboard; empty if there is none."""
    try:
        return str(copykitten.paste())
    except copykitten.CopykittenError:
        return ""


def _paste(state: AppState) -> None:
    """Open the picture in the clipboard, or apply the pose that it holds."""
    text = copied_text()
    if f'"{POSE_FORMAT}"' in text[:200]:
        _apply_pose(state, text)
        return
    picture = copied_picture()
    if picture is None:
        state.notice = tr("The clipboard holds neither a picture nor a pose")
        return
    show = partial(_show, state)
    task = background_task(
        tr("Opening the picture in the clipboard"), partial(_make, picture), show, state.wake
    )
    files.confirm_unsaved(state, lambda: state.begin_task(task))


def _make(picture: NDArray[np.uint8]) -> Document:
    threshold = fitting_threshold(picture[..., 3])
    return new_document(make_drawing(picture, threshold=threshold, name=_NAME))


def _show(state: AppState, document: Document) -> None:
    files.show_document(state, document)
    assert state.editor.session is not None
    state.editor.session.mark_unsaved()  # no file holds the picture
    state.notice = state.notice or tr("Opened the picture in the clipboard")


def _apply_pose(state: AppState, text: str) -> None:
    if state.document is None:
        state.notice = tr("The clipboard holds a pose: open its drawing first")
        return
    pose = decode_pose(text.encode(), state.document.drawing)
    gestures.apply_pose(state.editor, pose.pins, pose.positions, pose.crossings)
    state.notice = tr("Applied the pose in the clipboard")


def _copy_picture(state: AppState) -> None:
    """Put a picture of the pose into the clipboard, as large as the drawing's own, with transparency."""
    document = state.document
    assert document is not None
    order = document.draw_order
    picture = state.offscreen_renderer.render(document.drawing, document.state.positions, order=order)
    height, width = picture.shape[:2]
    _put(lambda: copykitten.copy_image(picture.tobytes(), width, height))
    state.notice = tr("Copied the pose as a picture, {width} × {height} px", width=width, height=height)


def _copy_pose(state: AppState) -> None:
    """Put pins and pose into the clipboard, for another drawing of the same mesh."""
    document = state.document
    assert document is not None
    text = encode_pose(document).decode()
    _put(lambda: copykitten.copy(text))
    state.notice = tr("Copied the pose; paste it into another drawing of the same mesh")


def _put(copy: Callable[[], None]) -> None:
    """Put something into the clipboard. Raises InputError if the system refuses it."""
    try:
        copy()
    except copykitten.CopykittenError as error:
        raise InputError(tr("Couldn't copy to the clipboard. {error}", error=error)) from error


PASTE = Command("Paste Picture or Pose", _paste, (CTRL | Key.v,))
COPY_PICTURE = Command("Copy as Picture", _copy_picture, (CTRL | Key.c,), "", has_drawing)
COPY_POSE = Command("Copy Pose", _copy_pose, (CTRL | SHIFT | Key.c,), "", has_drawing)
