"""Applies clips to drawings: angles and relative lengths along the tree of the pins become targets."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ....errors import InputError
from ....geometry.operators import to_complex, to_points
from ....geometry.validation import Complexes, Floats
from ....words import tr
from ...document.document import Document, EditState
from ...document.drawing import Drawing
from ...document.keyframes import NO_ANIMATION, Keyframe
from ...document.pin import Pin, pin_points
from ...session.edits import SetTargets
from ...session.session import Session
from .clip import Clip, named_pins

_MAX_STEPS = 300  # to the pose of a key
_SAME = 1e-6  # share of √area: targets that differ by less are the same


def clip_targets(clip: Clip, drawing: Drawing, state: EditState) -> list[dict[int, tuple[float, float]]]:
    """The target of each pin by its id, pixels, for each key of a clip.

    Between a pin and the one on which it hangs, the clip has rotated and stretched the vector between them at
    rest; the same happens to that of the drawing. The root moves by the same share of the tree's length.
    Pins that the drawing lacks are skipped, and those that the clip lacks move along with the root.
    Raises InputError if they have no pin in common.
    """
    pins = named_pins(state.pins)
    used = [number for number, name in enumerate(clip.names) if name in pins]
    if not used:
        raise InputError(
            tr(
                "The clip “{clip}” moves pins with the names {names}; no pin of the drawing has one of them",
                clip=clip.name,
                names=", ".join(clip.names),
            )
        )
    order, parents = _contracted(clip, used)
    mesh = drawing.mesh
    chosen = [pins[clip.names[number]] for number in order]
    rest = to_complex(mesh.evaluate(pin_points(chosen), mesh.vertices))
    clip_rest = to_complex(clip.rest)[order]
    alone = len(order) == 1
    scale = _lone_scale(clip, drawing) if alone else _size(rest, parents) / _size(clip_rest, parents)
    others = [pin for pin in state.pins if pin not in chosen]
    at_rest = mesh.evaluate(pin_points(others), state.positions) if others else np.empty((0, 2))
    result = []
    for key in clip.keys:
        placed = _placed(to_complex(key.positions)[order], clip_rest, rest, parents, scale)
        shift = placed[0] - rest[0]
        moved = to_points(to_complex(at_rest) + shift)
        result.append({**_by_id(chosen, to_points(placed)), **_by_id(others, moved)})
    return result


def apply_clip(
    clip: Clip, document: Document, start: float, speed: float = 1.0, repeats: int = 1
) -> Iterator[float | list[Keyframe]]:
    """Solve the poses of a clip's keys on a drawing; yields the share done, and at last the keyframes.

    start: time of the first one, seconds; speed: 2 is twice as fast; repeats: how often the clip plays.
    Raises InputError if pins or times do not fit, SolverError.
    """
    drawing, state = document.drawing, document.state
    all_targets = clip_targets(clip, drawing, state)
    session = Session(Document(drawing, replace(state, animation=NO_ANIMATION, poses=(), drawing=None)))
    poses: list[EditState] = []
    limit = _SAME * drawing.mesh.length
    for number, targets in enumerate(all_targets):
        yield number / len(all_targets)
        if number and number == len(all_targets) - 1 and _are_same(targets, all_targets[0], limit):
            poses.append(poses[0])  # it ends as it begins, to the last bit
            continue
        session.apply(SetTargets(targets))
        for _ in range(_MAX_STEPS):
            if not session.is_moving:
                break
            session.step()
            yield number / len(all_targets)
        poses.append(session.state)
    yield _keyframes(clip, poses, start, speed, repeats)


def _keyframes(
    clip: Clip, poses: Sequence[EditState], start: float, speed: float, repeats: int
) -> list[Keyframe]:
    """The keyframes of a clip; where it starts over, its last key is also its first."""
    keyframes: list[Keyframe] = []
    flows = len(poses) > 1 and poses[-1] is poses[0]
    for turn in range(repeats):
        begin = start + turn * clip.duration / speed
        for number, (key, pose) in enumerate(zip(clip.keys, poses, strict=True)):
            if turn and number == 0 and (flows or clip.duration == 0):
                keyframes[-1] = replace(keyframes[-1], ease=key.ease)
                continue
            gap = 0.001 * bool(turn and number == 0)  # to a first key that differs from the last one
            time = begin + key.time / speed + gap
            keyframes.append(Keyframe(time, pose.positions, key.ease, pose.crossings))
    if any(first.time >= second.time for first, second in pairwise(keyframes)):
        raise InputError(tr("speed: expected keys that stay a millisecond apart, got {speed:g}", speed=speed))
    return keyframes


def _contracted(clip: Clip, used: Sequence[int]) -> tuple[list[int], list[int]]:
    """The used pins of a clip, parents first, and for each the place of its parent in that list, or −1.

    A pin whose parent is not used hangs on the nearest ancestor that is. If the root is not used, the first
    pin takes its place.
    """
    numbers = {name: number for number, name in enumerate(clip.names)}
    parents = [None if pin.parent is None else numbers[pin.parent] for pin in clip.pins]

    depths: dict[int, int] = {}
    while len(depths) < len(parents):
        for number, above in enumerate(parents):
            if above is None or above in depths:
                depths[number] = 0 if above is None else depths[above] + 1
    order = sorted(used, key=lambda number: (depths[number], number))
    places = {number: place for place, number in enumerate(order)}
    result = []
    for place, number in enumerate(order):
        above = parents[number]
        while above is not None and above not in places:
            above = parents[above]
        result.append((0 if place else -1) if above is None else places[above])
    return order, result


def _size(positions: Complexes, parents: Sequence[int]) -> float:
    """The length of the tree."""
    lengths = [abs(positions[k] - positions[parent]) for k, parent in enumerate(parents) if parent >= 0]
    return max(float(sum(lengths)), 1e-9)


def _lone_scale(clip: Clip, drawing: Drawing) -> float:
    """Pixels per unit of a clip of which the drawing has one pin only: by the sizes of both."""
    size = float(np.ptp(clip.rest, axis=0).max())
    return drawing.mesh.length / size if size > 0 else 1.0


def _placed(
    key: Complexes, clip_rest: Complexes, rest: Complexes, parents: Sequence[int], scale: float
) -> Complexes:
    """Where the pins of a drawing are in a key of the clip."""
    placed = np.empty_like(rest)
    for number, parent in enumerate(parents):
        if parent < 0:
            placed[number] = rest[number] + scale * (key[number] - clip_rest[number])
            continue
        before, after = clip_rest[number] - clip_rest[parent], key[number] - key[parent]
        change = after / before if abs(before) > 1e-9 else 1.0
        placed[number] = placed[parent] + change * (rest[number] - rest[parent])
    return placed


def _by_id(pins: Sequence[Pin], points: Floats) -> dict[int, tuple[float, float]]:
    return {pin.id: (float(x), float(y)) for pin, (x, y) in zip(pins, points.tolist(), strict=True)}


def _are_same(
    first: dict[int, tuple[float, float]], second: dict[int, tuple[float, float]], limit: float
) -> bool:
    return bool(np.abs(np.array([*first.values()]) - np.array([*second.values()])).max() <= limit)
