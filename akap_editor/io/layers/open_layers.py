"""Opens pictures in layers: Photoshop and OpenRaster files, and folders of PNG pictures."""

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from ...display_text import display_name
from ...errors import FileError, InputError, file_errors
from ...layers.composite import hidden_layers
from ...layers.layered_picture import Layer, LayeredPicture, trimmed
from ...progress import announce
from ...words import mark, tr, tr_plural
from ..atomic import as_path, open_file, os_error_reason
from ..images import read_image
from .limits import LayerBudget, quoted
from .ora import ORA_MIMETYPE, decode_ora

PSD_MAGIC = b"8BPS"
_MAX_NAMED = 5  # layers or parts named in a sentence


def _decode_psd(file: BinaryIO) -> LayeredPicture:
    from .psd import decode_psd  # psd-tools takes 0.2 s to load

    return decode_psd(file)


_DECODERS: dict[str, Callable[[BinaryIO], LayeredPicture]] = {
    ".psd": _decode_psd,
    ".psb": _decode_psd,
    ".ora": decode_ora,
}
LAYER_SUFFIXES = tuple(_DECODERS)


def is_layered(path: str | Path) -> bool:
    """Whether `open_layers` opens a path: by the ending of its name, or because it is a folder."""
    path = as_path(path)
    return path.suffix.lower() in LAYER_SUFFIXES or path.is_dir()


def open_layers(path: str | Path) -> LayeredPicture:
    """Open the layers of a Photoshop file (.psd, .psb), an OpenRaster file (.ora) or a folder.

    Of a folder they are its PNG pictures, which must have one size; the first one by name is at the bottom,
    and numbers in names count as numbers. Each layer is cut to its visible pixels. Raises FileError.

    >>> from akap_editor import open_layers
    >>> puppet = open_layers("robot.ora")
    >>> for layer in puppet.layers[:2]:
    ...     print("/".join(layer.path), layer.offset, layer.picture.shape)
    arm left/arm upper left (604, 452) (184, 226, 4)
    arm left/arm lower left (738, 264) (368, 202, 4)
    """
    path = as_path(path)
    if path.is_dir():
        return _open_folder(path)
    decode = _DECODERS.get(path.suffix.lower())
    if decode is None:
        endings = ", ".join(LAYER_SUFFIXES)
        got = path.suffix or tr("no ending")
        reason = tr("expected a folder or a file that ends in {endings}, got {got}", endings=endings, got=got)
        raise FileError("open", path, reason)
    with open_file(path, mark("a picture in layers")) as file, file_errors("open", path):
        return decode(file)


def decode_layers(data: bytes, suffix: str = ".ora") -> LayeredPicture:
    """The layers in the bytes of a Photoshop or OpenRaster file. Raises InputError.

    suffix: of the file's name, one of `LAYER_SUFFIXES`; it decides if the first bytes do not tell.
    """
    decode = (
        _decode_psd if data.startswith(PSD_MAGIC) else decode_ora if has_layers(data) else _DECODERS[suffix]
    )
    return decode(BytesIO(data))


def has_layers(data: bytes) -> bool:
    """Whether the first bytes of a file are those of a Photoshop or OpenRaster file."""
    return data.startswith(PSD_MAGIC) or b"mimetype" + ORA_MIMETYPE in data[:100]


def merging_notes(layered: LayeredPicture) -> list[str]:
    """Sentences without period about what a flat drawing of a picture in layers shows and leaves out."""
    hidden = hidden_layers(layered)
    shown = len(layered.layers) - len(hidden)
    notes = [
        tr_plural(
            "{count} layer was merged into one drawing", "{count} layers were merged into one drawing", shown
        )
    ]
    if hidden:
        names, count = _listed([quoted(layer.name) for layer in hidden]), len(hidden)
        notes.append(
            tr_plural(
                "{count} hidden layer was left out: {names}",
                "{count} hidden layers were left out: {names}",
                count,
                names=names,
            )
        )
    return notes + left_out_notes(layered)


def left_out_notes(layered: LayeredPicture) -> list[str]:
    """A sentence without period about what a file contains and the layers do not; none if that is nothing."""
    if not layered.left_out:
        return []
    return [tr("Not drawn: {names}", names=_listed(list(layered.left_out)))]


def _listed(names: list[str]) -> str:
    """The names separated by commas; of many, the first ones and the number of the others."""
    others = len(names) - _MAX_NAMED
    if others < 2:
        return ", ".join(names)
    return tr("{names} and {count} more", names=", ".join(names[:_MAX_NAMED]), count=others)


def _open_folder(folder: Path) -> LayeredPicture:
    """The PNG pictures of a folder as layers. Raises FileError."""
    try:
        paths = [
            path
            for path in folder.iterdir()
            if path.suffix.lower() == ".png" and not path.name.startswith(".") and path.is_file()
        ]
    except OSError as error:
        raise FileError("open", folder, os_error_reason(error)) from error
    if not paths:
        raise FileError("open", folder, tr("the folder contains no PNG pictures, which would be its layers"))
    size: tuple[int, int] | None = None
    layers, budget = [], LayerBudget()
    for number, path in enumerate(sorted(paths, key=_natural_key)):
        announce(number / (len(paths) + 1), tr("Reading the layer {name}", name=quoted(path.stem)))
        picture = read_image(path)
        with file_errors("open", folder):
            came = picture.shape[1], picture.shape[0]
            size = size or came
            if came != size:
                text = mark(
                    "expected pictures of one size, {size} pixels like the first one, got {file} with {other}"
                )
                size_text, other = (f"{width} x {height}" for width, height in (size, came))
                raise InputError(tr(text, size=size_text, file=display_name(path), other=other))
            budget.add_layer()
            cut = trimmed(picture, (0, 0))
            if cut is not None:
                budget.add_pixels(cut[0].size // 4)
                layers.append(Layer(path.stem, *cut))
    if not layers or size is None:
        raise FileError("open", folder, tr("its pictures are fully transparent"))
    return LayeredPicture(size, tuple(layers))


def _natural_key(path: Path) -> tuple[list[tuple[int, str]], str]:
    """A key that sorts "layer 2" before "layer 10"."""
    parts = re.split(r"([0-9]+)", path.stem.casefold())
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in parts], path.name
