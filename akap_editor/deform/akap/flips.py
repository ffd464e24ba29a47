"""Whether faces flip in a pose: their signed areas are no longer positive."""

from ...geometry.jit import compiled
from ...geometry.validation import Complexes, Floats, Indices


@compiled
def is_acceptable(
    before: Complexes, after: Complexes, max_displacement: float, faces: Indices, min_areas: Floats
) -> bool:
    """Whether no vertex moves farther than ``max_displacement``, and no face shrinks too much.

    A face must not shrink below its minimum area (m,) or, if that is smaller, 0.9 times its area before.
    Faces that are flipped before do not count.
    """
    for i in range(len(before)):
        d = after[i] - before[i]
        if not d.real * d.real + d.imag * d.imag <= max_displacement * max_displacement:  # NaN, too
            return False
    for f in range(len(faces)):
        area_before, area_after = _area(before, faces[f]), _area(after, faces[f])
        if area_before > 0 and not area_after > min(min_areas[f], 0.9 * area_before):
            return False
    return True


@compiled
def count_flipped(pose: Complexes, faces: Indices) -> int:
    """The number of faces with an area that is not positive."""
    count = 0
    for f in range(len(faces)):
        if not _area(pose, faces[f]) > 0:
            count += 1
    return count


@compiled
def _area(pose: Complexes, corners: Indices) -> float:
    """The signed area of a face."""
    p = pose[corners[0]]
    a, b = pose[corners[1]] - p, pose[corners[2]] - p
    return 0.5 * (a.real * b.imag - a.imag * b.real)
