"""Writes the pose of a drawing as a picture."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from ..errors import InputError
from ..io.export import ExportOptions
from .export import export_file, print_results
from .options import (
    FILE,
    check_png,
    export_options,
    framing_options,
    json_option,
    merge_layers_option,
    output_files,
    overwrite_option,
    refuse_unnamed,
    threshold_option,
)

STDOUT = Path("-")


@click.command(
    epilog="Example: akap-editor render posed.akap -o pose.png --scale 2 --crop pose\n\n"
    "Example: akap-editor render *.akap -o pictures"
)
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=FILE)
@click.option(
    "-o",
    "--output",
    type=FILE,
    required=True,
    help="PNG file to write, or to replace, or a folder for one picture of each FILE; - for stdout.",
)
@framing_options
@threshold_option
@merge_layers_option
@overwrite_option
@json_option
def render(
    files: tuple[Path, ...],
    output: Path,
    scale: float | None,
    background: str | None,
    crop: str | None,
    threshold: float | None,
    merge_layers: bool,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the pose of FILE, a saved drawing or a picture, as a PNG picture."""
    options = export_options(scale, background, crop)
    if output == STDOUT:
        _write_to_stdout(files, options, threshold, merge_layers)
        return
    outputs = output_files(files, output, ".png")
    if outputs == [output]:
        check_png(output)
    refuse_unnamed(outputs, output, files, overwrite)
    results = [
        export_file(file, target, options, threshold, overwrite, merge_layers=merge_layers)
        for file, target in zip(files, outputs, strict=True)
    ]
    print_results(results, as_json)


def _write_to_stdout(
    files: tuple[Path, ...], options: ExportOptions, threshold: float | None, merge_layers: bool
) -> None:
    """Write the picture of one file to stdout. Raises InputError."""
    if len(files) > 1:
        raise InputError(f"--output: expected a folder for the pictures of {len(files)} files, got -")
    with TemporaryDirectory() as folder:
        picture = Path(folder) / "pose.png"
        export_file(files[0], picture, options, threshold, merge_layers=merge_layers)
        sys.stdout.buffer.write(picture.read_bytes())
