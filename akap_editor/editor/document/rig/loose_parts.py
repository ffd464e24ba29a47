"""Loose parts: ears, tails and hair that lag behind the pose, overshoot and settle."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....deform.follow_through import (
    DEFAULT_BOUNCE,
    DEFAULT_SPEED,
    MAX_BOUNCE,
    MAX_SPEED,
    MIN_SPEED,
)
from ....errors import InputError
from ....geometry.validation import Floats, Ints, as_number
from ....words import tr

_LEAST_COVERAGE = 0.5  # of a face by a stroke that paints it


@dataclass(frozen=True, eq=False)
class LooseParts:
    """Which faces are loose, (m,) bool, and how they swing.

    speed: swings a second; bounce: what is left of a swing after half a period, see `FollowThrough`. Raises
    InputError on values out of range.
    """

    faces: NDArray[np.bool_]
    speed: float = DEFAULT_SPEED
    bounce: float = DEFAULT_BOUNCE

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", as_number(self.speed, "speed", MIN_SPEED, MAX_SPEED))
        object.__setattr__(self, "bounce", as_number(self.bounce, "bounce", 0.0, MAX_BOUNCE))
        faces = np.array(self.faces, dtype=bool)
        faces.flags.writeable = False
        object.__setattr__(self, "faces", faces)

    def on_faces(self, sources: Ints) -> "LooseParts | None":
        """The loose parts of another mesh whose faces are at those of this one, (q,); None without any."""
        faces = self.faces[sources]
        return replace(self, faces=faces) if faces.any() else None


def make_loose_parts(indices: ArrayLike, faces: int, speed: float, bounce: float) -> LooseParts | None:
    """The loose parts with the faces ``indices`` of a mesh with ``faces`` faces; None without any.

    Raises InputError on indices or numbers out of range.
    """
    numbers = np.asarray(indices)
    is_valid = numbers.ndim == 1 and (not len(numbers) or numbers.dtype.kind in "iu")
    if not is_valid or (len(numbers) and not 0 <= numbers.min() <= numbers.max() < faces):
        raise InputError(tr("loose: expected indices of faces below {faces}", faces=faces))
    loose = np.zeros(faces, dtype=bool)
    loose[numbers.astype(np.int64)] = True
    parts = LooseParts(loose, speed, bounce)
    return parts if loose.any() else None


def painted_loose(parts: LooseParts | None, coverage: Floats, erases: bool) -> LooseParts | None:
    """The loose parts after a stroke that covers faces by ``coverage`` (m,); None without any."""
    before = np.zeros(len(coverage), dtype=bool) if parts is None else parts.faces
    covered = coverage >= _LEAST_COVERAGE
    faces = before & ~covered if erases else before | covered
    if not faces.any():
        return None
    if parts is not None and np.array_equal(faces, before):
        return parts
    return LooseParts(faces) if parts is None else replace(parts, faces=faces)
