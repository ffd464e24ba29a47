"""Frames to what a name asks for: a picture, an animation, a video, a folder of pictures, a sprite sheet."""

from collections.abc import Iterable
from pathlib import Path
from typing import Literal

from ...errors import InputError
from ..atomic import Write, write_atomic
from ..images import Picture, write_png
from .animated_images import animation_suffix, write_animation
from .sprite_sheet import write_frames, write_sheet
from .video import VIDEO_SUFFIXES, require_av

Kind = Literal["picture", "frames", "sheet", "animation", "video"]


def export_kind(path: str | Path, sheet: bool = False) -> Kind:
    """What `export_frames` would write, by the name.

    A picture (.png), frames (a folder: no ending), a sheet, an animation (.gif, .webp, .apng) or a video
    (.mp4, .webm). Raises InputError on other names.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if sheet:
        if suffix != ".png":
            raise InputError(f"{path}: expected a sheet's name to end in .png, got {suffix or 'none'}")
        return "sheet"
    if not suffix or path.is_dir():
        return "frames"
    if suffix == ".png":
        return "picture"
    if animation_suffix(path) in VIDEO_SUFFIXES:
        require_av()
        return "video"
    return "animation"


def export_frames(
    path: str | Path,
    frames: Iterable[Picture],
    fps: float,
    plays: int = 0,
    sheet: bool = False,
    write: Write = write_atomic,
) -> str:
    """Write frames, (h, w, 4) uint8 each, straight alpha, all of one size; a few words on what was written.

    Of a .png it is the last frame, unless ``sheet``. plays: of an animation, 0 for ever; write: writes what
    becomes one file, when all of it is encoded. Raises InputError.
    """
    kind = export_kind(path, sheet)
    if kind == "sheet":
        columns, rows = write_sheet(path, frames, fps, write)
        return f"a sheet of {columns} x {rows} sprites, and its index {Path(path).with_suffix('.json').name}"
    if kind == "frames":
        return f"{write_frames(path, frames)} pictures"
    if kind == "picture":
        *_, last = frames
        write_png(path, last)
        return f"{last.shape[1]} x {last.shape[0]} pixels"
    write_animation(path, frames, fps, plays, write)
    return f"at {fps:g} frames per second"
