"""Small pictures of layers."""

import numpy as np
from imgui_bundle import ImVec2, imgui
from PIL import Image

from ....io.images import Picture
from ....layers.drawing_layer import DrawingLayer
from ...app_state import AppState
from ...theme import ACCENT, FRAME, HOVER, packed

THUMBNAIL_SIDE = 26  # design points


def draw_thumbnail(
    state: AppState, layer: DrawingLayer, corner: ImVec2, side: int, scale: float, is_marked: bool
) -> None:
    """Draw the picture of a layer in a square, with a border in the accent color if it is marked."""
    draw, end = imgui.get_window_draw_list(), ImVec2(corner.x + side, corner.y + side)
    is_hovered = imgui.is_mouse_hovering_rect(corner, end)
    draw.add_rect_filled(corner, end, packed(HOVER if is_hovered else FRAME), 4 * scale)
    if is_marked:
        draw.add_rect(corner, end, packed(ACCENT), 4 * scale, thickness=max(1.0, scale))
    pixels = side - 4
    if imgui.is_rect_visible(corner, end):
        state.thumbnails.draw((layer.artwork, pixels), corner, side, lambda: _small(layer, pixels))


def _small(layer: DrawingLayer, pixels: int) -> Picture:
    """The picture of a layer, at most ``pixels`` wide and high."""
    picture = layer.artwork.picture
    step = 1 + max(picture.shape[:2]) // (8 * pixels)
    image = Image.fromarray(np.ascontiguousarray(picture[::step, ::step]))
    image.thumbnail((pixels, pixels))
    return np.asarray(image)
