"""Color scales: even steps of lightness, and colors that everybody tells apart."""

import numpy as np

from akap_editor.render.colormaps import diverging, sequential, srgb


def luminance(colors):
    linear = np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def test_the_sequential_scale_grows_lighter_throughout():
    colors = sequential()
    assert (np.diff(luminance(colors)) > 0).all()
    assert ((colors >= 0) & (colors <= 1)).all()


def test_the_diverging_scale_is_lightest_in_its_middle_and_even_on_both_sides():
    light = luminance(diverging())
    assert (np.diff(light[:32]) > 0).all()
    assert (np.diff(light[32:]) < 0).all()
    assert np.abs(light - light[::-1]).max() < 0.06
    blue, orange = diverging()[[0, -1]]
    assert blue.argmax() == 2
    assert orange.argmax() == 0
    assert np.ptp(diverging()[31]) < 0.05, "no change is no color"


def test_polar_coordinates_become_the_colors_that_oklab_defines():
    """Ottosson's own examples: white and black have no chroma, and gray of one lightness is neutral."""
    assert np.allclose(srgb([1.0, 0.0], 0.0, 0.0), [[1, 1, 1], [0, 0, 0]], atol=1e-3)
    gray = srgb(0.5, 0.0, 123.0)
    assert np.ptp(gray) < 1e-3
    red = srgb(0.6279554, 0.2576833, 29.2338)  # sRGB (255, 0, 0)
    assert np.allclose(red, [1, 0, 0], atol=2e-3)
