"""The state of the window: the editor, and what two or more of its dialogs, panels and jobs share."""

import math
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import Any, Protocol, TypeVar, runtime_checkable

from ..display_text import display_name
from ..editor import gestures
from ..editor.animation.loose_motion import LooseCanvas
from ..editor.background_remesh import BackgroundRemesh
from ..editor.comparison import MethodComparison
from ..editor.document.document import Document
from ..editor.document.settings import Settings
from ..editor.editor import Editor
from ..editor.tools.stiffness_brush import Brush
from ..errors import AkapError, InputError
from ..geometry.distortion import Distortion, distortion
from ..geometry.validation import Floats
from ..io.akap.autosave import Autosave
from ..render.offscreen import OffscreenRenderer
from ..words import tr, use_language
from .canvas.view_options import ViewOptions
from .jobs.background_thread import BackgroundThread, Wake, no_window
from .jobs.engine_preparation import EnginePreparation
from .jobs.pose_export import PoseExportQueue
from .jobs.task import Progress, Steps, Task
from .preferences import Preferences
from .thumbnails import Thumbnails
from .timeline.timeline import Timeline

_STORED_OPTIONS = {"show_mesh": "show_mesh", "checker": "show_checkerboard"}  # preference: view option

P = TypeVar("P")


def error_message(error: Exception) -> str:
    """The message of an exception on the screen; an unexpected one is also printed for a bug report."""
    if isinstance(error, AkapError):
        return str(error)
    traceback.print_exception(error)
    return tr(
        "Something went wrong in the program ({kind}: {error}). Your drawing is still open.",
        kind=type(error).__name__,
        error=error,
    )


@dataclass(frozen=True)
class NoticeButton:
    """A button in the status bar, shown as long as its notice is.

    label: English, for `tr`; icon: of it; run: what a click does.
    """

    notice: str
    label: str
    icon: str
    run: Callable[[], None]


@runtime_checkable
class WorkingPart(Protocol):
    """A part of the window that lets threads work for it."""

    def end_work(self) -> None:
        """End what is under way, without a result."""


@dataclass
class AppState:
    """What panels and dialogs show and commands change.

    editor: the open drawing; view: what is shown besides it; timeline: its playback; comparison: the second
    method in the split view; remesher: makes other meshes; engine: whether its machine code is there; wake:
    lets the window draw a frame, threads call it when they are done.

    notice: text in the status bar until the next edit; error: text that must be read before anything else;
    task: the work whose progress a dialog shows; pose_exports: exports in the background; is_closing: whether
    the window is about to close; panels_are_hidden: whether only canvas and menus are shown; is_full_screen:
    whether the window is to cover its monitor; notice_button: what can be done about a notice; frame_delay:
    seconds until a frame is due because something on the screen moves by itself.

    folder: where the next file dialog starts; preferences: what is stored between runs; autosave: keeps
    recovery copies, None for none; offscreen_renderer, thumbnails: share the window's OpenGL context.
    """

    editor: Editor = field(default_factory=Editor)
    wake: Wake = no_window
    view: ViewOptions = field(default_factory=ViewOptions)
    timeline: Timeline = field(init=False)
    comparison: MethodComparison = field(default_factory=MethodComparison)
    remesher: BackgroundRemesh = field(init=False)
    engine: EnginePreparation = field(default_factory=EnginePreparation)
    notice: str = ""
    error: str = ""
    task: Task | None = None
    pose_exports: PoseExportQueue = field(init=False)
    is_closing: bool = False
    panels_are_hidden: bool = False
    is_full_screen: bool = False
    notice_button: NoticeButton | None = None
    frame_delay: float = math.inf
    folder: Path = field(default_factory=Path.cwd)
    preferences: Preferences = field(default_factory=Preferences)
    autosave: Autosave | None = None
    offscreen_renderer: OffscreenRenderer = field(default_factory=OffscreenRenderer)
    thumbnails: Thumbnails = field(default_factory=Thumbnails)
    _new_jobs: list[Callable[[], None]] = field(default_factory=list)
    _due_jobs: list[Callable[[], None]] = field(default_factory=list)
    loose_canvas: LooseCanvas = field(default_factory=lambda: LooseCanvas(monotonic))
    _measured: tuple[Floats, Distortion] | None = None
    _parts: dict[type, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.remesher = BackgroundRemesh(self.editor, BackgroundThread("mesh", self.wake), self.wake)
        self.pose_exports = PoseExportQueue(self.wake)
        self.timeline = Timeline(self.editor)

    def part(self, kind: type[P]) -> P:
        """The window's one dialog, panel or other part of a class, made on first use."""
        if kind not in self._parts:
            self._parts[kind] = kind()
        part: P = self._parts[kind]
        return part

    def reset_part(self, kind: type[object]) -> None:
        """Forget a part; the next use makes it anew, for example a dialog that is closed."""
        self._parts.pop(kind, None)

    # -- preferences -----------------------------------------------------------------------------------------

    @classmethod
    def from_preferences(
        cls, preferences: Preferences, wake: Wake = no_window, engine: EnginePreparation | None = None
    ) -> "AppState":
        """The state as it was stored, in the chosen language; a thread computes the solver's steps."""
        use_language(preferences.language)
        editor = Editor(worker=BackgroundThread("engine", wake))
        engine = engine or EnginePreparation()
        engine.wake = wake
        state = cls(editor, wake, engine=engine, preferences=preferences, notice=preferences.problem)
        for name, option in _STORED_OPTIONS.items():
            setattr(state.view, option, preferences.get(name, getattr(state.view, option)))
        state.timeline.is_shown = preferences.get("show_timeline", False)
        state.view.restore(preferences.get("overlays", {}))
        if state.view.reference_path is not None:
            state.run_after_frame(state.view.reload_reference)
        state.editor.brush_tool.brush = Brush.restored(preferences.get("brush", []))
        return state

    def save_preferences(self) -> None:
        """Write the preferences if they have changed; an error becomes a notice, once."""
        for name, option in _STORED_OPTIONS.items():
            self.preferences.put(name, getattr(self.view, option))
        self.preferences.put("show_timeline", self.timeline.is_shown)
        self.preferences.put("overlays", self.view.to_json())
        self.preferences.put("brush", self.editor.brush_tool.brush.to_json())
        try:
            self.preferences.write()
        except InputError as error:
            self.notice = str(error)

    # -- work ------------------------------------------------------------------------------------------------

    @property
    def needs_frame(self) -> bool:
        """Whether the next frame changes something without an event: deferred jobs, a task, playback."""
        can_task_advance = self.task is not None and not self.task.progress.is_blocked
        is_moving = self.timeline.playback.is_playing or self.loose_canvas.is_moving
        return bool(self._new_jobs or self._due_jobs) or can_task_advance or is_moving

    @property
    def is_waiting(self) -> bool:
        """Whether what is going on must end before anything can be edited or any command be run."""
        return bool(self._new_jobs or self._due_jobs) or (self.task is not None and self.task.is_blocking)

    @property
    def is_canvas_waiting(self) -> bool:
        """Whether the canvas takes no input: `is_waiting`, or another mesh is being made."""
        return self.is_waiting or self.remesher.is_busy

    @property
    def is_busy(self) -> bool:
        """Whether anything moves or is computed, be it in a thread; when it ends, the window is idle."""
        is_moving = self.editor.is_moving or self.comparison.is_moving or self.timeline.playback.is_playing
        is_computing = self.view.is_computing or self.remesher.is_busy or self.pose_exports.is_busy
        return is_moving or is_computing or self.needs_frame or self.task is not None

    def begin_task(self, task: Task) -> None:
        """Begin long work; it ends the one that is under way."""
        if self.task is not None:
            self.task.cancel()
        self.task = task

    def end_work(self) -> None:
        """End all that is under way, before the state is dropped: a thread that waits for more would stay."""
        if self.task is not None:
            self.task.cancel()
            self.task = None
        for part in self._parts.values():
            if isinstance(part, WorkingPart):
                part.end_work()

    def run_after_frame(self, job: Callable[[], None], notice: str = "") -> None:
        """Run ``job`` after the next whole frame, which shows ``notice``."""
        self.notice = notice or self.notice
        self._new_jobs.append(job)

    def run_pending(self) -> bool:
        """Run what is due after a frame: jobs, exports, task, remeshing; return whether anything changed."""
        messages = self.notice, self.error
        jobs, self._due_jobs, self._new_jobs = self._due_jobs, self._new_jobs, []
        for job in jobs:
            self.run_reporting_errors(job)
        self.run_reporting_errors(self._advance_exports)
        if self.task is not None:
            self.run_reporting_errors(self._advance_task)
            return self.task is None or not self.task.progress.is_blocked
        has_changed = bool(jobs) | self._advance_remesh()
        if self.remesher.is_busy and not self.remesher.is_dragging:
            self.begin_task(
                Task(tr("Making the mesh"), self._remesh_steps(), is_shown_late=True, blocks_at_once=False)
            )
        return has_changed or (self.notice, self.error) != messages

    def _advance_exports(self) -> None:
        self.notice = self.pose_exports.advance(self.offscreen_renderer) or self.notice

    def _advance_remesh(self) -> bool:
        """Start or take over a mesh; whether the drawing changed."""
        try:
            return self.remesher.advance()
        except Exception as error:  # a dialog would interrupt the drag of a slider
            self.notice = error_message(error)
            return False

    def _remesh_steps(self) -> Steps:
        """Wait for the mesh, unless its slider is dragged again; the end before that cancels it."""
        try:
            while self.remesher.is_busy and not self.remesher.is_dragging:
                yield Progress(*self.remesher.progress, is_blocked=True)
                self._advance_remesh()
        except GeneratorExit:
            self.remesher.cancel()
            raise

    def _advance_task(self) -> None:
        """Run a slice of the task, which is dropped when it is done or raises an exception."""
        task, self.task = self.task, None
        assert task is not None
        if not task.advance():
            self.task = task

    def run_reporting_errors(self, job: Callable[[], object]) -> bool:
        """Run ``job`` and show an exception as a message; return whether there was none."""
        try:
            job()
        except Exception as error:
            self.notice, self.error = "", error_message(error)
            return False
        return True

    # -- the document ----------------------------------------------------------------------------------------

    @property
    def document(self) -> Document | None:
        """The open document."""
        return self.editor.session.document if self.editor.session is not None else None

    @property
    def title(self) -> str:
        """The title of the window; an asterisk marks unsaved changes."""
        if self.document is None:
            return "akap-editor"
        path = self.document.path
        name = display_name(path) if path is not None else self.document.drawing.name
        return f"{name}{' *' if self.editor.is_modified else ''} - akap-editor"

    def change_settings(self, settings: Settings) -> None:
        """Change method and parameters, for new drawings too. Raises InputError for invalid ones."""
        gestures.set_settings(self.editor, settings)
        values = {"method": settings.method, "parameters": dict(settings.parameters)}
        self.preferences.put("settings", values)

    def preferred_settings(self) -> Settings | None:
        """The settings of the last change, in this run or an earlier one."""
        match self.preferences.get("settings", {}):
            case {"method": str(method), "parameters": dict(parameters)}:
                return Settings(method, tuple(sorted(parameters.items())))
        return None

    def measure_distortion(self) -> Distortion | None:
        """The distortion of the current pose, computed once for each pose."""
        if self.document is None:
            return None
        pose = self.document.state.positions
        if self._measured is None or self._measured[0] is not pose:
            self._measured = pose, distortion(self.document.drawing.mesh, pose)
        return self._measured[1]
