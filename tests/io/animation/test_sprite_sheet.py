import json

import numpy as np
import pytest
from scipy import ndimage

from akap_editor.errors import InputError
from akap_editor.io.animation.sprite_sheet import GUTTER, MAX_SHEET_SIDE, write_frames, write_sheet
from akap_editor.io.images import read_image


def dot(step, height=20, width=30):
    """A dot that moves, with margins that are always empty."""
    image = np.zeros((height, width, 4), dtype=np.uint8)
    image[5 + step, 10 + step] = (200, 10 * step, 0, 255)
    return image


def test_the_index_finds_every_frame_in_the_sheet(tmp_path):
    frames = [dot(step) for step in range(7)]
    columns, rows = write_sheet(tmp_path / "walk.png", iter(frames), fps=12)
    assert columns * rows >= 7 > columns * (rows - 1)
    sheet = read_image(tmp_path / "walk.png")
    index = json.loads((tmp_path / "walk.json").read_text())
    assert index["meta"]["image"] == "walk.png"
    assert index["meta"]["size"] == {"w": sheet.shape[1], "h": sheet.shape[0]}
    for entry, image in zip(index["frames"], frames, strict=True):
        at, place, size = entry["frame"], entry["spriteSourceSize"], entry["sourceSize"]
        again = np.zeros((size["h"], size["w"], 4), dtype=np.uint8)
        again[place["y"] : place["y"] + place["h"], place["x"] : place["x"] + place["w"]] = sheet[
            at["y"] : at["y"] + at["h"], at["x"] : at["x"] + at["w"]
        ]
        np.testing.assert_array_equal(again, image)
    assert (index["frames"][0]["spriteSourceSize"]["x"], index["frames"][0]["frame"]["w"]) == (10, 7)
    assert sum(entry["duration"] for entry in index["frames"]) == round(7000 / 12)


def test_a_sheet_of_nothing_is_a_sheet(tmp_path):
    write_sheet(tmp_path / "a.png", [np.zeros((4, 6, 4), dtype=np.uint8)] * 2, fps=10)
    sheet = read_image(tmp_path / "a.png")
    assert not sheet.any()
    index = json.loads((tmp_path / "a.json").read_text())
    assert [entry["frame"] for entry in index["frames"]] == [
        {"x": 2, "y": 2, "w": 6, "h": 4},
        {"x": 2, "y": 8, "w": 6, "h": 4},
    ]


@pytest.mark.parametrize("count", [1, 2, 5, 7])
def test_frames_are_apart_from_each_other_and_from_the_rim(tmp_path, count):
    write_sheet(tmp_path / "a.png", [np.full((5, 6, 4), 9, dtype=np.uint8)] * count, fps=10)
    covered = read_image(tmp_path / "a.png")[..., 3] > 0
    assert covered.sum() == count * 30
    assert ndimage.label(ndimage.binary_dilation(covered, np.ones((GUTTER, GUTTER))))[1] == count
    inner = covered[GUTTER:-GUTTER, GUTTER:-GUTTER]
    assert inner.sum() == covered.sum()


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        ([], "at least one frame"),
        ([dot(0), dot(0, 21)], "frame 1: expected 30 x 20 pixels as in frame 0, got 30 x 21"),
        ([dot(0)[..., :3]], "frame 0: expected shape"),
        ([np.full((1, MAX_SHEET_SIDE + 1, 4), 9, dtype=np.uint8)], "choose a smaller size or rate"),
    ],
)
def test_bad_sheets_are_told_and_nothing_is_written(tmp_path, frames, message):
    with pytest.raises(InputError, match=message):
        write_sheet(tmp_path / "a.png", frames, fps=10)
    assert list(tmp_path.iterdir()) == []


def test_frames_are_numbered_and_those_of_a_longer_animation_go(tmp_path):
    folder = tmp_path / "new" / "frames"
    assert write_frames(folder, [dot(step) for step in range(5)]) == 5
    (folder / "notes.txt").write_text("stays")
    assert write_frames(folder, [dot(6), dot(2)]) == 2
    assert sorted(path.name for path in folder.iterdir()) == ["frame-0000.png", "frame-0001.png", "notes.txt"]
    np.testing.assert_array_equal(read_image(folder / "frame-0000.png"), dot(6))


def test_a_file_in_the_way_of_a_folder_is_told(tmp_path):
    (tmp_path / "frames").write_text("a file")
    with pytest.raises(InputError, match=r"Couldn't save “.*frames”"):
        write_frames(tmp_path / "frames", [dot(0)])
