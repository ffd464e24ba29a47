"""What the window holds besides the drawing's own state: view switches, files, messages, questions."""

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..editor.document import Document
from ..editor.editor import Editor
from ..errors import AkapError
from ..geometry.checks import Floats
from ..geometry.distortion import Distortion, distortion
from ..io import project_file
from ..io.documents import PICTURE_SUFFIXES, PROJECT_SUFFIX, open_document
from ..io.images import has_transparency, write_png
from ..render.offscreen import OffscreenRenderer


@dataclass
class Question:
    """Unsaved changes stand in the way of ``go_on``."""

    go_on: Callable[[], None]


@dataclass
class FileRequest:
    """A file is to be chosen, and ``use`` gets its path.

    suffixes: of the files that are meant, the first one is added to a name without any; folder, name: what is
    in the dialog's fields; saving: whether the file is to be written.
    """

    title: str
    suffixes: tuple[str, ...]
    folder: Path
    use: Callable[[Path], None]
    name: str = ""
    saving: bool = False

    @property
    def path(self) -> Path:
        """The file that the fields name, or a folder that is there."""
        # os.path, unlike Path, takes whatever may be typed: unknown users, names that are too long
        path = self.folder / os.path.expanduser(self.name.strip())
        if self.saving and not path.suffix and not os.path.isdir(path):
            return path.with_name(path.name + self.suffixes[0])
        return path

    def entries(self) -> list[tuple[str, bool]]:
        """Folders, then files that are meant, each with whether it is a folder; none if unreadable."""
        try:
            found = [(entry.name, entry.is_dir()) for entry in self.folder.iterdir()]
        except OSError:
            return []
        shown = [
            (name, is_folder)
            for name, is_folder in found
            if not name.startswith(".") and (is_folder or Path(name).suffix.lower() in self.suffixes)
        ]
        return sorted(shown, key=lambda entry: (not entry[1], entry[0].lower()))


@dataclass
class Workspace:
    """The state of the window; panels show it and commands change it.

    notice: a sentence for the status bar that goes with the next edit; error: one that must be read first.
    """

    editor: Editor = field(default_factory=Editor)
    show_mesh: bool = False
    show_pins: bool = True
    checker: bool = True
    notice: str = ""
    error: str = ""
    about: bool = False
    keys: bool = False
    closing: bool = False
    question: Question | None = None
    request: FileRequest | None = None
    folder: Path = field(default_factory=Path.cwd)
    exporter: OffscreenRenderer = field(default_factory=OffscreenRenderer)
    _jobs: list[Callable[[], None]] = field(default_factory=list)
    _due: list[Callable[[], None]] = field(default_factory=list)
    _measured: tuple[Floats, Distortion] | None = None

    # -- work that may fail ----------------------------------------------------------------------------------

    def later(self, job: Callable[[], None], notice: str = "") -> None:
        """Do ``job`` once a whole frame has been drawn, so that ``notice`` is seen while it runs."""
        self.notice = notice or self.notice
        self._jobs.append(job)

    @property
    def waiting(self) -> bool:
        """Whether there is work left."""
        return bool(self._jobs or self._due)

    def work(self) -> bool:
        """After a frame: do what was put off before it began; whether there was anything."""
        jobs, self._due, self._jobs = self._due, self._jobs, []
        for job in jobs:
            self.attempt(job)
        return bool(jobs)

    def attempt(self, job: Callable[[], object]) -> bool:
        """Run ``job``; what it raises on purpose becomes a message, and everything open stays as it was."""
        try:
            job()
        except AkapError as error:
            self.notice, self.error = "", str(error)
            return False
        return True

    # -- files -----------------------------------------------------------------------------------------------

    @property
    def document(self) -> Document | None:
        """The open document."""
        return self.editor.session.document if self.editor.session is not None else None

    def show(self, document: Document) -> None:
        """Make a document the open one."""
        self.editor.open(document)
        opaque = document.path is None and not has_transparency(document.drawing.image)
        self.notice = (
            "This picture has no transparent background, so the whole rectangle bends" if opaque else ""
        )

    def open_path(self, path: Path) -> None:
        """Open a picture or a posed drawing, after asking about unsaved changes."""

        def read() -> None:
            self.show(open_document(path))
            self.folder = path.resolve().parent

        self.unless_unsaved(lambda: self.later(read, f"Opening {path.name} ..."))

    def unless_unsaved(self, go_on: Callable[[], None]) -> None:
        """Go on at once, or after the user has said what to do with unsaved changes."""
        if self.editor.modified:
            self.question = Question(go_on)
        else:
            go_on()

    def save(self, go_on: Callable[[], None] | None = None) -> None:
        """Write to the document's own file, or ask for one; then ``go_on``."""
        if self.document is None:
            return
        if self.document.path is None:
            self.save_as(go_on)
        else:
            self._write(self.document.path, go_on)

    def save_as(self, go_on: Callable[[], None] | None = None) -> None:
        """Ask for a file and write to it."""
        if self.document is None:
            return
        start = self.document.path or self.folder / f"{self.document.drawing.name}{PROJECT_SUFFIX}"
        self.request = FileRequest(
            "Save drawing",
            (PROJECT_SUFFIX,),
            start.resolve().parent,
            lambda path: self._write(path, go_on),
            start.name,
            saving=True,
        )

    def _write(self, path: Path, go_on: Callable[[], None] | None) -> None:
        def write() -> None:
            assert self.document is not None
            project_file.save(self.document, path)
            self.editor.mark_saved(path)
            self.folder = path.resolve().parent
            self.notice = f"Saved {path.name}"

        if self.attempt(write) and go_on is not None:
            go_on()

    def ask_open(self) -> None:
        """Ask for a picture or a posed drawing to open."""
        suffixes = (PROJECT_SUFFIX, *PICTURE_SUFFIXES)
        self.request = FileRequest("Open picture or drawing", suffixes, self.folder, self.open_path)

    def ask_export(self) -> None:
        """Ask where the pose goes as a transparent PNG."""
        if self.document is not None:
            name = f"{self.document.drawing.name}-posed.png"
            self.request = FileRequest(
                "Export picture", (".png",), self.folder, self.export_picture, name, saving=True
            )

    def export_picture(self, path: Path) -> None:
        """Write the pose as a PNG with alpha, at the picture's own resolution."""

        def export() -> None:
            assert self.document is not None
            picture = self.exporter.render(self.document.drawing, self.document.state.positions)
            write_png(path, picture)
            self.notice = f"Exported {path.name}, {picture.shape[1]} × {picture.shape[0]} pixels"

        self.later(export, f"Exporting {path.name} ...")

    def quit(self) -> None:
        """Close the window, after asking about unsaved changes."""

        def close() -> None:
            self.closing = True

        self.unless_unsaved(close)

    def measure(self) -> Distortion | None:
        """The distortion of the current pose, computed once for each pose."""
        if self.document is None:
            return None
        pose = self.document.state.positions
        if self._measured is None or self._measured[0] is not pose:
            self._measured = pose, distortion(self.document.drawing.mesh, pose)
        return self._measured[1]

    @property
    def title(self) -> str:
        """For the window's title bar."""
        if self.document is None:
            return "akap-editor"
        path = self.document.path
        name = path.name if path is not None else self.document.drawing.name
        return f"{name}{' *' if self.editor.modified else ''} - akap-editor"
