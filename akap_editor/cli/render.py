"""Writes the pose of a drawing as a picture."""

from pathlib import Path

import click

from ..io.streams import written_path
from .export import export_file, print_results
from .options import (
    FILE,
    INPUT,
    check_png,
    export_options,
    framing_options,
    json_option,
    merge_layers_option,
    output_files,
    overwrite_option,
    refuse_stream_of_several,
    refuse_unnamed,
    threshold_option,
)


@click.command(
    epilog="Example: akap-editor render posed.akap -o pose.png --scale 2 --crop pose\n\n"
    "Example: akap-editor render *.akap -o pictures"
)
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=INPUT)
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
    refuse_stream_of_several(files, output)
    with written_path(output, ".png") as target:
        outputs = output_files(files, target, ".png")
        if outputs == [target]:
            check_png(target)
        refuse_unnamed(outputs, target, files, overwrite)
        results = [
            export_file(file, path, options, threshold, overwrite, merge_layers=merge_layers)
            for file, path in zip(files, outputs, strict=True)
        ]
    print_results(results, as_json, output)
