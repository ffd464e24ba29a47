"""The command line: the same session, with or without a window."""

import os
import sys
from pathlib import Path
from typing import Any

import click

from . import __version__
from .editor.document import Document, Drawing, make_drawing
from .editor.recording import Recording, mesh_digest
from .editor.replay import replay
from .errors import AkapError, DisplayError, InputError
from .geometry.checks import Floats
from .io.documents import open_document
from .io.images import animation_suffix, read_image, write_animation, write_png
from .io.recordings import read_recording
from .resources import bundled_drawings, resource

FIRST_DRAWING = "elephant"
OUTPUT_FOLDER = Path("out")

_FILE = click.Path(path_type=Path)


class _Main(click.Group):
    """A file in place of a command is opened in the editor."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        options = {"-h", "--help", "--version"}
        if not args or (args[0] not in self.commands and args[0] not in options):
            args = ["edit", *args]
        return super().parse_args(ctx, args)


@click.group(cls=_Main, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="akap-editor")
def cli() -> None:
    """Bend cartoons. `akap-editor FILE` opens a picture with a transparent background, or a saved drawing."""


@cli.command(epilog="Example: akap-editor edit cat.png")
@click.argument("file", type=_FILE, required=False)
def edit(file: Path | None) -> None:
    """Open FILE in the window: a picture, or a drawing saved as .akap. Without FILE, a bundled cartoon.

    Where there is no display, the bundled recording is replayed without a window instead.
    """
    document = open_document(file if file is not None else _bundled(FIRST_DRAWING))
    try:
        _edit(document)
    except DisplayError as error:
        if file is not None:
            raise
        click.echo(f"No window: {error}. Replaying the bundled recording without one.")
        recording = resource("assets", "recordings", f"{FIRST_DRAWING}.akaprec")
        animation = OUTPUT_FOLDER / f"{FIRST_DRAWING}.webp"
        _replay(recording, None, animation, animation.with_suffix(".png"), fps=24.0, size=480)


def _edit(document: Document) -> None:
    x11 = sys.platform.startswith("linux")
    if x11 and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise DisplayError("there is no display")
    try:
        from .app.window import Window
    except ImportError as error:
        raise DisplayError(f"a library that windows need is missing ({error})") from error
    with Window() as window:
        window.run(document)


@cli.command(epilog="Example: akap-editor render posed.akap -o pose.png --scale 2")
@click.argument("file", type=_FILE)
@click.option("-o", "--output", type=_FILE, required=True, help="PNG file to write.")
@click.option(
    "--scale", default=1.0, show_default=True, help="Pixels of the output per pixel of the picture."
)
@click.option("--background", metavar="#RRGGBB", help="Color behind the drawing; transparent without it.")
def render(file: Path, output: Path, scale: float, background: str | None) -> None:
    """Write the pose of FILE, a saved drawing or a picture, as a PNG."""
    from .render.offscreen import OffscreenRenderer

    _check_png(output)
    document = open_document(file)
    with OffscreenRenderer() as renderer:
        picture = renderer.render(
            document.drawing, document.state.positions, scale=scale, background=_color(background)
        )
    _write_png(output, picture)
    click.echo(f"{output}: {picture.shape[1]} × {picture.shape[0]} pixels")


@cli.command("replay", epilog="Example: akap-editor replay wave.akaprec --drawing cat.png -o wave.webp")
@click.argument("recording", type=_FILE)
@click.option("--drawing", type=_FILE, help="Picture to replay it on, where it is not a bundled one.")
@click.option("-o", "--output", type=_FILE, required=True, help="Animation to write: .webp, .gif or .apng.")
@click.option("--pose", type=_FILE, help="Also write the last pose as this PNG file, in full resolution.")
@click.option("--fps", default=30.0, show_default=True, help="Frames per second.")
@click.option(
    "--size", default=640, show_default=True, help="Longest side of the animation in pixels, at most."
)
def replay_command(
    recording: Path, drawing: Path | None, output: Path, pose: Path | None, fps: float, size: int
) -> None:
    """Do a recorded session again without a window and write it as an animation."""
    _replay(recording, drawing, output, pose, fps, size)


def _replay(
    path: Path, drawing_path: Path | None, animation: Path, pose: Path | None, fps: float, size: int
) -> None:
    from .render.offscreen import OffscreenRenderer, frame_box

    if not 1 <= fps <= 120:
        raise InputError(f"--fps: expected a number from 1 to 120, got {fps:g}")
    if not 16 <= size <= 8192:
        raise InputError(f"--size: expected a number from 16 to 8192, got {size}")
    animation_suffix(animation)
    if pose is not None:
        _check_png(pose)
    recording = read_recording(path)
    drawing = _drawing_of(recording, drawing_path)
    poses = _sampled(recording, drawing, fps)
    box = frame_box(drawing, poses)
    scale = min(1.0, size / max(box[2] - box[0], box[3] - box[1]))
    _make_folder_of(animation)
    with OffscreenRenderer() as renderer:
        with click.progressbar(poses, label="Drawing") as bar:
            write_animation(animation, (renderer.render(drawing, p, box, scale) for p in bar), fps)
        if pose is not None:
            _write_png(pose, renderer.render(drawing, poses[-1]))
            click.echo(f"Wrote {pose}, the last pose")
    click.echo(f"Wrote {animation}, {len(poses)} frames at {fps:g} per second")


def _sampled(recording: Recording, drawing: Drawing, fps: float) -> list[Floats]:
    """The pose at each frame's time."""
    poses: list[Floats] = [drawing.mesh.vertices]
    with click.progressbar(replay(recording, drawing), length=len(recording.events), label="Bending") as bar:
        for time, state in bar:
            while len(poses) <= time * fps:
                poses.append(poses[-1])
            poses[-1] = state.positions
    return poses


def _drawing_of(recording: Recording, path: Path | None) -> Drawing:
    """The drawing that a recording was made on: the file given, or the bundled one that it names."""
    if path is not None:
        return open_document(path).drawing
    name = str(recording.header.get("name"))
    picture = _bundled(name)
    drawing = make_drawing(read_image(picture), name=name)
    count = recording.header.get("vertices")
    if recording.header.get("mesh") != mesh_digest(drawing.mesh) and isinstance(count, int):
        drawing = make_drawing(read_image(picture), vertices=count, name=name)
    return drawing


def _bundled(name: str) -> Path:
    names = {path.stem: path for path in bundled_drawings()}
    if name not in names:
        raise InputError(
            f"drawing: expected a bundled one ({', '.join(names)}), got {name!r}; "
            "name its file with --drawing"
        )
    return names[name]


def _color(text: str | None) -> tuple[float, float, float] | None:
    if text is None:
        return None
    digits = text.removeprefix("#")
    try:
        red, green, blue = bytes.fromhex(digits)
    except ValueError as error:
        raise InputError(f"--background: expected a color as #RRGGBB, got {text!r}") from error
    return red / 255, green / 255, blue / 255


def _check_png(path: Path) -> None:
    if path.suffix.lower() != ".png":
        raise InputError(f"{path}: expected a name that ends in .png, got {path.suffix or 'none'}")


def _make_folder_of(path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from error


def _write_png(path: Path, picture: Any) -> None:
    _make_folder_of(path)
    write_png(path, picture)


def main() -> None:
    """Run the command line; what goes wrong on purpose is one line on stderr and exit code 2."""
    try:
        cli(prog_name="akap-editor", standalone_mode=False)
    except (AkapError, click.ClickException) as error:
        message = error.format_message() if isinstance(error, click.ClickException) else str(error)
        click.echo(f"akap-editor: {message}", err=True)
        sys.exit(2)
    except click.Abort:
        sys.exit(130)  # as shells say of a program that Ctrl+C ended


if __name__ == "__main__":
    main()
