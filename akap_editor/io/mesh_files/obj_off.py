"""Parses OBJ (Wavefront) and OFF files as other programs write them, and writes OBJ files.

The parsers are our own because libraries silently repair the defects that must be reported: they merge
vertices, split them along seams, drop faces and renumber the rest.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ...words import tr
from ..akap.picture_record import MAX_DOCUMENT_VERTICES
from ..atomic import write_atomic

_MAX_CORNERS = 6_000_000
_MAX_DIGITS = 15  # of an index: more than any that is valid
_INTEGER = re.compile(r"[+-]?[0-9]+", re.ASCII)
_NUMBER = re.compile(
    r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?|[+-]?(nan|inf|infinity)", re.A | re.I
)
_LINE_END = re.compile(r"\r\n|\r|\n")
# Geomview's headers; the coordinates of a vertex come first, whatever follows them. ("4OFF" is not flat.)
OFF_HEADER = re.compile(r"(ST)?C?N?OFF", re.I)
_NAME_KINDS = ("mtllib", "usemtl")  # whose value may hold spaces and number signs


@dataclass
class PolygonMesh:
    """A mesh as in its file, with indices from 0.

    vertices: 3 coordinates each; faces: polygons of vertex indices; texture_points: 2 coordinates each;
    texture_corners: for each face that has any, the texture point of each corner; material_libraries: names
    of the files with the materials, in order, as written after "mtllib"; materials: names of the materials of
    faces, in order, each once.
    """

    vertices: list[list[float]] = field(default_factory=list)
    faces: list[list[int]] = field(default_factory=list)
    texture_points: list[list[float]] = field(default_factory=list)
    texture_corners: list[list[int]] = field(default_factory=list)
    material_libraries: list[str] = field(default_factory=list)
    materials: list[str] = field(default_factory=list)


def write_obj(path: str | Path, mesh: TriMesh, size: tuple[int, int]) -> None:
    """Write the rest pose of a picture's mesh as an OBJ file, in pixels, y up from the picture's lower edge.

    size: width and height of the picture that the texture coordinates refer to. Raises InputError.
    """
    points = np.array([0.0, size[1]]) + mesh.vertices * [1.0, -1.0]
    lines = [
        *(f"v {x:.9g} {y:.9g} 0" for x, y in points.tolist()),
        *(f"vt {u:.9g} {v:.9g}" for u, v in (points / size).tolist()),
        *(f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in (mesh.faces[:, ::-1] + 1).tolist()),
    ]
    write_atomic(path, ("\n".join(lines) + "\n").encode())


def decode_text(data: bytes) -> str:
    """The text of a mesh or material file: UTF-8 or UTF-16 by its byte order mark; never fails."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", errors="replace")
    return data.decode("utf-8-sig", errors="surrogateescape")


def parse_obj(text: str) -> PolygonMesh:
    """Parse the text of an OBJ file. Raises InputError with the number of the bad line.

    Negative indices count back from the line of their face, positive ones may refer to later lines.
    """
    mesh = PolygonMesh()
    # Of each face: number of its line, words of its corners, vertices and points before it.
    corner_lines: list[tuple[int, list[list[str]], int, int]] = []
    material = ""
    for number, (kind, *words) in _lines(text, _NAME_KINDS):
        match kind.lower():
            case "v":
                if len(words) < 2:
                    raise InputError(
                        tr(
                            "line {number}: expected x and y of a vertex, got {count} numbers",
                            number=number,
                            count=len(words),
                        )
                    )
                mesh.vertices.append(_numbers(words, 3, number))
            case "vt":
                mesh.texture_points.append(_numbers(words, 2, number))
            case "f":
                if len(words) < 3:
                    raise InputError(
                        tr(
                            "line {number}: expected a face with 3 corners or more, got {count}",
                            number=number,
                            count=len(words),
                        )
                    )
                corners = [word.split("/") for word in words]
                corner_lines.append((number, corners, len(mesh.vertices), len(mesh.texture_points)))
                if material and material not in mesh.materials:
                    mesh.materials.append(material)
            case "mtllib" if words:
                mesh.material_libraries.append(words[0])
            case "usemtl":
                material = words[0].split(" #", 1)[0].strip() if words else ""
    for line in corner_lines:
        _add_face(mesh, *line)
    return mesh


def _add_face(mesh: PolygonMesh, number: int, corners: list[list[str]], vertices: int, points: int) -> None:
    """Add the face of a line; each corner is a vertex index and perhaps that of a texture point: v/vt/vn.

    vertices, points: how many of each the file had before this line.
    """
    counts = len(mesh.vertices), len(mesh.texture_points)
    mesh.faces.append([_index(corner[0], vertices, counts[0], number, "vertex") for corner in corners])
    words = [corner[1] for corner in corners if len(corner) > 1 and corner[1]]
    if words:
        name = "texture coordinate"
        mesh.texture_corners.append([_index(word, points, counts[1], number, name) for word in words])


def parse_off(text: str) -> PolygonMesh:
    """Parse the text of an OFF file. Raises InputError with the number of the bad line."""
    lines = _lines(text)
    number, words = next(lines, (1, [""]))
    if OFF_HEADER.fullmatch(words[0]):
        if len(words) > 1 and words[1].lower() == "binary":
            raise InputError(
                tr("line {number}: expected an OFF file of text, got a binary one", number=number)
            )
        number, words = (number, words[1:]) if len(words) > 1 else next(lines, (number + 1, []))
    elif not _INTEGER.fullmatch(words[0]):  # the header may be absent
        raise InputError(tr("line {number}: expected OFF, got {word!r}", number=number, word=words[0][:20]))
    counts = [_count(word) for word in words[:2]]
    if len(counts) < 2 or not (0 <= counts[0] <= MAX_DOCUMENT_VERTICES and 0 <= counts[1] <= _MAX_CORNERS):
        actual = " ".join(words)[:60]
        raise InputError(
            tr(
                "line {number}: expected the numbers of vertices and faces, got {actual!r}",
                number=number,
                actual=actual,
            )
        )
    mesh = PolygonMesh()
    rows = [row for _, row in zip(range(sum(counts)), lines, strict=False)]
    if len(rows) < sum(counts):
        raise InputError(
            tr(
                "expected {vertices} vertices and {faces} faces, but the file ends before",
                vertices=counts[0],
                faces=counts[1],
            )
        )
    mesh.vertices = [_numbers(words, 3, number) for number, words in rows[: counts[0]]]
    for number, words in rows[counts[0] :]:
        size = _count(words[0])
        if not 3 <= size < len(words):
            raise InputError(
                tr(
                    "line {number}: expected a face with 3 corners or more, got {word!r}",
                    number=number,
                    word=words[0][:20],
                )
            )
        indices = [_count(word) for word in words[1 : size + 1]]
        if not all(0 <= index < counts[0] for index in indices):
            actual = " ".join(words[1 : size + 1])[:60]
            raise InputError(
                tr(
                    "line {number}: expected vertices from 0 to {last}, got {actual}",
                    number=number,
                    last=counts[0] - 1,
                    actual=actual,
                )
            )
        mesh.faces.append(indices)
    return mesh


PARSERS: dict[str, Callable[[str], PolygonMesh]] = {".obj": parse_obj, ".off": parse_off}


def _lines(text: str, name_kinds: tuple[str, ...] = ()) -> Iterator[tuple[int, list[str]]]:
    """Number and words of each line that is not empty; a line that ends in a backslash continues on the next.

    Comments are skipped. name_kinds: first words, in lower case, whose value is the whole rest of the line.
    """
    begun, first_number = "", 0
    for number, line in enumerate(_LINE_END.split(text.removeprefix("\ufeff")), start=1):
        words = line.split(maxsplit=1)
        if not begun and len(words) == 2 and words[0].lower() in name_kinds:
            yield number, [words[0], words[1].strip()]
            continue
        content = line.split("#", 1)[0].rstrip()
        first_number = first_number if begun else number
        if content.endswith("\\"):
            begun += content[:-1] + " "
            continue
        words, begun = (begun + content).split(), ""
        if words:
            yield first_number, words
    if begun.split():
        yield first_number, begun.split()


def _numbers(words: list[str], count: int, number: int) -> list[float]:
    """The first ``count`` words of a line as numbers; missing ones are 0."""
    if not all(_NUMBER.fullmatch(word) for word in words[:count]):
        raise InputError(
            tr("line {number}: expected numbers, got {words!r}", number=number, words=" ".join(words)[:60])
        )
    return [float(word) for word in words[:count]] + [0.0] * (count - len(words))


def _count(word: str) -> int:
    """A whole number of an OFF file; -1 if the word is none, or too long to be valid."""
    return int(word) if len(word) <= _MAX_DIGITS and _INTEGER.fullmatch(word) else -1


def _index(word: str, before: int, count: int, number: int, kind: str) -> int:
    """An index of an OBJ file, from 0.

    before: number of elements before the line, from which negative indices count back; count: in the file.
    """
    if not _INTEGER.fullmatch(word):
        raise InputError(tr("line {number}: expected an index, got {word!r}", number=number, word=word[:60]))
    index = int(word) if len(word) <= _MAX_DIGITS else 0
    if not (1 <= index <= count or 1 <= -index <= before):
        raise InputError(
            tr(
                "line {number}: expected a {kind} from 1 to {count}, got {word}",
                number=number,
                kind=kind,
                count=count,
                word=word[:60],
            )
        )
    return index - 1 if index > 0 else before + index
