"""The brush that paints stiffness, and what becomes of what it has painted."""

from dataclasses import replace

import numpy as np

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.remesh import transfer_state
from akap_editor.editor.document.rest_pose import with_pose_as_rest
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.document.stiffness import stroke_coverage
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.replay import replay
from akap_editor.editor.tools.stiffness_brush import MAX_RADIUS, MIN_RADIUS, Brush
from akap_editor.geometry.distortion import distortion
from tests.support.editor_driver import Driver, bits
from tests.support.meshers import needs_triangle
from tests.support.puppets import ARM, BODY, SKULL, puppet

NECK, HEAD = (80.0, 40.0), (30.0, 40.0)


def stroke(
    d: Driver, *places: tuple[float, float], button: str = "left", release: bool = True, radius: float = 12.0
) -> None:
    """Paint through places of the drawing."""
    d.editor.chosen_tool = d.editor.brush_tool
    brush_tool = d.editor.brush_tool
    brush_tool.brush = replace(brush_tool.brush, radius=radius * d.editor.camera.zoom)
    on_screen = [d.editor.camera.to_screen(place) for place in places]
    d.handle(PointerEvent("press", on_screen[0], button))  # type: ignore[arg-type]
    for at in on_screen[1:]:
        d.handle(PointerEvent("move", at, button))  # type: ignore[arg-type]
    if release:
        d.handle(PointerEvent("release", on_screen[-1], button))  # type: ignore[arg-type]


def at(d: Driver, place: tuple[float, float]) -> float:
    """The factor of the face at a place of the rest pose."""
    stiffness = d.state.stiffness
    found = d.session.drawing.mesh.find(place)
    return 1.0 if stiffness is None else float(stiffness[found.faces[0]])


def test_a_click_with_shift_paints_a_straight_line_from_the_end_of_the_last_stroke(pinned):
    stroke(pinned, (20.0, 40.0))
    assert at(pinned, (60.0, 40.0)) == 1.0
    place = pinned.editor.camera.to_screen((100.0, 40.0))
    for kind in ("press", "release"):
        pinned.handle(PointerEvent(kind, place, shift=True))
    stiff = [at(pinned, (x, 40.0)) for x in (20.0, 40.0, 60.0, 80.0, 100.0)]
    assert min(stiff) == max(stiff) == 100.0
    pinned.undo()
    assert at(pinned, (60.0, 40.0)) == 1.0
    assert at(pinned, (20.0, 40.0)) == 100.0


@needs_triangle
def test_shift_without_an_earlier_stroke_paints_where_it_is(pinned):
    pinned.editor.chosen_tool = pinned.editor.brush_tool
    place = pinned.editor.camera.to_screen((100.0, 40.0))
    for kind in ("press", "release"):
        pinned.handle(PointerEvent(kind, place, shift=True))
    assert at(pinned, (100.0, 40.0)) == 100.0
    assert at(pinned, (30.0, 40.0)) == 1.0


def test_a_stroke_stiffens_what_it_covers_and_is_one_entry(pinned):
    before, pose = bits(pinned.state), pinned.state.positions
    stroke(pinned, (70.0, 40.0), (95.0, 40.0))
    assert [at(pinned, (x, 40.0)) for x in (72.0, 82.0, 94.0)] == [100.0] * 3
    assert at(pinned, HEAD) == 1.0
    assert pinned.state.positions is pose
    assert not pinned.state.stiffness.flags.writeable
    assert pinned.session.history.undo_label == "Paint Stiffness"
    pinned.undo()
    assert pinned.state.stiffness is None
    assert bits(pinned.state) == before
    pinned.redo()
    assert at(pinned, NECK) == 100.0


def test_what_is_stiff_bends_less(new_driver):
    bent = []
    for stiff in (False, True):
        d = new_driver()
        for place in ((20.0, 40.0), (105.0, 40.0)):
            d.click(place)
        if stiff:
            stroke(d, (62.0, 40.0), (88.0, 40.0))
            d.editor.chosen_tool = d.editor.pins_tool
        d.drag((105.0, 40.0), (70.0, 70.0))
        d.settle()
        faces = stroke_coverage(d.session.drawing.mesh, [(x, 40.0) for x in range(62, 89, 2)], 12.0) == 1.0
        found = distortion(d.session.drawing.mesh, d.state.positions)
        bent.append(float((found.face_angle[faces] - 2.0).mean()))
    assert bent[1] < 0.2 * bent[0]


def test_the_eraser_and_the_right_button_take_it_away(pinned):
    stroke(pinned, NECK)
    stroke(pinned, NECK, button="right")
    assert at(pinned, NECK) == 1.0
    stroke(pinned, NECK)
    pinned.editor.brush_tool.brush = Brush(pinned.editor.brush_tool.brush.radius, erasing=True)
    stroke(pinned, (70.0, 40.0), (80.0, 40.0), (90.0, 40.0), radius=30.0)
    assert pinned.state.stiffness is None, "where all is erased nothing is left"
    assert pinned.session.history.labels == ["Add Pin"] * 3 + ["Paint Stiffness", "Erase Stiffness"] * 2


def test_escape_takes_the_stroke_back_and_shows_what_was_before(pinned):
    before = pinned.everything
    stroke(pinned, NECK, release=False)
    assert pinned.editor.tool.shown_stiffness.max() == 100.0
    assert pinned.state.stiffness is None, "the deformer is made anew at the end only"
    pinned.key("escape")
    assert pinned.everything == before
    assert pinned.editor.tool.shown_stiffness is None


def test_a_stroke_beside_the_drawing_is_no_step(pinned):
    before = pinned.everything
    stroke(pinned, (2.0, 2.0), (5.0, 2.0))
    assert pinned.everything == before


@needs_triangle
def test_a_fast_stroke_has_no_gaps(pinned):
    stroke(pinned, (15.0, 40.0), (105.0, 40.0))
    assert min(at(pinned, (float(x), 40.0)) for x in range(15, 106)) == 100.0


def test_a_stroke_on_a_bent_drawing_is_where_the_pointer_was(pinned):
    pinned.drag(pinned.where(3), (90.0, 60.0))
    pinned.settle()
    stroke(pinned, pinned.where(3))
    assert at(pinned, (105.0, 40.0)) == 100.0
    assert at(pinned, (62.0, 40.0)) == 1.0


def test_with_the_brush_a_click_on_a_pin_paints(pinned):
    stroke(pinned, pinned.where(2))
    assert len(pinned.ids) == 3
    assert not pinned.editor.selection
    assert at(pinned, (62.0, 40.0)) == 100.0
    assert not pinned.would_add_pin
    assert pinned.hovered_pin is None


def test_brushes_have_limits():
    small = large = Brush()
    for _ in range(30):
        small, large = small.resized(False), large.resized(True)
    assert (small.radius, large.radius) == (MIN_RADIUS, MAX_RADIUS)


def test_stiffness_is_carried_over_to_another_mesh_and_baked(pinned, finer_drawing):
    stroke(pinned, NECK)
    state = transfer_state(pinned.state, pinned.session.drawing.mesh, finer_drawing)
    centers = finer_drawing.mesh.vertices[finer_drawing.mesh.faces].mean(axis=1)
    away = np.hypot(*(centers - NECK).T)
    assert state.stiffness.shape == (len(finer_drawing.mesh.faces),)
    assert (state.stiffness[away < 3.0] == 100.0).all()
    assert (state.stiffness[away > 20.0] == 1.0).all()
    assert with_pose_as_rest(pinned.state, pinned.session.drawing).stiffness is pinned.state.stiffness


def test_other_methods_keep_it_and_bend_without(pinned):
    stroke(pinned, NECK)
    factors = pinned.state.stiffness
    pinned.editor.chosen_tool = pinned.editor.pins_tool
    gestures.set_settings(pinned.editor, Settings("arap", ()))
    pinned.drag(pinned.where(3), (90.0, 60.0))
    pinned.settle()
    assert pinned.state.stiffness is factors


def test_a_replay_paints_the_same_on_the_same_mesh_and_the_same_place_on_another(
    pinned, drawing, finer_drawing
):
    stroke(pinned, NECK)
    pinned.editor.chosen_tool = pinned.editor.pins_tool
    pinned.drag(pinned.where(3), (90.0, 60.0))
    pinned.settle()
    *_, last = replay(pinned.session.recording, drawing)
    assert bits(last.state) == bits(pinned.state)
    *_, other = replay(pinned.session.recording, finer_drawing)
    found = finer_drawing.mesh.find(NECK)
    assert other.state.stiffness[found.faces[0]] == 100.0


def test_a_drawing_that_is_opened_stiff_is_recorded_so(pinned, drawing):
    stroke(pinned, NECK)
    again = Driver(pinned.session.document)
    stroke(again, HEAD)
    *_, last = replay(again.session.recording, drawing)
    assert last.state.stiffness.tobytes() == again.state.stiffness.tobytes()


def test_a_stroke_paints_the_layer_where_it_begins_and_no_other():
    drawing = puppet()
    driver = Driver(new_document(drawing))
    stroke(driver, (92.0, 118.0), (120.0, 118.0))  # on the arm, which lies on the body
    layers = drawing.mesh.face_layers
    stiffness = driver.session.state.stiffness
    assert (stiffness[layers == ARM] > 1).any()
    assert (stiffness[layers != ARM] == 1).all()
    stroke(driver, (66.0, 150.0), (80.0, 80.0))  # from the body to where the head covers it
    stiffness = driver.session.state.stiffness
    assert (stiffness[layers == BODY] > 1).any()
    assert (stiffness[layers == SKULL] == 1).all()
    *_, last = replay(driver.session.recording, drawing)
    np.testing.assert_array_equal(last.state.stiffness, stiffness)


def loosened(d: Driver, place: tuple[float, float]) -> bool:
    """Whether the face at a place of the rest pose is loose."""
    loose, found = d.state.loose, d.session.drawing.mesh.find(place)
    return loose is not None and bool(loose.faces[found.faces[0]])


def test_a_stroke_paints_loose_parts_and_is_one_entry(pinned):
    brush_tool = pinned.editor.brush_tool
    brush_tool.brush = replace(brush_tool.brush, paints="loose", speed=2.0, bounce=0.3)
    before, pose, drawing = bits(pinned.state), pinned.state.positions, pinned.session.drawing
    stroke(pinned, (70.0, 40.0), (95.0, 40.0), release=False)
    assert pinned.editor.tool.shown_loose.faces.any()
    assert pinned.editor.tool.shown_stiffness is None
    pinned.handle(PointerEvent("release", pinned.editor.camera.to_screen((95.0, 40.0))))
    assert loosened(pinned, NECK)
    assert not loosened(pinned, HEAD)
    assert (pinned.state.loose.speed, pinned.state.loose.bounce) == (2.0, 0.3)
    assert pinned.state.positions is pose
    assert pinned.state.stiffness is None
    assert pinned.session.history.undo_label == "Paint Loose Parts"
    after = bits(pinned.state)
    pinned.undo()
    assert bits(pinned.state) == before
    pinned.redo()
    assert bits(pinned.state) == after
    *_, last = replay(pinned.session.recording, drawing)
    assert bits(last.state) == after


def test_a_further_stroke_keeps_how_loose_parts_swing(pinned):
    brush_tool = pinned.editor.brush_tool
    brush_tool.brush = replace(brush_tool.brush, paints="loose", speed=2.0)
    stroke(pinned, NECK)
    brush_tool.brush = replace(brush_tool.brush, speed=5.0)
    stroke(pinned, HEAD)
    assert loosened(pinned, HEAD)
    assert pinned.state.loose.speed == 2.0


def test_the_right_button_erases_loose_parts_and_escape_leaves_them(pinned):
    brush_tool = pinned.editor.brush_tool
    brush_tool.brush = replace(brush_tool.brush, paints="loose")
    stroke(pinned, NECK)
    painted = bits(pinned.state)
    stroke(pinned, NECK, release=False, button="right")
    assert pinned.editor.tool.shown_loose is None
    pinned.editor.tool.cancel()
    assert bits(pinned.state) == painted
    stroke(pinned, NECK, button="right")
    assert pinned.state.loose is None
    assert pinned.session.history.undo_label == "Erase Loose Parts"
