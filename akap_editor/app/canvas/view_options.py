"""The View menu's overlays: which are on, and what the renderer draws for them."""

from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...editor.document.rig.loose_parts import LooseParts
from ...editor.document.stiffness import MAX_STIFFNESS
from ...editor.editor import Editor
from ...editor.session.session import Session
from ...errors import InputError
from ...geometry.distortion import Distortion
from ...geometry.validation import Floats
from ...io.images import read_image
from ...layers.drawing_layer import shown_layers
from ...render.colormaps import diverging, sequential
from ...render.overlays import FaceColors, LineSegments, OnionPose, Overlays, Reference, Rgba
from .checkerboard import BOARD_LABELS, BoardChoice
from .vector_field_arrows import VectorFieldArrows, outlined

Measure = Literal["area", "angle"]

DISTORTION_SCALES: dict[Measure, Floats] = {"area": diverging(), "angle": sequential()}
DISTORTION_RANGES = (1.1, 1.25, 1.5, 2.0, 4.0)  # ratios at the end of the scale
STIFFNESS_COLOR = (0.62, 0.36, 1.0)
LOOSE_COLOR, _LOOSE_LEVEL = (0.05, 0.72, 0.55), 0.7  # and how much of it covers the picture
TRAIL_COLOR: Rgba = (0.95, 0.95, 0.95, 1.0)
REST_POSE_OPACITY, REFERENCE_OPACITY = 0.3, 0.5
BEFORE_TINT: Rgba = (0.34, 0.71, 0.91, 0.88)  # blue and orange, which all common color vision tells apart
AFTER_TINT: Rgba = (0.90, 0.55, 0.0, 0.88)
ONION_OPACITY = 0.5  # of the nearest pose
ONION_FADING = 0.65  # opacity of each pose as a share of that of the one before it
LAYER_COLOR: Rgba = (1.0, 0.706, 0.227, 0.9)  # of the outline of the selected layer
STORED_SWITCHES = {  # name in the preferences: field
    "vectors": "show_vector_fields",
    "ghost": "show_rest_pose",
    "trails": "show_pin_trails",
    "motion paths": "show_motion_paths",
    "speed graph": "show_speed_graph",
    "show_reference": "show_reference",
    "smooth bends": "smooth_bends",
}


@dataclass
class ViewOptions:
    """What is shown besides the drawing.

    board: the shade of the checkerboard; smooth_bends: whether the canvas and exports show curved faces, see
    `render.refinement`; is_split: whether a second method is compared; show_vector_fields:
    while a pin is dragged; distortion_measure: of the distortion map, None if it is off; distortion_range:
    index in `DISTORTION_RANGES`; reference_path: the file of the reference picture, None if it has none;
    selected_layer: the number of the layer that is selected in the list and outlined, None for none.
    """

    smooth_bends: bool = True
    show_mesh: bool = False
    show_pins: bool = True
    show_checkerboard: bool = True
    board: BoardChoice = "automatic"
    is_split: bool = False
    show_vector_fields: bool = False
    show_rest_pose: bool = False
    show_pin_trails: bool = False
    show_motion_paths: bool = False
    show_speed_graph: bool = False
    show_reference: bool = True
    distortion_measure: Measure | None = None
    distortion_range: int = 2
    reference: Reference | None = None
    reference_path: Path | None = None
    selected_layer: int | None = None
    _arrows: VectorFieldArrows = field(default_factory=VectorFieldArrows)
    _distortion_map: tuple[Distortion, Measure, int, FaceColors] | None = None
    _painted_map: tuple[Floats | LooseParts, FaceColors] | None = None

    def set_reference(self, image: NDArray[np.uint8], path: Path | None = None) -> None:
        """Show another reference picture, (h, w, 4) uint8."""
        self.reference, self.show_reference = Reference(image, REFERENCE_OPACITY), True
        self.reference_path = path

    def reload_reference(self) -> None:
        """Read the reference picture of the last run again; without a message if the file is gone."""
        path, show_reference = self.reference_path, self.show_reference
        self.reference_path = None
        with suppress(InputError):
            if path is not None:
                self.set_reference(read_image(path), path)
        self.show_reference = show_reference

    def toggle_distortion_map(self, measure: Measure) -> None:
        """Show the map of a measure instead of the other one, or no map if it is shown already."""
        self.distortion_measure = None if self.distortion_measure == measure else measure

    def use_next_distortion_range(self) -> None:
        """Use the next wider range of the distortion map; after the widest, the narrowest."""
        self.distortion_range = (self.distortion_range + 1) % len(DISTORTION_RANGES)

    def to_json(self) -> dict[str, object]:
        """The values to store in the preferences, for `restore`."""
        switches = {name: getattr(self, attribute) for name, attribute in STORED_SWITCHES.items()}
        return {
            **switches,
            "heat": self.distortion_measure or "",
            "range": DISTORTION_RANGES[self.distortion_range],
            "board": self.board,
            "reference": str(self.reference_path.absolute()) if self.reference_path is not None else "",
        }

    def restore(self, stored: dict[str, object]) -> None:
        """Take over stored values, except for the reference picture: call `reload_reference` to read it.

        A value that makes no sense is ignored, because the file may have been edited by hand.
        """
        for name, attribute in STORED_SWITCHES.items():
            if isinstance(value := stored.get(name), bool):
                setattr(self, attribute, value)
        measure = stored.get("heat")
        self.distortion_measure = next((name for name in DISTORTION_SCALES if name == measure), None)
        self.board = next((name for name in BOARD_LABELS if name == stored.get("board")), "automatic")
        if stored.get("range") in DISTORTION_RANGES:
            self.distortion_range = DISTORTION_RANGES.index(stored["range"])
        if isinstance(path := stored.get("reference"), str) and path:
            self.reference_path = Path(path)

    def overlays(
        self, editor: Editor, distortion: Distortion | None, mesh_lines: bool, scale: float
    ) -> Overlays:
        """The overlays that the renderer draws.

        distortion: of the current pose, None if nothing is open; scale: framebuffer pixels per design point.
        """
        lines: list[LineSegments] = []
        if self.show_pin_trails:
            lines += outlined(editor.trails.segments(), TRAIL_COLOR, 1.5 * scale)
        session = editor.session
        if session is not None and session.drawing.layers:
            lines += _layer_outline(session, self.selected_layer, scale)
        is_in_motion = editor.is_moving or editor.tool.drags_pins
        if self.show_vector_fields and session is not None and is_in_motion:
            lines += self._arrows.lines(editor, session, scale)
        else:
            self._arrows.cancel()
        return Overlays(
            mesh_lines=mesh_lines,
            rest_pose_opacity=REST_POSE_OPACITY if self.show_rest_pose else 0.0,
            face_colors=self._painted_colors(editor) or self._distortion_colors(distortion),
            lines=tuple(lines),
            reference=self.reference if self.show_reference else None,
        )

    @property
    def is_computing(self) -> bool:
        """Whether vector fields are being computed."""
        return self._arrows.is_computing

    def _painted_colors(self, editor: Editor) -> FaceColors | None:
        """Colors of the stiffness or loose parts that the tool shows; one object for each."""
        stiffness, loose = editor.tool.shown_stiffness, editor.tool.shown_loose
        painted = loose if stiffness is None else stiffness
        if painted is None:
            return None
        if self._painted_map is None or self._painted_map[0] is not painted:
            if isinstance(painted, LooseParts):
                levels, color = np.where(painted.faces, _LOOSE_LEVEL, 0.0), LOOSE_COLOR
            else:
                levels, color = np.log(painted) / np.log(MAX_STIFFNESS), STIFFNESS_COLOR
            self._painted_map = painted, FaceColors(levels, np.array([color, color]), translucent=True)
        return self._painted_map[1]

    def _distortion_colors(self, distortion: Distortion | None) -> FaceColors | None:
        """Colors of the distortion map; one object for each pose, so that it is uploaded once."""
        if self.distortion_measure is None or distortion is None:
            return None
        key = distortion, self.distortion_measure, self.distortion_range
        if self._distortion_map is None or self._distortion_map[:3] != key:
            limit = DISTORTION_RANGES[self.distortion_range]
            self._distortion_map = *key, distortion_colors(distortion, self.distortion_measure, limit)
        return self._distortion_map[3]


def _layer_outline(session: Session, layer: int | None, scale: float) -> list[LineSegments]:
    """The outline of a layer in the current pose. scale: framebuffer pixels per design point."""
    drawing = session.drawing
    if layer is None or layer >= len(drawing.layers) or not shown_layers(drawing.layers)[layer]:
        return []
    mesh, pose = drawing.mesh, session.state.positions
    assert mesh.layers is not None
    loops = [loop for loop in mesh.boundary_loops if mesh.layers[loop[0]] == layer]
    segments = np.concatenate([np.stack([pose[loop], pose[np.roll(loop, -1)]], axis=1) for loop in loops])
    return outlined(segments, LAYER_COLOR, 1.5 * scale)


def distortion_colors(distortion: Distortion, measure: Measure, limit: float) -> FaceColors:
    """Colors of a distortion map whose scale ends at the ratio ``limit``.

    area: the factor of each face's area, from 1/limit to limit, 1 in the middle. angle: a circle becomes an
    ellipse; its longer axis divided by the shorter one, from 1 to limit. Both scales are logarithmic. Flipped
    faces are off the scale.
    """
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        if measure == "area":
            levels = 0.5 + 0.5 * np.log(np.abs(distortion.face_determinant)) / np.log(limit)
        else:  # solves r + 1/r = s for the ratio r, where s is the measure of the paper
            s = np.maximum(distortion.face_angle, 2.0)
            levels = np.log(0.5 * (s + np.sqrt(s * s - 4.0))) / np.log(limit)
    levels = np.clip(levels, 0.0, 1.0)
    return FaceColors(np.where(distortion.face_determinant > 0, levels, -1.0), DISTORTION_SCALES[measure])


def onion_poses(before: list[Floats], after: list[Floats]) -> tuple[OnionPose, ...]:
    """The onion skin, nearest poses in front. before, after: poses (n, 2), the nearest one first."""
    poses = [
        (distance, OnionPose(positions, tint, ONION_OPACITY * ONION_FADING**distance))
        for skins, tint in ((before, BEFORE_TINT), (after, AFTER_TINT))
        for distance, positions in enumerate(skins)
    ]
    return tuple(pose for _, pose in sorted(poses, key=lambda entry: -entry[0]))
