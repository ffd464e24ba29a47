"""Each state of each tool completes, cancels without a trace, and can be undone bit for bit."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import pytest

from akap_editor.editor import gestures
from akap_editor.editor.events import Button, PointerEvent
from akap_editor.editor.tools.base import Cursor, Markers
from akap_editor.editor.tools.rotate import RING_RADIUS
from tests.support.editor_driver import OUTSIDE, Driver, Point, bits

NECK, END, FREE = (62.0, 40.0), (105.0, 40.0), (50.0, 45.0)  # two pins, and a point without a pin


@dataclass(frozen=True)
class Case:
    """A state of a tool and how to enter it.

    button: whose release ends the gesture; label: of the history entry, None if the gesture edits nothing;
    markers: names of the fields of `Markers` that it sets; tool: the attribute of the editor.
    """

    state: str
    enter: Callable[[Driver], None]
    label: str | None = None
    button: Button = "left"
    cursor: Cursor = "hand"
    markers: frozenset[str] = frozenset()
    tool: str = "pins_tool"

    def begin(self, driver: Driver) -> None:
        driver.editor.chosen_tool = getattr(driver.editor, self.tool)
        self.enter(driver)
        assert driver.tool == self.state


def drag(start: Point, end: Point, **how: object) -> Callable[[Driver], None]:
    """Presses and moves; one step is made."""

    def enter(driver: Driver) -> None:
        driver.press(start, **how)  # type: ignore[arg-type]
        driver.move(end)
        driver.advance()

    return enter


def press(point: Point, button: Button = "left", alt: bool = False) -> Callable[[Driver], None]:
    """Presses a point of the drawing."""

    def enter(driver: Driver) -> None:
        driver.handle(PointerEvent("press", driver.editor.camera.to_screen(point), button, alt=alt))

    return enter


def press_ring(driver: Driver) -> None:
    """Press the ring around the pin in the neck."""
    driver.key("alt")
    x, y = driver.editor.pins_on_screen()[2]
    driver.handle(PointerEvent("move", (x + RING_RADIUS, y), alt=True))
    driver.handle(PointerEvent("press", (x + RING_RADIUS, y), alt=True))


def rotate(driver: Driver) -> None:
    press_ring(driver)
    x, y = driver.editor.pins_on_screen()[2]
    angle = math.radians(30)
    position = x + RING_RADIUS * math.cos(angle), y + RING_RADIUS * math.sin(angle)
    driver.handle(PointerEvent("move", position, alt=True))
    driver.advance()


CASES = {
    "new pin pressed": Case("PointingPin", press(FREE), "Add Pin"),
    "pin pressed": Case("PointingPin", press(NECK)),
    "pin dragged": Case(
        "DraggingPin", drag(END, (90.0, 60.0)), "Drag Pin", cursor="grab", markers=frozenset({"pin_targets"})
    ),
    "pins dragged": Case(
        "DraggingPin",
        drag(END, (95.0, 55.0), shift=True),
        "Drag 2 Pins",
        cursor="grab",
        markers=frozenset({"pin_targets"}),
    ),
    "new pin dragged": Case(
        "DraggingPin",
        drag(FREE, (55.0, 55.0)),
        "Add and Drag Pin",
        cursor="grab",
        markers=frozenset({"pin_targets"}),
    ),
    "pin pressed with Alt": Case("RemovingPin", press(NECK, alt=True), "Remove Pin"),
    "pin pressed right": Case("OpeningMenu", press(NECK, "right"), button="right"),
    "pin pressed right by the hand": Case(
        "OpeningMenu", press(NECK, "right"), button="right", tool="hand_tool"
    ),
    "canvas pressed right": Case("OpeningMenu", press(OUTSIDE, "right"), button="right"),
    "joint pressed": Case("PointingJoint", press(NECK), cursor="cross", tool="joint_tool"),
    "zoom pressed": Case("PointingZoom", press(NECK), cursor="zoom", tool="zoom_tool"),
    "zoomed": Case("Zooming", drag(NECK, (70.0, 70.0)), cursor="zoom", tool="zoom_tool"),
    "canvas pressed": Case("PointingCanvas", press(OUTSIDE), cursor="arrow"),
    "box": Case(
        "RubberBand", drag(OUTSIDE, (70.0, 70.0)), cursor="arrow", markers=frozenset({"selection_box"})
    ),
    "ring pressed": Case("PointingRotationRing", press_ring, cursor="rotate"),
    "ring dragged": Case("RotatingPin", rotate, "Rotate Pin", cursor="rotate", markers=frozenset({"ring"})),
    "panning": Case("Panning", drag(NECK, (70.0, 70.0), button="middle"), button="middle", cursor="panning"),
    "panning by the hand": Case("Panning", drag(NECK, (70.0, 70.0)), cursor="panning", tool="hand_tool"),
    "panning while painting": Case(
        "Panning",
        drag(NECK, (70.0, 70.0), button="middle"),
        button="middle",
        cursor="panning",
        tool="brush_tool",
    ),
    "painting": Case(
        "Painting",
        drag(NECK, (70.0, 45.0)),
        "Paint Stiffness",
        cursor="hidden",
        markers=frozenset({"brush"}),
        tool="brush_tool",
    ),
}
IDLE = {"pins_tool": "PinsIdle", "hand_tool": "HandIdle", "brush_tool": "BrushIdle", "zoom_tool": "ZoomIdle"}
IDLE["joint_tool"] = "JointsIdle"

every_state = pytest.mark.parametrize("case", CASES.values(), ids=CASES)


@every_state
@pytest.mark.parametrize("how", ["escape", "cancel", "undo"])
def test_a_cancelled_gesture_leaves_no_trace(pinned: Driver, case: Case, how: str) -> None:
    pinned.editor.select({2})
    before = pinned.everything
    case.begin(pinned)
    {"escape": lambda: pinned.key("escape"), "cancel": pinned.editor.cancel, "undo": pinned.undo}[how]()
    assert pinned.tool == IDLE[case.tool]
    assert pinned.everything == before
    pinned.settle()
    assert pinned.everything == before


@every_state
def test_after_a_cancelled_gesture_the_rest_of_it_does_nothing(pinned: Driver, case: Case) -> None:
    pinned.editor.select({2})
    before = pinned.everything
    case.begin(pinned)
    pinned.key("escape")
    for button in ("left", "middle", "right"):
        pinned.move((30.0, 30.0), button)
        pinned.release((30.0, 30.0), button)
    assert pinned.everything == before


@every_state
def test_a_release_completes_the_gesture(pinned: Driver, case: Case) -> None:
    case.begin(pinned)
    pinned.release((70.0, 70.0), case.button)
    assert pinned.tool == IDLE[case.tool]
    assert not pinned.editor.is_busy


@every_state
def test_other_buttons_do_not_end_a_gesture(pinned: Driver, case: Case) -> None:
    case.begin(pinned)
    for button in {"left", "middle", "right"} - {case.button}:
        pinned.press((30.0, 30.0), button)
        pinned.release((30.0, 30.0), button)
    assert pinned.tool == case.state


@every_state
def test_edits_wait_for_the_end_of_a_gesture(pinned: Driver, case: Case) -> None:
    case.begin(pinned)
    before = pinned.everything
    gestures.remove_pins(pinned.editor, [1, 2, 3])
    gestures.reset_pose(pinned.editor)
    pinned.redo()
    assert gestures.add_pin(pinned.editor, (50.0, 50.0)) is None
    gestures.set_settings(pinned.editor, pinned.state.settings.with_parameter("memory", 0.0))
    assert pinned.tool == case.state
    assert pinned.everything == before


@every_state
def test_an_edit_is_one_entry_and_undo_and_redo_are_exact(pinned: Driver, case: Case) -> None:
    pinned.editor.select({2})
    before, depth = bits(pinned.state), pinned.depth
    case.begin(pinned)
    pinned.release((70.0, 70.0), case.button)
    pinned.settle()
    after = bits(pinned.state)
    if case.label is None:
        assert (after, pinned.depth) == (before, depth)
        return
    assert after != before
    assert (pinned.depth, pinned.session.history.undo_label) == (depth + 1, case.label)
    pinned.undo()
    assert bits(pinned.state) == before
    assert (pinned.depth, pinned.session.history.redo_label) == (depth, case.label)
    pinned.redo()
    assert bits(pinned.state) == after
    assert pinned.depth == depth + 1
    assert not pinned.editor.is_moving


@every_state
def test_every_state_has_a_hint_a_cursor_and_markers_of_its_own(pinned: Driver, case: Case) -> None:
    pinned.editor.chosen_tool = getattr(pinned.editor, case.tool)
    idle = pinned.editor.hint
    case.begin(pinned)
    tool = pinned.editor.tool
    assert tool.hint
    assert tool.hint != idle
    assert tool.cursor == case.cursor
    none = Markers()
    assert {name for name in vars(none) if getattr(tool.markers, name) != getattr(none, name)} == case.markers
    assert tool.drags_pins == (case.state == "DraggingPin")


@pytest.mark.parametrize(
    ("tool", "cursor"),
    [("hand_tool", "pan"), ("zoom_tool", "zoom"), ("joint_tool", "cross"), ("knife_tool", "cross")],
)
def test_a_tool_that_waits_has_a_cursor_of_its_own(pinned: Driver, tool: str, cursor: Cursor) -> None:
    pinned.editor.chosen_tool = getattr(pinned.editor, tool)
    pinned.move(NECK)
    assert pinned.editor.tool.cursor == cursor
