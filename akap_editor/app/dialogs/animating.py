"""What is chosen for exports of the timeline, and writing them."""

from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from ...editor.animation.motion import Frame, closed, frame_times
from ...editor.document.easing import EASINGS
from ...editor.document.framing import frame_box, picture_size, union_of_boxes
from ...io.animation.frames import export_frames, export_kind
from ..app_state import AppState
from ..jobs.frame_encoder import Encoder
from ..jobs.task import Progress, Steps, Task
from .file_dialog import FileRequest

REMEMBERED = "animation"  # the name of the choice in the preferences


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
    """fps: frames a second; size: of the longest side, in pixels; speed: 2 is twice as fast; ease: see
    `easing`; loop: shown for ever, else once; ping_pong: forwards, then backwards; background: where opaque.
    """

    format: str = FORMATS[0].label
    fps: float = 30.0
    size: int = 640
    speed: float = 1.0
    ease: str = "none"
    loop: bool = True
    ping_pong: bool = False
    opaque: bool = False
    background: tuple[float, float, float] = (1.0, 1.0, 1.0)

    @property
    def kind(self) -> AnimationFormat:
        """The format."""
        return next(each for each in FORMATS if each.label == self.format)

    @property
    def behind(self) -> tuple[float, float, float] | None:
        """The color behind the drawing; None where it is transparent."""
        return self.background if self.opaque or not self.kind.transparent else None

    def times(self, start: float, end: float) -> list[float]:
        """When to look, for each frame."""
        times = frame_times(start, end, self.fps, self.speed, self.ease)
        return times + times[-2:0:-1] if self.ping_pong else times


def remembered(state: AppState) -> AnimationExportOptions:
    """As it was chosen the last time; what makes no sense is as at first."""
    values: dict[str, Any] = state.preferences.get(REMEMBERED, {})
    choice = AnimationExportOptions()
    for name, plain in asdict(choice).items():
        value = values.get(name, plain)
        if name in LIMITS and type(value) in (int, float):
            value = type(plain)(min(max(value, LIMITS[name][0]), LIMITS[name][1]))
        if isinstance(value, list) and len(value) == 3 and all(type(each) is float for each in value):
            value = tuple(value)
        if type(value) is type(plain):
            setattr(choice, name, value)
    choice.ease = choice.ease if choice.ease in EASINGS else "none"
    choice.format = choice.format if choice.format in [each.label for each in FORMATS] else FORMATS[0].label
    return choice


def remember(state: AppState, choice: AnimationExportOptions) -> None:
    """Keep a choice for the next time."""
    state.preferences.put(REMEMBERED, asdict(choice))


def ask(state: AppState) -> None:
    """Ask what is to be made of the part between the marks."""
    start, end = state.playback.range
    if state.document is not None and end > start:
        if state.playback.playing:
            state.playback.stop()
        state.animating = True


def frame_at(state: AppState, moment: float) -> Frame:
    """What the timeline shows at a time."""
    keyed = state.timeline == "keyframes"
    return state.keyframe_playback.frame(moment) if keyed else state.session_playback.frame(moment)


def chosen_times(state: AppState, choice: AnimationExportOptions) -> list[float]:
    """When to look, for each frame. Of what repeats and ends as it begins, the end is left out."""
    start, end = state.playback.range
    times = choice.times(start, end)
    over = choice.kind.repeats and choice.loop and not choice.ping_pong and len(times) > 2
    return times[:-1] if over and closed(frame_at(state, start), frame_at(state, end)) else times


def ask_file(state: AppState) -> None:
    """Ask where it goes."""
    assert state.document is not None
    kind, name = remembered(state).kind, state.document.drawing.name
    name += kind.suffix or "-frames"
    if kind.sheet:
        name = f"{state.document.drawing.name}-sheet.png"
    suffixes = (kind.suffix,)
    use = partial(export, state)
    state.request = FileRequest("Export animation", suffixes, state.folder, use, name, saving=True)


def export(state: AppState, path: Path) -> None:
    """Write the part between the marks, as it was chosen; the name's ending decides on the format."""
    choice = remembered(state)

    def begin() -> None:
        sheet = choice.kind.sheet and path.suffix.lower() == ".png"
        export_kind(path, sheet)
        state.task = Task(f"Exporting {path.name}", _steps(state, choice, path, sheet))

    state.later(begin)


def _steps(state: AppState, choice: AnimationExportOptions, path: Path, sheet: bool) -> Steps:
    """Poses, then pictures, which another thread encodes."""
    times = chosen_times(state, choice)
    frames = []
    for number, time in enumerate(times):
        frames.append(frame_at(state, time))
        yield Progress(0.3 * number / len(times), f"Moving, frame {number + 1} of {len(times)}")
    box = union_of_boxes([frame_box(frame.drawing, [frame.pose]) for frame in frames])
    scale = min(1.0, choice.size / max(box[2] - box[0], box[3] - box[1]))
    picture_size(box, scale)
    encoder = Encoder(
        partial(export_frames, path, fps=choice.fps, plays=0 if choice.loop else 1, sheet=sheet)
    )
    try:
        for number, frame in enumerate(frames):
            picture = state.exporter.render(*frame[:2], box, scale, choice.behind, frame.order)
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
