"""Does recordings again, and plays keyframes, as animations."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import click

from ..deform.pose_interpolation import InterpolationCache
from ..editor.animation.keyframe_playback import keyed_frame
from ..editor.animation.motion import Frame, Motion, closed, frame_times, shorten_pauses
from ..editor.document.easing import EASINGS
from ..editor.document.framing import frame_box, union_of_boxes
from ..editor.document.settings import Settings
from ..editor.session.replay import replay
from ..errors import InputError, error_context
from ..io.akap.recording import read_recording, recorded_drawing
from ..io.animation.frames import export_frames, export_kind
from ..io.open_document import PROJECT_SUFFIX, open_document
from .options import FILE, check_png, color, make_folder_of, write_picture

# What a word of --variant sets.
VARIANT_WORDS: dict[str, tuple[str, object]] = {
    "dirichlet": ("dirichlet", True),
    "no-dirichlet": ("dirichlet", False),
    "spiral": ("trajectory", "spiral"),
    "linear": ("trajectory", "linear"),
    "soft": ("constraints", "soft"),
    "hard": ("constraints", "hard"),
    "memory": ("memory", 1.0),
    "no-memory": ("memory", 0.0),
}
_WORDS = ", ".join(VARIANT_WORDS)


@click.command(
    "replay",
    epilog="Example: akap-editor replay wave.akaprec --drawing cat.png -o wave.webp; akap-editor replay "
    "walk.akap -o walk.gif. The output's ending "
    "decides: .png is the last pose, .gif, .webp and .apng are animations, .mp4 and .webm videos, a folder/ "
    "gets one PNG a frame; with --sheet, .png is a sprite sheet, and .json beside it its index.",
)
@click.argument("recording", type=FILE)
@click.option("-o", "--output", type=FILE, required=True, help="File or folder/ to write.")
@click.option("--drawing", type=FILE, help="Drawing to replay it on, in place of its own.")
@click.option("--method", metavar="METHOD", help="Bend by another: akap, arap, mls, ..., arap:converge, ...")
@click.option("--variant", default="", metavar="WORDS", help=f"Of AKAP, divided by commas: {_WORDS}.")
@click.option("--pose", type=FILE, help="Also write the last pose as this PNG file, in full resolution.")
@click.option("--sheet", is_flag=True, help="Write a sprite sheet with a JSON index for games.")
@click.option("--fps", default=30.0, show_default=True, help="Frames per second.")
@click.option("--size", default=640, show_default=True, help="Longest side in pixels, at most.")
@click.option("--background", metavar="#RRGGBB", help="Color behind the drawing; transparent without it.")
@click.option("--from", "start", type=float, metavar="SECONDS", help="Leave out what was before.")
@click.option("--to", "end", type=float, metavar="SECONDS", help="Leave out what comes after.")
@click.option("--pause", type=float, metavar="SECONDS", help="Shorten longer pauses, before all else.")
@click.option("--speed", default=1.0, show_default=True, help="2 is twice as fast.")
@click.option(
    "--ease", type=click.Choice(list(EASINGS)), default="none", show_default=True, help="Start or end slowly."
)
@click.option("--ping-pong", is_flag=True, help="Forwards, then backwards.")
@click.option("--plays", default=0, show_default=True, help="How often an animation is shown; 0 for ever.")
def replay_command(
    recording: Path, output: Path, drawing: Path | None, pose: Path | None, **options: object
) -> None:
    """Do a recorded session again without a window and write it as an animation or a picture.

    Between recorded moments the drawing moves along its trajectories, so any frame rate is smooth. Of a
    drawing saved as .akap, its keyframes are played in the same way.
    """
    replay_recording(recording, drawing, output, pose, **options)  # type: ignore[arg-type]


def replay_recording(
    path: Path,
    drawing_path: Path | None,
    output: Path,
    pose: Path | None = None,
    *,
    fps: float = 30.0,
    size: int = 640,
    method: str | None = None,
    variant: str = "",
    sheet: bool = False,
    background: str | None = None,
    start: float | None = None,
    end: float | None = None,
    pause: float | None = None,
    speed: float = 1.0,
    ease: str = "none",
    ping_pong: bool = False,
    plays: int = 0,
) -> None:
    """As the command does. Raises InputError, and then nothing was written."""
    from ..render.offscreen import OffscreenRenderer

    _check_number("--fps", fps, 1, 120)
    _check_number("--size", size, 16, 8192)
    _check_number("--speed", speed, 0.01, 100)
    _check_number("--plays", plays, 0, 65535)
    behind = color(background)
    kind = export_kind(output, sheet)
    if pose is not None:
        check_png(pose)
    duration, play = _source(path, drawing_path, method, variant, pause)
    first, last = _range(duration, start, end)
    times = [last] if kind == "picture" else frame_times(first, last, fps, speed, ease)
    with error_context(path), click.progressbar(play(times), length=len(times), label="Bending") as bar:
        frames = list(bar)
    frames = _in_turn(frames, ping_pong, kind == "animation" and plays != 1)
    box = union_of_boxes([frame_box(frame.drawing, [frame.pose]) for frame in frames])
    scale = min(1.0, size / max(box[2] - box[0], box[3] - box[1]))
    make_folder_of(output)
    with OffscreenRenderer() as renderer:
        with click.progressbar(frames, label="Drawing") as bar:
            pictures = (renderer.render(at.drawing, at.pose, box, scale, behind, at.order) for at in bar)
            written = export_frames(output, pictures, fps, plays, sheet)
        if pose is not None:
            last_frame = frames[-1]
            write_picture(pose, renderer.render(*last_frame[:2], background=behind, order=last_frame.order))
            click.echo(f"Wrote {pose}, the last pose")
    click.echo(f"Wrote {output}, {len(frames)} frames, {written}")


def _in_turn(frames: list[Frame], ping_pong: bool, repeated: bool) -> list[Frame]:
    """What is shown one after the other; repeated and ending as it begins: without the end."""
    if ping_pong:
        return frames + frames[-2:0:-1]
    return frames[:-1] if repeated and len(frames) > 2 and closed(frames[0], frames[-1]) else frames


def _check_number(option: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(f"{option}: expected a number from {low:g} to {high:g}, got {value:g}")


def _range(duration: float, start: float | None, end: float | None) -> tuple[float, float]:
    first = 0.0 if start is None else start
    last = duration if end is None else end
    if not 0 <= first <= duration:
        raise InputError(f"--from: expected a time from 0 to the end at {duration:g} s, got {first:g}")
    if not first <= last:
        raise InputError(f"--to: expected a time of {first:g} s or later, got {last:g}")
    return first, min(last, duration)


def settings_change(method: str | None, variant: str) -> Callable[[Settings], Settings] | None:
    """What to make of recorded settings. Raises InputError on unknown words."""
    words = [word.strip() for word in variant.split(",") if word.strip()]
    for word in words:
        if word not in VARIANT_WORDS:
            raise InputError(f"--variant: expected words among {_WORDS}, got {word!r}")
    if method is None and not words:
        return None
    chosen = None if method is None else Settings.parse(method)

    def change(settings: Settings) -> Settings:
        settings = chosen or settings
        for word in words:
            settings = settings.with_parameter(*VARIANT_WORDS[word])
        return settings

    return change


# What gives drawing and pose at each of some times, which do not fall.
Play = Callable[[Sequence[float]], Iterator[Frame]]


def _source(
    path: Path, drawing_path: Path | None, method: str | None, variant: str, pause: float | None
) -> tuple[float, Play]:
    """How long keyframes or a recording are, and what plays them."""
    if path.suffix.lower() == PROJECT_SUFFIX:
        _refuse({"--drawing": drawing_path, "--method": method, "--variant": variant, "--pause": pause})
        return _keyframes(path)
    return _recorded(path, drawing_path, settings_change(method, variant), pause)


def _recorded(
    path: Path,
    drawing_path: Path | None,
    change: Callable[[Settings], Settings] | None,
    pause: float | None,
) -> tuple[float, Play]:
    """How long a recording is, and what plays it."""
    recording = read_recording(path)
    if pause is not None:
        _check_number("--pause", pause, 0, 1e9)
        recording = shorten_pauses(recording, pause)
    drawing = open_document(drawing_path).drawing if drawing_path is not None else recorded_drawing(recording)
    return recording.duration, lambda times: Motion(drawing, replay(recording, drawing, change)).frames(times)


def _keyframes(path: Path) -> tuple[float, Play]:
    """How long the keyframes of a drawing are, and what plays them."""
    document, ways = open_document(path), InterpolationCache()
    animation = document.state.animation
    if not animation.keyframes:
        raise InputError(f"{path}: expected a drawing with keyframes, or a recording, got one without any")
    return animation.duration, lambda times: (keyed_frame(document, ways, time) for time in times)


def _refuse(options: dict[str, object]) -> None:
    for name, value in options.items():
        if value not in (None, ""):
            raise InputError(f"{name}: expected a recording, which can be bent anew, got keyframes")
