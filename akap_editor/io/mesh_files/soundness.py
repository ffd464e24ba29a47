"""Reads meshes of all kinds that the program opens or exports, and finds their defects."""

import codecs
import reprlib
import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ...errors import InputError
from ...geometry.validation import MAX_COORDINATE, Floats, Ints, as_indices, as_points
from ...words import tr
from ..akap.json_records import numbers, parse_record
from .obj_off import OFF_HEADER, PARSERS, decode_text
from .polygons import triangulate_polygons

_COMPONENTS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
# Raised by code that uses a malformed JSON record.
_MALFORMED_ERRORS = (
    *(AttributeError, IndexError, KeyError, MemoryError, OverflowError, RecursionError),
    *(TypeError, ValueError, struct.error),
)


@dataclass(frozen=True, eq=False)
class TriangleSoup:
    """Triangles as in a file of some kind, perhaps with defects.

    kind: of the file; vertices: (n, 2) or (n, 3) float64; faces: (m, 3), indices of vertices.
    """

    kind: str
    vertices: Floats
    faces: Ints


def decode_mesh(data: bytes) -> TriangleSoup:
    """The mesh in the bytes of an OBJ, OFF or .glb file, or of a JSON export (Spine, or mesh and pins).

    Several meshes of one file are joined. Raises InputError, and nothing else.
    """
    kind, read = _reader(data)
    try:
        vertices, faces = read(data)
        shape = np.shape(vertices)
    except InputError:
        raise
    except _MALFORMED_ERRORS as error:
        reason = reprlib.repr(str(error))
        raise InputError(
            tr("expected a whole {kind} file, got a damaged one ({reason})", kind=kind, reason=reason)
        ) from error
    if len(shape) != 2 or shape[1] not in (2, 3) or not shape[0]:
        raise InputError(tr("expected vertices in the {kind} file, got none", kind=kind))
    points = as_points(vertices, "vertices", columns=shape[1])
    if np.abs(points).max() > MAX_COORDINATE:
        raise InputError(
            tr("vertices: expected coordinates up to {most:g}, got greater ones", most=MAX_COORDINATE)
        )
    return TriangleSoup(kind, points, as_indices(faces, "faces", 3, len(points)))


def mesh_defects(mesh: TriangleSoup) -> list[str]:
    """The defects that keep a mesh from being an oriented surface, one phrase each; none if it is sound."""
    if not len(mesh.faces):
        return ["it has no faces"]
    corners = mesh.vertices[mesh.faces]
    points = np.pad(corners, [(0, 0), (0, 0), (0, 3 - corners.shape[2])])
    areas = np.linalg.norm(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1)
    half_edges = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2) @ np.array([len(mesh.vertices), 1])
    _, counts = np.unique(half_edges, return_counts=True)
    unused = len(mesh.vertices) - len(np.unique(mesh.faces))
    defects = (
        (int((areas == 0).sum()), "without area", "face"),
        (int((counts > 1).sum()), "with two faces on one side", "edge"),
        (unused, "in no face", "vertex"),
    )
    plural = {"face": "faces", "edge": "edges", "vertex": "vertices"}
    return [f"{n} {name if n == 1 else plural[name]} {what}" for n, what, name in defects if n]


def count_parts(mesh: TriangleSoup) -> int:
    """The number of connected parts that have faces."""
    n = len(mesh.vertices)
    i, j = mesh.faces[:, [0, 1, 1, 2]].reshape(-1, 2).T
    graph = coo_array((np.ones(len(i)), (i, j)), shape=(n, n))
    _, part = connected_components(graph, directed=False)
    return len(np.unique(part[mesh.faces])) if len(mesh.faces) else 0


def _reader(data: bytes) -> tuple[str, Callable[[bytes], tuple[Any, Any]]]:
    """The kind of a file, by its first bytes, and the function that reads its vertices and faces."""
    if data[:4] == b"glTF":
        return "glTF", _read_glb
    if data.removeprefix(codecs.BOM_UTF8).lstrip()[:1] == b"{":
        return "JSON mesh", _read_json
    words = decode_text(data[:1000]).split(maxsplit=1)
    suffix = ".off" if words and OFF_HEADER.fullmatch(words[0]) else ".obj"
    return suffix[1:].upper(), partial(_read_polygons, suffix)


def _read_polygons(suffix: str, data: bytes) -> tuple[Any, Any]:
    mesh = PARSERS[suffix](decode_text(data))
    points = as_points(mesh.vertices, "vertices", columns=3)
    return mesh.vertices, triangulate_polygons(points, mesh.faces)


def _read_json(data: bytes) -> tuple[Any, Any]:
    record = parse_record(data.removeprefix(codecs.BOM_UTF8))
    if "faces" in record:
        return record["vertices"], record["faces"]
    vertices: list[Floats] = []
    faces: list[Ints] = []
    for skin in record["skins"]:
        for slot in skin["attachments"].values():
            for mesh in slot.values():
                points = numbers(mesh["vertices"], "vertices").reshape(-1, 2)
                corners = as_indices(np.reshape(mesh["triangles"], (-1, 3)), "triangles", 3, len(points))
                faces.append(corners + sum(map(len, vertices)))
                vertices.append(points)
    return np.concatenate(vertices), np.concatenate(faces)


def _read_glb(data: bytes) -> tuple[Any, Any]:
    size = struct.unpack_from("<I", data, 12)[0]
    record = parse_record(data[20 : 20 + size].rstrip(b" \0"))
    binary = data[28 + size :]
    vertices: list[NDArray[Any]] = []
    faces: list[NDArray[Any]] = []
    for mesh in record["meshes"]:
        for primitive in mesh["primitives"]:
            points = _accessor(record, binary, primitive["attributes"]["POSITION"])
            corners = _accessor(record, binary, primitive["indices"]).reshape(-1, 3)
            faces.append(as_indices(corners, "faces", 3, len(points)) + sum(map(len, vertices)))
            vertices.append(points)
    return np.concatenate(vertices), np.concatenate(faces)


def _accessor(record: dict[str, Any], binary: bytes, number: int) -> NDArray[Any]:
    """The array (count, columns) of a glTF accessor. Raises InputError, or one of `_MALFORMED_ERRORS`."""
    accessor = record["accessors"][_natural({"accessor": number}, "accessor")]
    view = record["bufferViews"][_natural(accessor, "bufferView")]
    columns = _COLUMNS[accessor["type"]]
    begin, size = _natural(view, "byteOffset", 0), _natural(view, "byteLength")
    start = _natural(accessor, "byteOffset", 0)
    kind = np.dtype(_COMPONENTS[accessor["componentType"]])
    count = _natural(accessor, "count") * columns
    if start + count * kind.itemsize > size or begin + size > len(binary):
        raise InputError(
            tr("accessor {number}: expected it to fit into its buffer view, got a longer one", number=number)
        )
    return np.frombuffer(binary, kind, count, begin + start).reshape(-1, columns)


def _natural(record: dict[str, Any], name: str, default: int | None = None) -> int:
    """The integer from 0 of a key. Raises InputError."""
    value = record.get(name, default)
    if type(value) is not int or value < 0:
        raise InputError(
            tr("expected {name} to be an integer from 0, got {value}", name=name, value=reprlib.repr(value))
        )
    return value
