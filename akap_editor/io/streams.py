"""Standard input and output in place of files, whose readers and writers work with paths."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from ..errors import InputError
from ..words import tr

STREAM = Path("-")  # stands for standard input or output
_FOLDER_START = "akap-stream-"  # of the names of folders that exist while a command runs
_HEAD = 400  # bytes that tell what the data are

_SUFFIXES = (  # by the first bytes
    (b"\x89PNG", ".png"),
    (b"\xff\xd8\xff", ".jpg"),
    (b"RIFF", ".webp"),
    (b"BM", ".bmp"),
    (b"GIF8", ".gif"),
    (b"II*\0", ".tif"),
    (b"MM\0*", ".tif"),
    (b"glTF", ".glb"),
    (b"OFF", ".off"),
)


def suffix_of(data: bytes) -> str:
    """The ending of file names for data, by their first bytes; that of OBJ files if they do not tell."""
    from .akap.clip import CLIP_FORMAT, CLIP_SUFFIX
    from .akap.pose import POSE_FORMAT, POSE_SUFFIX
    from .akap.project import PROJECT_SUFFIX
    from .akap.recording import RECORDING_SUFFIX
    from .layers.open_layers import PSD_MAGIC, has_layers

    if has_layers(data):
        return ".psd" if data.startswith(PSD_MAGIC) else ".ora"
    for start, suffix in (*_SUFFIXES, (b"PK", PROJECT_SUFFIX)):
        if data.startswith(start):
            return suffix
    formats = (  # by the word in a JSON file
        (b'"akap-recording"', RECORDING_SUFFIX),
        (f'"{POSE_FORMAT}"'.encode(), POSE_SUFFIX),
        (f'"{CLIP_FORMAT}"'.encode(), CLIP_SUFFIX),
        (b'"akap-mesh"', ".json"),
    )
    head = data[:_HEAD]
    return next((suffix for word, suffix in formats if word in head), ".obj")


def read_stream(folder: Path) -> Path:
    """Copy standard input to a file in a folder, with the ending of its kind. Raises InputError if empty."""
    data = b"" if sys.stdin is None or sys.stdin.isatty() else sys.stdin.buffer.read()
    if not data:
        raise InputError(tr("-: expected a file on standard input, got nothing"))
    path = folder / f"stdin{suffix_of(data)}"
    path.write_bytes(data)
    return path


def stream_folder() -> "TemporaryDirectory[str]":
    """A folder for such files."""
    return TemporaryDirectory(prefix=_FOLDER_START)


@contextmanager
def written_path(output: Path, suffix: str) -> Iterator[Path]:
    """Where to write an output; if it is `STREAM`, that file goes to standard output at the end.

    suffix: the ending of its name then. Raises InputError if more than one file was written.
    """
    if output != STREAM:
        yield output
        return
    with stream_folder() as folder:
        path = Path(folder) / f"stdout{suffix}"
        yield path
        written = sorted(each.name for each in Path(folder).iterdir())
        if written != [path.name]:
            raise InputError(
                tr(
                    "--output: expected a name for {suffix}, which has several files, "
                    "got - for standard output",
                    suffix=suffix,
                )
            )
        sys.stdout.buffer.write(path.read_bytes())
        sys.stdout.buffer.flush()


def named_path(path: Path) -> Path:
    """A path as the user named it: `STREAM` for a file of `read_stream`."""
    return STREAM if path.parent.name.startswith(_FOLDER_START) else path


def without_stream_folders(text: str) -> str:
    """A message without the folders of such files."""
    words = []
    for word in text.split(" "):
        start = word.find(_FOLDER_START)
        if start >= 0:
            slash = max(word.find("/", start), word.find("\\", start))
            quote = max(word[:start].rfind(mark) for mark in "“\"'(")
            word = word[: quote + 1] + word[slash + 1 :] if slash > 0 else word
        words.append(word)
    return " ".join(words)
