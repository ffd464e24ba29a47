import copy
import json
import os
import warnings
import zipfile
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from akap_editor.editor.document.document import Document, EditState, new_document
from akap_editor.editor.document.drawing import Drawing, Meshing, make_drawing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io import atomic
from akap_editor.io.akap.project import has_changed_on_disk, load, save
from akap_editor.io.images import encode_png, read_image
from akap_editor.meshing.meshers import PYTHONCDT, TRIANGLE

# What happens to a file after it was saved, and whether that is a change.
EVENTS = {
    "nothing": (lambda path, other: None, False),
    "touched": (lambda path, other: os.utime(path, (0, 0)), False),
    "the same bytes again": (lambda path, other: path.write_bytes(path.read_bytes()), False),
    "another version": (lambda path, other: path.write_bytes(other), True),
    "another version in its place": (lambda path, other: atomic.write_atomic(path, other), True),
    "a version of the same time": (
        lambda path, other: (path.write_bytes(other), os.utime(path, ns=(path.stat().st_mtime_ns,) * 2)),
        True,
    ),
    "damaged": (lambda path, other: path.write_bytes(b""), True),
    "removed": (lambda path, other: path.unlink(), False),
}

ENTRIES = [
    "mimetype",
    "document.json",
    "mesh/vertices",
    "mesh/faces",
    "mesh/uv",
    "pose/positions",
    "picture.png",
    "thumbnail.png",
]


def assert_equal(came: Document, expected: Document) -> None:
    """Bit for bit: NaN-free arrays by their bytes, so that -0.0 is not 0.0; True is not 1, 1 is not 1.0."""
    for a, b in [
        (came.drawing.image, expected.drawing.image),
        (came.drawing.mesh.vertices, expected.drawing.mesh.vertices),
        (came.drawing.mesh.faces, expected.drawing.mesh.faces),
        (came.drawing.uv, expected.drawing.uv),
        (came.state.positions, expected.state.positions),
    ]:
        assert a.dtype == b.dtype
        assert a.shape == b.shape
        assert a.tobytes() == b.tobytes()
        assert not a.flags.writeable
    assert came.drawing.name == expected.drawing.name
    assert repr(came.state.settings) == repr(expected.state.settings)
    assert len(came.state.pins) == len(expected.state.pins)
    for pin, wanted in zip(came.state.pins, expected.state.pins, strict=True):
        assert (pin.id, pin.face) == (wanted.id, wanted.face)
        assert pin.weights.tobytes() == wanted.weights.tobytes()
        assert pin.target.tobytes() == wanted.target.tobytes()


def unpack(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(BytesIO(data)) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}


def pack(entries: dict[str, bytes] | list[tuple[str, bytes]], method: int = zipfile.ZIP_STORED) -> bytes:
    buffer = BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", method) as archive:
        warnings.simplefilter("ignore")  # of duplicate names
        for name, content in entries.items() if isinstance(entries, dict) else entries:
            archive.writestr(name, content)
    return buffer.getvalue()


@pytest.fixture
def saved(document, tmp_path) -> dict[str, bytes]:
    """The entries of a good file."""
    save(document, tmp_path / "good.akap")
    return unpack((tmp_path / "good.akap").read_bytes())


@pytest.fixture
def reopen(tmp_path):
    """Loads what is packed from entries, or from the bytes of a file."""

    def load_bytes(content) -> Document:
        path = tmp_path / "cat.akap"
        path.write_bytes(content if isinstance(content, bytes) else pack(content))
        return load(path)

    return load_bytes


# Round trips


def test_round_trip_is_exact(document, tmp_path):
    path = tmp_path / "a.akap"
    returned = save(document, path)
    assert returned.path == path
    assert returned.state is document.state
    assert returned.revision == 5
    opened = load(str(path))
    assert opened.path == path
    assert opened.revision == 0
    assert_equal(opened, document)


def test_equal_documents_give_equal_bytes(document, tmp_path):
    save(document, tmp_path / "a.akap")
    save(load(tmp_path / "a.akap"), tmp_path / "b.akap")
    assert (tmp_path / "a.akap").read_bytes() == (tmp_path / "b.akap").read_bytes()


def test_saving_again_replaces_the_file(document, tmp_path):
    path = tmp_path / "a.akap"
    save(document, path)
    moved = document.with_state(replace(document.state, positions=document.state.positions + 1))
    save(moved, path)
    assert_equal(load(path), moved)
    assert os.listdir(tmp_path) == ["a.akap"]


def test_round_trip_of_cartoons(cartoon_path, tmp_path):
    drawing = make_drawing(read_image(cartoon_path), vertices=300, name=cartoon_path.stem)
    rng = np.random.default_rng(0)
    faces = rng.integers(0, len(drawing.mesh.faces), 9)
    pins = tuple(
        Pin(id, face, weights, target)
        for id, face, weights, target in zip(
            range(1, 10), faces, rng.dirichlet([1, 1, 1], 9), rng.normal(size=(9, 2)) * 1000, strict=True
        )
    )
    pose = drawing.mesh.vertices + rng.normal(size=drawing.mesh.vertices.shape)
    document = Document(drawing, EditState(pins, pose, Settings("arap", (("memory", 0.1), ("steps", 3)))))
    save(document, tmp_path / "a.akap")
    assert_equal(load(tmp_path / "a.akap"), document)


finite = st.floats(allow_nan=False, allow_infinity=False)
pixels = st.floats(-1e9, 1e9)
scalars = st.one_of(st.none(), st.booleans(), st.integers(-(2**53), 2**53), finite, st.text())


@st.composite
def documents(draw) -> Document:
    columns, rows = draw(st.integers(2, 4)), draw(st.integers(2, 4))
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    grid = np.stack([x.ravel(), y.ravel()], axis=1)
    moved = grid + draw(arrays(np.float64, grid.shape, elements=st.floats(-0.2, 0.2)))
    corner = (np.arange((rows - 1) * columns).reshape(rows - 1, columns)[:, :-1]).ravel()
    a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = TriMesh(moved * draw(st.floats(1e-3, 1e6)), faces)
    size = draw(st.tuples(st.integers(1, 5), st.integers(1, 5)))
    image = draw(arrays(np.uint8, (*size, 4)))
    uv = draw(
        arrays(np.float32, grid.shape, elements=st.floats(width=32, allow_nan=False, allow_infinity=False))
    )
    pins = []
    for id in draw(st.lists(st.integers(-(2**53), 2**53), unique=True, max_size=4)):
        s, t = sorted(draw(st.tuples(st.floats(0, 1), st.floats(0, 1))))
        target = draw(st.tuples(pixels, pixels))
        pins.append(Pin(id, draw(st.integers(0, len(faces) - 1)), [s, t - s, 1 - t], target))
    positions = draw(arrays(np.float64, grid.shape, elements=pixels))
    parameters = draw(st.dictionaries(st.text(), scalars, max_size=4))
    state = EditState(tuple(pins), positions, Settings(draw(st.text()), tuple(parameters.items())))
    return Document(Drawing(image, mesh, uv, draw(st.text())), state)


@settings(max_examples=60, deadline=None, derandomize=True, database=None)
@given(document=documents())
def test_every_document_round_trips(tmp_path_factory, document):
    path = tmp_path_factory.mktemp("any") / "a.akap"
    save(document, path)
    assert_equal(load(path), document)


@pytest.mark.parametrize("size", [(1, 1), (3, 4000), (256, 256), (2049, 700)])
def test_thumbnail_is_small_and_has_the_shape_of_the_picture(make_document, tmp_path, size):
    image = np.full((*size, 4), [250, 120, 10, 255], np.uint8)
    save(make_document(image), tmp_path / "a.akap")
    thumbnail = Image.open(BytesIO(unpack((tmp_path / "a.akap").read_bytes())["thumbnail.png"]))
    height, width = size
    scale = min(1, 256 / max(size))
    assert abs(thumbnail.width - width * scale) <= 1
    assert abs(thumbnail.height - height * scale) <= 1
    assert max(thumbnail.size) <= 256
    assert thumbnail.getcolors() == [(thumbnail.width * thumbnail.height, (250, 120, 10, 255))]


def test_format_is_as_documented(document, saved, tmp_path):
    """A second reader, written from docs/file-format.md without this package's help."""
    data = (tmp_path / "good.akap").read_bytes()
    assert data[30:56] == b"mimetypeapplication/x-akap"  # at a fixed place, for programs that look only there
    assert list(saved) == ENTRIES
    record = json.loads(saved["document.json"])
    assert (record["format"], record["version"], record["name"]) == ("akap", 1, "square")
    assert record["program"].startswith("akap-editor")
    assert record["picture"] == {"width": 8, "height": 6}
    assert record["mesh"] == {"vertices": 4, "faces": 2, "tied": False}
    assert record["settings"] == {"method": "akap", "parameters": {"memory": 1.0}}
    assert record["pins"] == [
        {"id": 1, "face": 0, "weights": [0.1, 0.2, 0.7], "target": [0.1 + 0.2, -3.0]},
        {"id": 7, "face": 1, "weights": [1.0, 0.0, 0.0], "target": [1e9, 5e-324]},
    ]
    mesh = document.drawing.mesh
    assert np.frombuffer(saved["mesh/vertices"], "<f8").tolist() == mesh.vertices.ravel().tolist()
    assert np.frombuffer(saved["mesh/faces"], "<i4").tolist() == [0, 1, 2, 0, 2, 3]
    assert np.frombuffer(saved["mesh/uv"], "<f4").tolist() == [0, 0, 1, 0, 1, 1, 0, 1]
    assert np.frombuffer(saved["pose/positions"], "<f8").tolist() == document.state.positions.ravel().tolist()
    assert (np.array(Image.open(BytesIO(saved["picture.png"]))) == document.drawing.image).all()


def test_a_second_writer_may_differ_where_the_format_allows(document, saved, reopen):
    """Another order, deflate, no thumbnail, unknown entries and keys, integers for floats, an RGB picture."""
    record = json.loads(saved["document.json"]) | {"later": [1, {"x": None}]}
    record["pins"] = [{"id": 2, "face": 0, "weights": [0, 1, 0], "target": [3, 4], "colour": "red"}]
    del saved["thumbnail.png"]
    buffer = BytesIO()
    Image.new("RGB", (8, 6), (1, 2, 3)).save(buffer, "PNG")
    saved |= {"document.json": json.dumps(record, indent=4).encode(), "picture.png": buffer.getvalue()}
    saved["notes.txt"] = b"hello"
    opened = reopen(pack(list(saved.items())[::-1], zipfile.ZIP_DEFLATED))
    assert opened.state.pins[0].weights.tolist() == [0.0, 1.0, 0.0]
    assert opened.state.pins[0].target.tolist() == [3.0, 4.0]
    assert (opened.drawing.image == [1, 2, 3, 255]).all()
    assert (opened.state.positions == document.state.positions).all()


# Files that cannot be written


FULL = OSError(28, "No space left on device")


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_failed_save_keeps_the_old_file(document, tmp_path, monkeypatch, step):
    def fail(*_):
        raise FULL

    path = tmp_path / "a.akap"
    save(document, path)
    before = path.read_bytes()
    monkeypatch.setattr(atomic.os, step, fail)
    with pytest.raises(InputError, match=r"^Couldn't save “.*a\.akap”\. No space left on device\.$"):
        save(document.with_state(replace(document.state, pins=())), path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == ["a.akap"]


def pin(**parts) -> tuple[Pin]:
    return (Pin(**({"id": 1, "face": 0, "weights": [1, 0, 0], "target": [0, 0]} | parts)),)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"pins": pin() + pin()}, "expected each pin once, got pin 1 2 times"),
        ({"pins": pin(id=2**53 + 1)}, "pins: expected ids up to 9007199254740992, got 9007199254740993"),
        ({"pins": pin(face=2)}, "pin 1: expected a face from 0 to 1, got 2"),
        ({"pins": pin(face=-1)}, "pin 1: expected a face from 0 to 1, got -1"),
        ({"pins": pin(weights=[0.5, 0.4, 0.2])}, "pin 1: expected weights from 0 to 1 that sum to 1, got"),
        ({"pins": pin(weights=[1.5, -0.5, 0.0])}, "pin 1: expected weights from 0 to 1 that sum to 1, got"),
        ({"pins": pin(weights=[np.nan, 1, 0])}, "pin 1: expected weights from 0 to 1 that sum to 1, got"),
        (
            {"pins": pin(weights=[0.5, 0.5])},
            "pin 1: expected 3 weights and a target of 2 coordinates, got 2 and 2",
        ),
        ({"pins": pin(target=[1])}, "pin 1: expected 3 weights and a target of 2 coordinates, got 3 and 1"),
        ({"pins": pin(target=[np.inf, 0])}, r"pin 1: expected a finite target, got \[inf, 0.0\]"),
        ({"positions": np.zeros((3, 2))}, r"positions: expected shape \(4, 2\), got \(3, 2\)"),
        ({"positions": np.full((4, 2), np.nan)}, "positions: expected finite numbers"),
        ({"settings": Settings("akap", (("a", 1), ("a", 2)))}, "got parameter 'a' 2 times"),
        ({"settings": Settings("akap", (("a", [1]),))}, "parameters: expected .*, got list for 'a'"),
        (
            {"settings": Settings("akap", (("a", np.nan),))},
            "parameter 'a': expected a finite number, got nan",
        ),
        (
            {"settings": Settings("akap", (("a", 10**5000),))},
            "parameter 'a': expected an integer up to .* bits",
        ),
    ],
)
def test_what_could_not_be_opened_is_not_saved(make_document, picture, tmp_path, parts, message):
    path = tmp_path / "a.akap"
    path.write_bytes(b"old")
    with pytest.raises(InputError, match=rf"(?i)^Couldn't save “.*a\.akap”\. .*{message}"):
        save(make_document(picture, **parts), path)
    assert path.read_bytes() == b"old"


# Files that cannot be read


def test_missing_file_and_folder(tmp_path):
    with pytest.raises(InputError, match=r"none\.akap”\. There is no such file"):
        load(tmp_path / "none.akap")
    with pytest.raises(InputError, match=r"Expected an \.akap file, got a folder"):
        load(tmp_path)


@pytest.mark.parametrize(
    "data", [b"", b"hello world", b"PK\x03\x04", encode_png(np.zeros((2, 2, 4), np.uint8))]
)
def test_other_files_are_refused(reopen, data):
    with pytest.raises(InputError, match=r"cat\.akap”\. The file is damaged or not an \.akap file"):
        reopen(data)


def test_every_truncation_is_refused(document, tmp_path, reopen):
    save(document, tmp_path / "good.akap")
    data = (tmp_path / "good.akap").read_bytes()
    for length in range(0, len(data), 7):
        with pytest.raises(InputError, match=r"Couldn't open “.*cat\.akap”\. "):
            reopen(data[:length])


@pytest.mark.parametrize("entry", ENTRIES[1:-1])
def test_missing_entry_is_named(saved, reopen, entry):
    del saved[entry]
    with pytest.raises(InputError, match=rf"cat\.akap”\. Expected the entry {entry}, which is missing\.$"):
        reopen(saved)


@pytest.mark.parametrize("entry", ENTRIES)
def test_repeated_entry_is_refused(saved, reopen, entry):
    with pytest.raises(InputError, match=rf"Expected each entry once, got '{entry}' 2 times"):
        reopen([*saved.items(), (entry, saved[entry])])


def test_other_zip_archives_are_refused(saved, reopen):
    for entries in ({"readme.txt": b"hello"}, saved | {"mimetype": b"application/epub+zip"}):
        with pytest.raises(InputError, match=r"Expected an \.akap file, got a zip archive of another kind"):
            reopen(entries)


@pytest.mark.parametrize("number", [3, 17, 2**53])
def test_newer_version_says_so_first(saved, reopen, number):
    entries = {"mimetype": saved["mimetype"]}
    entries["document.json"] = json.dumps({"format": "akap", "version": number}).encode()
    message = rf"newer version of the program \(file version {number}, this program reads up to 2\); update"
    with pytest.raises(InputError, match=message):
        reopen(entries)


RECORDS = [
    (["version"], 0, "expected a version from 1, got 0"),
    (["version"], 1.0, "expected version to be an integer, got 1.0"),
    (["version"], True, "expected version to be an integer, got True"),
    (["format"], "krita", "expected format 'akap', got 'krita'"),
    (["name"], None, "expected name to be a text, got None"),
    (["picture"], [], r"expected picture to be an object, got \[\]"),
    (["picture", "width"], 7, "picture.png: expected 7 x 6 pixels, got 8 x 6"),
    (["picture", "height"], "6", "expected height to be an integer, got '6'"),
    (["picture", "width"], 20_000_000, "expected at most 100000000 pixels, got 120000000"),
    (["picture", "width"], -8, "expected sizes above 0, got -8 x 6"),
    (["mesh", "vertices"], 5, r"pose/positions: expected 80 bytes for shape \(5, 2\), got 64"),
    (["mesh", "vertices"], 3, "pose/positions: expected at most 48 bytes, got 64"),
    (["mesh", "vertices"], 0, "expected sizes above 0, got 8 x 6, 0 vertices, 2 faces"),
    (["mesh", "vertices"], 2**40, "expected at most 1000000 vertices, got 1099511627776"),
    (["mesh", "faces"], 3, r"mesh/faces: expected 36 bytes for shape \(3, 3\), got 24"),
    (["mesh", "faces"], 2**40, "expected at most 2000000 faces"),
    (["mesh", "faces"], 2**53 + 1, "expected integers up to 9007199254740992, got '9007199254740993'"),
    (["pins"], {}, "expected pins to be a list, got {}"),
    (["pins"], [3], "expected pins to be objects, got 3"),
    (["pins"], [3] * 10_001, "expected at most 10000 pins, got 10001"),
    (["pins", 0, "id"], 7, "expected each pin once, got pin 7 2 times"),
    (["pins", 0, "id"], "1", "expected id to be an integer, got '1'"),
    (["pins", 0, "face"], 2, "pin 1: expected a face from 0 to 1, got 2"),
    (["pins", 0, "face"], -1, "pin 1: expected a face from 0 to 1, got -1"),
    (["pins", 0, "weights"], [1, 0], "expected 3 weights and a target of 2 coordinates, got 2 and 2"),
    (["pins", 0, "weights"], [[1, 0, 0]], "expected weights to be numbers"),
    (["pins", 0, "weights"], [True, 0, 0], "expected weights to be numbers"),
    (["pins", 0, "weights"], [0.5, 0.5, 0.1], "expected weights from 0 to 1 that sum to 1"),
    (["pins", 0, "weights"], [2, -1, 0], "expected weights from 0 to 1 that sum to 1"),
    (["pins", 0, "weights"], [float("nan"), 0, 0], "expected finite numbers, got NaN"),
    (["pins", 0, "target"], [0, float("inf")], "expected finite numbers, got Infinity"),
    (["pins", 0, "target"], None, "expected target to be a list, got None"),
    (["pins", 0, "target"], [1, 2, 3], "expected 3 weights and a target of 2 coordinates, got 3 and 3"),
    (["settings", "method"], 3, "expected method to be a text, got 3"),
    (["settings", "parameters"], [], r"expected parameters to be an object, got \[\]"),
    (["settings", "parameters", "memory"], [1.0], "parameters: expected .*, got list for 'memory'"),
    (["settings", "parameters", "memory"], {}, "parameters: expected .*, got dict for 'memory'"),
]


def changed(record, path: list, value):
    record = copy.deepcopy(record)
    place = record
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return record


@pytest.mark.parametrize(("path", "value", "message"), RECORDS, ids=lambda part: str(part)[:40])
def test_wrong_records_are_refused(saved, reopen, path, value, message):
    record = changed(json.loads(saved["document.json"]), path, value)
    saved["document.json"] = json.dumps(record).encode()
    with pytest.raises(InputError, match=rf"(?i)cat\.akap”\. .*{message}"):
        reopen(saved)


def test_missing_keys_are_named(saved, reopen):
    record = json.loads(saved["document.json"])
    for key in sorted(record.keys() - {"program"}):
        entries = saved | {
            "document.json": json.dumps({k: v for k, v in record.items() if k != key}).encode()
        }
        with pytest.raises(
            InputError, match=rf"document\.json: expected {key} to be an? \w+, but it is missing"
        ):
            reopen(entries)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b"", "expected JSON in UTF-8, got something else"),
        (b"{", "expected JSON in UTF-8"),
        (b'{"name": "\xff"}', "expected JSON in UTF-8"),
        (b"[" * 100_000, "expected JSON in UTF-8"),
        (b"[]", r"expected an object, got \[\]"),
        (b"7", "expected an object, got 7"),
        (b'{"a": 1, "a": 1}', r"expected each key once, got one of \['a'\] twice"),
        (b'{"a": ' + b"9" * 5000 + b"}", "expected integers up to 9007199254740992, got '9999"),
        (b'{"format": ' + b"[" * 500 + b"]" * 500 + b"}", "expected format to be a text, got"),
    ],
    ids=range(9),
)
def test_wrong_json_is_refused(saved, reopen, text, message):
    with pytest.raises(InputError, match=rf"document\.json: {message}"):
        reopen(saved | {"document.json": text})


def test_float_that_overflows_is_refused(saved, reopen):
    text = saved["document.json"].replace(b'"memory": 1.0', b'"memory": 1e999')
    with pytest.raises(InputError, match=r"document.json: expected finite numbers, got '1e999'"):
        reopen(saved | {"document.json": text})


def floats(*values: float) -> bytes:
    return np.array(values, "<f8").tobytes()


CORNERS = [0, 0, 8, 0, 8, 6, 0, 6]
ARRAYS = {
    "NaN vertex": ("mesh/vertices", floats(np.nan, *CORNERS[1:]), "vertices: expected coordinates up to"),
    "far vertex": (
        "mesh/vertices",
        floats(-1e300, *CORNERS[1:]),
        "expected coordinates up to 1e.09 pixels, got 1e.300",
    ),
    "vertex twice": ("mesh/vertices", floats(0, 0, *CORNERS[:6]), "faces: expected positive signed areas"),
    "flipped": ("mesh/vertices", floats(8, 0, 0, 0, 0, 6, 8, 6), "faces: expected positive signed areas"),
    "index too large": (
        "mesh/faces",
        np.array([0, 1, 2, 0, 2, 4], "<i4").tobytes(),
        "expected indices from 0 to 3, got 4",
    ),
    "index below 0": (
        "mesh/faces",
        np.array([0, 1, 2, 0, 2, -1], "<i4").tobytes(),
        "expected indices from 0 to 3, got -1",
    ),
    "unused vertex": ("mesh/faces", np.array([0, 1, 2, 0, 1, 2], "<i4").tobytes(), "but vertex 3 does not"),
    "wrong dtype": (
        "mesh/faces",
        np.array([0, 1, 2, 0, 2, 3], "<i8").tobytes(),
        "expected at most 24 bytes, got 48",
    ),
    "NaN uv": ("mesh/uv", np.full(8, np.nan, "<f4").tobytes(), "uv: expected finite numbers"),
    "NaN position": ("pose/positions", floats(*[np.nan] * 8), "positions: expected finite numbers"),
    "short positions": (
        "pose/positions",
        floats(*CORNERS[:6]),
        r"expected 64 bytes for shape \(4, 2\), got 48",
    ),
    "no picture": ("picture.png", b"hello", "picture.png: the file is damaged or not a PNG picture"),
    "half a picture": (
        "picture.png",
        encode_png(np.zeros((6, 8, 4), np.uint8))[:50],
        "picture.png: the PNG picture is damaged or incomplete",
    ),
    "another picture": (
        "picture.png",
        encode_png(np.zeros((8, 6, 4), np.uint8)),
        "expected 8 x 6 pixels, got 6 x 8",
    ),
}


@pytest.mark.parametrize("kind", ARRAYS)
def test_wrong_arrays_and_pictures_are_refused(saved, reopen, kind):
    entry, content, message = ARRAYS[kind]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(InputError, match=rf"(?i)cat\.akap”\. .*{message}"):
            reopen(saved | {entry: content})


def test_only_png_is_a_picture(saved, reopen):
    buffer = BytesIO()
    Image.new("RGB", (8, 6)).save(buffer, "BMP")
    with pytest.raises(
        InputError, match=r"picture\.png: the file is damaged or not a PNG picture; it begins with b'BM"
    ):
        reopen(saved | {"picture.png": buffer.getvalue()})


# Zip bombs and damage


def test_large_entries_are_refused_before_they_are_unpacked(saved, reopen, monkeypatch):
    data = pack(saved | {"mimetype": bytes(300)}, zipfile.ZIP_DEFLATED)
    monkeypatch.setattr(zipfile.ZipFile, "open", lambda *_, **__: pytest.fail("unpacked"))
    with pytest.raises(InputError, match="mimetype: expected at most 256 bytes, got 300"):
        reopen(data)


@pytest.mark.parametrize(
    ("entry", "size", "most"), [("document.json", 2**24 + 1, 2**24), ("mesh/vertices", 2**24, 64)]
)
def test_bombs_are_refused_by_their_size(saved, reopen, entry, size, most):
    data = pack(saved | {entry: bytes(size)}, zipfile.ZIP_DEFLATED)
    assert len(data) < 100_000
    with pytest.raises(InputError, match=f"{entry}: expected at most {most} bytes, got {size}"):
        reopen(data)


def test_bomb_that_lies_about_its_size_is_not_unpacked(saved, reopen):
    """The directory says 64 bytes, the stream holds 64 million."""
    data = pack(saved | {"mesh/vertices": bytes(64_000_000)}, zipfile.ZIP_DEFLATED)
    lie = data.replace((64_000_000).to_bytes(4, "little"), (64).to_bytes(4, "little"))
    assert lie != data
    with pytest.raises(InputError, match="mesh/vertices: the entry is damaged"):
        reopen(lie)


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_compression_is_refused(saved, reopen, method):
    with pytest.raises(InputError, match=f"expected no compression or deflate, got method {method}"):
        reopen(pack(saved, method))


# How the mesh was made


def test_ties_and_how_the_mesh_was_made_come_back(make_document, picture, tmp_path):
    document = make_document(picture)
    for tied, meshing in ((True, Meshing(500, 3.5, 0.25, None, PYTHONCDT)), (False, None)):
        mesh = replace(document.drawing.mesh, tied=tied)
        drawing = replace(document.drawing, mesh=mesh, meshing=meshing)
        save(replace(document, drawing=drawing), tmp_path / "a.akap")
        opened = load(tmp_path / "a.akap")
        assert opened.drawing.mesh.tied is tied
        assert opened.drawing.meshing == meshing


def test_a_mesh_of_which_nothing_is_said_is_tied(saved, reopen):
    """As in the first files of version 1."""
    record = json.loads(saved["document.json"])
    del record["mesh"]["tied"]
    opened = reopen(pack(saved | {"document.json": json.dumps(record).encode()}))
    assert opened.drawing.mesh.tied
    record["mesh"]["made"] = {"vertices": 10, "expand": 2, "threshold": "half"}
    with pytest.raises(InputError, match=r"expected expand and threshold to be numbers, got .*'half'"):
        reopen(pack(saved | {"document.json": json.dumps(record).encode()}))


def test_a_mesh_of_which_no_mesher_is_said_was_made_by_triangle(saved, reopen):
    record = json.loads(saved["document.json"])
    record["mesh"]["made"] = {"vertices": 10, "expand": 2, "threshold": 0.5}
    opened = reopen(pack(saved | {"document.json": json.dumps(record).encode()}))
    assert opened.drawing.meshing == Meshing(10, 2.0, 0.5, None, TRIANGLE)
    for mesher in ("gmsh", 3, None):
        record["mesh"]["made"]["mesher"] = mesher
        with pytest.raises(InputError, match="mesher: expected one of triangle, pythoncdt, got"):
            reopen(pack(saved | {"document.json": json.dumps(record).encode()}))


def test_a_removed_background_comes_back_with_its_tolerance(tmp_path):
    picture = np.full((40, 60, 4), (250, 250, 250, 255), dtype=np.uint8)
    picture[10:30, 10:50, :3] = (40, 90, 160)
    drawing = make_drawing(picture, vertices=60, background=0.125)
    saved = new_document(drawing)
    opened = load(save(saved, tmp_path / "cut.akap").path)
    assert_equal(opened, saved)
    assert opened.drawing.meshing == drawing.meshing
    np.testing.assert_array_equal(opened.drawing.original, picture)
    again = remesh_drawing(opened.drawing, replace(opened.drawing.meshing, background=None))
    np.testing.assert_array_equal(again.image, picture)

    entries = unpack((tmp_path / "cut.akap").read_bytes())
    for name, spoil in (
        ("original.png", None),
        ("original.png", encode_png(picture[:20])),
        ("document.json", entries["document.json"].replace(b'"background": 0.125', b'"background": 7')),
    ):
        spoiled = {**entries, name: spoil} if spoil is not None else {**entries}
        if spoil is None:
            del spoiled[name]
        path = tmp_path / "spoiled.akap"
        path.write_bytes(pack(spoiled))
        with pytest.raises(InputError, match="original.png" if name == "original.png" else "background"):
            load(path)


@pytest.mark.parametrize("event", EVENTS)
@pytest.mark.parametrize("begins", ["saved", "opened"])
def test_what_another_program_did_to_the_file_is_noticed(document, tmp_path, event, begins):
    other = document.with_state(replace(document.state, positions=document.state.positions + 1))
    path = tmp_path / "own.akap"
    own = save(document, path)
    own = own if begins == "saved" else load(path)
    happens, is_change = EVENTS[event]
    save(other, tmp_path / "other.akap")
    happens(path, (tmp_path / "other.akap").read_bytes())
    assert has_changed_on_disk(own) == is_change
    assert not has_changed_on_disk(save(own, path)), "what is saved over it is known"
    assert not has_changed_on_disk(document), "a document without a file"
