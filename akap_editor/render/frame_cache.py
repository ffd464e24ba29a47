"""Caches the last picture, and draws another one only if its content has changed."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import moderngl
import numpy as np

from .draw_calls import DrawTriangles, draw_triangles
from .shaders import load_program


def has_same_content(first: object, second: object) -> bool:
    """Whether two descriptions of a picture are the same.

    Dataclasses are compared field by field, tuples item by item, arrays by identity, everything else by
    equality. So a new field of a dataclass takes part by itself.
    """
    if first is second:
        return True
    if type(first) is not type(second) or isinstance(first, np.ndarray):
        return False
    if isinstance(first, tuple) and isinstance(second, tuple):
        return len(first) == len(second) and all(map(has_same_content, first, second))
    if is_dataclass(first):
        names = [field.name for field in fields(first)]
        return all(has_same_content(getattr(first, name), getattr(second, name)) for name in names)
    return bool(first == second)


MIN_CHANGES = 4  # in a row, after which pictures are expected to change again


class FrameCache:
    """Shows a picture that takes long to draw. `release` must be called in the end.

    While the content changes in each call, pictures are drawn without the cache, because a copy takes time.

    draw_triangles: copies it, see `draw_calls`.
    """

    def __init__(self, ctx: moderngl.Context, draw_triangles: DrawTriangles = draw_triangles) -> None:
        self._ctx, self._draw_triangles = ctx, draw_triangles
        self._copy_program = load_program(ctx, "fullscreen.vert", "copy.frag")
        self._copy_pass = ctx.vertex_array(self._copy_program, [])
        self._texture: moderngl.Texture | None = None
        self._framebuffer: moderngl.Framebuffer | None = None
        self._content: Any = None  # of the picture in the cache
        self._last_content: Any = None  # of the picture shown last
        self._changes = 0  # in a row

    def show(
        self,
        target: moderngl.Framebuffer,
        size: tuple[int, int],
        content: object,
        draw: Callable[[moderngl.Framebuffer], None],
    ) -> None:
        """Fill ``target``, ``size`` in pixels, with the opaque picture that ``draw`` draws.

        content: describes the picture, see `has_same_content`; ``draw`` must use nothing else. It is kept, so
        its arrays must not be modified.
        """
        framebuffer, texture = self._framebuffer, self._texture
        if framebuffer is None or texture is None or framebuffer.size != size:
            target.use()  # moderngl fails if a framebuffer is released while it is bound
            self._release_picture()
            texture = self._texture = self._ctx.texture(size, 4)
            framebuffer = self._framebuffer = self._ctx.framebuffer([texture])
        is_changed = self._last_content is None or not has_same_content(content, self._last_content)
        self._changes = self._changes + 1 if is_changed else 0
        if self._changes > MIN_CHANGES:
            self._content = self._last_content = None
            draw(target)
            self._last_content = content
            return
        if self._content is None or not has_same_content(content, self._content):
            self._content = self._last_content = None  # in case drawing fails
            draw(framebuffer)
            self._content = content
        self._last_content = content
        target.use()
        self._ctx.viewport, self._ctx.scissor = (0, 0, *size), None
        self._ctx.enable_only(moderngl.NOTHING)
        texture.use(0)
        self._draw_triangles(self._copy_pass, 0, 3)

    def release(self) -> None:
        """Free every OpenGL object."""
        self._release_picture()
        self._copy_pass.release()
        self._copy_program.release()

    def _release_picture(self) -> None:
        for item in (self._framebuffer, self._texture):
            if item is not None:
                item.release()
        self._framebuffer = self._texture = self._content = self._last_content = None
