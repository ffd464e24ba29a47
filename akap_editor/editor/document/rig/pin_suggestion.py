"""Suggests where pins help to bend a drawing: where limbs end and fork, and in the middle of the body.

A drawing in layers is seen as a whole: limbs are found in the outline of all layers that are shown, not in
each layer by itself, and then each place is given to one of the layers that are there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....errors import InputError
from ....geometry.limbs import find_limbs
from ....geometry.mesh import MeshPoints, TriMesh
from ....geometry.validation import Floats, Ints
from ....layers.drawing_layer import flat_picture, shown_layers
from ....meshing.picture_mesh import mesh_picture
from ..drawing import Drawing
from .joint import Joint

_OUTLINE_SIDE = 600  # pixels of the longer side of the picture in which the outline of all layers is found
_OUTLINE_VERTICES = 1200


@dataclass(frozen=True, eq=False)
class SuggestedPlaces:
    """Places for pins in the rest pose, the most telling ones first: limbs' ends, then middles, then forks.

    rest: (k, 2) pixels; layers: (k,) the layer that each is on, −1 for any.
    """

    rest: Floats
    layers: Ints

    def among(self, chosen: Ints) -> "SuggestedPlaces":
        """Some of the places, by number or mask."""
        return replace(self, rest=self.rest[chosen], layers=self.layers[chosen])

    def points(self, mesh: TriMesh) -> MeshPoints:
        """The places as points of the mesh."""
        return mesh.locate(self.rest, layers=self.layers)


def suggest_places(drawing: Drawing, joints: Sequence[Joint] = ()) -> SuggestedPlaces:
    """Where pins help to bend a drawing. joints: tell layers that bend from those that ride on others."""
    whole, scale = drawing.mesh, 1
    if drawing.layers:
        scale = max(1, round(max(drawing.size) / _OUTLINE_SIDE))
        picture = flat_picture(drawing.layers, drawing.layer_order, drawing.size, scale)
        try:
            whole = mesh_picture(picture[..., 3], _OUTLINE_VERTICES, mesher=_mesher(drawing)).mesh
        except InputError:  # no layer is shown, or hardly
            return SuggestedPlaces(np.zeros((0, 2)), np.zeros(0, dtype=np.int64))
    limbs = find_limbs(whole)
    rest = scale * whole.vertices[np.concatenate([limbs.tips, limbs.middles, limbs.forks])]
    if not drawing.layers:
        return SuggestedPlaces(rest, np.full(len(rest), -1))
    owners = [_owner(drawing, joints, place, index < len(limbs.tips)) for index, place in enumerate(rest)]
    places = SuggestedPlaces(rest, np.array(owners, dtype=np.int64))
    return places.among(np.flatnonzero(places.layers >= 0))


def _mesher(drawing: Drawing) -> str | None:
    return None if drawing.meshing is None else drawing.meshing.mesher


def _owner(drawing: Drawing, joints: Sequence[Joint], place: Floats, is_tip: bool) -> int:
    """The layer that a pin at a place of the rest pose belongs to; −1 if none is there.

    Layers that ride on others, such as eyes, get no pin where another one is. The end of a limb is that of
    the foremost layer; elsewhere the largest one holds the others.
    """
    mesh = drawing.mesh
    hits = mesh.find_all(place)
    shown = shown_layers(drawing.layers)
    at_place = {int(number) for number in mesh.face_layers[hits.faces]}
    rank = {number: at for at, number in enumerate(drawing.layer_order)}
    found = [number for number in at_place if shown[number] and not drawing.layers[number].locked]
    jointed = {number for joint in joints for number in joint.layers(mesh)}
    found = [number for number in found if number in jointed] or found
    if is_tip:
        return max(found, key=lambda number: rank[number], default=-1)
    areas = np.bincount(mesh.face_layers, mesh.rest_areas, len(drawing.layers))
    return max(found, key=lambda number: areas[number], default=-1)
