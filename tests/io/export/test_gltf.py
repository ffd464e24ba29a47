"""glTF: read back by pygltflib and trimesh, and the rules of the specification that viewers trip over."""

import io
import json
import struct

import numpy as np
import pygltflib
import pytest
import trimesh
from PIL import Image

from akap_editor.io.export.gltf import PIXELS_PER_UNIT
from akap_editor.io.export.texture import bleed, y_up

DTYPES = {5125: np.dtype("<u4"), 5126: np.dtype("<f4")}
COLUMNS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}


@pytest.fixture
def path(exported, bent):
    return exported(bent, "a.glb")


@pytest.fixture
def gltf(path):
    return pygltflib.GLTF2().load(path)


def array_of(gltf, number):
    accessor = gltf.accessors[number]
    view = gltf.bufferViews[accessor.bufferView]
    count = accessor.count * COLUMNS[accessor.type]
    array = np.frombuffer(gltf.binary_blob(), DTYPES[accessor.componentType], count, view.byteOffset)
    assert array.nbytes == view.byteLength
    return array.reshape(accessor.count, -1)


def test_container(path):
    """Header, two chunks, each a multiple of 4 bytes long and padded as it should be."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    assert size % 4 == 0
    record = json.loads(data[20 : 20 + size])
    binary, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    assert binary % 4 == 0
    assert 28 + size + binary == len(data)
    assert 0 <= binary - record["buffers"][0]["byteLength"] <= 3
    assert record["asset"]["version"] == "2.0"
    assert set(record["extensionsUsed"]) == {"KHR_materials_unlit"}


def test_views_are_aligned_apart_and_inside_the_buffer(gltf):
    end = 0
    for view in gltf.bufferViews:
        assert view.byteOffset % 4 == 0
        assert view.byteOffset >= end
        end = view.byteOffset + view.byteLength
    assert end <= gltf.buffers[0].byteLength
    targets = {accessor.bufferView: accessor.type for accessor in gltf.accessors}
    for number, view in enumerate(gltf.bufferViews):
        assert view.target == {None: None, "SCALAR": 34963}.get(targets.get(number), 34962)
        assert view.byteStride is None


def test_accessors_say_what_is_in_them(gltf):
    primitive = gltf.meshes[0].primitives[0]
    positions = [primitive.attributes.POSITION, primitive.targets[0]["POSITION"]]
    for number in positions:
        values, accessor = array_of(gltf, number), gltf.accessors[number]
        assert np.isfinite(values).all()
        np.testing.assert_array_equal(np.float32(accessor.min), values.min(axis=0))
        np.testing.assert_array_equal(np.float32(accessor.max), values.max(axis=0))
        assert [float(np.float32(value)) for value in accessor.min] == accessor.min
    counts = {gltf.accessors[n].count for n in (*positions, primitive.attributes.TEXCOORD_0)}
    assert len(counts) == 1
    assert array_of(gltf, primitive.indices).max() == counts.pop() - 1
    assert primitive.mode in (None, 4)


def test_rest_pose_and_morph_target(gltf, bent):
    primitive = gltf.meshes[0].primitives[0]
    rest, offset = (
        array_of(gltf, n).astype(np.float64)
        for n in (primitive.attributes.POSITION, primitive.targets[0]["POSITION"])
    )
    drawing = bent.drawing
    np.testing.assert_allclose(rest[:, :2], y_up(drawing, drawing.mesh.vertices), atol=1e-4)
    np.testing.assert_allclose((rest + offset)[:, :2], y_up(drawing, bent.state.positions), atol=1e-4)
    assert not rest[:, 2].any()
    assert not offset[:, 2].any()
    assert gltf.meshes[0].weights == [1.0]
    assert gltf.meshes[0].extras["targetNames"] == ["Pose"]
    assert gltf.nodes[0].scale == [1 / PIXELS_PER_UNIT] * 3


def test_faces_are_counterclockwise_and_in_order(gltf, bent):
    primitive = gltf.meshes[0].primitives[0]
    faces = array_of(gltf, primitive.indices).reshape(-1, 3)
    np.testing.assert_array_equal(faces, bent.drawing.mesh.faces[:, ::-1])
    a, b, c = array_of(gltf, primitive.attributes.POSITION)[faces].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_material_and_texture(gltf, bent):
    material = gltf.materials[0]
    assert material.alphaMode == "BLEND"
    assert material.doubleSided
    assert "KHR_materials_unlit" in material.extensions
    assert material.pbrMetallicRoughness.baseColorTexture.index == 0
    image = gltf.images[gltf.textures[0].source]
    assert image.mimeType == "image/png"
    view = gltf.bufferViews[image.bufferView]
    data = gltf.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(data))), bleed(bent.drawing.image))
    uv = array_of(gltf, gltf.meshes[0].primitives[0].attributes.TEXCOORD_0)
    np.testing.assert_array_equal(uv, bent.drawing.uv)


def test_another_reader_sees_the_same_scene(path, drawn):
    scene = trimesh.load(path)
    (geometry,) = scene.geometry.values()
    assert len(geometry.vertices) == len(drawn.drawing.mesh.vertices)
    assert geometry.area == pytest.approx(drawn.drawing.mesh.rest_areas.sum(), rel=1e-5)
    size = np.ptp(drawn.drawing.mesh.vertices, axis=0) / PIXELS_PER_UNIT
    np.testing.assert_allclose(scene.extents[:2], size, rtol=1e-5)
    assert geometry.visual.material.alphaMode == "BLEND"
    assert geometry.visual.material.baseColorTexture.size == drawn.drawing.size
