"""Draws small pictures in panels and dialogs, each uploaded to OpenGL once."""

from collections import OrderedDict
from collections.abc import Callable, Hashable

import moderngl
from imgui_bundle import ImVec2, imgui

from ..io.images import Picture

MOST_TEXTURES = 64  # beyond, the one that was drawn longest ago is released


class Thumbnails:
    """Textures of the thumbnails that were drawn last, in an OpenGL context.

    context: by default the current one. `release` must be called in the end.
    """

    def __init__(self, context: moderngl.Context | None = None) -> None:
        self._context = context
        self._textures: OrderedDict[Hashable, moderngl.Texture] = OrderedDict()

    def release(self) -> None:
        """Release all textures."""
        while self._textures:
            self._textures.popitem()[1].release()

    def draw(
        self,
        key: Hashable,
        corner: ImVec2,
        side: float,
        picture: Callable[[], Picture],
        pixels_per_point: float = 1.0,
    ) -> None:
        """Draw a thumbnail in the middle of a square of the current window, pixel by pixel.

        key: another one for each picture and size; corner, side: the square in points; picture: makes the
        (h, w, 4) picture, is called when the key is new.
        """
        texture = self._texture(key, picture)
        width, height = texture.width / pixels_per_point, texture.height / pixels_per_point
        low = ImVec2(round(corner.x + (side - width) / 2), round(corner.y + (side - height) / 2))
        high = ImVec2(low.x + width, low.y + height)
        imgui.get_window_draw_list().add_image(imgui.ImTextureRef(texture.glo), low, high)

    def _texture(self, key: Hashable, make_picture: Callable[[], Picture]) -> moderngl.Texture:
        if key in self._textures:
            self._textures.move_to_end(key)
            return self._textures[key]
        picture = make_picture()
        context = self._context or moderngl.get_context()
        texture = context.texture(picture.shape[1::-1], 4, picture.tobytes(), alignment=1)
        self._textures[key] = texture
        if len(self._textures) > MOST_TEXTURES:
            self._textures.popitem(last=False)[1].release()
        return texture
