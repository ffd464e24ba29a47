"""Options that several commands share, and checks of their values."""

import sys
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from inspect import cleandoc
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..display_text import display_text
from ..editor.framing import CROPS, Color
from ..errors import FileError, InputError
from ..io.atomic import os_error_reason
from ..io.outputs import refuse_replacing, refuse_source
from ..io.streams import STREAM, read_stream, stream_folder
from ..meshing.meshers import MESHERS
from ..resources import bundled_files

if TYPE_CHECKING:
    from click._termui_impl import ProgressBar

    from ..io.export import ExportOptions

FILE = click.Path(path_type=Path)


class InputFile(click.Path):
    """A file to read, as a path; - reads standard input, which is a file while the command runs."""

    def __init__(self) -> None:
        super().__init__(path_type=Path, allow_dash=True)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        path = super().convert(value, param, ctx)
        if path != STREAM or ctx is None:
            return path
        folder = stream_folder()
        ctx.call_on_close(folder.cleanup)
        return read_stream(Path(folder.name))


INPUT = InputFile()
T = TypeVar("T")

# Values that help shows, equal to those of the tables and classes that they name, which take half a second to
# load. A test compares them.
EXPORT_LABELS = {  # of `EXPORT_FORMATS`
    ".png": "PNG picture",
    ".svg": "SVG",
    ".glb": "glTF binary",
    ".obj": "Wavefront OBJ",
    ".spine.json": "Spine skeleton",
    ".json": "Mesh and pins",
}
ANIMATION_DESCRIPTIONS = {  # of `ANIMATION_FORMATS`
    ".webp": "An animation for the web: all colors, soft edges, small.",
    ".gif": "An animation that plays everywhere: 255 colors, hard edges.",
    ".apng": "An animation: all colors, soft edges, large.",
    ".mp4": "A video (H.264) without transparency.",
    ".webm": "A video (VP9) with transparency.",
    ".html": "A page that plays in browsers, sharp at any size.",
    "folder/": "A folder with one PNG per frame.",
    ".png --sheet": "One PNG with all frames, and a JSON index, for games.",
    ".png": "The last frame as a PNG.",
}
ANIMATION_ENDINGS = (".webp", ".gif", ".apng", ".mp4", ".webm", ".html")  # `ANIMATION_SUFFIXES`
COMPARED_METHODS = (  # of `compared_methods`
    "akap",
    "akap:memory=1",
    "akap:no-dirichlet",
    "akap:trajectory=linear",
    "arap",
    "igarashi",
    "cauchy-green",
    "mls",
)
MESH_VERTICES, MESH_MARGIN = 2000, 2.0  # of `Meshing`

_FRAMING = (
    click.option(
        "--scale", type=float, metavar="FACTOR", help="Pixels of the output per pixel of the drawing."
    ),
    click.option("--background", metavar="#RRGGBB", help="Background color; transparent by default."),
    click.option(
        "--crop",
        type=click.Choice(CROPS),
        help="none: picture frame and whole pose; frame: picture frame only; pose: pose only.",
    ),
)


overwrite_option = click.option(
    "--overwrite",
    is_flag=True,
    help="Replace also files that are read, and existing files that --output does not name: materials, "
    "textures, indices, files in a folder.",
)

threshold_option = click.option(
    "--threshold",
    type=float,
    metavar="SHARE",
    help="Share of full opacity at which a picture ends; by default 0.5, less for faint pictures.",
)


merge_layers_option = click.option(
    "--merge-layers",
    is_flag=True,
    help="Merge the visible layers of a picture in layers into one drawing.",
)

mesher_option = click.option(
    "--mesher",
    type=click.Choice(list(MESHERS)),
    help="Program that makes the mesh; by default triangle, if it is installed.",
)


json_option = click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")


def progress_bar(items: Iterable[T] | None, length: int, label: str) -> "ProgressBar[T]":
    """A progress bar on stderr, if that is a terminal; stdout is for results."""
    file = sys.stderr if sys.stderr.isatty() else StringIO()
    return click.progressbar(items, length, label, file=file)


def check_threshold(threshold: float | None) -> float | None:
    """Return a value of --threshold. Raises InputError if it is not between 0 and 1."""
    if threshold is not None and not 0 < threshold < 1:
        raise InputError(f"--threshold: expected a share between 0 and 1, got {threshold:g}")
    return threshold


def framing_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options for scale, background and crop to a command; see `export_options`."""
    for option in reversed(_FRAMING):
        command = option(command)
    return command


def export_options(
    scale: float | None, background: str | None, crop: str | None, rest: bool = False
) -> "ExportOptions":
    """The options of `framing_options`, of which None is the default, as `export` takes them.

    Raises InputError.
    """
    from ..io.export import ExportOptions

    defaults = ExportOptions()
    scale = defaults.scale if scale is None else scale
    return ExportOptions(scale, parse_color(background), crop or defaults.crop, rest)


def parse_numbers(option: str, text: str, low: int, high: int) -> list[int]:
    """The integers from ``low`` to ``high`` of a list separated by commas. Raises InputError."""
    try:
        numbers = [int(part) for part in text.split(",") if part.strip()]
    except ValueError:
        numbers = []
    if not numbers:
        raise InputError(f"{option}: expected numbers separated by commas, got {text!r}")
    for number in numbers:
        if not low <= number <= high:
            raise InputError(f"{option}: expected numbers from {low} to {high}, got {number}")
    return numbers


def append_formats(command: click.Command, formats: Sequence[tuple[str, str]]) -> None:
    """Append a list of formats to a command's help: ending of the output and description, for each."""
    width = max(len(ending) for ending, _ in formats)
    lines = "\n".join(f"{ending:<{width}}  {about}" for ending, about in formats)
    command.help = f"{cleandoc(command.help or '')}\n\n\b\nFormats, by the ending of the output:\n{lines}"


def bundled(name: str) -> Path:
    """The picture file of a bundled drawing. Raises InputError, which lists their names."""
    names = {path.stem: path for path in bundled_files()}
    if name not in names:
        raise InputError(f"expected the name of a bundled drawing ({', '.join(names)}), got {name!r}")
    return names[name]


def parse_color(text: str | None) -> Color | None:
    """The color written as #RRGGBB; None for None. Raises InputError."""
    if text is None:
        return None
    digits = text.removeprefix("#")
    try:
        red, green, blue = bytes.fromhex(digits)
    except ValueError as error:
        raise InputError(f"--background: expected a color as #RRGGBB, got {text!r}") from error
    return red / 255, green / 255, blue / 255


def say(text: str, output: Path | None = None) -> None:
    """Print a result; on stderr if ``output`` is standard output, which then holds the file."""
    click.echo(text, err=output == STREAM)


def check_png(path: Path) -> None:
    """Raise FileError if a name does not end in .png."""
    if path.suffix.lower() != ".png":
        raise FileError("save", path, f"expected a name that ends in .png, got {path.suffix or 'none'}")


def check_suffix(path: Path, suffix: str) -> None:
    """Raise FileError if a name does not end as files of its kind do."""
    if not path.name.lower().endswith(suffix):
        raise FileError("save", path, f"expected a name that ends in {suffix}")


def make_folder_of(path: Path) -> None:
    """Make the folder for a file that will be written. Raises FileError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError("save", path, os_error_reason(error)) from error


def output_files(files: Sequence[Path], output: Path, suffix: str) -> list[Path]:
    """What is written for each of ``files``: ``output`` for one, files in the folder ``output`` for several.

    A folder that exists takes one, too. suffix: of the names in the folder. Raises InputError if ``output``
    is no folder for several, or if two would have the same name.
    """
    if len(files) == 1 and not output.is_dir():
        return [output]
    if (output.exists() and not output.is_dir()) or output.name.lower().endswith(suffix):
        raise FileError(
            "save", output, f"expected a folder for the results of {len(files)} files, got a file"
        )
    name, count = Counter(file.stem for file in files).most_common(1)[0]
    if count > 1:
        raise InputError(
            f"expected files of different names, got {count} that would become {display_text(name)}{suffix}"
        )
    return [output / f"{file.stem}{suffix}" for file in files]


def refuse_stream_of_several(files: Sequence[Path], output: Path) -> None:
    """Raise InputError if the results of several files are to go to standard output."""
    if output == STREAM and len(files) > 1:
        raise InputError(f"--output: expected a folder for the results of {len(files)} files, got -")


def refuse_unnamed(outputs: Sequence[Path], output: Path, sources: Sequence[Path], overwrite: bool) -> None:
    """Raise FileError if ``outputs`` replace files of a folder, or ``sources``, unless ``overwrite``.

    output: the value of --output, the only file that may be replaced.
    """
    for path in outputs:
        refuse_source(path, sources, overwrite)
    refuse_replacing(output, (path for path in outputs if path != output), overwrite)


def write_picture(path: Path, picture: Any) -> None:
    """Write a picture (h, w, 4) as PNG; make its folder if necessary. Raises FileError."""
    from ..io.images import write_png

    make_folder_of(path)
    write_png(path, picture)
