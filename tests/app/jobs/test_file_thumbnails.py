"""Thumbnails of recent files."""

import numpy as np
import pytest

from akap_editor.app.jobs.background_thread import no_window
from akap_editor.app.jobs.file_thumbnails import FileThumbnails, file_thumbnail
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.akap.project import save
from akap_editor.io.images import write_png
from tests.support.pictures import figure_picture


@pytest.mark.parametrize("suffix", [".png", ".akap"])
def test_a_file_has_a_picture_of_the_size(tmp_path, suffix):
    path, image = tmp_path / f"a{suffix}", figure_picture(2)
    if suffix == ".png":
        write_png(path, image)
    else:
        save(new_document(make_drawing(image, vertices=200)), path)
    picture = file_thumbnail(path, 40)
    assert max(picture.shape[:2]) == 40
    assert 0 < picture[..., 3].mean() < 255


@pytest.mark.parametrize(
    ("name", "content"), [("a.png", b"no picture"), ("a.akap", b""), ("a.txt", b"text"), ("gone.png", None)]
)
def test_what_cannot_be_read_has_none(tmp_path, name, content):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    assert file_thumbnail(tmp_path / name, 40) is None


def test_it_is_made_once_in_a_thread(tmp_path):
    write_png(tmp_path / "a.png", figure_picture(2))
    thumbnails, woken = FileThumbnails(), []
    while (picture := thumbnails.picture(tmp_path / "a.png", 32, lambda: woken.append(1))) is None:
        pass
    (tmp_path / "a.png").unlink()
    assert thumbnails.picture(tmp_path / "a.png", 32, no_window) is picture
    assert np.isfinite(picture).all()
