"""Thumbnails of drawings and recordings for file managers."""

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.recording import Recording, drawing_header
from akap_editor.errors import InputError
from akap_editor.io.akap.project import save
from akap_editor.io.akap.recording import write_recording
from akap_editor.io.file_thumbnail import make_thumbnail
from akap_editor.resources import resource
from tests.support.pictures import bar_picture


@pytest.fixture
def drawing():
    return make_drawing(bar_picture(), vertices=60, name="bar")


@pytest.mark.parametrize(("side", "size"), [(256, (60, 90)), (45, (30, 45)), (1, (1, 1))])
def test_a_drawing_shows_its_picture_no_larger_than_asked(drawing, tmp_path, side, size):
    save(new_document(drawing), tmp_path / "a.akap")
    picture = make_thumbnail(tmp_path / "a.akap", side)
    assert picture.shape == (*size, 4)
    if side == 256:
        np.testing.assert_array_equal(picture[..., 3], drawing.image[..., 3])


def test_a_recording_shows_its_drawing(drawing, tmp_path):
    write_recording(Recording(drawing_header(drawing), []), tmp_path / "a.akaprec", drawing)
    assert make_thumbnail(tmp_path / "a.akaprec", 45).shape == (30, 45, 4)


def test_a_recording_shows_the_bundled_drawing_that_it_names():
    path = resource("assets", "recordings", "elephant.akaprec")
    assert make_thumbnail(path, 100).shape == (88, 100, 4)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.akap", b"PK\3\4 no zip"),
        ("a.akap", b""),
        ("a.akaprec", b"no json\n"),
        ("a.akaprec", b'{"format":"akap-recording","version":1,"drawing":{"akap":"no zip"}}\n'),
        ("a.akaprec", b'{"format":"akap-recording","version":1,"drawing":{"akap":7}}\n'),
        ("a.akaprec", b'{"format":"akap-recording","version":1,"drawing":{"name":["cat"]}}\n'),
        ("a.png", b"\x89PNG"),
        ("a", b"PK"),
    ],
)
def test_damaged_and_other_files_are_told_by_name(tmp_path, name, data):
    (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError, match=f"“?{name}"):
        make_thumbnail(tmp_path / name, 64)
