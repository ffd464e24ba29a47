"""Draws one pose."""

from pathlib import Path

import click

from ..io.documents import open_document
from .common import FILE, check_png, color, write_picture


@click.command(epilog="Example: akap-editor render posed.akap -o pose.png --scale 2")
@click.argument("file", type=FILE)
@click.option("-o", "--output", type=FILE, required=True, help="PNG file to write.")
@click.option(
    "--scale", default=1.0, show_default=True, help="Pixels of the output per pixel of the picture."
)
@click.option("--background", metavar="#RRGGBB", help="Color behind the drawing; transparent without it.")
def render(file: Path, output: Path, scale: float, background: str | None) -> None:
    """Write the pose of FILE, a saved drawing or a picture, as a PNG."""
    from ..render.offscreen import OffscreenRenderer

    check_png(output)
    document = open_document(file)
    with OffscreenRenderer() as renderer:
        picture = renderer.render(
            document.drawing, document.state.positions, scale=scale, background=color(background)
        )
    write_picture(output, picture)
    click.echo(f"{output}: {picture.shape[1]} × {picture.shape[0]} pixels")
