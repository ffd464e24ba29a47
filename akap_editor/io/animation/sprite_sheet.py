"""Writes frames as PNG pictures: one file per frame, or one sheet with an index for games."""

import json
import math
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...display_text import display_name, display_text
from ...errors import FileError, InputError
from ...words import tr
from ..atomic import Write, os_error_reason, write_atomic
from ..images import Picture, encode_png_bands, write_png
from .frames import Box, PackedFrames, bounding_box, checked_frames

MAX_SHEET_SIDE = 16384
GUTTER = 2  # empty pixels between frames, so that a game that scales them mixes no neighbors
_FRAME_NAME = re.compile(r"frame-(\d{4,})\.png")


def write_frames(folder: str | Path, frames: Iterable[Picture]) -> int:
    """Write frames, (h, w, 4) uint8 each, as frame-0000.png, frame-0001.png, ...; return their number.

    The folder is made if necessary. Frames that an older, longer animation left in it are deleted.
    Raises InputError.
    """
    folder = Path(folder)
    count = 0
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for count, image in enumerate(frames, start=1):
            write_png(folder / f"frame-{count - 1:04d}.png", image)
        for path in frame_files(folder, count):
            path.unlink()
    except OSError as error:
        raise FileError("save", folder, os_error_reason(error)) from error
    return count


def frame_files(folder: Path, first: int = 0) -> list[Path]:
    """The frames of an animation in a folder, from number ``first``. Raises FileError."""
    try:
        matches = {path: _FRAME_NAME.fullmatch(path.name) for path in folder.iterdir()}
    except OSError as error:
        raise FileError("save", folder, os_error_reason(error)) from error
    return sorted(path for path, match in matches.items() if match and int(match[1]) >= first)


def index_path(path: Path) -> Path:
    """The JSON index of a sprite sheet."""
    return path.with_suffix(".json")


def write_sheet(
    path: str | Path, frames: Iterable[Picture], fps: float, write: Write = write_atomic
) -> tuple[int, int]:
    """Write a sprite sheet, one PNG, and its index with the ending .json; return columns and rows.

    frames: (h, w, 4) uint8 each, all of one size; placed row by row, with gutters of `GUTTER` empty pixels
    between and around them. Margins that are empty in all frames are cropped. The index has the common form
    of texture packers: for each frame its rectangle in the sheet, its position in the uncropped picture, and
    its duration in milliseconds.
    Raises InputError, also for a sheet of more than `MAX_SHEET_SIDE` pixels a side.
    """
    path = Path(path)
    images, visible = PackedFrames(), None
    for image in checked_frames(frames):
        visible = image[..., 3] > 0 if visible is None else visible | (image[..., 3] > 0)
        images.append(image)
    assert visible is not None
    layout = _sheet_layout(visible, len(images))
    write(path, encode_png_bands(layout.size, _bands(images, layout), is_repetitive=True))
    write(index_path(path), json.dumps(_sheet_index(path, layout, len(images), fps), indent=1).encode())
    return layout.columns, layout.rows


class _SheetLayout(NamedTuple):
    """Where the sprites of a sheet are.

    columns, rows: of sprites; box: the part of the frames that is shown; frame_size: (width, height) of the
    uncropped frames, pixels.
    """

    columns: int
    rows: int
    box: Box
    frame_size: tuple[int, int]

    @property
    def sprite_size(self) -> tuple[int, int]:
        """Width and height of a sprite, pixels."""
        left, top, right, bottom = self.box
        return right - left, bottom - top

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the sheet, pixels."""
        width, height = self.sprite_size
        return self.columns * (width + GUTTER) + GUTTER, self.rows * (height + GUTTER) + GUTTER


def _sheet_layout(visible: NDArray[np.bool_], count: int) -> _SheetLayout:
    """The layout of ``count`` sprites, nearly square. Raises InputError for a sheet that is too large.

    visible: (h, w) the pixels that any frame shows.
    """
    height, width = visible.shape
    box = bounding_box(visible) if visible.any() else (0, 0, width, height)
    columns = min(count, max(1, round(math.sqrt(count * (box[3] - box[1]) / (box[2] - box[0])))))
    layout = _SheetLayout(columns, math.ceil(count / columns), box, (width, height))
    sheet_width, sheet_height = layout.size
    if max(layout.size) > MAX_SHEET_SIDE:
        raise InputError(
            tr(
                "sheet: expected at most {most} pixels a side, got {sheet_width} x {sheet_height} for "
                "{count} frames; choose a smaller size or rate",
                most=MAX_SHEET_SIDE,
                sheet_width=sheet_width,
                sheet_height=sheet_height,
                count=count,
            )
        )
    return layout


def _sheet_index(path: Path, layout: _SheetLayout, count: int, fps: float) -> dict[str, object]:
    """The index of a sheet of ``count`` sprites, for JSON."""
    (left, top, _, _), (w, h), (width, height) = layout.box, layout.sprite_size, layout.frame_size
    frames = []
    for number in range(count):
        row, column = divmod(number, layout.columns)
        x, y = GUTTER + column * (w + GUTTER), GUTTER + row * (h + GUTTER)
        frames.append(
            {
                "filename": f"{display_text(path.stem)}-{number:04d}",
                "frame": {"x": x, "y": y, "w": w, "h": h},
                "rotated": False,
                "trimmed": (w, h) != (width, height),
                "spriteSourceSize": {"x": left, "y": top, "w": w, "h": h},
                "sourceSize": {"w": width, "h": height},
                "duration": round(1000 * (number + 1) / fps) - round(1000 * number / fps),
            }
        )
    sheet_width, sheet_height = layout.size
    meta = {
        "app": "akap-editor",
        "image": display_name(path),
        "format": "RGBA8888",
        "size": {"w": sheet_width, "h": sheet_height},
        "scale": "1",
        "fps": fps,
    }
    return {"frames": frames, "meta": meta}


def _bands(images: PackedFrames, layout: _SheetLayout) -> Iterator[Picture]:
    """The sheet (h, w, 4) from top to bottom: a band for each row of sprites, with the gutter above it."""
    (left, top, right, bottom), (width, height) = layout.box, layout.sprite_size
    for first in range(0, len(images), layout.columns):
        band = np.zeros((GUTTER + height, layout.size[0], 4), dtype=np.uint8)
        for number in range(first, min(first + layout.columns, len(images))):
            x = GUTTER + (number - first) * (width + GUTTER)
            band[GUTTER:, x : x + width] = images[number][top:bottom, left:right]
        yield band
    yield np.zeros((GUTTER, layout.size[0], 4), dtype=np.uint8)
