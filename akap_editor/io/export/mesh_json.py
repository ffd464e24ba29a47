"""Exports mesh, pose and pins as JSON, described in docs/exporting.md."""

import json

from ...editor.document.document import Document
from ...overlap.seams import CutMesh

MESH_JSON_FORMAT = "akap-mesh"
MESH_JSON_VERSION = 1


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
                "face": pin.face,
                "weights": pin.weights.tolist(),
                "rest": rest_points[index].tolist(),
                "position": posed_points[index].tolist(),
                "target": pin.target.tolist(),
            }
            for index, pin in enumerate(state.pins)
        ],
        "stiffness": None if state.stiffness is None else state.stiffness.tolist(),
        "settings": state.settings.to_json(),
    }
    lines = (f"{json.dumps(key)}: {json.dumps(value, allow_nan=False)}" for key, value in record.items())
    return ("{\n" + ",\n".join(lines) + "\n}\n").encode()
