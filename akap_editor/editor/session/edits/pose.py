"""Edits of the pose, the rest pose and the mesh."""

import base64
import zlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError
from ....geometry.validation import MAX_COORDINATE, Floats, as_number
from ....layers.layered_picture import Layer, LayeredPicture, LayerGroup
from ....meshing.meshers import TRIANGLE, check_known, nearest_mesher
from ....words import tr
from ...document.crossings import as_crossings, crossings_in_pose
from ...document.document import EditState
from ...document.drawing import Drawing, Meshing
from ...document.named_poses import as_pose
from ...document.pin_angles import pins_fixed_at_pose
from ...document.remesh import remesh_drawing, transfer_state
from ...document.rest_pose import with_pose_as_rest
from ..artwork_reload import with_artwork
from .edit import Edit, Effect, Json, ReplayTarget, crossings_from_json, crossings_to_json

MAX_LAYER_PIXELS = 2**28
MAX_GROUPS = 50  # around a layer


@dataclass(frozen=True, eq=False)
class SetPose(Edit):
    """Set the pose (n, 2), pixels; the pins move with the drawing and stay there.

    crossings: which part passes in front, see `EditState`; by default the one that does now.
    """

    name = "pose"
    fields = ("positions",)
    effect = Effect.POSE

    positions: ArrayLike
    crossings: ArrayLike | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        pose = as_pose(self.positions, "positions", len(drawing.mesh.vertices))
        return _in_pose(state, drawing, pose, self.crossings)

    def to_json(self, drawing: Drawing) -> Json:
        positions = np.asarray(self.positions, dtype=np.float64).tolist()
        return {"positions": positions, **crossings_to_json(self.crossings)}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        positions = target.pose(event["positions"], len(drawing.mesh.vertices))
        return cls(positions, crossings_from_json(event))


def _in_pose(
    state: EditState, drawing: Drawing, pose: Floats, crossings: ArrayLike | None = None
) -> EditState:
    """A state in another pose (n, 2), with the given crossings or those that follow from the present ones."""
    mesh, pins = drawing.mesh, pins_fixed_at_pose(drawing.mesh, state.pins, pose)
    if crossings is None:
        crossings = crossings_in_pose(mesh, state.pins, state.positions, state.crossings, pose)
    return replace(state, pins=pins, positions=pose, crossings=as_crossings(crossings, len(mesh.faces)))


@dataclass(frozen=True)
class ResetPose(Edit):
    """Return to the rest pose; the pins move with the drawing and stay there."""

    name = "reset"
    effect = Effect.POSE

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        rest = drawing.mesh.vertices
        if np.array_equal(state.positions, rest):
            return state
        return _in_pose(state, drawing, rest)


@dataclass(frozen=True)
class SetRestPose(Edit):
    """Make the current pose the rest pose; no vertex moves."""

    name = "bake"
    effect = Effect.DOCUMENT

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        if np.array_equal(state.positions, drawing.mesh.vertices):
            return state
        return with_pose_as_rest(state, drawing)


@dataclass(frozen=True, eq=False)
class Remesh(Edit):
    """Give the picture another mesh; pins and pose stay.

    prepared: the drawing from `remesh_drawing` and the state from `transfer_state`, if they were computed
    before; the state must have been transferred from the one that the edit is applied to. A recorded edit
    whose mesher is not installed gives a mesh of another one. Recordings without a mesher are of times when
    there was only Triangle.
    """

    name = "mesh"
    fields = ("vertices", "expand", "threshold", "background")
    effect = Effect.MESH

    meshing: Meshing
    prepared: tuple[Drawing, EditState | None] | None = None

    @classmethod
    def from_drawing(cls, drawing: Drawing, transferred: EditState | None = None) -> Self:
        """The edit that takes over a drawing from `remesh_drawing`, and a state from `transfer_state`."""
        assert drawing.meshing is not None, "expected a drawing whose mesh can be made again"
        return cls(drawing.meshing, (drawing, transferred))

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        remeshed, transferred = self.prepared or (remesh_drawing(drawing, self.meshing), None)
        return transferred or transfer_state(state, drawing.mesh, remeshed)

    def to_json(self, drawing: Drawing) -> Json:
        record = asdict(self.meshing)
        if not self.meshing.cuts:
            del record["cuts"]
        return record

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        tolerance = event["background"]
        return cls(
            Meshing(
                int(event["vertices"]),
                target.scale * float(event["expand"]),
                float(event["threshold"]),
                None if tolerance is None else float(tolerance),
                nearest_mesher(check_known(event.get("mesher", TRIANGLE))),
                tuple(target.points(cut, "cuts", len(cut)).tolist() for cut in event.get("cuts", ())),
            )
        )


@dataclass(frozen=True, eq=False)
class ReloadArtwork(Edit):
    """Take over artwork that was painted anew; pins, joints, poses and stiffness stay, see `reload_layers`.

    artwork: layers, or one picture of a flat drawing, which is a single layer here; prepared: the state that
    was computed before from the one that the edit is applied to.
    """

    name = "artwork"
    fields = ("size", "layers")
    effect = Effect.MESH

    artwork: LayeredPicture
    prepared: EditState | None = None

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        return self.prepared or with_artwork(state, drawing, self.artwork)

    def to_json(self, drawing: Drawing) -> Json:
        return {"size": list(self.artwork.size), "layers": [*map(_layer_to_json, self.artwork.layers)]}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        width, height = _read_size(event["size"])
        return cls(LayeredPicture((width, height), tuple(map(_layer_from_json, event["layers"]))))


def _read_size(value: Sequence[int]) -> tuple[int, int]:
    """Width and height, pixels. Raises InputError if that is too much."""
    width, height = (int(as_number(side, "size", 1, MAX_LAYER_PIXELS)) for side in value)
    as_number(width * height, "pixels", 1, MAX_LAYER_PIXELS)
    return width, height


def _layer_to_json(layer: Layer) -> Json:
    height, width = layer.picture.shape[:2]
    groups = [group.name for group in layer.groups]
    pixels = base64.b64encode(zlib.compress(layer.picture.tobytes(), 6)).decode("ascii")
    return {
        "name": layer.name,
        "groups": groups,
        "offset": list(layer.offset),
        "size": [width, height],
        "opacity": layer.opacity,
        "blend": layer.blend,
        "visible": layer.visible,
        "pixels": pixels,
    }


def _layer_from_json(record: Json) -> Layer:
    width, height = _read_size(record["size"])
    size = 4 * width * height
    try:
        data = zlib.decompressobj().decompress(base64.b64decode(record["pixels"], validate=True), size)
    except zlib.error as error:
        raise InputError(tr("expected the pixels of a layer, got damaged ones")) from error
    if len(data) != size:
        raise InputError(tr("expected {size} bytes of pixels, got {count}", size=size, count=len(data)))
    if len(record["groups"]) > MAX_GROUPS:
        raise InputError(
            tr(
                "expected at most {most} groups around a layer, got {count}",
                most=MAX_GROUPS,
                count=len(record["groups"]),
            )
        )
    x, y = (int(as_number(value, "offset", -MAX_COORDINATE, MAX_COORDINATE)) for value in record["offset"])
    return Layer(
        str(record["name"]),
        np.frombuffer(data, np.uint8).reshape(height, width, 4),
        (x, y),
        tuple(LayerGroup(str(name)) for name in record["groups"]),
        record["opacity"],
        record["blend"],
        record["visible"],
    )
