"""The .akap file: a drawing with its mesh, pins, pose and settings, as described in docs/file-format.md."""

import json
import reprlib
import zipfile
from collections import Counter
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..editor.document import Document, Drawing, EditState, Pin, Settings
from ..errors import InputError
from ..geometry.checks import Floats, as_points
from ..geometry.mesh import TriMesh
from .atomic import read_file, write_atomic
from .images import MAX_PIXELS, decode_image, encode_png

MIMETYPE = b"application/x-akap"
FORMAT = "akap"
VERSION = 1

MAX_VERTICES = 1_000_000
MAX_FACES = 2_000_000
MAX_COORDINATE = 1e9
MAX_INTEGER = 2**53
MAX_DOCUMENT_BYTES = 2**24
MAX_PICTURE_BYTES = 2**29
WEIGHT_TOLERANCE = 1e-9
THUMBNAIL_SIDE = 256

Json = dict[str, Any]
T = TypeVar("T", int, str, list[Any], Json)


def save(document: Document, path: str | Path) -> Document:
    """Write an .akap file, whole or not at all, and return the document with its ``path`` set.

    Equal documents give equal bytes. Raises InputError where the file cannot be written or could not be
    opened again, e.g. for two pins with one id; the old file is then kept.
    """
    try:
        _check(document)
        data = _encode(document)
    except InputError as error:
        raise InputError(f"cannot write {path}: {error}") from error
    write_atomic(path, data)
    return replace(document, path=Path(path))


def load(path: str | Path) -> Document:
    """The document in an .akap file, bit for bit as it was saved; its ``revision`` is 0.

    Raises InputError, and nothing else, on a file that is missing, damaged, malicious or of a newer version.
    """
    data = read_file(path, "an .akap file")
    try:
        document = _decode(_Archive(data))
        _check(document)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    return replace(document, path=Path(path))


def _check(document: Document) -> None:
    """What holds for every .akap file and is not promised by the types of a document."""
    mesh, state = document.drawing.mesh, document.state
    _check_sizes(*document.drawing.size, len(mesh.vertices), len(mesh.faces))
    _check_vertices(mesh.vertices)
    as_points(state.positions, "positions", len(mesh.vertices))
    for pin in state.pins:
        _check_pin(pin, len(mesh.faces))
    for name, value in state.settings.parameters:
        _check_parameter(name, value)
    names = [f"pin {pin.id}" for pin in state.pins]
    names += [f"parameter {name!r}" for name, _ in state.settings.parameters]
    for name, count in Counter(names).items():
        if count > 1:
            raise InputError(f"expected each pin and each parameter once, got {name} {count} times")


def _check_sizes(width: int, height: int, vertices: int, faces: int) -> None:
    if min(width, height, vertices, faces) < 1:
        raise InputError(
            f"expected sizes above 0, got {width} x {height}, {vertices} vertices, {faces} faces"
        )
    limits = (
        (width * height, MAX_PIXELS, "pixels"),
        (vertices, MAX_VERTICES, "vertices"),
        (faces, MAX_FACES, "faces"),
    )
    for count, most, name in limits:
        if count > most:
            raise InputError(f"expected at most {most} {name}, got {count}")


def _check_vertices(vertices: Floats) -> None:
    far = np.abs(vertices).max()
    if not far <= MAX_COORDINATE:  # of NaN, too; areas of anything farther could overflow
        raise InputError(f"vertices: expected coordinates up to {MAX_COORDINATE:g} pixels, got {far:g}")


def _check_pin(pin: Pin, faces: int) -> None:
    if abs(pin.id) > MAX_INTEGER:
        raise InputError(f"pins: expected ids up to {MAX_INTEGER}, got {pin.id}")
    if not 0 <= pin.face < faces:
        raise InputError(f"pin {pin.id}: expected a face from 0 to {faces - 1}, got {pin.face}")
    if pin.weights.shape != (3,) or pin.target.shape != (2,):
        came = f"{pin.weights.size} and {pin.target.size}"
        raise InputError(f"pin {pin.id}: expected 3 weights and a target of 2 coordinates, got {came}")
    low, high = -WEIGHT_TOLERANCE, 1 + WEIGHT_TOLERANCE
    inside = all(low <= weight <= high for weight in pin.weights)
    if not inside or abs(pin.weights.sum() - 1) > WEIGHT_TOLERANCE:
        came = str(pin.weights.tolist())
        raise InputError(f"pin {pin.id}: expected weights from 0 to 1 that sum to 1, got {came}")
    if not np.isfinite(pin.target).all():
        raise InputError(f"pin {pin.id}: expected a finite target, got {pin.target.tolist()}")


def _check_parameter(name: str, value: object) -> None:
    if not isinstance(name, str) or not isinstance(value, bool | int | float | str | None):
        came = f"{type(value).__name__} for {name!r}"
        raise InputError(f"parameters: expected names and numbers, texts, true, false or null, got {came}")
    if isinstance(value, float) and not np.isfinite(value):
        raise InputError(f"parameter {name!r}: expected a finite number, got {value}")
    if isinstance(value, int) and abs(value) > MAX_INTEGER:
        came = f"one of {value.bit_length()} bits"
        raise InputError(f"parameter {name!r}: expected an integer up to {MAX_INTEGER}, got {came}")


# Writing


def _encode(document: Document) -> bytes:
    drawing, state = document.drawing, document.state
    text = json.dumps(_describe(document), allow_nan=False).encode()
    if len(text) > MAX_DOCUMENT_BYTES:
        raise InputError(f"expected a description of at most {MAX_DOCUMENT_BYTES} bytes, got {len(text)}")
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content, method in [
            ("mimetype", MIMETYPE, zipfile.ZIP_STORED),
            ("document.json", text, zipfile.ZIP_DEFLATED),
            ("mesh/vertices", drawing.mesh.vertices.astype("<f8").tobytes(), zipfile.ZIP_DEFLATED),
            ("mesh/faces", drawing.mesh.faces.astype("<i4").tobytes(), zipfile.ZIP_DEFLATED),
            ("mesh/uv", drawing.uv.astype("<f4").tobytes(), zipfile.ZIP_DEFLATED),
            ("pose/positions", state.positions.astype("<f8").tobytes(), zipfile.ZIP_DEFLATED),
            ("picture.png", encode_png(drawing.image), zipfile.ZIP_STORED),
            ("thumbnail.png", encode_png(_thumbnail(drawing.image)), zipfile.ZIP_STORED),
        ]:
            info = zipfile.ZipInfo(name)  # dated 1980-01-01, so that equal documents give equal bytes
            info.create_system = 3  # Unix, wherever it is written
            info.external_attr = 0o644 << 16
            info.compress_type = method
            archive.writestr(info, content, compresslevel=1)
    return buffer.getvalue()


def _describe(document: Document) -> Json:
    drawing, state = document.drawing, document.state
    width, height = drawing.size
    return {
        "format": FORMAT,
        "version": VERSION,
        "program": _program(),
        "name": drawing.name,
        "picture": {"width": width, "height": height},
        "mesh": {"vertices": len(drawing.mesh.vertices), "faces": len(drawing.mesh.faces)},
        "pins": [
            {
                "id": int(pin.id),
                "face": int(pin.face),
                "weights": pin.weights.tolist(),
                "target": pin.target.tolist(),
            }
            for pin in state.pins
        ],
        "settings": {"method": state.settings.method, "parameters": dict(state.settings.parameters)},
    }


def _program() -> str:
    try:
        return f"akap-editor {version('akap-editor')}"
    except PackageNotFoundError:  # a checkout that is not installed
        return "akap-editor"


def _thumbnail(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    step = 1 + max(image.shape[:2]) // (4 * THUMBNAIL_SIDE)  # a quick first reduction of large pictures
    picture = Image.fromarray(np.ascontiguousarray(image[::step, ::step]))
    picture.thumbnail((THUMBNAIL_SIDE, THUMBNAIL_SIDE))
    return np.asarray(picture)


# Reading


class _Archive:
    """The entries of a zip file, by exact name. Raises InputError on damage of any kind."""

    def __init__(self, data: bytes) -> None:
        try:
            self._archive = zipfile.ZipFile(BytesIO(data))
        except Exception as error:  # zipfile meets damage with exceptions of many kinds
            raise InputError("expected an .akap file, got a truncated one or one of another kind") from error
        entries = self._archive.infolist()
        self._entries = {entry.filename: entry for entry in entries}
        if len(self._entries) < len(entries):
            name, count = Counter(entry.filename for entry in entries).most_common(1)[0]
            raise InputError(f"expected each entry once, got {reprlib.repr(name)} {count} times")

    def __contains__(self, name: str) -> bool:
        return name in self._entries

    def read(self, name: str, most: int) -> bytes:
        """The content of an entry of at most ``most`` bytes."""
        if name not in self:
            raise InputError(f"expected the entry {name}, which is missing")
        entry = self._entries[name]
        if entry.file_size > most:
            raise InputError(f"{name}: expected at most {most} bytes, got {entry.file_size}")
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise InputError(f"{name}: expected no compression or deflate, got method {entry.compress_type}")
        try:
            with self._archive.open(entry) as file:
                content = file.read(entry.file_size)  # a bound: without, a false size would unpack at length
        except Exception as error:
            raise InputError(f"{name}: expected a readable entry, got a damaged one") from error
        if len(content) != entry.file_size:
            raise InputError(f"{name}: expected {entry.file_size} bytes, got {len(content)}")
        return content

    def read_array(self, name: str, dtype: str, rows: int, columns: int) -> NDArray[Any]:
        """An array (rows, columns) stored row by row without a header, in the machine's byte order."""
        size = rows * columns * np.dtype(dtype).itemsize
        content = self.read(name, size)
        if len(content) != size:
            raise InputError(
                f"{name}: expected {size} bytes for shape ({rows}, {columns}), got {len(content)}"
            )
        array = np.frombuffer(content, dtype).reshape(rows, columns)
        return array.astype(array.dtype.newbyteorder("="))


def _decode(archive: _Archive) -> Document:
    if "mimetype" not in archive or archive.read("mimetype", 256) != MIMETYPE:
        raise InputError("expected an .akap file, got a zip archive of another kind")
    record = _parse(archive.read("document.json", MAX_DOCUMENT_BYTES))
    _check_version(record)
    picture, mesh = _get(record, "picture", dict), _get(record, "mesh", dict)
    width, height = _get(picture, "width", int), _get(picture, "height", int)
    n, m = _get(mesh, "vertices", int), _get(mesh, "faces", int)
    _check_sizes(width, height, n, m)
    settings = _get(record, "settings", dict)
    state = EditState(
        tuple(_pin(pin) for pin in _get(record, "pins", list)),
        archive.read_array("pose/positions", "<f8", n, 2),
        Settings(_get(settings, "method", str), tuple(_get(settings, "parameters", dict).items())),
    )
    vertices = archive.read_array("mesh/vertices", "<f8", n, 2)
    _check_vertices(vertices)
    trimesh = TriMesh(vertices, archive.read_array("mesh/faces", "<i4", m, 3))
    uv = archive.read_array("mesh/uv", "<f4", n, 2)
    image = _picture(archive, width, height)
    return Document(Drawing(image, trimesh, uv, _get(record, "name", str)), state)


def _check_version(record: Json) -> None:
    if _get(record, "format", str) != FORMAT:
        raise InputError(f"document.json: expected format {FORMAT!r}, got {reprlib.repr(record['format'])}")
    number = _get(record, "version", int)
    if number > VERSION:
        raise InputError(
            f"the file was written by a newer version of the program (file version {number}, "
            f"this program reads up to {VERSION})"
        )
    if number < 1:
        raise InputError(f"document.json: expected a version from 1 to {VERSION}, got {number}")


def _picture(archive: _Archive, width: int, height: int) -> NDArray[np.uint8]:
    content = archive.read("picture.png", MAX_PICTURE_BYTES)
    try:
        image = decode_image(content, ("PNG",))
    except InputError as error:
        raise InputError(f"picture.png: {error}") from error
    if image.shape[:2] != (height, width):
        came = f"{image.shape[1]} x {image.shape[0]}"
        raise InputError(f"picture.png: expected {width} x {height} pixels, got {came}")
    return image


def _pin(record: Any) -> Pin:
    if not isinstance(record, dict):
        raise InputError(f"document.json: expected pins to be objects, got {reprlib.repr(record)}")
    return Pin(
        _get(record, "id", int),
        _get(record, "face", int),
        _numbers(record, "weights"),
        _numbers(record, "target"),
    )


def _numbers(record: Json, name: str) -> Floats:
    values = _get(record, name, list)
    if not all(type(value) in (int, float) for value in values):
        raise InputError(f"document.json: expected {name} to be numbers, got {reprlib.repr(values)}")
    return np.array(values, dtype=np.float64)


_NAMES = {int: "an integer", str: "a text", list: "a list", dict: "an object"}


def _get(record: Json, name: str, kind: type[T]) -> T:
    if name not in record:
        raise InputError(f"document.json: expected {name} to be {_NAMES[kind]}, but it is missing")
    value = record[name]
    if type(value) is not kind:  # to isinstance, true would be an integer
        raise InputError(f"document.json: expected {name} to be {_NAMES[kind]}, got {reprlib.repr(value)}")
    return value


def _parse(text: bytes) -> Json:
    """A JSON object in UTF-8, with different keys and numbers that are finite and not excessively long."""
    try:
        record = json.loads(
            text.decode(), object_pairs_hook=_object, parse_int=_integer, parse_constant=_no_constant
        )
    except InputError as error:
        raise InputError(f"document.json: {error}") from error
    except (ValueError, RecursionError) as error:
        raise InputError("document.json: expected JSON in UTF-8, got something else") from error
    if not isinstance(record, dict):
        raise InputError(f"document.json: expected an object, got {reprlib.repr(record)}")
    return record


def _object(pairs: list[tuple[str, Any]]) -> Json:
    record = dict(pairs)
    if len(record) < len(pairs):
        raise InputError(f"expected each key once, got one of {reprlib.repr(list(record))} twice")
    return record


def _integer(digits: str) -> int:
    if len(digits) > 17 or abs(int(digits)) > MAX_INTEGER:
        raise InputError(f"expected integers up to {MAX_INTEGER}, got {reprlib.repr(digits)}")
    return int(digits)


def _no_constant(name: str) -> float:
    raise InputError(f"expected finite numbers, got {name}")
