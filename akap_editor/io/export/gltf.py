"""Exports glTF 2.0 binary files (Khronos): mesh, texture, pose and keyframes as morph targets."""

import json
import struct
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from .baked_animation import BakedAnimation
from .drawn_faces import DrawnFaces, drawn_faces, stacked
from .texture import encode_texture, level_height, y_up
from .unique_names import UniqueNames

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
        return self._add_accessor(view, array, kind, bounds)

    def add_samples(self, array: NDArray[Any], kind: str, bounds: bool = False) -> int:
        """Append the times or the values (count, columns) float32 of an animation; see `add_array`."""
        return self._add_accessor(self.add_view(array.tobytes()), array, kind, bounds)

    def _add_accessor(self, view: int, array: NDArray[Any], kind: str, bounds: bool) -> int:
        is_index = array.dtype == np.uint32
        count = array.size if kind == "SCALAR" else len(array)
        accessor: dict[str, Any] = {"bufferView": view, "componentType": _UINT if is_index else _FLOAT}
        accessor |= {"count": count, "type": kind}
        if bounds:
            low, high = np.atleast_1d(array.min(axis=0)), np.atleast_1d(array.max(axis=0))
            accessor |= {"min": low.tolist(), "max": high.tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def encode_glb(
    drawing: Drawing,
    positions: Floats,
    order: Ints | CutMesh | None = None,
    baked: BakedAnimation | None = None,
    z_order: bool = False,
) -> bytes:
    """The bytes of a .glb file: the rest pose, and the pose ``positions`` (n, 2) as a morph target.

    The target's weight is 1, so that viewers show the pose. Faces are counterclockwise seen from +z, from
    back to front; order: see `Document.draw_order`. baked: keyframes, of which each pose is a target, too,
    and the animation "Keyframes" sets their weights. Where they need several orders, there is a node for each
    of these, and the animation scales those to nothing that are not shown. z_order: lay what is in front
    nearer to the viewer, see `stacked`.
    """
    buffer = _Buffer()
    poses = [positions, *([] if baked is None else baked.poses)]
    layers = _layers(drawing, positions, order, baked, z_order)
    names = ["Pose", *(f"Keyframes {k}" for k in range(1, len(poses)))]
    meshes = [
        {
            "name": drawing.name if number == 0 else f"{drawing.name} {number + 1}",
            "primitives": primitives,
            "weights": [1.0, *[0.0] * (len(poses) - 1)],
            "extras": {"targetNames": names},
        }
        for number, primitives in enumerate(_primitives(buffer, drawing, layers, poses))
    ]
    nodes = [
        {"name": mesh["name"], "mesh": number, "scale": [0.0 if number else 1 / PIXELS_PER_UNIT] * 3}
        for number, mesh in enumerate(meshes)
    ]
    animations = {} if baked is None else {"animations": [_animation(buffer, baked, len(layers))]}
    image = buffer.add_view(encode_texture(drawing))
    scene = {
        "asset": {"version": "2.0", "generator": "akap-editor"},
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": meshes,
        **animations,
        "materials": _materials(drawing),
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


def _layers(
    drawing: Drawing,
    positions: Floats,
    order: Ints | CutMesh | None,
    baked: BakedAnimation | None,
    z_order: bool,
) -> list[tuple[DrawnFaces, CutMesh | None]]:
    """The faces in each order, and how the mesh is cut; the pose has an order of its own if it has seams."""
    layers: list[tuple[DrawnFaces, CutMesh | None]] = []
    if baked is None or isinstance(order, CutMesh):
        drawn = drawn_faces(drawing, positions, order)
        drawn = stacked(drawn, *drawn.low_and_high) if z_order else drawn
        layers.append((drawn, order if isinstance(order, CutMesh) else None))
    for each in [] if baked is None else baked.orders:
        drawn = drawn_faces(drawing, positions, each.cut)
        rank = np.full(len(drawn.faces), -1)  # faces of hidden layers are not drawn
        rank[each.order] = np.arange(len(each.order))
        drawn = replace(
            drawn,
            faces=drawn.faces[each.order],
            components=drawn.components[each.order],
            layers=drawn.layers[each.order],
        )
        pairs = np.stack([rank[each.low], rank[each.high]])
        low, high = pairs[:, pairs.min(axis=0, initial=0) >= 0]
        layers.append((stacked(drawn, low, high) if z_order else drawn, each.cut))
    return layers


def _primitives(
    buffer: _Buffer,
    drawing: Drawing,
    layers: Sequence[tuple[DrawnFaces, CutMesh | None]],
    poses: Sequence[Floats],
) -> list[list[dict[str, Any]]]:
    """The primitives of each order of drawing; those with the same vertices share them and their targets.

    Each layer is a primitive with a material of its own; without layers there is one.
    """
    shared: dict[tuple[bytes, bytes, int], dict[str, Any]] = {}  # by vertices, levels and cuts
    primitives = []
    for drawn, cut in layers:
        key = drawn.sources.tobytes(), drawn.z.tobytes(), id(cut)
        if key not in shared:
            rest = _to_3d(y_up(drawing, drawn.rest), drawn.z * level_height(drawing))
            shared[key] = {
                "attributes": {
                    "POSITION": buffer.add_array(rest, "VEC3", bounds=True),
                    "TEXCOORD_0": buffer.add_array(drawn.uv.astype("<f4"), "VEC2"),
                },
            }
        runs = drawn.layer_runs(drawing)
        indices = [buffer.add_array(drawn.faces[run, ::-1].astype("<u4"), "SCALAR") for _, run in runs]
        if "targets" not in shared[key]:
            targets = []
            for pose in poses:
                points = pose if cut is None else cut.values(pose)
                offsets = _to_3d(y_up(drawing, points[drawn.sources]), rest[:, 2]) - rest
                targets.append({"POSITION": buffer.add_array(offsets, "VEC3", bounds=True)})
            shared[key]["targets"] = targets
        primitives.append(
            [
                {**shared[key], "indices": accessor, "material": int(drawn.layers[run[0]])}
                for accessor, (_, run) in zip(indices, runs, strict=True)
            ]
        )
    return primitives


def _animation(buffer: _Buffer, baked: BakedAnimation, node_count: int) -> dict[str, Any]:
    """Weights of all targets over time; and where there are several nodes, when they are shown.

    The last nodes are those of the orders, one before them is of the pose alone.
    """
    count = len(baked.times)
    times = buffer.add_samples(np.array(baked.times, dtype="<f4"), "SCALAR", bounds=True)
    weights = np.eye(count, count + 1, 1, dtype="<f4")
    samplers: list[dict[str, Any]] = [
        {"input": times, "output": buffer.add_samples(weights.reshape(-1, 1), "SCALAR")}
    ]
    channels: list[dict[str, Any]] = [
        {"sampler": 0, "target": {"node": node, "path": "weights"}} for node in range(node_count)
    ]
    if node_count > 1:
        changes = sorted({0.0, *(start for each in baked.orders for start, _ in each.spans)})
        moments = buffer.add_samples(np.array(changes, dtype="<f4"), "SCALAR", bounds=True)
        spans: list[list[tuple[float, float]]] = [[]] * (node_count - len(baked.orders)) + [
            each.spans for each in baked.orders
        ]
        for node, shown_in in enumerate(spans):
            shown = [any(start <= time < end for start, end in shown_in) for time in changes]
            scales = np.repeat(np.array(shown, dtype="<f4")[:, None] / PIXELS_PER_UNIT, 3, axis=1)
            output = buffer.add_samples(scales.astype("<f4"), "VEC3")
            channels.append({"sampler": len(samplers), "target": {"node": node, "path": "scale"}})
            samplers.append({"input": moments, "output": output, "interpolation": "STEP"})
    return {"name": "Keyframes", "channels": channels, "samplers": samplers}


def _to_3d(points: Floats, z: NDArray[Any]) -> NDArray[np.float32]:
    """Points (n, 2) and their z (n,) as (n, 3) float32."""
    return np.column_stack([points, z]).astype("<f4")


def _materials(drawing: Drawing) -> list[dict[str, Any]]:
    """One for each layer, in their order, or for a flat drawing."""
    if not drawing.layers:
        return [_material(drawing.name, 1.0)]
    names = UniqueNames()
    return [_material(names.next(layer.name), layer.opacity) for layer in drawing.layers]


def _material(name: str, opacity: float) -> dict[str, Any]:
    """An unlit material that blends alpha and shows both sides, as a pose may flip faces."""
    return {
        "name": name,
        "pbrMetallicRoughness": {
            **({} if opacity == 1 else {"baseColorFactor": [1.0, 1.0, 1.0, opacity]}),
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
