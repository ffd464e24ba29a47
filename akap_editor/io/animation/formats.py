"""The table of animation formats, and the export of frames by it."""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...display_text import display_name
from ...editor.animation.frames import Frame
from ...editor.framing import Color
from ...errors import FileError, InputError, join_with_or
from ...words import mark, tr
from ..atomic import Write, write_atomic
from ..images import Picture, write_png
from ..outputs import existing, refuse_replacing
from ..painter import FramedPose, Painter, framed_poses, paint_frames
from .animated_images import write_apng, write_webp
from .gif import MAX_GIF_FPS, write_gif
from .player import write_player
from .sprite_sheet import frame_files, index_path, write_frames, write_sheet
from .video import require_av, write_mp4, write_webm

MAX_PLAYS = 65535

Shot = Picture | FramedPose  # what a format is written from: a picture, or a pose for a reader that draws it
Writer = Callable[..., str]  # of path, shots, fps, plays and write; and quality or hover, where there is one


@dataclass(frozen=True)
class AnimationFormat:
    """A row of the table of formats.

    label: name on the screen; suffix: ending of file names, "" for a folder; about: description for the user;
    has_transparency: whether the background can be transparent; repeats: whether the file says how often it
    plays; is_video: whether the package av is needed, and width and height must be even; is_sheet: whether
    all frames are in one picture; is_still: whether only the last frame is written; is_page: whether it is a
    web page, which draws poses itself and can wait for the pointer; has_quality: whether it can be lossy;
    max_fps: frames per second, at most; encoding_share: about the share of the time of an export that is
    still to come when the last frame is drawn; writer: see `write_animation`.
    """

    label: str
    suffix: str
    about: str
    writer: Writer = field(repr=False)
    has_transparency: bool = True
    repeats: bool = False
    is_video: bool = False
    is_sheet: bool = False
    is_still: bool = False
    is_page: bool = False
    has_quality: bool = False
    max_fps: float = 120.0
    encoding_share: float = 0.05


def _write_pictures(path: Path, frames: Iterable[Picture], *_: object) -> str:
    return tr("{count} pictures", count=write_frames(path, frames))


def _write_sheet(path: Path, frames: Iterable[Picture], fps: float, _: int, write: Write) -> str:
    columns, rows = write_sheet(path, frames, fps, write)
    return tr(
        "a sheet of {columns} x {rows} sprites, and its index {file}",
        columns=columns,
        rows=rows,
        file=display_name(index_path(path)),
    )


def _write_last(path: Path, frames: Iterable[Picture], *_: object) -> str:
    last = deque(frames, maxlen=1)[0]
    write_png(path, last)
    return tr("{width} x {height} pixels", width=last.shape[1], height=last.shape[0])


ANIMATION_FORMATS = (
    AnimationFormat(
        "WebP",
        ".webp",
        mark("An animation for the web: all colors, soft edges, small."),
        write_webp,
        repeats=True,
        has_quality=True,
        encoding_share=0.65,
    ),
    AnimationFormat(
        "GIF",
        ".gif",
        mark("An animation that plays everywhere: 255 colors, hard edges."),
        write_gif,
        repeats=True,
        max_fps=MAX_GIF_FPS,
        encoding_share=0.1,
    ),
    AnimationFormat(
        "APNG",
        ".apng",
        mark("An animation: all colors, soft edges, large."),
        write_apng,
        repeats=True,
    ),
    AnimationFormat(
        "MP4",
        ".mp4",
        mark("A video (H.264) without transparency."),
        write_mp4,
        has_transparency=False,
        is_video=True,
    ),
    AnimationFormat("WebM", ".webm", mark("A video (VP9) with transparency."), write_webm, is_video=True),
    AnimationFormat(
        mark("Web page"),
        ".html",
        mark("A page that plays in browsers, sharp at any size."),
        write_player,
        repeats=True,
        is_page=True,
        encoding_share=0.9,
    ),
    AnimationFormat(mark("Pictures"), "", mark("A folder with one PNG per frame."), _write_pictures),
    AnimationFormat(
        mark("Sprite sheet"),
        ".png",
        mark("One PNG with all frames, and a JSON index, for games."),
        _write_sheet,
        is_sheet=True,
        encoding_share=0.2,
    ),
    AnimationFormat(mark("Picture"), ".png", mark("The last frame as a PNG."), _write_last, is_still=True),
)


# Endings of the formats that are one file and no picture.
ANIMATION_SUFFIXES = tuple(
    each.suffix for each in ANIMATION_FORMATS if each.suffix and not each.is_sheet and not each.is_still
)


def animation_format(path: str | Path, sheet: bool = False) -> AnimationFormat:
    """The format for a file name's ending; for .png the last frame, or a sprite sheet if ``sheet``.

    Raises InputError for an unknown ending, or if the package for videos is missing.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if sheet and suffix != ".png":
        raise FileError(
            "export",
            path,
            tr("expected a sheet's name to end in .png, got {suffix}", suffix=suffix or "none"),
        )
    if path.is_dir() and not sheet:
        suffix = ""
    for each in ANIMATION_FORMATS:
        if each.suffix == suffix and each.is_sheet == sheet:
            if each.is_video:
                require_av()
            return each
    endings = join_with_or(sorted({each.suffix for each in ANIMATION_FORMATS if each.suffix}))
    raise FileError(
        "export",
        path,
        tr("expected a name that ends in {endings}, got {suffix}", endings=endings, suffix=suffix or "none"),
    )


def animation_shots(
    chosen: AnimationFormat,
    frames: Sequence[Frame],
    painter: Painter,
    longest_side: int,
    background: Color | None,
) -> Iterable[Shot]:
    """What `write_animation` needs of frames for a format; pictures are drawn when they are asked for.

    longest_side, background: see `framed_poses`. Raises InputError if the pictures would be too large.
    """
    if chosen.is_page:
        return framed_poses(frames, longest_side, background)
    return paint_frames(frames, painter, longest_side, background, chosen.is_video)


def write_animation(
    path: str | Path,
    shots: Iterable[Shot],
    fps: float,
    plays: int = 0,
    sheet: bool = False,
    write: Write = write_atomic,
    overwrite: bool = False,
    quality: int | None = None,
    hover: bool = False,
) -> str:
    """Write an animation; return a few words on the result.

    The ending of ``path`` decides on the format, see `animation_format`. shots: pictures (h, w, 4) uint8,
    straight alpha, all of one size, or `FramedPose`s for a web page, see `animation_shots`; read once, in
    order; plays: how often the animation is shown, 0 for forever; formats that do not repeat ignore it;
    write: writes a file when all of it is encoded; overwrite: replace files that ``path`` does not name, too,
    see `replaced_files`; quality: 1 to 100 for a lossy WebP, None for a lossless one; hover: let a web page
    play only while the pointer is over it. What is done after the last frame is announced, see `progress`.
    Raises InputError for bad frames or arguments, and if the file
    cannot be written.
    """
    path = Path(path)
    chosen = animation_format(path, sheet)
    if not 0.1 <= fps <= 1000:
        raise InputError(tr("fps: expected a number from 0.1 to 1000, got {fps}", fps=fps))
    if not 0 <= plays <= MAX_PLAYS:
        raise InputError(
            tr("plays: expected a number from 0 to {most}, got {plays}", most=MAX_PLAYS, plays=plays)
        )
    refuse_replacing(path, replaced_files(path, sheet), overwrite)
    options = _own_options(chosen, quality, hover)
    return chosen.writer(path, shots, fps, plays, write, **options)


def _own_options(chosen: AnimationFormat, quality: int | None, hover: bool) -> dict[str, object]:
    """The options that only some formats have. Raises InputError for one that this one has not."""
    options: dict[str, object] = {}
    if quality is not None:
        if not chosen.has_quality:
            raise InputError(
                tr("quality: expected a WebP, got {format}, which has no such choice", format=chosen.label)
            )
        if not 1 <= quality <= 100:
            raise InputError(tr("quality: expected a number from 1 to 100, got {quality}", quality=quality))
        options["quality"] = quality
    if hover:
        if not chosen.is_page:
            raise InputError(
                tr("hover: expected a web page, got {format}, which has no such choice", format=chosen.label)
            )
        options["hover"] = True
    return options


def replaced_files(path: Path, sheet: bool = False) -> list[Path]:
    """The files that exist and that an animation replaces or deletes although ``path`` does not name them.

    They are the index of a sheet, and the frames of an older animation in a folder.
    """
    if sheet:
        return existing([index_path(path)])
    return frame_files(path) if path.is_dir() else []
