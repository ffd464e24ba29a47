"""Fuzzes the file readers: each damaged or malicious file must open, or be refused with an InputError.

Run from the project's root: python benchmarks/fuzz_files.py [--cases N] [--seed S]
Makes .akap, .pose.json, .akaprec, mesh, picture, .psd and .ora files with damage on the outside (bytes,
length, zip directory) or, with correct checksums, on the inside (numbers, JSON, XML, PNG, sizes, names,
bombs), and opens them, with all Python warnings as errors. A file that opens is saved as a document, opened
and saved again, and must be the same; of pictures, layers and recordings, which are meshed or replayed for
this, only a share.
Prints the numbers of opened and refused files, the slowest case and the peak memory. The exit code is 1 after
any other exception, a case of over 20 seconds, or more than a gigabyte of memory. A failing case prints its
seed; --seed S --cases 1 runs it alone.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import resource
import signal
import struct
import sys
import time
import warnings
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from PIL import Image
from psd_tools import PSDImage

from akap_editor.editor import gestures
from akap_editor.editor.document.document import Document, EditState, new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.named_poses import NamedPose
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.rig.joint import make_joint
from akap_editor.editor.editor import Editor
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.replay import Replay
from akap_editor.errors import AkapError, InputError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io.akap.pose import decode_pose, encode_pose
from akap_editor.io.akap.project import decode_document, encode_document
from akap_editor.io.akap.recording import decode_recording
from akap_editor.io.export.gltf import encode_glb
from akap_editor.io.images import Picture, decode_image, encode_png
from akap_editor.io.layers.open_layers import decode_layers
from akap_editor.io.mesh_files.obj_off import PARSERS
from akap_editor.io.mesh_files.soundness import decode_mesh, mesh_defects
from akap_editor.io.open_document import open_document
from akap_editor.layers.composite import composite
from akap_editor.layers.layered_picture import Layer, LayeredPicture

MAX_CASE_SECONDS = 20.0  # of processor time; the largest allowed pictures take several
MAX_MEMORY_BYTES = 2**30
BOMB_SHARE = 1 / 8000  # of all .akap files
MESHED_SHARE = 0.1  # of the pictures and layers that open; meshing takes much longer than reading
REPLAYED_SHARE = 0.02  # of the recordings that open
SMALL_SIDE = 64  # pixels, of a picture that is meshed

Rng = np.random.Generator
Entries = list[tuple[str, bytes]]

JUNK: list[Any] = [
    *(None, True, False, -1, 0, 1, 2, 7, 2**31 - 1, 2**31, 2**53, 2**64, 10**400, 0.5, -0.0, 1e308, -1e308),
    *(float("nan"), float("inf"), "", "x", "../../etc/passwd", "/etc/passwd", "\ud800", "a" * 5000),
    *([], [1, 2], [1e308] * 3, [[]], [[0, 0]] * 3, {}, {"id": 1}),
]
NUMBERS = [0.0, -0.0, 1.0, -1.0, np.nan, np.inf, -np.inf, 1e300, -1e300, 5e-324, 1e9, 2e9]
INDICES = [-(2**31), -1, 0, 1, 2, 3, 4, 1000, 2**31 - 1]
NAMES = ["", "/", "../x", "/etc/passwd", "mesh", "mesh/", "mesh/../mimetype", "MIMETYPE", "a\\b", "x" * 3000]


def seed_documents() -> list[Document]:
    """Small drawings with pins, a pose and named poses: two triangles, and a strip of triangles."""
    documents = []
    for columns in (2, 5):
        x = np.repeat(np.arange(columns), 2)
        vertices = np.stack([2.0 * x, 4.0 * np.tile([0, 1], columns)], axis=1)
        left = 2 * np.arange(columns - 1)
        faces = np.concatenate(
            [np.stack([left, left + 2, left + 1], axis=1), np.stack([left + 1, left + 2, left + 3], axis=1)]
        )
        mesh = TriMesh(vertices, faces)
        width = 2 * (columns - 1)
        image = np.random.default_rng(columns).integers(0, 256, (4, width, 4), dtype=np.uint8)
        uv = (vertices / [width, 4]).astype(np.float32)
        pins = (
            Pin(1, 0, np.array([0.25, 0.25, 0.5]), np.array([0.1 + 0.2, -3.0])),
            Pin(7, 1, np.array([1.0, 0.0, 0.0]), np.array([1e3, 5e-3])),
        )
        poses = NamedPose("Wave", vertices + 1.0), NamedPose("Rest", vertices)
        state = EditState(pins, vertices * 1.25 + 0.5, poses=poses)
        documents.append(Document(Drawing(image, mesh, uv, "seed"), state))
    return documents


def seed_puppet() -> Document:
    """Two squares on layers, held together by a weld."""
    square = np.full((12, 12, 4), 255, dtype=np.uint8)
    layers = Layer("body", square), Layer("arm", square, (7, 3), opacity=0.5, blend="multiply")
    drawing = make_drawing(layers=LayeredPicture((20, 16), layers), vertices=20)
    joint = make_joint(drawing.mesh, 1, 1, 0, np.array([9.0, 8.0]), kind="weld")
    return Document(drawing, EditState((), drawing.mesh.vertices, joints=(joint,)))


def seed_recording(document: Document) -> bytes:
    """The recording of a short session with edits of many kinds."""
    editor = Editor(clock=lambda: 0.0)
    editor.open(Document(document.drawing, EditState((), document.drawing.mesh.vertices)))
    session = editor.session
    assert session is not None
    for at in ((1.0, 1.0), (1.5, 3.0)):
        gestures.add_pin(editor, at)
    session.begin("Drag")
    session.apply(SetTargets({1: (1.2, 0.8)}))
    for _ in range(3):
        session.step()
    session.commit()
    gestures.apply_pose(editor, session.state.pins, session.state.positions * 1.01)
    gestures.reset_pose(editor)
    editor.undo()
    editor.redo()
    gestures.remove_pins(editor, {2})
    return session.recording.to_text().encode()


# -- damage ------------------------------------------------------------------------------------------------


def pick(rng: Rng, values: Any) -> Any:
    """A random one of the values."""
    return values[int(rng.integers(len(values)))]


def change_bytes(rng: Rng, data: bytes) -> bytes:
    """Change one to three bytes."""
    if not data:
        return bytes(rng.integers(0, 256, 3, dtype=np.uint8))
    array = np.frombuffer(data, np.uint8).copy()
    array[rng.integers(0, len(array), rng.integers(1, 4))] = pick(
        rng, [0, 1, 127, 128, 255, rng.integers(256)]
    )
    return array.tobytes()


def cut(rng: Rng, data: bytes) -> bytes:
    """Cut off the end, cut out a part, or repeat a part."""
    a, b = sorted(int(place) for place in rng.integers(0, len(data) + 1, 2))
    return pick(rng, [data[:b], data[:a] + data[b:], data[:b] + data[a:]])


def change_json(rng: Rng, text: bytes) -> bytes:
    """Replace, remove or add a value at a random place of a JSON object."""
    try:
        record = json.loads(text)
    except ValueError:
        return change_bytes(rng, text)
    place = record
    while isinstance(place, dict | list) and place:
        key = pick(rng, list(place) if isinstance(place, dict) else range(len(place)))
        if not place[key] or not isinstance(place[key], dict | list) or rng.random() < 0.2:
            break
        place = place[key]
    if not isinstance(place, dict | list) or not place:
        return json.dumps(pick(rng, JUNK)).encode()
    if rng.random() < 0.15:
        del place[key]
    elif isinstance(place, dict) and rng.random() < 0.1:
        place[pick(rng, NAMES)] = pick(rng, JUNK)
    else:
        place[key] = pick(rng, JUNK)
    return json.dumps(record).encode()


def change_numbers(rng: Rng, name: str, data: bytes) -> bytes:
    """Change numbers of an array, in its own dtype."""
    if name == "mesh/faces":
        array: Any = np.frombuffer(data[: len(data) // 4 * 4], "<i4").copy()
        values: Any = INDICES
    else:
        size = 4 if name == "mesh/uv" else 8
        array = np.frombuffer(data[: len(data) // size * size], f"<f{size}").copy()
        values = NUMBERS
    if len(array):
        with np.errstate(over="ignore"):
            array[rng.integers(0, len(array), rng.integers(1, 4))] = pick(rng, values)
    return bytes(array.tobytes())


def png_chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    """Kind and content of each chunk of a PNG file."""
    chunks, at = [], 8
    while at + 12 <= len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    return chunks


def png(chunks: list[tuple[bytes, bytes]]) -> bytes:
    """A PNG file of chunks, with correct checksums."""
    parts = [b"\x89PNG\r\n\x1a\n"]
    for kind, content in chunks:
        parts.append(struct.pack(">I", len(content)) + kind + content)
        parts.append(struct.pack(">I", zlib.crc32(kind + content)))
    return b"".join(parts)


def change_png(rng: Rng, data: bytes) -> bytes:
    """Damage a chunk, the pixel stream or the header, or insert other chunks; checksums are correct."""
    chunks = png_chunks(data) or [(b"IHDR", data)]
    index = int(rng.integers(len(chunks)))
    kind, content = chunks[index]
    match int(rng.integers(5)):
        case 0:
            chunks[index] = kind, change_bytes(rng, content)
        case 1 if kind == b"IDAT":
            with suppress(zlib.error):  # it may have been damaged before
                chunks[index] = kind, zlib.compress(change_bytes(rng, zlib.decompress(content)), 1)
        case 2:
            chunks.pop(index)
        case 3:
            extra = pick(
                rng, [b"tRNS", b"PLTE", b"eXIf", b"zTXt", b"iCCP", b"acTL", b"fcTL", b"IDAT", b"gAMA"]
            )
            chunks.insert(index, (extra, rng.integers(0, 256, rng.integers(0, 30), dtype=np.uint8).tobytes()))
        case _:
            chunks.insert(index, pick(rng, chunks))
    return png(chunks)


def change_directory(rng: Rng, data: bytes) -> bytes:
    """Change sizes, methods, flags, offsets or names in the tables of a zip archive."""
    array = bytearray(data)
    signature = pick(rng, [b"PK\x01\x02", b"PK\x03\x04", b"PK\x05\x06"])
    places = [at for at in range(len(data)) if data.startswith(signature, at)]
    if places:
        at = pick(rng, places) + 4 + 2 * int(rng.integers(21))
        value = pick(rng, [0, 1, 8, 12, 14, 99, 0x7FFF, 0xFFFF, int(rng.integers(2**16))])
        array[at : at + 2] = struct.pack("<H", value)
    return bytes(array)


def pack(entries: Entries, method: int) -> bytes:
    """A zip archive of entries with any names."""
    buffer = BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w") as archive:
        warnings.simplefilter("ignore")  # of duplicate names
        for name, content in entries:
            info = zipfile.ZipInfo(name or "x")
            info.compress_type = method
            archive.writestr(info, content, compresslevel=1)
    return buffer.getvalue()


def bomb(rng: Rng, entries: Entries) -> Entries:
    """Entries that are small in the file and large when they are unpacked or decoded."""
    contents = dict(entries)
    record = json.loads(contents["document.json"])
    match int(rng.integers(6)):
        case 0:
            contents[pick(rng, list(contents))] = bytes(2**26)
        case 1:
            contents["document.json"] = b'{"pins":[' + b"{}," * 5_000_000 + b"{}]}"
        case 2:
            contents["document.json"] = b"[" * 2**24
        case 3:
            count = 1_000_000
            record["mesh"] = {"vertices": count, "faces": 2 * count}
            contents |= {"mesh/vertices": bytes(16 * count), "pose/positions": bytes(16 * count)}
            contents |= {"mesh/faces": bytes(24 * count), "mesh/uv": bytes(8 * count)}
            contents["document.json"] = json.dumps(record).encode()
        case 4:
            record["pins"] = [
                {"id": i, "face": 0, "weights": [1, 0, 0], "target": [0, 0]} for i in range(10**5)
            ]
            contents["document.json"] = json.dumps(record).encode()
        case _:
            side = 6000
            record["picture"] = {"width": side, "height": side}
            contents["document.json"] = json.dumps(record).encode()
            header = struct.pack(">IIBBBBB", side, side, 8, 6, 0, 0, 0)
            pixels = zlib.compress(bytes(side * (1 + 4 * side)), 1)
            contents["picture.png"] = png([(b"IHDR", header), (b"IDAT", pixels), (b"IEND", b"")])
    return list(contents.items())


def damaged_drawing(rng: Rng, files: list[Entries]) -> bytes:
    """An .akap file with damage in one or two places."""
    entries = list(pick(rng, files))
    method = pick(rng, [zipfile.ZIP_STORED, zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
    if rng.random() < BOMB_SHARE:
        return pack(bomb(rng, entries), zipfile.ZIP_DEFLATED)
    for _ in range(int(rng.integers(1, 3))):
        index, other = rng.integers(0, len(entries), 2)
        name, content = entries[index]
        match int(rng.integers(12)):
            case 0:
                return change_bytes(rng, pack(entries, method))
            case 1:
                return cut(rng, pack(entries, method))
            case 2:
                return change_directory(rng, pack(entries, method))
            case 3:
                entries[index] = name, entries[other][1]
            case 4:
                entries[index] = name, cut(rng, content)
            case 5:
                entries.pop(index)
            case 6:
                entries.insert(index, (pick(rng, [name, *NAMES]), content))
            case 7:
                entries[index] = name, pick(rng, files)[other % 6][1]
            case 8 | 9:
                entries = [(n, change_json(rng, c) if n.endswith(".json") else c) for n, c in entries]
            case 10:
                entries = [(n, change_png(rng, c) if n == "picture.png" and c else c) for n, c in entries]
            case _:
                change: Callable[..., bytes] = change_numbers if "/" in name else change_bytes
                entries[index] = name, change(rng, name, content) if "/" in name else change(rng, content)
        if not entries:
            break
    return pack(entries, method)


def damaged_pose(rng: Rng, poses: list[bytes]) -> bytes:
    """A damaged .pose.json file."""
    return pick(rng, [change_json, change_json, change_bytes, cut])(rng, pick(rng, poses))


def damaged_recording(rng: Rng, recordings: list[bytes]) -> bytes:
    """An .akaprec file with damaged, missing, repeated or swapped lines."""
    data = pick(rng, recordings)
    if rng.random() < 0.2:
        return pick(rng, [change_bytes, cut])(rng, data)
    lines = data.split(b"\n")
    for _ in range(int(rng.integers(1, 3))):
        index, other = rng.integers(0, len(lines), 2)
        match int(rng.integers(6)):
            case 0:
                lines[index], lines[other] = lines[other], lines[index]
            case 1:
                lines.pop(index)
            case 2:
                lines.insert(index, lines[other])
            case _:
                lines[index] = change_json(rng, lines[index])
        if not lines:
            break
    return b"\n".join(lines)


SQUARE = b"mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 9 5 0\nv 4 2 0\nv 0 5 0\nvt 0 0\nvt 1 1\n"
MESH_SEEDS = [
    (".obj", SQUARE + b"usemtl m\nf 1/1 2/2 3/1 4/1 5/2\n"),
    (".obj", SQUARE + b"f -5 -4 \\\n -3 -2 -1\n"),
    (".off", b"OFF\n5 2 0\n0 0 0\n9 0 0\n9 5 0\n4 2 0\n0 5 0\n3 0 1 3\n4 0 1 2 3\n"),
    (".json", b'{"vertices":[[0,0],[9,0],[9,5]],"faces":[[0,1,2]]}'),
    (".json", b'{"skins":[{"attachments":{"a":{"b":{"vertices":[0,0,9,0,9,5],"triangles":[0,1,2]}}}}]}'),
]
WORDS = [
    b"9" * 5000,
    b"1e999",
    b"-1",
    b"0",
    b"\xc2\xb2",
    b"nan",
    b"1_0",
    b"2147483648",
    b"",
    b"\\",
    b"f",
    b"v 1",
]


def damaged_text(rng: Rng, data: bytes) -> bytes:
    """A mesh file as text with other words, bytes or lengths."""
    if data.startswith(b"{") and rng.random() < 0.7:
        return change_json(rng, data)
    if rng.random() < 0.3:
        return pick(rng, [change_bytes, cut])(rng, data)
    words = data.split(b" ")
    for _ in range(int(rng.integers(1, 3))):
        words[int(rng.integers(len(words)))] = pick(rng, WORDS)
    return b" ".join(words)


MATERIAL = b"newmtl m\nKd 1 1 1\nmap_Kd -s 1 1 1 a.png\n"
PICTURE_KINDS = {"JPEG": "RGB", "WEBP": "RGBA", "BMP": "RGB", "TIFF": "RGBA", "GIF": "P"}


def seed_pictures() -> list[bytes]:
    """Small pictures in the formats of `PICTURE_KINDS`."""
    rgba = np.random.default_rng(3).integers(0, 256, (6, 8, 4), dtype=np.uint8)
    files = []
    for kind, mode in PICTURE_KINDS.items():
        buffer = BytesIO()
        Image.fromarray(rgba).convert(mode).save(buffer, kind)
        files.append(buffer.getvalue())
    return files


def damaged_glb(rng: Rng, data: bytes) -> bytes:
    """A glTF binary with another JSON, in a chunk of the right length, or with other bytes."""
    if rng.random() < 0.2:
        return pick(rng, [change_bytes, cut])(rng, data)
    (size,) = struct.unpack_from("<I", data, 12)
    text, binary = data[20 : 20 + size], data[20 + size :]
    for _ in range(int(rng.integers(1, 3))):
        text = change_json(rng, text)
    if rng.random() < 0.2:
        binary = change_bytes(rng, binary)
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(binary), len(text), b"JSON")
    return header + text + binary


def seed_psd() -> bytes:
    """A Photoshop file with two layers, one in a group with opacity."""
    psd = PSDImage.new("RGB", (8, 6))
    for name, parent in (("a", psd), ("b", psd.create_group(name="group", opacity=100))):
        picture = Image.fromarray(np.random.default_rng(1).integers(0, 256, (4, 5, 4), dtype=np.uint8))
        parent.create_pixel_layer(picture, name=name, left=1, top=1)
    buffer = BytesIO()
    psd.save(buffer)
    return buffer.getvalue()


def seed_ora() -> Entries:
    """The entries of an OpenRaster file with two layers, one in a group."""
    picture = encode_png(np.random.default_rng(1).integers(0, 256, (4, 5, 4), dtype=np.uint8))
    stack = (
        b'<image w="8" h="6"><stack><stack name="g" opacity="0.5" x="1">'
        b'<layer name="a" src="data/a.png" y="-1"/></stack>'
        b'<layer name="b" src="data/b.png" composite-op="svg:multiply" visibility="hidden"/></stack></image>'
    )
    return [
        ("mimetype", b"image/openraster"),
        ("stack.xml", stack),
        ("data/a.png", picture),
        ("data/b.png", picture),
    ]


def damaged_layers(rng: Rng, psd: bytes, ora: Entries) -> bytes:
    """A Photoshop or OpenRaster file with damage in one or two places."""
    if rng.random() < 0.5:
        for _ in range(int(rng.integers(1, 3))):
            psd = pick(rng, [change_bytes, change_bytes, cut])(rng, psd)
        return psd
    entries = list(ora)
    for _ in range(int(rng.integers(1, 3))):
        index = int(rng.integers(len(entries)))
        name, content = entries[index]
        match int(rng.integers(6)):
            case 0:
                return pick(rng, [change_bytes, cut, change_directory])(
                    rng, pack(entries, zipfile.ZIP_STORED)
                )
            case 1:
                entries[index] = name, change_png(rng, content) if name.endswith(".png") else content
            case 2:
                entries[index] = pick(rng, NAMES), content
            case _:
                words = entries[1][1].split(b'"')
                words[int(rng.integers(len(words)))] = pick(
                    rng, [*WORDS, b"stack", b"layer", b"/>", b"<stack>"]
                )
                entries[1] = "stack.xml", b'"'.join(words)
    return pack(entries, zipfile.ZIP_DEFLATED)


# -- what must hold ------------------------------------------------------------------------------------------


@dataclass
class Fuzzer:
    """Makes and checks one case per seed.

    counts: by kind and outcome; messages: of refused files; slowest: seconds, kind and seed of a case.
    """

    counts: Counter[str] = field(default_factory=Counter)
    messages: set[str] = field(default_factory=set)
    slowest: tuple[float, str, int] = (0.0, "", 0)

    def __post_init__(self) -> None:
        self.documents = seed_documents()
        self.files = []
        for document in [*self.documents, seed_puppet()]:
            with zipfile.ZipFile(BytesIO(encode_document(document))) as archive:
                self.files.append([(name, archive.read(name)) for name in archive.namelist()])
        self.poses = [encode_pose(document) for document in self.documents]
        self.psd, self.ora, self.pictures = seed_psd(), seed_ora(), seed_pictures()
        self.recordings = [seed_recording(document) for document in self.documents]
        self.glbs = [encode_glb(document.drawing, document.state.positions) for document in self.documents]

    def run(self, seed: int) -> None:
        """Check one case. Raises any exception but an `InputError` whose message is one line."""
        rng = np.random.default_rng(seed)
        kind = pick(rng, ["akap", "akap", "akap", "pose", "akaprec", "mesh", "picture", "glb", "layers"])
        started = time.process_time()
        try:
            getattr(self, f"_open_{kind}")(rng)
            outcome = "opened"
        except InputError as error:
            message = str(error)
            if "\n" in message or not message or len(message) > 600:
                raise AssertionError(f"not one line: {message!r}") from error
            self.messages.add(message)
            outcome = "refused"
        self.counts[f"{kind} {outcome}"] += 1
        self.slowest = max(self.slowest, (time.process_time() - started, kind, seed))

    def _open_akap(self, rng: Rng) -> None:
        check_saving(decode_document(damaged_drawing(rng, self.files)))

    def _open_mesh(self, rng: Rng) -> None:
        name, data = pick(rng, MESH_SEEDS)
        data = damaged_text(rng, data)
        if rng.random() < 0.5:
            mesh_defects(decode_mesh(data))
        if name not in PARSERS:
            return
        with TemporaryDirectory() as folder:
            path = Path(folder, f"a{name}")
            path.write_bytes(data)
            path.with_suffix(".mtl").write_bytes(
                pick(rng, [MATERIAL, damaged_text(rng, MATERIAL), change_bytes(rng, MATERIAL)])
            )
            if rng.random() < 0.7:
                picture = encode_png(self.documents[0].drawing.image)
                path.with_suffix(".png").write_bytes(pick(rng, [picture, change_png(rng, picture)]))
            check_saving(open_document(path))

    def _open_glb(self, rng: Rng) -> None:
        mesh_defects(decode_mesh(damaged_glb(rng, pick(rng, self.glbs))))

    def _open_picture(self, rng: Rng) -> None:
        if rng.random() < 0.5:
            image = decode_image(pick(rng, [change_bytes, cut])(rng, pick(rng, self.pictures)))
        else:
            document = pick(rng, self.documents)
            data = change_png(rng, encode_png(document.drawing.image))
            image = decode_image(data, ("PNG",), document.drawing.size)
        self._mesh_some(rng, image)
        if max(image.shape) <= SMALL_SIDE:
            assert (decode_image(encode_png(image)) == image).all()

    def _open_layers(self, rng: Rng) -> None:
        layered = decode_layers(damaged_layers(rng, self.psd, self.ora))
        if layered.size[0] * layered.size[1] < 2**20:
            picture = composite(layered)
            assert picture.shape[1::-1] == layered.size
            self._mesh_some(rng, picture)

    def _mesh_some(self, rng: Rng, image: Picture) -> None:
        """Make a drawing of a share of the pictures."""
        if rng.random() < MESHED_SHARE and max(image.shape) <= SMALL_SIDE:
            check_saving(new_document(make_drawing(image, vertices=50)))

    def _open_pose(self, rng: Rng) -> None:
        document = pick(rng, self.documents)
        pose = decode_pose(damaged_pose(rng, self.poses), document.drawing)
        posed = document.with_state(EditState(pose.pins, pose.positions))
        assert (
            decode_pose(encode_pose(posed), document.drawing).positions.tobytes() == pose.positions.tobytes()
        )
        check_saving(posed)

    def _open_akaprec(self, rng: Rng) -> None:
        recording = decode_recording(damaged_recording(rng, self.recordings))
        assert decode_recording(recording.to_text().encode()).events == recording.events
        if rng.random() < REPLAYED_SHARE and len(recording.events) < 100:
            try:
                replayed = Replay(recording, pick(rng, self.documents).drawing)
                for _ in replayed.events():
                    pass
            except AkapError as error:
                raise InputError(str(error)) from error
            if replayed.session is not None:
                check_saving(replayed.end().document)


def check_saving(document: Document) -> None:
    """Assert that a document can be saved, and that opening and saving it again gives the same bytes."""
    data = encode_document(document)
    assert encode_document(decode_document(data)) == data


def stop_case(*_: object) -> None:
    """End a case that takes too long."""
    raise TimeoutError(f"over {MAX_CASE_SECONDS:g} s")


def main() -> None:
    """Run the cases and print the results."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1, help="of the first case; each next one is one higher")
    options = parser.parse_args()
    warnings.simplefilter("error")
    signal.signal(signal.SIGPROF, stop_case)
    fuzzer, failed = Fuzzer(), 0
    started = time.process_time()
    for seed in range(options.seed, options.seed + options.cases):
        signal.setitimer(signal.ITIMER_PROF, MAX_CASE_SECONDS)
        try:
            fuzzer.run(seed)
        except Exception as error:
            failed += 1
            print(f"FAILED --seed {seed}: {type(error).__name__}: {error}", flush=True)
            if options.cases == 1:
                raise
        signal.setitimer(signal.ITIMER_PROF, 0)
        if (seed + 1 - options.seed) % 10_000 == 0:
            print_results(fuzzer, failed, started)
    print_results(fuzzer, failed, started)
    sys.exit(bool(failed) or peak_memory() > MAX_MEMORY_BYTES)


def peak_memory() -> int:
    """The peak memory of this process in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def print_results(fuzzer: Fuzzer, failed: int, started: float) -> None:
    """Print the results so far."""
    seconds, kind, seed = fuzzer.slowest
    count = fuzzer.counts.total() + failed
    print(f"{count} files, {failed} failed, {time.process_time() - started:.0f} s of work")
    print(", ".join(f"{name}: {number}" for name, number in sorted(fuzzer.counts.items())))
    print(f"{len(fuzzer.messages)} different messages; slowest {1000 * seconds:.0f} ms ({kind}, seed {seed})")
    print(f"peak memory {peak_memory() / 1e6:.0f} MB", flush=True)


if __name__ == "__main__":
    main()
