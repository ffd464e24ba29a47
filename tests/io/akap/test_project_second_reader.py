"""What the file format's page says is enough: another reader gets the same, and refuses the same."""

import json
import zipfile
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor.document.document import Document, EditState, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.io.akap.pose import encode_pose
from akap_editor.io.akap.project import decode_document, encode_document, load
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.second_reader import FormatError, check_mesh, read_akap, read_pose

FIXTURE = Path(__file__).with_name("version1.akap")


def assert_same(read: dict, document: Document) -> None:
    mesh, state = document.drawing.mesh, document.state
    for name, expected in [
        ("vertices", mesh.vertices),
        ("faces", mesh.faces),
        ("uv", document.drawing.uv),
        ("positions", state.positions),
        ("picture", document.drawing.image),
    ]:
        assert read[name].shape == expected.shape
        assert read[name].tobytes() == expected.tobytes()
    assert read["name"] == document.drawing.name
    assert read["tied"] == mesh.tied
    assert Settings(read["method"], tuple(read["parameters"].items())) == state.settings
    assert_same_pins(read["pins"], state.pins)


def assert_same_pins(records, pins) -> None:
    assert [(pin["id"], pin["face"]) for pin in records] == [(pin.id, pin.face) for pin in pins]
    for record, pin in zip(records, pins, strict=True):
        assert np.array(record["weights"], float).tobytes() == pin.weights.tobytes()
        assert np.array(record["target"], float).tobytes() == pin.target.tobytes()


def test_another_reader_gets_the_same(document):
    assert_same(read_akap(encode_document(document)), document)


def test_another_reader_gets_the_same_from_a_cartoon():
    image = read_image(resource("assets", "drawings", "alien.png"))
    document = new_document(make_drawing(image, vertices=400, name="alien"))
    pose = document.drawing.mesh.vertices * 0.9 + np.pi
    document = document.with_state(replace(document.state, positions=pose))
    assert_same(read_akap(encode_document(document)), document)
    read = read_pose(encode_pose(document), document.drawing.mesh.vertices, document.drawing.mesh.faces)
    assert read["positions"].tobytes() == pose.tobytes()


def test_a_file_of_version_1_opens_in_all_later_versions():
    """The file was written by the first version and is never written again."""
    document = load(FIXTURE)
    assert_same(read_akap(FIXTURE.read_bytes()), document)
    assert document.drawing.name == "Ei, ünïcode 卵"
    assert document.drawing.size == (90, 60)
    assert [pin.id for pin in document.state.pins] == [1, 2, 3]
    assert document.state.settings == Settings("akap", (("memory", 0.5),))
    assert document.drawing.mesh.tied
    arrived = document.drawing.mesh.evaluate(document.state.points, document.state.positions)
    assert np.abs(arrived - document.state.targets).max() < 0.25


def test_another_reader_gets_the_same_pose(document):
    mesh = document.drawing.mesh
    read = read_pose(encode_pose(document), mesh.vertices, mesh.faces)
    assert read["positions"].tobytes() == document.state.positions.tobytes()
    assert_same_pins(read["pins"], document.state.pins)


def test_another_reader_refuses_what_is_not_as_the_page_says(document):
    bad = replace(document.state.settings, method=5)
    state = EditState(document.state.pins, document.state.positions, bad)
    with pytest.raises(FormatError):
        read_akap(encode_document(document.with_state(state)))
    with pytest.raises(FormatError, match="positive signed areas"):
        check_mesh(document.drawing.mesh.vertices, document.drawing.mesh.faces[:, ::-1])


def test_optional_keys_have_the_defaults_of_the_page(document):
    buffer = BytesIO()
    with zipfile.ZipFile(BytesIO(encode_document(document))) as archive, zipfile.ZipFile(buffer, "w") as copy:
        for name in archive.namelist():
            content = archive.read(name)
            if name == "document.json":
                record = json.loads(content)
                del record["program"], record["mesh"]["tied"]
                content = json.dumps(record).encode()
            if name != "thumbnail.png":
                copy.writestr(name, content)
        copy.writestr("../unknown/entry", b"is ignored")
    opened = decode_document(buffer.getvalue())
    assert opened.drawing.mesh.tied
    assert_same(read_akap(buffer.getvalue()), opened)
