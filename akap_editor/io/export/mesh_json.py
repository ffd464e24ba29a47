"""Exports mesh, pose and pins as JSON, described in docs/exporting.md."""

import json
from typing import Any

from ...editor.document.document import Document
from ...editor.document.drawing import Drawing
from ...layers.drawing_layer import shown_layers
from ...overlap.seams import CutMesh

MESH_JSON_FORMAT = "akap-mesh"
MESH_JSON_VERSION = 1


def _layers(drawing: Drawing) -> dict[str, Any] | None:
    """The layers of a drawing from back to front, and the layer of each face; None without layers."""
    if not drawing.layers:
        return None
    shown = shown_layers(drawing.layers)
    height, width = drawing.image.shape[:2]
    return {
        "texture": {"width": width, "height": height},
        "layers": [
            {
                "name": layer.name,
                "groups": list(layer.groups),
                "shown": bool(shown[number]),
                "opacity": layer.opacity,
                "blend": layer.blend,
                "offset": list(layer.artwork.offset),
                "corner": list(layer.artwork.corner),
            }
            for number, layer in enumerate(drawing.layers)
        ],
        "order": list(drawing.layer_order),
        "faceLayers": drawing.face_layers.tolist(),
    }


def encode_json(document: Document) -> bytes:
    """The bytes of a .json file: one object, one line per value. Floats are exact."""
    drawing, state = document.drawing, document.state
    mesh, drawn = drawing.mesh, document.draw_order
    cut = drawn if isinstance(drawn, CutMesh) else None
    rest_points, posed_points = (
        mesh.evaluate(state.points, positions) for positions in (mesh.vertices, state.positions)
    )
    record = {
        "format": MESH_JSON_FORMAT,
        "version": MESH_JSON_VERSION,
        "name": drawing.name,
        "picture": {"width": drawing.size[0], "height": drawing.size[1]},
        "vertices": mesh.vertices.tolist(),
        "positions": state.positions.tolist(),
        "uv": drawing.uv.tolist(),
        "faces": mesh.faces.tolist(),
        "order": None if document.face_order is None else document.face_order.tolist(),
        "seams": None
        if cut is None
        else {"edges": cut.edges.tolist(), "shares": cut.shares.tolist(), "faces": cut.faces.tolist()},
        "pins": [
            {
                "id": pin.id,
                "depth": pin.depth,
                "angle": pin.angle,
                "scale": pin.scale,
                "face": pin.face,
                "weights": pin.weights.tolist(),
                "rest": rest_points[index].tolist(),
                "position": posed_points[index].tolist(),
                "target": pin.target.tolist(),
            }
            for index, pin in enumerate(state.pins)
        ],
        "layers": _layers(drawing),
        "stiffness": None if state.stiffness is None else state.stiffness.tolist(),
        "settings": state.settings.to_json(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(value, allow_nan=False)}" for key, value in record.items())
    return ("{\n" + ",\n".join(lines) + "\n}\n").encode()
