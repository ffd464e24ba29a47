"""A document's keyframes as poses between which other programs interpolate linearly."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...editor.animation.loose_motion import AnimationFrames
from ...editor.document.crossings import depth_order, overlaps_of
from ...editor.document.document import Document
from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...layers.drawing_layer import stacked_faces
from ...overlap.circles import face_levels
from ...overlap.overlaps import Overlaps
from ...overlap.seams import CutMesh, cut_for_motion

TOLERANCE = 0.25  # pixels by which a pose may be off between two that are kept
_RATE = 30.0  # samples a second
_MOST_NUMBERS = 2e7  # vertices of all samples, so that long animations of fine meshes fit into the memory
_LONGEST_GAP = 15  # samples
_INSTANT = 0.001  # seconds before a keyframe, at which a pose that is held still is as it was


@dataclass
class DrawingOrder:
    """An order in which faces are drawn, and when.

    order: (q,) the faces from back to front, without those of hidden layers; low, high: (p,) pairs of faces
    that it keeps in order; layer_order: the layers from back to front; cut: the mesh cut along seams, of
    whose faces order and pairs speak, None for those of the mesh itself; spans: from when until when it is
    shown, in seconds.
    """

    order: Ints
    low: Ints
    high: Ints
    layer_order: tuple[int, ...] = ()
    cut: CutMesh | None = None
    spans: list[tuple[float, float]] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class BakedAnimation:
    """Poses (n, 2) each at times in seconds, the first at 0, and the orders in which they are drawn.

    The first order is that of the document's present pose, and may be shown at no time.
    """

    times: list[float]
    poses: list[Floats]
    orders: list[DrawingOrder]


def bake_animation(document: Document) -> BakedAnimation | None:
    """The keyframes of a document; None if there are fewer than two.

    Poses are kept where straight lines between the others would be off by more than `TOLERANCE`, and at each
    keyframe. One order serves as long as its pairs are in no circle and the same layers are shown. Where
    it has seams, faces are cut along those of its first keyframe that has some.
    """
    mesh, animation = document.drawing.mesh, document.state.animation
    if len(animation.keyframes) < 2:
        return None
    collected = _Orders(document)
    times = _sample_times(document)
    frames = AnimationFrames(document)
    poses, numbers = [], []
    for time in times:
        drawing, crossed = frames.crossed(time)
        overlaps = overlaps_of(mesh, *crossed)
        numbers.append(collected.number_for(drawing, overlaps, is_keyframe=time in animation.times))
        poses.append(crossed.positions)
    orders = collected.orders()
    starts = [k for k, number in enumerate(numbers) if k == 0 or number != numbers[k - 1]]
    for k, after in zip(starts, [*starts[1:], len(times) - 1], strict=True):
        orders[numbers[k]].spans.append((times[k], times[after]))
    kept = _needed_samples(times, poses, set(animation.times))
    return BakedAnimation([times[k] for k in kept], [poses[k] for k in kept], orders)


def _sample_times(document: Document) -> list[float]:
    animation = document.state.animation
    most = _MOST_NUMBERS / len(document.drawing.mesh.vertices)
    count = max(2, int(min(_RATE * animation.duration, most)))
    times = {0.0, *np.linspace(0, animation.duration, count + 1).round(4).tolist(), *animation.times}
    for start, end in zip(animation.keyframes, animation.keyframes[1:], strict=False):
        if animation.easing_after(start) == "hold" or start.layers != end.layers:
            times.add(max(start.time, end.time - _INSTANT))
    return sorted(times)


def _needed_samples(times: Sequence[float], poses: Sequence[Floats], fixed: set[float]) -> list[int]:
    """The samples to keep, so that straight lines between them come near all others."""
    kept = [0]
    while kept[-1] < len(times) - 1:
        start = end = kept[-1]
        while end + 1 < len(times) and end - start < _LONGEST_GAP:
            if end > start and (times[end] in fixed or not _is_straight(times, poses, start, end + 1)):
                break
            end += 1
        kept.append(end)
    return kept


def _is_straight(times: Sequence[float], poses: Sequence[Floats], start: int, end: int) -> bool:
    span = times[end] - times[start]
    for k in range(start + 1, end):
        share = (times[k] - times[start]) / span
        if np.abs((1 - share) * poses[start] + share * poses[end] - poses[k]).max() > TOLERANCE:
            return False
    return True


class _Orders:
    """Finds few orders that keep all pairs of all samples."""

    def __init__(self, document: Document) -> None:
        mesh, state = document.drawing.mesh, document.state
        self._count = len(mesh.faces)
        depths = depth_order(mesh, state.pins)
        self._rank = np.arange(self._count)
        if depths is not None:
            self._rank[depths] = np.arange(self._count)
        overlaps = overlaps_of(mesh, state.pins, state.positions, state.crossings)
        self._pairs = [_ascending(self._codes(*overlaps.low_and_high))]  # of each order
        self._drawings = [document.drawing]  # with the layers that each order shows
        self._seams = [(True, overlaps)]  # where each order is cut, and whether that is a keyframe

    def number_for(self, drawing: Drawing, overlaps: Overlaps, is_keyframe: bool) -> int:
        """The number of an order for a pose: the last one that can keep its decisions, too, else another one.

        Faces are cut along the seams of a keyframe if there is one with seams. drawing: with the layers that
        are to be visible.
        """
        codes = _ascending(self._codes(*overlaps.low_and_high))
        for number in reversed(range(len(self._pairs))):
            if self._drawings[number].layer_view != drawing.layer_view:
                continue
            seams = self._seams[number]
            joint = _ascending(np.concatenate([self._pairs[number], codes]))
            if overlaps.has_seam and (not seams[1].has_seam or (is_keyframe and not seams[0])):
                seams = is_keyframe, overlaps
            is_same = len(joint) == len(self._pairs[number]) and seams is self._seams[number]
            if is_same or self._is_possible(joint, seams[1]):
                self._pairs[number], self._seams[number] = joint, seams
                return number
        self._pairs.append(codes)
        self._drawings.append(drawing)
        self._seams.append((is_keyframe, overlaps))
        return len(self._pairs) - 1

    def orders(self) -> list[DrawingOrder]:
        """All orders."""
        result = []
        for codes, drawing, (_, overlaps) in zip(self._pairs, self._drawings, self._seams, strict=True):
            low, high = self._low_and_high(codes)
            levels, _ = face_levels(self._count, low, high)
            order: Ints = np.lexsort((self._rank, levels))
            cut, face_layers = None, drawing.face_layers
            found = self._cut(overlaps, order, low, high)
            if found is not None:
                cut, low, high = found
                order = np.arange(len(cut.faces))
                face_layers = face_layers[cut.sources] if drawing.layers else face_layers
            if drawing.layers:
                stacked = stacked_faces(order, face_layers, drawing.layers, drawing.layer_order)
                order = order if stacked is None else stacked
            result.append(DrawingOrder(order, low, high, drawing.layer_order, cut))
        return result

    def _codes(self, low: Ints, high: Ints) -> Ints:
        return low.astype(np.int64) * self._count + high

    def _low_and_high(self, codes: Ints) -> tuple[Ints, Ints]:
        return (codes // self._count).astype(np.int32), (codes % self._count).astype(np.int32)

    def _cut(
        self, overlaps: Overlaps, order: Ints, low: Ints, high: Ints
    ) -> tuple[CutMesh, Ints, Ints] | None:
        mesh = self._drawings[0].mesh
        return cut_for_motion(mesh, overlaps, order, low, high) if overlaps.has_seam else None

    def _is_possible(self, codes: Ints, seams: Overlaps) -> bool:
        """Whether pairs are in no circle, with faces cut along the seams of a pose, too."""
        low, high = self._low_and_high(codes)
        _, placed = face_levels(self._count, low, high)
        if not placed.all():
            return False
        return not seams.has_seam or self._cut(seams, np.arange(self._count), low, high) is not None


def _ascending(codes: Ints) -> Ints:
    """Each code once, in order; `np.unique` collects them in a table of hashes, which takes much longer."""
    codes = np.sort(codes)
    return codes[np.diff(codes, prepend=-1) > 0]
