"""What the window shows under its panels: the drawing, and the second one beside it."""

from dataclasses import replace

import moderngl

from ...render.frame_cache import FrameCache
from ...render.renderer import CANVAS, Background, Renderer
from ..app_state import AppState
from . import split_view

PLAIN = Background(color=CANVAS.color)
# Faces of a mesh from which on a picture is kept. Without a graphics card such a mesh takes several times as
# long to draw as the copy of its picture, and the pointer that hovers over it should not feel that.
KEPT_FROM = 10_000


class Scene:
    """Draws it, or shows it again where nothing has changed. `release` must be called in the end."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._renderer = Renderer(ctx)
        self._kept = FrameCache(ctx)

    def draw(self, state: AppState, size: tuple[int, int], window: tuple[int, int], scale: float) -> None:
        """Fill the screen, of a ``size`` in framebuffer pixels and, as ``window``, in points.

        scale: points for a point of the design.
        """
        document, camera = state.document, state.editor.camera
        view = camera.view(*window)
        background = replace(CANVAS, cell=CANVAS.cell * scale) if state.checker else PLAIN
        overlays = state.overlays(scale * size[0] / max(window[0], 1))

        def draw(target: moderngl.Framebuffer) -> None:
            if document is None:
                self._renderer.hide()
            else:
                self._renderer.show(document.drawing, document.state.positions, document.face_order)
            self._renderer.draw(target, size, view, background=background, overlays=overlays)
            split_view.render(state, self._renderer, target, size, window, background)

        if document is None or len(document.drawing.mesh.faces) < KEPT_FROM:
            draw(self._ctx.screen)
            return
        split = state.editor.canvas if state.split else None
        values = view, window, background, overlays.mesh_lines, overlays.ghost, split
        shown = [document]
        if state.split and state.comparison.session is not None:
            shown.append(state.comparison.session.document)
        poses = [thing for each in shown for thing in (each.drawing, each.state.positions, each.face_order)]
        more = overlays.heat, overlays.reference, *overlays.skins, *overlays.strokes
        self._kept.show(self._ctx.screen, size, draw, values, (*poses, *more))

    def release(self) -> None:
        """Free every OpenGL object."""
        self._kept.release()
        self._renderer.release()
