"""What players show of an animated picture."""

from pathlib import Path

import numpy as np
from PIL import Image

from .pictures import Picture


def played(path: Path) -> list[tuple[Picture, float]]:
    """The frames (h, w, 4) of an animated picture, as Pillow shows them, and for how many ms each."""
    shown = []
    with Image.open(path) as file:
        for number in range(file.n_frames):
            file.seek(number)
            file.load()
            shown.append((np.array(file.convert("RGBA")), file.info["duration"]))
    return shown


def gif_images(data: bytes) -> list[tuple[int, int, int, int]]:
    """The rectangles (left, top, width, height) of the images of a GIF, read block by block.

    Raises ValueError if anything else than the blocks of the format is found, or anything after the end.
    """
    if data[:6] != b"GIF89a":
        raise ValueError("expected the signature GIF89a")
    images, at = [], 13 + _table_size(data[10])
    while data[at : at + 1] != b";":
        if data[at : at + 1] == b"!":
            at += 2
        elif data[at : at + 1] == b",":
            left, top, width, height = np.frombuffer(data[at + 1 : at + 9], "<u2").tolist()
            images.append((left, top, width, height))
            at += 11 + _table_size(data[at + 9])
        else:
            raise ValueError(f"expected a block at byte {at}, got {data[at : at + 6]!r}")
        while data[at]:
            at += 1 + data[at]
        at += 1
    if at != len(data) - 1:
        raise ValueError(f"expected the end at byte {at}, got {len(data)} bytes")
    return images


def _table_size(flags: int) -> int:
    return 3 * 2 ** ((flags & 7) + 1) if flags & 0x80 else 0
