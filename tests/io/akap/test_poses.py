import json
import zipfile

import numpy as np
import pytest

from akap_editor.editor.document.named_poses import NamedPose
from akap_editor.errors import InputError
from akap_editor.io.akap.project import load, save


@pytest.fixture
def document(make_document, picture):
    dice = np.random.default_rng(3)
    poses = NamedPose("Wave «ä»", dice.normal(size=(4, 2))), NamedPose("Rest", dice.normal(size=(4, 2)))
    return make_document(picture, poses=poses)


def changed(path, entries):
    """The file again, with other contents of some entries, or without them."""
    with zipfile.ZipFile(path) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    content.update(entries)
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in content.items():
            if data is not None:
                archive.writestr(name, data)


def test_poses_come_back_bit_for_bit_in_their_order(document, tmp_path):
    save(document, tmp_path / "a.akap")
    again = load(tmp_path / "a.akap").state.poses
    assert [pose.name for pose in again] == ["Wave «ä»", "Rest"]
    for pose, kept in zip(again, document.state.poses, strict=True):
        np.testing.assert_array_equal(pose.positions, kept.positions)


def test_without_poses_the_file_has_no_entries_for_them(make_document, picture, tmp_path):
    save(make_document(picture), tmp_path / "a.akap")
    with zipfile.ZipFile(tmp_path / "a.akap") as archive:
        assert not any("poses" in name for name in archive.namelist())
    assert load(tmp_path / "a.akap").state.poses == ()


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"poses.json": b"["}, "poses.json: expected JSON"),
        ({"poses.json": b"{}"}, "poses.json: expected poses to be a list"),
        ({"poses.json": b'{"poses": ["a", "a"]}'}, "poses.json: expected names"),
        ({"poses.json": b'{"poses": [1, 2]}'}, "poses.json: expected names"),
        ({"poses.json": b'{"poses": ["", "b"]}'}, "poses: .* a name of 1 to"),
        ({"poses.json": json.dumps({"poses": [str(k) for k in range(1001)]}).encode()}, "at most 1000"),
        ({"poses/1": None}, "poses/1"),
        ({"poses/1": b"short"}, "poses/1"),
        ({"poses/0": np.full(8, np.nan).tobytes()}, "poses: pose: expected"),
    ],
)
def test_bad_poses_are_refused_in_one_sentence(document, tmp_path, entries, message):
    save(document, tmp_path / "a.akap")
    changed(tmp_path / "a.akap", entries)
    with pytest.raises(InputError, match=message):
        load(tmp_path / "a.akap")
