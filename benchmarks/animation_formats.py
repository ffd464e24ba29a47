"""Measures the way from a recording to each format, beside FFmpeg's own encoders on the same frames.

Run from the project's root: python benchmarks/animation_formats.py [--recording FILE] [--to 3] [--size 640]
[--only gif webp]. `ffmpeg` must be installed. Prints tables in Markdown. "All": CPU seconds and peak memory
of the whole program, which replays, draws and encodes; "encoding": CPU seconds of the encoder alone, given
the frames; "PSNR": of the colors of opaque pixels, for formats that lose some. Keyframes, of which glTF and
Spine files are made, are those of the recording with a tolerance of 2 pixels.
"""

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import NamedTuple

import numpy as np
from PIL import Image

from akap_editor.editor.animation.keyframing.simplification import Simplification
from akap_editor.editor.animation.keyframing.take import take_poses
from akap_editor.editor.animation.session_playback import Snapshot
from akap_editor.editor.document.keyframes import Animation
from akap_editor.editor.session.replay import Replay
from akap_editor.io.akap.project import save
from akap_editor.io.akap.recording import read_recording, recorded_drawing
from akap_editor.io.animation.formats import write_animation
from akap_editor.io.images import Picture
from akap_editor.resources import resource

FPS = 30
TOLERANCE = 2.0
PALETTE = "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none"
VP9 = "-c:v libvpx-vp9 -pix_fmt yuva420p -crf 18 -b:v 0 -deadline good -cpu-used 4"


class Row(NamedTuple):
    """A format.

    name: of the file, or of a folder; options: of `akap-editor replay`; ffmpeg: its options for the same
    purpose, "" where it has no such format; is_lossy: whether its colors differ from those of the frames.
    """

    label: str
    name: str
    options: tuple[str, ...]
    ffmpeg: str
    is_lossy: bool = False


ANIMATIONS = (
    Row("GIF", "a.gif", (), f"-filter_complex {PALETTE}", True),
    Row("WebP, lossless", "a.webp", (), "-c:v libwebp_anim -lossless 1 -pix_fmt bgra"),
    Row(
        "WebP, quality 80",
        "q.webp",
        ("--quality", "80"),
        "-c:v libwebp_anim -quality 80 -pix_fmt yuva420p",
        True,
    ),
    Row("APNG", "a.apng", (), "-f apng -pred mixed -plays 0"),
    Row("MP4", "a.mp4", (), "-c:v libx264 -pix_fmt yuv420p -crf 16 -preset medium", True),
    Row("WebM", "a.webm", (), VP9, True),
    Row("sprite sheet", "sheet.png", ("--sheet",), "-vf tile={columns}x{rows}:padding=2:margin=2"),
    Row("PNG frames", "frames", (), "-c:v png"),
    Row("HTML", "a.html", (), ""),
)
EXPORTS = (("glTF, keyframes", "a.glb"), ("Spine, keyframes", "a.spine.json"), ("SVG of a pose", "a.svg"))


class Cost(NamedTuple):
    """What a process took: CPU seconds of all its threads, and its peak memory in MiB."""

    seconds: float
    memory: float


def run(command: Sequence[str], given: bytes = b"") -> tuple[Cost, str]:
    """Run a command that reads some bytes; its cost, and what it printed."""
    with TemporaryFile() as source, TemporaryFile() as said:
        source.write(given)
        source.seek(0)
        process = subprocess.Popen(command, stdin=source, stdout=said)
        memory, ended = 0.0, 0
        while not ended:
            memory = max(memory, peak_memory(process.pid))
            time.sleep(0.02)
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
        said.seek(0)
        if status:
            raise SystemExit(f"failed: {' '.join(command)}")
        return Cost(usage.ru_utime + usage.ru_stime, memory), said.read().decode()


def peak_memory(pid: int) -> float:
    """MiB; `ru_maxrss` does not do, because it begins with what the process that started it holds."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return max([float(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM")], default=0.0)


def program(*arguments: str | Path) -> tuple[Cost, str]:
    """Run `akap-editor`, with the installed package or the one of this folder."""
    return run([sys.executable, "-m", "akap_editor.cli", *map(str, arguments)])


def by_ffmpeg(frames: Sequence[Picture], row: Row, path: Path) -> Cost:
    """Let FFmpeg encode the frames."""
    height, width = frames[0].shape[:2]
    columns = max(1, round((len(frames) * height / width) ** 0.5))
    options = row.ffmpeg.format(columns=columns, rows=-(-len(frames) // columns)).split()
    if path.suffix == ".mp4":
        frames = [over_white(frame) for frame in frames]
    if not path.suffix:
        path.mkdir()
        path /= "frame-%04d.png"
    source = f"-f rawvideo -pix_fmt rgba -s {width}x{height} -r {FPS} -i -".split()
    command = ["ffmpeg", "-loglevel", "error", "-y", *source, *options, str(path)]
    return run(command, b"".join(frame.tobytes() for frame in frames))[0]


def over_white(image: Picture) -> Picture:
    """A frame without transparency."""
    white = Image.new("RGBA", image.shape[1::-1], "white")
    return np.array(Image.alpha_composite(white, Image.fromarray(image)))


def frames_in(path: Path, count: int, size: tuple[int, int]) -> list[Picture]:
    """The frames (h, w, 4) of an animation; of a GIF or WebP as Pillow shows them.

    count: of the frames, of which equal ones may be stored as one; size: of a video.
    """
    if path.suffix not in (".gif", ".webp"):
        decoder = ["-c:v", "libvpx-vp9"] if path.suffix == ".webm" else []
        command = f"-i {path} -f rawvideo -pix_fmt rgba -".split()
        data = subprocess.check_output(["ffmpeg", "-loglevel", "error", *decoder, *command])
        return list(np.frombuffer(data, np.uint8).reshape(-1, size[1], size[0], 4))
    frames: list[Picture] = []
    ends: list[float] = []
    with Image.open(path) as file:
        for number in range(getattr(file, "n_frames", 1)):
            file.seek(number)
            file.load()
            frames.append(np.array(file.convert("RGBA")))
            ends.append(file.info["duration"] + (ends[-1] if ends else 0))
    middles = (np.arange(count) + 0.5) * 1000 / FPS
    return [frames[min(np.searchsorted(ends, middle), len(frames) - 1)] for middle in middles]


def psnr(shown: Sequence[Picture], frames: Sequence[Picture]) -> float:
    """In dB, of the colors of opaque pixels."""
    errors = []
    for came, frame in zip(shown, frames, strict=True):
        height, width = frame.shape[:2]
        is_opaque = frame[..., 3] == 255
        offsets = came[:height, :width, :3][is_opaque].astype(float) - frame[..., :3][is_opaque]
        errors.append((offsets**2).mean(axis=1))
    return float(10 * np.log10(255**2 / np.concatenate(errors).mean()))


def size_of(path: Path) -> float:
    """MB of a file, or of the files in a folder."""
    files = path.iterdir() if path.is_dir() else [path]
    return sum(file.stat().st_size for file in files) / 1e6


def encode(folder: Path, name: str, options: Sequence[str]) -> None:
    """Encode frames.npy alone and print the CPU seconds; runs in a process of its own."""
    frames = np.load(folder / "frames.npy", mmap_mode="r")
    quality = int(options[1]) if "--quality" in options else None
    start = time.process_time()
    write_animation(folder / name, iter(frames), FPS, sheet="--sheet" in options, quality=quality)
    print(time.process_time() - start)


def keyframed(recording: Path, path: Path) -> None:
    """Save the motion of a recording as keyframes."""
    events = read_recording(recording)
    drawing, snapshots, jumps = recorded_drawing(events), [], 0
    player = Replay(events, drawing)
    for line, event in enumerate(player.events()):
        jumps += event.is_jump
        assert player.session is not None
        snapshots.append(Snapshot(event.time, line, event.state, player.session.drawing, jumps))
    assert player.session is not None
    take = Simplification(drawing.mesh, take_poses(snapshots, 0.0, snapshots[-1].time, drawing))
    for _ in take.refine(TOLERANCE):
        pass
    document = player.session.present_document
    animation = Animation(tuple(take.keyframes(TOLERANCE)))
    save(document.with_state(replace(document.state, animation=animation)), path)


def print_animations(recording: Path, options: Sequence[str], only: Sequence[str], folder: Path) -> None:
    """Print a row for each format of animations."""
    program("replay", recording, "-o", folder / "source", *options)
    frames = [np.array(Image.open(path)) for path in sorted((folder / "source").iterdir())]
    np.save(folder / "frames.npy", np.array(frames))
    height, width = frames[0].shape[:2]
    print(f"{len(frames)} frames of {width} × {height} pixels\n")
    print("| | all | peak memory | encoding | size | PSNR | FFmpeg | size | PSNR |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row in ANIMATIONS:
        if only and row.name.rpartition(".")[2] not in only:
            continue
        ours, theirs = folder / row.name, folder / f"ffmpeg-{row.name}"
        whole, _ = program("replay", recording, "-o", ours, *options, *row.options)
        alone = ["", ""]
        qualities = ["", ""]
        if row.name != "a.html":
            script = [sys.executable, __file__, "--encode", str(folder), f"alone-{row.name}", *row.options]
            alone[0] = f"{float(run(script)[1]):.1f} s"
        if row.ffmpeg:
            alone[1] = f"{by_ffmpeg(frames, row, theirs).seconds:.1f} s"
        for number, path in enumerate((ours, theirs)):
            if row.is_lossy:
                even = width + width % 2, height + height % 2
                qualities[number] = f"{psnr(frames_in(path, len(frames), even), frames):.1f} dB"
        cells = [row.label, f"{whole.seconds:.1f} s", f"{whole.memory:.0f} MiB", alone[0]]
        cells += [f"{size_of(ours):.2f} MB", qualities[0], alone[1]]
        cells += [f"{size_of(theirs):.2f} MB" if row.ffmpeg else "", qualities[1]]
        print("|", " | ".join(cells), "|", flush=True)


def print_exports(recording: Path, folder: Path) -> None:
    """Print a row for each format that other programs animate themselves."""
    keyframed(recording, folder / "keys.akap")
    print("\n| | all | peak memory | size |\n|---|---|---|---|")
    for label, name in EXPORTS:
        options = ["--textured"] if name.endswith(".svg") else []
        whole, _ = program("export", folder / "keys.akap", "-o", folder / name, *options)
        cells = label, f"{whole.seconds:.1f} s", f"{whole.memory:.0f} MiB", f"{size_of(folder / name):.2f} MB"
        print("|", " | ".join(cells), "|", flush=True)


def main() -> None:
    """Print both tables."""
    if sys.argv[1:2] == ["--encode"]:
        encode(Path(sys.argv[2]), sys.argv[3], sys.argv[4:])
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument(
        "--recording", type=Path, default=resource("assets", "recordings", "elephant.akaprec")
    )
    parser.add_argument("--to", default="3", help="seconds")
    parser.add_argument("--size", default="640", help="longest side in pixels")
    parser.add_argument("--only", nargs="*", default=[], help="endings")
    arguments = parser.parse_args()
    options = ["--fps", str(FPS), "--to", arguments.to, "--size", arguments.size]
    with TemporaryDirectory() as folder:
        print_animations(arguments.recording, options, arguments.only, Path(folder))
        if not arguments.only:
            print_exports(arguments.recording, Path(folder))


if __name__ == "__main__":
    main()
