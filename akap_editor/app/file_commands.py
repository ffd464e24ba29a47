"""Commands that ask for a file and use it: masks, poses, recordings and the reference picture."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from ..display_text import display_name, file_stem
from ..editor import gestures
from ..editor.document.document import Document, new_document
from ..editor.document.drawing import (
    Meshing,
    apply_mask,
    make_drawing,
    mask_layers,
    mesh_layered_drawing,
    remove_background_and_mesh,
)
from ..errors import file_errors
from ..io.akap.pose import POSE_SUFFIX, load_pose, save_pose
from ..io.akap.recording import RECORDING_SUFFIX, write_recording
from ..io.images import read_image, read_mask
from ..io.open_document import PICTURE_SUFFIXES
from ..layers.drawing_layer import as_layered_picture, flat_picture
from ..meshing.faint import fitting_threshold
from ..words import tr
from . import files
from .app_state import AppState
from .dialogs.file_dialog import FileDialog, FileRequest
from .jobs.background_task import background_task

# -- masks --------------------------------------------------------------------------------------------------


def can_mask(state: AppState) -> bool:
    """Whether the mesh was made from the picture; drawings from mesh files bring their own."""
    return state.document is not None and state.document.drawing.meshing is not None


def choose_mask(state: AppState) -> None:
    """Choose a mask file; confirm unsaved changes first, because the drawing is rebuilt."""

    def use(path: Path) -> None:
        document = state.document
        if document is None:
            return

        def show(masked: Document) -> None:
            files.show_document(state, masked)
            state.notice = tr("Cut out with {file}", file=display_name(path))

        task = background_task(
            tr("Cutting out with {file}", file=display_name(path)),
            partial(cut_out, document, path),
            show,
            state.wake,
        )
        files.confirm_unsaved(state, lambda: state.begin_task(task))

    state.part(FileDialog).ask(FileRequest(tr("Choose mask"), PICTURE_SUFFIXES, state.folder, use))


def cut_out(document: Document, mask: Path) -> Document:
    """A new document with the picture of ``document``, transparent wherever the mask file hides it.

    mask: a picture of the same size, bright or opaque where the drawing is to be visible. A background that
    was removed is in the picture again. The new document has no pins and the rest pose. Raises InputError.
    """
    drawing = document.drawing
    assert drawing.meshing is not None
    picture = drawing.image if drawing.original is None else drawing.original
    visible = read_mask(mask)
    with file_errors("use", mask):
        if drawing.layers:
            layered = as_layered_picture(drawing.layers, drawing.layer_order, drawing.size)
            cut = mesh_layered_drawing(mask_layers(layered, visible), drawing.meshing, drawing.name)
            return replace(new_document(cut), sources=(*document.sources, mask))
        image = apply_mask(picture, visible)
        threshold = fitting_threshold(image[..., 3], drawing.meshing.threshold)  # the mask may be faint
        meshing = replace(drawing.meshing, background=None, threshold=threshold)
        masked = new_document(remove_background_and_mesh(image, meshing, drawing.name))
    return replace(masked, sources=(*document.sources, mask))


# -- layers -------------------------------------------------------------------------------------------------


def has_layers(state: AppState) -> bool:
    """Whether the drawing has layers."""
    return state.document is not None and bool(state.document.drawing.layers)


def merge_layers(state: AppState) -> None:
    """Replace the drawing by one of its merged visible layers; confirm unsaved changes first."""
    document = state.document
    if document is None:
        return

    def show(merged: Document) -> None:
        files.show_document(state, merged)
        state.notice = tr("The visible layers were merged into one drawing")

    task = background_task(tr("Merging the layers"), partial(merged_document, document), show, state.wake)
    files.confirm_unsaved(state, lambda: state.begin_task(task))


def merged_document(document: Document) -> Document:
    """A new document of the visible layers of ``document`` as one picture, without pins, at rest.

    Raises InputError if nothing is visible.
    """
    drawing = document.drawing
    image = flat_picture(drawing.layers, drawing.layer_order, drawing.size)
    meshing = drawing.meshing or Meshing()
    threshold = fitting_threshold(image[..., 3], meshing.threshold)
    merged = make_drawing(image, None, meshing.vertices, meshing.expand, threshold, name=drawing.name)
    return replace(new_document(merged), sources=document.sources, artwork=document.artwork)


# -- poses --------------------------------------------------------------------------------------------------


def choose_pose_to_save(state: AppState) -> None:
    """Ask for a pose file, then write pins and pose to it."""
    if state.document is not None:
        name = f"{file_stem(state.document.drawing.name)}{POSE_SUFFIX}"
        use = partial(save_pose_file, state)
        state.part(FileDialog).ask(
            FileRequest(tr("Save pose"), (POSE_SUFFIX,), state.folder, use, name, saving=True)
        )


def save_pose_file(state: AppState, path: Path) -> None:
    """Write pins and pose to a file."""
    if state.document is not None and state.run_reporting_errors(partial(save_pose, state.document, path)):
        state.notice = tr("Saved {file}", file=display_name(path))


def choose_pose_to_apply(state: AppState) -> None:
    """Ask for a pose file of this drawing, then apply it."""
    if state.document is not None:
        use = partial(apply_pose_file, state)
        state.part(FileDialog).ask(FileRequest(tr("Apply pose"), (POSE_SUFFIX,), state.folder, use))


def apply_pose_file(state: AppState, path: Path) -> None:
    """Replace pins and pose by those of a file, as one undoable gesture."""

    def apply() -> None:
        assert state.document is not None
        pose = load_pose(path, state.document.drawing)
        gestures.apply_pose(state.editor, pose.pins, pose.positions, pose.crossings)
        state.notice = tr("Applied {file}", file=display_name(path))

    state.run_reporting_errors(apply)


# -- recordings ---------------------------------------------------------------------------------------------


def choose_recording_to_save(state: AppState) -> None:
    """Ask for a recording file, then write the session to it."""
    if state.document is not None:
        name, use = (
            f"{file_stem(state.document.drawing.name)}{RECORDING_SUFFIX}",
            partial(save_recording_file, state),
        )
        state.part(FileDialog).ask(
            FileRequest(tr("Save recording"), (RECORDING_SUFFIX,), state.folder, use, name, saving=True)
        )


def save_recording_file(state: AppState, path: Path) -> None:
    """Write the drawing and everything that was done to it since it was opened."""

    def write() -> None:
        session = state.editor.session
        assert session is not None
        write_recording(session.recording, path, session.drawing)
        state.notice = tr(
            "Saved {file}, {seconds:.0f} seconds", file=display_name(path), seconds=session.recording.duration
        )

    state.run_after_frame(write, tr("Saving {file} ...", file=display_name(path)))


# -- the reference picture ----------------------------------------------------------------------------------


def choose_reference(state: AppState) -> None:
    """Ask for a picture, then show it behind the drawing."""

    def use(path: Path) -> None:
        state.run_reporting_errors(lambda: state.view.set_reference(read_image(path), path))

    state.part(FileDialog).ask(
        FileRequest(tr("Choose reference picture"), PICTURE_SUFFIXES, state.folder, use)
    )
