"""Makes the program known to the desktop of the current user, and writes thumbnails for file managers.

These call `thumbnail` through the installed .thumbnailer file.
"""

from pathlib import Path

import click

from ..desktop.integration import data_folder, integrate, program_command, remove_integration
from ..errors import FileError, InputError
from ..io.outputs import same_file
from ..io.streams import written_path
from .options import FILE, INPUT

MAX_SIDE = 2048


@click.command("integrate", epilog="Example: akap-editor integrate")
@click.option("--remove", is_flag=True, help="Remove everything again.")
def integrate_command(remove: bool) -> None:
    """Put the program into the menus and file managers of the current user, on Linux.

    Installs a menu entry, the file types .akap and .akaprec with icons and thumbnails, and the man page below
    ~/.local/share. Run it again after the program has moved.
    """
    folder = data_folder()
    paths = remove_integration(folder) if remove else integrate(folder, program_command())
    for path in paths:
        click.echo(path)
    click.echo(f"{'Removed' if remove else 'Installed'} {len(paths)} files")


@click.command(hidden=True)
@click.argument("file", type=INPUT)
@click.argument("output", type=FILE)
@click.option("--size", default=256, show_default=True, help="Longest side in pixels, at most.")
def thumbnail(file: Path, output: Path, size: int) -> None:
    """Write a thumbnail of FILE, a drawing or recording, as the PNG file OUTPUT."""
    from ..io.file_thumbnail import make_thumbnail
    from ..io.images import write_png

    if not 1 <= size <= MAX_SIDE:
        raise InputError(f"--size: expected a number from 1 to {MAX_SIDE}, got {size}")
    picture = make_thumbnail(file, size)
    if same_file(output, file):
        raise FileError("save", output, "it is the file that is read; choose another name")
    with written_path(output, ".png") as path:
        write_png(path, picture)
