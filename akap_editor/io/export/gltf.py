"""Exports glTF 2.0 binary files: mesh, texture, and the pose as a morph target (Khronos specification)."""

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from .drawn_faces import drawn_faces
from .texture import encode_texture, y_up

PIXELS_PER_UNIT = 100.0  # by the scale of the node; the mesh itself is in pixels

_FLOAT, _UINT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963  # targets of buffer views
_LINEAR, _MIPMAPS, _CLAMP = 9729, 9987, 33071


class _Buffer:
    """Collects the binary part of the file, with its buffer views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add_view(self, data: bytes, **properties: int) -> int:
        """Append data, padded to a multiple of 4 bytes; return the number of its buffer view."""
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **properties})
        self.data += data + bytes(-len(data) % 4)
        return len(self.views) - 1

    def add_array(self, array: NDArray[Any], kind: str, bounds: bool = False) -> int:
        """Append an array (count, columns) of float32, or of indices uint32; return its accessor's number.

        kind: "SCALAR", "VEC2" or "VEC3"; bounds: whether the accessor has the least and greatest values.
        """
        is_index = array.dtype == np.uint32
        view = self.add_view(array.tobytes(), target=_INDICES if is_index else _VERTICES)
        count = array.size if is_index else len(array)
        accessor: dict[str, Any] = {"bufferView": view, "componentType": _UINT if is_index else _FLOAT}
        accessor |= {"count": count, "type": kind}
        if bounds:
            accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def encode_glb(drawing: Drawing, positions: Floats, order: Ints | CutMesh | None = None) -> bytes:
    """The bytes of a .glb file: the rest pose, and the pose ``positions`` (n, 2) as a morph target.

    The target's weight is 1, so that viewers show the pose. Faces are counterclockwise seen from +z, from
    back to front; order: see `Document.draw_order`.
    """
    buffer, drawn = _Buffer(), drawn_faces(drawing, positions, order)
    rest, pose = (_to_3d(y_up(drawing, points)) for points in (drawn.rest, drawn.pose))
    primitive = {
        "attributes": {
            "POSITION": buffer.add_array(rest, "VEC3", bounds=True),
            "TEXCOORD_0": buffer.add_array(drawn.uv.astype("<f4"), "VEC2"),
        },
        "indices": buffer.add_array(drawn.faces[:, ::-1].astype("<u4"), "SCALAR"),
        "material": 0,
        "targets": [{"POSITION": buffer.add_array(pose - rest, "VEC3", bounds=True)}],
    }
    image = buffer.add_view(encode_texture(drawing))
    scene = {
        "asset": {"version": "2.0", "generator": "akap-editor"},
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": drawing.name, "mesh": 0, "scale": [1 / PIXELS_PER_UNIT] * 3}],
        "meshes": [
            {
                "name": drawing.name,
                "primitives": [primitive],
                "weights": [1.0],
                "extras": {"targetNames": ["Pose"]},
            }
        ],
        "materials": [_material(drawing.name)],
        "textures": [{"sampler": 0, "source": 0}],
        "samplers": [{"magFilter": _LINEAR, "minFilter": _MIPMAPS, "wrapS": _CLAMP, "wrapT": _CLAMP}],
        "images": [{"name": drawing.name, "bufferView": image, "mimeType": "image/png"}],
        "buffers": [{"byteLength": len(buffer.data)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    text = json.dumps(scene, separators=(",", ":"), allow_nan=False).encode()
    chunks = _chunk(b"JSON", text + b" " * (-len(text) % 4)) + _chunk(b"BIN\0", bytes(buffer.data))
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _to_3d(points: Floats) -> NDArray[np.float32]:
    """Points (n, 2) as (n, 3) float32 with z = 0."""
    return np.pad(points, [(0, 0), (0, 1)]).astype("<f4")


def _material(name: str) -> dict[str, Any]:
    """An unlit material that blends alpha and shows both sides, as a pose may flip faces."""
    return {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0},
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
        "alphaMode": "BLEND",
        "doubleSided": True,
        "extensions": {"KHR_materials_unlit": {}},
    }


def _chunk(kind: bytes, content: bytes) -> bytes:
    """A chunk of the file, with its length and type."""
    return struct.pack("<I4s", len(content), kind) + content
