"""What the commands share: files that are named, colors, checks of what is to be written."""

from collections.abc import Callable, Sequence
from inspect import cleandoc
from pathlib import Path
from typing import Any

import click

from ..editor.framing import CROPS, Color
from ..errors import FileError, InputError
from ..io.atomic import os_error_reason
from ..io.export import ExportOptions
from ..io.images import write_png
from ..resources import bundled_drawings

FILE = click.Path(path_type=Path)


_FRAMING = (
    click.option(
        "--scale", type=float, metavar="FACTOR", help="Pixels of the output per pixel of the picture."
    ),
    click.option("--background", metavar="#RRGGBB", help="Color behind the drawing; transparent without it."),
    click.option(
        "--crop",
        type=click.Choice(CROPS),
        help="Show the picture's frame and all of the pose (none), the frame alone, or the pose alone.",
    ),
)


def framing_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options that say how large a picture is and what it shows, see `export_options`."""
    for option in reversed(_FRAMING):
        command = option(command)
    return command


def export_options(
    scale: float | None, background: str | None, crop: str | None, rest: bool = False
) -> ExportOptions:
    """What the options of `framing_options` mean; None where one was not given. Raises InputError."""
    plain = ExportOptions()
    return ExportOptions(plain.scale if scale is None else scale, color(background), crop or plain.crop, rest)


def append_formats(command: click.Command, formats: Sequence[tuple[str, str]]) -> None:
    """Append a list of formats to a command's help: ending of the output and description, for each."""
    width = max(len(ending) for ending, _ in formats)
    lines = "\n".join(f"{ending:<{width}}  {about}" for ending, about in formats)
    command.help = f"{cleandoc(command.help or '')}\n\n\b\nFormats, by the ending of the output:\n{lines}"


def bundled(name: str) -> Path:
    """The picture of a bundled drawing. Raises InputError with the names that there are."""
    names = {path.stem: path for path in bundled_drawings()}
    if name not in names:
        raise InputError(f"expected the name of a bundled drawing ({', '.join(names)}), got {name!r}")
    return names[name]


def color(text: str | None) -> Color | None:
    """Red, green and blue from 0 to 1 of a color written as #RRGGBB. Raises InputError."""
    if text is None:
        return None
    digits = text.removeprefix("#")
    try:
        red, green, blue = bytes.fromhex(digits)
    except ValueError as error:
        raise InputError(f"--background: expected a color as #RRGGBB, got {text!r}") from error
    return red / 255, green / 255, blue / 255


def check_png(path: Path) -> None:
    """Raise InputError where a name does not end in .png."""
    if path.suffix.lower() != ".png":
        raise InputError(f"{path}: expected a name that ends in .png, got {path.suffix or 'none'}")


def make_folder_of(path: Path) -> None:
    """Make the folder that a file is to be written to. Raises InputError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError("save", path, os_error_reason(error)) from error


def write_picture(path: Path, picture: Any) -> None:
    """Write a picture (h, w, 4) as PNG, in a new folder if need be. Raises InputError."""
    make_folder_of(path)
    write_png(path, picture)
