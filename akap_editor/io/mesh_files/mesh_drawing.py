"""Opens a flat mesh from another program as a drawing."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...editor.document.drawing import Drawing
from ...errors import InputError, file_errors
from ...geometry.mesh import TriMesh, signed_areas
from ...geometry.validation import Floats
from ...words import mark, tr
from ..akap.picture_record import MAX_DOCUMENT_VERTICES
from ..atomic import read_file, resolved
from ..images import read_image
from .materials import parse_textures
from .obj_off import PARSERS, PolygonMesh, decode_text
from .polygons import triangulate_polygons

_MAX_THICKNESS = 1e-6  # share of its width and height up to which a mesh counts as flat
# Pixels: a mesh between the first two sizes keeps its size, others are scaled to the third.
_SMALLEST_SIZE, _LARGEST_SIZE, _USUAL_SIZE = 100.0, 4000.0, 1000.0
_MARGIN = 20.0  # pixels around a mesh without a texture
_GRID_LINES = 20  # on a mesh without a texture
_PAPER, _INK = (226, 228, 234, 255), (150, 156, 170, 255)
_MAX_FOLDERS = 16  # in the name of a texture
_TEXTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")


def read_mesh(path: str | Path) -> Drawing:
    """The flat mesh in an OBJ or OFF file as a drawing.

    Its picture is the texture that the file's material names (map_Kd), or else a picture of the same name in
    the same folder. Texture coordinates place the mesh on the picture; without them its coordinates are
    pixels. A mesh without a picture gets one with a grid. Polygons are cut into triangles.
    Raises InputError if the file is not readable, the mesh not flat, or refused by `TriMesh`.
    """
    path = Path(path)
    data = read_file(path, mark("a mesh"))
    with file_errors("open", path):
        return _drawing(PARSERS[path.suffix.lower()](decode_text(data)), path)


def _drawing(mesh: PolygonMesh, path: Path) -> Drawing:
    points = _flat_points(mesh.vertices)
    faces = triangulate_polygons(points, mesh.faces)
    if not len(faces):
        raise InputError(tr("expected a mesh with faces, got none"))
    flipped = signed_areas(points, faces) < 0
    faces[flipped] = faces[flipped][:, ::-1]
    uv = _texture_coordinates(mesh, len(points))
    texture, is_named = _texture(mesh, path)
    if texture is not None and uv is not None:
        size = np.array([texture.shape[1], texture.shape[0]], dtype=np.float64)
        placed = TriMesh(_fit(points, uv * size), faces, True)
        return Drawing(texture, placed, _float32(uv), path.stem)
    if texture is not None:
        size = np.array([texture.shape[1], texture.shape[0]], dtype=np.float64)
        pixels = points + np.array([0.0, size[1] if (points[:, 1] < 0).any() else 0.0])
        if (pixels >= 0).all() and (pixels <= size).all():
            return Drawing(texture, TriMesh(pixels, faces, True), _float32(pixels / size), path.stem)
        if is_named:
            raise InputError(tr("expected texture coordinates, as the material has a texture, got none"))
    trimesh = TriMesh(_to_pixels(points), faces, True)
    image = _grid_picture(trimesh.vertices.max(axis=0) + _MARGIN)
    return Drawing(image, trimesh, _float32(trimesh.vertices / [image.shape[1], image.shape[0]]), path.stem)


def _flat_points(vertices: list[list[float]]) -> Floats:
    """The vertices (n, 2) with y down. Raises InputError if they are not flat, finite and few enough."""
    if not vertices:
        raise InputError(tr("expected a mesh with vertices, got none"))
    if len(vertices) > MAX_DOCUMENT_VERTICES:
        raise InputError(
            tr(
                "expected at most {most} vertices, got {count}",
                most=MAX_DOCUMENT_VERTICES,
                count=len(vertices),
            )
        )
    points = np.array(vertices)
    if not np.isfinite(points).all() or np.abs(points).max() > 1e9:
        raise InputError(tr("expected finite coordinates up to 1e9, got others"))
    low, high = points.min(axis=0), points.max(axis=0)
    if high[2] - low[2] > _MAX_THICKNESS * max(high[:2] - low[:2]):
        raise InputError(
            tr(
                "expected a flat mesh, got one in 3D, with z from {low:g} to {high:g}",
                low=low[2],
                high=high[2],
            )
        )
    return points[:, :2] * [1.0, -1.0]


def _texture_coordinates(mesh: PolygonMesh, count: int) -> Floats | None:
    """Texture coordinates (n, 2) with v down, or None. Raises InputError if a vertex has several."""
    if not mesh.texture_corners:
        return None
    vertex = np.concatenate([np.array(face) for face in mesh.faces])
    corner = np.concatenate([np.array(face) for face in mesh.texture_corners])
    if len(corner) != len(vertex):
        raise InputError(
            tr("expected texture coordinates at every corner of every face or at none, got some")
        )
    coordinates = np.array(mesh.texture_points)[corner]
    if not np.isfinite(coordinates).all() or np.abs(coordinates).max() > 1e6:
        raise InputError(tr("expected finite texture coordinates up to 1e6, got others"))
    uv = np.zeros((count, 2))
    uv[vertex] = coordinates
    several = (uv[vertex] != coordinates).any(axis=1)
    if several.any():
        number = int(vertex[np.argmax(several)]) + 1
        raise InputError(
            tr(
                "expected one place in the texture for each vertex, but vertex {number} has several",
                number=number,
            )
        )
    return np.array([0.0, 1.0]) + uv * [1.0, -1.0]


def _texture(mesh: PolygonMesh, path: Path) -> tuple[NDArray[np.uint8] | None, bool]:
    """The picture, if there is one, and whether the material names it. Only the mesh's folder is searched."""
    textures: dict[str, str] = {}  # file names by materials
    for library in mesh.material_libraries:
        whole_names = [name for name in (library, library.split(" #", 1)[0]) if _find(path.parent, name)]
        for name in whole_names[:1] or library.split():
            file = _find(path.parent, name)
            if file is not None:
                textures = {**parse_textures(decode_text(read_file(file, mark("a material")))), **textures}
    used = [textures[name] for name in mesh.materials if name in textures] or list(textures.values())
    if used:
        folder_and_name = used[0].replace("\\", "/")
        picture = _find(path.parent, folder_and_name) or _find(path.parent, Path(folder_and_name).name)
        return read_image(picture or path.with_name(Path(folder_and_name).name or "texture")), True
    for suffix in _TEXTURE_SUFFIXES:
        picture = path.with_suffix(suffix)
        if picture.is_file():
            return read_image(picture), False
    return None, False


def _find(folder: Path, name: str) -> Path | None:
    """The file of a name, perhaps with folders, in or below a folder; letters of another case will do.

    None if there is no such file, or the name leads out of the folder.
    """
    parts = name.replace("\\", "/").split("/")
    parts = [part for part in parts if part not in ("", ".")]
    if not parts or ".." in parts or len(parts) > _MAX_FOLDERS or name.startswith("/") or "\0" in name:
        return None
    place = folder
    for part in parts:
        exact = place / part
        if not _exists(exact):
            same = [each for each in _children(place) if each.name.casefold() == part.casefold()]
            if not same:
                return None
            exact = min(same)
        place = exact
    return place if place.is_file() and resolved(place).is_relative_to(resolved(folder)) else None


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # e.g. a name that is too long
        return False


def _children(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def _fit(points: Floats, goals: Floats) -> Floats:
    """The points scaled and moved, not rotated, to be as close to ``goals`` (n, 2), pixels, as possible."""
    centered, centered_goals = points - points.mean(axis=0), goals - goals.mean(axis=0)
    scale = float((centered * centered_goals).sum() / (centered**2).sum()) if centered.any() else 0.0
    if scale <= 0:
        raise InputError(tr("expected a texture that is the right way round, got a mirrored or rotated one"))
    return goals.mean(axis=0) + scale * centered


def _to_pixels(points: Floats) -> Floats:
    """The points moved to a margin from the origin, and scaled to a size that fits a screen."""
    low, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    scale = 1.0 if _SMALLEST_SIZE <= size <= _LARGEST_SIZE else _USUAL_SIZE / size if size > 0 else 1.0
    return (points - low) * scale + _MARGIN


def _grid_picture(size: Floats) -> NDArray[np.uint8]:
    """A picture of at least this size with a grid, which shows how a mesh deforms."""
    width, height = np.ceil(size).astype(int).tolist()
    image = np.empty((height, width, 4), dtype=np.uint8)
    image[:] = _PAPER
    step = max(max(width, height) // _GRID_LINES, 4)
    image[step // 2 :: step], image[:, step // 2 :: step] = _INK, _INK
    return image


def _float32(values: Floats) -> NDArray[np.float32]:
    return values.astype(np.float32)
