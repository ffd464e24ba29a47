"""`akap-editor integrate`, for the current user and back."""

import click

from akap_editor.cli import cli
from akap_editor.resources import resource


def test_there_and_back(run, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    code, out, err = run("integrate")
    *paths, last = out.splitlines()
    assert (code, err, last) == (0, "", f"Installed {len(paths)} files")
    assert str(tmp_path / "data" / "applications" / "akap-editor.desktop") in paths
    code, out, err = run("integrate", "--remove")
    assert (code, err) == (0, "")
    assert out.splitlines() == [*paths, f"Removed {len(paths)} files"]


def test_the_man_page_tells_of_every_command_and_option():
    """`python tools/make_man_page.py` makes it again."""
    page = resource("assets", "desktop", "akap-editor.1").read_text("utf-8").replace("\\-", "-")
    context = click.Context(cli)
    commands = [cli.get_command(context, name) for name in cli.list_commands(context)]
    for command in commands:
        if command.hidden:
            continue
        assert f".SS \\fB{command.name}\\fR" in page
        for option in command.params:
            assert not isinstance(option, click.Option) or ", ".join(option.opts) in page
