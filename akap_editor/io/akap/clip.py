"""Reads and writes .clip.json files, and finds the bundled clips with the pins of the bundled drawings."""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from ...display_text import display_text
from ...editor.animation.clips.clip import MAX_CLIP_KEYS, MAX_CLIP_PINS, Clip, ClipKey, ClipPin
from ...editor.document.drawing import Drawing
from ...errors import InputError, file_errors
from ...resources import resource
from ...words import mark, tr
from ..atomic import read_file, write_atomic
from .json_records import (
    Json,
    file_version,
    numbers,
    optional,
    pairs,
    parse_record,
    program_name,
    refuse_newer,
    require,
)

CLIP_SUFFIX = ".clip.json"
CLIP_FORMAT = "akap-clip"
CLIP_VERSION = 1
MAX_CLIP_BYTES = 2**24
_MAX_NAME = 100  # letters


def save_clip(clip: Clip, path: str | Path) -> None:
    """Write a clip, whole or not at all. Raises FileError."""
    with file_errors("save", path):
        data = encode_clip(clip)
    write_atomic(path, data)


def load_clip(path: str | Path) -> Clip:
    """The clip in a file. Raises FileError, and nothing else."""
    data = read_file(path, mark("a clip"))
    with file_errors("open", path):
        return decode_clip(data)


def encode_clip(clip: Clip) -> bytes:
    """The bytes of a .clip.json file."""
    record = {
        "format": CLIP_FORMAT,
        "version": CLIP_VERSION,
        "program": program_name(),
        "name": clip.name,
        "pins": [
            {"name": pin.name, "parent": pin.parent, "rest": rest}
            for pin, rest in zip(clip.pins, clip.rest.tolist(), strict=True)
        ],
        "keys": [
            {"time": float(key.time), "positions": key.positions.tolist(), "ease": key.ease}
            for key in clip.keys
        ],
    }
    return json.dumps(record, allow_nan=False, ensure_ascii=False, indent=1).encode() + b"\n"


def decode_clip(data: bytes) -> Clip:
    """The clip in the bytes of a .clip.json file. Raises InputError, and nothing else."""
    if len(data) > MAX_CLIP_BYTES:
        raise InputError(
            tr("expected a clip of at most {most} bytes, got {count}", most=MAX_CLIP_BYTES, count=len(data))
        )
    record = parse_record(data)
    refuse_newer(file_version(record, CLIP_FORMAT), CLIP_VERSION)
    name = display_text(require(record, "name", str))
    if not 0 < len(name) <= _MAX_NAME:
        raise InputError(
            tr("name: expected 1 to {most} letters, got {count}", most=_MAX_NAME, count=len(name))
        )
    pins, keys = require(record, "pins", list), require(record, "keys", list)
    if len(pins) > MAX_CLIP_PINS or len(keys) > MAX_CLIP_KEYS:
        raise InputError(
            tr("expected at most {pins} pins and {keys} keys", pins=MAX_CLIP_PINS, keys=MAX_CLIP_KEYS)
        )
    rest = pairs([require(_as_object(pin, "pins"), "rest", list) for pin in pins], "rest")
    return Clip(name, tuple(map(_read_pin, pins)), rest, tuple(map(_read_key, keys)))


def _read_pin(record: Json) -> ClipPin:
    parent = record.get("parent")
    name = display_text(require(record, "name", str))
    return ClipPin(name, None if parent is None else display_text(require(record, "parent", str)))


def _read_key(value: Any) -> ClipKey:
    record = _as_object(value, "keys")
    positions = pairs(require(record, "positions", list), "positions")
    time = float(numbers([record.get("time")], "time")[0])
    return ClipKey(time, positions, optional(record, "ease", str, "smooth"))


def _as_object(value: Any, name: str) -> Json:
    if type(value) is not dict:
        raise InputError(tr("{name}: expected objects, got {value!r:.60}", name=name, value=value))
    return value


# -- bundled clips -------------------------------------------------------------------------------------------


@lru_cache(1)
def bundled_clips() -> tuple[Clip, ...]:
    """The clips that come with the program, by name."""
    paths = sorted(resource("assets", "clips").glob(f"*{CLIP_SUFFIX}"))
    return tuple(sorted(map(load_clip, paths), key=lambda clip: clip.name))


def bundled_pins(drawing: Drawing) -> dict[str, tuple[float, float]]:
    """The named pins by which bundled clips move a bundled drawing, with their places at rest in pixels.

    Empty for other drawings.
    """
    layout = _layouts().get(drawing.name, {})
    if layout and tuple(layout["size"]) != drawing.size:
        return {}
    return {name: (x, y) for name, (x, y) in layout.get("pins", {}).items()}


def clips_for(name: str) -> tuple[Clip, ...]:
    """The bundled clips that suit a bundled drawing, mirrored if it looks to the left."""
    layout = _layouts().get(name, {})
    clips = {clip.name: clip for clip in bundled_clips()}
    chosen = (clips[each] for each in layout.get("clips", ()))
    return tuple(clip.mirrored() if layout.get("mirror") else clip for clip in chosen)


@lru_cache(1)
def _layouts() -> dict[str, Any]:
    layouts: dict[str, Any] = parse_record(read_file(resource("assets", "clips", "pins.json"), "pins"))
    return layouts
