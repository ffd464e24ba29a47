"""Composition of layers into one picture.

The blending follows W3C's Compositing and Blending Level 1: with premultiplied colors c and opacities a, of
the source s over the backdrop b, c = (1 - a_s) c_b + (1 - a_b) c_s + B, where B = a_s a_b blend(c_b / a_b,
c_s / a_s), and a = a_s + a_b - a_s a_b. What clips keeps the opacity of its base: c = (1 - a_s) c_b + B.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..progress import announce
from ..words import tr
from .layered_picture import PASS_THROUGH, Layer, LayeredPicture, LayerGroup, trimmed

Samples = NDArray[np.float32]  # (h, w, 4) premultiplied, 0 to 1
Box = tuple[int, int, int, int]  # left, top, right, bottom on the canvas

STRIP_PIXELS = 2**16  # composed at once, which the processor's cache holds


@dataclass
class Node:
    """A layer, or a group with its children, and what is clipped to it; both from the bottom to the top."""

    content: Layer | LayerGroup
    children: list["Node"] = field(default_factory=list)
    clipped: list["Node"] = field(default_factory=list)

    @cached_property
    def box(self) -> Box:
        """The part of the canvas outside of which it is transparent."""
        if isinstance(self.content, Layer):
            return self.content.box
        lefts, tops, rights, bottoms = zip(*(child.box for child in self.children), strict=True)
        return min(lefts), min(tops), max(rights), max(bottoms)


def composite(layered: LayeredPicture) -> NDArray[np.uint8]:
    """The picture that all visible layers show together, (height, width, 4) uint8, straight alpha.

    Colors are mixed in sRGB, as drawing programs do unless they are told otherwise.
    """
    nodes = arrange(layered.layers)
    width, height = layered.size
    result = np.empty((height, width, 4), np.uint8)
    rows = max(1, STRIP_PIXELS // width)
    for top in range(0, height, rows):
        announce(top / height, tr("Merging the layers"))
        bottom = min(top + rows, height)
        strip = np.zeros((bottom - top, width, 4), np.float32)
        _draw(nodes, strip, (0, top, width, bottom))
        result[top:bottom] = _straight(strip)
    return result


def node_picture(node: Node) -> tuple[NDArray[np.uint8], tuple[int, int]] | None:
    """The picture (h, w, 4) uint8 of a node with what is clipped to it, and its offset on the canvas.

    The node's own opacity, blending and visibility do not count. None if all of it is transparent.
    """
    left, top, *_ = node.box
    samples = _source(node, node.box)
    for above in node.clipped:
        _clip(above, samples, node.box)
    return trimmed(_straight(samples), (left, top))


def hidden_layers(layered: LayeredPicture) -> list[Layer]:
    """The layers that `composite` does not draw, from the bottom to the top.

    They or their groups are not visible, or they clip to what is not.
    """
    shown: set[int] = set()

    def walk(nodes: list[Node]) -> None:
        for node in nodes:
            if node.content.visible:
                shown.add(id(node.content))
                walk(node.children)
                walk(node.clipped)

    walk(arrange(layered.layers))
    return [layer for layer in layered.layers if id(layer) not in shown]


def arrange(layers: Sequence[Layer]) -> list[Node]:
    """The tree of groups and layers."""
    root: list[Node] = []
    open_groups: list[Node] = []
    for layer in layers:
        kept = 0
        for node, group in zip(open_groups, layer.groups, strict=False):
            if node.content is not group:
                break
            kept += 1
        del open_groups[kept:]
        for group in layer.groups[kept:]:
            node = Node(group)
            _append(open_groups[-1].children if open_groups else root, node)
            open_groups.append(node)
        _append(open_groups[-1].children if open_groups else root, Node(layer))
    return root


def _append(siblings: list[Node], node: Node) -> None:
    """Add a node on top of its siblings, or to what is clipped to the topmost."""
    if node.content.clipping and siblings:
        siblings[-1].clipped.append(node)
    else:
        siblings.append(node)


def _draw(nodes: list[Node], backdrop: Samples, box: Box) -> None:
    """Draw the nodes on a part of the canvas, ``box``, whose samples are ``backdrop``."""
    for node in nodes:
        content = node.content
        inner = _common_box(node.box, box)
        if not content.visible or content.opacity == 0 or inner is None:
            continue
        part = _view(backdrop, box, inner)
        if isinstance(content, LayerGroup) and content.blend == PASS_THROUGH and not node.clipped:
            before = part.copy() if content.opacity < 1 else None
            _draw(node.children, part, inner)
            if before is not None:
                part *= content.opacity
                before *= 1 - content.opacity
                part += before
            continue
        source = _source(node, inner)
        for above in node.clipped:
            _clip(above, source, inner)
        if content.opacity < 1:
            source *= content.opacity
        _blend(source, part, content.blend)


def _source(node: Node, box: Box) -> Samples:
    """The samples of a node alone, without its own opacity and without what is clipped to it."""
    left, top, right, bottom = box
    if isinstance(node.content, LayerGroup):
        samples = np.zeros((bottom - top, right - left, 4), np.float32)
        _draw(node.children, samples, box)
        return samples
    x, y = node.content.offset
    samples = node.content.picture[top - y : bottom - y, left - x : right - x].astype(np.float32)
    samples *= 1 / 255
    samples[..., :3] *= samples[..., 3:]
    return samples


def _clip(node: Node, base: Samples, box: Box) -> None:
    """Draw a node on ``base`` without changing its opacity."""
    content, inner = node.content, _common_box(node.box, box)
    if not content.visible or inner is None:
        return
    source = _source(node, inner)
    source *= content.opacity
    part = _view(base, box, inner)
    colors = part[..., :3]
    mixed = _mixed(source, part, content.blend)
    colors *= 1 - source[..., 3:]
    colors += mixed


def _blend(source: Samples, backdrop: Samples, mode: str) -> None:
    """Draw ``source`` on ``backdrop``."""
    rest = 1 - source[..., 3:]
    if mode in ("normal", PASS_THROUGH):
        backdrop *= rest
        backdrop += source
        return
    mixed = _mixed(source, backdrop, mode)
    mixed += source[..., :3] * (1 - backdrop[..., 3:])
    backdrop *= rest
    backdrop[..., :3] += mixed
    backdrop[..., 3] += source[..., 3]


def _mixed(source: Samples, backdrop: Samples, mode: str) -> Samples:
    """B of the formula, (h, w, 3)."""
    s, b = source[..., :3], backdrop[..., :3]
    source_opacity, backdrop_opacity = source[..., 3:], backdrop[..., 3:]
    if mode == "multiply":
        return s * b
    if mode == "screen":
        return s * backdrop_opacity + b * source_opacity - s * b
    if mode == "add":
        total = s * backdrop_opacity + b * source_opacity
        return np.minimum(total, source_opacity * backdrop_opacity, out=total)
    return s * backdrop_opacity


def _straight(samples: Samples) -> NDArray[np.uint8]:
    """Samples as a picture (h, w, 4) uint8, straight alpha; where it is transparent, all values are 0."""
    opacity = samples[..., 3:]
    samples[..., :3] /= np.maximum(opacity, np.float32(1e-6))
    samples *= 255
    samples += 0.5
    np.clip(samples, 0, 255, out=samples)
    return samples.astype(np.uint8) * (samples[..., 3:] >= 1)


def _common_box(a: Box, b: Box) -> Box | None:
    """The part that two boxes have in common, None if there is none."""
    left, top, right, bottom = max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3])
    return (left, top, right, bottom) if left < right and top < bottom else None


def _view(samples: Samples, box: Box, inner: Box) -> Samples:
    """The part ``inner`` of the samples of ``box``."""
    x, y = box[:2]
    return samples[inner[1] - y : inner[3] - y, inner[0] - x : inner[2] - x]
