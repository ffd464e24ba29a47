"""A reader of .akap and .pose.json files, written from docs/file-format.md alone, without akap_editor.

It checks every rule of that page and ignores all optional keys and entries.
"""

import hashlib
import json
import zipfile
from io import BytesIO
from math import isfinite

import numpy as np
from PIL import Image

MAX_BYTES, MAX_DOCUMENT, MAX_PICTURE, MAX_PIXELS = 2**30, 2**24, 2**29, 100_000_000
MAX_VERTICES, MAX_FACES, MAX_PINS, MAX_COORDINATE = 1_000_000, 2_000_000, 10_000, 1e9


class FormatError(Exception):
    """The file breaks a rule of the page."""


def expect(holds: bool, rule: str) -> None:
    """Raise FormatError with the rule unless it holds."""
    if not holds:
        raise FormatError(rule)


def read_json(text: bytes) -> dict:
    """Parse one JSON object by the page's rules."""

    def once(pairs):
        expect(len(dict(pairs)) == len(pairs), "no key twice")
        return dict(pairs)

    def refuse(name):
        raise FormatError("no NaN, no Infinity")

    def whole(digits):
        value = int(digits)
        expect(abs(value) <= 2**53, "integers up to 2^53")
        return value

    record = json.loads(text.decode("utf-8"), object_pairs_hook=once, parse_constant=refuse, parse_int=whole)
    expect(type(record) is dict, "one object")
    return record


def entry(archive: zipfile.ZipFile, name: str, limit: int) -> bytes:
    """Read an entry of at most ``limit`` bytes."""
    info = archive.getinfo(name)
    expect(info.compress_type in (0, 8) and not info.flag_bits & 1, "stored or deflated, not encrypted")
    expect(info.file_size <= limit, f"{name} is too large")
    with archive.open(info) as file:
        data = file.read(info.file_size + 1)
    expect(len(data) == info.file_size, f"{name} has the size that the directory gives")
    return data


def array(archive: zipfile.ZipFile, name: str, kind: str, rows: int, columns: int) -> np.ndarray:
    """Read an entry of numbers of a dtype."""
    size = rows * columns * np.dtype(kind).itemsize
    data = entry(archive, name, size)
    expect(len(data) == size, f"{name} has the size that the counts give")
    values = np.frombuffer(data, kind).reshape(rows, columns)
    expect(bool(np.isfinite(values).all()), "every float is finite")
    return values


def check_mesh(vertices: np.ndarray, faces: np.ndarray) -> None:
    """Check the rules for meshes."""
    expect(bool((abs(vertices) <= MAX_COORDINATE).all()), "coordinates up to 10^9")
    expect(bool((faces >= 0).all() and (faces < len(vertices)).all()), "indices from 0 to n - 1")
    expect(len(set(faces.ravel().tolist())) == len(vertices), "every vertex in at least one face")
    expect(len({(x, y) for x, y in (vertices + 0.0).tolist()}) == len(vertices), "no two vertices coincide")
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    areas = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    expect(bool((areas > 0).all()), "positive signed areas")
    edges = [(int(face[i]), int(face[(i + 1) % 3])) for face in faces for i in range(3)]
    expect(len(set(edges)) == len(edges), "no directed edge twice")
    outside = [start for start, end in edges if (end, start) not in set(edges)]
    expect(len(set(outside)) == len(outside), "parts that touch share an edge, not only a vertex")


def check_pins(pins: list, faces: int) -> None:
    """Check the rules for pins on a mesh with ``faces`` faces."""
    expect(type(pins) is list and len(pins) <= MAX_PINS, "at most 10 000 pins")
    expect(len({pin["id"] for pin in pins}) == len(pins), "unique ids")
    for pin in pins:
        expect(type(pin["id"]) is int and type(pin["face"]) is int, "id and face are integers")
        expect(0 <= pin["face"] < faces, "a face from 0 to m - 1")
        expect(len(pin["weights"]) == 3 and len(pin["target"]) == 2, "3 weights, 2 coordinates")
        expect(
            all(type(x) in (int, float) and isfinite(x) for x in pin["weights"] + pin["target"]), "numbers"
        )
        expect(all(-1e-9 <= weight <= 1 + 1e-9 for weight in pin["weights"]), "weights from 0 to 1")
        expect(abs(sum(pin["weights"]) - 1) <= 1e-9, "weights of sum 1")


def read_akap(data: bytes) -> dict:
    """Return name, picture (h, w, 4), vertices, faces, uv, positions, pins, method, parameters and tied."""
    expect(len(data) <= MAX_BYTES, "at most 2^30 bytes")
    expect(data[30:56] == b"mimetypeapplication/x-akap", "the type at byte 30")
    with zipfile.ZipFile(BytesIO(data)) as archive:
        expect(len(set(archive.namelist())) == len(archive.namelist()), "no name twice")
        expect(entry(archive, "mimetype", 18) == b"application/x-akap", "the type")
        record = read_json(entry(archive, "document.json", MAX_DOCUMENT))
        expect(record["format"] == "akap" and type(record["version"]) is int, "format and version")
        expect(record["version"] == 1, "a newer file")
        width, height = record["picture"]["width"], record["picture"]["height"]
        n, m = record["mesh"]["vertices"], record["mesh"]["faces"]
        expect(all(type(x) is int and x >= 1 for x in (width, height, n, m)), "integers from 1")
        expect(width * height <= MAX_PIXELS and n <= MAX_VERTICES and m <= MAX_FACES, "limits")
        drawing = {
            "vertices": array(archive, "mesh/vertices", "<f8", n, 2),
            "faces": array(archive, "mesh/faces", "<i4", m, 3),
            "uv": array(archive, "mesh/uv", "<f4", n, 2),
            "positions": array(archive, "pose/positions", "<f8", n, 2),
        }
        picture = Image.open(BytesIO(entry(archive, "picture.png", MAX_PICTURE)), formats=["PNG"])
    expect(picture.size == (width, height), "the picture's size")
    check_mesh(drawing["vertices"], drawing["faces"])
    check_pins(record["pins"], m)
    settings = record["settings"]
    expect(type(settings["method"]) is str and type(record["name"]) is str, "texts")
    for value in settings["parameters"].values():
        expect(value is None or type(value) in (bool, int, float, str), "plain parameters")
    return drawing | {
        "name": record["name"],
        "picture": np.asarray(picture.convert("RGBA")),
        "pins": record["pins"],
        "method": settings["method"],
        "parameters": settings["parameters"],
        "tied": record["mesh"].get("tied", True),
    }


def read_pose(data: bytes, vertices: np.ndarray, faces: np.ndarray) -> dict:
    """Return pins and positions (n, 2) of a pose of the given mesh."""
    expect(len(data) <= MAX_DOCUMENT, "at most 2^24 bytes")
    record = read_json(data)
    expect(record["format"] == "akap-pose" and record["version"] == 1, "format and version")
    digest = hashlib.sha256(vertices.astype("<f8").tobytes() + faces.astype("<i4").tobytes())
    expect(record["drawing"]["mesh"] == digest.hexdigest()[:32], "a pose of this mesh")
    positions = np.array(record["positions"], dtype=float)
    expect(positions.shape == vertices.shape and bool(np.isfinite(positions).all()), "n pairs of numbers")
    check_pins(record["pins"], len(faces))
    return {"pins": record["pins"], "positions": positions}
