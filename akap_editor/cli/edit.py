"""Opens the editor's window."""

import gc
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import DisplayError, InputError
from ..io.outputs import unused_path
from ..resources import bundled_files, resource
from ..words import use_language
from .options import FILE, bundled, check_threshold, merge_layers_option, mesher_option, threshold_option

if TYPE_CHECKING:
    from ..app.preferences import Preferences
    from ..editor.document.document import Document

FIRST_DRAWING = "elephant"
OUTPUT_FOLDER = Path("out")


def _complete(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Complete the name of a bundled drawing in the shell."""
    return [path.stem for path in bundled_files() if path.stem.startswith(incomplete)]


@click.command(epilog="Example: akap-editor edit cat.png")
@click.argument("file", type=FILE, required=False)
@click.option("--mask", type=FILE, help="Picture that is bright, or opaque, where FILE is to be visible.")
@click.option(
    "--bundled",
    "name",
    metavar="NAME",
    shell_complete=_complete,
    help=f"Open a drawing that comes with the program instead of FILE, e.g. {FIRST_DRAWING}.",
)
@threshold_option
@merge_layers_option
@mesher_option
def edit(
    file: Path | None,
    mask: Path | None,
    name: str | None = None,
    threshold: float | None = None,
    merge_layers: bool = False,
    mesher: str | None = None,
) -> None:
    """Open FILE in a window: a picture, also in layers (PSD, ORA, a folder of PNG pictures), a flat
    OBJ or OFF mesh, a drawing saved as .akap, or a recording, which is then on the timeline.

    The layers of a picture stay layers, each of which bends on its own; --merge-layers makes one drawing
    of them.

    Without FILE, the start page shows bundled drawings and recent files, and accepts dropped files.

    Without a display and without FILE, a bundled recording is replayed offscreen instead.
    """
    with _paused_collector():
        from ..io.akap.recording import RECORDING_SUFFIX
        from ..io.open_document import open_document

    _check_arguments(file, mask, name)
    preferences = _stored_preferences()
    use_language(preferences.language)  # that of errors, which the window shows
    document, problem, recording = None, None, None
    source = bundled(name) if name is not None else file
    try:
        if (
            source is not None
            and source.suffix.lower() == RECORDING_SUFFIX
            and mask is None
            and threshold is None
        ):
            recording = source
        elif source is not None:
            document = open_document(
                source, mask, check_threshold(threshold), mesher or preferences.mesher, merge_layers
            )
    except InputError as error:
        problem = error
    try:
        message = "" if problem is None else str(problem)
        open_window(document, message, recording, file if document else None)
    except DisplayError as error:
        if problem is not None:
            raise problem from None
        if file is not None:
            raise
        click.echo(f"No window: {error}. Replaying the bundled recording without one.")
        from . import replay

        recording = resource("assets", "recordings", f"{FIRST_DRAWING}.akaprec")
        animation = unused_path(OUTPUT_FOLDER / f"{FIRST_DRAWING}.webp", ".png")
        pose = animation.with_suffix(".png")
        result = replay.replay_recording(recording, None, animation, pose, fps=24.0, size=480)
        replay.print_replays([result], False, animation)


def _stored_preferences() -> "Preferences":
    """What was chosen in the window last."""
    from ..app.preferences import Preferences, preferences_path

    return Preferences(preferences_path())


def _check_arguments(file: Path | None, mask: Path | None, name: str | None) -> None:
    """Raise InputError if the arguments exclude or miss each other."""
    if file is not None and name is not None:
        raise InputError(f"expected a FILE or --bundled, got both: {file} and {name}")
    if mask is not None and file is None:
        raise InputError(f"--mask: expected a FILE that is to be cut out, got only the mask {mask}")


@contextmanager
def _paused_collector() -> Iterator[None]:
    """Look for no garbage in the block: what is imported stays, and the search takes a sixth of the start."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


def open_window(document: "Document | None", problem: str, recording: Path | None, file: Path | None) -> None:
    """Open the window and stay until it is closed. Raises DisplayError if that is not possible.

    problem: shown as an error, e.g. that a file could not be opened; recording: replayed in the window, which
    shows the progress; file: of the document, if it has one.
    """
    from ..io.akap.autosave import Autosave

    needs_display = sys.platform.startswith("linux")
    if needs_display and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise DisplayError("there is no display")
    with ExitStack() as stack:
        with _paused_collector():
            try:
                from ..app import files
                from ..app.jobs.engine_preparation import EnginePreparation
                from ..app.preferences import Preferences, preferences_path
                from ..app.window import Window
            except ImportError as error:
                raise DisplayError(f"a package that the window needs is missing ({error})") from error
            engine = stack.enter_context(EnginePreparation())  # it loads while the window is made
            preferences = Preferences(preferences_path())
            window = stack.enter_context(Window(preferences=preferences, autosave=Autosave(), engine=engine))
            gc.freeze()  # a full collection would otherwise stop the window for 50 ms
        window.state.error = problem
        if recording is not None:
            files.open_path(window.state, recording)
        if file is not None:
            files.remember_file(window.state, file)
        window.run(document)
