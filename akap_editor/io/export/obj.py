"""Exports Wavefront OBJ files: the posed mesh, its material and its texture."""

import numpy as np

from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from .drawn_faces import drawn_faces, stacked
from .texture import companion_stem, encode_texture, level_height, texture_name, y_up
from .unique_names import UniqueNames


def encode_obj(
    drawing: Drawing,
    positions: Floats,
    stem: str,
    order: Ints | CutMesh | None = None,
    z_order: bool = True,
) -> dict[str, bytes]:
    """The contents of texture, material and mesh file, by name, for the pose ``positions`` (n, 2).

    Vertices keep their order, so that other programs can blend two poses of a drawing; new ones along seams
    follow. Each layer is a group. Faces are counterclockwise seen from +z, from back to front; order: see
    `Document.draw_order`; z_order: lay what is in front nearer to the viewer, see `stacked`.
    """
    drawn = drawn_faces(drawing, positions, order)
    if z_order:
        drawn = stacked(drawn, *drawn.low_and_high)
    z = drawn.z * level_height(drawing)
    texture, material = companion_names(stem)
    points, uv = y_up(drawing, drawn.pose), drawn.uv * np.array([1, -1]) + np.array([0, 1])
    lines = [
        f"mtllib {material}",
        f"o {companion_stem(drawing.name) or 'drawing'}",
        *(f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in np.column_stack([points, z]).tolist()),
        *(f"vt {u:.9g} {v:.9g}" for u, v in uv.tolist()),
        "vn 0 0 1",
        "usemtl drawing",
    ]
    groups = _group_names(drawing)
    for layer, run in drawn.layer_runs(drawing):
        if layer is not None:
            lines.append(f"g {groups[drawn.layers[run[0]]]}")
        lines += [f"f {a}/{a}/1 {b}/{b}/1 {c}/{c}/1" for a, b, c in (drawn.faces[run, ::-1] + 1).tolist()]
    return {
        texture: encode_texture(drawing),
        material: _material(texture).encode(),
        f"{stem}.obj": ("\n".join(lines) + "\n").encode(),
    }


def _group_names(drawing: Drawing) -> list[str]:
    """The name of the group of each layer, which differ."""
    names = UniqueNames("_")
    return [names.next(companion_stem(layer.name) or "layer") for layer in drawing.layers]


def companion_names(stem: str) -> list[str]:
    """The names of texture and material beside an OBJ file."""
    return [texture_name(stem), f"{companion_stem(stem)}.mtl"]


def _material(texture: str) -> str:
    return f"newmtl drawing\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\nmap_Kd {texture}\nmap_d {texture}\n"
