"""Help and shell completion of all commands."""

import subprocess
import sys

import click
import pytest
from click.shell_completion import BashComplete, FishComplete, ZshComplete

from akap_editor.cli import ABOUT, cli, options
from akap_editor.deform.methods import compared_methods
from akap_editor.editor.document.drawing import Meshing
from akap_editor.io.animation.formats import ANIMATION_FORMATS, ANIMATION_SUFFIXES
from akap_editor.io.export import EXPORT_FORMATS

COMMANDS = {name: cli.get_command(click.Context(cli), name) for name in ABOUT}
VISIBLE = [name for name, command in COMMANDS.items() if not command.hidden]


@pytest.fixture
def complete():
    """What the shell is offered after some words, as pairs of kind and value."""

    def call(*words, incomplete=""):
        shell = BashComplete(cli, {}, "akap-editor", "_AKAP_EDITOR_COMPLETE")
        return [(item.type, item.value) for item in shell.get_completions(list(words), incomplete)]

    return call


def test_commands_and_files_come_first(complete):
    offered = complete()
    assert {value for kind, value in offered if kind == "plain"} == set(VISIBLE)
    assert ("file", "") in offered


def test_a_command_that_has_begun(complete):
    assert ("plain", "export") in complete(incomplete="ex")
    assert ("plain", "info") not in complete(incomplete="ex")


def test_options_and_their_values(complete):
    assert ("plain", "--crop") in complete("export", "cat.akap", incomplete="--")
    assert complete("export", "--crop") == [("plain", "none"), ("plain", "frame"), ("plain", "pose")]
    assert complete("export", incomplete="ca") == [("file", "ca")]


def test_names_of_bundled_drawings(complete):
    assert ("plain", "elephant") in complete("edit", "--bundled")
    assert complete("edit", "--bundled", incomplete="el") == [("plain", "elephant")]


def test_a_file_without_a_command_is_no_dead_end(complete):
    assert complete("cat.png") is not None


@pytest.mark.parametrize("shell", [ZshComplete, FishComplete])
def test_scripts_of_other_shells_name_the_program(shell):
    script = shell(cli, {}, "akap-editor", "_AKAP_EDITOR_COMPLETE").source()
    assert "_AKAP_EDITOR_COMPLETE" in script
    assert "akap-editor" in script


def test_the_shell_gets_its_list_from_the_program(run, monkeypatch):
    monkeypatch.setenv("_AKAP_EDITOR_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", "akap-editor ")
    monkeypatch.setenv("COMP_CWORD", "1")
    code, said, errors = run()
    assert (code, errors) == (0, "")
    assert {f"plain,{name}" for name in VISIBLE} <= set(said.splitlines())


@pytest.mark.parametrize("name", sorted(VISIBLE))
def test_each_command_has_help_with_an_example(run, name):
    code, said, errors = run(name, "--help")
    assert (code, errors) == (0, "")
    assert f"Example: akap-editor {name}" in " ".join(said.split())
    for parameter in COMMANDS[name].params:
        assert not isinstance(parameter, click.Option) or parameter.help, parameter.name


@pytest.mark.parametrize("name", ABOUT)
def test_the_list_of_commands_says_what_their_help_says(name):
    assert COMMANDS[name].name == name
    assert COMMANDS[name].get_short_help_str(1000) == ABOUT[name]


def test_the_list_of_commands_loads_nothing_that_they_need():
    code = """
import sys
from akap_editor.cli import main
sys.argv = ["akap-editor", "--help"]
main()
print(sorted({"numpy", "scipy", "shapely", "numba", "PIL", "moderngl", "imgui_bundle"} & sys.modules.keys()))
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.splitlines()[-1] == "[]"
    for name in VISIBLE:
        assert f"\n  {name} " in said


def test_help_loads_nothing_that_the_commands_need():
    code = """
import sys
from akap_editor.cli import ABOUT, cli
for name in ABOUT:
    cli([name, "--help"], standalone_mode=False)
print(sorted({"scipy", "shapely", "numba", "PIL", "moderngl", "psd_tools"} & sys.modules.keys()))
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.splitlines()[-1] == "[]"
    for name in ABOUT:
        assert f" {name} [OPTIONS]" in said


def test_help_shows_the_values_of_the_tables():
    def ending(each):
        return f"{each.suffix or 'folder/'}{' --sheet' * each.is_sheet}"

    assert list(options.EXPORT_LABELS.items()) == [(each.suffix, each.label) for each in EXPORT_FORMATS]
    descriptions = [(ending(each), each.about) for each in ANIMATION_FORMATS]
    assert list(options.ANIMATION_DESCRIPTIONS.items()) == descriptions
    assert options.ANIMATION_ENDINGS == ANIMATION_SUFFIXES
    assert list(options.COMPARED_METHODS) == compared_methods()
    assert (Meshing.vertices, Meshing.expand) == (options.MESH_VERTICES, options.MESH_MARGIN)
