"""Recordings as text: exact there and back, cut off, and bad lines."""

import json

import pytest

from akap_editor.editor.session.recording import Recording, drawing_header, mesh_digest, parse_recording
from akap_editor.errors import InputError

HEAD = {"format": "akap-recording", "version": 1, "drawing": {"name": "figure"}}
EVENTS = [
    {"t": 0.0, "do": "settings", "method": "akap", "parameters": {"memory": 1.0}},
    {"t": 0.5, "do": "begin", "label": "Bend «ä»"},
    {"t": 0.5, "do": "targets", "targets": {"1": [0.1 + 0.2, 1 / 3]}},
    {"t": 1.25, "do": "step"},
    {"t": 2.0, "do": "commit"},
]


def text(*lines):
    """The text of a recording; lines that are no strings are written as JSON."""
    return "".join((line if isinstance(line, str) else json.dumps(line)) + "\n" for line in lines)


def test_text_and_back_is_exact():
    recording = Recording(HEAD["drawing"], EVENTS)
    again = parse_recording(recording.to_text())
    assert again.header == recording.header
    assert again.events == recording.events
    assert again.to_text() == recording.to_text()


def test_text_is_one_object_a_line_with_the_header_first():
    lines = Recording(HEAD["drawing"], EVENTS).to_text().splitlines()
    assert [json.loads(line) for line in lines] == [HEAD, *EVENTS]


def test_a_session_is_recorded_exactly(pinned):
    pinned.drag((105.0, 40.0), (90.0, 60.0))
    pinned.settle()
    pinned.undo()
    recording = pinned.session.recording
    assert parse_recording(recording.to_text()).events == recording.events
    times = [event["t"] for event in recording.events]
    assert times == sorted(times)
    assert recording.duration == times[-1] > 0


def test_a_session_that_starts_with_a_pose_records_it(pinned, drawing):
    pinned.drag((105.0, 40.0), (90.0, 60.0))
    pinned.settle()
    document = pinned.session.document
    pinned.editor.open(document)
    assert [event["do"] for event in pinned.session.recording.events] == ["settings", "pose", "pins"]


def test_an_empty_recording_lasts_no_time():
    assert Recording({}).duration == 0.0


def test_the_header_names_picture_and_mesh(drawing, finer_drawing):
    header = drawing_header(drawing)
    assert header["name"] == "figure"
    assert header["size"] == [120, 80]
    assert header["vertices"] == len(drawing.mesh.vertices)
    assert header["mesh"] == mesh_digest(drawing.mesh) != mesh_digest(finer_drawing.mesh)


@pytest.mark.parametrize("length", [1, 10, -1])
def test_an_incomplete_last_line_is_ignored(length):
    whole = text(HEAD, *EVENTS)
    last = json.dumps(EVENTS[-1])
    cut = whole[: -len(last) - 1] + last[:length]
    assert parse_recording(cut).events == EVENTS[:-1]


def test_a_complete_last_line_without_its_end_of_line_is_read():
    assert parse_recording(text(HEAD, *EVENTS)[:-1]).events == EVENTS


def test_windows_line_ends_are_read():
    assert parse_recording(text(HEAD, *EVENTS).replace("\n", "\r\n")).events == EVENTS


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([], "line 1: expected the header of a recording, got nothing"),
        (["", ""], "line 1: expected the header"),
        (["not JSON"], "line 1: expected the header of a recording, got 'not JSON'"),
        ([{"format": "something else"}], "line 1: expected the header"),
        ([{**HEAD, "drawing": None}], "line 1: expected the header"),
        ([{**HEAD, "version": 2}], "line 1: expected version 1, got 2"),
        ([{"format": "akap-recording", "drawing": {}}], "line 1: expected version 1, got None"),
        ([EVENTS[0]], "line 1: expected the header"),
        ([HEAD, "not JSON", EVENTS[0]], "line 2: expected a JSON object"),
        ([HEAD, EVENTS[0], [1, 2]], "line 3: expected a JSON object"),
        ([HEAD, EVENTS[0], "{" * 100_000], "line 3: expected a JSON object"),
        ([HEAD, {"t": 0, "do": "explode"}], "line 2: expected one of .*, got 'explode'"),
        ([HEAD, {"t": 0}], "line 2: expected one of .*, got None"),
        ([HEAD, {"t": 0, "do": ["step"]}], r"line 2: expected one of .*, got \['step'\]"),
        ([HEAD, {"do": "step"}], "line 2: expected a time of 0 s or later, got None"),
        ([HEAD, {"t": "0", "do": "step"}], "line 2: expected a time"),
        ([HEAD, {"t": -1, "do": "step"}], "line 2: expected a time"),
        ([HEAD, {"t": float("nan"), "do": "step"}], "line 2: expected finite numbers, got NaN"),
        ([HEAD, {"t": float("inf"), "do": "step"}], "line 2: expected finite numbers, got Infinity"),
        ([HEAD, '{"t":1e999,"do":"step"}'], "line 2: expected finite numbers, got '1e999'"),
        ([HEAD, {"t": 10**400, "do": "step"}], "line 2: expected integers up to 9007199254740992, got '1000"),
        ([HEAD, '{"t":' + "9" * 5000 + ',"do":"step"}'], "line 2: expected integers up to"),
        ([HEAD, {"t": 1e9, "do": "step"}], "line 2: expected a time up to 1e.07 s, got 1000000000.0"),
        (
            [HEAD, {"t": 3, "do": "step"}, {"t": 2, "do": "step"}],
            "line 3: expected a time of 3 s or later, got 2",
        ),
        ([{**HEAD, "t": "soon"}, {"t": -1, "do": "step"}], "line 2: expected a time of 0 s"),
        ([HEAD, {"t": 0, "do": "begin"}], "line 2: expected a value 'label' in 'begin', got none"),
        ([HEAD, {"t": 0, "do": "pins"}], "line 2: expected a value 'pins'"),
        ([HEAD, {"t": 0, "do": "targets"}], "line 2: expected a value 'targets'"),
        ([HEAD, {"t": 0, "do": "pose"}], "line 2: expected a value 'positions'"),
        ([HEAD, {"t": True, "do": "step"}], "line 2: expected a time of 0 s or later, got True"),
        ([HEAD, {"t": 0, "do": "return"}], "line 2: expected a value 'line'"),
        (
            [HEAD, EVENTS[0], {"t": 0, "do": "return", "line": 3}],
            "line 3: expected an earlier line",
        ),
        (
            [HEAD, EVENTS[0], {"t": 0, "do": "return", "line": 1}],
            "line 3: .* earlier line .*, got 1",
        ),
        ([HEAD, EVENTS[0], {"t": 0, "do": "return", "line": "2"}], "line 3: expected an earlier line"),
        ([HEAD, {"t": 0, "do": "settings", "method": "akap"}], "line 2: expected a value 'parameters'"),
    ],
)
def test_a_bad_line_is_named_by_its_number(lines, message):
    with pytest.raises(InputError, match=message):
        parse_recording(text(*lines))
