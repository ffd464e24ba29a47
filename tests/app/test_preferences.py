"""What is remembered between runs, and files of preferences that are no good."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from akap_editor.app import files
from akap_editor.app import preferences as module
from akap_editor.app.app_state import AppState
from akap_editor.app.canvas.view_options import DISTORTION_RANGES, ViewOptions
from akap_editor.app.preferences import MAX_RECENT, Preferences, preferences_path
from akap_editor.editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from akap_editor.editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS, Brush
from akap_editor.errors import InputError
from akap_editor.io.images import read_image
from akap_editor.resources import resource


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


def test_overlays_come_back(path, tmp_path):
    picture = tmp_path / "behind.png"
    picture.write_bytes(resource("assets", "drawings", "bar.png").read_bytes())
    state = AppState.from_preferences(Preferences(path))
    state.view.show_vector_fields = state.view.show_rest_pose = state.view.show_pin_trails = True
    state.view.distortion_measure, state.view.distortion_range = "angle", 4
    state.view.set_reference(np.zeros((1, 1, 4), np.uint8), picture)
    state.view.show_reference = False
    state.editor.brush_tool.brush = Brush(80.0, 500.0, erasing=True)
    state.save_preferences()
    again = AppState.from_preferences(Preferences(path))
    for name in (
        "show_vector_fields",
        "show_rest_pose",
        "show_pin_trails",
        "distortion_measure",
        "distortion_range",
        "show_reference",
        "reference_path",
    ):
        assert getattr(again.view, name) == getattr(state.view, name), name
    assert again.view.reference is None, "a start must not wait for it"
    while again.needs_frame:
        again.run_pending()
    assert again.view.reference is not None
    assert again.view.reference.image.shape == read_image(picture).shape
    assert not again.view.show_reference
    assert again.editor.brush_tool.brush == Brush(80.0, 500.0)


def test_a_reference_picture_that_is_gone_is_not_missed(path, tmp_path):
    state = AppState.from_preferences(Preferences(path))
    state.view.set_reference(np.zeros((1, 1, 4), np.uint8), tmp_path / "gone.png")
    state.save_preferences()
    again = AppState.from_preferences(Preferences(path))
    while again.needs_frame:
        again.run_pending()
    assert (again.view.reference, again.view.reference_path, again.error) == (None, None, "")


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


@pytest.mark.parametrize("brush", [[1e9, -1.0], [float("nan")] * 2, ["a", 2], [3], {}])
def test_a_remembered_brush_is_one_that_there_is(brush):
    preferences = Preferences()
    preferences.put("brush", brush)
    found = AppState.from_preferences(preferences).editor.brush_tool.brush
    assert MIN_RADIUS <= found.radius <= MAX_RADIUS
    assert MIN_STIFFNESS <= found.factor <= MAX_STIFFNESS


# -- in the window ------------------------------------------------------------------------------------------


@pytest.fixture
def keeping(ui, path):
    """The window with preferences in a file."""
    ui.state.preferences = Preferences(path)
    return ui


def test_switches_and_folded_sections_come_back(keeping, path):
    keeping.panel("Checkerboard")
    keeping.panel("###section View")
    keeping.do(lambda hand: [] if not hand.item_exists("//Panel/Mesh") else pytest.fail("View is folded"))
    keeping.window.remember()
    again = AppState.from_preferences(Preferences(path))
    assert not again.view.show_checkerboard
    assert again.view.show_mesh == keeping.state.view.show_mesh
    assert again.timeline.is_shown == keeping.state.timeline.is_shown
    assert again.preferences.get("sections", {}) == {"View": False}
    assert again.preferences.get("window", []) == [1280, 800]


def test_unfolded_parameters_come_back(keeping, path):
    keeping.panel("Parameters")
    keeping.window.remember()
    keeping.state.preferences = Preferences(path)
    keeping.settle()
    keeping.panel("Parameters/memory/##value")
    keeping.panel("Parameters")
    assert keeping.state.preferences.get("sections", {}) == {"Parameters": False}


def test_files_that_were_opened_and_saved_are_recent_and_bundled_ones_are_not(keeping, tmp_path):
    state = keeping.state
    files.open_path(state, resource("assets", "drawings", "bar.png"))
    keeping.settle()
    assert state.document.drawing.name == "bar"
    assert state.preferences.recent == []
    files.write_document(state, tmp_path / "bar.akap")
    assert state.preferences.recent == [tmp_path / "bar.akap"]
    files.open_path(state, tmp_path / "bar.akap")
    keeping.settle()
    (tmp_path / "bar.akap").unlink()
    files.open_path(state, tmp_path / "bar.akap")
    keeping.settle()
    assert "no such file" in state.error
    assert state.preferences.recent == [], "what cannot be opened is not offered again"


def test_preferences_that_cannot_be_written_are_a_notice_and_no_more(ui, tmp_path):
    (tmp_path / "file").write_text("")
    ui.state.preferences = Preferences(tmp_path / "file" / "preferences.json")
    ui.window.remember()
    assert ui.state.notice.startswith(f"Couldn't save “{tmp_path}/file/preferences.json”. ")
    ui.state.notice = ""
    ui.panel("Mesh")
    ui.window.remember()
    assert not ui.state.notice
