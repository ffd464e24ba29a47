"""In no state of the window, at no scale, a text is cut off or lies over another one."""

from imgui_bundle import imgui  # isort: skip
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from akap_editor.app import files
from akap_editor.app.commands import registry as commands
from akap_editor.app.commands.palette import Palette
from akap_editor.app.dialogs.clips import ClipsDialog
from akap_editor.app.dialogs.export.animation import ExportAnimationDialog
from akap_editor.app.dialogs.export.pose import ExportPoseDialog
from akap_editor.app.dialogs.first_steps import FirstSteps
from akap_editor.app.dialogs.question import Question, QuestionDialog
from akap_editor.app.dialogs.replace_files import replace_question
from akap_editor.app.frame import layout
from akap_editor.app.glfw_window import MIN_SIZE
from akap_editor.app.jobs.task import Progress, Task
from akap_editor.app.panels.side_panel import SECTIONS
from akap_editor.editor import gestures
from akap_editor.editor.events import PinRequest
from akap_editor.editor.tools.suggested_pins import suggest_pins
from akap_editor.io.open_document import open_document
from akap_editor.resources import resource
from akap_editor.words import use_language
from tests.support.layout_watch import watching
from tests.support.window_driver import WindowDriver

LONG = "a drawing whose name somebody has typed without thinking of panels at all, final version 27"
ADVANCED = ("Parameters", "Mesh parameters")
TOOLS = ("pins_tool", "hand_tool", "zoom_tool", "brush_tool", "joint_tool", "knife_tool")

STATES: dict[str, Callable[[WindowDriver], None]] = {}


def state(prepare: Callable[[WindowDriver], None]) -> Callable[[WindowDriver], None]:
    """Register a state of the window, which begins with three pins."""
    STATES[prepare.__name__] = prepare
    return prepare


@state
def start_page(ui):
    ui.editor.close()
    for name in ("cat.png", f"{LONG}/{LONG}.akap"):
        ui.state.preferences.add_recent(Path("/home/ada") / name)


def show_tab(ui, tab):
    for name in ("Rest", LONG[:80]):
        gestures.add_pose(ui.editor, name)
    titles = (*(section.title for section in SECTIONS if section.tab == tab), *ADVANCED)
    ui.unfold(tab, *titles)


@state
def pose_tab(ui):
    gestures.rename_pin(ui.editor, 1, LONG[:60])
    show_tab(ui, "Pose")


@state
def animate_tab(ui):
    show_tab(ui, "Animate")


@state
def mesh_tab(ui):
    ui.state.view.distortion_measure = "area"
    show_tab(ui, "Mesh")


@state
def puppet(ui):
    files.show_document(ui.state, open_document(resource("assets", "drawings", "robot.ora")))
    ui.unfold("Pose", "Layers", "Joints")
    ui.state.preferences.put("sections", {"Pins": False, "Poses": False, "Layers": True, "Joints": True})


@state
def one_pin(ui):
    gestures.rename_pin(ui.editor, 1, LONG[:60])
    ui.editor.select({1})


@state
def several_pins(ui):
    ui.editor.select({1, 2})


@state
def values_of_a_pin(ui):
    ui.editor.select({1})
    ui.editor.request = PinRequest("values", 1)


@state
def menu_of_a_pin(ui):
    ui.editor.select({1})
    ui.editor.request = PinRequest("menu", 1)


for tool_name in TOOLS:

    def choose_tool(ui, name=tool_name):
        ui.editor.chosen_tool = getattr(ui.editor, name)

    STATES[tool_name] = choose_tool


@state
def loose_brush(ui):
    ui.editor.chosen_tool = ui.editor.brush_tool
    ui.editor.brush_tool.brush = replace(ui.editor.brush_tool.brush, paints="loose")


@state
def suggested(ui):
    suggest_pins(ui.editor)


@state
def session(ui):
    ui.state.timeline.is_shown = True


def show_keyframes(ui):
    ui.state.timeline.show_keyframes()
    for time in (0.0, 1.0):
        ui.state.timeline.keyframe_playback.set_keyframe(time)


@state
def keyframes(ui):
    show_keyframes(ui)
    ui.state.view.show_speed_graph = True


@state
def compared(ui):
    ui.state.view.is_split = True


@state
def first_steps(ui):
    ui.state.part(FirstSteps).is_open = True


@state
def notice(ui):
    ui.state.notice = f"Exported {LONG}.png"
    ui.state.exported = ui.state.notice, Path(f"/home/ada/{LONG}.png")


@state
def error(ui):
    ui.state.error = f"/a/folder/{LONG}.png: expected a picture, got something else"


@state
def progress(ui):
    def steps():
        while True:
            yield Progress(0.37, f"Reading {LONG}", is_blocked=True)

    ui.state.begin_task(Task(f"Opening {LONG}", steps(), finish_early=lambda: None))


@state
def preferences(ui):
    commands.PREFERENCES.run(ui.state)


@state
def shortcuts(ui):
    commands.SHORTCUTS.run(ui.state)


@state
def about(ui):
    commands.ABOUT.run(ui.state)


@state
def palette(ui):
    ui.state.part(Palette).open(commands.PALETTE_ITEMS, "sho")


@state
def clips(ui):
    ui.state.part(ClipsDialog).open(ui.state)


@state
def export(ui):
    ui.state.part(ExportPoseDialog).open(ui.state)


@state
def export_animation(ui):
    show_keyframes(ui)
    ui.state.part(ExportAnimationDialog).open(ui.state)


@state
def save_as(ui):
    files.save_as(ui.state)


@state
def unsaved_changes(ui):
    text = f"Save changes to “{LONG}” before closing?"
    question = Question("Unsaved changes", text, "Save", lambda: None, "Don't Save", lambda: None)
    ui.state.part(QuestionDialog).ask(question)


@state
def replaced_files(ui):
    question = replace_question(f"“{LONG}” exists already.", lambda: None, "Other Name...", lambda: None)
    ui.state.part(QuestionDialog).ask(question)


@pytest.fixture(
    scope="module",
    params=[
        *((MIN_SIZE, 1.0, language) for language in ("en", "de", "fr")),  # these two have the longest words
        (MIN_SIZE, 1.5, "en"),
        ((1280, 800), 2.0, "en"),
    ],
    ids=["least", "least, German", "least, French", "least at 150 %", "200 %"],
)
def module_window(request, new_window):
    size, scale, language = request.param
    ui = new_window(size=tuple(round(scale * side) for side in size), scale=scale)
    use_language(language)
    yield ui
    use_language("en")


@pytest.mark.parametrize("name", STATES)
def test_all_texts_have_room(pinned, drawing, name):
    layout.show_tab(pinned.state, "Pose")
    STATES[name](pinned)
    with watching() as watch:
        for _ in range(6):  # until popups have their size
            watch.begin_frame()
            pinned.frame()
    pinned.state.task = None
    assert watch.faults == []
    assert len({text.text for text in watch.texts}) > 10, "it has seen the window"


def test_texts_without_room_are_found(pinned):
    """Of a button that is too narrow, a text beyond the edge, and two at one place."""

    def draw():
        imgui.begin("Faults")
        imgui.button("too narrow###button", imgui.ImVec2(20, 20))
        imgui.set_cursor_pos(imgui.ImVec2(imgui.get_window_width() - 9, 60))
        imgui.text("beyond the edge")
        for text in ("one", "two"):
            imgui.get_window_draw_list().add_text(
                imgui.get_window_pos() + imgui.ImVec2(50, 40), 0xFFFFFFFF, text
            )
        imgui.end()

    with watching() as watch, pytest.MonkeyPatch.context() as patch:
        patch.setattr("akap_editor.app.window.draw_legend", lambda *_: draw())
        for _ in range(3):
            watch.begin_frame()
            pinned.frame()
    found = {fault for fault in watch.faults if fault.startswith("Faults: ")}
    assert "Faults: “beyond the edge” is cut off at the edge" in found
    assert "Faults: “one” and “two” lie over each other" in found
    assert any(fault.startswith("Faults: “too narrow” needs") for fault in found)
