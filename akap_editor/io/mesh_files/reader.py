"""Meshes as files: OBJ (Wavefront) and OFF, flat, with y up as in other programs.

The readers are our own because the defects that they have to name are what libraries repair on the way: they
merge vertices, split them along seams, drop faces and renumber the rest.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing
from ...errors import InputError
from ...geometry.mesh import TriMesh, signed_areas
from ...geometry.validation import Floats, Ints
from ..atomic import read_file, write_atomic
from ..images import read_image

MAX_VERTICES, MAX_CORNERS = 1_000_000, 6_000_000

_FLAT = 1e-6  # share of its width and height up to which a mesh may be thick
_SMALLEST, _LARGEST, _USUAL = 100.0, 4000.0, 1000.0  # pixels: sizes that are kept; what others become
_MARGIN, _LINES = 20.0, 20  # pixels around a mesh without a texture; lines of the grid drawn on it
_PAPER, _INK = (226, 228, 234, 255), (150, 156, 170, 255)
_TEXTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")


@dataclass
class _Content:
    """What a mesh file says, with indices from 0.

    vertices: as in the file, 3 numbers each; faces: polygons; coordinates: of the texture, 2 numbers each;
    corners: of each face that has any, which of those; library: the file that names the texture.
    """

    vertices: list[list[float]] = field(default_factory=list)
    faces: list[list[int]] = field(default_factory=list)
    coordinates: list[list[float]] = field(default_factory=list)
    corners: list[list[int]] = field(default_factory=list)
    library: str = ""


def read_mesh(path: str | Path) -> Drawing:
    """The flat mesh in an OBJ or OFF file as a drawing.

    Its picture is the one that the file's material names (map_Kd), or else one of the same name beside it.
    With texture coordinates the mesh is placed where it fits them best, without them in pixels; polygons are
    cut into triangles. Without a picture a grid is drawn on it. Raises InputError in one sentence on a file
    that is not readable, a mesh that is not flat, or what `TriMesh` refuses.
    """
    path = Path(path)
    data = read_file(path, "a mesh")
    try:
        content = READERS[path.suffix.lower()](data.decode("utf-8", errors="replace"))
        return _drawing(content, path)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def write_obj(path: str | Path, mesh: TriMesh, size: tuple[int, int]) -> None:
    """Write the rest pose of a picture's mesh as an OBJ file, in pixels, y up from the picture's lower edge.

    size: width and height of the picture, on which the texture coordinates lie. Raises InputError.
    """
    points = np.array([0.0, size[1]]) + mesh.vertices * [1.0, -1.0]
    lines = [
        *(f"v {x:.9g} {y:.9g} 0" for x, y in points.tolist()),
        *(f"vt {u:.9g} {v:.9g}" for u, v in (points / size).tolist()),
        *(f"f {a}/{a} {b}/{b} {c}/{c}" for a, b, c in (mesh.faces[:, ::-1] + 1).tolist()),
    ]
    write_atomic(path, ("\n".join(lines) + "\n").encode())


def _drawing(content: _Content, path: Path) -> Drawing:
    points, faces = _flat(content.vertices), _triangles(content.faces)
    if not len(faces):
        raise InputError("expected a mesh with faces, got none")
    flipped = signed_areas(points, faces) < 0
    faces[flipped] = faces[flipped][:, ::-1]
    uv = _uv(content, len(points))
    texture, is_named = _texture(content, path)
    if texture is not None and uv is not None:
        size = np.array([texture.shape[1], texture.shape[0]], dtype=np.float64)
        return Drawing(texture, TriMesh(_placed(points, uv * size), faces, True), _float32(uv), path.stem)
    if texture is not None:
        size = np.array([texture.shape[1], texture.shape[0]], dtype=np.float64)
        places = points + np.array([0.0, size[1] if (points[:, 1] < 0).any() else 0.0])
        if (places >= 0).all() and (places <= size).all():
            return Drawing(texture, TriMesh(places, faces, True), _float32(places / size), path.stem)
        if is_named:
            raise InputError("expected texture coordinates, as the material has a texture, got none")
    mesh = TriMesh(_in_pixels(points), faces, True)
    image = _grid(mesh.vertices.max(axis=0) + _MARGIN)
    return Drawing(image, mesh, _float32(mesh.vertices / [image.shape[1], image.shape[0]]), path.stem)


def _flat(vertices: list[list[float]]) -> Floats:
    """The places (n, 2) with y down."""
    if not vertices:
        raise InputError("expected a mesh with vertices, got none")
    if len(vertices) > MAX_VERTICES:
        raise InputError(f"expected at most {MAX_VERTICES} vertices, got {len(vertices)}")
    points = np.array(vertices)
    if not np.isfinite(points).all() or np.abs(points).max() > 1e9:
        raise InputError("expected finite coordinates up to 1e9, got others")
    low, high = points.min(axis=0), points.max(axis=0)
    if high[2] - low[2] > _FLAT * max(high[:2] - low[:2]):
        raise InputError(f"expected a flat mesh, got one in 3D, with z from {low[2]:g} to {high[2]:g}")
    return points[:, :2] * [1.0, -1.0]


def _triangles(polygons: list[list[int]]) -> Ints:
    """(m, 3): each polygon cut from its first corner."""
    cut = [(face[0], b, c) for face in polygons for b, c in pairwise(face[1:])]
    return np.array(cut, dtype=np.int32).reshape(-1, 3)


def _uv(content: _Content, count: int) -> Floats | None:
    """Texture coordinates (n, 2) with v down, or None. Raises InputError where a vertex has several."""
    if not content.corners:
        return None
    vertex = np.concatenate([np.array(face) for face in content.faces])
    corner = np.concatenate([np.array(face) for face in content.corners])
    if len(corner) != len(vertex):
        raise InputError("expected texture coordinates at every corner of every face or at none, got some")
    coordinates = np.array(content.coordinates)[corner]
    if not np.isfinite(coordinates).all() or np.abs(coordinates).max() > 1e6:
        raise InputError("expected finite texture coordinates up to 1e6, got others")
    uv = np.zeros((count, 2))
    uv[vertex] = coordinates
    several = (uv[vertex] != coordinates).any(axis=1)
    if several.any():
        number = int(vertex[np.argmax(several)]) + 1
        raise InputError(
            f"expected one place in the texture for each vertex, but vertex {number} has several"
        )
    return np.array([0.0, 1.0]) + uv * [1.0, -1.0]


def _texture(content: _Content, path: Path) -> tuple[NDArray[np.uint8] | None, bool]:
    """The picture, if there is one, and whether the file names it."""
    library = path.with_name(Path(content.library).name) if content.library else None
    if library is not None and library.is_file():
        text = read_file(library, "a material").decode("utf-8", errors="replace")
        for line in text.splitlines():
            words = line.split(maxsplit=1)
            if len(words) == 2 and words[0] == "map_Kd":
                return read_image(path.with_name(Path(words[1].strip().replace("\\", "/")).name)), True
    for suffix in _TEXTURE_SUFFIXES:
        comparison = path.with_suffix(suffix)
        if comparison.is_file():
            return read_image(comparison), False
    return None, False


def _placed(points: Floats, goals: Floats) -> Floats:
    """The points scaled and moved, not turned, to where they are nearest to ``goals``, pixels."""
    arms, aims = points - points.mean(axis=0), goals - goals.mean(axis=0)
    scale = float((arms * aims).sum() / (arms**2).sum()) if arms.any() else 0.0
    if scale <= 0:
        raise InputError("expected a texture that is the right way round, got a mirrored or turned one")
    return goals.mean(axis=0) + scale * arms


def _in_pixels(points: Floats) -> Floats:
    """The points at a margin from the origin, at a size that fits a screen."""
    low, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    scale = 1.0 if _SMALLEST <= size <= _LARGEST else _USUAL / size if size > 0 else 1.0
    return (points - low) * scale + _MARGIN


def _grid(size: Floats) -> NDArray[np.uint8]:
    """A picture of at least this size with lines, on which it can be seen how a mesh bends."""
    width, height = np.ceil(size).astype(int).tolist()
    image = np.empty((height, width, 4), dtype=np.uint8)
    image[:] = _PAPER
    step = max(max(width, height) // _LINES, 4)
    image[step // 2 :: step], image[:, step // 2 :: step] = _INK, _INK
    return image


def _float32(values: Floats) -> NDArray[np.float32]:
    return values.astype(np.float32)


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Number and words of each line, without comments."""
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        if words:
            yield number, words


def _numbers(words: list[str], count: int, number: int) -> list[float]:
    try:
        return [float(word) for word in words[:count]] + [0.0] * (count - len(words))
    except ValueError:
        raise InputError(f"line {number}: expected numbers, got {' '.join(words)[:60]!r}") from None


def _index(word: str, count: int, number: int, what: str) -> int:
    """An index of an OBJ file from 0; negative ones count from the end."""
    try:
        index = int(word)
    except ValueError:
        raise InputError(f"line {number}: expected an index, got {word[:60]!r}") from None
    if not 1 <= abs(index) <= count:
        raise InputError(f"line {number}: expected a {what} from 1 to {count}, got {index}")
    return index - 1 if index > 0 else count + index


def _read_obj(text: str) -> _Content:
    content = _Content()
    lines = list(_lines(text.replace("\\\n", " ")))
    for number, (kind, *words) in lines:
        if kind == "v":
            if len(words) < 2:
                raise InputError(f"line {number}: expected x and y of a vertex, got {len(words)} numbers")
            content.vertices.append(_numbers(words, 3, number))
        elif kind == "vt":
            content.coordinates.append(_numbers(words, 2, number))
        elif kind == "mtllib" and words:
            content.library = " ".join(words)
    for number, (kind, *words) in lines:
        if kind == "f":
            _add_face(content, words, number)
    return content


def _add_face(content: _Content, words: list[str], number: int) -> None:
    if len(words) < 3:
        raise InputError(f"line {number}: expected a face with 3 corners or more, got {len(words)}")
    parts = [word.split("/") for word in words]
    content.faces.append([_index(part[0], len(content.vertices), number, "vertex") for part in parts])
    places = [part[1] for part in parts if len(part) > 1 and part[1]]
    if places:
        count = len(content.coordinates)
        content.corners.append([_index(place, count, number, "texture coordinate") for place in places])


def _read_off(text: str) -> _Content:
    lines = _lines(text)
    number, words = next(lines, (1, [""]))
    if words[0] not in ("OFF", "COFF"):
        raise InputError(f"line {number}: expected OFF, got {words[0][:20]!r}")
    if len(words) == 1:
        number, words = next(lines, (number + 1, []))
    else:
        words = words[1:]
    counts = [int(value) if value.is_integer() else -1 for value in _numbers(words, 2, number)]
    if not (0 <= counts[0] <= MAX_VERTICES and 0 <= counts[1] <= MAX_CORNERS):
        raise InputError(
            f"line {number}: expected the numbers of vertices and faces, got {' '.join(words)!r}"
        )
    content = _Content()
    rows = [row for _, row in zip(range(sum(counts)), lines, strict=False)]
    if len(rows) < sum(counts):
        raise InputError(f"expected {counts[0]} vertices and {counts[1]} faces, but the file ends before")
    content.vertices = [_numbers(words, 3, number) for number, words in rows[: counts[0]]]
    for number, words in rows[counts[0] :]:
        size = int(words[0]) if words[0].isdigit() else 0
        if not 3 <= size < len(words):
            raise InputError(f"line {number}: expected a face with 3 corners or more, got {words[0][:20]!r}")
        indices = words[1 : size + 1]
        if not all(word.isdigit() and int(word) < counts[0] for word in indices):
            came = " ".join(indices)[:60]
            raise InputError(f"line {number}: expected vertices from 0 to {counts[0] - 1}, got {came}")
        content.faces.append([int(word) for word in indices])
    return content


READERS: dict[str, Callable[[str], _Content]] = {".obj": _read_obj, ".off": _read_off}
