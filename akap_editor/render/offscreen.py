"""Renders a posed drawing to an array, without a window."""

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from math import ceil, floor, isfinite
from typing import Any, Self

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..editor.document import Drawing
from ..errors import GraphicsError, InputError
from ..geometry.checks import as_points
from .renderer import Background, Color, Renderer, View, load_program

Box = tuple[int, int, int, int]

MAX_SIZE = 8192
_SLACK = 1e-6  # pixels: rounding noise must not add a row


def frame_box(drawing: Drawing, poses: Sequence[ArrayLike]) -> Box:
    """The rectangle (x0, y0, x1, y1) in whole drawing units that holds the picture's frame and all ``poses``.

    poses: (n, 2) each. Nothing is cut off, and an animation gets one box for all its frames.
    Raises InputError for a bad pose.
    """
    corners = [np.array([(0, 0), drawing.size], dtype=np.float64)]
    corners += [as_points(pose, "poses", len(drawing.mesh.vertices)) for pose in poses]
    low = np.min([points.min(axis=0) for points in corners], axis=0)
    high = np.max([points.max(axis=0) for points in corners], axis=0)
    return (
        floor(low[0] + _SLACK),
        floor(low[1] + _SLACK),
        ceil(high[0] - _SLACK),
        ceil(high[1] - _SLACK),
    )


def standalone_context() -> moderngl.Context:
    """An OpenGL 3.3 context that needs no window and no display server. Raises GraphicsError."""
    backend: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=330, **backend)
    except Exception as error:  # moderngl raises nothing more specific
        raise GraphicsError(
            "OpenGL 3.3 without a window is not available: on Debian and Ubuntu, install the packages "
            f"libegl1 and libgl1 ({error})"
        ) from error


class OffscreenRenderer:
    """A context manager that renders drawings to arrays.

    context: an OpenGL context that is current in all calls, e.g. the window's; by default one of its own,
    made on first use, without any display server.
    """

    def __init__(self, context: moderngl.Context | None = None) -> None:
        self._context = context
        self._owned = context is None
        self._renderer: Renderer | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        if self._renderer is not None:
            with self._current():
                for item in (self._unpremultiply_pass, self._unpremultiply, self._renderer):
                    item.release()
            self._renderer = None
        if self._owned and self._context is not None:
            self._context.release()
            self._context = None

    def render(
        self,
        drawing: Drawing,
        positions: ArrayLike,
        box: Box | None = None,
        scale: float = 1.0,
        background: Color | None = None,
    ) -> NDArray[np.uint8]:
        """The drawing in a pose as (h, w, 4) uint8, straight alpha; where alpha is 0, so is the color.

        positions: (n, 2) drawing units; box: the part of the drawing plane to show, by default `frame_box` of
        the pose; scale: pixels per drawing unit, the size is rounded up; background: (r, g, b) from 0 to 1,
        or None for transparent. A drawing at rest comes out as its picture was, within what its mesh covers.
        Raises InputError for a bad argument or too large a picture, GraphicsError without OpenGL 3.3.
        """
        pose = as_points(positions, "positions", len(drawing.mesh.vertices))
        x0, y0, x1, y1 = frame_box(drawing, [pose]) if box is None else box
        if not (isfinite(scale) and scale > 0):
            raise InputError(f"scale: expected a positive number, got {scale:g}")
        if not (x0 < x1 and y0 < y1):
            raise InputError(f"box: expected x0 < x1 and y0 < y1, got {(x0, y0, x1, y1)}")
        if self._context is None:
            self._context = standalone_context()
        with self._current():
            renderer = self._prepared_renderer(self._context)
            width, height = (x1 - x0) * scale, (y1 - y0) * scale
            limit = min(MAX_SIZE, renderer.max_texture_size)
            if max(width, height) > limit + _SLACK:
                raise InputError(
                    f"picture size: expected at most {limit}×{limit} pixels, got {width:.0f}×{height:.0f}; "
                    "choose a smaller scale"
                )
            size = max(1, ceil(width - _SLACK)), max(1, ceil(height - _SLACK))
            renderer.show(drawing, pose)
            # y is not turned: the target's bottom row, which is read first, is the top row of the result.
            sx, sy = 2 * scale / size[0], 2 * scale / size[1]
            view = sx, sy, -1 - sx * x0, -1 - sy * y0
            return self._draw(self._context, renderer, size, view, Background(background))

    def _draw(
        self,
        ctx: moderngl.Context,
        renderer: Renderer,
        size: tuple[int, int],
        view: View,
        background: Background,
    ) -> NDArray[np.uint8]:
        """Draw in 16-bit floats, so that the division by alpha is exact, and divide on the graphics card."""
        target = ctx.texture(size, 4, dtype="f2")
        straight = ctx.renderbuffer(size, 4)
        first, second = ctx.framebuffer([target]), ctx.framebuffer([straight])
        try:
            with ctx.scope(first):
                renderer.draw(first, size, view, background=background)
            target.use(0)
            with ctx.scope(second, moderngl.NOTHING):
                self._unpremultiply_pass.render(moderngl.TRIANGLES, vertices=3)
            pixels = np.empty((size[1], size[0], 4), dtype=np.uint8)
            second.read_into(pixels, components=4, alignment=1)
            return pixels
        finally:
            for item in (first, second, target, straight):
                item.release()

    def _prepared_renderer(self, ctx: moderngl.Context) -> Renderer:
        if self._renderer is None:
            self._renderer = Renderer(ctx, precise=True)
            self._unpremultiply = load_program(ctx, "fullscreen.vert", "unpremultiply.frag")
            self._unpremultiply_pass = ctx.vertex_array(self._unpremultiply, [])
        return self._renderer

    def _current(self) -> AbstractContextManager[object]:
        """Makes an own context current; a given one is current already."""
        return self._context if self._owned and self._context is not None else nullcontext()
