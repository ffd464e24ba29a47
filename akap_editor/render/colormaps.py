"""Perceptually uniform color scales, computed in OKLab (Ottosson 2020)."""

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.validation import Floats

_STEPS = 64

# From OKLab to the cube roots of cone responses, and from those to linear sRGB (Ottosson 2020).
_TO_ROOTS = np.array(
    [
        [1.0, 0.3963377774, 0.2158037573],
        [1.0, -0.1055613458, -0.0638541728],
        [1.0, -0.0894841775, -1.2914855480],
    ]
)
_TO_LINEAR = np.array(
    [
        [4.0767416621, -3.3077115913, 0.2309699292],
        [-1.2684380046, 2.6097574011, -0.3413193965],
        [-0.0041960863, -0.7034186147, 1.7076147010],
    ]
)


def srgb(lightness: ArrayLike, chroma: ArrayLike, hue: ArrayLike) -> Floats:
    """Convert OKLab colors in polar form to sRGB (c, 3), clipped to 0 to 1; hue in degrees."""
    angle = np.radians(hue)
    lab = np.stack(np.broadcast_arrays(lightness, chroma * np.cos(angle), chroma * np.sin(angle)), axis=-1)
    linear = np.clip((lab @ _TO_ROOTS.T) ** 3 @ _TO_LINEAR.T, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def sequential() -> Floats:
    """(64, 3) from dark violet over green to light yellow; lightness grows evenly, also in gray."""
    t = np.linspace(0.0, 1.0, _STEPS)
    return srgb(0.26 + 0.66 * t, 0.10 + 0.05 * t, 295.0 - 190.0 * t)


def diverging() -> Floats:
    """(64, 3) from blue over near white to orange, which all common color vision tells apart."""
    t = np.linspace(-1.0, 1.0, _STEPS)
    return srgb(0.93 - 0.42 * np.abs(t), 0.145 * np.abs(t), np.where(t < 0, 255.0, 50.0))
