"""The start page, and what the program opens at its start."""

from imgui_bundle import imgui  # isort: skip
import math
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from akap_editor.app.commands.command import CTRL, Key
from akap_editor.app.jobs.file_thumbnails import FileThumbnails
from akap_editor.app.jobs.tile_motion import FRAMES_PER_SECOND, TileMotions
from akap_editor.cli.edit import edit
from akap_editor.errors import InputError
from akap_editor.io.images import read_image, write_png
from akap_editor.resources import bundled_drawings

START = "//Start/"


@pytest.fixture
def closed(ui):
    """The window with nothing open."""
    ui.key(CTRL | Key.w)
    assert ui.state.document is None
    return ui


def test_close_shows_the_start_page_and_nothing_of_the_drawing(ui):
    left, top, right, bottom = map(round, ui.editor.canvas)
    x, y = map(round, ui.to_screen((70.0, 80.0)))
    drawn = ui.screenshot()[y, x]
    ui.menu("File", "Close")
    assert ui.state.document is None
    assert ui.state.title == "akap-editor"
    shot = ui.screenshot()
    assert (shot[top:bottom, left:right] != drawn).any(axis=2).mean() > 0.99
    ui.do(lambda hand: [hand.item_info(START + path.stem) for path in bundled_drawings()])


def test_closing_asks_for_unsaved_changes(pinned):
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0], start[1] - 80))
    pinned.key(CTRL | Key.w)
    assert pinned.state.document is not None
    pinned.dialog("Unsaved changes", "Cancel")
    assert pinned.state.document is not None
    pinned.key(CTRL | Key.w)
    pinned.dialog("Unsaved changes", "Don't Save")
    assert pinned.state.document is None


@pytest.mark.parametrize("path", bundled_drawings()[1:3], ids=lambda path: path.stem)
def test_a_thumbnail_opens_its_drawing(closed, path):
    closed.do(lambda hand: hand.item_click(START + path.stem))
    closed.settle()
    assert closed.document.drawing.name == path.stem
    assert closed.editor.camera == closed.editor._fitted


def test_thumbnails_show_the_drawings(closed):
    """Each thumbnail shows about as much as is visible of its drawing."""
    shot = closed.screenshot()
    places = {}

    def look(hand):
        for path in bundled_drawings():
            rect = hand.item_info(START + path.stem).rect_full
            places[path] = round(rect.min.x), round(rect.min.y), round(rect.max.x), round(rect.max.y)

    closed.do(look)
    assert len({place[1] for place in places.values()}) == 1, "all in one row"
    for path, (left, top, right, bottom) in places.items():
        alpha = read_image(path)[..., 3]
        visible = (alpha > 200).sum() / max(alpha.shape) ** 2  # of the square that the drawing fits into
        part = shot[top + 12 : bottom - 30, left + 12 : right - 12].astype(int)
        tile = np.median(part[0], axis=0)  # the color around the drawing
        assert (np.abs(part - tile).max(axis=2) > 30).mean() > 0.6 * visible, path.stem


def test_the_drop_zone_asks_for_a_file(closed):
    closed.do(lambda hand: hand.item_click(f"{START}Drop a picture here"))
    assert closed.file_request is not None
    closed.key(Key.escape)
    assert closed.file_request is None


def test_recent_files_are_listed_and_opened(closed, tmp_path, image):
    path = tmp_path / "a folder with a rather long name" / "seen before.png"
    path.parent.mkdir()
    write_png(path, image)
    closed.state.preferences.add_recent(path)
    closed.settle()
    closed.do(lambda hand: hand.item_click(f"{START}##recent 0"))
    closed.settle()
    assert closed.document.drawing.name == "seen before"
    closed.key(CTRL | Key.w)
    closed.menu("File", "Open Recent", "###0")
    closed.settle()
    assert closed.document.drawing.name == "seen before"


def test_a_tile_moves_while_the_pointer_is_over_it(closed):
    (path,) = (each for each in bundled_drawings() if each.stem == "raptor")
    tiles = closed.state.part(TileMotions)
    seen = []

    def rest_on_it(hand):
        hand.mouse_move(START + path.stem)
        while tiles.frame(path, closed.window.wake) is None:
            hand.yield_()
        hand.yield_(2)
        seen.append(closed.state.frame_delay)
        hand.mouse_move_to_pos(imgui.ImVec2(640.0, 60.0))
        hand.yield_(2)
        seen.append(closed.state.frame_delay)

    closed.do(rest_on_it)
    assert seen == [1 / FRAMES_PER_SECOND, math.inf]


def test_a_recent_file_has_a_thumbnail(closed, tmp_path, image):
    path = tmp_path / "seen.png"
    write_png(path, image)
    plain = closed.screenshot()
    closed.state.preferences.add_recent(path)
    closed.settle()
    thumbnails = closed.state.part(FileThumbnails)
    closed.frame_until(lambda: thumbnails.picture(path, 36, closed.window.wake) is not None)
    found = []
    closed.do(lambda hand: found.append(hand.item_info(f"{START}##recent 0").rect_full))
    low = found[0].min
    area = np.s_[round(low.y) + 4 : round(low.y) + 36, round(low.x) + 4 : round(low.x) + 36]
    assert (closed.screenshot()[area] != plain[area]).any(axis=2).mean() > 0.2


def test_a_picture_dropped_on_the_start_page_opens(closed, tmp_path, image):
    write_png(tmp_path / "dropped.png", image)
    closed.drop(tmp_path / "dropped.png")
    closed.settle()
    assert closed.document.drawing.name == "dropped"


def test_a_bad_file_leaves_the_start_page(closed, tmp_path):
    (tmp_path / "bad.png").write_text("no picture")
    closed.drop(tmp_path / "bad.png")
    closed.settle()
    assert "bad.png" in closed.state.error
    assert closed.state.document is None
    closed.dialog("Error", "OK")
    closed.do(lambda hand: hand.item_click(f"{START}bar"))
    closed.settle()
    assert closed.document.drawing.name == "bar"


@pytest.fixture
def shown(monkeypatch):
    """What `edit` shows in place of a window: documents, and what could not be opened."""
    seen = []

    class Screen:
        state = SimpleNamespace(error="")

        def __init__(self, **options):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *error):
            pass

        def run(self, document):
            seen.append((document, self.state.error))

    monkeypatch.setenv("DISPLAY", ":of-a-test")
    monkeypatch.setattr("akap_editor.app.window.Window", Screen)
    return seen


def test_a_file_that_cannot_be_opened_at_the_start_leads_to_the_start_page(shown, tmp_path):
    edit.callback(tmp_path / "missing.png", None)
    ((document, error),) = shown
    assert document is None
    assert "missing.png" in error


def test_without_a_file_the_program_begins_with_the_start_page(shown):
    edit.callback(None, None)
    assert shown == [(None, "")]


def test_a_bundled_drawing_is_opened_by_its_name(shown):
    edit.callback(None, None, "cat")
    ((document, error),) = shown
    assert (document.drawing.name, error) == ("cat", "")


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        ((None, None, "mammoth"), r"elephant.*, got 'mammoth'"),
        (("a.png", None, "cat"), "got both: a.png and cat"),
        ((None, "mask.png", None), "expected a FILE .* mask.png"),
        ((None, "mask.png", "cat"), "expected a FILE .* mask.png"),
    ],
)
def test_arguments_that_make_no_sense_open_no_window(shown, arguments, part):
    with pytest.raises(InputError, match=part):
        edit.callback(*arguments)
    assert not shown


def test_without_a_display_a_file_that_cannot_be_opened_is_an_error(monkeypatch, tmp_path):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    with pytest.raises(InputError, match=r"missing\.png"):
        edit.callback(tmp_path / "missing.png", None)


def test_drop_works_while_a_page_of_help_is_open(ui, tmp_path, image):
    write_png(tmp_path / "dropped.png", image)
    ui.key(Key.f1)
    ui.drop(tmp_path / "dropped.png")
    ui.settle()
    assert ui.document.drawing.name == "dropped"
    ui.key(Key.escape)


def test_of_several_dropped_files_the_first_opens_and_that_is_said(ui, tmp_path, image):
    for name in ("one", "two"):
        write_png(tmp_path / f"{name}.png", image)
    ui.drop(tmp_path / "one.png", tmp_path / "two.png")
    ui.settle()
    assert ui.document.drawing.name == "one"
    assert ui.state.notice == "Opened one.png, the first of 2 files"
