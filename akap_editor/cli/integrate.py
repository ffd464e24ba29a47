"""Makes the program known to the desktop of the current user."""

import click

from ..desktop.integration import data_folder, integrate, program_command, remove_integration


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
