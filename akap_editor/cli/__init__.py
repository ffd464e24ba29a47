"""The command line, with one module per command."""

import sys
from io import TextIOWrapper

import click
from click.shell_completion import CompletionItem

from .. import __version__
from ..display_text import display_text
from ..errors import AkapError

# The first lines of the commands' help: a list of them needs nothing of what the commands do.
ABOUT = {
    "edit": "Open FILE in a window: a picture, also in layers (PSD, ORA, a folder of PNG pictures), a flat "
    "OBJ or OFF mesh, a drawing saved as .akap, or a recording, which is then on the timeline.",
    "render": "Write the pose of FILE, a saved drawing or a picture, as a PNG picture.",
    "replay": "Replay a recording, or the keyframes of a drawing saved as .akap, as an animation or a "
    "picture.",
    "compare": "Replay recordings with several methods and write a report: index.html and comparison.json.",
    "export": "Export FILE, a saved drawing or a picture, for other programs.",
    "clip": "Apply a clip, a motion of named pins, to a drawing; save one; list the bundled ones.",
    "info": "Tell what FILE contains, a picture (also in layers), drawing, pose, clip, recording or mesh, "
    "and whether it is sound.",
    "bench": "Measure deformation methods on this computer: the bundled elephant lifts its trunk, one step "
    "per frame.",
    "mesh": "Make a mesh of each PICTURE, or of all pictures in a folder, and report its quality.",
    "integrate": "Put the program into the menus and file managers of the current user, on Linux.",
    "thumbnail": "Write a thumbnail of FILE, a drawing or recording, as the PNG file OUTPUT.",
}
_HIDDEN = {"thumbnail"}


def _load_command(name: str) -> click.Command:
    """Import a command, and with it all that it needs."""
    if name == "edit":
        from .edit import edit

        return edit
    if name == "render":
        from .render import render

        return render
    if name == "replay":
        from .replay import replay_command

        return replay_command
    if name == "compare":
        from .compare import compare_command

        return compare_command
    if name == "export":
        from .export import export_command

        return export_command
    if name == "clip":
        from .clip import clip_group

        return clip_group
    if name == "info":
        from .info import info

        return info
    if name == "bench":
        from .bench import bench

        return bench
    if name == "mesh":
        from .mesh.command import mesh

        return mesh
    if name == "integrate":
        from .desktop import integrate_command

        return integrate_command
    from .desktop import thumbnail

    return thumbnail


class _Main(click.Group):
    """A group of commands in which `edit` is the default: a file instead of a command is opened.

    A command is imported when it is used, because what most of them need takes a second to load.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(ABOUT)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in ABOUT and cmd_name not in self.commands:
            self.add_command(_load_command(cmd_name))
        return self.commands.get(cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """List the commands without importing them."""
        shown = [name for name in sorted(ABOUT) if name not in _HIDDEN]
        limit = formatter.width - 6 - max(map(len, shown))
        rows = [(name, click.Command(name, help=ABOUT[name]).get_short_help_str(limit)) for name in shown]
        with formatter.section("Commands"):
            formatter.write_dl(rows)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        options = {"-h", "--help", "--version"}
        has_command = args and (args[0] in ABOUT or args[0] in options)
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
        if "akap-stream-" in message:
            from ..io.streams import without_stream_folders

            message = without_stream_folders(message)
        click.echo(f"akap-editor: {display_text(message, keeps_lines=True)}", err=True)
        sys.exit(2)
    except click.Abort:
        sys.exit(130)  # the shells' code for Ctrl+C
