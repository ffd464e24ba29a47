"""Opens, saves and protects the document of the window; asks about unsaved changes first."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from ..display_text import display_name, file_stem
from ..editor.animation.session_playback import SessionPlayback
from ..editor.document.document import Document
from ..editor.document.settings import Settings
from ..editor.session.session import Session
from ..errors import InputError
from ..io.akap.project import PROJECT_SUFFIX, has_changed_on_disk
from ..io.akap.project import save as save_project
from ..io.akap.recording import RECORDING_SUFFIX
from ..io.atomic import resolved
from ..io.images import has_transparency, is_animation
from ..io.layers.open_layers import LAYER_SUFFIXES
from ..io.open_document import MESH_SUFFIXES, PICTURE_SUFFIXES, open_document, opening_notes
from ..resources import bundled_files
from ..words import tr
from .app_state import AppState, error_message
from .dialogs.file_dialog import FileDialog, FileRequest
from .dialogs.question import Question, QuestionDialog
from .dialogs.replace_files import replace_question
from .jobs.background_task import background_task
from .jobs.engine_preparation import TEXT as PREPARATION_TEXT
from .jobs.open_recording import ReadRecording, read_for_replay, replay_task
from .jobs.reload_artwork import watch_artwork
from .jobs.task import Task

T = TypeVar("T")

# -- opening ------------------------------------------------------------------------------------------------


def show_document(state: AppState, document: Document) -> None:
    """Make a document the open one. A new drawing gets the settings that were chosen last."""
    preferred = state.preferred_settings() if document.state.settings == Settings() else None
    try:
        if preferred is not None and document.path is None:
            state.editor.open(document.with_state(replace(document.state, settings=preferred)))
        else:
            state.editor.open(document)
    except InputError:  # preferences that were written by hand, or by another version
        state.editor.open(document)
    state.view.selected_layer = state.editor.joint_tool.selected = None
    if document.state.animation.keyframes:
        state.timeline.mode, state.timeline.is_shown = "keyframes", True
    opaque = document.path is None and not has_transparency(document.drawing.image)
    notes = opening_notes(document, tr("in the Mesh section"))
    if opaque:
        notes.append(
            tr(
                "This picture has no transparency, so the whole rectangle bends. "
                "Remove Background in the Mesh section cuts out the drawing."
            )
        )
    state.notice = ". ".join(notes)
    watch_artwork(state)


def show_when_prepared(state: AppState, document: Document) -> None:
    """`show_document` as soon as the engine can take a document. The first start has to wait for that."""
    if state.engine.can_open:
        show_document(state, document)
        return

    def show(_: None) -> None:
        show_document(state, document)

    state.begin_task(background_task(tr(PREPARATION_TEXT), state.engine.wait_to_open, show, state.wake))


def choose_and_open(state: AppState) -> None:
    """Ask for a picture, drawing or recording, then open it."""
    suffixes = (PROJECT_SUFFIX, RECORDING_SUFFIX, *PICTURE_SUFFIXES, *LAYER_SUFFIXES, *MESH_SUFFIXES)
    state.part(FileDialog).ask(
        FileRequest(tr("Open picture or drawing"), suffixes, state.folder, partial(open_path, state))
    )


def open_dropped(state: AppState, paths: list[Path]) -> None:
    """Open the first of the files that were dropped on the window."""
    notice = (
        tr("Opened {file}, the first of {count} files", file=display_name(paths[0]), count=len(paths))
        if len(paths) > 1
        else ""
    )
    open_path(state, paths[0], notice)


def open_path(state: AppState, path: Path, notice: str = "", then: Callable[[], None] | None = None) -> None:
    """Open a picture, drawing or recording, after asking about unsaved changes; then show ``notice``.

    then: is called after a picture or drawing was opened.
    """

    def begin() -> None:
        state.notice = ""
        if path.suffix.lower() == RECORDING_SUFFIX:
            _begin_recording(state, path)
        else:
            _begin_document(state, path, notice, then)

    confirm_unsaved(state, begin)


def _begin_document(state: AppState, path: Path, notice: str, then: Callable[[], None] | None = None) -> None:
    """Read a picture or drawing in a thread, then show it."""

    def show(document: Document) -> None:
        show_document(state, document)
        if is_animation(path):
            state.notice = tr("Opened the first frame of the animation {file}", file=display_name(path))
        remember_file(state, path)
        state.notice = notice or state.notice
        if then is not None:
            state.run_after_frame(then)

    state.begin_task(
        _opening_task(state, path, partial(open_document, path, mesher=state.preferences.mesher), show)
    )


def _begin_recording(state: AppState, path: Path) -> None:
    """Read a recording in a thread, then replay it."""

    def begin_replay(read: ReadRecording) -> None:
        state.begin_task(replay_task(read, partial(_show_recording, state, path)))

    def read() -> ReadRecording:
        state.engine.wait_to_open(and_to_step=True)
        return read_for_replay(path)

    state.begin_task(_opening_task(state, path, read, begin_replay))


def _opening_task(state: AppState, path: Path, read: Callable[[], T], show: Callable[[T], None]) -> Task:
    """A task that reads a file and shows it; a file that cannot be read is no recent one any more."""

    def forget() -> None:
        state.preferences.remove_recent(path)

    def read_and_wait() -> T:
        result = read()
        state.engine.wait_to_open()
        return result

    return background_task(
        tr("Opening {file}", file=display_name(path)), read_and_wait, show, state.wake, forget
    )


def _show_recording(state: AppState, path: Path, session: Session, playback: SessionPlayback) -> None:
    """Continue the replayed session of a recording; the timeline shows all of it."""
    session.mark_saved(None)
    state.editor.take_over(session)
    state.timeline.session_playback, state.timeline.mode, state.timeline.is_shown = playback, "session", True
    remember_file(state, path)
    state.notice = tr(
        "Opened {file}; the timeline shows its {seconds:.0f} seconds",
        file=display_name(path),
        seconds=playback.duration,
    )


def remember_file(state: AppState, path: Path) -> None:
    """Start the next file dialog in this file's folder, and list the file among the recent ones."""
    state.folder = resolved(path).parent
    if resolved(path) not in map(resolved, bundled_files()):
        state.preferences.add_recent(path)
        state.save_preferences()  # now, so that it survives a crash


# -- saving -------------------------------------------------------------------------------------------------


def save(state: AppState, then: Callable[[], None] | None = None) -> None:
    """Write the document to its own file, or ask for one if it has none; after that, call ``then``.

    If another program has changed the file, ask before replacing it.
    """
    if state.document is None:
        return
    path = state.document.path
    if path is None:
        save_as(state, then)
    elif has_changed_on_disk(state.document):
        text = tr(
            "“{file}” has been changed by another program, or in another window, since it was "
            "opened or saved here. Replacing it loses these changes.",
            file=display_name(path),
        )
        replace_it = partial(write_document, state, path, then)
        rename = partial(save_as, state, then)
        state.part(QuestionDialog).ask(replace_question(text, replace_it, tr("Save As..."), rename))
    else:
        write_document(state, path, then)


def save_as(state: AppState, then: Callable[[], None] | None = None) -> None:
    """Ask for a file and write the document to it; after that, call ``then``."""
    if state.document is None:
        return
    suggested = (
        state.document.path or state.folder / f"{file_stem(state.document.drawing.name)}{PROJECT_SUFFIX}"
    )
    state.part(FileDialog).ask(
        FileRequest(
            tr("Save drawing"),
            (PROJECT_SUFFIX,),
            resolved(suggested).parent,
            lambda path: write_document(state, path, then),
            suggested.name,
            saving=True,
        )
    )


def write_document(state: AppState, path: Path, then: Callable[[], None] | None = None) -> None:
    """Write the document to a file, which becomes its own; after that, call ``then``."""

    def write() -> None:
        assert state.editor.session is not None
        saved = save_project(state.editor.session.present_document, path)
        state.editor.mark_saved(path, saved.digest)
        remember_file(state, path)
        state.notice = tr("Saved {file}", file=display_name(path))

    if state.run_reporting_errors(write) and then is not None:
        then()


# -- closing ------------------------------------------------------------------------------------------------


def confirm_unsaved(state: AppState, proceed: Callable[[], None]) -> None:
    """Call ``proceed`` at once, or after the user has decided what happens to unsaved changes."""
    document = state.document
    if document is None or not state.editor.is_modified:
        proceed()
        return
    name = display_name(document.path) if document.path is not None else document.drawing.name
    text = tr("Save changes to “{name}” before closing?", name=name)
    state.part(QuestionDialog).ask(
        Question("Unsaved changes", text, tr("Save"), lambda: save(state, proceed), tr("Don't Save"), proceed)
    )


def close_document(state: AppState) -> None:
    """Go to the start page, after asking about unsaved changes."""

    def close() -> None:
        state.editor.close()
        state.notice = ""

    confirm_unsaved(state, close)


def quit_program(state: AppState) -> None:
    """Close the window, after asking about unsaved changes."""

    def close() -> None:
        state.is_closing = True

    confirm_unsaved(state, close)


# -- recovery copies ----------------------------------------------------------------------------------------


def autosave(state: AppState) -> None:
    """Keep a recovery copy of unsaved changes up to date; to be called about once a frame."""
    session = state.editor.session
    if state.autosave is None:
        return
    try:
        last_gesture = session.history.last if session is not None else None
        document = session.present_document if session is not None else None
        state.autosave.watch(document, state.editor.is_modified, last_gesture)
    except Exception as error:  # a copy that fails must not end the program that it protects
        state.notice = error_message(error)


def rescue(state: AppState) -> None:
    """Write a recovery copy of unsaved changes now, because the program is about to end with an error."""
    session = state.editor.session
    if state.autosave is not None and session is not None and state.editor.is_modified:
        state.run_reporting_errors(partial(state.autosave.rescue, session.present_document))
