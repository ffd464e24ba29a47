"""Proposes joints for a drawing in layers, by overlap, groups and names.

Layers form a tree: the next one is always that with the strongest link to a layer in the tree (Prim 1957). A
link is the overlap as a share of the smaller layer, times how well groups and names go together. What lies
almost wholly on a larger layer behind it rides there without a joint, unless it is named like a limb.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....geometry.validation import Floats
from ....layers.drawing_layer import DrawingLayer, shown_layers
from ..drawing import Drawing
from .joint import Joint, make_joint

_RASTER = 500  # pixels of the longer side at which overlaps are measured
_REACH = 6  # pixels of the canvas within which layers touch
_INSIDE = 0.85  # share of a layer on another one from which on it rides on it
_TOUCH_SHARE = 0.05  # what touching counts, as a share of overlapping
LIMB_WORDS = frozenset(
    ["arm", "leg", "hand", "foot", "tail", "wing", "ear", "hair", "antenna", "paw", "thigh", "shin", "finger"]
)
BODY_WORDS = frozenset(["body", "torso", "trunk", "hips", "pelvis", "belly", "chest"])
HEAD_WORDS = frozenset(["head", "skull", "face"])
FACE_WORDS = frozenset(
    [
        "hair",
        "fringe",
        "hat",
        "eye",
        "eyes",
        "brow",
        "brows",
        "mouth",
        "nose",
        "beard",
        "pupil",
        "pupils",
        "blush",
        "cheek",
        "glasses",
        "cap",
        "helmet",
        "bow",
        "moustache",
        "lips",
        "teeth",
        "tongue",
    ]
)
CLOTHES_WORDS = frozenset(
    [
        "coat",
        "skirt",
        "shirt",
        "dress",
        "jacket",
        "trousers",
        "pants",
        "scarf",
        "cape",
        "cloak",
        "belt",
        "vest",
        "sweater",
        "apron",
        "robe",
        "collar",
        "tie",
        "bag",
        "backpack",
    ]
)
SIDE_WORDS = frozenset(
    [
        "left",
        "right",
        "l",
        "r",
        "near",
        "far",
        "front",
        "fore",
        "back",
        "hind",
        "rear",
    ]
)


@dataclass(frozen=True, eq=False)
class _Covers:
    """Coarse pictures of the layers: covers: (l, h, w) bool on the canvas; step: pixels per sample."""

    covers: NDArray[np.bool_]
    step: int


def suggest_joints(drawing: Drawing) -> tuple[Joint, ...]:
    """Proposed joints of a drawing in layers at rest; () without layers. Hidden layers get none."""
    if len(drawing.layers) < 2:
        return ()
    raster = _covers(drawing)
    numbers = [n for n in drawing.layer_order if shown_layers(drawing.layers)[n] and raster.covers[n].any()]
    tree = _tree(drawing, raster, numbers)
    joints: list[Joint] = []
    for limb, carrier in tree:
        place = _joint_place(raster, limb, carrier)
        joints.append(make_joint(drawing.mesh, len(joints) + 1, limb, carrier, place, is_proposed=True))
    return tuple(joints)


def _covers(drawing: Drawing) -> _Covers:
    width, height = drawing.size
    step = max(1, round(max(width, height) / _RASTER))
    covers = np.zeros((len(drawing.layers), height // step + 1, width // step + 1), dtype=bool)
    for number, layer in enumerate(drawing.layers):
        rows, columns = np.nonzero(layer.artwork.picture[::step, ::step, 3] > 127)
        x, y = layer.artwork.offset
        rows, columns = rows + y // step, columns + x // step
        inside = (rows >= 0) & (columns >= 0) & (rows < covers.shape[1]) & (columns < covers.shape[2])
        covers[number, rows[inside], columns[inside]] = True
    return _Covers(covers, step)


def _words(layer: DrawingLayer) -> set[str]:
    return set(layer.name.lower().replace("_", " ").replace("-", " ").split())


def _are_siblings(words: set[str], others: set[str]) -> bool:
    """Whether two names are those of limbs of one kind on different sides: a left leg and a right leg."""
    return bool(words & others & LIMB_WORDS) and words & SIDE_WORDS != others & SIDE_WORDS


def _tree(drawing: Drawing, raster: _Covers, numbers: list[int]) -> list[tuple[int, int]]:
    """Limbs with the layers that they hang on."""
    from scipy.ndimage import binary_dilation

    layers, covers = drawing.layers, raster.covers
    reach = max(1, round(_REACH / raster.step))
    flat = {n: covers[n].ravel().astype(np.float32) for n in numbers}
    near = {n: binary_dilation(covers[n], iterations=reach).ravel().astype(np.float32) for n in numbers}
    area = {n: float(flat[n].sum()) for n in numbers}
    overlap = {(a, b): float(flat[a] @ flat[b]) for a in numbers for b in numbers}
    touch = {(a, b): float(near[a] @ flat[b]) for a in numbers for b in numbers}
    words = {n: _words(layers[n]) for n in numbers}
    place = {n: index for index, n in enumerate(numbers)}

    def rides_on(n: int) -> int | None:
        if words[n] & LIMB_WORDS:
            return None
        below = [
            q
            for q in numbers[: place[n]]
            if area[q] > area[n] and overlap[n, q] > _INSIDE * area[n] and not words[q] & CLOTHES_WORDS
        ]
        return below[-1] if below else None

    def strength(limb: int, carrier: int) -> float:
        common = overlap[limb, carrier] or _TOUCH_SHARE * touch[limb, carrier]
        if not common:
            return 0.0
        groups = layers[limb].groups, layers[carrier].groups
        shared = sum(a == b for a, b in zip(*groups, strict=False))
        affinity = 1.0 + shared - 0.5 * (max(map(len, groups)) - shared)
        if words[limb] & FACE_WORDS or words[carrier] & FACE_WORDS:
            fits = words[limb] & FACE_WORDS and words[carrier] & HEAD_WORDS
            affinity *= 4.0 if fits else 0.25
        if _are_siblings(words[limb], words[carrier]):
            affinity *= 0.1
        if words[carrier] & CLOTHES_WORDS:  # limbs come out of clothes, but hang on what wears them
            affinity *= 0.1
        larger = 1.5 if area[carrier] > area[limb] else 1.0
        return common / min(area[limb], area[carrier]) * max(affinity, 0.1) * larger

    held = {n for n in numbers if rides_on(n) is not None}
    free = [n for n in numbers if n not in held]

    def centrality(n: int) -> float:
        links = sum(touch[n, q] > 0 for q in numbers if q != n)
        body = 3.0 * bool(words[n] & BODY_WORDS) - 3.0 * bool(words[n] & CLOTHES_WORDS)
        return links + body + area[n] / sum(area.values())

    tree: list[tuple[int, int]] = []
    inside = {max(free, key=centrality)} if free else set()
    while len(inside) < len(free):
        best = max((strength(n, q), -n, n, q) for n in free if n not in inside for q in inside)
        if best[0] <= 0:  # it touches nothing
            inside.add(best[2])
            continue
        tree.append((best[2], best[3]))
        inside.add(best[2])
    return tree


def _joint_place(raster: _Covers, limb: int, carrier: int) -> Floats:
    """Where a joint goes, (2,) pixels: deep in the largest overlap, towards the limb's end if it is long."""
    from scipy.ndimage import binary_dilation, distance_transform_edt, label

    own, other = raster.covers[limb], raster.covers[carrier]
    both = own & other
    if not both.any():
        reach = max(1, round(_REACH / raster.step))
        both = binary_dilation(own, iterations=reach) & binary_dilation(other, iterations=reach)
    marks, count = label(both)
    if count > 1:
        both = marks == np.bincount(marks.ravel())[1:].argmax() + 1
    depth = distance_transform_edt(both)
    y, x = np.nonzero(both)
    center = np.array([x.mean(), y.mean()])
    rest_y, rest_x = np.nonzero(own & ~both)
    rest = np.array([rest_x.mean(), rest_y.mean()]) if len(rest_x) else center
    away = center - rest
    away /= np.hypot(*away) or 1.0
    along = (x - center[0]) * away[0] + (y - center[1]) * away[1]
    length = np.sqrt(np.linalg.eigvalsh(np.cov(x, y)).max()) / depth.max() if len(x) > 2 else 0.0
    if length > 0.9:
        across = np.hypot(x - center[0], y - center[1])  # decides only where the others are equal
        score = np.minimum(depth[y, x], 0.75 * depth.max()) + 0.05 * along - 0.01 * across
    else:
        score = depth[y, x] - 0.05 * np.hypot(x - center[0], y - center[1])
    best = int(score.argmax())
    return (np.array([x[best], y[best]], dtype=np.float64) + 0.5) * raster.step
