"""Pairs of faces in which every overlap of a pose begins."""

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints
from .common_area import common_areas
from .topology import Topology

_TOUCHING = 1e-9  # share of the square of a face's size; faces that touch have less in common
_FULL_TURN = 2 * np.pi + 1e-9


def overlap_seeds(topology: Topology, pose: Floats) -> Ints:
    """Pairs of overlapping faces (s, 2) int32, at least one in each connected overlap of a pose (n, 2).

    Without flipped faces, an overlap within a component begins where the rim crosses itself, or at a vertex
    of the rim whose faces wind around it more than once, as in an elbow folded shut. A component can also lie
    wholly inside another one. Faces of different layers do not count: the order of the layers decides there.
    """
    t = topology
    order = np.argsort(pose[t.rim, 0].min(axis=1), kind="stable")
    seeds = _rim_crossings(pose, t.rim, t.rim_faces, t.layers, order)
    wound = np.flatnonzero(_fan_angles(pose, t.faces, t.fans, t.fan_edges, len(t.rim)) > _FULL_TURN)
    if len(wound):  # the first and the last face of each such fan
        ends = np.stack([t.rim_faces[wound], t.rim_faces[t.rim_previous[wound]]], axis=1)
        seeds = np.concatenate([seeds, ends])
    if len(t.loops) > 1 and t.components.any():
        inside = _enclosed_loops(pose, t.faces, t.rim, t.rim_faces, t.components, t.layers, t.loops)
        seeds = np.concatenate([seeds, inside])
    if t.is_cut[0] and len(seeds):  # the lips of a slit touch, and by rounding their edges may cross
        first, second = (np.ascontiguousarray(side) for side in seeds.T)
        corners = pose[t.faces[first]]
        sides = np.abs(corners - np.roll(corners, 1, axis=1)).max(axis=(1, 2))
        common = common_areas(pose, t.faces, first, second)
        seeds = np.ascontiguousarray(seeds[common > _TOUCHING * sides**2])
    return seeds


@compiled
def enlarged(rows: Ints, count: int) -> Ints:
    """Room for ``count`` rows that begins with ``rows`` (r, 2)."""
    result = np.empty((count, 2), dtype=np.int32)
    for i in range(len(rows)):
        result[i, 0], result[i, 1] = rows[i, 0], rows[i, 1]
    return result


@compiled
def _rim_crossings(pose: Floats, rim: Ints, rim_faces: Ints, layers: Ints, order: Ints) -> Ints:
    """Faces of rim edges that cross, (s, 2); order: (r,) the edges by their left ends, which is swept."""
    count = len(rim)
    left, right = np.empty(count), np.empty(count)
    low, high = np.empty(count), np.empty(count)
    for i in range(count):
        p, q = rim[order[i], 0], rim[order[i], 1]
        px, py, qx, qy = pose[p, 0], pose[p, 1], pose[q, 0], pose[q, 1]
        left[i], right[i] = min(px, qx), max(px, qx)
        low[i], high[i] = min(py, qy), max(py, qy)
    found, size = np.empty((64, 2), dtype=np.int32), 0
    for i in range(count):
        for j in range(i + 1, count):
            if left[j] > right[i]:
                break
            if low[j] > high[i] or high[j] < low[i]:
                continue
            e, g = order[i], order[j]
            if layers[rim_faces[e]] != layers[rim_faces[g]]:
                continue
            p, q, r, s = rim[e, 0], rim[e, 1], rim[g, 0], rim[g, 1]
            if r in (p, q) or s in (p, q):
                continue
            px, py, qx, qy = pose[p, 0], pose[p, 1], pose[q, 0], pose[q, 1]
            rx, ry, sx, sy = pose[r, 0], pose[r, 1], pose[s, 0], pose[s, 1]
            a = (qx - px) * (ry - py) - (qy - py) * (rx - px)
            b = (qx - px) * (sy - py) - (qy - py) * (sx - px)
            c = (sx - rx) * (py - ry) - (sy - ry) * (px - rx)
            d = (sx - rx) * (qy - ry) - (sy - ry) * (qx - rx)
            if (a > 0) != (b > 0) and (c > 0) != (d > 0):
                if size == len(found):
                    found = enlarged(found, 2 * size)
                found[size, 0], found[size, 1] = rim_faces[e], rim_faces[g]
                size += 1
    return found[:size]


@compiled
def _fan_angles(pose: Floats, faces: Ints, fans: Ints, fan_edges: Ints, count: int) -> Floats:
    """The sum (count,) of the angles in radians of the faces around the first vertex of each rim edge."""
    angle = np.zeros(count)
    for i in range(len(fans)):
        f, k = fans[i, 0], fans[i, 1]
        o, u, v = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        ux, uy = pose[u, 0] - pose[o, 0], pose[u, 1] - pose[o, 1]
        vx, vy = pose[v, 0] - pose[o, 0], pose[v, 1] - pose[o, 1]
        angle[fan_edges[i]] += np.arctan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)
    return angle


@compiled
def _enclosed_loops(
    pose: Floats, faces: Ints, rim: Ints, rim_faces: Ints, components: Ints, layers: Ints, loops: Ints
) -> Ints:
    """Face of a boundary loop and face of another component around a vertex of that loop, (s, 2)."""
    found, size = np.empty((64, 2), dtype=np.int32), 0
    count = components[0] + 1
    for f in range(len(faces)):
        count = max(count, components[f] + 1)
    box = np.empty((count, 4))
    for c in range(count):
        box[c, 0], box[c, 1], box[c, 2], box[c, 3] = np.inf, np.inf, -np.inf, -np.inf
    for e in range(len(rim)):
        c, x, y = components[rim_faces[e]], pose[rim[e, 0], 0], pose[rim[e, 0], 1]
        box[c, 0], box[c, 1] = min(box[c, 0], x), min(box[c, 1], y)
        box[c, 2], box[c, 3] = max(box[c, 2], x), max(box[c, 3], y)
    for e in loops:
        x, y, own = pose[rim[e, 0], 0], pose[rim[e, 0], 1], components[rim_faces[e]]
        met = False
        for c in range(count):
            if c != own and box[c, 0] <= x <= box[c, 2] and box[c, 1] <= y <= box[c, 3]:
                met = True
        if not met:
            continue
        for f in range(len(faces)):
            if components[f] == own or layers[f] != layers[rim_faces[e]]:
                continue
            ax, bx, cx = pose[faces[f, 0], 0], pose[faces[f, 1], 0], pose[faces[f, 2], 0]
            if (ax < x and bx < x and cx < x) or (ax > x and bx > x and cx > x):
                continue
            ay, by, cy = pose[faces[f, 0], 1], pose[faces[f, 1], 1], pose[faces[f, 2], 1]
            inside = (
                (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0
                and (cx - bx) * (y - by) - (cy - by) * (x - bx) > 0
                and (ax - cx) * (y - cy) - (ay - cy) * (x - cx) > 0
            )
            if inside:
                if size == len(found):
                    found = enlarged(found, 2 * size)
                found[size, 0], found[size, 1] = rim_faces[e], f
                size += 1
    return found[:size]
