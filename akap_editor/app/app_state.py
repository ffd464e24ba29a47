"""What the window holds besides the drawing's own state: view switches, files, messages, questions."""

import traceback
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar

from ..editor import gestures
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
from ..render.overlays import Overlays
from .canvas.view_options import ViewOptions, onion_poses
from .jobs.background_thread import BackgroundThread, Wake, no_window
from .jobs.pose_export import PoseExportQueue
from .jobs.task import Task
from .preferences import Preferences
from .thumbnails import Thumbnails
from .timeline.timeline import Timeline

_VIEW_PREFERENCES = {"show_mesh": "show_mesh", "checker": "show_checkerboard"}  # preferences: view options

P = TypeVar("P")


def error_message(error: Exception) -> str:
    """The message of an exception on the screen; an unexpected one is also printed for a bug report."""
    if isinstance(error, AkapError):
        return str(error)
    traceback.print_exception(error)
    return (
        f"Something went wrong in the program ({type(error).__name__}: {error}). Your drawing is still open."
    )


@dataclass
class AppState:
    """The state of the window; panels show it and commands change it.

    notice: a sentence for the status bar that goes with the next edit; error: one that must be read first.
    """

    editor: Editor = field(default_factory=Editor)
    wake: Wake = no_window  # lets the window draw a frame; threads call it when they are done
    timeline: Timeline = field(init=False)
    task: Task | None = None
    comparison: MethodComparison = field(default_factory=MethodComparison)
    notice: str = ""
    error: str = ""
    closing: bool = False
    folder: Path = field(default_factory=Path.cwd)
    exporter: OffscreenRenderer = field(default_factory=OffscreenRenderer)
    writer: PoseExportQueue = field(init=False)
    thumbnails: Thumbnails = field(default_factory=Thumbnails)
    preferences: Preferences = field(default_factory=Preferences)
    autosave: Autosave | None = None
    view: ViewOptions = field(default_factory=ViewOptions)
    remesher: BackgroundRemesh = field(init=False)
    _jobs: list[Callable[[], None]] = field(default_factory=list)
    _due: list[Callable[[], None]] = field(default_factory=list)
    _measured: tuple[Floats, Distortion] | None = None
    _parts: dict[type, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.remesher = BackgroundRemesh(self.editor, BackgroundThread("mesh", self.wake))
        self.writer = PoseExportQueue(self.wake)
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

    # -- between runs ----------------------------------------------------------------------------------------

    @classmethod
    def remembering(cls, preferences: Preferences, wake: Wake = no_window) -> "AppState":
        """The state that the preferences remember; steps are computed in a thread."""
        editor = Editor(worker=BackgroundThread("engine", wake))
        state = cls(editor, wake, preferences=preferences, notice=preferences.problem)
        for name, option in _VIEW_PREFERENCES.items():
            setattr(state.view, option, preferences.get(name, getattr(state.view, option)))
        state.timeline.is_shown = preferences.get("show_timeline", False)
        state.view.restore(preferences.get("overlays", {}))
        if state.view.reference_path is not None:
            state.run_after_frame(state.view.reload_reference)
        brush: list[object] = preferences.get("brush", [])
        match brush:
            case [int() | float() as factor, int() | float() as radius]:
                state.editor.brush_tool.brush = Brush.within_limits(radius, factor)
        return state

    def remember(self) -> None:
        """Write what has changed to the preferences; if that fails, a notice says so once."""
        for name, option in _VIEW_PREFERENCES.items():
            self.preferences.put(name, getattr(self.view, option))
        self.preferences.put("show_timeline", self.timeline.is_shown)
        self.preferences.put("overlays", self.view.to_json())
        brush = self.editor.brush_tool.brush
        self.preferences.put("brush", [brush.factor, brush.radius])
        try:
            self.preferences.write()
        except InputError as error:
            self.notice = f"Couldn't save the preferences. {error}"

    # -- work that may fail ----------------------------------------------------------------------------------

    def run_after_frame(self, job: Callable[[], None], notice: str = "") -> None:
        """Do ``job`` once a whole frame has been drawn, so that ``notice`` is seen while it runs."""
        self.notice = notice or self.notice
        self._jobs.append(job)

    @property
    def needs_frame(self) -> bool:
        """Whether the next frame changes something without an event: deferred jobs, a task, playback."""
        task_can_go_on = self.task is not None and not self.task.progress.is_blocked
        return bool(self._jobs or self._due) or task_can_go_on or self.timeline.playback.is_playing

    @property
    def is_busy(self) -> bool:
        """Whether anything moves or is computed, be it in a thread; when it ends, the window is idle."""
        moves = self.editor.is_moving or self.comparison.is_moving or self.timeline.playback.is_playing
        computes = self.view.is_computing or self.remesher.is_busy or self.writer.is_busy
        return moves or computes or self.needs_frame or self.task is not None

    def run_pending(self) -> bool:
        """After a frame: do what was put off before it began; whether there was anything."""
        messages = self.notice, self.error
        jobs, self._due, self._jobs = self._due, self._jobs, []
        for job in jobs:
            self.run_reporting_errors(job)
        self.run_reporting_errors(self._go_on_writing)
        if self.task is not None:
            self.run_reporting_errors(self._go_on)
            return self.task is None or not self.task.progress.is_blocked
        has_changed = bool(jobs)
        try:
            has_changed |= self.remesher.advance()
        except Exception as error:  # no dialog in the middle of a drag
            self.notice = error_message(error)
        return has_changed or (self.notice, self.error) != messages

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
        """Run ``job``; an exception becomes a message, and everything open stays as it was."""
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

    def overlays(self, scale: float) -> Overlays:
        """What the renderer shows besides the drawing. scale: framebuffer pixels per point of the design."""
        distortion = self.measure() if self.view.distortion_measure is not None else None
        mesh = self.view.show_mesh or self.remesher.is_active
        overlays = self.view.overlays(self.editor, distortion, mesh, scale)
        if not self.timeline.shows_keyframes:
            return overlays
        return replace(overlays, onion_poses=onion_poses(*self.timeline.keyframe_playback.onion_poses()))

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
        return f"{name}{' *' if self.editor.is_modified else ''} - akap-editor"
