"""The mirror of a drawing: an axis in the rest pose, and pins that form pairs across it."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError
from ....geometry.validation import MAX_COORDINATE, Floats, as_number, as_points
from ....words import tr
from ..pin import MAX_PINS

Pair = tuple[int, int]  # ids of two pins


@dataclass(frozen=True)
class Mirror:
    """An axis and pairs of pins.

    x, y: a point of the axis, pixels of the rest pose; angle: its direction, radians, 0 along x, π/2 upright;
    is_on: whether what is done to a pin is done to its partner, mirrored; pairs: no pin is in two of them.
    """

    x: float
    y: float
    angle: float
    is_on: bool = True
    pairs: tuple[Pair, ...] = ()

    def vectors(self, vectors: ArrayLike) -> Floats:
        """Mirrored vectors, (k, 2)."""
        cosine, sine = math.cos(2 * self.angle), math.sin(2 * self.angle)
        mirrored: Floats = np.asarray(vectors, dtype=np.float64) @ np.array([[cosine, sine], [sine, -cosine]])
        return mirrored

    def points(self, points: ArrayLike) -> Floats:
        """Mirrored points, (k, 2) pixels of the rest pose."""
        origin = np.array([self.x, self.y])
        return origin + self.vectors(np.asarray(points, dtype=np.float64) - origin)

    def distances(self, points: ArrayLike) -> Floats:
        """Distances of points (k, 2) from the axis, (k,) pixels."""
        normal = np.array([-math.sin(self.angle), math.cos(self.angle)])
        return np.abs((np.asarray(points, dtype=np.float64) - (self.x, self.y)) @ normal)

    def partner(self, pin: int) -> int | None:
        """The other pin of the pair that a pin is in; None if it is in none."""
        for first, second in self.pairs:
            if pin in (first, second):
                return second if pin == first else first
        return None

    def with_pair(self, first: int, second: int) -> "Mirror":
        """This mirror with another pair, and without those in which one of its pins was."""
        others = self.without({first, second})
        return replace(others, pairs=(*others.pairs, (first, second)))

    def without(self, pins: Iterable[int]) -> "Mirror":
        """This mirror without the pairs of these pins."""
        gone = set(pins)
        pairs = tuple(pair for pair in self.pairs if not gone.intersection(pair))
        return self if pairs == self.pairs else replace(self, pairs=pairs)

    def of_pins(self, pins: Iterable[int]) -> "Mirror":
        """This mirror without the pairs of pins that are not among these."""
        return self.without({pin for pair in self.pairs for pin in pair} - set(pins))

    def to_json(self) -> dict[str, Any]:
        """The mirror as an object of a document or recording; docs/file-format.md describes it."""
        axis = {"point": [float(self.x), float(self.y)], "angle": float(self.angle)}
        return {**axis, "on": self.is_on, "pairs": [list(pair) for pair in self.pairs]}

    @classmethod
    def from_json(cls, record: Any, scale: float = 1.0) -> "Mirror":
        """Read what `to_json` wrote. scale: of the picture. Raises InputError on values of other kinds."""
        if not isinstance(record, dict):
            raise InputError(tr("mirror: expected an object"))
        ((x, y),) = (scale * as_points([record.get("point") or ()], "point of the mirror", 1)).tolist()
        if max(abs(x), abs(y)) > MAX_COORDINATE:
            raise InputError(tr("mirror: expected a point within {limit:g} pixels", limit=MAX_COORDINATE))
        angle = as_number(record.get("angle"), "angle of the mirror", -2 * math.pi, 2 * math.pi)
        rows = record.get("pairs", [])
        is_list = isinstance(rows, list) and len(rows) <= MAX_PINS
        if not is_list or any(
            type(row) is not list or len(row) != 2 or any(type(pin) is not int for pin in row) for row in rows
        ):
            raise InputError(tr("mirror: expected pairs of ids of pins"))
        pins = [pin for row in rows for pin in row]
        if len(set(pins)) < len(pins):
            raise InputError(tr("mirror: expected each pin in one pair at most"))
        return cls(x, y, angle, record.get("on") is True, tuple((first, second) for first, second in rows))


def suggest_pairs(mirror: Mirror, places: Mapping[int, ArrayLike], reach: float) -> tuple[Pair, ...]:
    """Pairs of pins that lie across from one another.

    places: of the pins in the rest pose, (2,) each, by id; reach: pixels that a pin may be off its partner's
    mirrored place. Two pins make a pair if each is the nearest one to the mirrored place of the other.
    """
    ids = list(places)
    if len(ids) < 2:
        return ()
    points = np.array([places[pin] for pin in ids], dtype=np.float64)
    distances = np.linalg.norm(mirror.points(points)[:, None] - points[None], axis=2)
    nearest = distances.argmin(axis=1)
    return tuple(
        (ids[first], ids[second])
        for first, second in enumerate(nearest.tolist())
        if first < second and nearest[second] == first and distances[first, second] <= reach
    )
