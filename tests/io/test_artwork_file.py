"""The picture that a drawing was made from: what documents say of it, and whether it has changed."""

import json
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest

from akap_editor.editor.document.document import ArtworkFile
from akap_editor.errors import InputError
from akap_editor.io.akap.autosave import RecoveryCopy
from akap_editor.io.akap.picture_record import describe_source, read_source
from akap_editor.io.akap.project import encode_document, load, save
from akap_editor.io.artwork_file import artwork_file
from akap_editor.io.images import write_png
from akap_editor.io.open_document import open_document
from akap_editor.resources import bundled_drawings
from tests.support.pictures import figure_picture


@pytest.fixture
def picture(tmp_path):
    path = tmp_path / "art" / "figure.png"
    path.parent.mkdir()
    write_png(path, figure_picture(2, soft=True))
    return path


def record(path):
    return json.loads(ZipFile(path).read("document.json"))


def test_a_saved_drawing_finds_its_picture_again_also_when_both_were_moved(picture, tmp_path):
    opened = open_document(picture)
    save(opened, tmp_path / "drawings.akap")
    assert record(tmp_path / "drawings.akap")["source"] == {
        "path": "art/figure.png",
        "digest": opened.artwork.digest,
    }
    assert record(tmp_path / "drawings.akap")["version"] == 1
    again = open_document(tmp_path / "drawings.akap")
    assert again.artwork == ArtworkFile(picture, opened.artwork.digest)
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    (tmp_path / "drawings.akap").rename(moved / "drawings.akap")
    picture.rename(moved / "figure.png")
    assert open_document(moved / "drawings.akap").artwork.path == moved / "figure.png"


def test_a_change_since_the_drawing_was_saved_is_known_when_it_is_opened(picture, tmp_path):
    save(open_document(picture), tmp_path / "a.akap")
    assert not open_document(tmp_path / "a.akap").artwork.has_changed
    write_png(picture, figure_picture(3, soft=True))
    assert open_document(tmp_path / "a.akap").artwork.has_changed
    picture.unlink()
    gone = open_document(tmp_path / "a.akap").artwork
    assert (gone.path, gone.has_changed) == (picture, False)


def test_of_a_folder_all_pictures_count(tmp_path):
    for name in ("a.png", "b.PNG"):
        write_png(tmp_path / name, figure_picture(2, soft=True))
    before = artwork_file(tmp_path)
    assert artwork_file(tmp_path) == before
    write_png(tmp_path / "b.PNG", figure_picture(3, soft=True))
    assert artwork_file(tmp_path).digest not in ("", before.digest)


def test_a_drawing_cut_out_by_a_mask_has_no_picture_to_reload(picture):
    assert open_document(picture, mask=picture).artwork is None


@pytest.mark.parametrize(
    ("path", "folder", "stored"),
    [
        ("/art/a.png", "/art", "a.png"),
        ("/art/a.png", "/art/rigs/robot", "../../a.png"),
        ("/home/ann/art/a.png", "/home/ann/rigs", "../art/a.png"),
        ("/home/ann/art/a.png", "/mnt/shared", "a.png"),  # the name of the user's folder is nobody's business
        ("/mnt/art/a.png", "/home/ann", "../../mnt/art/a.png"),
        ("/art/a:b.png", "/art", None),
        ("/art/\udce4.png", "/art", None),
    ],
)
def test_paths_begin_at_the_folder_of_the_drawing(path, folder, stored, monkeypatch):
    monkeypatch.setenv("HOME", "/home/ann")
    artwork = ArtworkFile(Path(path))
    described = describe_source(artwork, Path(folder))
    assert described == ({} if stored is None else {"source": {"path": stored}})
    if stored is not None and stored != "a.png":
        assert read_source(described, Path(folder)) == artwork


def test_bundled_drawings_and_recordings_name_no_file(picture, tmp_path):
    (bundled, *_) = bundled_drawings()
    assert describe_source(ArtworkFile(bundled), tmp_path) == {}
    assert b"figure.png" not in ZipFile(BytesIO(encode_document(open_document(picture)))).read(
        "document.json"
    )


@pytest.mark.parametrize(
    "path",
    [
        "",
        "/etc/passwd",
        "//server/share",
        "C:/a.png",
        "C:a.png",
        r"\\server\a",
        "a/../b",
        "./a",
        "a\0b",
        "a" * 1001,
    ],
)
def test_paths_that_a_document_must_not_have_are_refused(path):
    with pytest.raises(InputError, match="source: expected a relative path"):
        read_source({"source": {"path": path}}, Path("/art"))


@pytest.mark.parametrize(
    "source", [3, {}, {"path": 3}, {"path": "a.png", "digest": "x"}, {"path": "..", "digest": 1}]
)
def test_other_values_are_refused(source):
    with pytest.raises(InputError):
        read_source({"source": source}, Path("/art"))


def test_a_recovery_copy_knows_the_picture(picture, tmp_path):
    document = replace(open_document(picture), path=tmp_path / "a.akap")
    copy = RecoveryCopy.claim(tmp_path / "copy.akap")
    copy.write(document)
    assert copy.read().artwork == document.artwork
    copy.release()


def test_saving_elsewhere_changes_the_path_only(picture, tmp_path):
    saved = save(open_document(picture), tmp_path / "a.akap")
    (tmp_path / "deep").mkdir()
    save(saved, tmp_path / "deep" / "b.akap")
    assert record(tmp_path / "deep" / "b.akap")["source"]["path"] == "../art/figure.png"
    assert load(tmp_path / "deep" / "b.akap").artwork == saved.artwork
