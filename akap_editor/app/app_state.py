"""What the window holds besides the drawing's own state: view switches, files, messages, questions."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Literal, TypeVar

from ..editor import gestures
from ..editor.animation.keyframe_playback import KeyframePlayback
from ..editor.animation.playback import Playback
from ..editor.animation.pose_blend import PoseBlend
from ..editor.animation.session_playback import SessionPlayback
from ..editor.background_remesh import BackgroundRemesh
from ..editor.comparison import MethodComparison
from ..editor.document.document import Document
from ..editor.document.settings import Settings
from ..editor.editor import Editor
from ..editor.session.session import Session
from ..editor.tools.stiffness_brush import Brush
from ..errors import AkapError, InputError
from ..geometry.distortion import Distortion, distortion
from ..geometry.validation import Floats
from ..io.akap.autosave import Autosave, RecoveryCopy
from ..io.akap.project import save
from ..io.akap.recording import RECORDING_SUFFIX
from ..io.images import has_transparency, is_animation
from ..io.open_document import MESH_SUFFIXES, PICTURE_SUFFIXES, PROJECT_SUFFIX, open_document
from ..render.offscreen import OffscreenRenderer
from ..render.overlays import Overlays
from ..resources import bundled_drawings
from .canvas.view_options import ViewOptions, skins
from .dialogs.file_dialog import FileRequest, Palette, UnsavedChangesQuestion
from .jobs.open_recording import reenacting
from .jobs.pose_export import PoseExportQueue
from .jobs.task import Task
from .panels.measurements import Measurements
from .pending_values import PendingValues
from .preferences import Preferences

SWITCHES = ("show_mesh", "checker", "show_timeline")  # fields that are remembered between runs

D = TypeVar("D")


@dataclass
class AppState:
    """The state of the window; panels show it and commands change it.

    notice: a sentence for the status bar that goes with the next edit; error: one that must be read first.
    """

    editor: Editor = field(default_factory=lambda: Editor(worker=ThreadPoolExecutor(1, "engine")))
    show_mesh: bool = False
    show_pins: bool = True
    show_timeline: bool = False
    session_playback: SessionPlayback = field(default_factory=SessionPlayback)
    pose_blend: PoseBlend = field(default_factory=PoseBlend)
    keyframe_playback: KeyframePlayback = field(init=False)
    timeline: Literal["session", "keyframes"] = "session"  # which of the two the timeline shows
    grip: Literal["start", "end", "head", "keys", "none"] = "head"  # what the pointer holds of the timeline
    held_key: float = 0.0  # the time of the keyframe that it holds
    key_menu: bool = False  # whether a key asks for the menu of a keyframe
    task: Task | None = None
    renaming: str | None = None  # the pose that is given another name
    new_name: str = ""
    checker: bool = True
    split: bool = False
    comparison: MethodComparison = field(default_factory=MethodComparison)
    notice: str = ""
    error: str = ""
    about: bool = False
    keys: bool = False
    closing: bool = False
    question: UnsavedChangesQuestion | None = None
    request: FileRequest | None = None
    palette: Palette | None = None
    folder: Path = field(default_factory=Path.cwd)
    exporter: OffscreenRenderer = field(default_factory=OffscreenRenderer)
    writer: PoseExportQueue = field(default_factory=PoseExportQueue)
    preferences: Preferences = field(default_factory=Preferences)
    autosave: Autosave | None = None
    lost: list[RecoveryCopy] = field(default_factory=list)  # unsaved work of programs that crashed
    pending_values: PendingValues = field(default_factory=PendingValues)
    view: ViewOptions = field(default_factory=ViewOptions)
    measurements: Measurements = field(default_factory=Measurements)
    first_steps: bool = False  # whether newcomers are shown how to begin
    steps_taken: int = 0  # of these
    remesher: BackgroundRemesh = field(init=False)
    _jobs: list[Callable[[], None]] = field(default_factory=list)
    _due: list[Callable[[], None]] = field(default_factory=list)
    _measured: tuple[Floats, Distortion] | None = None
    _dialogs: dict[type, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.remesher = BackgroundRemesh(self.editor)
        self.keyframe_playback = KeyframePlayback(self.editor)

    def dialog(self, kind: type[D]) -> D:
        """The window's one dialog of a class, made on first use; it keeps its state while it is closed."""
        if kind not in self._dialogs:
            self._dialogs[kind] = kind()
        dialog: D = self._dialogs[kind]
        return dialog

    @property
    def playback(self) -> Playback:
        """What the timeline plays."""
        return self.keyframe_playback if self.timeline == "keyframes" else self.session_playback

    def show_in_timeline(self, timeline: Literal["session", "keyframes"]) -> None:
        """Look at the other one; of what was shown nothing is seen any more."""
        if timeline != self.timeline:
            self.show_present()
            self.timeline = timeline

    def show_present(self) -> None:
        """Of what the timeline shows nothing is seen any more."""
        if self.session_playback.at is not None:
            self.session_playback.now()
        if self.keyframe_playback.following:
            self.keyframe_playback.leave()

    # -- between runs ----------------------------------------------------------------------------------------

    @classmethod
    def remembering(cls, preferences: Preferences) -> "AppState":
        """As it was left the last time."""
        state = cls(preferences=preferences, notice=preferences.problem)
        state.first_steps = preferences.is_kept and not preferences.get("first steps done", False)
        for name in SWITCHES:
            setattr(state, name, preferences.get(name, getattr(state, name)))
        state.view.recall(preferences.get("overlays", {}))
        if state.view.reference_path is not None:
            state.later(state.view.read_reference_again)
        brush: list[object] = preferences.get("brush", [])
        match brush:
            case [int() | float() as factor, int() | float() as radius]:
                state.editor.brush = Brush.of(radius, factor)
        return state

    def remember(self) -> None:
        """Write what has changed to the preferences; if that fails, a notice says so once."""
        for name in SWITCHES:
            self.preferences.put(name, getattr(self, name))
        self.preferences.put("overlays", self.view.kept())
        self.preferences.put("brush", [self.editor.brush.factor, self.editor.brush.radius])
        try:
            self.preferences.write()
        except InputError as error:
            self.notice = f"Not remembered for the next time: {error}"

    # -- work that may fail ----------------------------------------------------------------------------------

    def later(self, job: Callable[[], None], notice: str = "") -> None:
        """Do ``job`` once a whole frame has been drawn, so that ``notice`` is seen while it runs."""
        self.notice = notice or self.notice
        self._jobs.append(job)

    @property
    def waiting(self) -> bool:
        """Whether there is work left."""
        return bool(self._jobs or self._due) or self.remesher.busy or self.task is not None

    def work(self) -> bool:
        """After a frame: do what was put off before it began; whether there was anything."""
        jobs, self._due, self._jobs = self._due, self._jobs, []
        for job in jobs:
            self.attempt(job)
        if self.writer.moving and not self.writer.waiting:
            self.attempt(self._go_on_writing)
        if self.task is not None:
            self.attempt(self._go_on)
            return True
        try:
            return self.remesher.advance() or bool(jobs)
        except InputError as error:  # no dialog in the middle of a drag
            self.notice = str(error)
            return True

    def _go_on_writing(self) -> None:
        self.notice = self.writer.advance(self.exporter) or self.notice

    def _go_on(self) -> None:
        """A slice of the task."""
        task = self.task
        assert task is not None
        self.task = None  # where it fails, there is none
        if not task.advance():
            self.task = task

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
        """Make a document the open one. A new drawing bends as was chosen last."""
        chosen = self._chosen_settings() if document.state.settings == Settings() else None
        try:
            preferred = replace(document.state, settings=chosen or document.state.settings)
            self.editor.open(document if chosen is None or document.path else document.with_state(preferred))
        except InputError:
            self.editor.open(document)
        if document.state.animation.keyframes:
            self.timeline, self.show_timeline = "keyframes", True
        opaque = document.path is None and not has_transparency(document.drawing.image)
        self.notice = (
            "This picture has no transparent background, so the whole rectangle bends; "
            "Mesh, at the right, can remove it"
            if opaque
            else ""
        )

    def change_settings(self, settings: Settings) -> None:
        """Bend differently from now on, new drawings too. Raises InputError on what no method knows."""
        gestures.set_settings(self.editor, settings)
        values = {"method": settings.method, "parameters": dict(settings.parameters)}
        self.preferences.put("settings", values)

    def _chosen_settings(self) -> Settings | None:
        """Those of the last change, of this run or one before."""
        match self.preferences.get("settings", {}):
            case {"method": str(method), "parameters": dict(parameters)}:
                return Settings(method, tuple(sorted(parameters.items())))
        return None

    def open_dropped(self, paths: list[Path]) -> None:
        """Open the first of the files that were dropped on the window."""
        several = f"Opened {paths[0].name}, the first of {len(paths)} files" if len(paths) > 1 else ""
        self.open_path(paths[0], several)

    def open_path(self, path: Path, notice: str = "") -> None:
        """Open a picture or a posed drawing, after asking about unsaved changes; then show ``notice``."""

        def read() -> None:
            try:
                if path.suffix.lower() == RECORDING_SUFFIX:
                    self.task = reenacting(path, partial(self._go_on_with, path))
                    return
                document = open_document(path)
            except InputError:
                self.preferences.forget(path)
                raise
            self.show(document)
            if is_animation(path):
                self.notice = f"{path.name} is an animation; its first frame was opened"
            self.used(path)
            self.notice = notice or self.notice

        self.unless_unsaved(lambda: self.later(read, f"Opening {path.name} ..."))

    def _go_on_with(self, path: Path, session: Session, playback: SessionPlayback) -> None:
        """Show a recording that was done again; the timeline holds all of it."""
        session.mark_saved(None)
        self.editor.take_over(session)
        self.session_playback, self.timeline, self.show_timeline = playback, "session", True
        self.used(path)
        self.notice = f"Opened {path.name}: {playback.duration:.0f} seconds are on the timeline"

    def used(self, path: Path) -> None:
        """A file was opened or saved: the next dialog begins there, and it can be found again."""
        self.folder = path.resolve().parent
        if path.resolve() not in map(Path.resolve, bundled_drawings()):
            self.preferences.opened(path)

    def unless_unsaved(self, go_on: Callable[[], None]) -> None:
        """Go on at once, or after the user has said what to do with unsaved changes."""
        if self.editor.modified:
            self.question = UnsavedChangesQuestion(go_on)
        else:
            go_on()

    def protect(self) -> None:
        """See to it that unsaved work would survive a crash; called all the time."""
        session = self.editor.session
        if self.autosave is None:
            return
        try:
            last = session.history.last if session is not None else None
            kept = session.present_document if session is not None else None
            self.autosave.watch(kept, self.editor.modified, last)
        except InputError as error:
            self.notice = str(error)

    def rescue(self) -> None:
        """The program is about to end by mistake: keep what is not saved, if that is still possible."""
        session = self.editor.session
        if self.autosave is not None and session is not None and self.editor.modified:
            self.attempt(partial(self.autosave.rescue, session.present_document))

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
            assert self.editor.session is not None
            save(self.editor.session.present_document, path)
            self.editor.mark_saved(path)
            self.used(path)
            self.notice = f"Saved {path.name}"

        if self.attempt(write) and go_on is not None:
            go_on()

    def ask_open(self) -> None:
        """Ask for a picture or a posed drawing to open."""
        suffixes = (PROJECT_SUFFIX, RECORDING_SUFFIX, *PICTURE_SUFFIXES, *MESH_SUFFIXES)
        self.request = FileRequest("Open picture or drawing", suffixes, self.folder, self.open_path)

    def close(self) -> None:
        """Go to the start page, after asking about unsaved changes."""

        def close() -> None:
            self.editor.close()
            self.notice = ""

        self.unless_unsaved(close)

    def quit(self) -> None:
        """Close the window, after asking about unsaved changes."""

        def close() -> None:
            self.closing = True

        self.unless_unsaved(close)

    @property
    def _motions(self) -> tuple[tuple[bool, bool], ...]:
        """Of all that may move: whether it does, and whether it only waits for its thread."""
        parts = (self.editor, self.comparison, self.view, self.writer)
        return *((part.moving, part.waiting) for part in parts), (self.playback.playing, False)

    @property
    def moving(self) -> bool:
        """Whether anything that is seen has not come to rest."""
        return any(moves for moves, _ in self._motions)

    @property
    def stalled(self) -> bool:
        """Whether nothing new can be seen before a thread is done with what it computes or writes."""
        return self.moving and all(waits for moves, waits in self._motions if moves)

    def overlays(self, scale: float) -> Overlays:
        """What the renderer shows besides the drawing. scale: framebuffer pixels per point of the design."""
        distortion = self.measure() if self.view.heat is not None else None
        mesh = self.show_mesh or self.remesher.active
        overlays = self.view.overlays(self.editor, distortion, mesh, scale)
        if self.timeline == "session" or not self.show_timeline:
            return overlays
        return replace(overlays, skins=skins(*self.keyframe_playback.neighbors()))

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
