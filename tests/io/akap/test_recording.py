import base64
import json

import numpy as np
import pytest

from akap_editor.editor.document.document import new_document
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import drawing_header
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.io.akap.recording import read_recording, recorded_drawing, write_recording
from akap_editor.io.open_document import open_document


@pytest.fixture
def session(document):
    """A square with a pin, moved a little."""
    session = Session(new_document(document.drawing))
    session.begin("Bénd")
    pin = add_pin(session, (2.0, 3.0))
    session.apply(SetTargets({pin: (2.5, 3.0)}))
    session.settle()
    session.commit()
    return session


def test_a_recording_carries_its_drawing_bit_for_bit(session, tmp_path):
    write_recording(session.recording, tmp_path / "a.akaprec", session.drawing)
    recording = read_recording(tmp_path / "a.akaprec")
    drawing = recorded_drawing(recording)
    assert drawing_header(drawing) == drawing_header(session.drawing)
    np.testing.assert_array_equal(drawing.image, session.drawing.image)
    np.testing.assert_array_equal(drawing.uv, session.drawing.uv)
    *_, last = replay(recording, drawing)
    np.testing.assert_array_equal(last.state.positions, session.state.positions)
    assert "akap" not in session.recording.header, "the session's own recording stays small"


def test_any_file_cut_off_after_its_first_line_is_read_up_to_there(session, tmp_path):
    path = tmp_path / "a.akaprec"
    session.recording.events[1]["label"] = "Ünd — 曲げる"
    lines = [json.dumps({"format": "akap-recording", "version": 1, "drawing": session.recording.header})]
    lines += [json.dumps(event, ensure_ascii=False) for event in session.recording.events[:4]]
    data = "".join(line + "\n" for line in lines).encode()
    for end in range(len(lines[0]) + 1, len(data) + 1):
        path.write_bytes(data[:end])
        events = read_recording(path).events
        assert events == session.recording.events[: len(events)]
        assert len(events) >= data[:end].count(b"\n") - 1


def test_bytes_that_are_no_text_in_the_middle_are_refused(session, tmp_path):
    path = tmp_path / "a.akaprec"
    write_recording(session.recording, path)
    path.write_bytes(path.read_bytes().replace(b'"label"', b'"la\xffel"', 1))
    with pytest.raises(InputError, match=r"a\.akaprec”\. Expected a recording, which is text"):
        read_recording(path)


@pytest.mark.parametrize("inside", [5, None, "no Base64!", "", base64.b64encode(b"PK\x03\x04 no").decode()])
def test_a_damaged_drawing_inside_is_told(session, inside):
    session.recording.header["akap"] = inside
    with pytest.raises(InputError, match="recording line 1: the drawing inside is damaged"):
        recorded_drawing(session.recording)


@pytest.mark.parametrize("name", ["unicorn", None, 5, ["elephant"]])
def test_a_drawing_that_is_neither_inside_nor_bundled_is_told(session, name):
    session.recording.header["name"] = name
    with pytest.raises(InputError, match=r"recording line 1: expected a drawing inside, or .* elephant"):
        recorded_drawing(session.recording)


def test_every_cartoon_travels_inside_its_recording(cartoon_path, tmp_path):
    if cartoon_path.parent.name == "gophers":
        pytest.skip("takes seconds to mesh, and is no other case")
    session = Session(open_document(cartoon_path))
    write_recording(session.recording, tmp_path / "a.akaprec", session.drawing)
    drawing = recorded_drawing(read_recording(tmp_path / "a.akaprec"))
    assert drawing_header(drawing) == drawing_header(session.drawing)
    np.testing.assert_array_equal(drawing.image, session.drawing.image)
