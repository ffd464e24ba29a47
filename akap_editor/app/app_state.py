"""What the window holds besides the drawing's own state: view switches, files, messages, questions."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

from ..editor import gestures
from ..editor.animation.pose_blend import PoseBlend
from ..editor.background_remesh import BackgroundRemesh
from ..editor.comparison import MethodComparison
from ..editor.document.document import Document
from ..editor.document.settings import Settings
from ..editor.editor import Editor
from ..editor.tools.stiffness_brush import Brush
from ..errors import AkapError, InputError
from ..geometry.distortion import Distortion, distortion
from ..geometry.validation import Floats
from ..io.akap.autosave import Autosave, RecoveryCopy
from ..render.offscreen import OffscreenRenderer
from ..render.overlays import Overlays
from .canvas.view_options import ViewOptions, skins
from .dialogs.file_dialog import FileRequest, Palette, UnsavedChangesQuestion
from .jobs.pose_export import PoseExportQueue
from .jobs.task import Task
from .panels.measurements import Measurements
from .pending_values import PendingValues
from .preferences import Preferences
from .timeline.timeline import Timeline

SWITCHES = ("show_mesh", "checker")  # fields that are remembered between runs

D = TypeVar("D")


@dataclass
class AppState:
    """The state of the window; panels show it and commands change it.

    notice: a sentence for the status bar that goes with the next edit; error: one that must be read first.
    """

    editor: Editor = field(default_factory=lambda: Editor(worker=ThreadPoolExecutor(1, "engine")))
    show_mesh: bool = False
    show_pins: bool = True
    timeline: Timeline = field(init=False)
    pose_blend: PoseBlend = field(default_factory=PoseBlend)
    grip: Literal["start", "end", "head", "keys", "none"] = "head"  # what the pointer holds of the timeline
    held_key: float = 0.0  # the time of the keyframe that it holds
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
        self.timeline = Timeline(self.editor)

    def dialog(self, kind: type[D]) -> D:
        """The window's one dialog of a class, made on first use; it keeps its state while it is closed."""
        if kind not in self._dialogs:
            self._dialogs[kind] = kind()
        dialog: D = self._dialogs[kind]
        return dialog

    # -- between runs ----------------------------------------------------------------------------------------

    @classmethod
    def remembering(cls, preferences: Preferences) -> "AppState":
        """As it was left the last time."""
        state = cls(preferences=preferences, notice=preferences.problem)
        state.first_steps = preferences.is_kept and not preferences.get("first steps done", False)
        for name in SWITCHES:
            setattr(state, name, preferences.get(name, getattr(state, name)))
        state.timeline.is_shown = preferences.get("show_timeline", False)
        state.view.recall(preferences.get("overlays", {}))
        if state.view.reference_path is not None:
            state.run_after_frame(state.view.read_reference_again)
        brush: list[object] = preferences.get("brush", [])
        match brush:
            case [int() | float() as factor, int() | float() as radius]:
                state.editor.brush_tool.brush = Brush.within_limits(radius, factor)
        return state

    def remember(self) -> None:
        """Write what has changed to the preferences; if that fails, a notice says so once."""
        for name in SWITCHES:
            self.preferences.put(name, getattr(self, name))
        self.preferences.put("show_timeline", self.timeline.is_shown)
        self.preferences.put("overlays", self.view.kept())
        brush = self.editor.brush_tool.brush
        self.preferences.put("brush", [brush.factor, brush.radius])
        try:
            self.preferences.write()
        except InputError as error:
            self.notice = f"Not remembered for the next time: {error}"

    # -- work that may fail ----------------------------------------------------------------------------------

    def run_after_frame(self, job: Callable[[], None], notice: str = "") -> None:
        """Do ``job`` once a whole frame has been drawn, so that ``notice`` is seen while it runs."""
        self.notice = notice or self.notice
        self._jobs.append(job)

    @property
    def waiting(self) -> bool:
        """Whether there is work left."""
        return bool(self._jobs or self._due) or self.remesher.busy or self.task is not None

    def run_pending(self) -> bool:
        """After a frame: do what was put off before it began; whether there was anything."""
        jobs, self._due, self._jobs = self._due, self._jobs, []
        for job in jobs:
            self.run_reporting_errors(job)
        if self.writer.moving and not self.writer.waiting:
            self.run_reporting_errors(self._go_on_writing)
        if self.task is not None:
            self.run_reporting_errors(self._go_on)
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

    def run_reporting_errors(self, job: Callable[[], object]) -> bool:
        """Run ``job``; what it raises on purpose becomes a message, and everything open stays as it was."""
        try:
            job()
        except AkapError as error:
            self.notice, self.error = "", str(error)
            return False
        return True

    # -- the document ----------------------------------------------------------------------------------------

    @property
    def document(self) -> Document | None:
        """The open document."""
        return self.editor.session.document if self.editor.session is not None else None

    def change_settings(self, settings: Settings) -> None:
        """Deform with other settings from now on, in new drawings too. Raises InputError for invalid ones."""
        gestures.set_settings(self.editor, settings)
        values = {"method": settings.method, "parameters": dict(settings.parameters)}
        self.preferences.put("settings", values)

    def preferred_settings(self) -> Settings | None:
        """The settings of the last change, in this run or an earlier one."""
        match self.preferences.get("settings", {}):
            case {"method": str(method), "parameters": dict(parameters)}:
                return Settings(method, tuple(sorted(parameters.items())))
        return None

    @property
    def _motions(self) -> tuple[tuple[bool, bool], ...]:
        """Of all that may move: whether it does, and whether it only waits for its thread."""
        parts = (self.editor, self.comparison, self.view, self.writer)
        return *((part.moving, part.waiting) for part in parts), (self.timeline.playback.playing, False)

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
        if not self.timeline.shows_keyframes:
            return overlays
        return replace(overlays, skins=skins(*self.timeline.keyframe_playback.neighbors()))

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
