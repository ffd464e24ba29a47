"""The command line, with one module per command."""

import sys
from io import TextIOWrapper

import click
from click.shell_completion import CompletionItem

from .. import __version__
from ..display_text import display_text
from ..errors import AkapError
from .bench import bench
from .compare import compare_command
from .edit import edit
from .export import export_command
from .info import info
from .integrate import integrate_command
from .mesh import mesh
from .render import render
from .replay import replay_command
from .thumbnail import thumbnail


class _Main(click.Group):
    """A group of commands in which `edit` is the default: a file instead of a command is opened."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        options = {"-h", "--help", "--version"}
        has_command = args and (args[0] in self.commands or args[0] in options)
        if not has_command and not ctx.resilient_parsing:  # resilient: the shell asks for completions
            args = ["edit", *args]
        return super().parse_args(ctx, args)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Complete commands and files, which need no command."""
        return [*super().shell_complete(ctx, incomplete), CompletionItem(incomplete, type="file")]


@click.group(cls=_Main, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="akap-editor")
def cli() -> None:
    """Deform cartoons. `akap-editor FILE` opens a picture with a transparent background, or a drawing."""


for command in (
    edit,
    render,
    replay_command,
    compare_command,
    export_command,
    info,
    bench,
    mesh,
    integrate_command,
    thumbnail,
):
    cli.add_command(command)


def main() -> None:
    """Run the command line. An error of the package is one line on stderr and exit code 2.

    What the terminal has no character for is escaped.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        cli(prog_name="akap-editor", standalone_mode=False)
    except (AkapError, click.ClickException) as error:
        message = error.format_message() if isinstance(error, click.ClickException) else str(error)
        click.echo(f"akap-editor: {display_text(message, keeps_lines=True)}", err=True)
        sys.exit(2)
    except click.Abort:
        sys.exit(130)  # the shells' code for Ctrl+C
