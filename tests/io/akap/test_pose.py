"""Poses that are carried from one session to another, and files that are none."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.editor import Editor
from akap_editor.errors import InputError
from akap_editor.io.akap import pose as pose_file
from akap_editor.io.akap.pose import decode_pose, encode_pose, load_pose, save_pose
from akap_editor.io.akap.project import load

FIXTURE = Path(__file__).with_name("version1.pose.json")


def same_pins(pins, others):
    assert [(pin.id, pin.face) for pin in pins] == [(pin.id, pin.face) for pin in others]
    for pin, other in zip(pins, others, strict=True):
        assert pin.weights.tobytes() == other.weights.tobytes()
        assert pin.target.tobytes() == other.target.tobytes()


def test_round_trip_is_exact(document, tmp_path):
    path = tmp_path / "a.pose.json"
    save_pose(document, path)
    pose = load_pose(path, document.drawing)
    assert pose.positions.tobytes() == document.state.positions.tobytes()
    same_pins(pose.pins, document.state.pins)


def test_file_of_version_1_opens():
    drawing = load(FIXTURE.with_name("version1.akap")).drawing
    pose = load_pose(FIXTURE, drawing)
    record = json.loads(FIXTURE.read_bytes())
    assert pose.positions.tolist() == record["positions"]
    assert [pin.id for pin in pose.pins] == [pin["id"] for pin in record["pins"]]


def test_applying_is_one_gesture_that_keeps_the_pose(make_document, picture):
    document = make_document(picture, pins=(Pin(3, 1, [0.5, 0.25, 0.25], [2.0, 2.0]),))
    pose = decode_pose(encode_pose(document), document.drawing)
    editor = Editor()
    editor.open(make_document(picture, pins=(), positions=document.drawing.mesh.vertices))
    before = editor.session.state
    gestures.apply_pose(editor, pose.pins, pose.positions)
    state = editor.session.state
    assert state.positions.tobytes() == document.state.positions.tobytes()
    assert [(pin.id, pin.face, pin.weights.tolist()) for pin in state.pins] == [(3, 1, [0.5, 0.25, 0.25])]
    assert not editor.is_moving
    assert editor.session.pin_error() == 0
    assert editor.session.history.undo_label == "Apply Pose"
    editor.undo()
    assert editor.session.state is before


def test_a_pose_of_another_mesh_is_refused(make_document, picture):
    data = encode_pose(make_document(picture))
    other = make_document(np.zeros((9, 9, 4), np.uint8)).drawing
    with pytest.raises(
        InputError, match=r"expected a pose of this very mesh, with 4 vertices, got one of .*'square' with 4"
    ):
        decode_pose(data, other)


def test_what_could_not_be_read_again_is_not_written(document, make_document, picture, tmp_path, monkeypatch):
    path = tmp_path / "a.pose.json"
    path.write_bytes(b"old")
    bad = make_document(picture, positions=np.full((4, 2), np.nan))
    with pytest.raises(InputError, match=r"^Couldn't save “.*a\.pose\.json”\. positions: expected finite"):
        save_pose(bad, path)
    monkeypatch.setattr(pose_file, "MAX_POSE_BYTES", 100)
    with pytest.raises(InputError, match="Expected a pose of at most 100 bytes, got"):
        save_pose(document, path)
    assert path.read_bytes() == b"old"


CHANGES = [
    ({"format": "akap"}, "expected format 'akap-pose', got 'akap'"),
    ({"version": 2}, r"newer version of the program \(file version 2, this program reads up to 1\)"),
    ({"version": 0}, "expected a version from 1, got 0"),
    ({"drawing": {}}, "expected mesh to be a text, but it is missing"),
    ({"positions": [[0, 0]] * 3}, r"positions: expected shape \(4, 2\), got \(3, 2\)"),
    ({"positions": [[0, 0]] * 3 + [[0]]}, "expected positions to be pairs of numbers, got"),
    ({"positions": [0, 0] * 4}, "expected positions to be pairs of numbers, got"),
    ({"positions": [[0, 1e999]] * 4}, "expected finite numbers, got Infinity"),
    ({"positions": [[0, True]] * 4}, "expected positions to be numbers, got"),
    ({"positions": [[0, None]] * 4}, "expected positions to be numbers, got"),
    ({"positions": [["0", "1"]] * 4}, "expected positions to be numbers, got"),
    ({"positions": {}}, "expected positions to be a list, got {}"),
    ({"pins": [{"id": 1}]}, "expected weights to be a list, but it is missing"),
    ({"pins": [{"id": 1, "face": 2, "weights": [1, 0, 0], "target": [0, 0]}]}, "expected a face from 0 to 1"),
]


@pytest.mark.parametrize(("change", "message"), CHANGES, ids=lambda part: str(part)[:40])
def test_wrong_files_are_refused(document, tmp_path, change, message):
    path = tmp_path / "bad.pose.json"
    path.write_text(json.dumps(json.loads(encode_pose(document)) | change))
    with pytest.raises(InputError, match=rf"(?i)^Couldn't open “.*bad\.pose\.json”\. .*{message}"):
        load_pose(path, document.drawing)


@pytest.mark.parametrize("data", [b"", b"\xff", b"[]", b"[" * 10**6, b'{"a":1,"a":2}', bytes(100)])
def test_other_files_are_refused(document, data):
    with pytest.raises(InputError, match="expected"):
        decode_pose(data, document.drawing)


def test_unknown_keys_are_ignored(document):
    record = json.loads(encode_pose(document)) | {"later": 1}
    pose = decode_pose(json.dumps(record).encode(), document.drawing)
    same_pins(pose.pins, replace(document.state).pins)
