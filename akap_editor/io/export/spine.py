"""Exports Spine skeletons in its JSON format, https://esotericsoftware.com/spine-json-format."""

import json
from collections.abc import Collection, Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...editor.document.drawing import Drawing
from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from ...words import tr
from .baked_animation import BakedAnimation, DrawingOrder
from .component_runs import component_runs
from .drawn_faces import DrawnFaces, drawn_faces
from .texture import companion_stem, encode_texture, texture_name, y_up
from .unique_names import UniqueNames

SPINE_VERSION = "4.2.00"
MAX_ATTACHMENT_VERTICES = 32767  # runtimes count vertices with signed 16-bit integers
_DECIMALS = 3


def encode_spine(
    drawing: Drawing,
    positions: Floats,
    stem: str,
    order: Ints | CutMesh | None = None,
    baked: BakedAnimation | None = None,
) -> dict[str, bytes]:
    """The contents of texture, atlas and JSON file, by name. Raises InputError if the mesh is too large.

    The skeleton has one bone; each component of the mesh is a slot with one unweighted mesh attachment, or
    several slots where it passes both behind and in front of another one. Slots are named after their layers,
    and hidden layers are left out. The setup pose is the rest pose, the animation "pose" holds ``positions``
    (n, 2) as a deform key. order: see `Document.draw_order`. baked: keyframes, which are the animation
    "keyframes"; where they need several orders, there are slots for each of these, which share what they can.
    """
    texture = texture_name(stem)
    region = texture.removesuffix(".png")
    rest = y_up(drawing, drawing.mesh.vertices)
    if baked is None:
        cut = order if isinstance(order, CutMesh) else None
        shape = _Shape(drawing, positions, order, cut)
        pairs = shape.drawn.low_and_high
        orders = [DrawingOrder(np.arange(len(shape.drawn.faces)), *pairs, drawing.layer_order, cut)]
        shapes = {id(cut): shape}
    else:
        orders = baked.orders
        shapes = {id(each.cut): _Shape(drawing, positions, each.cut, each.cut) for each in orders}
    slots: list[dict[str, str]] = []
    attachments: dict[str, dict[str, dict[str, Any]]] = {}
    offsets = _Offsets(drawing)
    runs_of_orders = [_layered_runs(drawing, shapes[id(each.cut)], each) for each in orders]
    slots_of_orders: list[list[str]] = [[] for _ in orders]
    slot_names = UniqueNames()
    for run, numbers in _shared_runs(runs_of_orders):
        name = slot_names.next(_title(drawing, run))
        shown = {"attachment": name} if 0 in numbers else {}
        slots.append({"name": name, "bone": "root", **shown})
        attachments[name] = {name: _attachment(drawing, run, region)}
        offsets.add_slot(name, run)
        for number in numbers:
            slots_of_orders[number].append(name)
    animations = {
        "pose": {"attachments": {"default": offsets.timelines(slots_of_orders[0], [(0.0, positions)])}}
    }
    if baked is not None:
        animations["keyframes"] = _animation(baked, slots_of_orders, offsets)
    low, high = rest.min(axis=0), rest.max(axis=0)
    x, y, width, height = np.round([*low, *(high - low)], 2).tolist()
    skeleton = {"spine": SPINE_VERSION, "x": x, "y": y, "width": width, "height": height, "images": "./"}
    record = {
        "skeleton": skeleton,
        "bones": [{"name": "root"}],
        "slots": slots,
        "skins": [{"name": "default", "attachments": attachments}],
        "animations": animations,
    }
    text = json.dumps(record, separators=(",", ":"), allow_nan=False)
    return {
        texture: encode_texture(drawing),
        atlas_name(stem): _atlas(texture, drawing.image.shape[1::-1]).encode(),
        f"{stem}.spine.json": text.encode(),
    }


def atlas_name(stem: str) -> str:
    """The name of the texture atlas beside a skeleton."""
    return f"{companion_stem(stem)}.atlas"


def _atlas(texture: str, size: tuple[int, ...]) -> str:
    """A texture atlas with one region: https://esotericsoftware.com/spine-atlas-format."""
    width, height = size
    region = texture.removesuffix(".png")
    lines = texture, f"size: {width}, {height}", "filter: Linear, Linear", region
    return "\n".join([*lines, f"bounds: 0, 0, {width}, {height}", ""])


class _Shape:
    """The drawn faces of one way to cut the mesh, and its parts by component.

    order: see `drawn_faces`; cut: the same, if it is one, else None.
    """

    def __init__(
        self, drawing: Drawing, positions: Floats, order: Ints | CutMesh | None, cut: CutMesh | None
    ) -> None:
        self.drawn, self.cut = drawn_faces(drawing, positions, order), cut
        self.rest = y_up(drawing, self.drawn.rest)
        numbers = np.unique(self.drawn.components).tolist()
        self.parts = {number: _Part(drawing.mesh, self.drawn, number) for number in numbers}


@dataclass(frozen=True, eq=False)
class _Run:
    """Some faces (q,) of a component, from back to front."""

    shape: _Shape
    component: int
    faces: Ints

    @property
    def part(self) -> "_Part":
        return self.shape.parts[self.component]

    @property
    def key(self) -> Hashable:
        """Equal for the same faces of the same part: with other cuts, too, if it is not cut."""
        cut = self.shape.cut
        is_cut = cut is not None and self.part.order.max() >= len(self.shape.drawn.rest) - len(cut.edges)
        return self.component, id(cut) if is_cut else None, self.shape.drawn.faces[self.faces].tobytes()


def _title(drawing: Drawing, run: _Run) -> str:
    """The name of the layer of some drawn faces; without layers that of the drawing."""
    name = drawing.layers[run.shape.drawn.layers[run.faces[0]]].name if drawing.layers else drawing.name
    return name or "drawing"


class _Offsets:
    """Deform keys of slots: where vertices are, relative to the rest pose."""

    def __init__(self, drawing: Drawing) -> None:
        self._drawing = drawing
        self._runs: dict[str, _Run] = {}

    def add_slot(self, name: str, run: _Run) -> None:
        """Note which faces a slot has."""
        self._runs[name] = run

    def timelines(self, names: Sequence[str], keys: Sequence[tuple[float, Floats]]) -> dict[str, Any]:
        """Deform timelines of slots with poses (n, 2) at times in seconds."""
        return {name: {name: {"deform": [self._key(name, *key) for key in keys]}} for name in names}

    def _key(self, name: str, time: float, pose: Floats) -> dict[str, Any]:
        run = self._runs[name]
        shape, order = run.shape, run.part.order
        points = pose if shape.cut is None else shape.cut.values(pose)
        offsets = _flat(y_up(self._drawing, points)[order]) - _flat(shape.rest[order])
        vertices = {"vertices": (np.round(offsets, _DECIMALS) + 0.0).tolist()}
        return {"time": round(time, 4), **vertices} if time else vertices


def _animation(
    baked: BakedAnimation, slots_of_orders: Sequence[Sequence[str]], offsets: _Offsets
) -> dict[str, Any]:
    """The animation of keyframes: deform keys; the slots of an order have attachments while it is shown."""
    switches: dict[str, Any] = {}
    deform: dict[str, Any] = {}
    spans_of: dict[str, list[tuple[float, float]]] = {}
    for names, order in zip(slots_of_orders, baked.orders, strict=True):
        for name in names:
            spans_of.setdefault(name, []).extend(order.spans)
    starts = [max((start for start, _ in order.spans), default=-1.0) for order in baked.orders]
    last = starts.index(max(starts))  # the order at the end
    for name, spans in spans_of.items():
        spans = _joined(spans)
        deform |= offsets.timelines([name], _keys_in_spans(baked, spans))
        if name in slots_of_orders[0] and spans == [(baked.times[0], baked.times[-1])]:
            continue
        keys: list[dict[str, Any]] = [{"name": None}]
        for start, end in spans:
            keys += [{"time": start, "name": name}, {"time": end, "name": None}]
        if name in slots_of_orders[last]:
            keys.pop()  # it stays at the end
        switches[name] = {"attachment": _without_doubles(keys)}
    slots = {"slots": switches} if switches else {}
    return {**slots, "attachments": {"default": deform}}


def _joined(spans: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Spans of time in order, those that meet as one."""
    result: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if result and start <= result[-1][1]:
            result[-1] = result[-1][0], max(end, result[-1][1])
        else:
            result.append((start, end))
    return result


def _without_doubles(keys: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Keys of which each is later than the one before; of several at one time the last one."""
    return list({key.get("time", 0.0): key for key in keys}.values())


def _keys_in_spans(baked: BakedAnimation, spans: Sequence[tuple[float, float]]) -> list[tuple[float, Floats]]:
    """The poses while an order is shown, and those just before and after."""
    times = baked.times
    needed: set[int] = set()
    for start, end in spans:
        first = max(k for k, time in enumerate(times) if time <= start)
        last = min(k for k, time in enumerate(times) if time >= end)
        needed |= set(range(first, last + 1))
    return [(times[k], baked.poses[k]) for k in sorted(needed)] or [(0.0, baked.poses[0])]


def _shared_runs(runs_of_orders: Sequence[Sequence[_Run]]) -> list[tuple[_Run, list[int]]]:
    """The runs of several orders from back to front, each with the numbers of the orders that have it.

    Orders share runs, for example all layers that stay when others are switched, unless these follow one
    another differently.
    """
    stacks: list[dict[Hashable, tuple[_Run, list[int]]]] = []
    for number, runs in enumerate(runs_of_orders):
        own = {run.key: run for run in runs}
        index = next((k for k, stack in enumerate(stacks) if _follow_alike(stack, own)), len(stacks))
        stack = stacks[index] if index < len(stacks) else {}
        left, merged = list(stack), {}
        for key, run in own.items():
            while key in stack and left[0] != key:
                passed = left.pop(0)
                merged[passed] = stack[passed]
            earlier = stack[left.pop(0)][1] if key in stack else []
            merged[key] = (run, [*earlier, number])
        merged |= {key: stack[key] for key in left}
        stacks[index:] = [merged, *stacks[index + 1 :]]
    return [each for stack in stacks for each in stack.values()]


def _follow_alike(first: Collection[Hashable], second: Collection[Hashable]) -> bool:
    """Whether what two sequences have in common follows one another in the same order."""
    return [key for key in first if key in second] == [key for key in second if key in first]


def _layered_runs(drawing: Drawing, shape: _Shape, order: DrawingOrder) -> list[_Run]:
    """`component_runs` of each layer, from back to front; of a drawing without layers those of all."""
    drawn = shape.drawn
    if not drawing.layers:
        runs = component_runs(drawn.components, order.order, order.low, order.high)
        return [_Run(shape, *run) for run in runs]
    result: list[_Run] = []
    layers = drawn.layers
    for layer in order.layer_order:
        faces = order.order[layers[order.order] == layer]
        if not len(faces):
            continue
        new = np.full(len(drawn.faces), -1)
        new[faces] = np.arange(len(faces))
        own = layers[order.low] == layer  # both faces of a pair are on one layer
        low, high = new[order.low[own]], new[order.high[own]]
        local = component_runs(drawn.components[faces], np.arange(len(faces)), low, high)
        result += [_Run(shape, component, faces[members]) for component, members in local]
    return result


class _Part:
    """A component of a mesh, renumbered as Spine requires: the hull (outer contour) first, in order.

    order: (p,) the drawn vertex for each new number; hull: number of vertices of the hull; faces: (q, 3) all
    drawn faces, −1 for vertices of other components; edges: (e, 2) the hull's edges first; both in new
    numbers.
    """

    def __init__(self, mesh: TriMesh, drawn: DrawnFaces, number: int) -> None:
        own = drawn.faces[drawn.components == number]
        vertices = np.unique(own)
        loops = [loop for loop in mesh.boundary_loops if mesh.component[loop[0]] == number]
        hull = max(loops, key=lambda loop: abs(_area(mesh.vertices[loop])))
        self.hull = len(hull)
        self.order = np.concatenate([hull, np.setdiff1d(vertices, hull)])
        new = np.full(len(drawn.rest), -1)
        new[self.order] = np.arange(len(self.order))
        self.faces: Ints = new[drawn.faces]
        ring = np.stack([np.arange(self.hull), np.roll(np.arange(self.hull), -1)], axis=1)
        sides = np.concatenate([own[:, [0, 1]], own[:, [1, 2]], own[:, [2, 0]]])
        inner = np.unique(np.sort(new[sides], axis=1), axis=0)
        known = {tuple(sorted(pair)) for pair in ring.tolist()}
        rest = [pair for pair in inner.tolist() if tuple(pair) not in known]
        self.edges: Ints = np.array([*ring.tolist(), *rest])


def _attachment(drawing: Drawing, run: _Run, texture: str) -> dict[str, Any]:
    """The mesh attachment of some drawn faces of a component."""
    part, shape = run.part, run.shape
    if len(part.order) > MAX_ATTACHMENT_VERTICES:
        raise InputError(
            tr(
                "expected parts of at most {most} vertices for Spine, got {count}; choose a coarser mesh",
                most=MAX_ATTACHMENT_VERTICES,
                count=len(part.order),
            )
        )
    height, width = drawing.image.shape[:2]
    return {
        "type": "mesh",
        "path": texture,
        "uvs": np.round(_flat(shape.drawn.uv[part.order]), 6).tolist(),
        "triangles": part.faces[run.faces].ravel().tolist(),
        "vertices": np.round(_flat(shape.rest[part.order]), _DECIMALS).tolist(),
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
