"""Meshes in glTF and JSON files as programs should not write them: one sentence each, never a traceback."""

import json
import struct

import pytest

from akap_editor.editor.document.drawing import make_drawing
from akap_editor.errors import InputError
from akap_editor.io.export.gltf import encode_glb
from akap_editor.io.inspection import inspect
from akap_editor.io.mesh_files.soundness import count_parts, decode_mesh, mesh_defects
from tests.support.pictures import bar_picture

CORNERS, FACES = "[[0, 0], [1, 0], [0, 1]]", "[[0, 1, 2]]"


def json_mesh(vertices=CORNERS, faces=FACES):
    return f'{{"vertices": {vertices}, "faces": {faces}}}'


def spine(vertices="[0, 0, 1, 0, 0, 1]", triangles="[0, 1, 2]"):
    mesh = f'{{"vertices": {vertices}, "triangles": {triangles}}}'
    return f'{{"skins": [{{"attachments": {{"a": {{"b": {mesh}}}}}}}]}}'


BAD_JSON = {
    "ragged rows": json_mesh("[[0, 0], [1], [0, 1]]"),
    "rows of rows": json_mesh("[[[0, 0]], [[1, 0]], [[0, 1]]]"),
    "no rows": json_mesh("[0, 0, 1, 0, 0, 1]"),
    "rows of four": json_mesh("[[0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1]]"),
    "texts": json_mesh('[["0", "0"], ["1", "0"], ["0", "1"]]'),
    "superscript digits": json_mesh('[["²", "0"], ["1", "0"], ["0", "1"]]'),
    "true and false": json_mesh("[[true, false], [false, true], [true, true]]"),
    "null": json_mesh("[[null, 0], [1, 0], [0, 1]]"),
    "NaN": json_mesh("[[NaN, 0], [1, 0], [0, 1]]"),
    "1e999": json_mesh("[[1e999, 0], [1, 0], [0, 1]]"),
    "1e300": json_mesh("[[1e300, 0], [1, 0], [0, 1]]"),
    "an integer of 5000 digits": json_mesh(f"[[{'9' * 5000}, 0], [1, 0], [0, 1]]"),
    "no vertices": json_mesh("[]"),
    "vertices by name": json_mesh('{"a": 1}'),
    "vertices missing": '{"faces": [[0, 1, 2]]}',
    "ragged faces": json_mesh(faces="[[0, 1, 2], [0, 1]]"),
    "faces of two": json_mesh(faces="[[0, 1]]"),
    "faces of four": json_mesh(faces="[[0, 1, 2, 0]]"),
    "an index too high": json_mesh(faces="[[0, 1, 3]]"),
    "a negative index": json_mesh(faces="[[0, 1, -1]]"),
    "half an index": json_mesh(faces="[[0, 1, 1.5]]"),
    "an index as text": json_mesh(faces='[["0", "1", "2"]]'),
    "an index of true": json_mesh(faces="[[true, false, true]]"),
    "an index of 18 digits": json_mesh(faces=f"[[0, 1, {10**18}]]"),
    "an index of 5000 digits": json_mesh(faces=f"[[0, 1, {'9' * 5000}]]"),
    "no list of faces": json_mesh(faces="null"),
    "a key twice": '{"vertices": [], "vertices": [], "faces": []}',
    "nothing": "{}",
    "100,000 brackets": '{"vertices": ' + "[" * 100_000 + "]" * 100_000 + "}",
    "no skins": '{"skins": 3}',
    "no attachments": '{"skins": []}',
    "half a point": spine("[0, 0, 1]"),
    "points as text": spine('["0", 0, 1, 0, 0, 1]'),
    "half a triangle": spine(triangles="[0, 1]"),
    "a triangle as text": spine(triangles='["0", "1", "2"]'),
    "a triangle of the next attachment": spine(triangles="[0, 1, 3]"),
    "a triangle of a huge index": spine(triangles=f"[0, 1, {2**53 - 1}]"),
}

GOOD_GLB = encode_glb(drawing := make_drawing(bar_picture(), vertices=60), drawing.mesh.vertices)
JSON_SIZE = struct.unpack_from("<I", GOOD_GLB, 12)[0]
RECORD, BINARY = json.loads(GOOD_GLB[20 : 20 + JSON_SIZE]), GOOD_GLB[20 + JSON_SIZE :]
INDICES = RECORD["meshes"][0]["primitives"][0]["indices"]
VIEW = RECORD["accessors"][INDICES]["bufferView"]
NO_NUMBERS = [-1, 2**31, 2**53, 1.5, True, None, "3", []]


def glb(*path_and_value, binary=BINARY):
    """The good file with another value at a path of its JSON."""
    record = json.loads(json.dumps(RECORD))
    if path_and_value:
        *path, key, value = path_and_value
        place = record
        for step in path:
            place = place[step]
        place[key] = value
    text = json.dumps(record).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(binary), len(text), b"JSON")
    return header + text + binary


def other_number(number):
    return BINARY[:8] + struct.pack("<f", number) + BINARY[12:]


BAD_GLB = {
    "only its name": b"glTF",
    "cut in its JSON": GOOD_GLB[:40],
    "without its binary part": GOOD_GLB[: 20 + JSON_SIZE],
    "a JSON of 4 GB": GOOD_GLB[:12] + b"\xff" * 4 + GOOD_GLB[16:],
    "no meshes": glb("meshes", []),
    "meshes by name": glb("meshes", {}),
    "meshes of null": glb("meshes", None),
    "no primitives": glb("meshes", 0, "primitives", 3),
    "positions of NaN": glb(binary=other_number(float("nan"))),
    "positions of 3e38": glb(binary=other_number(3e38)),
    "indices that are no integers": glb("accessors", INDICES, "componentType", 5126),
    **{
        f"accessor {key} {value!r}": glb("accessors", INDICES, key, value)
        for key in ("count", "byteOffset", "bufferView", "componentType", "type")
        for value in NO_NUMBERS
    },
    **{
        f"buffer view {key} {value!r}": glb("bufferViews", VIEW, key, value)
        for key in ("byteOffset", "byteLength")
        for value in NO_NUMBERS
    },
    **{
        f"position {value!r}": glb("meshes", 0, "primitives", 0, "attributes", "POSITION", value)
        for value in NO_NUMBERS
    },
}
TABLE = {
    **{f"JSON, {kind}": (".json", text.encode()) for kind, text in BAD_JSON.items()},
    **{f"glTF, {kind}": (".glb", data) for kind, data in BAD_GLB.items()},
}


@pytest.mark.parametrize("kind", TABLE)
def test_each_bad_mesh_has_its_sentence(tmp_path, kind):
    suffix, data = TABLE[kind]
    with pytest.raises(InputError) as caught:
        decode_mesh(data)
    assert 0 < len(str(caught.value)) <= 300
    assert "\n" not in str(caught.value)
    (tmp_path / f"bad{suffix}").write_bytes(data)
    inspection = inspect(tmp_path / f"bad{suffix}")
    assert inspection.problems == [str(caught.value)]


@pytest.mark.parametrize("data", [json_mesh(), spine(), glb()], ids=["JSON", "Spine", "glTF"])
def test_the_meshes_of_the_table_are_good_without_their_fault(data):
    mesh = decode_mesh(data if isinstance(data, bytes) else data.encode())
    assert mesh_defects(mesh) == []
    assert count_parts(mesh) == 1
