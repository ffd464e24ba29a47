"""Makes the man page from the help of the commands; run it after changing that.

Run from the project's root: python tools/make_man_page.py
"""

import re
from inspect import cleandoc

import click

from akap_editor import __version__
from akap_editor.cli import cli
from akap_editor.resources import resource

FILES = (
    (r"~/.config/akap\-editor/preferences.json", "preferences, recent files and the state of the window"),
    (r"~/.local/state/akap\-editor/", "copies of unsaved work, which the next start offers after a crash"),
)


def escape(text: str) -> str:
    """Text in which troff finds no commands."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return re.sub(r"(?m)^([.'])", r"\\&\1", text)


def paragraphs(text: str) -> list[str]:
    """The paragraphs of a help text; lists, which begin with a line "\\b", keep their lines."""
    lines: list[str] = []
    for block in cleandoc(text).split("\n\n"):
        if block.startswith("\b"):
            lines += [".PP", ".nf", escape(block.removeprefix("\b").strip("\n")), ".fi"]
        else:
            lines += [".PP", escape(" ".join(block.split()))]
    return lines


def option_lines(command: click.Command) -> list[str]:
    """The options of a command with their help."""
    lines = []
    for parameter in command.params:
        if not isinstance(parameter, click.Option):
            continue
        names = ", ".join(parameter.opts)
        kind = "" if parameter.is_flag else f" {parameter.make_metavar(click.Context(command))}"
        values = parameter.default if isinstance(parameter.default, tuple) else [parameter.default]
        has_default = parameter.show_default and parameter.default is not None
        default = f" Default: {' '.join(map(str, values))}." if has_default else ""
        lines += [".TP", rf"\fB{escape(names)}\fR{escape(kind)}", escape((parameter.help or "") + default)]
    return lines


def man_page() -> str:
    """The whole page in troff."""
    lines = [
        rf'.TH AKAP\-EDITOR 1 "" "akap\-editor {__version__}" "User Commands"',
        ".SH NAME",
        r"akap\-editor \- bend and animate cartoons with pins",
        ".SH SYNOPSIS",
        r"\fBakap\-editor\fR [\fIFILE\fR]",
        ".br",
        r"\fBakap\-editor\fR \fICOMMAND\fR [\fIOPTION\fR]...",
        ".SH DESCRIPTION",
        r"\fBakap\-editor\fR opens a picture with a transparent background, cuts it out and makes a mesh.",
        "Pins on the drawing are dragged, and it bends in real time.",
        "Without a command, FILE is opened in a window.",
        ".SH COMMANDS",
    ]
    context = click.Context(cli)
    for name in sorted(cli.list_commands(context)):
        command = cli.get_command(context, name)
        if command is None or command.hidden:
            continue
        arguments = " ".join(
            parameter.make_metavar(click.Context(command))
            for parameter in command.params
            if isinstance(parameter, click.Argument)
        )
        lines.append(rf".SS \fB{escape(name)}\fR {escape(arguments)}".rstrip())
        lines += [*paragraphs(command.help or ""), *option_lines(command)]
        lines += paragraphs(command.epilog) if command.epilog else []
    lines.append(".SH FILES")
    for path, about in FILES:
        lines += [".TP", rf"\fI{path}\fR", escape(about)]
    lines += [".SH EXIT STATUS", "0 on success, 1 if some of the files could not be used, 2 on an error."]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write assets/desktop/akap-editor.1."""
    path = resource("assets", "desktop") / "akap-editor.1"
    path.write_text(man_page(), encoding="utf-8")
    print(path)


if __name__ == "__main__":
    main()
