"""Reads and writes .akap files, which hold a document, as described in docs/file-format.md."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...editor.document.document import Document, EditState
from ...editor.document.drawing import Drawing
from ...editor.document.rig.joint import check_joints
from ...errors import FileError, InputError, error_context, file_errors
from ...geometry.mesh import TriMesh
from ...geometry.validation import MAX_COORDINATE, Floats, as_instance, freeze
from ...layers.drawing_layer import flat_picture
from ...words import mark, tr
from ..atomic import as_path, read_file, resolved, write_atomic
from ..images import MAX_PIXELS, decode_image, encode_png
from .archive import Archive, ArchiveEntry, check_expanded, pack
from .json_records import (
    Json,
    file_version,
    optional,
    parse_record,
    program_name,
    refuse_newer,
    require,
)
from .layer_entries import (
    MAX_PICTURE_BYTES,
    describe_layers,
    layer_picture_entries,
    read_joints,
    read_layers,
)
from .loose_entries import describe_loose, loose_entries, read_loose
from .picture_record import (
    MAX_DOCUMENT_VERTICES,
    check_meshing,
    describe_meshing,
    describe_source,
    read_meshing,
    read_source,
)
from .pose_entries import keyframe_entries, named_pose_entries, read_keyframes, read_named_poses
from .state_records import (
    check_crossings,
    check_state,
    read_crossings,
    read_mirror,
    read_pins,
    read_settings,
    write_crossings,
)

PROJECT_SUFFIX = ".akap"
MIMETYPE = b"application/x-akap"
DOCUMENT_FORMAT = "akap"
DOCUMENT_VERSION = 2
FLAT_VERSION = 1  # of drawings without layers, which older programs open
STIFFNESS_ENTRY = "stiffness"  # a factor for each face
THUMBNAIL_ENTRY = "thumbnail.png"  # a small copy of the picture
ORIGINAL_ENTRY = "original.png"  # the picture before its background was removed

MAX_DOCUMENT_FACES = 2_000_000
MAX_DOCUMENT_BYTES = 2**24
THUMBNAIL_SIDE = 256


def save(document: Document, path: str | Path) -> Document:
    """Write an .akap file, whole or not at all; return the document with its ``path`` and ``digest`` set.

    Equal documents give equal bytes in one folder. Raises FileError if the file cannot be written, or could
    not be opened again, e.g. for two pins with one id; then the old file stays.
    """
    as_instance(document, "document", Document)
    path = as_path(path)
    with file_errors("save", path):
        data = encode_document(document, folder=resolved(path).parent)
    write_atomic(path, data)
    return replace(document, path=Path(path), digest=_digest(data))


def load(path: str | Path) -> Document:
    """The document in an .akap file, bit for bit as it was saved; its ``revision`` is 0.

    Raises FileError, and nothing else, if the file is missing, damaged, malicious or of a newer version.
    """
    data = read_file(path, mark("an .akap file"))
    with file_errors("open", path):
        document = decode_document(data, resolved(as_path(path)).parent)
    return replace(document, path=Path(path), digest=_digest(data))


def has_changed_on_disk(document: Document) -> bool:
    """Whether another program has written the document's file since it was opened or saved here.

    False if there is no such file any more, or nothing is known about it.
    """
    if document.path is None or not document.digest:
        return False
    try:
        return _digest(read_file(document.path, mark("an .akap file"))) != document.digest
    except FileError:
        return False


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def encode_document(
    document: Document, more: Sequence[ArchiveEntry] = (), folder: Path | None = None
) -> bytes:
    """The bytes of an .akap file. Raises InputError if it could not be opened again.

    more: additional entries at the end, which readers ignore; folder: where the file will be, from which the
    path of the artwork begins; None leaves it out.
    """
    _check(document)
    drawing = document.drawing
    text = json.dumps(_describe(document, folder), allow_nan=False).encode()
    if len(text) > MAX_DOCUMENT_BYTES:
        raise InputError(
            tr(
                "expected a description of at most {most} bytes, got {count}",
                most=MAX_DOCUMENT_BYTES,
                count=len(text),
            )
        )
    entries = [
        ("mimetype", MIMETYPE, False),
        ("document.json", text, True),
        ("mesh/vertices", drawing.mesh.vertices.astype("<f8").tobytes(), True),
        ("mesh/faces", drawing.mesh.faces.astype("<i4").tobytes(), True),
        ("mesh/uv", drawing.uv.astype("<f4").tobytes(), True),
        ("pose/positions", document.state.positions.astype("<f8").tobytes(), True),
        *_stiffness_entries(document.state),
        *loose_entries(document.state),
        *_picture_entries(drawing),
        *named_pose_entries(document.state.poses),
        *keyframe_entries(document.state.animation),
        *more,
    ]
    pictures = (1 if drawing.original is None else 2) * drawing.image.nbytes
    check_expanded(pictures + sum(len(content) for name, content, _ in entries if not name.endswith(".png")))
    return pack(entries)


def decode_document(data: bytes, folder: Path = Path()) -> Document:
    """The document in the bytes of an .akap file, which is in ``folder``. Raises InputError, nothing else."""
    document = _decode(Archive(data), folder)
    _check(document)
    return document


def _check(document: Document) -> None:
    """Raise InputError if the document breaks a rule of .akap files that its types do not enforce."""
    mesh = document.drawing.mesh
    _check_sizes(*document.drawing.size, len(mesh.vertices), len(mesh.faces))
    _check_vertices(mesh.vertices)
    if document.drawing.meshing is not None:
        check_meshing(document.drawing.meshing)
    state = document.state
    check_state(state, len(mesh.vertices), len(mesh.faces))
    check_joints(state.joints, mesh)
    of_poses = [pose.crossings for pose in state.poses]
    for crossings in [*of_poses, *(keyframe.crossings for keyframe in state.animation.keyframes)]:
        check_crossings(crossings, len(mesh.faces))
    count = len(document.drawing.layers)
    for keyframe in state.animation.keyframes:
        if count and keyframe.layers is not None and not keyframe.layers.fits(count):
            actual = len(keyframe.layers.order)
            raise InputError(
                tr("keyframes: expected {count} layers in each, got {actual}", count=count, actual=actual)
            )


def _check_sizes(width: int, height: int, vertices: int, faces: int) -> None:
    if min(width, height, vertices, faces) < 1:
        raise InputError(
            tr(
                "expected sizes above 0, got {width} x {height}, {vertices} vertices, {faces} faces",
                width=width,
                height=height,
                vertices=vertices,
                faces=faces,
            )
        )
    limits = (
        (width * height, MAX_PIXELS, "pixels"),
        (vertices, MAX_DOCUMENT_VERTICES, "vertices"),
        (faces, MAX_DOCUMENT_FACES, "faces"),
    )
    for count, most, name in limits:
        if count > most:
            raise InputError(
                tr("expected at most {most} {name}, got {count}", most=most, name=name, count=count)
            )


def _check_vertices(vertices: Floats) -> None:
    largest = np.abs(vertices).max()
    if not largest <= MAX_COORDINATE:  # also for NaN; areas of larger coordinates could overflow
        raise InputError(
            tr(
                "vertices: expected coordinates up to {most:g} pixels, got {largest:g}",
                most=MAX_COORDINATE,
                largest=largest,
            )
        )


# -- writing -------------------------------------------------------------------------------------------------


# The pictures of a drawing never change, and encoding them takes longer than the rest of a save.
_encoded_pictures: WeakKeyDictionary[Drawing, list[ArchiveEntry]] = WeakKeyDictionary()


def _picture_entries(drawing: Drawing) -> list[ArchiveEntry]:
    if drawing.layers:
        return [*layer_picture_entries(drawing), *_layered_thumbnail(drawing)]
    if drawing not in _encoded_pictures:
        pictures = {"picture.png": drawing.image, THUMBNAIL_ENTRY: _thumbnail(drawing.image)}
        if drawing.original is not None:
            pictures[ORIGINAL_ENTRY] = drawing.original
        entries = [(name, encode_png(picture), False) for name, picture in pictures.items()]
        _encoded_pictures[drawing] = entries
    return _encoded_pictures[drawing]


def _layered_thumbnail(drawing: Drawing) -> list[ArchiveEntry]:
    if drawing not in _encoded_pictures:
        step = _thumbnail_step(drawing.size)
        picture = flat_picture(drawing.layers, drawing.layer_order, drawing.size, step)
        _encoded_pictures[drawing] = [(THUMBNAIL_ENTRY, encode_png(_thumbnail(picture)), False)]
    return _encoded_pictures[drawing]


def _stiffness_entries(state: EditState) -> list[ArchiveEntry]:
    if state.stiffness is None:
        return []
    return [(STIFFNESS_ENTRY, state.stiffness.astype("<f8").tobytes(), True)]


def _describe(document: Document, folder: Path | None) -> Json:
    """The entry document.json."""
    drawing, state = document.drawing, document.state
    width, height = drawing.size
    return {
        "format": DOCUMENT_FORMAT,
        "version": DOCUMENT_VERSION if _is_of_version_2(document) else FLAT_VERSION,
        "program": program_name(),
        "name": drawing.name,
        "picture": {"width": width, "height": height},
        "mesh": {
            "vertices": len(drawing.mesh.vertices),
            "faces": len(drawing.mesh.faces),
            "tied": drawing.mesh.tied,
            **({"cut": True} if drawing.mesh.is_cut else {}),
            **({"made": describe_meshing(drawing)} if drawing.meshing is not None else {}),
        },
        "pins": [pin.to_json() for pin in document.state.pins],
        "settings": document.state.settings.to_json(),
        **describe_layers(drawing),
        **({"joints": [joint.to_json() for joint in state.joints]} if state.joints else {}),
        **write_crossings(document.state.crossings),
        **({"mirror": state.mirror.to_json()} if state.mirror is not None else {}),
        **describe_loose(document.state),
        **describe_source(document.artwork, folder),
    }


def _is_of_version_2(document: Document) -> bool:
    """Whether it has what programs that know version 1 only would lose."""
    drawing = document.drawing
    has_scales = any(pin.scale is not None for pin in document.state.pins)
    return bool(drawing.layers) or drawing.mesh.is_cut or has_scales


def _thumbnail(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    step = _thumbnail_step(image.shape[:2])
    picture = Image.fromarray(np.ascontiguousarray(image[::step, ::step]))
    picture.thumbnail((THUMBNAIL_SIDE, THUMBNAIL_SIDE))
    return np.asarray(picture)


def _thumbnail_step(size: tuple[int, ...]) -> int:
    """Of a picture of this size, every how many pixels count: a quick first reduction of large ones."""
    return 1 + max(size) // (4 * THUMBNAIL_SIDE)


# -- reading -------------------------------------------------------------------------------------------------


def _decode(archive: Archive, folder: Path) -> Document:
    if "mimetype" not in archive or archive.read("mimetype", 256) != MIMETYPE:
        raise InputError(tr("expected an .akap file, got a zip archive of another kind"))
    text = archive.read("document.json", MAX_DOCUMENT_BYTES)
    with error_context("document.json"):
        record = parse_record(text)
        version = file_version(record, DOCUMENT_FORMAT)
    refuse_newer(version, DOCUMENT_VERSION)
    with error_context("document.json"):
        name, picture, mesh = (
            require(record, "name", str),
            require(record, "picture", dict),
            require(record, "mesh", dict),
        )
        width, height = require(picture, "width", int), require(picture, "height", int)
        n, m = require(mesh, "vertices", int), require(mesh, "faces", int)
        tied = optional(mesh, "tied", bool, True)
        is_cut = optional(mesh, "cut", bool, False) and version > FLAT_VERSION
        meshing = read_meshing(require(mesh, "made", dict)) if "made" in mesh else None
        _check_sizes(width, height, n, m)
    positions = archive.read_array("pose/positions", "<f8", n, 2)
    with error_context("document.json"):
        pins = read_pins(require(record, "pins", list))
        settings = read_settings(require(record, "settings", dict))
        crossings, mirror = read_crossings(record), read_mirror(record, pins)
        artwork = read_source(record, folder)
    stiffness = archive.read_array(STIFFNESS_ENTRY, "<f8", m, 1)[:, 0] if STIFFNESS_ENTRY in archive else None
    poses, animation = read_named_poses(archive, n), read_keyframes(archive, n)
    loose = read_loose(archive, record, m)
    state = EditState(
        pins, positions, settings, None, poses, stiffness, animation, crossings, mirror=mirror, loose=loose
    )
    vertices = archive.read_array("mesh/vertices", "<f8", n, 2)
    _check_vertices(vertices)
    faces, uv = archive.read_array("mesh/faces", "<i4", m, 3), archive.read_array("mesh/uv", "<f4", n, 2)
    if version > FLAT_VERSION and "layers" in record:
        texture, layers, order, vertex_layers = read_layers(archive, record, n)
        layered_mesh = TriMesh(vertices, faces, tied, vertex_layers, is_cut)
        drawing = Drawing(
            texture, layered_mesh, uv, name, meshing, None, layers, order, canvas=(width, height)
        )
        with error_context("document.json"):
            joints = read_joints(record)
        return Document(drawing, replace(state, joints=joints), artwork=artwork)
    trimesh = TriMesh(vertices, faces, tied, is_cut=is_cut)
    image, original = _picture(archive, "picture.png", width, height), None
    if meshing is not None and meshing.background is not None:
        original = _picture(archive, ORIGINAL_ENTRY, width, height)
    return Document(Drawing(image, trimesh, uv, name, meshing, original), state, artwork=artwork)


def _picture(archive: Archive, name: str, width: int, height: int) -> NDArray[np.uint8]:
    content = archive.read(name, MAX_PICTURE_BYTES)
    archive.count_expanded(max(4 * width * height - len(content), 0))
    with error_context(name):
        image = decode_image(content, ("PNG",), (width, height))
        if image.shape[:2] != (height, width):
            raise InputError(tr("expected an upright picture, got one rotated by its EXIF data"))
    return freeze(image)
