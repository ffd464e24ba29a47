"""Says what a file is."""

import json
from pathlib import Path
from typing import Any

import click

from ..io.inspection import inspect
from .options import FILE


@click.command(epilog="Example: akap-editor info posed.akap --json")
@click.argument("file", type=FILE)
@click.option("--json", "as_json", is_flag=True, help="Print the facts as JSON.")
def info(file: Path, as_json: bool) -> None:
    """Say what FILE is: a picture, a drawing, a pose, a recording or a mesh; and whether it is sound.

    The exit code is 1 where it is not.
    """
    found = inspect(file)
    if as_json:
        record = {"file": str(file), "kind": found.kind, "sound": found.sound}
        click.echo(json.dumps({**record, "problems": found.problems, "facts": found.facts}, indent=2))
    else:
        verdict = "sound" if found.sound else "not sound"
        click.echo("\n".join([f"{file}: {found.kind}, {verdict}", *_lines(found.facts)]))
        for problem in found.problems:
            click.echo(f"  {problem}")
    if not found.sound:
        raise SystemExit(1)


def _lines(facts: dict[str, Any]) -> list[str]:
    width = max(map(len, facts), default=0)
    return [f"  {name:<{width}}  {_words(value)}" for name, value in facts.items()]


def _words(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(f"{each:g}" for each in value)
    return str(value)
