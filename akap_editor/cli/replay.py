"""Writes recordings and keyframes as animations."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from ..display_text import display_text
from ..editor.document.easing import EASINGS
from ..errors import FileError, InputError, file_errors
from ..io.atomic import noted_reads
from ..io.outputs import refuse_replacing, refuse_source, same_file
from ..io.streams import STREAM, written_path
from ..progress import listening
from .options import (
    ANIMATION_DESCRIPTIONS,
    ANIMATION_ENDINGS,
    FILE,
    INPUT,
    append_formats,
    check_png,
    json_option,
    make_folder_of,
    overwrite_option,
    parse_color,
    progress_bar,
    say,
    write_picture,
)

if TYPE_CHECKING:
    from ..editor.animation.frames import Frame
    from ..editor.document.settings import Settings
    from ..io.animation.formats import Shot

# The parameter that each word of --variant sets.
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


@click.command(
    "replay",
    epilog="Example: akap-editor replay wave.akaprec --drawing cat.png -o wave.webp\n\n"
    "Example: akap-editor replay walk.akap -o walk.gif",
)
@click.argument("recording", type=INPUT)
@click.option(
    "-o",
    "--output",
    type=FILE,
    required=True,
    help="File to write, or to replace, or folder/ for the frames; its ending sets the format. - for stdout.",
)
@click.option("--format", "suffix", type=click.Choice([*ANIMATION_ENDINGS, ".png"]), help="Format on stdout.")
@click.option("--drawing", type=INPUT, help="Replay on this drawing instead of the recorded one.")
@click.option(
    "--method", metavar="METHOD", help="Replay with another method: akap, arap, mls, ..., arap:converge, ..."
)
@click.option(
    "--variant",
    default="",
    metavar="WORDS",
    help=f"Change parameters of AKAP; words separated by commas: {', '.join(VARIANT_WORDS)}.",
)
@click.option("--pose", type=FILE, help="Also write the last pose as this PNG file, in full resolution.")
@click.option("--sheet", is_flag=True, help="Write a sprite sheet and its JSON index, for games.")
@click.option("--fps", default=30.0, show_default=True, help="Frames per second.")
@click.option("--size", default=640, show_default=True, help="Longest side in pixels, at most.")
@click.option("--background", metavar="#RRGGBB", help="Background color; transparent by default.")
@click.option("--from", "start", type=float, metavar="SECONDS", help="Skip everything before this time.")
@click.option("--to", "end", type=float, metavar="SECONDS", help="Skip everything after this time.")
@click.option(
    "--pause", type=float, metavar="SECONDS", help="Shorten longer pauses, before all other options."
)
@click.option("--speed", default=1.0, show_default=True, help="2 is twice as fast.")
@click.option(
    "--ease",
    type=click.Choice(list(EASINGS)),
    default="none",
    show_default=True,
    help="Easing of the whole animation.",
)
@click.option("--ping-pong", is_flag=True, help="Play forwards, then backwards.")
@click.option(
    "--plays",
    type=int,
    metavar="NUMBER",
    help="How often the animation plays; 0 for forever, the default, unless the drawing says that it plays "
    "once.",
)
@click.option(
    "--quality", type=int, metavar="NUMBER", help="Of a lossy WebP, 1 to 100; it is lossless by default."
)
@click.option("--hover", is_flag=True, help="Let a web page play only while the pointer is over it.")
@json_option
@overwrite_option
def replay_command(
    recording: Path,
    output: Path,
    suffix: str | None,
    drawing: Path | None,
    pose: Path | None,
    **options: object,
) -> None:
    """Replay a recording, or the keyframes of a drawing saved as .akap, as an animation or a picture.

    No window is needed. Between recorded steps the drawing moves along its trajectories, so that any frame
    rate is smooth.
    """
    if (suffix is None) == (output == STREAM):
        raise InputError("--format: expected the format of an output -, which is stdout, and of no other")
    as_json = bool(options.pop("as_json"))
    with written_path(output, suffix or "") as path:
        result = replay_recording(recording, drawing, path, pose, **options)  # type: ignore[arg-type]
    print_replays([result], as_json, output)


append_formats(replay_command, list(ANIMATION_DESCRIPTIONS.items()))


class ReplayResult(NamedTuple):
    """An animation that was written.

    facts: the record for --json, but for the files; written: a few words on it; pose: the file of the last
    pose.
    """

    output: Path
    facts: dict[str, object]
    written: str
    pose: Path | None

    @property
    def text(self) -> str:
        """Lines for people."""
        last = "" if self.pose is None else f"Wrote {display_text(self.pose)}, the last pose\n"
        return f"{last}Wrote {display_text(self.output)}, {self.facts['frames']} frames, {self.written}"

    @property
    def record(self) -> dict[str, object]:
        """The record for --json."""
        return {**self.facts, "files": [str(path) for path in (self.output, self.pose) if path is not None]}


def print_replays(results: Sequence[ReplayResult], as_json: bool, output: Path) -> None:
    """Print what was written, as JSON an object for one file and a list for several.

    output: the value of --output; on standard output there is only the file then.
    """
    if output == STREAM:
        results = [result._replace(output=STREAM) for result in results]
    if as_json:
        records = [result.record for result in results]
        say(json.dumps(records if len(records) > 1 else records[0], indent=2), output)
    else:
        say("\n".join(result.text for result in results), output)


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
    plays: int | None = None,
    quality: int | None = None,
    hover: bool = False,
    overwrite: bool = False,
) -> ReplayResult:
    """Write what the command writes. Raises InputError before anything is written."""
    from ..editor.animation.frames import frame_times, loops_seamlessly, playing_order
    from ..io.animation.formats import (
        MAX_PLAYS,
        animation_format,
        animation_shots,
        replaced_files,
        write_animation,
    )
    from ..render.offscreen import OffscreenRenderer

    _check_number("--fps", fps, 1, 120)
    _check_number("--size", size, 16, 8192)
    _check_number("--speed", speed, 0.01, 100)
    _check_number("--plays", plays or 0, 0, MAX_PLAYS)
    background_color = parse_color(background)
    chosen = animation_format(output, sheet)
    fps = min(fps, chosen.max_fps)
    if quality is not None:
        if not chosen.has_quality:
            raise InputError(f"--quality: expected an output that ends in .webp, got {chosen.label}")
        _check_number("--quality", quality, 1, 100)
    if hover and not chosen.is_page:
        raise InputError(f"--hover: expected an output that ends in .html, got {chosen.label}")
    if pose is not None:
        check_png(pose)
        if pose.absolute() == output.absolute() or same_file(pose, output):
            raise InputError(f"--pose: expected another file than --output, got {pose}")
    refuse_replacing(output, replaced_files(output, sheet), overwrite)
    with noted_reads() as read:
        source = _open_source(path, drawing_path, method, variant, pause)
    for written_file in filter(None, [output, pose]):
        refuse_source(written_file, read, overwrite)
    plays = source.plays if plays is None else plays
    first, last = _range(source.duration, start, end)
    times = [last] if chosen.is_still else frame_times(first, last, fps, speed, ease)
    with file_errors("replay", path), progress_bar(source.play(times), len(times), "Bending") as bar:
        frames = list(bar)
    is_loop = plays != 1 and loops_seamlessly(frames[0], frames[-1])
    end_frame, frames = frames[-1], playing_order(frames, ping_pong, is_loop)
    make_folder_of(output)
    with OffscreenRenderer() as renderer:
        shots = animation_shots(chosen, frames, renderer, size, background_color)
        with _writing_bar(shots, len(frames), chosen.encoding_share) as counted:
            written = write_animation(
                output, counted, fps, plays, sheet, overwrite=overwrite, quality=quality, hover=hover
            )
        if pose is not None:
            picture = renderer.render(
                end_frame.drawing, end_frame.pose, background=background_color, order=end_frame.order
            )
            write_picture(pose, picture)
    facts = {"format": chosen.label, "frames": len(frames), "fps": fps, "plays": plays}
    return ReplayResult(output, facts, written, pose)


@contextmanager
def _writing_bar(shots: "Iterable[Shot]", count: int, encoding_share: float) -> "Iterator[Iterator[Shot]]":
    """A progress bar over drawing and encoding; gives the shots, which it counts.

    encoding_share: of the time, after the last shot is drawn.
    """
    drawing_share, most = 1 - encoding_share, 1000
    items: Iterable[Shot] | None = None
    with progress_bar(items, most, "Writing") as bar:

        def show(share: float, _: str = "") -> None:
            bar.update(max(0, round(most * share) - bar.pos))

        def counted() -> "Iterator[Shot]":
            for number, shot in enumerate(shots, start=1):
                yield shot
                show(drawing_share * number / count)

        with listening(lambda share, _: show(drawing_share + encoding_share * share)):
            yield counted()
        show(1.0)


def _check_number(option: str, value: float, low: float, high: float) -> None:
    if not low <= value <= high:
        raise InputError(f"{option}: expected a number from {low:g} to {high:g}, got {value:g}")


def _range(duration: float, start: float | None, end: float | None) -> tuple[float, float]:
    """First and last second that are shown. Raises InputError."""
    first = 0.0 if start is None else start
    last = duration if end is None else end
    if not 0 <= first <= duration:
        raise InputError(f"--from: expected a time from 0 to the end at {duration:g} s, got {first:g}")
    if not first <= last:
        raise InputError(f"--to: expected a time of {first:g} s or later, got {last:g}")
    return first, min(last, duration)


# -- what is played ------------------------------------------------------------------------------------------


class _Source(NamedTuple):
    """A recording or keyframes.

    duration: seconds; plays: how often it is shown, 0 for forever; play: gives the frames at ascending times.
    """

    duration: float
    plays: int
    play: "Callable[[Sequence[float]], Iterator[Frame]]"


def _open_source(
    path: Path, drawing_path: Path | None, method: str | None, variant: str, pause: float | None
) -> _Source:
    """Open a recording, or a drawing with keyframes. Raises InputError."""
    from ..io.akap.project import PROJECT_SUFFIX

    if path.suffix.lower() == PROJECT_SUFFIX:
        _refuse({"--drawing": drawing_path, "--method": method, "--variant": variant, "--pause": pause})
        return _open_keyframes(path)
    return _open_recording(path, drawing_path, settings_change(method, variant), pause)


def _open_recording(
    path: Path,
    drawing_path: Path | None,
    change: "Callable[[Settings], Settings] | None",
    pause: float | None,
) -> _Source:
    from ..editor.animation.motion import Motion, shorten_pauses
    from ..editor.session.replay import replay
    from ..io.akap.recording import read_recording, recorded_drawing
    from ..io.open_document import open_document

    recording = read_recording(path)
    if pause is not None:
        _check_number("--pause", pause, 0, 1e9)
        recording = shorten_pauses(recording, pause)
    drawing = open_document(drawing_path).drawing if drawing_path is not None else recorded_drawing(recording)
    return _Source(
        recording.duration,
        0,
        lambda times: Motion(drawing, replay(recording, drawing, change)).frames(times),
    )


def _open_keyframes(path: Path) -> _Source:
    from ..editor.animation.loose_motion import AnimationFrames
    from ..io.open_document import open_document

    document = open_document(path)
    animation = document.state.animation
    if not animation.keyframes:
        raise FileError("replay", path, "the drawing has no keyframes; add some, or replay a recording")
    return _Source(
        animation.duration,
        0 if animation.loop else 1,
        lambda times: map(AnimationFrames(document).frame, times),
    )


def _refuse(options: dict[str, object]) -> None:
    """Raise InputError if an option is given that keyframes do not have."""
    for name, value in options.items():
        if value not in (None, ""):
            raise InputError(f"{name}: expected a recording, got keyframes, which no method computes")


def settings_change(method: str | None, variant: str) -> "Callable[[Settings], Settings] | None":
    """The change of recorded settings that --method and --variant ask for; None for no change.

    Raises InputError on unknown words.
    """
    from ..editor.document.settings import Settings

    words = [word.strip() for word in variant.split(",") if word.strip()]
    for word in words:
        if word not in VARIANT_WORDS:
            raise InputError(f"--variant: expected words among {', '.join(VARIANT_WORDS)}, got {word!r}")
    if method is None and not words:
        return None
    chosen = None if method is None else Settings.parse(method)

    def change(settings: "Settings") -> "Settings":
        settings = chosen or settings
        for word in words:
            settings = settings.with_parameter(*VARIANT_WORDS[word])
        return settings

    return change
