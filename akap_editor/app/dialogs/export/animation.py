"""The dialog that exports the played range of the timeline as an animation."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from imgui_bundle import ImVec2, imgui

from ....display_text import display_name, file_stem
from ....editor.animation.frames import Frame, frame_times, loops_seamlessly, playing_order
from ....editor.document.easing import EASING_LABELS, EASINGS
from ....editor.framing import Box, Color, output_size
from ....errors import InputError
from ....io.animation.formats import (
    ANIMATION_FORMATS,
    AnimationFormat,
    animation_format,
    animation_shots,
    replaced_files,
    write_animation,
)
from ....io.outputs import is_source
from ....words import mark, number_text, tr, tr_plural
from ... import widgets
from ...app_state import AppState
from ...jobs.file_manager import folder_button
from ...jobs.frame_encoder import FrameEncoder
from ...jobs.task import Progress, Steps, Task
from ...preferences import Preferences
from ..file_dialog import FileDialog, FileRequest
from ..replace_files import ask_unless_new
from .animation_size import AnimationSize
from .fields import LABEL_WIDTH, background_field, format_list, number_field, preset_buttons
from .preview import AnimationPreview
from .size_estimate import SizeEstimate, WrittenAnimation, size_in_words

PREFERENCE = "animation"  # name of the stored options

DIALOG_FORMATS = tuple(each for each in ANIMATION_FORMATS if not each.is_still)
FRAME_RATES = (12, 24, 30, 60)
LIMITS = {"fps": (1.0, 120.0), "size": (16, 8192), "speed": (0.01, 100.0)}
_POSING_SHARE = 0.4  # of the time until the last frame is drawn
_WIDTH, _HEIGHT, _LIST_WIDTH = 600, 346, 190  # design points
_MIN_PREVIEW, _MARGINS, _ROOM_ABOVE_AND_BELOW = 160, 80, 104  # around all that is in the dialog

T = TypeVar("T")


@dataclass
class AnimationExportOptions:
    """Choices of the dialog.

    format: label of a format; fps: frames per second; size: longest side in pixels, at most; speed: 2 is
    twice as fast; ease: see `easing`; loop: repeat forever, else play once; ping_pong: forwards, then
    backwards; hover: a web page plays only under the pointer; opaque: whether ``background`` is used.
    """

    format: str = DIALOG_FORMATS[0].label
    fps: float = 30.0
    size: int = 640
    speed: float = 1.0
    ease: str = "none"
    loop: bool = True
    ping_pong: bool = False
    hover: bool = False
    opaque: bool = False
    background: Color = (1.0, 1.0, 1.0)

    @property
    def chosen_format(self) -> AnimationFormat:
        """The row of the table of formats."""
        return next(each for each in DIALOG_FORMATS if each.label == self.format)

    @property
    def plays(self) -> int:
        """How often the animation plays; 0 for forever."""
        return 0 if self.loop else 1

    @property
    def visible_background(self) -> Color | None:
        """The color behind the drawing; None for transparent."""
        return self.background if self.opaque or not self.chosen_format.has_transparency else None

    @property
    def written_fps(self) -> float:
        """Frames per second of the file: the rate that was chosen, or the highest of the format."""
        return min(self.fps, self.chosen_format.max_fps)

    def frame_times(self, start: float, end: float) -> list[float]:
        """Times on the timeline in seconds, one per frame, in ascending order."""
        return frame_times(start, end, self.written_fps, self.speed, self.ease)

    def playing_order(self, frames: Sequence[T], first: Frame, last: Frame) -> list[T]:
        """Frames, or their times, in the order in which they are shown. first, last: ends of the motion."""
        is_loop = self.loop and loops_seamlessly(first, last)
        return playing_order(frames, self.ping_pong, is_loop)

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
        if options.format not in [each.label for each in DIALOG_FORMATS]:
            options.format = DIALOG_FORMATS[0].label
        return options


class ExportAnimationDialog:
    """Asks for a format and its options, then for a file. The preferences keep the options."""

    def __init__(self) -> None:
        self.is_open = False
        self._size = AnimationSize()
        self._estimate = SizeEstimate()
        self._preview = AnimationPreview()

    def open(self, state: AppState) -> None:
        """Show the dialog if there is a range to export; playback stops. It loops if playback does."""
        playback = state.timeline.playback
        start, end = playback.played_range
        if state.document is not None and end > start:
            if playback.is_playing:
                playback.stop()
            options = AnimationExportOptions.remembered(state.preferences)
            replace(options, loop=playback.loop).remember(state.preferences)
            self.is_open = True

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        start, end = state.timeline.playback.played_range
        if state.document is None or end <= start:
            self.is_open = False
            self.end_work()
            return
        if not widgets.begin_dialog("Export animation"):
            return
        options = AnimationExportOptions.remembered(state.preferences)
        window = imgui.get_main_viewport().size
        height = min(_HEIGHT * scale, window.y - _ROOM_ABOVE_AND_BELOW * scale)
        width = _LIST_WIDTH * scale
        options.format = format_list(DIALOG_FORMATS, options.chosen_format, width, height).label
        imgui.same_line(0, 18 * scale)
        size = ImVec2((_WIDTH - _LIST_WIDTH - 18) * scale, height)
        imgui.begin_child("##options", size, widgets.NAV_FLATTENED)
        _draw_options(options, scale)
        times, framing, problem = _written_frames(state, options, self._size)
        animation = _written_animation(options, times, framing)
        size_in_bytes = None if animation is None else self._estimate.advance(state, animation)
        _draw_result(options, len(times), framing, problem, scale)
        _draw_file_size(size_in_bytes, self._estimate.is_rough, scale)
        imgui.end_child()
        side = min(height / scale, window.x / scale - _WIDTH - _MARGINS)
        if side >= _MIN_PREVIEW:
            imgui.same_line(0, 18 * scale)
            background = options.visible_background
            self._preview.draw(
                state, times, options.written_fps, framing, background, round(side * scale), scale
            )
        imgui.spacing()
        options.remember(state.preferences)
        accepted = widgets.button(tr("Export..."), primary=True)
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._close()
        elif accepted or (widgets.confirm_pressed() and not imgui.get_io().want_text_input):
            self._close()
            request_file(state, options)
        imgui.end_popup()

    def end_work(self) -> None:
        """End the estimate of the size."""
        self._estimate.close()

    def _close(self) -> None:
        self.is_open = False
        self.end_work()
        widgets.close_popup()


def frame_times_in_order(state: AppState, options: AnimationExportOptions) -> list[float]:
    """Times of the frames of an export with these options, seconds on the timeline, in playing order."""
    start, end = state.timeline.playback.played_range
    times = options.frame_times(start, end)
    return options.playing_order(times, state.timeline.frame(start), state.timeline.frame(end))


def request_file(state: AppState, options: AnimationExportOptions) -> None:
    """Ask for the file or folder to write, then write it."""
    assert state.document is not None
    name = file_stem(state.document.drawing.name) + (options.chosen_format.suffix or "-frames")
    if options.chosen_format.is_sheet:
        name = f"{file_stem(state.document.drawing.name)}-sheet.png"
    use = partial(export_animation, state, options)
    suffixes = (options.chosen_format.suffix,)
    state.part(FileDialog).ask(
        FileRequest(tr("Export animation"), suffixes, state.folder, use, name, saving=True)
    )


def export_animation(state: AppState, options: AnimationExportOptions, path: Path) -> None:
    """Write the played range of the timeline; the file name's ending decides on the format.

    Ask before files are replaced that the user did not name, or that the drawing was opened from.
    """
    sheet = options.chosen_format.is_sheet and path.suffix.lower() == ".png"

    def check() -> None:
        animation_format(path, sheet)  # raises InputError
        rename = partial(request_file, state, options)
        source = path if state.document is not None and is_source(path, state.document.sources) else None
        ask_unless_new(state, replaced_files(path, sheet), begin, rename, source)

    def begin() -> None:
        state.task = Task(
            tr("Exporting {file}", file=display_name(path)), _export_steps(state, options, path, sheet)
        )

    state.run_after_frame(check)


def _export_steps(state: AppState, options: AnimationExportOptions, path: Path, sheet: bool) -> Steps:
    """Compute the poses, then draw the pictures, which another thread encodes."""
    times = options.frame_times(*state.timeline.playback.played_range)
    chosen = animation_format(path, sheet)
    drawn = 1 - chosen.encoding_share
    posed = _POSING_SHARE * drawn
    frames = []
    for number, time in enumerate(times):
        frames.append(state.timeline.frame(time))
        yield Progress(
            posed * number / len(times),
            tr("Posing frame {number} of {count}", number=number + 1, count=len(times)),
        )
    frames = options.playing_order(frames, frames[0], frames[-1])
    shots = animation_shots(
        chosen, frames, state.offscreen_renderer, options.size, options.visible_background
    )
    export = partial(
        write_animation,
        path,
        fps=options.written_fps,
        plays=options.plays,
        sheet=sheet,
        overwrite=True,
        hover=options.hover and chosen.is_page,
    )
    encoder = FrameEncoder(export, state.wake)
    try:
        for number, shot in enumerate(shots):
            share = posed + (drawn - posed) * number / len(frames)
            progress = Progress(
                share, tr("Drawing frame {number} of {count}", number=number + 1, count=len(frames))
            )
            yield progress
            for _ in encoder.take(shot):
                yield progress._replace(is_blocked=True)
        for _ in encoder.finish():
            share = drawn + chosen.encoding_share * encoder.encoded
            yield Progress(share, tr("Encoding {file}", file=display_name(path)), is_blocked=True)
    finally:
        encoder.close()
    state.notice = tr_plural(
        "Exported {file}, {count} frame, {details}",
        "Exported {file}, {count} frames, {details}",
        len(frames),
        file=display_name(path),
        details=encoder.said,
    )
    state.notice_button = folder_button(state.notice, path)


def _draw_options(options: AnimationExportOptions, scale: float) -> None:
    """Draw the options of the chosen format."""
    below = imgui.get_cursor_pos_y() + 2 * imgui.get_text_line_height()
    widgets.secondary_text(tr(options.chosen_format.about))
    imgui.set_cursor_pos_y(below + imgui.get_style().item_spacing.y)
    options.fps = number_field(tr("Frame rate"), options.fps, LIMITS["fps"], "%.4g fps", 0.2, 96, scale)
    preset = preset_buttons([f"{rate}" for rate in FRAME_RATES], scale)
    if preset is not None:
        options.fps = float(FRAME_RATES[preset])
    tooltip = tr("The longest side, at most: drawings are not enlarged.")
    size = number_field(tr("Size"), options.size, LIMITS["size"], "%.0f px", 2.0, 96, scale, tooltip)
    options.size = round(size)
    low, high = LIMITS["speed"]
    percent = number_field(
        tr("Speed"), 100 * options.speed, (100 * low, 100 * high), "%.4g %%", 0.5, 96, scale
    )
    options.speed = percent / 100
    widgets.label(tr("Easing"), LABEL_WIDTH * scale)
    imgui.set_next_item_width(widgets.FULL)
    names = list(EASINGS)
    _, chosen = widgets.combo(
        "##easing", names.index(options.ease), [tr(EASING_LABELS[name]) for name in names]
    )
    options.ease = names[chosen]
    widgets.show_tooltip(tr("Easing of the whole animation, in addition to that of keyframes."))
    widgets.switch_label(tr("Playback"), LABEL_WIDTH * scale)
    _, options.ping_pong = widgets.switch(
        tr("Ping-pong"), options.ping_pong, tr("Play forwards, then backwards.")
    )
    imgui.same_line(0, 16 * scale)
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() + widgets.switch_offset())
    tooltip = tr("If the motion ends as it begins, its last frame is left out.")
    if options.chosen_format.repeats:
        tooltip = f"{tooltip} {tr('Off: the animation plays once.')}"
    _, options.loop = widgets.switch(tr("Loop forever"), options.loop, tooltip)
    if options.chosen_format.is_page:
        widgets.switch_label("", LABEL_WIDTH * scale)
        tooltip = tr("Off: it plays at once, and a click stops it.")
        _, options.hover = widgets.switch(tr("Play on hover"), options.hover, tooltip)
    options.opaque, options.background = background_field(
        options.opaque,
        options.background,
        not options.chosen_format.has_transparency,
        tr("Off: the background is transparent."),
        scale,
    )


def _written_frames(
    state: AppState, options: AnimationExportOptions, measured_size: AnimationSize
) -> tuple[list[float], tuple[Box, float] | None, str]:
    """Times of all frames, their box and scale (None until they are known), and what prevents an export."""
    times = options.frame_times(*state.timeline.playback.played_range)
    try:
        framing = measured_size.framing(state, times, options.size, options.chosen_format.is_video)
    except InputError as error:
        return frame_times_in_order(state, options), None, str(error)
    return frame_times_in_order(state, options), framing, ""


def _written_animation(
    options: AnimationExportOptions, times: list[float], framing: tuple[Box, float] | None
) -> WrittenAnimation | None:
    """What the size of the file depends on; None until it is known."""
    if framing is None:
        return None
    return WrittenAnimation(
        options.chosen_format,
        tuple(times),
        framing,
        options.written_fps,
        options.plays,
        options.visible_background,
    )


def _draw_result(
    options: AnimationExportOptions,
    count: int,
    framing: tuple[Box, float] | None,
    problem: str,
    scale: float,
) -> None:
    """Draw the number of frames, the seconds and the size in pixels of what is written."""
    tenths = round(10 * count / options.written_fps)
    seconds = number_text(tenths / 10, "g")
    text = tr_plural("{count} frame, {seconds} s", "{count} frames, {seconds} s", count, seconds=seconds)
    if options.written_fps < options.fps:
        text = tr("{frames} at {fps:g} fps", frames=text, fps=options.written_fps)
    widgets.label(tr("Result"), LABEL_WIDTH * scale)
    imgui.text(text)
    widgets.label("", LABEL_WIDTH * scale)
    imgui.text(problem or size_text(options, framing))


def _draw_file_size(size: int | None, is_rough: bool, scale: float) -> None:
    """Draw the estimated size of the file, bytes; dimmed while it is rough, an ellipsis if it is unknown."""
    widgets.label("", LABEL_WIDTH * scale)
    text = "..." if size is None else tr("about {size}", size=size_in_words(size))
    (imgui.text_disabled if is_rough else imgui.text)(text)


def size_text(options: AnimationExportOptions, framing: tuple[Box, float] | None) -> str:
    """The size of the pictures that are written, in words; an ellipsis until it is known."""
    if framing is None:
        return "..."
    width, height = output_size(*framing)
    # of a sheet, margins that are empty in all frames are cropped
    text = (
        mark("at most {width} × {height} px")
        if options.chosen_format.is_sheet
        else mark("{width} × {height} px")
    )
    return tr(text, width=width, height=height)
