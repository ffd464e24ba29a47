"""Opening pictures: thresholds, and what is said about them."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.akap.project import load, save
from akap_editor.io.images import write_png
from akap_editor.io.open_document import open_document, opening_notes
from akap_editor.resources import bundled_puppets


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
    assert note.endswith("; a lower alpha threshold (--threshold) keeps it")
    assert opening_notes(open_document(path), "in the Mesh section") == [
        note.replace("--threshold", "in the Mesh section")
    ]
    kept = open_document(path, threshold=0.1)
    assert kept.drawing.meshing.threshold == 0.1
    assert opening_notes(kept) == []
    save(open_document(path), tmp_path / "a.akap")
    assert opening_notes(load(tmp_path / "a.akap")) == []


def test_a_threshold_that_was_chosen_stays_also_if_it_is_the_usual_one(tmp_path):
    path = written(tmp_path / "a.png", (15, 102))
    with pytest.raises(InputError, match="transparent"):
        open_document(path, threshold=0.5)


def test_the_sources_are_all_files_that_were_read(tmp_path):
    picture, mask = written(tmp_path / "a.png", (5, 255)), written(tmp_path / "mask.png", (9, 255))
    assert open_document(picture).sources == (picture,)
    assert open_document(picture, mask).sources == (picture, mask)
    document = open_document(picture)
    assert document.with_state(document.state).sources == (picture,)
    save(document, tmp_path / "a.akap")
    assert open_document(tmp_path / "a.akap").sources == (tmp_path / "a.akap",)
    folder = tmp_path / "layers"
    folder.mkdir()
    layers = [written(folder / f"{number}.png", (5, 255)) for number in (1, 2)]
    assert open_document(folder).sources == tuple(layers)
    mesh, material = tmp_path / "b.obj", tmp_path / "b.mtl"
    material.write_text("newmtl m\nmap_Kd a.png\n")
    corners = "v 0 0 0\nv 60 0 0\nv 60 60 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
    mesh.write_text(f"mtllib b.mtl\n{corners}usemtl m\nf 1/1 2/2 3/3\n")
    assert open_document(mesh).sources == (mesh, material, picture)


def test_nothing_is_said_of_a_sharp_picture(tmp_path):
    assert opening_notes(open_document(written(tmp_path / "a.png", (20, 255)))) == []


def test_a_threshold_needs_a_picture(tmp_path):
    with pytest.raises(InputError, match=r"threshold: expected a picture to cut out, got a\.akap"):
        open_document(tmp_path / "a.akap", threshold=0.2)


def test_the_bundled_puppet_opens_with_mouths_to_switch_and_joints():
    (path,) = bundled_puppets()
    document = open_document(path)
    mouths = [layer for layer in document.drawing.layers if layer.slot == "mouth"]
    assert [layer.name for layer in mouths if layer.visible] == ["mouth smile"]
    assert len(mouths) == 4
    limbs = {
        document.drawing.layers[joint.layers(document.drawing.mesh)[0]].name
        for joint in document.state.joints
    }
    assert limbs >= {
        "arm upper left",
        "arm lower left",
        "arm upper right",
        "arm lower right",
        "head",
        "antenna",
    }
