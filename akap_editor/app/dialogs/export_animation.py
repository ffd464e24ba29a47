"""The dialog that exports the played range of the timeline as an animation."""

from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from imgui_bundle import ImVec2, imgui

from ...editor.animation.motion import Frame, closed, frame_times
from ...editor.document.easing import EASINGS
from ...editor.document.framing import Color, frame_box, output_size, union_of_boxes
from ...io.animation.frames import export_frames, export_kind
from .. import widgets
from ..app_state import AppState
from ..jobs.frame_encoder import Encoder
from ..jobs.task import Progress, Steps, Task
from ..preferences import Preferences
from .export_widgets import LABEL_WIDTH, background_field, format_list, number_field, preset_buttons
from .file_dialog import FileRequest

PREFERENCE = "animation"  # name of the stored options

EASING_LABELS = {
    "none": "Steady",
    "in": "Slow start",
    "out": "Slow end",
    "in-out": "Slow start and end",
    "hold": "Hold, then jump",
}
_WIDTH, _HEIGHT, _LIST_WIDTH = 600, 292, 190  # design points


@dataclass(frozen=True)
class AnimationFormat:
    """label, suffix: what it is called and how its names end, nothing for a folder; about: for people;
    transparent: whether it can be; repeats: whether it says how often it is shown; sheet: of sprites.
    """

    label: str
    suffix: str
    about: str
    transparent: bool = True
    repeats: bool = False
    sheet: bool = False


FORMATS = (
    AnimationFormat("WebP", ".webp", "An animation for the web: all colors, soft rims, small.", repeats=True),
    AnimationFormat("GIF", ".gif", "An animation for everywhere: 255 colors, hard rims.", repeats=True),
    AnimationFormat("APNG", ".apng", "An animation: all colors, soft rims, large.", repeats=True),
    AnimationFormat("MP4", ".mp4", "A video (H.264), without transparency.", transparent=False),
    AnimationFormat("WebM", ".webm", "A video (VP9) that keeps transparency."),
    AnimationFormat("Pictures", "", "A folder with one PNG a frame."),
    AnimationFormat(
        "Sprite sheet", ".png", "One PNG with all frames, and a JSON index, for games.", sheet=True
    ),
)
RATES = (12, 24, 30, 60)
LIMITS = {"fps": (1.0, 120.0), "size": (16, 8192), "speed": (0.01, 100.0)}


@dataclass
class AnimationExportOptions:
    """Choices of the dialog.

    format: label of a format; fps: frames per second; size: longest side in pixels, at most; speed: 2 is
    twice as fast; ease: see `easing`; loop: repeat forever, else play once; ping_pong: forwards, then
    backwards; opaque: whether ``background`` is used.
    """

    format: str = FORMATS[0].label
    fps: float = 30.0
    size: int = 640
    speed: float = 1.0
    ease: str = "none"
    loop: bool = True
    ping_pong: bool = False
    opaque: bool = False
    background: Color = (1.0, 1.0, 1.0)

    @property
    def kind(self) -> AnimationFormat:
        """The chosen format."""
        return next(each for each in FORMATS if each.label == self.format)

    @property
    def behind(self) -> Color | None:
        """The color behind the drawing; None if it is transparent."""
        return self.background if self.opaque or not self.kind.transparent else None

    def times(self, start: float, end: float) -> list[float]:
        """Seconds on the timeline, for each frame."""
        times = frame_times(start, end, self.fps, self.speed, self.ease)
        return times + times[-2:0:-1] if self.ping_pong else times

    def remember(self, preferences: Preferences) -> None:
        """Store the options for the next time."""
        preferences.put(PREFERENCE, asdict(self))

    @classmethod
    def remembered(cls, preferences: Preferences) -> "AnimationExportOptions":
        """The stored options; a value that is missing or makes no sense is replaced by its default."""
        values: dict[str, Any] = preferences.get(PREFERENCE, {})
        options = cls()
        for name, default in asdict(options).items():
            value = values.get(name, default)
            if name in LIMITS and type(value) in (int, float):
                value = type(default)(min(max(value, LIMITS[name][0]), LIMITS[name][1]))
            if isinstance(value, list) and len(value) == 3 and all(type(each) is float for each in value):
                value = tuple(value)
            if type(value) is type(default):
                setattr(options, name, value)
        options.ease = options.ease if options.ease in EASINGS else "none"
        if options.format not in [each.label for each in FORMATS]:
            options.format = FORMATS[0].label
        return options


class ExportAnimationDialog:
    """Asks for a format and its options, then for a file. The preferences keep the options."""

    def __init__(self) -> None:
        self.is_open = False

    def open(self, state: AppState) -> None:
        """Show the dialog if there is a range to export; playback stops."""
        start, end = state.timeline.playback.range
        if state.document is not None and end > start:
            if state.timeline.playback.playing:
                state.timeline.playback.stop()
            self.is_open = True

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        start, end = state.timeline.playback.range
        if state.document is None or end <= start:
            self.is_open = False
            return
        if not widgets.begin_dialog("Export animation"):
            return
        options = AnimationExportOptions.remembered(state.preferences)
        options.format = format_list(FORMATS, options.kind, _LIST_WIDTH * scale, _HEIGHT * scale).label
        imgui.same_line(0, 18 * scale)
        size = ImVec2((_WIDTH - _LIST_WIDTH - 18) * scale, _HEIGHT * scale)
        imgui.begin_child("##options", size, widgets.NAV_FLATTENED)
        _draw_options(options, scale)
        _draw_result(state, options, scale)
        imgui.end_child()
        imgui.spacing()
        options.remember(state.preferences)
        accepted = widgets.button("Export...", primary=True)
        imgui.same_line()
        if widgets.button("Cancel") or widgets.cancel_pressed():
            self._close()
        elif accepted or (widgets.confirm_pressed() and not imgui.get_io().want_text_input):
            self._close()
            request_file(state, options)
        imgui.end_popup()

    def _close(self) -> None:
        self.is_open = False
        widgets.close_popup()


def frame_at(state: AppState, time: float) -> Frame:
    """The timeline's frame at a time in seconds."""
    keyed = state.timeline.mode == "keyframes"
    return (
        state.timeline.keyframe_playback.frame(time) if keyed else state.timeline.session_playback.frame(time)
    )


def exported_times(state: AppState, options: AnimationExportOptions) -> list[float]:
    """Seconds on the timeline, for each frame. In a seamless loop the last frame is dropped."""
    start, end = state.timeline.playback.range
    times = options.times(start, end)
    over = options.kind.repeats and options.loop and not options.ping_pong and len(times) > 2
    return times[:-1] if over and closed(frame_at(state, start), frame_at(state, end)) else times


def request_file(state: AppState, options: AnimationExportOptions) -> None:
    """Ask for the file or folder to write, then write it."""
    assert state.document is not None
    name = state.document.drawing.name + (options.kind.suffix or "-frames")
    if options.kind.sheet:
        name = f"{state.document.drawing.name}-sheet.png"
    use = partial(export_animation, state, options)
    suffixes = (options.kind.suffix,)
    state.request = FileRequest("Export animation", suffixes, state.folder, use, name, saving=True)


def export_animation(state: AppState, options: AnimationExportOptions, path: Path) -> None:
    """Write the played range of the timeline; the file name's ending decides on the format."""

    def begin() -> None:
        sheet = options.kind.sheet and path.suffix.lower() == ".png"
        export_kind(path, sheet)
        state.task = Task(f"Exporting {path.name}", _steps(state, options, path, sheet))

    state.run_after_frame(begin)


def _steps(state: AppState, options: AnimationExportOptions, path: Path, sheet: bool) -> Steps:
    """Compute the poses, then draw the pictures, which another thread encodes."""
    times = exported_times(state, options)
    frames = []
    for number, time in enumerate(times):
        frames.append(frame_at(state, time))
        yield Progress(0.3 * number / len(times), f"Moving, frame {number + 1} of {len(times)}")
    box = union_of_boxes([frame_box(frame.drawing, [frame.pose]) for frame in frames])
    scale = min(1.0, options.size / max(box[2] - box[0], box[3] - box[1]))
    output_size(box, scale)
    encoder = Encoder(
        partial(export_frames, path, fps=options.fps, plays=0 if options.loop else 1, sheet=sheet)
    )
    try:
        for number, frame in enumerate(frames):
            picture = state.exporter.render(*frame[:2], box, scale, options.behind, frame.order)
            share = 0.3 + 0.6 * number / len(frames)
            done = Progress(share, f"Drawing, frame {number + 1} of {len(frames)}")
            yield done
            for _ in encoder.take(picture):
                yield done
        for _ in encoder.finish():
            yield Progress(0.95, f"Writing {path.name}")
    finally:
        encoder.close()
    state.notice = f"Exported {path.name}, {len(frames)} frames, {encoder.said}"


def _draw_options(options: AnimationExportOptions, scale: float) -> None:
    """Draw what can be chosen about the format."""
    below = imgui.get_cursor_pos_y() + 2 * imgui.get_text_line_height()
    widgets.secondary_text(options.kind.about)
    imgui.set_cursor_pos_y(below + imgui.get_style().item_spacing.y)
    options.fps = number_field("Frame rate", options.fps, LIMITS["fps"], "%.4g fps", 0.2, 96, scale)
    preset = preset_buttons([f"{rate}" for rate in RATES], scale)
    if preset is not None:
        options.fps = float(RATES[preset])
    options.size = round(number_field("Size", options.size, LIMITS["size"], "%.0f px", 2.0, 96, scale))
    widgets.show_tooltip("Of the longest side, at most; a drawing is not enlarged.")
    low, high = LIMITS["speed"]
    percent = number_field("Speed", 100 * options.speed, (100 * low, 100 * high), "%.4g %%", 0.5, 96, scale)
    options.speed = percent / 100
    widgets.label("Easing", LABEL_WIDTH * scale)
    imgui.set_next_item_width(widgets.FULL)
    names = list(EASINGS)
    _, chosen = imgui.combo("##easing", names.index(options.ease), [EASING_LABELS[name] for name in names])
    options.ease = names[chosen]
    widgets.show_tooltip("Of the whole, on top of what keyframes do.")
    widgets.switch_label("Repeat", LABEL_WIDTH * scale)
    _, options.ping_pong = widgets.switch("Ping-pong", options.ping_pong, "Forwards, then backwards.")
    if options.kind.repeats:
        imgui.same_line(0, 16 * scale)
        imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
        _, options.loop = widgets.switch("For ever", options.loop, "Off: it is shown once, and stops.")
    options.opaque, options.background = background_field(
        options.opaque,
        options.background,
        not options.kind.transparent,
        "Without it, it is transparent.",
        scale,
    )


def _draw_result(state: AppState, options: AnimationExportOptions, scale: float) -> None:
    """Draw the number of frames and seconds."""
    count = len(exported_times(state, options))
    seconds = f"{count / options.fps:.1f}".removesuffix(".0")
    widgets.label("Makes", LABEL_WIDTH * scale)
    imgui.text(f"{count} frame{'s' * (count != 1)}, {seconds} s")
