"""Does recordings again, as animations."""

from pathlib import Path

import click

from ..editor.document import Drawing, make_drawing
from ..editor.recording import Recording, mesh_digest
from ..editor.replay import replay
from ..errors import InputError
from ..geometry.checks import Floats
from ..io.documents import open_document
from ..io.images import animation_suffix, read_image, write_animation
from ..io.recordings import read_recording
from .common import FILE, bundled, check_png, make_folder_of, write_picture


@click.command("replay", epilog="Example: akap-editor replay wave.akaprec --drawing cat.png -o wave.webp")
@click.argument("recording", type=FILE)
@click.option("--drawing", type=FILE, help="Picture to replay it on, where it is not a bundled one.")
@click.option("-o", "--output", type=FILE, required=True, help="Animation to write: .webp, .gif or .apng.")
@click.option("--pose", type=FILE, help="Also write the last pose as this PNG file, in full resolution.")
@click.option("--fps", default=30.0, show_default=True, help="Frames per second.")
@click.option(
    "--size", default=640, show_default=True, help="Longest side of the animation in pixels, at most."
)
def replay_command(
    recording: Path, drawing: Path | None, output: Path, pose: Path | None, fps: float, size: int
) -> None:
    """Do a recorded session again without a window and write it as an animation."""
    replay_recording(recording, drawing, output, pose, fps, size)


def replay_recording(
    path: Path, drawing_path: Path | None, animation: Path, pose: Path | None, fps: float, size: int
) -> None:
    from ..render.offscreen import OffscreenRenderer, frame_box

    if not 1 <= fps <= 120:
        raise InputError(f"--fps: expected a number from 1 to 120, got {fps:g}")
    if not 16 <= size <= 8192:
        raise InputError(f"--size: expected a number from 16 to 8192, got {size}")
    animation_suffix(animation)
    if pose is not None:
        check_png(pose)
    recording = read_recording(path)
    drawing = _drawing_of(recording, drawing_path)
    poses = _sampled(recording, drawing, fps)
    box = frame_box(drawing, poses)
    scale = min(1.0, size / max(box[2] - box[0], box[3] - box[1]))
    make_folder_of(animation)
    with OffscreenRenderer() as renderer:
        with click.progressbar(poses, label="Drawing") as bar:
            write_animation(animation, (renderer.render(drawing, p, box, scale) for p in bar), fps)
        if pose is not None:
            write_picture(pose, renderer.render(drawing, poses[-1]))
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
    picture = bundled(name)
    drawing = make_drawing(read_image(picture), name=name)
    count = recording.header.get("vertices")
    if recording.header.get("mesh") != mesh_digest(drawing.mesh) and isinstance(count, int):
        drawing = make_drawing(read_image(picture), vertices=count, name=name)
    return drawing
