"""Exports Spine skeletons in its JSON format, https://esotericsoftware.com/spine-json-format."""

import json
from typing import Any

import numpy as np

from ...editor.document.drawing import Drawing
from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from .component_runs import component_runs
from .texture import encode_texture, texture_name, y_up

SPINE_VERSION = "4.2.00"
MAX_ATTACHMENT_VERTICES = 32767  # runtimes count vertices with signed 16-bit integers
_DECIMALS = 3


def encode_spine(
    drawing: Drawing,
    positions: Floats,
    stem: str,
    order: Ints | None = None,
    pairs: tuple[Ints, Ints] = (np.zeros(0, dtype=int), np.zeros(0, dtype=int)),
) -> dict[str, bytes]:
    """The contents of texture and JSON file, by name. Raises InputError if the mesh is too large.

    The skeleton has one bone; each component of the mesh is a slot with one unweighted mesh attachment, or
    several slots where it passes both behind and in front of another one. The setup pose is the rest pose,
    the animation "pose" holds ``positions`` (n, 2) as a deform key. order: (m,) faces from back to front;
    pairs: (p,) lower and upper faces that overlap, see `Overlaps.low_and_high`.
    """
    texture, title = texture_name(stem), drawing.name or "drawing"
    rest, pose = y_up(drawing, drawing.mesh.vertices), y_up(drawing, positions)
    slots, attachments, deform = [], {}, {}
    mesh, order = drawing.mesh, np.arange(len(drawing.mesh.faces)) if order is None else order
    parts = [_Part(mesh, number) for number in range(int(mesh.component.max()) + 1)]
    runs = component_runs(mesh.component[mesh.faces[:, 0]], order, *pairs)
    for number, (component, faces) in enumerate(runs, start=1):
        part = parts[component]
        name = title if number == 1 else f"{title} {number}"
        slots.append({"name": name, "bone": "root", "attachment": name})
        attachments[name] = {name: _attachment(drawing, part, faces, rest, texture.removesuffix(".png"))}
        offsets = _flat(pose[part.order]) - _flat(rest[part.order])
        deform[name] = {name: {"deform": [{"vertices": np.round(offsets, _DECIMALS).tolist()}]}}
    low, high = rest.min(axis=0), rest.max(axis=0)
    x, y, width, height = np.round([*low, *(high - low)], 2).tolist()
    skeleton = {"spine": SPINE_VERSION, "x": x, "y": y, "width": width, "height": height, "images": "./"}
    record = {
        "skeleton": skeleton,
        "bones": [{"name": "root"}],
        "slots": slots,
        "skins": [{"name": "default", "attachments": attachments}],
        "animations": {"pose": {"attachments": {"default": deform}}},
    }
    text = json.dumps(record, separators=(",", ":"), allow_nan=False)
    return {texture: encode_texture(drawing), f"{stem}.spine.json": text.encode()}


class _Part:
    """A component of a mesh, renumbered as Spine requires: the hull (outer contour) first, in order.

    order: (p,) the mesh's vertex for each new number; hull: number of vertices of the hull; faces: (m, 3)
    those of the whole mesh, −1 for vertices of other components; edges: (e, 2) the hull's edges first; both
    in new numbers.
    """

    def __init__(self, mesh: TriMesh, number: int) -> None:
        vertices = np.flatnonzero(mesh.component == number)
        loops = [loop for loop in mesh.boundary_loops if mesh.component[loop[0]] == number]
        hull = max(loops, key=lambda loop: abs(_area(mesh.vertices[loop])))
        self.hull = len(hull)
        self.order = np.concatenate([hull, np.setdiff1d(vertices, hull)])
        new = np.full(len(mesh.vertices), -1)
        new[self.order] = np.arange(len(self.order))
        self.faces: Ints = new[mesh.faces]
        ring = np.stack([np.arange(self.hull), np.roll(np.arange(self.hull), -1)], axis=1)
        inner = np.sort(new[mesh.edges[mesh.component[mesh.edges[:, 0]] == number]], axis=1)
        known = {tuple(sorted(pair)) for pair in ring.tolist()}
        rest = [pair for pair in inner.tolist() if tuple(pair) not in known]
        self.edges: Ints = np.array([*ring.tolist(), *rest])


def _attachment(drawing: Drawing, part: _Part, faces: Ints, rest: Floats, texture: str) -> dict[str, Any]:
    """The mesh attachment of some faces of a component; rest (n, 2): vertices with y up."""
    if len(part.order) > MAX_ATTACHMENT_VERTICES:
        raise InputError(
            f"expected parts of at most {MAX_ATTACHMENT_VERTICES} vertices for Spine, got {len(part.order)}; "
            "choose a coarser mesh"
        )
    width, height = drawing.size
    return {
        "type": "mesh",
        "path": texture,
        "uvs": np.round(_flat(drawing.uv[part.order].astype(np.float64)), 6).tolist(),
        "triangles": part.faces[faces].ravel().tolist(),
        "vertices": np.round(_flat(rest[part.order]), _DECIMALS).tolist(),
        "hull": part.hull,
        "edges": (2 * part.edges).ravel().tolist(),  # indices into the list of coordinates
        "width": width,
        "height": height,
    }


def _flat(points: Floats) -> Floats:
    """Points (n, 2) as x0, y0, x1, y1, ... without negative zeros."""
    return points.ravel() + 0.0


def _area(ring: Floats) -> float:
    """Signed area of a polygon (q, 2)."""
    x, y = ring.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
