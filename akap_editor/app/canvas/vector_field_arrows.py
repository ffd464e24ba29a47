"""Arrows of the vector fields of the last step, drawn over the drawing while a pin is dragged."""

import time
from concurrent.futures import Future, wait

import numpy as np

from ...editor.document.drawing import Drawing
from ...editor.editor import FRAME_BUDGET, Editor
from ...editor.session.session import Session
from ...geometry.validation import Floats, Ints
from ...render.overlays import LineSegments, Rgba
from ..theme import DARK

U_OPT_COLOR: Rgba = (0.35, 0.95, 0.45, 1.0)  # green and blue, as in Figure 4 of the paper
U_SMOOTH_COLOR: Rgba = (0.30, 0.55, 1.0, 1.0)  # of U°
SPACING = 30.0  # points of the screen between arrows
MAX_LENGTH = 1.6  # of an arrow, in spacings
MAX_SHARE = 0.2  # of the time while the drawing moves that may be spent on fields


class VectorFieldArrows:
    """The fields of the last motion of the pins, computed by the editor's worker when there is time."""

    def __init__(self) -> None:
        self._pending: Future[tuple[Floats, Floats] | None] | None = None
        self._fields: tuple[Floats, Floats] | None = None
        self._motion: object = None  # the motion whose fields are shown, or pending
        self._drawing: Drawing | None = None
        self._started = self._not_before = 0.0
        self._grid: tuple[Drawing, float, Ints] | None = None

    @property
    def is_computing(self) -> bool:
        """Whether fields are being computed."""
        return self._pending is not None

    def lines(self, editor: Editor, session: Session, scale: float) -> list[LineSegments]:
        """Arrows of U°, and those of U_opt over them; none for a method without vector fields.

        scale: framebuffer pixels per design point.
        """
        self._update(editor, session)
        if self._fields is None:
            return []
        u_opt, u_smooth = self._fields
        longest = max(float(np.linalg.norm(field, axis=1).max()) for field in self._fields)
        if longest == 0:
            return []
        zoom, spacing = editor.camera.zoom, SPACING * editor.ui_scale
        # in steps of √2, so that the arrows stay in place while one zooms a little
        vertices = self._grid_vertices(session.drawing, spacing / 2.0 ** (round(2 * np.log2(zoom)) / 2))
        starts, max_length = session.state.positions[vertices], MAX_LENGTH * spacing / zoom
        smooth_arrows, opt_arrows = (
            arrows(starts, compressed(field[vertices] / longest, max_length), 0.25 * spacing / zoom)
            for field in (u_smooth, u_opt)
        )
        return [
            *outlined(smooth_arrows, U_SMOOTH_COLOR, 3.2 * scale),
            LineSegments(opt_arrows, U_OPT_COLOR, 1.4 * scale),
        ]

    def cancel(self) -> None:
        """Ignore the fields that are being computed."""
        if self._pending is not None:
            self._pending = self._motion = None

    def _update(self, editor: Editor, session: Session) -> None:
        """Take over fields that are computed, and start to compute those of a new motion."""
        if session.drawing is not self._drawing:
            self._drawing, self._motion, self._fields, self._pending = session.drawing, None, None, None
        motion, now = session.last_motion, time.perf_counter()
        has_time = not editor.is_moving or now >= self._not_before
        if self._pending is None and motion is not self._motion and has_time:
            self._motion, self._started = motion, now
            self._pending = editor.worker.submit(session.vector_fields)
            wait([self._pending], FRAME_BUDGET)
        if self._pending is not None and self._pending.done():
            self._fields, self._pending = self._pending.result(), None
            seconds = time.perf_counter() - self._started
            self._not_before = self._started + seconds / MAX_SHARE

    def _grid_vertices(self, drawing: Drawing, spacing: float) -> Ints:
        if self._grid is None or self._grid[0] is not drawing or self._grid[1] != spacing:
            self._grid = drawing, spacing, grid_vertices(drawing, spacing)
        return self._grid[2]


def grid_vertices(drawing: Drawing, spacing: float) -> Ints:
    """Indices (v,) of vertices about ``spacing`` drawing units apart, one in each cell of a grid.

    The grid lies on the rest pose, so that arrows move with the drawing and do not flicker.
    """
    scaled = drawing.mesh.vertices / spacing
    cells = np.floor(scaled)
    off_center = np.abs(scaled - cells - 0.5).max(axis=1)
    order = np.lexsort((off_center, cells[:, 1], cells[:, 0]))
    _, first = np.unique(cells[order], axis=0, return_index=True)
    return order[first]


def compressed(vectors: Floats, max_length: float) -> Floats:
    """Vectors (k, 2) of lengths 0 to 1 with lengths max_length √length, so that slow parts are visible."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return max_length * vectors / np.sqrt(np.maximum(lengths, 1e-12))


def arrows(starts: Floats, vectors: Floats, head: float) -> Floats:
    """Line segments (3 k, 2, 2) of arrows from ``starts`` (k, 2): a shaft and two barbs, ``head`` at most."""
    ends = starts + vectors
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    back = -vectors / np.maximum(lengths, 1e-12) * np.minimum(0.4 * lengths, head)
    side = 0.6 * np.stack([-back[:, 1], back[:, 0]], axis=1)
    pieces = [(starts, ends), (ends, ends + back + side), (ends, ends + back - side)]
    return np.concatenate([np.stack(piece, axis=1) for piece in pieces])


def outlined(segments: Floats, color: Rgba, width: float) -> list[LineSegments]:
    """Lines with a dark outline, visible on any picture."""
    outline = (*DARK[:3], 0.55)
    return [LineSegments(segments, outline, width + 2.0), LineSegments(segments, color, width)]
