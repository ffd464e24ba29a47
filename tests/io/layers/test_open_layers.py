"""Opening pictures in layers: the puppets, folders, what is said about them, and damage."""

import zipfile
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import akap_editor as akap
from akap_editor.errors import InputError
from akap_editor.io.images import write_png
from akap_editor.io.layers.open_layers import decode_layers, has_layers, merging_notes, open_layers
from akap_editor.io.open_document import open_document, opening_notes
from akap_editor.layers.composite import composite
from akap_editor.layers.layered_picture import Layer, LayeredPicture, LayerGroup
from akap_editor.progress import Cancelled, listening
from tests.support.layered_files import add_layer, filled, ora_bytes, psd_bytes

RED = filled(30, 20, 255, 0, 0)


@pytest.mark.parametrize("name", ["alien", "raptor"])
def test_the_puppets_merge_to_the_picture_in_their_files(shared_data, name):
    path = shared_data / "puppets" / f"{name}-puppet.ora"
    with zipfile.ZipFile(path) as archive, Image.open(BytesIO(archive.read("mergedimage.png"))) as picture:
        expected = np.asarray(picture.convert("RGBA"))
    layered, other = open_layers(path), open_layers(path.with_suffix(".psd"))
    merged = composite(layered)
    assert np.abs(merged.astype(int) - expected)[expected[..., 3] > 0].max() <= 1
    assert (composite(other) == merged).all()
    assert [layer.path for layer in other.layers] == [layer.path for layer in layered.layers]


def write_folder(folder, **pictures):
    folder.mkdir()
    for name, picture in pictures.items():
        write_png(folder / f"{name}.png", picture)
    return folder


def test_a_folder_of_pictures_is_sorted_as_people_count(tmp_path):
    folder = write_folder(tmp_path / "cat", layer10=RED, layer9=RED, Layer2=RED)
    (folder / "notes.txt").write_text("no layer")
    (folder / ".hidden.png").write_text("no layer")
    layered = open_layers(folder)
    assert [layer.name for layer in layered.layers] == ["Layer2", "layer9", "layer10"]
    assert layered.size == (30, 20)


@pytest.mark.parametrize(
    ("pictures", "message"),
    [
        ({}, "The folder contains no PNG pictures"),
        ({"a": RED * 0}, "Its pictures are fully transparent"),
        (
            {"a": RED, "b": RED[:9]},
            r"Expected pictures of one size, 30 x 20 pixels like the first one, got b\.png with 30 x 9",
        ),
    ],
)
def test_folders_that_are_no_layers(tmp_path, pictures, message):
    with pytest.raises(InputError, match=rf"^Couldn't open “.*cat”\. {message}"):
        open_layers(write_folder(tmp_path / "cat", **pictures))


def test_a_damaged_picture_of_a_folder_is_named(tmp_path):
    folder = write_folder(tmp_path / "cat", a=RED)
    (folder / "b.png").write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"Couldn't open “.*b\.png”"):
        open_layers(folder)


@pytest.mark.parametrize("name", ["a.psd", "a.ora", "a.psb", "a.PSD"])
def test_damaged_and_missing_files_are_named(tmp_path, name):
    with pytest.raises(InputError, match=rf"^Couldn't open “.*{name}”\. There is no such file"):
        open_layers(tmp_path / name)
    (tmp_path / name).write_bytes(b"no picture")
    with pytest.raises(InputError, match=rf"^Couldn't open “.*{name}”\. The file is damaged or not"):
        open_layers(tmp_path / name)


def test_other_files_are_refused(tmp_path):
    with pytest.raises(
        InputError, match=r"Expected a folder or a file that ends in \.psd, \.psb, \.ora, got \.txt"
    ):
        open_layers(tmp_path / "a.txt")


def test_files_are_told_by_their_first_bytes():
    psd = psd_bytes(lambda psd: add_layer(psd, "a", RED))
    ora = ora_bytes("<layer name='a' src='a.png'/>", {"a.png": RED})
    for data in (psd, ora):
        assert has_layers(data)
        assert decode_layers(data).layers[0].name == "a"
    assert not has_layers(b"PK\x03\x04 an .akap file")


def test_one_notice_says_what_was_merged_and_what_was_left_out():
    layers = [
        Layer(name, RED, visible=name == "body")
        for name in ("body", "sketch", "x" * 60, "a", "b", "c", "d", "e")
    ]
    notes = merging_notes(LayeredPicture((30, 20), layers, ("the effects of “hat”",)))
    assert notes == [
        "1 layer was merged into one drawing",
        f"7 hidden layers were left out: “sketch”, “{'x' * 39}…”, “a”, “b”, “c” and 2 more",
        "Not drawn: the effects of “hat”",
    ]
    hidden = LayerGroup("old", visible=False)
    notes = merging_notes(
        LayeredPicture((30, 20), [layers[0], layers[0], Layer("arm", RED, groups=(hidden,))])
    )
    assert notes == ["2 layers were merged into one drawing", "1 hidden layer was left out: “arm”"]


def test_a_document_has_the_layers_of_the_file_or_its_visible_ones_merged_and_says_so_once(tmp_path):
    def build(psd):
        add_layer(psd, "a", filled(40, 40, 9, 9, 200), 10, 10)
        add_layer(psd, "b", RED, 40, 20)
        add_layer(psd, "sketch", RED, visible=False)

    (tmp_path / "puppet.psd").write_bytes(psd_bytes(build, size=(90, 60)))
    layered = open_document(tmp_path / "puppet.psd")
    assert [(layer.name, layer.visible) for layer in layered.drawing.layers] == [
        ("a", True),
        ("b", True),
        ("sketch", False),
    ]
    note = "Opened 3 layers, 1 of them hidden; Merge Layers in the File menu makes one drawing of them"
    assert opening_notes(layered, "Alpha threshold") == [note]
    assert opening_notes(layered) == [], "a command prints nothing about it"
    document = open_document(tmp_path / "puppet.psd", merge_layers=True)
    assert document.drawing.name == layered.drawing.name == "puppet"
    assert document.drawing.size == layered.drawing.size == (90, 60)
    assert not document.drawing.layers
    assert document.drawing.image[30, 45].tolist() == [255, 0, 0, 255]
    assert document.drawing.image[5, 5, 3] == 0
    notes = ["2 layers were merged into one drawing", "1 hidden layer was left out: “sketch”"]
    assert opening_notes(document) == notes
    for each in (document, layered):
        akap.save(each, tmp_path / "puppet.akap")
        assert opening_notes(akap.load(tmp_path / "puppet.akap")) == []


def test_a_file_with_a_single_layer_becomes_a_flat_drawing(tmp_path):
    (tmp_path / "a.psd").write_bytes(psd_bytes(lambda psd: add_layer(psd, "a", RED, 5, 9), size=(90, 60)))
    document = open_document(tmp_path / "a.psd")
    assert not document.drawing.layers
    assert document.drawing.image.shape == (60, 90, 4)
    assert opening_notes(document) == []


def test_a_mask_cuts_out_all_layers(tmp_path):
    (tmp_path / "a.psd").write_bytes(
        psd_bytes(lambda psd: [add_layer(psd, name, RED, 20, 10) for name in "ab"], size=(90, 60))
    )
    mask = np.zeros((60, 90, 4), np.uint8)
    mask[:, :35] = 255
    write_png(tmp_path / "mask.png", mask)
    drawing = open_document(tmp_path / "a.psd", tmp_path / "mask.png").drawing
    assert [layer.artwork.picture.shape[:2] for layer in drawing.layers] == [(20, 30)] * 2
    assert drawing.mesh.vertices[:, 0].max() < 38
    write_png(tmp_path / "small.png", mask[:9])
    with pytest.raises(InputError, match=r"small\.png|expected the size of the picture, 90 x 60"):
        open_document(tmp_path / "a.psd", tmp_path / "small.png")


def test_opening_announces_layers_and_can_be_cancelled(tmp_path):
    folder = write_folder(tmp_path / "cat", a=RED, b=RED)
    for path, data in {
        "a.psd": psd_bytes(lambda psd: [add_layer(psd, name, RED) for name in "ab"]),
        "a.ora": ora_bytes("<layer name='b' src='a.png'/><layer name='a' src='a.png'/>", {"a.png": RED}),
    }.items():
        (tmp_path / path).write_bytes(data)

    def cancel(share, text):
        assert 0 <= share <= 1
        if text == "Reading the layer “b”":
            raise Cancelled("cancelled")

    for path in (folder, tmp_path / "a.psd", tmp_path / "a.ora"):
        with listening(cancel), pytest.raises(Cancelled):
            open_layers(path)
