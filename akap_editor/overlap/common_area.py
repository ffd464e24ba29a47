"""The area that two overlapping faces have in common."""

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Floats, Ints


@compiled
def common_areas(pose: Floats, faces: Ints, first: Ints, second: Ints) -> Floats:
    """Area (p,) in square pixels that the faces ``first`` and ``second`` (p,) share in a pose (n, 2).

    The first face is clipped by the edges of the second one (Sutherland and Hodgman 1974); faces of negative
    area share nothing.
    """
    areas = np.zeros(len(first))
    shape, clipped = np.empty((16, 2)), np.empty((16, 2))
    for i in range(len(first)):
        f, g = first[i], second[i]
        count = 3
        for k in range(3):
            shape[k, 0], shape[k, 1] = pose[faces[f, k], 0], pose[faces[f, k], 1]
        for k in range(3):
            ux, uy = pose[faces[g, k], 0], pose[faces[g, k], 1]
            vx, vy = pose[faces[g, (k + 1) % 3], 0] - ux, pose[faces[g, (k + 1) % 3], 1] - uy
            size = 0
            for j in range(count):
                ax, ay = shape[j, 0], shape[j, 1]
                bx, by = shape[(j + 1) % count, 0], shape[(j + 1) % count, 1]
                d = vx * (ay - uy) - vy * (ax - ux)
                e = vx * (by - uy) - vy * (bx - ux)
                if d >= 0:
                    clipped[size, 0], clipped[size, 1] = ax, ay
                    size += 1
                if (d > 0 and e < 0) or (d < 0 and e > 0):
                    t = d / (d - e)
                    clipped[size, 0], clipped[size, 1] = ax + t * (bx - ax), ay + t * (by - ay)
                    size += 1
            count = size
            shape, clipped = clipped, shape
        for j in range(1, count - 1):
            ax, ay = shape[j, 0] - shape[0, 0], shape[j, 1] - shape[0, 1]
            bx, by = shape[j + 1, 0] - shape[0, 0], shape[j + 1, 1] - shape[0, 1]
            areas[i] += 0.5 * (ax * by - ay * bx)
        areas[i] = max(areas[i], 0.0)
    return areas
