"""A picture that takes long to draw, kept as long as nothing in it changes."""

from collections.abc import Callable
from typing import Any

import moderngl

from .shaders import load_program


class FrameCache:
    """Shows the picture drawn last; draws another where it would come out differently.

    `release` must be called in the end.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._copy = load_program(ctx, "fullscreen.vert", "copy.frag")
        self._pass = ctx.vertex_array(self._copy, [])
        self._texture: moderngl.Texture | None = None
        self._framebuffer: moderngl.Framebuffer | None = None
        self._values: Any = None
        self._things: tuple[object, ...] = ()

    def show(
        self,
        target: moderngl.Framebuffer,
        size: tuple[int, int],
        draw: Callable[[moderngl.Framebuffer], None],
        values: object,
        things: tuple[object, ...],
    ) -> None:
        """Fill ``target``, ``size`` in pixels, with what ``draw`` draws, all of it opaque.

        values, things: on which that depends, those that are compared by value and by identity.
        """
        framebuffer, texture = self._framebuffer, self._texture
        if framebuffer is None or texture is None or framebuffer.size != size:
            target.use()  # moderngl trips over a framebuffer that is released while bound
            self._forget()
            texture = self._texture = self._ctx.texture(size, 4)
            framebuffer = self._framebuffer = self._ctx.framebuffer([texture])
        same = len(things) == len(self._things) and all(map(_is, things, self._things))
        if not same or values != self._values:
            self._things = ()  # should it fail
            draw(framebuffer)
            self._values, self._things = values, things
        target.use()
        self._ctx.viewport, self._ctx.scissor = (0, 0, *size), None
        self._ctx.enable_only(moderngl.NOTHING)
        texture.use(0)
        self._pass.render(moderngl.TRIANGLES, vertices=3)

    def release(self) -> None:
        """Free every OpenGL object."""
        self._forget()
        self._pass.release()
        self._copy.release()

    def _forget(self) -> None:
        for item in (self._framebuffer, self._texture):
            if item is not None:
                item.release()
        self._framebuffer = self._texture = None
        self._values, self._things = None, ()


def _is(a: object, b: object) -> bool:
    return a is b
