"""Tells what a file contains."""

import json
from pathlib import Path
from typing import Any

import click

from ..display_text import display_text
from ..io.streams import named_path
from .options import INPUT


@click.command(epilog="Example: akap-editor info posed.akap --json")
@click.argument("file", type=INPUT)
@click.option("--json", "as_json", is_flag=True, help="Print the facts as JSON.")
def info(file: Path, as_json: bool) -> None:
    """Tell what FILE contains, a picture (also in layers), drawing, pose, clip, recording or mesh, and
    whether it is sound.

    The exit code is 1 if it is not sound.
    """
    from ..io.inspection import inspect

    inspection = inspect(file)
    if as_json:
        record = {
            "file": str(named_path(file)),
            "kind": inspection.kind,
            "sound": inspection.sound,
            "problems": inspection.problems,
            "facts": inspection.facts,
        }
        click.echo(json.dumps(record, indent=2))
    else:
        verdict = "sound" if inspection.sound else "not sound"
        click.echo(
            "\n".join(
                [
                    f"{display_text(named_path(file))}: {inspection.kind}, {verdict}",
                    *_fact_lines(inspection.facts),
                ]
            )
        )
        for problem in inspection.problems:
            click.echo(f"  {display_text(problem)}")
    if not inspection.sound:
        raise SystemExit(1)


def _fact_lines(facts: dict[str, Any]) -> list[str]:
    width = max(map(len, facts), default=0)
    return [f"  {name:<{width}}  {_format_value(value)}" for name, value in facts.items()]


def _format_value(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return ", ".join(f"{each:g}" for each in value)
    return display_text(value)
