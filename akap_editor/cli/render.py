"""Writes the pose of a drawing as a picture."""

import json
from pathlib import Path

import click

from .export import export_file
from .options import (
    FILE,
    check_png,
    export_options,
    framing_options,
    json_option,
    overwrite_option,
    threshold_option,
)


@click.command(epilog="Example: akap-editor render posed.akap -o pose.png --scale 2 --crop pose")
@click.argument("file", type=FILE)
@click.option("-o", "--output", type=FILE, required=True, help="PNG file to write.")
@framing_options
@threshold_option
@overwrite_option
@json_option
def render(
    file: Path,
    output: Path,
    scale: float | None,
    background: str | None,
    crop: str | None,
    threshold: float | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the pose of FILE, a saved drawing or a picture, as a PNG picture."""
    check_png(output)
    options = export_options(scale, background, crop)
    result = export_file(file, output, options, threshold, overwrite)
    click.echo(json.dumps(result.facts, indent=2) if as_json else result.text)
