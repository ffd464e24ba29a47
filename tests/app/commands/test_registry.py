"""Each command by its menu, its button and its keys."""

from imgui_bundle import imgui  # isort: skip
import glfw
import numpy as np
import pytest

from akap_editor.app import files
from akap_editor.app.canvas.view_options import DISTORTION_RANGES
from akap_editor.app.commands import clipboard
from akap_editor.app.commands import registry as commands
from akap_editor.app.commands.command import CTRL, SHIFT, Command, CommandGroup, Key, chord_name
from akap_editor.app.commands.palette import Palette
from akap_editor.app.commands.registry import COMMANDS, MENUS
from akap_editor.app.commands.shortcuts_page import ShortcutsPage
from akap_editor.app.dialogs.about import AboutDialog
from akap_editor.app.dialogs.clips import ClipsDialog
from akap_editor.app.dialogs.export.animation import ExportAnimationDialog
from akap_editor.app.dialogs.export.pose import ExportPoseDialog
from akap_editor.app.dialogs.preferences_page import PreferencesPage
from akap_editor.app.dialogs.take import TakeDialog
from akap_editor.app.frame import layout
from akap_editor.app.glfw_window import on_key
from akap_editor.editor import gestures, mirroring
from akap_editor.editor.camera import Camera
from akap_editor.editor.document.document import new_document
from akap_editor.editor.events import PinRequest
from akap_editor.editor.session.edits import PaintLoose, PaintStiffness, SetTargets
from akap_editor.editor.tools.stiffness_brush import Brush
from tests.support.clipboards import FakeClipboard
from tests.support.puppets import puppet

ITEMS = [((menu, item.label), item) for menu, group in MENUS for item in group if isinstance(item, Command)]
ITEMS += [
    ((menu, group.label, command.label), command)
    for menu, items in MENUS
    for group in items
    if isinstance(group, CommandGroup)
    for command in group.commands
    if command is not None
]


@pytest.fixture(autouse=True)
def fake_clipboard(monkeypatch):
    monkeypatch.setattr(clipboard, "copykitten", FakeClipboard())


# -- what each command does: prepare, and a law that holds after it -----------------------------------------


def nothing(ui):
    pass


def bent(ui):
    ui.bend()


def undone(ui):
    ui.bend()
    ui.editor.undo()


def one_selected(ui):
    ui.editor.select({2})


def scattered(ui):
    """All pins are selected; the middle one is neither on the line of the others nor between them."""
    targets = {1: (40.0, 70.0), 2: (120.0, 90.0), 3: (220.0, 77.0)}
    ui.editor.edit("Move Pins", lambda session: (session.apply(SetTargets(targets)), session.settle()))
    ui.editor.select_all()


def stacked(ui):
    """Three pins in the head, one below the other; all are selected."""
    gestures.remove_pins(ui.editor, {pin.id for pin in ui.pins})
    for place in ((40.0, 62.0), (60.0, 80.0), (48.0, 98.0)):
        gestures.add_pin(ui.editor, place)
    ui.editor.select_all()


def paired(ui):
    ui.editor.select({1, 3})
    mirroring.pair_selected(ui.editor)


def targets_are(axis, expected):
    return lambda ui: [pin.target[axis] for pin in ui.pins] == pytest.approx(expected, abs=0.5)


def folded(ui):
    """Pin 3 is dragged over the head, and in front of it."""
    ui.session.begin("Drag Pin")
    ui.session.apply(SetTargets({3: (22.0, 46.0)}))
    ui.session.settle()
    ui.session.commit()
    ui.editor.select({3})


def folded_behind(ui):
    folded(ui)
    gestures.order_limb(ui.editor, False)


def last_entry(label):
    return lambda ui: ui.session.history.undo_label == label


def with_tool(name):
    return lambda ui: setattr(ui.editor, "chosen_tool", getattr(ui.editor, name))


def stiffened(ui):
    ui.editor.apply("Paint Stiffness", PaintStiffness([(50.0, 80.0)], 30.0, 100.0))


def loosened(ui):
    ui.editor.apply("Paint Loose Parts", PaintLoose([(50.0, 80.0)], 30.0))


def moved_camera(ui):
    ui.editor.camera = Camera(0.7, (10.0, 20.0))


def watch_palette(ui):
    """Test Engine closes popups at the end of its tests, so each frame is looked at."""
    ui.palettes = []
    ui.window.after_draw[:] = [lambda: ui.palettes.append(ui.state.part(Palette).is_open)]


def is_rest(ui):
    return not ui.session.is_posed


def zoom_is(factor):
    def holds(ui):
        middle = 48 + (1280 - 48 - 288) / 2
        assert ui.editor.canvas[0] == 48
        assert (ui.editor.canvas[0] + ui.editor.canvas[2]) / 2 == middle
        return ui.editor.camera.zoom == pytest.approx(0.7 * factor)

    return holds


def keyed(ui):
    """Two keyframes, at 0 and at 1 second, the second one chosen."""
    playback = ui.state.timeline.keyframe_playback
    ui.state.timeline.is_shown, ui.state.timeline.mode = True, "keyframes"
    ui.settle()
    playback.set_keyframe(0.0)
    ui.bend()
    playback.set_keyframe(1.0)
    playback.scrub(1.0)
    playback.selected = frozenset({1.0})
    ui.settle()


def copied(ui):
    """The keyframe at 1 second is copied; the playhead is at 2 seconds."""
    keyed(ui)
    playback = ui.state.timeline.keyframe_playback
    playback.copy_keyframes()
    playback.scrub(2.0)


def looking_between(ui):
    keyed(ui)
    ui.state.timeline.keyframe_playback.scrub(0.5)


def once_keyed(ui):
    """Playing takes a tenth of a second, and then the range is over."""
    keyed(ui)
    ui.state.timeline.keyframe_playback.loop = False
    ui.state.timeline.keyframe_playback.mark_range(0.1, 0.2)


def looked_at(ui):
    """Three seconds, the first and the last one cut off, looked at after a half second of the rest."""
    keyed(ui)
    ui.state.timeline.keyframe_playback.set_keyframe(3.0)
    ui.state.timeline.keyframe_playback.mark_range(1.0, 2.5)
    ui.state.timeline.keyframe_playback.scrub(1.5)


def look_is(moment):
    return lambda ui: ui.state.timeline.keyframe_playback.time == pytest.approx(moment)


def range_is(start, end):
    return lambda ui: ui.state.timeline.keyframe_playback.played_range == pytest.approx((start, end))


def watch_requests(ui):
    """What is asked for a pin, at the end of each frame."""
    one_selected(ui)
    ui.requests = []
    ui.window.after_draw[:] = [lambda: ui.requests.append(ui.editor.request)]


def watch_tools(ui):
    """Test Engine takes its mouse away at the end of its tests, and a mouse that moves ends the crosshair."""
    ui.tools = []
    ui.window.after_draw[:] = [lambda: ui.tools.append(ui.tool)]


def asked_for(kind):
    return lambda ui: PinRequest(kind, 2) in ui.requests


def looks(x, y):
    def holds(ui):
        dx, dy = ui.editor.camera.offset[0] - 10.0, ui.editor.camera.offset[1] - 20.0
        return (np.sign([-dx, -dy]) == (x, y)).all()

    return holds


def times(ui):
    return ui.session.present.animation.times


CASES = {
    "Step Forward": (looked_at, look_is(1.55)),
    "Step Back": (looked_at, look_is(1.45)),
    "One Second Forward": (looked_at, look_is(2.5)),
    "One Second Back": (looked_at, look_is(0.5)),
    "Go to Start": (looked_at, look_is(1.0)),
    "Go to End": (looked_at, look_is(2.5)),
    "Set Range Start": (looked_at, range_is(1.5, 2.5)),
    "Set Range End": (looked_at, range_is(1.0, 1.5)),
    "Clear Range": (looked_at, range_is(0.0, 3.0)),
    "Zoom In Timeline": (keyed, lambda ui: ui.state.timeline.keyframe_playback.visible_range.is_zoomed),
    "Zoom Out Timeline": (
        lambda ui: [keyed(ui), ui.state.timeline.keyframe_playback.visible_range.zoom(1.4, 0.0)],
        lambda ui: not ui.state.timeline.keyframe_playback.visible_range.is_zoomed,
    ),
    "Select All Keyframes": (keyed, lambda ui: ui.state.timeline.keyframe_playback.selected == {0.0, 1.0}),
    "Crosshair": (watch_tools, lambda ui: "KeyboardPointer" in ui.tools),
    "Next Pin": (one_selected, lambda ui: ui.editor.selection == {3}),
    "Previous Pin": (one_selected, lambda ui: ui.editor.selection == {1}),
    "Pin Values...": (watch_requests, asked_for("values")),
    "Context Menu": (watch_requests, asked_for("menu")),
    "Pan Left": (moved_camera, looks(-1, 0)),
    "Pan Right": (moved_camera, looks(1, 0)),
    "Pan Up": (moved_camera, looks(0, -1)),
    "Pan Down": (moved_camera, looks(0, 1)),
    "Next Distortion Range": (
        lambda ui: setattr(ui.state.view, "distortion_measure", "area"),
        lambda ui: DISTORTION_RANGES[ui.state.view.distortion_range] == 2.0,
    ),
    "Play": (once_keyed, lambda ui: ui.state.timeline.keyframe_playback.time == 0.2),
    "Export Animation...": (keyed, lambda ui: ui.state.part(ExportAnimationDialog).is_open),
    "Add Keyframe": (looking_between, lambda ui: times(ui) == (0.0, 0.5, 1.0)),
    "Delete Keyframe": (keyed, lambda ui: times(ui) == (0.0,)),
    "Duplicate Keyframe": (keyed, lambda ui: times(ui) == (0.0, 1.0, 1.5)),
    "Auto Key": (nothing, lambda ui: ui.state.timeline.keyframe_playback.auto_key.is_on),
    "Reverse Keyframes": (keyed, lambda ui: ui.session.history.undo_label == "Reverse 2 Keyframes"),
    "Duplicate Keyframes Reversed": (keyed, lambda ui: times(ui) == (0.0, 1.0, 1.5, 2.5)),
    "Next Keyframe": (looking_between, lambda ui: ui.state.timeline.keyframe_playback.time == 1.0),
    "Previous Keyframe": (looking_between, lambda ui: ui.state.timeline.keyframe_playback.time == 0.0),
    "Move Keyframe Earlier": (keyed, lambda ui: times(ui) == (0.0, 0.95)),
    "Move Keyframe Later": (keyed, lambda ui: times(ui) == (0.0, 1.05)),
    "Speed Graph": (nothing, lambda ui: ui.state.timeline.is_shown and ui.state.view.show_speed_graph),
    "Keyframes from Take...": (lambda ui: ui.bend(), lambda ui: ui.state.part(TakeDialog).is_open),
    "Clips...": (nothing, lambda ui: ui.state.part(ClipsDialog).is_open),
    "Save as Clip...": (keyed, lambda ui: ui.file_request is not None and ui.file_request.saving),
    "Copy Keyframes": (keyed, lambda ui: ui.state.timeline.keyframe_playback.can_paste()),
    "Paste Keyframes": (copied, lambda ui: times(ui) == (0.0, 1.0, 2.0)),
    "Paste Keyframes Reversed": (copied, lambda ui: times(ui) == (0.0, 1.0, 2.0)),
    "Onion Skin": (keyed, lambda ui: ui.state.timeline.keyframe_playback.onion_skin.is_shown),
    "Open...": (nothing, lambda ui: ui.file_request is not None and not ui.file_request.saving),
    "Merge Layers": (
        lambda ui: files.show_document(ui.state, new_document(puppet())),
        lambda ui: not ui.document.drawing.layers or ui.state.task is not None,
    ),
    "Reload Artwork": (nothing, lambda ui: ui.file_request is not None and not ui.file_request.saving),
    "Cut Out with Mask...": (
        nothing,
        lambda ui: ui.file_request is not None and not ui.file_request.saving,
    ),
    "Save": (bent, lambda ui: ui.file_request is not None and ui.file_request.saving),
    "Save As...": (nothing, lambda ui: ui.file_request is not None and ui.file_request.saving),
    "Export...": (nothing, lambda ui: ui.state.part(ExportPoseDialog).is_open),
    "Close": (nothing, lambda ui: ui.state.document is None),
    "Quit": (nothing, lambda ui: ui.state.is_closing),
    "Undo": (bent, is_rest),
    "Redo": (undone, lambda ui: ui.session.is_posed),
    "Copy as Picture": (nothing, lambda ui: ui.state.notice.startswith("Copied the pose as a picture")),
    "Copy Pose": (nothing, lambda ui: ui.state.notice.startswith("Copied the pose; paste")),
    "Paste Picture or Pose": (nothing, lambda ui: ui.state.notice.startswith("The clipboard holds neither")),
    "Remove Selected Pins": (one_selected, lambda ui: [pin.id for pin in ui.pins] == [1, 3]),
    "Raise Depth": (one_selected, lambda ui: [pin.depth for pin in ui.pins] == [0, 1, 0]),
    "Lower Depth": (one_selected, lambda ui: [pin.depth for pin in ui.pins] == [0, -1, 0]),
    "Bring Limb to Front": (folded_behind, last_entry("Bring Limb to Front")),
    "Send Limb to Back": (folded, last_entry("Send Limb to Back")),
    "Remove Last Pin": (nothing, lambda ui: [pin.id for pin in ui.pins] == [1, 2]),
    "Select All Pins": (nothing, lambda ui: ui.editor.selection == {1, 2, 3}),
    "Suggest Pins": (nothing, lambda ui: ui.tool == "SuggestedPins"),
    "Deselect": (one_selected, lambda ui: not ui.editor.selection),
    "Reset Pose": (bent, lambda ui: not ui.session.is_posed and len(ui.pins) == 3),
    "Set Rest Pose from Current": (bent, lambda ui: not ui.session.is_posed and ui.editor.is_modified),
    "Remember Rest Shape": (nothing, lambda ui: ui.session.state.settings.get("memory") == 0.0),
    "Reset Parameters": (
        lambda ui: ui.state.change_settings(
            ui.session.state.settings.with_parameter("memory", 0.25).with_parameter("exact", True)
        ),
        lambda ui: (
            ui.session.state.settings.get("memory") == 1.0 and not ui.session.state.settings.get("exact")
        ),
    ),
    "Fit in Window": (moved_camera, lambda ui: ui.editor.camera == fitted(ui)),
    "Actual Size": (moved_camera, lambda ui: ui.editor.camera.zoom == pytest.approx(1.0)),
    "Zoom In": (moved_camera, zoom_is(1.25)),
    "Zoom Out": (moved_camera, zoom_is(0.8)),
    "Show Mesh": (nothing, lambda ui: ui.state.view.show_mesh),
    "Show Pins": (nothing, lambda ui: not ui.state.view.show_pins),
    "Smooth Bends": (nothing, lambda ui: not ui.state.view.smooth_bends),
    "Show Checkerboard": (nothing, lambda ui: not ui.state.view.show_checkerboard),
    "Show Vector Field": (nothing, lambda ui: ui.state.view.show_vector_fields),
    "Show Area Distortion": (nothing, lambda ui: ui.state.view.distortion_measure == "area"),
    "Show Angle Distortion": (
        lambda ui: setattr(ui.state.view, "distortion_measure", "area"),
        lambda ui: ui.state.view.distortion_measure == "angle",
    ),
    "Show Rest Pose": (nothing, lambda ui: ui.state.view.show_rest_pose),
    "Show Motion Paths": (nothing, lambda ui: ui.state.view.show_motion_paths),
    "Show Pin Trails": (nothing, lambda ui: ui.state.view.show_pin_trails),
    "Reference Picture...": (nothing, lambda ui: ui.file_request is not None),
    "Show Reference Picture": (
        lambda ui: ui.state.view.set_reference(ui.document.drawing.image),
        lambda ui: not ui.state.view.show_reference,
    ),
    "Export Pose File...": (nothing, lambda ui: ui.file_request is not None and ui.file_request.saving),
    "Apply Pose File...": (nothing, lambda ui: ui.file_request is not None and not ui.file_request.saving),
    "Save Recording...": (nothing, lambda ui: ui.file_request is not None and ui.file_request.saving),
    "Compare Methods": (nothing, lambda ui: ui.state.view.is_split),
    "Show Timeline": (nothing, lambda ui: ui.state.timeline.is_shown),
    "Find Command...": (watch_palette, lambda ui: any(ui.palettes)),
    "Keyboard Shortcuts": (nothing, lambda ui: ui.state.part(ShortcutsPage).is_open),
    "Preferences...": (nothing, lambda ui: ui.state.part(PreferencesPage).is_open),
    "About akap-editor": (nothing, lambda ui: ui.state.part(AboutDialog).is_open),
    "Pin Tool": (with_tool("hand_tool"), lambda ui: ui.editor.chosen_tool is ui.editor.pins_tool),
    "Hand Tool": (nothing, lambda ui: ui.editor.chosen_tool is ui.editor.hand_tool),
    "Joint Tool": (nothing, lambda ui: ui.editor.chosen_tool is ui.editor.joint_tool),
    "Knife": (nothing, lambda ui: ui.editor.chosen_tool is ui.editor.knife_tool),
    "Zoom Tool": (nothing, lambda ui: ui.editor.chosen_tool is ui.editor.zoom_tool),
    "Hide Panels": (nothing, lambda ui: ui.editor.canvas[0] == 0 and ui.editor.canvas[2] == 1280),
    "Full Screen": (nothing, lambda ui: ui.state.is_full_screen),
    "Show Toolbar": (nothing, lambda ui: ui.editor.canvas[0] == 0),
    "Show Options Bar": (nothing, lambda ui: ui.editor.canvas[1] < 30),
    "Show Side Panel": (nothing, lambda ui: ui.editor.canvas[2] == 1280),
    "Pose Tab": (
        lambda ui: layout.show_tab(ui.state, "Mesh"),
        lambda ui: layout.current_tab(ui.state) == "Pose",
    ),
    "Animate Tab": (nothing, lambda ui: layout.current_tab(ui.state) == "Animate"),
    "Mesh Tab": (nothing, lambda ui: layout.current_tab(ui.state) == "Mesh"),
    "Align Left": (stacked, targets_are(0, [40.0, 40.0, 40.0])),
    "Align Horizontal Centers": (stacked, targets_are(0, [50.0, 50.0, 50.0])),
    "Align Right": (stacked, targets_are(0, [60.0, 60.0, 60.0])),
    "Align Top": (scattered, targets_are(1, [70.0, 70.0, 70.0])),
    "Align Vertical Centers": (scattered, targets_are(1, [80.0, 80.0, 80.0])),
    "Align Bottom": (scattered, targets_are(1, [90.0, 90.0, 90.0])),
    "Distribute Horizontally": (scattered, targets_are(0, [40.0, 130.0, 220.0])),
    "Distribute Vertically": (scattered, targets_are(1, [70.0, 90.0, 80.0])),
    "Mirror Pins": (
        nothing,
        lambda ui: ui.session.state.mirror is not None and ui.session.state.mirror.is_on,
    ),
    "Draw Mirror Axis": (nothing, lambda ui: ui.tool == "AxisIdle"),
    "Pair Pins": (
        lambda ui: ui.editor.select({1, 3}),
        lambda ui: ui.session.state.mirror is not None and ui.session.state.mirror.partner(1) == 3,
    ),
    "Unpair Pins": (paired, lambda ui: ui.session.state.mirror.partner(1) is None),
    "Flip Pose": (bent, lambda ui: ui.session.history.undo_label == "Flip Pose"),
    "Finish": (one_selected, lambda ui: not ui.editor.selection),
    "Stiffness Brush": (nothing, lambda ui: ui.editor.chosen_tool is ui.editor.brush_tool),
    "Erase Stiffness": (with_tool("brush_tool"), lambda ui: ui.editor.brush_tool.brush.erasing),
    "Decrease Brush Size": (
        with_tool("brush_tool"),
        lambda ui: ui.editor.brush_tool.brush.radius < Brush().radius,
    ),
    "Increase Brush Size": (
        with_tool("brush_tool"),
        lambda ui: ui.editor.brush_tool.brush.radius > Brush().radius,
    ),
    "Clear Loose Parts": (loosened, lambda ui: ui.session.state.loose is None),
    "Clear Stiffness": (stiffened, lambda ui: ui.session.state.stiffness is None),
    "Hold Angle": (one_selected, lambda ui: [pin.angle is None for pin in ui.pins] == [True, False, True]),
}


def fitted(ui):
    camera = ui.editor.camera
    ui.editor.fit()
    expected, ui.editor.camera = ui.editor.camera, camera
    return expected


def test_every_command_has_a_case():
    assert {command.label for command in COMMANDS} == set(CASES)


def check(ui, command, run):
    prepare, holds = CASES[command.label]
    prepare(ui)
    assert not holds(ui), "the law must not hold before"
    run()
    assert holds(ui)
    assert not ui.state.error


@pytest.mark.parametrize(("path", "command"), ITEMS, ids=[command.label for _, command in ITEMS])
def test_by_menu(pinned, path, command):
    check(pinned, command, lambda: pinned.menu(*path))


CHORDS = [(command, chord) for command in COMMANDS for chord in command.chords]


@pytest.mark.parametrize(("command", "chord"), CHORDS, ids=[f"{c.label}-{chord_name(k)}" for c, k in CHORDS])
def test_by_key(pinned, command, chord):
    check(pinned, command, lambda: pinned.key(chord))


@pytest.mark.parametrize(
    ("key", "text"),
    [("equal", "+"), ("right_bracket", "+"), ("keypad_add", "+")],
    ids=["US", "German", "keypad"],
)
def test_a_typed_plus_zooms_in_once_wherever_the_keyboard_has_it(pinned, key, text):
    moved_camera(pinned)
    io = imgui.get_io()
    if key == "equal":
        io.add_key_event(imgui.Key.mod_shift, True)
        io.add_key_event(imgui.Key.left_shift, True)
    io.add_key_event(imgui.Key[key], True)
    io.add_input_character(ord(text))
    io.add_key_event(imgui.Key[key], False)
    if key == "equal":
        io.add_key_event(imgui.Key.left_shift, False)
        io.add_key_event(imgui.Key.mod_shift, False)
    pinned.settle()
    assert pinned.editor.camera.zoom == pytest.approx(0.7 * 1.25)


MISSING = [command for command in COMMANDS if command.missing]


@pytest.mark.parametrize("command", MISSING, ids=[command.label for command in MISSING])
def test_a_key_that_cannot_do_anything_now_says_why(ui, command):
    assert not command.enabled(ui.state)
    ui.key(command.chords[0])
    assert ui.state.notice == command.missing


BUTTONS = [
    commands.PIN_TOOL,
    commands.HAND_TOOL,
    commands.BRUSH_TOOL,
    commands.KNIFE_TOOL,
    commands.UNDO,
    commands.REDO,
    commands.REMOVE_SELECTED,
    commands.FIT,
    commands.SHOW_MESH,
]


@pytest.mark.parametrize("command", BUTTONS, ids=[command.label for command in BUTTONS])
def test_by_button(pinned, command):
    check(pinned, command, lambda: pinned.tool_button(command))


def test_no_key_means_two_things():
    chords = [int(chord) for command in COMMANDS for chord in command.chords]
    assert len(set(chords)) == len(chords)


@pytest.mark.parametrize(
    ("chord", "name"),
    [
        (CTRL | SHIFT | Key.z, "Ctrl+Shift+Z"),
        (Key.delete, "Del"),
        (Key._1, "1"),
        (CTRL | Key.equal, "Ctrl+="),
        (Key.f1, "F1"),
    ],
)
def test_chord_name(chord, name):
    assert chord_name(chord) == name


@pytest.mark.parametrize(
    "command", [commands.UNDO, commands.REDO, commands.REMOVE_SELECTED, commands.RESET_POSE]
)
def test_commands_that_have_nothing_to_do_are_disabled(pinned, command):
    assert not command.enabled(pinned.state)
    revision = pinned.document.revision
    pinned.key(*command.chords)
    assert pinned.document.revision == revision
    assert pinned.session.history.depth == 0


def test_undo_and_redo_restore_bit_for_bit(pinned):
    rest = pinned.session.state
    pinned.bend()
    bent = pinned.session.state
    pinned.key(CTRL | Key.z)
    assert pinned.session.state is rest
    pinned.key(CTRL | SHIFT | Key.z)
    assert pinned.session.state.positions.tobytes() == bent.positions.tobytes()
    pinned.key(CTRL | Key.z, CTRL | Key.y)
    assert pinned.session.state.positions.tobytes() == bent.positions.tobytes()


def test_a_shortcut_within_one_frame_is_not_its_key_alone(pinned):
    """Ctrl+B is no shortcut, B alone is the brush."""
    io = imgui.get_io()
    io.add_key_event(CTRL, True)
    io.add_key_event(Key.b, True)
    on_key(None, glfw.KEY_LEFT_CONTROL, 0, glfw.RELEASE, 0)
    io.add_key_event(CTRL, False)
    io.add_key_event(Key.b, False)
    pinned.settle()
    assert pinned.editor.chosen_tool is pinned.editor.pins_tool
    assert not io.key_ctrl


def test_escape_cancels_first_and_then_deselects(pinned):
    pinned.editor.select({3})
    start, seen = pinned.to_screen(pinned.pin_position(3)), []

    def act(hand):
        pinned.begin_drag(hand, start)
        hand.mouse_move_to_pos(imgui.ImVec2(start[0], start[1] - 50))
        hand.key_press(Key.escape)
        hand.mouse_up(0)
        hand.yield_(2)
        seen.append((pinned.session.history.labels, pinned.editor.selection))
        hand.key_press(Key.escape)
        hand.yield_(2)
        seen.append((pinned.session.history.labels, pinned.editor.selection))

    pinned.do(act)
    assert seen == [([], {3}), ([], frozenset())]


def test_enter_keeps_what_a_drag_has_done(pinned):
    start = pinned.to_screen(pinned.pin_position(3))

    def act(hand):
        pinned.begin_drag(hand, start)
        hand.mouse_move_to_pos(imgui.ImVec2(start[0], start[1] - 50))
        hand.key_press(Key.enter)
        hand.yield_(2)
        hand.mouse_move_to_pos(imgui.ImVec2(start[0] + 90, start[1]))
        hand.mouse_up(0)

    pinned.do(act)
    assert pinned.session.history.labels == ["Drag Pin"]
    assert pinned.to_screen(pinned.pin_position(3)) == pytest.approx((start[0], start[1] - 50), abs=1.5)


def test_no_letter_alone_toggles_an_overlay():
    view = dict(MENUS)["View"]
    switches = [item for item in view if isinstance(item, Command) and item.checked is not None]
    letters = {getattr(Key, letter) for letter in "abcdefghijklmnopqrstuvwxyz"}
    assert len(switches) > 8
    assert not [item.label for item in switches if letters & set(map(Key, filter(_is_key, item.chords)))]


def _is_key(chord):
    return chord in set(map(int, Key))


def test_all_keys_of_commands_are_different():
    chords = [int(chord) for command in COMMANDS for chord in command.chords]
    assert sorted(chords) == sorted(set(chords))


def test_space_presses_no_button_that_was_clicked_before(pinned):
    pinned.tool_button(commands.SHOW_MESH)
    start = pinned.to_screen(pinned.pin_position(2))
    camera = pinned.editor.camera
    pinned.drag(start, (start[0] + 30, start[1]), held=Key.space)
    assert pinned.editor.camera != camera
    assert pinned.state.view.show_mesh


def test_keys_do_nothing_while_a_name_is_typed(pinned):
    pinned.editor.select({1})
    pinned.key(CTRL | Key.o)
    pinned.type_name("Open picture or drawing", "mfb", enter=False)
    pinned.key(Key.delete)
    assert pinned.file_request.name == "mfb"
    assert not pinned.state.view.show_mesh
    assert len(pinned.pins) == 3
    pinned.key(Key.escape)
    assert pinned.file_request is None
