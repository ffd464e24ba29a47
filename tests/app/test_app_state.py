"""What the state of the window stores in the preferences and restores from them."""

import json
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.app import files
from akap_editor.app.app_state import AppState
from akap_editor.app.preferences import Preferences
from akap_editor.deform.follow_through import MAX_BOUNCE, MAX_SPEED, MIN_SPEED
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.document.stiffness import MAX_STIFFNESS, MIN_STIFFNESS
from akap_editor.editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS, Brush
from akap_editor.io.images import read_image
from akap_editor.resources import resource


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "preferences.json"


def test_overlays_come_back(path, tmp_path):
    picture = tmp_path / "behind.png"
    picture.write_bytes(resource("assets", "drawings", "bar.png").read_bytes())
    state = AppState.from_preferences(Preferences(path))
    state.view.show_vector_fields = state.view.show_rest_pose = state.view.show_pin_trails = True
    state.view.distortion_measure, state.view.distortion_range = "angle", 4
    state.view.set_reference(np.zeros((1, 1, 4), np.uint8), picture)
    state.view.show_reference = False
    state.editor.brush_tool.brush = Brush(80.0, 500.0, erasing=True, paints="loose", speed=2.0, bounce=0.25)
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
    assert again.editor.brush_tool.brush == replace(state.editor.brush_tool.brush, erasing=False)


def test_a_reference_picture_that_is_gone_is_not_missed(path, tmp_path):
    state = AppState.from_preferences(Preferences(path))
    state.view.set_reference(np.zeros((1, 1, 4), np.uint8), tmp_path / "gone.png")
    state.save_preferences()
    again = AppState.from_preferences(Preferences(path))
    while again.needs_frame:
        again.run_pending()
    assert (again.view.reference, again.view.reference_path, again.error) == (None, None, "")


@pytest.mark.parametrize(
    "brush",
    [
        [1e9, -1.0],
        [float("nan")] * 2,
        ["a", 2],
        [3],
        {},
        [100.0, 32.0, "loose", 1e9, 1e9],
        [100.0, 32.0, "loose", -1.0, float("nan")],
        [100.0, 32.0, "wet", 2.0, 0.5],
    ],
)
def test_a_remembered_brush_is_one_that_there_is(brush):
    preferences = Preferences()
    preferences.put("brush", brush)
    found = AppState.from_preferences(preferences).editor.brush_tool.brush
    assert MIN_RADIUS <= found.radius <= MAX_RADIUS
    assert MIN_STIFFNESS <= found.factor <= MAX_STIFFNESS
    assert found.paints in ("stiff", "loose")
    assert MIN_SPEED <= found.speed <= MAX_SPEED
    assert 0 <= found.bounce <= MAX_BOUNCE


def test_a_brush_of_an_earlier_version_is_remembered():
    preferences = Preferences()
    preferences.put("brush", [300.0, 20.0])
    assert AppState.from_preferences(preferences).editor.brush_tool.brush == Brush(20.0, 300.0)


@pytest.fixture
def keeping(ui, path):
    """The window with preferences in a file."""
    ui.state.preferences = Preferences(path)
    return ui


def test_switches_and_folded_sections_come_back(keeping, path):
    keeping.tab("Mesh")
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
    keeping.panel("Advanced")
    keeping.window.remember()
    keeping.state.preferences = Preferences(path)
    keeping.settle()
    keeping.panel("memory/##value")
    keeping.panel("Advanced")
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
    ui.panel("Remember rest shape")
    ui.window.remember()
    assert not ui.state.notice


def test_a_new_drawing_bends_as_was_chosen_last_also_in_another_run(tmp_path, document):
    path = tmp_path / "preferences.json"
    first = AppState(preferences=Preferences(path))
    files.show_document(first, document)
    assert first.document.state.settings == Settings()
    chosen = Settings("arap", (("iterations", 7),))
    first.change_settings(chosen)
    first.preferences.write()
    second = AppState(preferences=Preferences(path))
    files.show_document(second, document)
    assert second.document.state.settings == chosen
    assert second.editor.session.history.depth == 0
    assert not second.editor.is_modified


def test_a_drawing_with_settings_of_its_own_keeps_them(document, drawing):
    state = AppState()
    files.show_document(state, document)
    state.change_settings(Settings("arap", ()))
    files.show_document(state, new_document(drawing, Settings("mls", ())))
    assert state.document.state.settings.method == "mls"


@pytest.mark.parametrize(
    "remembered",
    [
        {"method": "no such", "parameters": {}},
        {"method": "akap", "parameters": {"no such": 1}},
        {"method": "akap", "parameters": {"memory": 7}},
        {"method": "akap", "parameters": {"memory": "much"}},
        {"method": 3},
        {"parameters": []},
    ],
)
def test_remembered_settings_that_make_no_sense_are_ignored(tmp_path, document, remembered):
    path = tmp_path / "preferences.json"
    path.write_text(json.dumps({"settings": remembered}))
    state = AppState(preferences=Preferences(path))
    files.show_document(state, document)
    assert state.document.state.settings == Settings()
