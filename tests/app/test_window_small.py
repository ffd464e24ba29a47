"""Long names and the smallest window: nothing is cut off, nothing lies over anything else."""

from imgui_bundle import imgui  # isort: skip
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.app import files, widgets
from akap_editor.app.commands import registry as commands
from akap_editor.app.dialogs.export.animation import ExportAnimationDialog
from akap_editor.app.dialogs.export.pose import ExportPoseDialog
from akap_editor.app.dialogs.question import QuestionDialog
from akap_editor.app.glfw_window import MIN_SIZE
from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.session.edits import AddPose

LONG = "a drawing whose name somebody has typed without thinking of panels at all, final version 27"


@pytest.fixture(scope="module")
def module_window(new_window):
    return new_window(size=MIN_SIZE)


def ask_save(state):
    files.save_as(state)


def ask_export(state):
    state.part(ExportPoseDialog).open(state)


def ask_animation(state):
    state.timeline.show_keyframes()
    playback = state.timeline.keyframe_playback
    for time in (0.0, 1.0):
        playback.set_keyframe(time)
    state.part(ExportAnimationDialog).open(state)


def ask_question(state):
    state.editor.apply("Add Pose", AddPose("pose"))
    files.close_document(state)
    assert state.part(QuestionDialog).is_open


def show_keys(state):
    commands.SHORTCUTS.run(state)


def show_error(state):
    state.error = f"/a/folder/{LONG}.png: expected a picture, got something else"


@pytest.mark.parametrize(
    ("title", "ask"),
    [
        ("Save drawing", ask_save),
        ("Export", ask_export),
        ("Export animation", ask_animation),
        ("Unsaved changes", ask_question),
        ("Keyboard shortcuts", show_keys),
        ("Error", show_error),
    ],
)
def test_dialogs_are_wholly_in_the_window(ui, drawing, title, ask):
    files.show_document(ui.state, new_document(replace(drawing, name=LONG)))
    ask(ui.state)
    ui.settle()
    dialog = imgui.internal.find_window_by_name(f"{title}###dialog {title}")
    assert dialog.active
    assert dialog.scroll_max.x == 0
    assert dialog.scroll_max.y == 0
    assert dialog.pos.x >= 0
    assert dialog.pos.y >= 0
    assert dialog.pos.x + dialog.size.x <= MIN_SIZE[0]
    assert dialog.pos.y + dialog.size.y <= MIN_SIZE[1]


def test_texts_are_shortened_to_the_room_there_is(ui):
    """In a frame, as texts are measured with its font."""
    seen, name = [], LONG.replace(" ", "-")

    def measure():
        room = imgui.calc_text_size("MMMMMMMMMM").x
        for end in (False, True):
            short = widgets.shortened(name, room, end)
            more = f"…{name[-len(short) :]}" if end else f"{name[: len(short)]}…"  # by one letter
            seen.append((short, imgui.calc_text_size(short).x <= room < imgui.calc_text_size(more).x))
        seen.append(widgets.shortened("short", room))
        seen.append(widgets.shortened(name, 0.0))

    ui.window.after_draw.append(measure)
    ui.frame()
    ui.window.after_draw.clear()
    (begin, begins_fit), (end, ends_fit), short, least = seen
    assert begins_fit
    assert ends_fit
    assert name.startswith(begin.rstrip("…"))
    assert begin.endswith("…")
    assert name.endswith(end.removeprefix("…"))
    assert short == "short"
    assert least == "…"


def test_texts_are_broken_between_words_and_folders_alone(ui):
    text = "Save the changes to figure.akap, from /home/ada/Pictures/figure.akap?\nIt is 0.5 MB."
    seen = {}

    def look():
        for width in range(40, 600, 20):
            seen[width] = widgets.wrapped(text, width), imgui.calc_text_size

    ui.window.after_draw.append(lambda: seen or look())
    try:
        ui.window.wake()
        ui.settle()
    finally:
        ui.window.after_draw.clear()
    for width, (broken, measure) in seen.items():
        lines = broken.split("\n")
        assert "".join(broken.split()) == "".join(text.split()), "nothing is lost"
        parts = [part for line in lines for part in line.replace("/", "/ ").split()]
        assert parts == text.replace("/", "/ ").split(), "no word is cut"
        assert lines[-1].endswith("MB.")
        assert all(measure(line).x <= width for line in lines if " " in line)
    assert len(seen[580][0].split("\n")) == 2
    assert len(seen[200][0].split("\n")) > 3


def test_all_tools_are_seen_above_the_timeline(ui):
    ui.state.timeline.is_shown, ui.state.timeline.mode = True, "keyframes"
    ui.settle()
    tools, timeline = map(imgui.internal.find_window_by_name, ("Tools", "Timeline"))
    assert tools.scroll_max.y == 0
    found = []
    last = commands.SHOW_MESH
    ui.do(lambda hand: found.append(hand.item_info(f"//Tools/{last.icon}##{last.label}").rect_full))
    assert tools.pos.y < found[0].min.y < found[0].max.y <= timeline.pos.y
    low, high = found[0].min, found[0].max
    button = ui.screenshot()[round(low.y) : round(high.y), round(low.x) : round(high.x)].astype(int)
    icon = (np.abs(button - button[0, 0]).max(axis=2) > 60).any(axis=0).sum()
    assert icon >= 12, "its icon is whole, too"


def test_the_captions_of_two_methods_stay_in_their_halves(pinned):
    """Between the captions and the line in the middle nothing is written."""
    pinned.state.view.is_split, pinned.state.view.show_pins = True, False
    picture = pinned.screenshot().astype(int)
    left, _, middle, bottom = map(int, pinned.editor.canvas)
    below = picture[bottom - 70 : bottom - 4, left:middle]
    written = np.ptp(below, axis=2).max(axis=0) + np.ptp(below, axis=0).max(axis=1)
    assert written[20:60].max() > 100, "there are captions"
    assert written[-8:-2].max() < 20


def test_a_long_name_of_a_pose_moves_no_other(ui):
    names = ("Rest", LONG[:80], "Wave")
    for name in names:
        gestures.add_pose(ui.editor, name)
    ui.state.preferences.put("sections", {"Pins": False})
    ui.settle()
    found = {}

    def look(hand):
        found.update({name: hand.item_info(f"//Panel/**/pose {name}").rect_full.min for name in names})

    ui.do(look)
    first, second, third = (found[name] for name in names)
    assert third.y == second.y == first.y
    assert third.x - second.x == second.x - first.x


def test_the_pin_that_is_selected_is_seen_in_the_list(ui):
    for x in range(50, 220, 10):
        gestures.add_pin(ui.editor, (float(x), 80.0))
    for pin in (17, 1):
        ui.editor.select({pin})
        ui.settle()
        (rows,) = (window for window in imgui.get_current_context().windows if "##pins" in window.name)
        first = round(rows.scroll.y / imgui.get_text_line_height_with_spacing())
        assert first < pin <= first + 6


def test_the_present_step_of_a_long_history_is_seen_below_whole_rows(pinned):
    for depth in range(1, 21):
        gestures.set_depth(pinned.editor, 1, depth)
    folded = dict.fromkeys(("Pins", "Poses", "Bending"), False)
    pinned.state.preferences.put("sections", {**folded, "History": True})
    pinned.editor.undo_or_redo_to(11)
    pinned.settle()
    (rows,) = (window for window in imgui.get_current_context().windows if "##history" in window.name)
    height = imgui.get_text_line_height_with_spacing()
    assert rows.scroll.y > 0
    assert rows.scroll.y % height == 0
    assert rows.scroll.y / height < 11 < rows.scroll.y / height + 6
