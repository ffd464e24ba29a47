"""The ring around a pin, and pins that hold an angle, as a hand uses them."""

import math

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.comparison import MethodComparison
from akap_editor.editor.document.remesh import transfer_state
from akap_editor.editor.document.rest_pose import with_pose_as_rest
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import PaintStiffness, SetAngles
from akap_editor.editor.session.replay import replay
from akap_editor.editor.tools.rotate import RING_RADIUS
from akap_editor.errors import InputError
from tests.support.editor_driver import Driver, bits

NEAR = 0.02  # radians: pins hold angles softly


def on_ring(d: Driver, pin: int, degrees: float) -> tuple[float, float]:
    """A point of the screen on a pin's ring, in a direction from it."""
    x, y = d.editor.pins_on_screen()[pin]
    angle = math.radians(degrees)
    return x + RING_RADIUS * math.cos(angle), y + RING_RADIUS * math.sin(angle)


def point(d: Driver, kind: str, at: tuple[float, float], **more: bool) -> None:
    d.handle(PointerEvent(kind, at, alt="alt" in d.editor.held, **more))  # type: ignore[arg-type]


def ring_pin(d: Driver) -> int | None:
    """The pin whose ring is shown."""
    ring = d.editor.tool.markers.ring
    return None if ring is None else ring.pin


def grab_ring(d: Driver, pin: int, start: float = 0.0) -> None:
    d.key("alt")
    point(d, "move", on_ring(d, pin, start))
    point(d, "press", on_ring(d, pin, start))


def rotate(d: Driver, pin: int, *directions: float) -> None:
    """Drag the ring from direction 0 through others, in degrees; release, and let it come to rest."""
    grab_ring(d, pin)
    for direction in directions:
        point(d, "move", on_ring(d, pin, direction))
        d.advance()
    point(d, "release", on_ring(d, pin, directions[-1]))
    d.key("alt", pressed=False)
    d.settle()


def test_a_drag_of_the_ring_rotates_the_drawing_which_then_holds_the_angle(pinned):
    rest = bits(pinned.state)
    rotate(pinned, 2, 10, 20, 30, 40)
    assert pinned.state.pin(2).angle == pytest.approx(math.radians(40), abs=1e-9)
    assert pinned.session.pin_angle(2) == pytest.approx(math.radians(40), abs=NEAR)
    assert pinned.session.pin_error() < 0.25, "no pin leaves its place"
    assert pinned.session.history.undo_label == "Rotate Pin"
    assert pinned.editor.selection == {2}
    rotated = bits(pinned.state)
    pinned.undo()
    assert bits(pinned.state) == rest
    pinned.redo()
    assert bits(pinned.state) == rotated


def test_a_held_angle_stays_when_another_pin_is_dragged(pinned):
    rotate(pinned, 3, 15, 30)
    pinned.drag(pinned.where(1), (24.0, 52.0))
    pinned.settle()
    assert pinned.session.pin_angle(3) == pytest.approx(math.radians(30), abs=NEAR)
    assert pinned.session.pin_error() < 0.25


def test_rotation_continues_beyond_180_degrees_however_fast_the_hand_is(driver):
    driver.click((62.0, 40.0))
    grab_ring(driver, 1)
    for direction in (90, 180, 250):
        point(driver, "move", on_ring(driver, 1, direction))
    assert driver.state.pin(1).angle == pytest.approx(math.radians(250))
    driver.advance()
    assert 0 < driver.session.pin_angle(1) < math.pi / 2, "it rotates clockwise"
    point(driver, "release", on_ring(driver, 1, 250))
    driver.settle()
    assert driver.session.pin_angle(1) == pytest.approx(math.radians(250 - 360), abs=NEAR)


@pytest.mark.parametrize(("direction", "angle"), [(40, 45), (-10, -15), (7, 0)])
def test_shift_snaps_to_15_degrees(pinned, direction, angle):
    grab_ring(pinned, 2)
    pinned.key("shift")
    point(pinned, "move", on_ring(pinned, 2, direction))
    assert pinned.state.pin(2).angle == pytest.approx(math.radians(angle), abs=1e-12)
    assert f"{angle:+.1f}°" in pinned.editor.hint


@pytest.mark.parametrize("how", ["escape", "undo"])
def test_escape_in_the_middle_restores_exactly(pinned, how):
    before = pinned.everything
    grab_ring(pinned, 2)
    for direction in (20, 50):
        point(pinned, "move", on_ring(pinned, 2, direction))
        pinned.advance()
    assert pinned.tool == "RotatingPin"
    pinned.key("escape") if how == "escape" else pinned.undo()
    assert pinned.everything == before
    assert pinned.tool == "PinsIdle"


def test_a_click_on_the_ring_does_nothing_and_one_on_the_pin_removes_it(pinned):
    before = pinned.everything
    grab_ring(pinned, 2)
    point(pinned, "release", on_ring(pinned, 2, 0))
    assert pinned.everything == before
    at = pinned.editor.pins_on_screen()[2]
    point(pinned, "press", at)
    point(pinned, "release", at)
    assert pinned.ids == [1, 3]


def test_the_ring_is_that_of_the_pin_nearby_or_of_the_only_selected_one(pinned):
    def shown(at):
        point(pinned, "move", at)
        return ring_pin(pinned)

    outside = pinned.editor.camera.to_screen((2.0, 78.0))
    assert shown(on_ring(pinned, 2, 30)) is None, "no pin is selected"
    pinned.key("alt")
    assert shown(on_ring(pinned, 2, 30)) == 2
    assert shown(pinned.editor.pins_on_screen()[3]) == 3
    assert shown(outside) is None
    pinned.editor.select({1})
    assert shown(outside) == 1
    assert shown(on_ring(pinned, 2, 30)) == 2
    pinned.editor.chosen_tool = pinned.editor.hand_tool
    assert shown(on_ring(pinned, 2, 30)) is None


def test_the_only_selected_pin_always_shows_its_ring_which_rotates_without_any_key(pinned):
    outside = pinned.editor.camera.to_screen((2.0, 78.0))
    point(pinned, "move", outside)
    pinned.editor.select({2})
    assert ring_pin(pinned) == 2
    assert pinned.editor.tool.cursor == "arrow"
    point(pinned, "move", on_ring(pinned, 2, 0))
    assert pinned.editor.tool.cursor == "rotate"
    assert not pinned.would_add_pin
    point(pinned, "press", on_ring(pinned, 2, 0))
    for direction in (10, 20, 30):
        point(pinned, "move", on_ring(pinned, 2, direction))
        pinned.advance()
    point(pinned, "release", on_ring(pinned, 2, 30))
    assert pinned.state.pin(2).angle == pytest.approx(math.radians(30), abs=1e-9)
    pinned.editor.select({1, 2})
    assert ring_pin(pinned) is None, "several pins have no ring"


@pytest.mark.parametrize(
    ("distance", "rotates"), [(12.5, False), (20, False), (24, True), (34, True), (37, False)]
)
def test_without_alt_only_the_line_of_the_ring_takes_a_press(driver, distance, rotates):
    driver.click((62.0, 40.0))
    x, y = driver.editor.pins_on_screen()[1]
    driver.handle(PointerEvent("press", (x + distance, y)))
    assert (driver.tool == "PointingRotationRing") == rotates


def test_a_click_on_the_ring_adds_a_pin_as_anywhere_on_the_drawing(pinned):
    pinned.editor.select({2})
    at = next(
        on_ring(pinned, 2, angle)
        for angle in range(0, 360, 10)
        if pinned.editor.is_on_drawing(on_ring(pinned, 2, angle))
    )
    point(pinned, "press", at)
    point(pinned, "release", at)
    assert len(pinned.ids) == 4
    assert pinned.editor.selection == {max(pinned.ids)}
    pinned.undo()
    assert len(pinned.ids) == 3


def test_another_pin_in_reach_of_the_ring_is_dragged_and_not_the_ring(pinned):
    pinned.editor.select({2})
    pinned.editor.camera = pinned.editor.camera.zoomed(
        RING_RADIUS / math.dist(pinned.editor.pins_on_screen()[1], pinned.editor.pins_on_screen()[2]),
        pinned.editor.pins_on_screen()[2],
    )
    point(pinned, "press", pinned.editor.pins_on_screen()[1])
    assert pinned.tool == "PointingPin"


def test_a_method_that_cannot_rotate_pins_has_no_ring_and_keeps_the_angles(pinned):
    rotate(pinned, 2, 20)
    gestures.set_settings(pinned.editor, Settings("arap", ()))
    pinned.key("alt")
    point(pinned, "move", on_ring(pinned, 2, 0))
    assert ring_pin(pinned) is None
    pinned.key("alt", pressed=False)
    pinned.drag(pinned.where(3), (100.0, 30.0))
    pinned.settle()
    assert pinned.state.pin(2).angle == pytest.approx(math.radians(20))


def test_holding_and_releasing_move_nothing(pinned):
    pinned.drag(pinned.where(3), (96.0, 22.0))
    pinned.settle()
    pose, here = pinned.state.positions, pinned.session.pin_angle(3)
    assert abs(here) > 0.05
    pinned.editor.select({2, 3})
    gestures.toggle_held_angles(pinned.editor)
    assert pinned.state.pin(3).angle == pytest.approx(here)
    assert pinned.state.pin(1).angle is None
    pinned.settle()
    assert pinned.state.positions is pose
    gestures.toggle_held_angles(pinned.editor)
    pinned.settle()
    assert pinned.state.positions is pose
    assert np.isnan(pinned.state.angles).all()
    assert pinned.session.history.undo_label == "Release Angle"


def test_angles_by_number(pinned):
    gestures.set_pin_angle(pinned.editor, 2, math.radians(-30))
    pinned.settle()
    assert pinned.session.pin_angle(2) == pytest.approx(math.radians(-30), abs=NEAR)
    before = pinned.everything
    for bad in (np.nan, np.inf, 1e6):
        with pytest.raises(InputError, match="angle of pin 2: expected a number"):
            gestures.set_pin_angle(pinned.editor, 2, bad)
    assert pinned.everything == before
    gestures.set_pin_angle(pinned.editor, 2, None)
    assert pinned.state.pin(2).angle is None


def test_a_pin_rotates_a_little_in_each_step_and_the_rest_comes_later(pinned):
    gestures.set_pin_angle(pinned.editor, 2, 1.0)
    pinned.advance()
    assert 0.05 < pinned.session.pin_angle(2) < 0.3
    pinned.settle()
    assert pinned.session.pin_angle(2) == pytest.approx(1.0, abs=NEAR)


def test_a_reset_or_baked_drawing_holds_the_angles_that_it_has_then(pinned):
    rotate(pinned, 2, 25)
    baked = with_pose_as_rest(pinned.state, pinned.session.drawing)
    assert baked.pin(2).angle == pytest.approx(0.0, abs=1e-12)
    assert baked.pin(1).angle is None
    gestures.reset_pose(pinned.editor)
    assert pinned.state.pin(2).angle == pytest.approx(0.0, abs=1e-12)
    pinned.settle()
    assert not pinned.session.is_posed


def test_angles_are_carried_over_to_another_mesh(pinned, finer_drawing):
    rotate(pinned, 2, 25)
    state = transfer_state(pinned.state, pinned.session.drawing.mesh, finer_drawing)
    assert [pin.angle for pin in state.pins] == [None, pinned.state.pin(2).angle, None]


def test_a_replay_gives_the_same_poses_to_the_last_bit(pinned, drawing):
    rotate(pinned, 2, 30, 60)
    gestures.toggle_held_angles(pinned.editor)
    pinned.drag(pinned.where(1), (24.0, 48.0))
    pinned.settle()
    *_, last = replay(pinned.session.recording, drawing)
    assert bits(last.state) == bits(pinned.state)


def test_a_second_method_beside_rotates_as_well(pinned):
    comparison = MethodComparison("akap:memory=1,no-dirichlet")
    comparison.follow(pinned.session)
    rotate(pinned, 2, 20, 40)
    comparison.follow(pinned.session)
    while comparison.is_moving:
        comparison.follow(pinned.session)
    assert comparison.session is not None
    assert comparison.session.pin_angle(2) == pytest.approx(math.radians(40), abs=NEAR)
    gestures.set_pin_angle(pinned.editor, 2, None)
    comparison.follow(pinned.session)
    assert comparison.session.state.pin(2).angle is None


def test_held_angles_come_to_rest_soon_also_where_parts_are_stiff(pinned):
    pinned.session.begin("Paint Stiffness")
    pinned.session.apply(PaintStiffness([(62.0, 40.0)], 20.0, 300.0))
    pinned.session.commit()
    pinned.session.begin("Rotate Pin")
    pinned.session.apply(SetAngles({1: 1.0, 3: -0.8}))
    steps = 0
    while pinned.session.is_moving:
        pinned.session.step()
        steps += 1
    pinned.session.commit()
    assert steps < 60
    assert pinned.session.pin_angle(1) == pytest.approx(1.0, abs=2 * NEAR)
    assert pinned.session.pin_angle(3) == pytest.approx(-0.8, abs=2 * NEAR)


def test_unknown_pins_cannot_be_rotated(pinned):
    with pytest.raises(InputError, match=r"angles: expected ids of pins \[1, 2, 3\], got 7"):
        pinned.session.apply(SetAngles({7: 0.1}))
