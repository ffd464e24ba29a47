"""Named poses and keyframes in .akap files."""

import json
import zipfile

import numpy as np
import pytest

from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.named_poses import NamedPose
from akap_editor.errors import InputError
from akap_editor.io.akap.project import load, save


def change_entries(path, entries):
    """Rewrite an archive with other contents of some entries; None removes an entry."""
    with zipfile.ZipFile(path) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    content.update(entries)
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in content.items():
            if data is not None:
                archive.writestr(name, data)


# -- named poses -----------------------------------------------------------------------------------------


@pytest.fixture
def posed(make_document, picture):
    dice = np.random.default_rng(3)
    poses = NamedPose("Wave «ä»", dice.normal(size=(4, 2))), NamedPose("Rest", dice.normal(size=(4, 2)))
    return make_document(picture, poses=poses)


def test_poses_come_back_bit_for_bit_in_their_order(posed, tmp_path):
    save(posed, tmp_path / "a.akap")
    again = load(tmp_path / "a.akap").state.poses
    assert [pose.name for pose in again] == ["Wave «ä»", "Rest"]
    for pose, kept in zip(again, posed.state.poses, strict=True):
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
def test_bad_poses_are_refused_in_one_sentence(posed, tmp_path, entries, message):
    save(posed, tmp_path / "a.akap")
    change_entries(tmp_path / "a.akap", entries)
    with pytest.raises(InputError, match=message):
        load(tmp_path / "a.akap")


# -- keyframes -------------------------------------------------------------------------------------------


@pytest.fixture
def keyed(make_document, picture):
    dice = np.random.default_rng(3)
    first, second = (dice.normal(size=(4, 2)) for _ in range(2))
    first.flags.writeable = False
    start = Keyframe(0, first)
    keys = start, Keyframe(0.25, second, "hold"), Keyframe(1.5, start.positions)
    return make_document(picture, animation=Animation(keys, "out", loop=False))


def index(**values):
    keys = [{"time": 0, "pose": 0}, {"time": 1, "pose": 0}]
    return {"animation.json": json.dumps({"ease": "in", "poses": 1, "keyframes": keys} | values).encode()}


def test_keyframes_come_back_bit_for_bit_and_share_their_poses(keyed, tmp_path):
    save(keyed, tmp_path / "a.akap")
    again, kept = load(tmp_path / "a.akap").state.animation, keyed.state.animation
    assert again.ease == "out"
    assert not again.loop
    assert [(key.time, key.ease) for key in again.keyframes] == [(0, None), (0.25, "hold"), (1.5, None)]
    for key, old in zip(again.keyframes, kept.keyframes, strict=True):
        np.testing.assert_array_equal(key.positions, old.positions)
    with zipfile.ZipFile(tmp_path / "a.akap") as archive:
        assert [name for name in archive.namelist() if name.startswith("animation/")] == [
            "animation/0",
            "animation/1",
        ]


def test_without_keyframes_the_file_has_no_entries_for_them(make_document, picture, tmp_path):
    save(make_document(picture), tmp_path / "a.akap")
    with zipfile.ZipFile(tmp_path / "a.akap") as archive:
        assert not any("animation" in name for name in archive.namelist())
    assert load(tmp_path / "a.akap").state.animation.keyframes == ()


def test_a_reader_takes_the_defaults_of_what_is_missing(keyed, tmp_path):
    save(keyed, tmp_path / "a.akap")
    record = json.loads(index()["animation.json"])
    del record["ease"]
    assert "loop" not in record
    change_entries(tmp_path / "a.akap", {"animation.json": json.dumps(record).encode()})
    animation = load(tmp_path / "a.akap").state.animation
    assert animation.ease == "in-out"
    assert animation.loop


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"animation.json": b"["}, "animation.json: expected JSON"),
        ({"animation.json": b"{}"}, "animation.json: expected keyframes to be a list"),
        (index(keyframes=[1], poses=0), "expected keyframes to be objects, got 1"),
        (index(keyframes=[{"time": 0, "pose": 1}]), "expected a pose below 1, got 1"),
        (index(keyframes=[{"pose": 0}]), "expected time to be numbers"),
        (index(keyframes=[{"time": -1, "pose": 0}]), "time of a keyframe: expected"),
        (index(keyframes=[{"time": 1, "pose": 0}] * 2), "expected times that grow"),
        (index(keyframes=[{"time": 1, "pose": 0, "ease": "up"}]), "ease: expected one of"),
        (index(ease="up"), "ease: expected one of"),
        (index(ease=1), "expected ease to be a text"),
        (index(loop=1), "expected loop to be"),
        (index(poses=3), "poses to be a number from 0 to 2, got 3"),
        (index(poses=-1), "poses to be a number"),
        (index(keyframes=[{"time": k, "pose": 0} for k in range(10_001)]), "at most 10000 keyframes"),
        ({"animation/1": None}, "animation/1"),
        ({"animation/1": b"short"}, "animation/1"),
        ({"animation/0": np.full(8, np.nan).tobytes()}, "keyframe: expected"),
    ],
)
def test_bad_keyframes_are_refused_in_one_sentence(keyed, tmp_path, entries, message):
    save(keyed, tmp_path / "a.akap")
    change_entries(tmp_path / "a.akap", entries)
    with pytest.raises(InputError, match=message):
        load(tmp_path / "a.akap")


def test_keyframes_that_share_a_pose_share_it_after_opening_too(keyed, tmp_path):
    save(keyed, tmp_path / "a.akap")
    again = load(tmp_path / "a.akap")
    for state in (keyed.state, again.state):
        keys = state.animation.keyframes
        assert len({id(key.positions) for key in keys}) < len(keys)
    save(again, tmp_path / "b.akap")
    assert (tmp_path / "a.akap").read_bytes() == (tmp_path / "b.akap").read_bytes()


def test_what_a_document_may_expand_to_is_a_sum(posed, tmp_path, monkeypatch):
    save(posed, tmp_path / "a.akap")
    with zipfile.ZipFile(tmp_path / "a.akap") as archive:
        largest = max(entry.file_size for entry in archive.infolist())
    monkeypatch.setattr("akap_editor.io.akap.archive.MAX_EXPANDED_BYTES", 2 * largest)
    with pytest.raises(InputError, match=f"xpected at most {2 * largest} bytes in all"):
        load(tmp_path / "a.akap")
    with pytest.raises(InputError, match=f"xpected at most {2 * largest} bytes in all"):
        save(posed, tmp_path / "b.akap")
