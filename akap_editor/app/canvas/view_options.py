"""What the canvas shows besides the drawing: fields, distortion, rest pose, trails, a reference picture."""

import time
from concurrent.futures import Future, wait
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui
from numpy.typing import NDArray

from ...deform.methods import get_method
from ...editor.document.drawing import Drawing
from ...editor.document.stiffness import MAX_STIFFNESS
from ...editor.editor import FRAME_BUDGET, Editor
from ...editor.session.session import Session
from ...errors import InputError
from ...geometry.distortion import Distortion
from ...geometry.validation import Floats, Ints
from ...io.images import read_image
from ...render.colormaps import diverging, sequential
from ...render.overlays import FaceColors, LineSegments, OnionPose, Overlays, Reference
from ..theme import DARK, QUIET, TEXT, packed

Measure = Literal["area", "angle"]

GREEN, BLUE = (0.35, 0.95, 0.45, 1.0), (0.30, 0.55, 1.0, 1.0)  # U_opt and U° as in the paper's Fig. 4
TRAIL = (0.95, 0.95, 0.95, 1.0)
RANGES = (1.1, 1.25, 1.5, 2.0, 4.0)  # at the ends of the distortion scale
STIFF = (0.62, 0.36, 1.0)  # of parts that bend less, while the brush is at hand
GHOST, REFERENCE = 0.3, 0.5  # opacity
BEFORE, AFTER = (0.34, 0.71, 0.91, 0.88), (0.90, 0.55, 0.0, 0.88)  # blue and orange: told apart by all eyes
SKIN, FADING = 0.5, 0.65  # opacity of the nearest pose of the onion skin, and by how much others have less
SPACING = 30.0  # points of the screen between arrows
LONGEST = 1.6  # times the spacing: the longest arrow
SHARE = 0.2  # of the time that fields may take while something moves
COLORS: dict[Measure, Floats] = {"area": diverging(), "angle": sequential()}
SWITCHES = ("vectors", "ghost", "trails", "show_reference")  # fields that are remembered between runs


@dataclass
class ViewOptions:
    """Which overlays are on.

    vectors: the fields of the drag; heat: what the map of distortion shows, if on; heat_range: see RANGES;
    reference_path: the file of the reference picture, None where it came from none.
    """

    vectors: bool = False
    heat: Measure | None = None
    heat_range: int = 2
    ghost: bool = False
    trails: bool = False
    reference: Reference | None = None
    reference_path: Path | None = None
    show_reference: bool = True
    _fields: "_VectorFieldArrows" = field(default_factory=lambda: _VectorFieldArrows())
    _heat: "tuple[Distortion, Measure, int, FaceColors] | None" = None
    _tint: tuple[Floats, FaceColors] | None = None

    def set_reference(self, image: NDArray[np.uint8], path: Path | None = None) -> None:
        """Show another reference picture, (h, w, 4) uint8, at half its strength."""
        self.reference, self.show_reference = Reference(image, REFERENCE), True
        self.reference_path = path

    def read_reference_again(self) -> None:
        """The picture of the last run, on or off as it was; nobody misses it where it is gone."""
        path, shown = self.reference_path, self.show_reference
        self.reference_path = None
        with suppress(InputError):
            if path is not None:
                self.set_reference(read_image(path), path)
        self.show_reference = shown

    def kept(self) -> dict[str, object]:
        """What is remembered between runs, for `recall`."""
        switches = {name: getattr(self, name) for name in SWITCHES}
        reference = str(self.reference_path.absolute()) if self.reference_path is not None else ""
        return {**switches, "heat": self.heat or "", "range": RANGES[self.heat_range], "reference": reference}

    def recall(self, kept: dict[str, object]) -> None:
        """All as `kept` said it was, but the reference picture, which must be read again.

        What makes no sense is passed over: the file may have been edited by hand.
        """
        for name in SWITCHES:
            if isinstance(on := kept.get(name), bool):
                setattr(self, name, on)
        self.heat = next((measure for measure in COLORS if measure == kept.get("heat")), None)
        if kept.get("range") in RANGES:
            self.heat_range = RANGES.index(kept["range"])
        if isinstance(path := kept.get("reference"), str) and path:
            self.reference_path = Path(path)

    def overlays(
        self, editor: Editor, distortion: Distortion | None, mesh_lines: bool, scale: float
    ) -> Overlays:
        """What the renderer draws. distortion: of the pose, None where there is none.

        scale: framebuffer pixels for a point of the design.
        """
        strokes: list[LineSegments] = []
        if self.trails:
            strokes += outlined(editor.trails.segments(), TRAIL, 1.5 * scale)
        if self.vectors and editor.session is not None and (editor.is_moving or editor.tool.drags_pins):
            strokes += self._fields.strokes(editor, editor.session, scale)
        else:
            self._fields.drop()
        return Overlays(
            mesh_lines=mesh_lines,
            ghost=GHOST if self.ghost else 0.0,
            heat=self._tint_of(editor) or self._heat_of(distortion),
            strokes=tuple(strokes),
            reference=self.reference if self.show_reference else None,
        )

    @property
    def is_computing(self) -> bool:
        """Whether vector fields are being computed."""
        return self._fields.coming is not None

    def _tint_of(self, editor: Editor) -> FaceColors | None:
        """What bends less, while the brush is at hand; one object for each stiffness."""
        stiffness = editor.tool.shown_stiffness
        if stiffness is None:
            return None
        if self._tint is None or self._tint[0] is not stiffness:
            levels = np.log(stiffness) / np.log(MAX_STIFFNESS)
            self._tint = stiffness, FaceColors(levels, np.array([STIFF, STIFF]), sheer=True)
        return self._tint[1]

    def _heat_of(self, distortion: Distortion | None) -> FaceColors | None:
        """One object for each pose, so that it is uploaded once."""
        if self.heat is None or distortion is None:
            return None
        key = distortion, self.heat, self.heat_range
        if self._heat is None or self._heat[:3] != key:
            self._heat = *key, heat(distortion, self.heat, RANGES[self.heat_range])
        return self._heat[3]


def heat(distortion: Distortion, measure: Measure, limit: float) -> FaceColors:
    """Levels for a scale that ends at ``limit``, the ratio by which an area or a shape has changed.

    area: from 1/limit over 1 in the middle to limit, by equal ratios. angle: the longer by the shorter axis
    that a circle has become, from 1 to limit. Flipped faces are off the scale.
    """
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        if measure == "area":
            levels = 0.5 + 0.5 * np.log(np.abs(distortion.face_determinant)) / np.log(limit)
        else:  # r + 1/r = s, the paper's measure
            s = np.maximum(distortion.face_angle, 2.0)
            levels = np.log(0.5 * (s + np.sqrt(s * s - 4.0))) / np.log(limit)
    levels = np.clip(levels, 0.0, 1.0)
    return FaceColors(np.where(distortion.face_determinant > 0, levels, -1.0), COLORS[measure])


def skins(before: list[Floats], after: list[Floats]) -> tuple[OnionPose, ...]:
    """The onion skin of poses before and after, the nearest ones first; those lie in front."""
    made = [
        (number, OnionPose(pose, tint, SKIN * FADING**number))
        for poses, tint in ((before, BEFORE), (after, AFTER))
        for number, pose in enumerate(poses)
    ]
    return tuple(skin for _, skin in sorted(made, key=lambda each: -each[0]))


def outlined(segments: Floats, color: tuple[float, float, float, float], width: float) -> list[LineSegments]:
    """Lines with a dark rim, which stand out from any picture."""
    dark = (*DARK[:3], 0.55)
    return [LineSegments(segments, dark, width + 2.0), LineSegments(segments, color, width)]


def spread(drawing: Drawing, spacing: float) -> Ints:
    """Indices of vertices about ``spacing`` drawing pixels from one another, one in each cell of a grid.

    The grid lies on the rest pose, so that arrows ride on the drawing and do not flicker.
    """
    places = drawing.mesh.vertices / spacing
    cells = np.floor(places)
    off_center = np.abs(places - cells - 0.5).max(axis=1)
    order = np.lexsort((off_center, cells[:, 1], cells[:, 0]))
    _, first = np.unique(cells[order], axis=0, return_index=True)
    return order[first]


def softened(vectors: Floats, longest: float) -> Floats:
    """Vectors of lengths up to 1 as arrows up to ``longest``; by the root, so that slow places show, too."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return longest * vectors / np.sqrt(np.maximum(lengths, 1e-12))


def arrows(starts: Floats, vectors: Floats, head: float) -> Floats:
    """(3 k, 2, 2): shafts (k, 2) + ``vectors`` with two barbs each, ``head`` long at most."""
    ends = starts + vectors
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    back = -vectors / np.maximum(lengths, 1e-12) * np.minimum(0.4 * lengths, head)
    side = 0.6 * np.stack([-back[:, 1], back[:, 0]], axis=1)
    pieces = [(starts, ends), (ends, ends + back + side), (ends, ends + back - side)]
    return np.concatenate([np.stack(piece, axis=1) for piece in pieces])


class _VectorFieldArrows:
    """The vector fields of the last move of the pins, computed no more often than there is time for.

    coming: those that the worker computes.
    """

    def __init__(self) -> None:
        self.coming: Future[tuple[Floats, Floats] | None] | None = None
        self._way: object = None
        self._drawing: Drawing | None = None
        self._fields: tuple[Floats, Floats] | None = None
        self._begun = self._until = 0.0
        self._chosen: tuple[Drawing, float, Ints] | None = None

    def strokes(self, editor: Editor, session: Session, scale: float) -> list[LineSegments]:
        """Arrows of U° with those of U_opt over them; none for methods without fields."""
        self._update(editor, session)
        if self._fields is None:
            return []
        optimal, smooth = self._fields
        longest = max(float(np.linalg.norm(each, axis=1).max()) for each in self._fields)
        if longest == 0:
            return []
        zoom, spacing = editor.camera.zoom, SPACING * editor.ui_scale
        chosen = self._vertices(session.drawing, spacing / 2.0 ** (round(2 * np.log2(zoom)) / 2))
        starts = session.state.positions[chosen]
        below, above = (
            arrows(starts, softened(each[chosen] / longest, LONGEST * spacing / zoom), 0.25 * spacing / zoom)
            for each in (smooth, optimal)
        )
        return [*outlined(below, BLUE, 3.2 * scale), LineSegments(above, GREEN, 1.4 * scale)]

    def drop(self) -> None:
        """Nobody waits for what the worker computes."""
        if self.coming is not None:
            self.coming = self._way = None

    def _update(self, editor: Editor, session: Session) -> None:
        """Take over what the worker has computed, and let it compute what is new."""
        if session.drawing is not self._drawing:
            self._drawing, self._way, self._fields, self.coming = session.drawing, None, None, None
        way, now = session.last_motion, time.perf_counter()
        if self.coming is None and way is not self._way and not (editor.is_moving and now < self._until):
            self._way, self._begun = way, now
            self.coming = editor.worker.submit(session.vector_fields)
            wait([self.coming], FRAME_BUDGET)
        if self.coming is not None and self.coming.done():
            self._fields, self.coming = self.coming.result(), None
            self._until = self._begun + (time.perf_counter() - self._begun) / SHARE

    def _vertices(self, drawing: Drawing, spacing: float) -> Ints:
        if self._chosen is None or self._chosen[0] is not drawing or self._chosen[1] != spacing:
            self._chosen = drawing, spacing, spread(drawing, spacing)
        return self._chosen[2]


def draw_legend(view: ViewOptions, editor: Editor, scale: float) -> None:
    """What colors mean, in the lower left corner of the canvas; a click on a scale chooses its range."""
    if editor.session is None or not (view.vectors or view.heat is not None):
        return
    left, _, _, bottom = editor.canvas
    imgui.set_next_window_pos(
        ImVec2(left + 12 * scale, bottom - 12 * scale), imgui.Cond_.always, ImVec2(0, 1)
    )
    imgui.set_next_window_bg_alpha(0.82)
    flags = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.always_auto_resize
    flags |= imgui.WindowFlags_.no_move | imgui.WindowFlags_.no_saved_settings
    flags |= imgui.WindowFlags_.no_focus_on_appearing
    if view.heat is None:
        flags |= imgui.WindowFlags_.no_inputs  # nor does F6 stop there
    if imgui.begin("##legend", None, flags)[0]:
        if view.vectors:
            _field_legend(editor.session, scale)
        if view.heat is not None:
            _heat_legend(view, view.heat, scale)
    imgui.end()


def _field_legend(session: Session, scale: float) -> None:
    if not get_method(session.state.settings.method).deformer.has_vector_fields:
        imgui.text_colored(ImVec4(*QUIET), "This method has no vector field")
        return
    for color, label in ((GREEN, "U_opt, the field followed"), (BLUE, "U°, before the second solve")):
        at, size = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
        start, end = ImVec2(at.x, at.y + size / 2), ImVec2(at.x + 18 * scale, at.y + size / 2)
        draw = imgui.get_window_draw_list()
        draw.add_line(start, end, packed(color), 2 * scale)
        tip = 4 * scale
        draw.add_line(end, ImVec2(end.x - tip, end.y - tip), packed(color), 2 * scale)
        draw.add_line(end, ImVec2(end.x - tip, end.y + tip), packed(color), 2 * scale)
        imgui.dummy(ImVec2(22 * scale, size))
        imgui.same_line()
        imgui.text_colored(ImVec4(*TEXT), label)


def _heat_legend(view: ViewOptions, measure: Measure, scale: float) -> None:
    limit = RANGES[view.heat_range]
    title = "Area, against the drawing at rest" if measure == "area" else "Stretch, longer by shorter axis"
    imgui.text_colored(ImVec4(*QUIET), title)
    size = ImVec2(230 * scale, 10 * scale)
    at = imgui.get_cursor_screen_pos()
    whole = ImVec2(size.x, size.y + 3 * scale + imgui.get_text_line_height())
    if imgui.invisible_button("##range", whole, imgui.ButtonFlags_.enable_nav):
        view.heat_range = (view.heat_range + 1) % len(RANGES)
    if imgui.is_item_hovered(imgui.HoveredFlags_.delay_normal):
        imgui.set_tooltip("Click, or R, for another range")
    draw, colors = imgui.get_window_draw_list(), COLORS[measure]
    edges = np.linspace(at.x, at.x + size.x, len(colors) + 1).tolist()
    for low, high, color in zip(edges, edges[1:], colors.tolist(), strict=False):
        draw.add_rect_filled(ImVec2(low, at.y), ImVec2(high + 0.5, at.y + size.y), packed((*color, 1.0)))
    labels = (f"÷ {limit:g}", "same", f"× {limit:g}") if measure == "area" else ("1 (none)", "", f"{limit:g}")
    for share, label in zip((0.0, 0.5, 1.0), labels, strict=True):
        x = at.x + share * (size.x - imgui.calc_text_size(label).x)
        draw.add_text(ImVec2(x, at.y + size.y + 3 * scale), packed(TEXT), label)
