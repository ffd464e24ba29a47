"""Applies clips to drawings, saves motions as clips, and lists the bundled clips."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..display_text import display_text
from ..errors import InputError
from ..geometry.validation import as_number
from ..io.streams import STREAM, written_path
from .options import FILE, INPUT, check_suffix, make_folder_of, progress_bar, say

if TYPE_CHECKING:
    from click._termui_impl import ProgressBar

    from ..editor.animation.clips.clip import Clip
    from ..editor.document.document import Document
    from ..editor.document.keyframes import Keyframe


@click.group("clip", epilog="Example: akap-editor clip apply Wave posed.akap -o waving.akap")
def clip_group() -> None:
    """Apply a clip, a motion of named pins, to a drawing; save one; list the bundled ones."""


@clip_group.command(
    "apply", epilog="Example: akap-editor clip apply Wave posed.akap -o waving.akap --repeat 2"
)
@click.argument("clip")
@click.argument("file", type=INPUT)
@click.option("-o", "--output", type=FILE, required=True, help="The .akap file to write; - for stdout.")
@click.option("--at", type=float, default=0.0, metavar="SECONDS", help="Time of the first keyframe.")
@click.option("--speed", type=float, default=1.0, metavar="FACTOR", help="2 is twice as fast.")
@click.option("--repeat", type=int, default=1, metavar="COUNT", help="How often the clip plays.")
@click.option("--mirror", is_flag=True, help="Exchange left and right.")
def apply_command(
    clip: str, file: Path, output: Path, at: float, speed: float, repeat: int, mirror: bool
) -> None:
    """Make keyframes of CLIP, the name of a bundled clip or a .clip.json file, for the drawing FILE."""
    from ..io.akap.project import PROJECT_SUFFIX, save
    from ..io.open_document import open_document

    if output != STREAM:
        check_suffix(output, PROJECT_SUFFIX)
    as_number(speed, "--speed", 0.01, 100)
    as_number(repeat, "--repeat", 1, 1000)
    as_number(at, "--at", 0, 3600)
    document = open_document(file)
    chosen = _find_clip(clip)
    chosen = chosen.mirrored() if mirror else chosen
    document = with_clip(document, chosen, at, speed, repeat)
    with written_path(output, PROJECT_SUFFIX) as path:
        make_folder_of(path)
        save(document, path)
    count = len(document.state.animation.keyframes)
    say(f"{display_text(output)}: {count} keyframes, {document.state.animation.duration:.2f} s", output)


def with_clip(
    document: "Document", clip: "Clip", start: float, speed: float = 1.0, repeats: int = 1
) -> "Document":
    """The document with the keyframes of a clip, and the pins that a bundled drawing lacks for it.

    Raises InputError, SolverError.
    """
    from ..editor.animation.clips.clip import named_pins, pins_with_names
    from ..editor.animation.clips.retargeting import apply_clip
    from ..editor.animation.keyframing.group_edits import insert_edits
    from ..io.akap.clip import bundled_pins

    pins = document.state.pins
    if not named_pins(pins).keys() & set(clip.names):
        pins = pins_with_names(document.drawing, document.state, bundled_pins(document.drawing))
    state = replace(document.state, pins=pins)
    keyframes: list[Keyframe] = []
    bar: ProgressBar[None]
    with progress_bar(None, 1000, "Posing") as bar:
        shown = 0
        for each in apply_clip(clip, document.with_state(state), start, speed, repeats):
            if isinstance(each, list):
                keyframes = each
            else:
                bar.update(round(1000 * each) - shown)
                shown = round(1000 * each)
        bar.update(1000 - shown)
    for edit in insert_edits(state.animation, keyframes):
        state = edit.apply(state, document.drawing)
    return document.with_state(state)


def _find_clip(name: str) -> "Clip":
    """A bundled clip by its name, or the one in a file. Raises InputError."""
    from ..io.akap.clip import CLIP_SUFFIX, bundled_clips, load_clip

    bundled = {clip.name.lower(): clip for clip in bundled_clips()}
    if name.lower() in bundled:
        return bundled[name.lower()]
    if not name.endswith(".json"):
        names = ", ".join(clip.name for clip in bundled_clips())
        raise InputError(
            f"expected a bundled clip ({names}) or a file that ends in {CLIP_SUFFIX}, got {name!r}"
        )
    return load_clip(name)


@clip_group.command("save", epilog="Example: akap-editor clip save walk.akap -o walk.clip.json --to 1")
@click.argument("file", type=INPUT)
@click.option("-o", "--output", type=FILE, required=True, help="The .clip.json file to write; - for stdout.")
@click.option("--name", help="Name of the clip; by default that of the output.")
@click.option("--from", "start", type=float, metavar="SECONDS", help="Leave out earlier keyframes.")
@click.option("--to", "end", type=float, metavar="SECONDS", help="Leave out later keyframes.")
def save_command(file: Path, output: Path, name: str | None, start: float | None, end: float | None) -> None:
    """Save the motion of the named pins of FILE through its keyframes as a clip."""
    from ..editor.animation.clips.clip import clip_from_keyframes
    from ..io.akap.clip import CLIP_SUFFIX, save_clip
    from ..io.open_document import open_document

    if output != STREAM:
        check_suffix(output, CLIP_SUFFIX)
    document = open_document(file)
    animation = document.state.animation
    low, high = start or 0.0, animation.duration if end is None else end
    times = [time for time in animation.times if low <= time <= high]
    name = name or display_text(file.stem if output == STREAM else output.name).removesuffix(CLIP_SUFFIX)
    clip = clip_from_keyframes(name, document.drawing, document.state, animation, times)
    with written_path(output, CLIP_SUFFIX) as path:
        make_folder_of(path)
        save_clip(clip, path)
    facts = f"{len(clip.keys)} keys of {len(clip.pins)} pins, {clip.duration:.2f} s"
    say(f"{display_text(output)}: {facts}", output)


@clip_group.command("list")
def list_command() -> None:
    """List the bundled clips with their pins."""
    from ..io.akap.clip import bundled_clips

    clips = bundled_clips()
    width = max(len(clip.name) for clip in clips)
    for clip in clips:
        click.echo(f"{clip.name:<{width}}  {clip.duration:.2f} s  {', '.join(clip.names)}")
