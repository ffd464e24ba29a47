"""Writes the pose of a drawing as a picture."""

from pathlib import Path

import click

from .export import export_file
from .options import FILE, check_png, export_options, framing_options, overwrite_option, threshold_option


@click.command(epilog="Example: akap-editor render posed.akap -o pose.png --scale 2 --crop pose")
@click.argument("file", type=FILE)
@click.option("-o", "--output", type=FILE, required=True, help="PNG file to write.")
@framing_options
@threshold_option
@overwrite_option
def render(
    file: Path,
    output: Path,
    scale: float | None,
    background: str | None,
    crop: str | None,
    threshold: float | None,
    overwrite: bool,
) -> None:
    """Write the pose of FILE, a saved drawing or a picture, as a PNG picture."""
    check_png(output)
    options = export_options(scale, background, crop)
    click.echo(export_file(file, output, options, threshold, overwrite).text)
