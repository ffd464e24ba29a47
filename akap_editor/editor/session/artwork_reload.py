"""Reloads artwork that was painted anew: pins, joints, poses and stiffness stay, layer by layer."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...geometry.validation import Floats, Ints
from ...layers.atlas import pack
from ...layers.composite import composite
from ...layers.drawing_layer import Artwork, DrawingLayer
from ...layers.layer_view import LayerView
from ...layers.layered_picture import Layer, LayeredPicture
from ...layers.merging import movable_layers
from ...meshing.layer_mesh import mesh_layers
from ...meshing.meshers import nearest_mesher
from ...words import tr
from ..document.document import EditState
from ..document.drawing import Drawing, Meshing, artwork_in, remove_background_and_mesh, texture_shifts
from ..document.remesh import LayerOrigins, check_lies_on_picture, transfer_state


def reload_layers(drawing: Drawing, layered: LayeredPicture) -> tuple[Drawing, LayerOrigins]:
    """A drawing in layers with the artwork of another picture, and where its layers come from.

    A layer is found again by its path of names, else by its picture. Its name and the switches of the list
    stay. If its picture is the same, so is its mesh, moved with it; else it gets a new mesh of as many
    vertices. New layers come in where they are in the file. Raises InputError if nothing is left of the
    layers, or if the mesh does not lie on its picture, for example after a new rest pose.
    """
    movable = movable_layers(layered)
    if not movable:
        raise InputError(tr("the layers are fully transparent: expected a drawing"))
    check_lies_on_picture(drawing)
    assert drawing.mesh.layers is not None
    meshing = drawing.meshing or Meshing()
    old_of = _matches(drawing.layers, movable)
    counts = np.bincount(drawing.mesh.layers, minlength=len(drawing.layers))
    known: dict[int, tuple[Floats, Ints]] = {}
    shifts, is_same = np.zeros((len(movable), 2)), np.zeros(len(movable), dtype=bool)
    for number, (layer, old) in enumerate(zip(movable, old_of, strict=True)):
        if old >= 0 and np.array_equal(layer.picture, drawing.layers[old].artwork.picture):
            is_same[number] = True
            shifts[number] = np.subtract(layer.offset, drawing.layers[old].artwork.offset)
            vertices, faces = _part(drawing.mesh, old)
            known[number] = vertices + shifts[number], faces
    texture, corners = pack([layer.picture for layer in movable], meshing.expand)
    layers = tuple(
        _drawing_layer(
            drawing, layer, old, artwork_in(texture, layer.picture.shape[:2], layer.offset, corner)
        )
        for layer, old, corner in zip(movable, old_of, corners, strict=True)
    )
    wanted = {number: max(int(counts[old]), 20) for number, old in enumerate(old_of) if old >= 0}
    mesh = mesh_layers(
        [layer.picture[..., 3] for layer in movable],
        [layer.offset for layer in movable],
        meshing.vertices,
        meshing.expand,
        meshing.threshold,
        nearest_mesher(meshing.mesher),
        known,
        wanted,
    )
    places = mesh.vertices + texture_shifts(layers)[mesh.layers]
    uv = (places / [texture.shape[1], texture.shape[0]]).astype(np.float32)
    order = _order(drawing.layer_order, old_of)
    reloaded = Drawing(
        texture, mesh, uv, drawing.name, drawing.meshing, None, layers, order, canvas=layered.size
    )
    return reloaded, LayerOrigins(np.array(old_of), shifts, is_same)


def _drawing_layer(drawing: Drawing, layer: Layer, old: int, artwork: Artwork) -> DrawingLayer:
    groups = tuple(group.name for group in layer.groups)
    if old >= 0:
        return replace(drawing.layers[old], artwork=artwork, groups=groups, blend=layer.blend)
    return DrawingLayer(artwork, layer.name, groups, layer.opacity, layer.blend, layer.visible)


def _part(mesh: TriMesh, layer: int) -> tuple[Floats, Ints]:
    """Vertices (v, 2) and faces (q, 3) of one layer."""
    assert mesh.layers is not None
    own = np.flatnonzero(mesh.layers == layer)
    return mesh.vertices[own], mesh.faces[mesh.face_layers == layer] - own[0]


def _matches(old_layers: Sequence[DrawingLayer], layers: Sequence[Layer]) -> list[int]:
    """The number of the old layer of each new one, −1 for none: by path, the n-th of it, then by picture."""
    seen: Counter[tuple[str, ...]] = Counter()
    by_path: dict[tuple[tuple[str, ...], int], int] = {}
    for number, old in enumerate(old_layers):
        by_path[old.path, seen[old.path]] = number
        seen[old.path] += 1
    seen.clear()
    matches = []
    for layer in layers:
        matches.append(by_path.pop((layer.path, seen[layer.path]), -1))
        seen[layer.path] += 1
    left = sorted(by_path.values())
    for number, layer in enumerate(layers):
        if matches[number] < 0:
            alike = (old for old in left if np.array_equal(old_layers[old].artwork.picture, layer.picture))
            found = next(alike, None)
            if found is not None:
                matches[number] = found
                left.remove(found)
    return matches


def _order(old_order: Sequence[int], old_of: Sequence[int]) -> tuple[int, ...]:
    """The order of the layers: old ones as they were, new ones in front of those below them in the file."""
    new_of = {old: new for new, old in enumerate(old_of) if old >= 0}
    order = [new_of[old] for old in old_order if old in new_of]
    for number, old in enumerate(old_of):
        if old < 0:
            order.insert(order.index(number - 1) + 1 if number else 0, number)
    return tuple(order)


def _reloaded_view(view: LayerView, reloaded: Drawing, origins: LayerOrigins) -> LayerView:
    """What a keyframe holds of the layer list, for the layers of the reloaded artwork."""
    old_of: list[int] = origins.layers.tolist()
    visible = (
        view.visible[old] if old >= 0 else layer.visible
        for old, layer in zip(old_of, reloaded.layers, strict=True)
    )
    return LayerView(tuple(visible), _order(view.order, old_of))


def with_artwork(state: EditState, drawing: Drawing, artwork: LayeredPicture) -> EditState:
    """A state with the artwork of another picture in place of the drawing's.

    Of a flat drawing the artwork is one layer of the size of the canvas. Raises InputError as `reload_layers`
    and `transfer_state` do.
    """
    if drawing.layers:
        reloaded, origins = reload_layers(drawing, artwork)
        transferred = transfer_state(state, drawing.mesh, reloaded, origins)
        animation = transferred.animation.map_layers(lambda view: _reloaded_view(view, reloaded, origins))
        return replace(transferred, animation=animation)
    check_lies_on_picture(drawing)
    meshing = drawing.meshing or Meshing()
    image = composite(artwork)
    return transfer_state(state, drawing.mesh, remove_background_and_mesh(image, meshing, drawing.name))
