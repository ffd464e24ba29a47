"""How alike two pictures look."""

import numpy as np
from scipy.ndimage import gaussian_filter

from .pictures import Picture

_SIGMA, _K1, _K2 = 1.5, 0.01, 0.03  # as in the paper


def structural_similarity(first: Picture, second: Picture) -> float:
    """SSIM of two pictures (h, w, 4) with straight alpha: the lowest of all colors, on white and on black.

    Wang, Bovik, Sheikh, Simoncelli, “Image Quality Assessment: From Error Visibility to Structural
    Similarity”, 2004, with their window and constants.
    """
    values = []
    for background in (0.0, 1.0):
        a, b = (_on(image, background) for image in (first, second))
        values += [_mean_ssim(a[..., channel], b[..., channel]) for channel in range(3)]
    return min(values)


def _on(image: Picture, background: float) -> np.ndarray:
    alpha = image[..., 3:] / 255
    return image[..., :3] / 255 * alpha + background * (1 - alpha)


def _mean_ssim(a: np.ndarray, b: np.ndarray) -> float:
    def blur(values: np.ndarray) -> np.ndarray:
        return gaussian_filter(values, _SIGMA, truncate=3.5)

    mean_a, mean_b = blur(a), blur(b)
    var_a, var_b = blur(a * a) - mean_a**2, blur(b * b) - mean_b**2
    covariance = blur(a * b) - mean_a * mean_b
    c1, c2 = _K1**2, _K2**2
    ssim = (2 * mean_a * mean_b + c1) * (2 * covariance + c2)
    return float((ssim / ((mean_a**2 + mean_b**2 + c1) * (var_a + var_b + c2))).mean())
