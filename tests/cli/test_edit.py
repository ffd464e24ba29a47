"""`akap-editor edit` without a display, and with a mask."""

import importlib

import numpy as np
import pytest
from PIL import Image

from akap_editor.cli import replay as replaying
from akap_editor.errors import InputError
from akap_editor.io.images import read_image, write_png
from akap_editor.io.open_document import open_document
from tests.support.command_line import assert_one_line


def test_a_first_run_without_display_replays_the_bundled_recording(run, tmp_path, monkeypatch):
    wanted, written = [], []

    def smaller(*arguments, **options):
        wanted.append((arguments, options))
        if len(wanted) == 1:
            written.append(replay(*arguments, fps=6.0, size=96))
        return written[0]

    replay = replaying.replay_recording
    monkeypatch.setattr(replaying, "replay_recording", smaller)
    code, output, errors = run("edit", "--bundled", "elephant")
    assert (code, errors) == (0, "")
    assert "there is no display" in output.splitlines()[0]
    with Image.open(tmp_path / "out" / "elephant.webp") as animation:
        assert animation.n_frames > 10
    pose = read_image(tmp_path / "out" / "elephant.png")
    assert (pose[..., 3] > 127).sum() > 10_000
    assert "elephant.png" in output
    assert "elephant.webp" in output

    code, alone, errors = run()
    assert (code, errors) == (0, "")
    assert alone.splitlines()[0] == output.splitlines()[0]
    (first, options), (second, options_alone) = wanted
    assert options == options_alone == {"fps": 24.0, "size": 480}
    assert second[:2] == first[:2], "without arguments it does the same"
    assert [path.name for path in second[2:]] == ["elephant-2.webp", "elephant-2.png"], "it replaces nothing"


def test_an_unknown_bundled_drawing_is_an_error_that_names_those_there_are(run, tmp_path):
    assert_one_line(run("edit", "--bundled", "mammoth"), "mammoth", "elephant")
    assert not (tmp_path / "out").exists()


def test_a_picture_without_display_is_an_error(run, picture, tmp_path):
    before = sorted(tmp_path.iterdir())
    assert_one_line(run(picture), "no display")
    assert sorted(tmp_path.iterdir()) == before


def test_a_mask_is_put_on_the_picture_that_is_opened(run, picture, tmp_path, monkeypatch):
    opened = []
    module = importlib.import_module("akap_editor.cli.edit")  # the name in the package is the command
    monkeypatch.setattr(module, "open_window", lambda document, *_: opened.append(document))
    mask = np.zeros((60, 90), np.uint8)
    mask[20:40, 20:60] = 255
    write_png(tmp_path / "mask.png", np.dstack([mask, mask, mask, np.full_like(mask, 255)]))
    assert run("edit", picture, "--mask", tmp_path / "mask.png") == (0, "", "")
    alpha = opened[0].drawing.image[..., 3]
    assert (alpha[20:40, 20:60] == 255).all()
    assert (alpha[mask == 0] == 0).all()
    write_png(tmp_path / "small.png", np.full((5, 5, 4), 255, np.uint8))
    with pytest.raises(InputError, match="mask: expected the size of the picture, 90 x 60 pixels, got 5 x 5"):
        open_document(picture, tmp_path / "small.png")
