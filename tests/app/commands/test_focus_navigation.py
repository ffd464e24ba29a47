"""The keyboard focus: from the canvas to each panel and back."""

from imgui_bundle import imgui  # isort: skip
import pytest

from akap_editor.app.canvas.view_options import DISTORTION_RANGES
from akap_editor.app.commands.command import SHIFT, Key
from akap_editor.app.dialogs.first_steps import FirstSteps
from akap_editor.editor import gestures
from akap_editor.resources import bundled_drawings


@pytest.fixture(autouse=True)
def nothing_watched(module_window):
    yield
    module_window.window.after_draw.clear()


# -- the timeline -------------------------------------------------------------------------------------------


def test_keys_that_walk_a_panel_move_no_time(keyed):
    keyed.state.timeline.keyframe_playback.scrub(0.5)
    keyed.keys(Key.f6, Key.page_down, Key.end, Key.home)
    assert keyed.state.timeline.keyframe_playback.time == 0.5


# -- around the canvas --------------------------------------------------------------------------------------


def pane():
    window = imgui.get_current_context().nav_window
    return window.name if window is not None and imgui.get_io().nav_visible else ""


def test_f6_goes_to_every_pane_and_back_to_the_canvas(keyed):
    keyed.state.view.is_split, keyed.state.part(FirstSteps).is_open = True, True
    keyed.state.view.distortion_measure = "area"
    keyed.settle()
    panes = ["Panel", "Tools", "Timeline", "Comparison", "##legend", "First steps", "Options", "Tabs", ""]
    assert keyed.keys(*[Key.f6] * 9, look=pane) == panes
    assert keyed.keys(*[SHIFT | Key.f6] * 9, look=pane) == [*panes[-2::-1], ""]


def test_f6_stops_nowhere_else(ui):
    assert ui.keys(*[Key.f6] * 5, look=pane) == ["Panel", "Tools", "Options", "Tabs", ""]


def test_the_second_method_is_chosen_by_keys(pinned):
    pinned.state.view.is_split = True
    pinned.settle()
    before = pinned.state.comparison.spec
    pinned.keys(*[Key.f6] * 3, Key.space, Key.down_arrow, Key.space)
    assert pinned.state.comparison.spec != before


def test_the_range_of_the_scale_is_chosen_by_keys(ui):
    ui.state.view.distortion_measure = "area"
    ui.settle()
    ui.keys(SHIFT | Key.r)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 2.0
    ui.keys(*[Key.f6] * 3, Key.space)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 4.0
    ui.tab("Mesh")
    ui.walk_to("##range", Key.space, Key.up_arrow, Key.space)
    assert DISTORTION_RANGES[ui.state.view.distortion_range] == 2.0


def test_first_steps_are_put_away_by_keys(ui):
    ui.state.part(FirstSteps).is_open = True
    ui.settle()
    ui.keys(*[Key.f6] * 3, Key.space)
    assert not ui.state.part(FirstSteps).is_open


def test_lists_of_the_panel_are_walked_into(pinned):
    """From the name of the first pin down to the second one, and on to the third."""
    pinned.walk_to("**/###name 1", Key.down_arrow, Key.space)
    assert pinned.editor.selection == {2}
    pinned.walk_to("**/###name 1", *[Key.down_arrow] * 2, SHIFT | Key.space)
    assert pinned.editor.selection == {2, 3}


def test_a_pose_is_ordered_and_forgotten_from_its_menu(ui):
    for _ in range(3):
        gestures.add_pose(ui.editor)
    ui.settle()
    names = [pose.name for pose in ui.session.state.poses]
    ui.walk_to(f"**/pose {names[2]}", SHIFT | Key.f10, *[Key.down_arrow] * 3, Key.enter)
    assert [pose.name for pose in ui.session.state.poses] == [names[0], names[2], names[1]]
    ui.walk_to(f"**/pose {names[2]}", Key.menu, *[Key.down_arrow] * 5, Key.enter)
    assert [pose.name for pose in ui.session.state.poses] == [names[0], names[1]]


def test_keys_return_to_the_canvas(pinned):
    pinned.editor.select({2})
    y = pinned.pins[1].target[1]
    pinned.keys(Key.f6, Key.escape, Key.up_arrow)
    assert pinned.pins[1].target[1] == pytest.approx(y - 1)


@pytest.mark.parametrize(("chord", "name"), [(Key.f6, "Panel"), (SHIFT | Key.f6, "Tabs")])
def test_f6_goes_from_the_drawing_to_a_panel_and_escape_back(pinned, chord, name):
    pinned.editor.select({3})
    before = pinned.pin_position(3)
    seen = []

    def walk(hand):
        for key in (chord, Key.right_arrow, Key.escape, Key.right_arrow):
            hand.key_press(int(key))
            hand.yield_(2)
            window = imgui.get_current_context().nav_window
            moved = pinned.session.state.pin(3).target[0] - before[0]
            seen.append((window and window.name, imgui.get_io().nav_visible, round(float(moved))))

    pinned.do(walk)
    assert seen == [(name, True, 0), (name, True, 0), (None, False, 0), (None, False, 1)]


def test_a_drawing_is_opened_from_the_start_page_by_keys(pinned):
    pinned.editor.close()
    pinned.settle()
    pinned.key(Key.tab, Key.down_arrow, Key.enter)
    pinned.settle()
    assert pinned.document.drawing.name in [path.stem for path in bundled_drawings()]
    assert not imgui.get_io().nav_visible, "keys belong to the drawing"
