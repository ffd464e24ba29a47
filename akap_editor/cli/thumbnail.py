"""Writes thumbnails for file managers, which call it through the installed .thumbnailer file."""

from pathlib import Path

import click

from ..desktop.thumbnail import make_thumbnail
from ..errors import FileError, InputError
from ..io.images import write_png
from ..io.outputs import same_file
from .options import FILE

MAX_SIDE = 2048


@click.command(hidden=True)
@click.argument("file", type=FILE)
@click.argument("output", type=FILE)
@click.option("--size", default=256, show_default=True, help="Longest side in pixels, at most.")
def thumbnail(file: Path, output: Path, size: int) -> None:
    """Write a thumbnail of FILE, a drawing or recording, as the PNG file OUTPUT."""
    if not 1 <= size <= MAX_SIDE:
        raise InputError(f"--size: expected a number from 1 to {MAX_SIDE}, got {size}")
    picture = make_thumbnail(file, size)
    if same_file(output, file):
        raise FileError("save", output, "it is the file that is read; choose another name")
    write_png(output, picture)
