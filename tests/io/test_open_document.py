"""Opening pictures: thresholds, and what is said about them."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import write_png
from akap_editor.io.open_document import open_document, opening_notes


def written(path, *boxes):
    """A picture of 60 x 60 pixels with nested boxes of margins and opacities."""
    pixels = np.full((60, 60, 4), 90, np.uint8)
    pixels[..., 3] = 0
    for margin, alpha in boxes:
        pixels[margin:-margin, margin:-margin, 3] = alpha
    write_png(path, pixels)
    return path


def test_a_faint_drawing_opens_with_a_lower_threshold_and_says_so(tmp_path):
    document = open_document(written(tmp_path / "a.png", (15, 102)))
    assert document.drawing.meshing.threshold == 0.2
    (note,) = opening_notes(document)
    assert note == "The picture is faint, at most 40% opaque, so it was cut out at 20% opacity"


def test_what_the_threshold_cuts_off_is_said_with_the_way_to_keep_it(tmp_path):
    path = written(tmp_path / "a.png", (5, 60), (20, 255))
    (note,) = opening_notes(open_document(path))
    assert "of what is visible is fainter than the edge and left out" in note
    assert "--threshold" in note
    kept = open_document(path, threshold=0.1)
    assert kept.drawing.meshing.threshold == 0.1
    assert opening_notes(kept) == []
    save(open_document(path), tmp_path / "a.akap")
    assert opening_notes(load(tmp_path / "a.akap")) == []


def test_nothing_is_said_of_a_sharp_picture(tmp_path):
    assert opening_notes(open_document(written(tmp_path / "a.png", (20, 255)))) == []


def test_a_threshold_needs_a_picture(tmp_path):
    with pytest.raises(InputError, match=r"threshold: expected a picture to cut out, got a\.akap"):
        open_document(tmp_path / "a.akap", threshold=0.2)
