"""Exports Wavefront OBJ files: the posed mesh, its material and its texture."""

import numpy as np

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from .drawn_faces import drawn_faces
from .texture import companion_stem, encode_texture, texture_name, y_up


def encode_obj(
    drawing: Drawing, positions: Floats, stem: str, order: Ints | CutMesh | None = None
) -> dict[str, bytes]:
    """The contents of texture, material and mesh file, by name, for the pose ``positions`` (n, 2).

    Vertices keep their order, so that other programs can blend two poses of a drawing; new ones along seams
    follow. Faces are counterclockwise seen from +z, from back to front; order: see `Document.draw_order`.
    """
    drawn = drawn_faces(drawing, positions, order)
    texture, material = companion_names(stem)
    points, uv = y_up(drawing, drawn.pose), drawn.uv * np.array([1, -1]) + np.array([0, 1])
    corners = drawn.faces[:, ::-1] + 1
    lines = [
        f"mtllib {material}",
        f"o {companion_stem(drawing.name) or 'drawing'}",
        *(f"v {x:.9g} {y:.9g} 0" for x, y in points.tolist()),
        *(f"vt {u:.9g} {v:.9g}" for u, v in uv.tolist()),
        "vn 0 0 1",
        "usemtl drawing",
        *(f"f {a}/{a}/1 {b}/{b}/1 {c}/{c}/1" for a, b, c in corners.tolist()),
    ]
    return {
        texture: encode_texture(drawing),
        material: _material(texture).encode(),
        f"{stem}.obj": ("\n".join(lines) + "\n").encode(),
    }


def companion_names(stem: str) -> list[str]:
    """The names of texture and material beside an OBJ file."""
    return [texture_name(stem), f"{companion_stem(stem)}.mtl"]


def _material(texture: str) -> str:
    return f"newmtl drawing\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\nmap_Kd {texture}\nmap_d {texture}\n"
