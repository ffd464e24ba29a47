"""Draws what lies under the panels: the drawing with its overlays, and the second pose of the split view."""

from dataclasses import dataclass, replace

import moderngl

from ...editor.animation.loose_motion import Crossed, shown_frame
from ...editor.document.document import Document
from ...editor.document.drawing import Drawing
from ...geometry.validation import Floats, Ints
from ...overlap.seams import CutMesh
from ...render.draw_calls import AddressOf, unlocked_draw_triangles
from ...render.frame_cache import FrameCache
from ...render.overlays import NO_OVERLAYS, Overlays
from ...render.renderer import CANVAS, Background, Renderer
from ...render.shaders import View
from ..app_state import AppState
from .checkerboard import board_background
from .split_view import comparison_camera, right_half
from .view_options import onion_poses

PLAIN = Background(color=CANVAS.color)
# Without a graphics card, drawing a mesh of so many faces takes several times as long as copying its picture,
# and a pointer that only hovers over it would feel that.
MIN_CACHED_FACES = 10_000


@dataclass(frozen=True, eq=False)
class PosedDrawing:
    """A drawing in a pose.

    positions: (n, 2); order: (m,) faces in drawing order, None for that of the mesh; region: see
    `Renderer.draw`; is_smooth: see `Renderer.show`.
    """

    drawing: Drawing
    positions: Floats
    order: Ints | CutMesh | None
    view: View
    region: tuple[int, int, int, int] | None = None
    is_smooth: bool = False


@dataclass(frozen=True, eq=False)
class SceneContent:
    """Everything that the picture of a scene depends on; the cache compares it field by field.

    size: of the picture in pixels; main: None if nothing is open; comparison: None without a split view.
    """

    size: tuple[int, int]
    background: Background
    main: PosedDrawing | None = None
    comparison: PosedDrawing | None = None
    overlays: Overlays = NO_OVERLAYS


class Scene:
    """Draws the scene in each frame; `release` must be called in the end.

    Of a large mesh it shows the last picture again, unless the content has changed. address_of: see
    `unlocked_draw_triangles`.
    """

    def __init__(self, ctx: moderngl.Context, address_of: AddressOf) -> None:
        self._ctx = ctx
        draw_triangles = unlocked_draw_triangles(address_of)
        self._renderer = Renderer(ctx, draw_triangles=draw_triangles)
        self._cache = FrameCache(ctx, draw_triangles)

    def draw(self, state: AppState, size: tuple[int, int], window: tuple[int, int], scale: float) -> None:
        """Fill the screen. size, window: of it, in framebuffer pixels and in points; scale: points per design
        point.
        """
        self.paint(scene_content(state, size, window, scale))

    def paint(self, content: SceneContent) -> None:
        """Fill the screen with this content."""
        if content.main is None or len(content.main.drawing.mesh.faces) < MIN_CACHED_FACES:
            self._draw(content, self._ctx.screen)
        else:
            self._cache.show(
                self._ctx.screen, content.size, content, lambda target: self._draw(content, target)
            )

    def release(self) -> None:
        """Free every OpenGL object."""
        self._cache.release()
        self._renderer.release()

    def _draw(self, content: SceneContent, target: moderngl.Framebuffer) -> None:
        renderer, main, comparison = self._renderer, content.main, content.comparison
        if main is None:
            renderer.hide()
            renderer.draw(target, content.size, (1.0, 1.0, 0.0, 0.0), background=content.background)
            return
        self._show(main, content.size)
        renderer.draw(
            target, content.size, main.view, background=content.background, overlays=content.overlays
        )
        if comparison is not None:
            self._show(comparison, content.size)
            renderer.draw(
                target,
                content.size,
                comparison.view,
                background=content.background,
                region=comparison.region,
            )

    def _show(self, posed: PosedDrawing, size: tuple[int, int]) -> None:
        scale = posed.view[0] * size[0] / 2
        self._renderer.show(posed.drawing, posed.positions, posed.order, posed.is_smooth, scale)


def scene_content(
    state: AppState, size: tuple[int, int], window: tuple[int, int], scale: float
) -> SceneContent:
    """The content of the next frame; arguments as in `Scene.draw`."""
    document, density = state.document, size[0] / max(window[0], 1)
    overlays = scene_overlays(state, scale * density)
    if document is None:
        return SceneContent(size, PLAIN)
    background = PLAIN
    if state.view.show_checkerboard:
        background = board_background(document.drawing, state.view.board, CANVAS.cell * scale)
    view = state.editor.camera.view(*window)
    main = PosedDrawing(
        document.drawing,
        *_shown_pose(state, document),
        view,
        is_smooth=state.view.smooth_bends and not state.view.is_split,
    )
    comparison = _comparison(state, size, window, density)
    return SceneContent(size, background, main, comparison, overlays)


def _shown_pose(state: AppState, document: Document) -> tuple[Floats, Ints | CutMesh | None]:
    """The pose (n, 2) of the document with its loose parts where they are now, and what is drawn of it."""
    shown, session, timeline = document.state, state.editor.session, state.timeline
    if shown.loose is None or session is None:
        state.loose_canvas.is_moving = False
        return shown.positions, document.draw_order
    pose: Floats | None
    if timeline.shows_another_time:
        state.loose_canvas.is_moving = False
        pose = timeline.playback.loose_pose(timeline.playback.playhead)
    else:
        pose = state.loose_canvas.pose(document.drawing, shown, session.discontinuities)
    if pose is None or pose is shown.positions:
        return shown.positions, document.draw_order
    crossed = Crossed(shown.pins, shown.positions, shown.crossings)
    frame = shown_frame(document.drawing, crossed, pose)
    return frame.pose, frame.order


def scene_overlays(state: AppState, scale: float) -> Overlays:
    """The overlays of the next frame. scale: framebuffer pixels per design point."""
    has_map = state.view.distortion_measure is not None
    distortion = state.measure_distortion() if has_map else None
    mesh_lines = state.view.show_mesh or state.remesher.is_active
    overlays = state.view.overlays(state.editor, distortion, mesh_lines, scale)
    if not state.timeline.shows_keyframes:
        return overlays
    return replace(overlays, onion_poses=onion_poses(*state.timeline.keyframe_playback.onion_poses()))


def _comparison(
    state: AppState, size: tuple[int, int], window: tuple[int, int], density: float
) -> PosedDrawing | None:
    """The second pose in the right half. density: framebuffer pixels per point."""
    session = state.comparison.session
    if not state.view.is_split or session is None:
        return None
    canvas = state.editor.canvas
    left, top, right, bottom = (round(density * edge) for edge in right_half(canvas))
    return PosedDrawing(
        session.drawing,
        session.state.positions,
        session.document.draw_order,
        comparison_camera(state.editor.camera, canvas).view(*window),
        region=(left, size[1] - bottom, right - left, bottom - top),
    )
