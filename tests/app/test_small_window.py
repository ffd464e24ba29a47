"""Long names and the smallest window: nothing is cut off, nothing lies over anything else."""

from imgui_bundle import imgui  # isort: skip
from dataclasses import replace

import pytest

from akap_editor.app import widgets
from akap_editor.app.requests import Question
from akap_editor.app.window import SMALLEST
from akap_editor.editor.document import new_document

LONG = "a drawing whose name somebody has typed without thinking of panels at all, final version 27"


@pytest.fixture(scope="module")
def module_window(new_window):
    return new_window(size=SMALLEST)


def ask_save(space):
    space.save_as()


def ask_export(space):
    space.ask_export()


def ask_question(space):
    space.question = Question(lambda: None)


def show_keys(space):
    space.keys = True


def show_error(space):
    space.error = f"/a/folder/{LONG}.png: expected a picture, got something else"


@pytest.mark.parametrize(
    ("title", "ask"),
    [
        ("Save drawing", ask_save),
        ("Export", ask_export),
        ("Unsaved changes", ask_question),
        ("Keys and mouse", show_keys),
        ("That did not work", show_error),
    ],
)
def test_dialogs_are_wholly_in_the_window(ui, drawing, title, ask):
    ui.space.show(new_document(replace(drawing, name=LONG)))
    ask(ui.space)
    ui.settle()
    dialog = imgui.internal.find_window_by_name(f"{title}###dialog {title}")
    assert dialog.active
    assert dialog.scroll_max.x == 0
    assert dialog.scroll_max.y == 0
    assert dialog.pos.x >= 0
    assert dialog.pos.y >= 0
    assert dialog.pos.x + dialog.size.x <= SMALLEST[0]
    assert dialog.pos.y + dialog.size.y <= SMALLEST[1]


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
