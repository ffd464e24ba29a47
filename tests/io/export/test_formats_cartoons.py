"""Real cartoons, bent, in every format that has no pixels; read back by others."""

import json
from dataclasses import replace

import numpy as np
import pygltflib
import pytest
import shapely
import trimesh

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.export.svg import silhouette
from akap_editor.io.images import read_image


@pytest.fixture(params=["cat", "gecko", "t-rex"])
def curled(request, shared_data):
    """A cartoon wound up around its middle, so that limbs lie upon one another."""
    image = read_image(shared_data / "noto" / f"{request.param}.png")
    document = new_document(make_drawing(image, vertices=600, name=request.param))
    rest = document.drawing.mesh.vertices
    middle = np.median(rest, axis=0)
    x, y = (rest - middle).T
    angle = y / 120
    pose = middle + np.stack([x * np.cos(angle) + 90 * np.sin(angle), x * np.sin(angle) + y / 2], axis=1)
    return document.with_state(replace(document.state, positions=pose))


def test_all_readers_agree(exported, curled):
    mesh = curled.drawing.mesh
    counts = len(mesh.vertices), len(mesh.faces)
    obj = trimesh.load(exported(curled, "a.obj"), process=False, maintain_order=True)
    assert (len(obj.vertices), len(obj.faces)) == counts
    gltf = pygltflib.GLTF2().load(str(exported(curled, "a.glb")))
    primitive = gltf.meshes[0].primitives[0]
    assert gltf.accessors[primitive.attributes.POSITION].count == counts[0]
    assert gltf.accessors[primitive.indices].count == 3 * counts[1]
    skin = json.loads(exported(curled, "a.spine.json").read_text())["skins"][0]["attachments"]
    parts = [part for slot in skin.values() for part in slot.values()]
    assert sum(len(part["triangles"]) for part in parts) == 3 * counts[1]
    assert sum(len(part["uvs"]) for part in parts) == 2 * counts[0]
    assert len(parts) == mesh.component.max() + 1


def test_the_outline_covers_every_face_and_nothing_else(curled):
    """Middles of faces are inside; the area is at most that of all faces, less where limbs overlap."""
    mesh, pose = curled.drawing.mesh, curled.state.positions
    parts = silhouette(curled.drawing, pose)
    middles = pose[mesh.faces].mean(axis=1)
    covered = np.zeros(len(middles), dtype=bool)
    for part in parts:
        covered |= shapely.covers(part.buffer(0.01), shapely.points(middles))
    assert covered.all()
    a, b, c = pose[mesh.faces].transpose(1, 0, 2)
    areas = 0.5 * np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1)))
    assert sum(part.area for part in parts) <= areas.sum() + 0.1
