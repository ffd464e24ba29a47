"""What is remembered between runs, and files of preferences that are no good."""

import json
import sys
from pathlib import Path

import pytest

from akap_editor.app import preferences as module
from akap_editor.app.app_state import AppState
from akap_editor.app.canvas.view_options import DISTORTION_RANGES, ViewOptions
from akap_editor.app.preferences import MAX_RECENT, Preferences, preferences_path
from akap_editor.errors import InputError


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "preferences.json"


def test_values_come_back_in_the_next_run(path):
    values = {
        "text": "ä 🐘",
        "number": 3,
        "share": 0.1,
        "list": [1, [2]],
        "object": {"a": {}},
        "on": True,
    }
    first = Preferences(path)
    for name, value in values.items():
        first.put(name, value)
    first.write()
    second = Preferences(path)
    assert not second.problem
    for name, value in values.items():
        assert second.get(name, type(value)()) == value


def test_a_value_of_another_type_counts_as_none(path):
    path.parent.mkdir()
    path.write_text('{"size": "large", "on": 1, "scale": 2, "count": true, "nothing": null}')
    preferences = Preferences(path)
    assert preferences.get("size", [1, 2]) == [1, 2]
    assert preferences.get("on", False) is False
    assert preferences.get("count", 7) == 7
    assert preferences.get("nothing", "x") == "x"
    scale = preferences.get("scale", 1.0)
    assert scale == 2.0
    assert isinstance(scale, float)


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[1]", b"\xff\xfe\x00", b"[" * 100_000, b'"text"', b"nul"], ids=range(7)
)
def test_a_corrupt_file_is_told_and_replaced_at_the_next_write(path, content):
    path.parent.mkdir()
    path.write_bytes(content)
    preferences = Preferences(path)
    assert str(path) in preferences.problem
    assert "\n" not in preferences.problem
    assert preferences.recent == []
    assert AppState.from_preferences(preferences).notice == preferences.problem
    preferences.write()
    assert path.read_bytes() == content, "nothing has changed, so nothing is written"
    preferences.put("name", 1)
    preferences.write()
    assert json.loads(path.read_text()) == {"name": 1}


def test_two_programs_at_once_keep_what_the_other_one_changed(path):
    one, other = Preferences(path), Preferences(path)
    one.put("a", 1)
    one.write()
    other.put("b", 2)
    other.write()
    assert json.loads(path.read_text()) == {"a": 1, "b": 2}


def test_nothing_is_written_where_nothing_changed(path):
    preferences = Preferences(path)
    preferences.put("a", (1, 2))
    preferences.write()
    path.unlink()
    preferences.put("a", [1, 2])
    preferences.write()
    assert not path.exists()


def test_what_json_cannot_hold_is_refused(path):
    with pytest.raises(TypeError):
        Preferences(path).put("path", Path())


def test_a_folder_that_cannot_be_made_is_told_once(tmp_path):
    (tmp_path / "file").write_text("")
    preferences = Preferences(tmp_path / "file" / "preferences.json")
    preferences.put("a", 1)
    with pytest.raises(InputError):
        preferences.write()
    preferences.put("a", 2)
    preferences.write()
    assert preferences.get("a", 0) == 2


def test_the_folder_is_the_one_of_the_environment_or_of_the_platform(monkeypatch, tmp_path):
    monkeypatch.setenv(module.CONFIG_FOLDER_VARIABLE, str(tmp_path))
    assert preferences_path() == tmp_path / "preferences.json"
    monkeypatch.delenv(module.CONFIG_FOLDER_VARIABLE)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    folder = preferences_path().parent
    assert folder.name == "akap-editor"
    if sys.platform.startswith("linux"):
        assert folder.parent == tmp_path / "config"


def test_recent_files_are_the_newest_first_each_once(path, tmp_path):
    preferences = Preferences(path)
    files = [tmp_path / f"{number}.png" for number in range(MAX_RECENT + 3)]
    for file in files:
        preferences.add_recent(file)
    preferences.add_recent(files[5])
    expected = [files[5], *(file for file in reversed(files) if file != files[5])]
    assert preferences.recent == expected[:MAX_RECENT]
    preferences.remove_recent(files[5])
    assert preferences.recent == expected[1:MAX_RECENT]
    preferences.put("recent", ["a", 1, None])
    assert preferences.recent == [Path("a")]


def test_overlays_that_make_no_sense_are_passed_over():
    view = ViewOptions()
    view.restore({"vectors": 1, "ghost": True, "heat": ["area"], "range": "wide", "reference": 3})
    assert (view.show_vector_fields, view.show_rest_pose, view.distortion_measure, view.distortion_range) == (
        False,
        True,
        None,
        ViewOptions.distortion_range,
    )
    assert view.reference_path is None
    view.restore({"range": DISTORTION_RANGES[0]})
    assert view.distortion_range == 0
