"""The numbers of a document as JSON: mesh, pose and pins, described in docs/exporting.md."""

import json

from ...editor.document.document import Document

MESH_JSON_FORMAT = "akap-mesh"
MESH_JSON_VERSION = 1


def encode_json(document: Document) -> bytes:
    """One JSON object, one line for each of its values; floats read back are the same float64."""
    drawing, state = document.drawing, document.state
    mesh = drawing.mesh
    rest, now = (mesh.evaluate(state.points, points) for points in (mesh.vertices, state.positions))
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
        "pins": [
            {
                "id": pin.id,
                "depth": pin.depth,
                "face": pin.face,
                "weights": pin.weights.tolist(),
                "rest": rest[index].tolist(),
                "position": now[index].tolist(),
                "target": pin.target.tolist(),
            }
            for index, pin in enumerate(state.pins)
        ],
        "settings": state.settings.to_json(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(value, allow_nan=False)}" for key, value in record.items())
    return ("{\n" + ",\n".join(lines) + "\n}\n").encode()
