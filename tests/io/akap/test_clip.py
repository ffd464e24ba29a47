"""Clips as files, and those that come with the program."""

import json
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.animation.clips.clip import pins_with_names
from akap_editor.editor.animation.clips.retargeting import clip_targets
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.errors import FileError, InputError
from akap_editor.io.akap.clip import (
    bundled_clips,
    bundled_pins,
    clips_for,
    decode_clip,
    encode_clip,
    load_clip,
    save_clip,
)
from akap_editor.io.images import read_image
from akap_editor.resources import bundled_drawings
from tools.make_clips import CLIPS


def test_a_clip_is_read_as_it_was_saved(tmp_path):
    clip = bundled_clips()[0]
    save_clip(clip, tmp_path / "a.clip.json")
    read = load_clip(tmp_path / "a.clip.json")
    assert (read.name, read.pins) == (clip.name, clip.pins)
    np.testing.assert_array_equal(read.rest, clip.rest)
    for one, other in zip(read.keys, clip.keys, strict=True):
        assert (one.time, one.ease) == (other.time, other.ease)
        np.testing.assert_array_equal(one.positions, other.positions)


def changed(**values):
    return json.dumps({**json.loads(encode_clip(bundled_clips()[0])), **values}).encode()


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"[]",
        b"{}",
        changed(format="akap-pose"),
        changed(version=2),
        changed(name=""),
        changed(name=7),
        changed(pins=[1]),
        changed(pins=[{"name": "A", "parent": 1, "rest": [0, 0]}]),
        changed(pins=[{"name": "A", "parent": None, "rest": [0, "0"]}]),
        changed(keys=[{"time": 0}]),
        changed(keys=[[]]),
        changed(keys=[{"time": "0", "positions": []}]),
        changed(keys=[{}] * 2000),
    ],
)
def test_bad_files_are_refused(data):
    with pytest.raises(InputError):
        decode_clip(data)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileError, match=r"none\.clip\.json"):
        load_clip(tmp_path / "none.clip.json")


def test_the_bundled_clips_are_those_that_the_tool_makes():
    made = {clip.name: encode_clip(clip) for clip in (make() for make in CLIPS)}
    assert made == {clip.name: encode_clip(clip) for clip in bundled_clips()}
    assert set(made) == {"Wave", "Nod", "Hop", "Walk in Place", "Tail Wag"}


@pytest.mark.parametrize(
    "path", [path for path in bundled_drawings() if clips_for(path.stem)], ids=lambda p: p.stem
)
def test_clips_that_suit_a_bundled_drawing_move_pins_that_lie_on_it(path):
    drawing = make_drawing(read_image(path), name=path.stem, vertices=150)
    state = new_document(drawing).state
    pins = pins_with_names(drawing, state, bundled_pins(drawing))
    names = {pin.name for pin in pins}
    document = new_document(drawing).with_state(replace(state, pins=pins))
    for clip in clips_for(path.stem):
        assert len(names & set(clip.names)) >= 2
        first, *_, last = clip_targets(clip, drawing, document.state)
        assert len(first) == len(pins)
        np.testing.assert_allclose([*first.values()], [*last.values()], atol=1e-6)


def test_all_bundled_clips_are_shown_on_the_start_page():
    shown = {clips_for(path.stem)[0].name for path in bundled_drawings() if clips_for(path.stem)}
    assert shown == {clip.name for clip in bundled_clips()}


def test_another_picture_of_the_same_name_has_no_pins_of_its_own(document):
    assert bundled_pins(replace(document.drawing, name="cat")) == {}
