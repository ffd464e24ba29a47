"""Parses OBJ (Wavefront) and OFF files, and writes OBJ files.

The parsers are our own because libraries silently repair the defects that must be reported: they merge
vertices, split them along seams, drop faces and renumber the rest.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import InputError
from ...geometry.mesh import TriMesh
from ..akap.project import MAX_VERTICES
from ..atomic import write_atomic

_MAX_CORNERS = 6_000_000


@dataclass
class PolygonMesh:
    """A mesh as in its file, with indices from 0.

    vertices: 3 coordinates each; faces: polygons of vertex indices; texture_points: 2 coordinates each;
    texture_corners: for each face that has any, the texture point of each corner; material_library: name of
    the file with the materials, or "".
    """

    vertices: list[list[float]] = field(default_factory=list)
    faces: list[list[int]] = field(default_factory=list)
    texture_points: list[list[float]] = field(default_factory=list)
    texture_corners: list[list[int]] = field(default_factory=list)
    material_library: str = ""


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


def parse_obj(text: str) -> PolygonMesh:
    """The mesh in the text of an OBJ file. Raises InputError with the number of the bad line."""
    mesh = PolygonMesh()
    lines = list(_lines(text.replace("\\\n", " ")))
    for number, (kind, *words) in lines:
        if kind == "v":
            if len(words) < 2:
                raise InputError(f"line {number}: expected x and y of a vertex, got {len(words)} numbers")
            mesh.vertices.append(_numbers(words, 3, number))
        elif kind == "vt":
            mesh.texture_points.append(_numbers(words, 2, number))
        elif kind == "mtllib" and words:
            mesh.material_library = " ".join(words)
    for number, (kind, *words) in lines:
        if kind == "f":
            _add_face(mesh, words, number)
    return mesh


def _add_face(mesh: PolygonMesh, words: list[str], number: int) -> None:
    """Add a face; each word is a vertex index, perhaps followed by that of a texture point: v/vt/vn."""
    if len(words) < 3:
        raise InputError(f"line {number}: expected a face with 3 corners or more, got {len(words)}")
    corners = [word.split("/") for word in words]
    mesh.faces.append([_index(corner[0], len(mesh.vertices), number, "vertex") for corner in corners])
    texture_words = [corner[1] for corner in corners if len(corner) > 1 and corner[1]]
    if texture_words:
        count = len(mesh.texture_points)
        mesh.texture_corners.append(
            [_index(word, count, number, "texture coordinate") for word in texture_words]
        )


def parse_off(text: str) -> PolygonMesh:
    """The mesh in the text of an OFF file. Raises InputError with the number of the bad line."""
    lines = _lines(text)
    number, words = next(lines, (1, [""]))
    if words[0] not in ("OFF", "COFF"):
        raise InputError(f"line {number}: expected OFF, got {words[0][:20]!r}")
    if len(words) == 1:
        number, words = next(lines, (number + 1, []))
    else:
        words = words[1:]
    counts = [int(value) if value.is_integer() else -1 for value in _numbers(words, 2, number)]
    if not (0 <= counts[0] <= MAX_VERTICES and 0 <= counts[1] <= _MAX_CORNERS):
        raise InputError(
            f"line {number}: expected the numbers of vertices and faces, got {' '.join(words)!r}"
        )
    mesh = PolygonMesh()
    rows = [row for _, row in zip(range(sum(counts)), lines, strict=False)]
    if len(rows) < sum(counts):
        raise InputError(f"expected {counts[0]} vertices and {counts[1]} faces, but the file ends before")
    mesh.vertices = [_numbers(words, 3, number) for number, words in rows[: counts[0]]]
    for number, words in rows[counts[0] :]:
        size = int(words[0]) if words[0].isdigit() else 0
        if not 3 <= size < len(words):
            raise InputError(f"line {number}: expected a face with 3 corners or more, got {words[0][:20]!r}")
        indices = words[1 : size + 1]
        if not all(word.isdigit() and int(word) < counts[0] for word in indices):
            came = " ".join(indices)[:60]
            raise InputError(f"line {number}: expected vertices from 0 to {counts[0] - 1}, got {came}")
        mesh.faces.append([int(word) for word in indices])
    return mesh


PARSERS: dict[str, Callable[[str], PolygonMesh]] = {".obj": parse_obj, ".off": parse_off}


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Number and words of each line that is not empty; comments are skipped."""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        if words:
            yield number, words


def _numbers(words: list[str], count: int, number: int) -> list[float]:
    """The first ``count`` words of a line as numbers; missing ones are 0."""
    try:
        return [float(word) for word in words[:count]] + [0.0] * (count - len(words))
    except ValueError:
        raise InputError(f"line {number}: expected numbers, got {' '.join(words)[:60]!r}") from None


def _index(word: str, count: int, number: int, what: str) -> int:
    """An index of an OBJ file, from 0; negative ones count from the end."""
    try:
        index = int(word)
    except ValueError:
        raise InputError(f"line {number}: expected an index, got {word[:60]!r}") from None
    if not 1 <= abs(index) <= count:
        raise InputError(f"line {number}: expected a {what} from 1 to {count}, got {index}")
    return index - 1 if index > 0 else count + index
