"""Reloads the artwork of the open drawing, and offers to when another program has changed it."""

from functools import partial
from pathlib import Path

from imgui_bundle import icons_fontawesome_6 as icons

from ...display_text import display_name
from ...editor.document.document import ArtworkFile, EditState
from ...editor.session.artwork_reload import with_artwork
from ...editor.session.edits import ReloadArtwork
from ...errors import file_errors
from ...io.artwork_file import artwork_file
from ...io.images import read_image
from ...io.layers.open_layers import LAYER_SUFFIXES, is_layered, open_layers
from ...io.open_document import PICTURE_SUFFIXES
from ...layers.layered_picture import Layer, LayeredPicture
from ...words import mark, tr
from ..app_state import AppState, NoticeButton
from ..dialogs.file_dialog import FileDialog, FileRequest
from .artwork_watch import ArtworkWatch, artwork_path
from .background_task import background_task


def watch_artwork(state: AppState) -> None:
    """Begin to watch the artwork of a document that was just opened, and offer what changed before."""
    path = artwork_path(state)
    if path is not None and state.document is not None:
        state.part(ArtworkWatch).remember(path)
        if state.document.artwork is not None and state.document.artwork.has_changed:
            _offer(state, path)


def notice_changed_artwork(state: AppState) -> None:
    """Offer to reload the artwork if another program has written its file."""
    path = artwork_path(state)
    if path is not None and state.part(ArtworkWatch).has_changed(path):
        _offer(state, path)


def _offer(state: AppState, path: Path) -> None:
    state.notice = tr("{file} has changed on disk", file=display_name(path))
    run = partial(reload_artwork, state)
    label, icon = mark("Reload Artwork"), icons.ICON_FA_ARROWS_ROTATE
    state.notice_button = NoticeButton(state.notice, label, icon, run)


def can_reload(state: AppState) -> bool:
    """Whether the drawing was made from a picture."""
    return state.document is not None and state.document.drawing.meshing is not None


def reload_artwork(state: AppState) -> None:
    """Read the drawing's picture again; ask for its file if that is gone or unknown."""
    document = state.document
    if document is None:
        return
    known = artwork_path(state)
    if known is not None:
        _reload(state, known)
        return
    folder, name = state.folder, ""
    if document.artwork is not None:
        folder, name = document.artwork.path.parent, document.artwork.path.name
        state.notice = tr("{file} is not in {folder} any more: choose it", file=name, folder=folder)
        folder = next((each for each in (folder, *folder.parents) if each.is_dir()), state.folder)
    suffixes = (*PICTURE_SUFFIXES, *LAYER_SUFFIXES)
    use = partial(_reload, state)
    state.part(FileDialog).ask(FileRequest(tr("Choose the changed picture"), suffixes, folder, use, name))


def _reload(state: AppState, path: Path) -> None:
    session = state.editor.session
    if session is None:
        return
    session.finish_step()
    before, drawing = session.present, session.drawing

    def read() -> tuple[ArtworkFile, LayeredPicture, EditState]:
        file = artwork_file(path)  # first, so that a change meanwhile is noticed
        artwork = read_artwork(path)
        with file_errors("reload", path):
            return file, artwork, with_artwork(before, drawing, artwork)

    def show(result: tuple[ArtworkFile, LayeredPicture, EditState]) -> None:
        file, artwork, prepared = result
        is_current = state.editor.session is session and session.present is before
        state.editor.apply(mark("Reload Artwork"), ReloadArtwork(artwork, prepared if is_current else None))
        if state.editor.session is not None:
            state.editor.session.set_artwork(file)
        state.part(ArtworkWatch).remember(file.path)
        state.notice = tr("Reloaded {file}", file=display_name(path))

    state.begin_task(background_task(tr("Reloading {file}", file=display_name(path)), read, show, state.wake))


def read_artwork(path: Path) -> LayeredPicture:
    """The layers of a picture file; of a flat picture one layer. Raises FileError."""
    if is_layered(path):
        return open_layers(path)
    image = read_image(path)
    return LayeredPicture((image.shape[1], image.shape[0]), (Layer(path.stem, image),))
