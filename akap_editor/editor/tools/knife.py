"""The knife: a stroke becomes a slit in the mesh, so that limbs that touch in the picture come apart."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import shapely

from ...geometry.mesh import TriMesh
from ...geometry.operators import to_complex
from ...geometry.validation import Floats
from ...meshing.slits import Cut, simplified_cut
from ...words import mark, tr
from ..camera import Point
from ..document.drawing import Drawing
from ..document.remesh import map_points
from ..events import PointerEvent
from .base import IdleTool, Markers, Tool, ToolContext, distance

PICK_RADIUS = 8.0  # design points
_SAMPLING = 4.0  # points of the screen between two samples of a stroke
_TORN = 4.0  # times as far apart at rest as on the screen: the stroke has come to another limb


@dataclass(frozen=True)
class CutsRequest:
    """A request to the window to make the mesh with other cuts; label: of the history."""

    label: str
    cuts: tuple[Cut, ...]


def cuts_of(drawing: Drawing) -> tuple[Cut, ...]:
    """The strokes that are cut into a drawing, in pixels of the rest pose."""
    return () if drawing.meshing is None else drawing.meshing.cuts


@dataclass(frozen=True, eq=False)
class _Pose:
    """A pose (n, 2) as an argument of a cached function: another array is another pose."""

    positions: Floats

    def __hash__(self) -> int:
        return id(self.positions)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Pose) and other.positions is self.positions


@lru_cache(maxsize=2)
def _cuts_in_pose(drawing: Drawing, pose: _Pose) -> tuple[list[Floats], ...]:
    """The lips of each stroke in a pose, as densely sampled lines (p, 2)."""
    spacing = 0.01 * drawing.mesh.length
    lips = []
    for cut in cuts_of(drawing):
        points = np.array(shapely.segmentize(shapely.LineString(cut), spacing).coords)
        along = np.gradient(points, axis=0)
        aside = along[:, ::-1] * [-1, 1] / np.maximum(np.hypot(*along.T), 1e-9)[:, None]
        sides = (points + aside, points - aside)
        lines: list[Floats] = []
        for side in sides:
            line = map_points(points, drawing.mesh, pose.positions, sides=side)
            jumps = np.flatnonzero(np.hypot(*np.diff(line, axis=0).T) > _TORN * spacing)  # beside the drawing
            lines += [piece for piece in np.split(line, jumps + 1) if len(piece) > 1]
        lips.append(lines)
    return tuple(lips)


def cuts_on_screen(context: ToolContext) -> list[list[list[Point]]]:
    """The lips of each stroke in the current pose, on the screen."""
    session = context.session
    if session is None or not cuts_of(session.drawing):
        return []
    cuts, to_screen = _cuts_in_pose(session.drawing, _Pose(session.state.positions)), context.camera.to_screen
    return [[[to_screen((x, y)) for x, y in lip.tolist()] for lip in lips] for lips in cuts]


def cut_at(context: ToolContext, position: Point) -> int | None:
    """The index of the nearest stroke within reach of a point of the screen, or None."""
    point, found = shapely.Point(position), []
    for index, lips in enumerate(cuts_on_screen(context)):
        found.append((shapely.MultiLineString(lips).distance(point), index))
    nearest = min(found, default=None)
    return nearest[1] if nearest is not None and nearest[0] <= PICK_RADIUS * context.ui_scale else None


class KnifeIdle(IdleTool):
    """The knife waits for a press.

    request: what the window is to do; highlighted: the index of a stroke that the list points at.
    """

    def __init__(self, context: ToolContext) -> None:
        super().__init__(context)
        self.request: CutsRequest | None = None
        self.highlighted: int | None = None

    @property
    def press_hint(self) -> str:
        session, pointer = self.context.session, self.context.pointer
        if session is not None and session.drawing.layers:
            return tr("The knife cuts flat drawings; layers come apart already")
        if pointer is not None and self._hovered is not None:
            return tr("Alt-click removes this cut; drag across the drawing to cut it")
        return tr("Drag across the drawing, from outside, to cut limbs apart; Shift draws a straight line")

    keyboard_hint = mark("The knife needs a mouse; Esc ends")
    cursor = "cross"

    @property
    def _hovered(self) -> int | None:
        pointer = self.context.pointer
        return None if pointer is None else cut_at(self.context, pointer)

    @property
    def markers(self) -> Markers:
        hovered = self._hovered if "alt" in self.context.held else None
        return Markers(hovered_cut=self.highlighted if hovered is None else hovered)

    def press(self, event: PointerEvent) -> None:
        session = self.context.session
        if session is None or event.button != "left" or session.drawing.layers:
            return
        if event.alt or "alt" in self.context.held:
            hovered = cut_at(self.context, event.position)
            if hovered is not None:
                self.remove(hovered)
            return
        self.context.set_tool(Cutting(self.context, event, self))

    def remove(self, index: int) -> None:
        """Ask for the mesh without one of the strokes."""
        session = self.context.session
        if session is not None:
            cuts = cuts_of(session.drawing)
            self.request = CutsRequest(mark("Remove Cut"), (*cuts[:index], *cuts[index + 1 :]))

    def remove_all(self) -> None:
        """Ask for the mesh without any stroke."""
        session = self.context.session
        if session is not None and cuts_of(session.drawing):
            self.request = CutsRequest(mark("Remove All Cuts"), ())

    def add(self, lines: list[list[Floats]]) -> None:
        """Ask for the mesh with more strokes, whose points are in pixels of the rest pose."""
        session = self.context.session
        new = [cut for line in lines if (cut := simplified_cut([point.tolist() for point in line]))]
        if session is not None and new:
            self.request = CutsRequest(mark("Cut"), (*cuts_of(session.drawing), *new))


class Cutting(Tool):
    """A stroke of the knife; with Shift it is a straight line. It cuts when the button is released."""

    hint = mark("Release to cut, Shift for a straight line, Esc to cancel")
    cursor = "cross"

    def __init__(self, context: ToolContext, event: PointerEvent, idle_tool: KnifeIdle) -> None:
        super().__init__(context)
        self._idle_tool = idle_tool
        self._stroke: list[Point] = [event.position]

    @property
    def markers(self) -> Markers:
        return Markers(cut_stroke=tuple(self._stroke))

    def move(self, event: PointerEvent) -> None:
        if event.shift or "shift" in self.context.held:
            self._stroke[1:] = []
        self._stroke.append(event.position)

    def release(self, event: PointerEvent) -> None:
        if event.button == "left":
            lines = self._lines_at_rest()
            self.context.return_to_idle()
            self._idle_tool.add(lines)

    def _lines_at_rest(self) -> list[list[Floats]]:
        """The stroke in the rest pose, in pieces where it passes from one limb to another one."""
        camera, session = self.context.camera, self.session
        stroke = shapely.LineString(self._stroke) if len(self._stroke) > 1 else None
        if stroke is None or stroke.length == 0:
            return []
        samples = shapely.segmentize(stroke, _SAMPLING * self.context.ui_scale).coords
        lines: list[list[Floats]] = [[]]
        before: tuple[Point, Floats] | None = None
        for sample in samples:
            at = (float(sample[0]), float(sample[1]))
            place = rest_place(session.drawing.mesh, session.state.positions, camera.to_drawing(at))
            if before is not None:
                gone = float(np.hypot(*(place - before[1])))
                if gone > _TORN * max(distance(at, before[0]), 1.0) / camera.zoom:
                    lines.append([])
            lines[-1].append(place)
            before = at, place
        return lines


def rest_place(mesh: TriMesh, pose: Floats, point: Point) -> Floats:
    """Where a point (2,) of a pose (n, 2) is at rest; beside the drawing it goes with the nearest vertex."""
    found = mesh.find(point, pose)
    if found is not None:
        return mesh.evaluate(found, mesh.vertices)[0]
    place = np.array(point)
    nearest = int(((pose - place) ** 2).sum(axis=1).argmin())
    face = mesh.faces[np.argmax((mesh.faces == nearest).any(axis=1))]
    bent, rest = (to_complex(each[face] - each[face].mean(axis=0)) for each in (pose, mesh.vertices))
    rotation = complex(np.vdot(bent, rest))
    offset = complex(*(place - pose[nearest])) * rotation / abs(rotation)
    return mesh.vertices[nearest] + [offset.real, offset.imag]
