"""Exports drawings for other programs."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..display_text import display_name, display_text
from ..editor.framing import crop_box, output_size
from ..errors import InputError
from ..io.outputs import refuse_source
from ..io.streams import STREAM, written_path
from .options import (
    ANIMATION_ENDINGS,
    EXPORT_LABELS,
    FILE,
    INPUT,
    append_formats,
    check_threshold,
    export_options,
    framing_options,
    make_folder_of,
    merge_layers_option,
    mesher_option,
    output_files,
    overwrite_option,
    refuse_stream_of_several,
    refuse_unnamed,
    say,
    threshold_option,
)

if TYPE_CHECKING:
    from ..io.export import ExportFormat, ExportOptions


@dataclass(frozen=True)
class ExportResult:
    """The files of an export.

    label: of the format; files: all that were written, the named one last; size: of a picture, in pixels.
    """

    label: str
    files: list[Path]
    size: tuple[int, int] | None

    @property
    def text(self) -> str:
        """A line for people."""
        companions = ", ".join(map(display_name, self.files[:-1]))
        size = f": {self.size[0]} × {self.size[1]} pixels" if self.size else f": {self.label}"
        return f"{display_text(self.files[-1])}{size}" + (f", with {companions}" if companions else "")

    @property
    def facts(self) -> dict[str, object]:
        """The record for --json."""
        size = dict(zip(("width", "height"), self.size, strict=True)) if self.size else {}
        return {"format": self.label, "files": [str(path) for path in self.files], **size}


def export_file(
    file: Path,
    output: Path,
    options: "ExportOptions",
    threshold: float | None = None,
    overwrite: bool = False,
    mesher: str | None = None,
    merge_layers: bool = False,
) -> ExportResult:
    """Export a drawing or picture. Raises InputError."""
    from ..io.export import export, format_of
    from ..io.open_document import open_document, opening_notes
    from ..render.offscreen import OffscreenRenderer

    chosen = format_of(output)
    document = open_document(
        file, threshold=check_threshold(threshold), mesher=mesher, merge_layers=merge_layers
    )
    refuse_source(output, document.sources, overwrite)  # before anything is printed
    for note in opening_notes(document):
        click.echo(f"akap-editor: {note}", err=True)
    make_folder_of(output)
    with OffscreenRenderer() as renderer:
        files = export(document, output, options, renderer, overwrite)
    if not chosen.uses_framing:
        return ExportResult(chosen.label, files, None)
    pose = document.drawing.mesh.vertices if options.rest else document.state.positions
    size = output_size(crop_box(document.drawing, pose, options.crop), options.scale)
    return ExportResult(chosen.label, files, size)


def print_results(results: list[ExportResult], as_json: bool, output: Path) -> None:
    """Print what was written: a line a file, or as JSON an object for one file and a list for several.

    output: the value of --output; on standard output there is only the file then.
    """
    if output == STREAM:
        results = [replace(result, files=[STREAM]) for result in results]
    if as_json:
        facts = [result.facts for result in results]
        say(json.dumps(facts if len(facts) > 1 else facts[0], indent=2), output)
    else:
        say("\n".join(result.text for result in results), output)


@click.command(
    "export",
    epilog="Example: akap-editor export posed.akap -o cat.glb\n\n"
    "Example: akap-editor export posed.akap -o cat.png --scale 2 --crop pose\n\n"
    "Example: akap-editor export *.akap -o meshes --format .glb",
)
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=INPUT)
@click.option(
    "-o",
    "--output",
    type=FILE,
    required=True,
    help="File to write, or to replace; its ending sets the format. With --format, a folder for one file of "
    "each FILE, or - for stdout.",
)
@click.option(
    "--format",
    "suffix",
    type=click.Choice([*EXPORT_LABELS, *ANIMATION_ENDINGS]),
    help="Ending of the files in the folder, or format on stdout.",
)
@framing_options
@threshold_option
@merge_layers_option
@mesher_option
@overwrite_option
@click.option("--rest", is_flag=True, help="Export the rest pose.")
@click.option("--textured", is_flag=True, help="Draw an SVG with its texture instead of the outline alone.")
@click.option(
    "--z-order/--no-z-order",
    default=None,
    help="Lay what is in front nearer to the viewer in z, as ray tracers need it; by default for OBJ.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")
def export_command(
    files: tuple[Path, ...],
    output: Path,
    suffix: str | None,
    scale: float | None,
    background: str | None,
    crop: str | None,
    threshold: float | None,
    merge_layers: bool,
    mesher: str | None,
    overwrite: bool,
    rest: bool,
    textured: bool,
    z_order: bool | None,
    as_json: bool,
) -> None:
    """Export FILE, a saved drawing or a picture, for other programs."""
    from ..io.export import format_of

    if suffix is None and (len(files) > 1 or output.is_dir() or output == STREAM):
        raise InputError("--format: expected the ending of the files in the folder, or on stdout, got none")
    refuse_stream_of_several(files, output)
    given = {"--scale": scale, "--crop": crop, "--rest": rest or None, "--textured": textured or None}
    if (suffix or output.suffix.lower()) in ANIMATION_ENDINGS:
        _refuse_options({**given, "--z-order": z_order, "--threshold": threshold, "--mesher": mesher})
        _export_animations(files, output, suffix, background, overwrite, as_json)
        return
    with written_path(output, suffix or "") as target:
        outputs = [target] if suffix is None else output_files(files, target, suffix)
        chosen = format_of(outputs[0])
        if suffix is not None and chosen.suffix != suffix:
            raise InputError(f"--format: expected {chosen.suffix}, as the output's name ends, got {suffix}")
        _check_options(chosen, {**given, "--background": background}, z_order)
        options = replace(export_options(scale, background, crop, rest), textured=textured, z_order=z_order)
        refuse_unnamed(outputs, target, files, overwrite)
        results = [
            export_file(file, path, options, threshold, overwrite, mesher, merge_layers)
            for file, path in zip(files, outputs, strict=True)
        ]
    print_results(results, as_json, output)


def _check_options(chosen: "ExportFormat", given: Mapping[str, object], z_order: bool | None) -> None:
    """Raise InputError if an option is given that the format does not have."""
    for name in ("--scale", "--background", "--crop"):
        if given[name] is not None and not chosen.uses_framing:
            raise InputError(f"{name}: expected a picture or an outline as output, got {chosen.suffix}")
    if given["--textured"] and not chosen.can_be_textured:
        raise InputError(f"--textured: expected an output that ends in .svg, got {chosen.suffix}")
    if z_order is not None and chosen.z_order is None:
        raise InputError(f"--z-order: expected an output that ends in .obj or .glb, got {chosen.suffix}")


def _refuse_options(given: Mapping[str, object]) -> None:
    for name, value in given.items():
        if value is not None:
            raise InputError(f"{name}: expected a pose as output, got an animation; `replay` has its options")


def _export_animations(
    files: tuple[Path, ...],
    output: Path,
    suffix: str | None,
    background: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the keyframes of drawings as animations, as `replay` does by default."""
    from .replay import print_replays, replay_recording

    with written_path(output, suffix or output.suffix) as target:
        outputs = [target] if suffix is None else output_files(files, target, suffix)
        refuse_unnamed(outputs, target, files, overwrite)
        results = [
            replay_recording(file, None, path, background=background, overwrite=overwrite)
            for file, path in zip(files, outputs, strict=True)
        ]
    print_replays(results, as_json, output)


append_formats(
    export_command,
    [
        *EXPORT_LABELS.items(),
        (", ".join(ANIMATION_ENDINGS), "the keyframes as an animation, see `replay`"),
    ],
)
