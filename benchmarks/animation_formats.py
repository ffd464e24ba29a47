"""Measures how long each animation format takes to encode, beside FFmpeg's encoders on the same frames.

Run from the project's root: python benchmarks/animation_formats.py [--frames 60] [--size 640]
"""

import argparse
from collections.abc import Callable, Iterator
from contextlib import suppress
from fractions import Fraction
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np
from PIL import Image

from akap_editor.io.animation.formats import write_animation
from akap_editor.io.animation.video import require_av
from akap_editor.io.images import Picture
from akap_editor.resources import resource

av: Any = require_av()
FPS = 25
OURS = ("gif", "webp", "apng", "mp4", "webm", "")
# container, codec, pixel format and options of FFmpeg for the same purpose
FFMPEG = {
    "webp": ("webp", "libwebp_anim", "bgra", {"lossless": "1"}),
    "apng": ("apng", "apng", "rgba", {"pred": "mixed"}),
    "mp4": ("mp4", "libx264", "yuv420p", {"crf": "16", "preset": "medium"}),
    "webm": ("webm", "libvpx-vp9", "yuva420p", {"crf": "18", "b": "0", "deadline": "good", "cpu-used": "4"}),
}


def turning_elephant(count: int, size: int) -> list[Picture]:
    """The bundled elephant, turned by 2 degrees from frame to frame."""
    picture = Image.open(resource("assets", "drawings", "elephant.png")).convert("RGBa")
    picture.thumbnail((size, size))
    picture = picture.crop((0, 0, picture.width // 2 * 2, picture.height // 2 * 2))
    turned = (picture.rotate(2 * number, Image.Resampling.BICUBIC) for number in range(count))
    return [np.array(each.convert("RGBA")) for each in turned]


def video_frames(frames: list[Picture]) -> Iterator[Any]:
    for number, image in enumerate(frames):
        frame = av.VideoFrame.from_ndarray(image, format="rgba")
        frame.pts, frame.time_base = number, Fraction(1, FPS)
        yield frame


def encode_by_ffmpeg(frames: list[Picture], suffix: str) -> bytes:
    container_name, codec, pixel_format, options = FFMPEG[suffix]
    buffer = BytesIO()
    with av.open(buffer, "w", format=container_name) as container:
        stream = container.add_stream(codec, rate=FPS, options=options)
        stream.height, stream.width = frames[0].shape[:2]
        stream.pix_fmt = pixel_format
        for frame in video_frames(frames):
            container.mux(stream.encode(frame.reformat(format=pixel_format)))
        container.mux(stream.encode())
    return buffer.getvalue()


def encode_gif_by_ffmpeg(frames: list[Picture]) -> bytes:
    """By the filters palettegen and paletteuse, without dithering."""
    height, width = frames[0].shape[:2]
    graph = av.filter.Graph()
    source = graph.add_buffer(width=width, height=height, format="rgba", time_base=Fraction(1, FPS))
    split, palette, use = graph.add("split"), graph.add("palettegen"), graph.add("paletteuse", "dither=none")
    sink = graph.add("buffersink")
    source.link_to(split)
    split.link_to(palette, 0)
    split.link_to(use, 1, 0)
    palette.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()
    for frame in video_frames(frames):
        source.push(frame)
    source.push(None)
    buffer = BytesIO()
    with av.open(buffer, "w", format="gif") as container:
        stream = container.add_stream("gif", rate=FPS)
        stream.width, stream.height, stream.pix_fmt = width, height, "pal8"
        with suppress(av.error.EOFError, av.error.BlockingIOError):
            while True:
                frame = sink.pull()
                frame.time_base = Fraction(1, FPS)
                container.mux(stream.encode(frame))
        container.mux(stream.encode())
    return buffer.getvalue()


def measured(encode: Callable[[], int]) -> str:
    """CPU seconds of all threads, and the size in kB."""
    start = process_time()
    size = encode()
    return f"{process_time() - start:.1f} s, {size / 1000:,.0f} kB"


def main() -> None:
    """Print a row for each format."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--size", type=int, default=640)
    arguments = parser.parse_args()
    frames = turning_elephant(arguments.frames, arguments.size)
    print(
        f"{len(frames)} frames of {frames[0].shape[1]} x {frames[0].shape[0]} pixels; CPU time of all threads"
    )
    with TemporaryDirectory() as folder:
        for suffix in OURS:
            path = Path(folder) / (f"a.{suffix}" if suffix else "frames")

            def ours(path: Path = path) -> int:
                write_animation(path, iter(frames), FPS)
                files = path.iterdir() if path.is_dir() else [path]
                return sum(file.stat().st_size for file in files)

            def theirs(suffix: str = suffix) -> int:
                is_gif = suffix == "gif"
                return len(encode_gif_by_ffmpeg(frames) if is_gif else encode_by_ffmpeg(frames, suffix))

            row = measured(ours)
            beside = measured(theirs) if suffix == "gif" or suffix in FFMPEG else "-"
            print(f"{suffix or 'folder':8} {row:24} FFmpeg: {beside}")


if __name__ == "__main__":
    main()
