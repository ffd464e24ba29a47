"""Exports SVG pictures: the outline of a pose as paths, or its parts with their texture."""

import base64
from collections.abc import Iterator
from html import escape

import numpy as np
import shapely

from ...editor.document.drawing import Drawing
from ...editor.framing import Box, Color, output_size
from ...geometry.mesh import signed_areas
from ...geometry.validation import Floats, Ints
from ...layers.drawing_layer import shown_layers
from ...overlap.seams import CutMesh
from ..images import encode_png
from ..painter import Painter
from .component_runs import component_runs
from .drawn_faces import drawn_faces

GRID_SIZE = 0.001  # pixels


def silhouette(drawing: Drawing, positions: Floats) -> list[shapely.Polygon]:
    """The area that the mesh covers in the pose ``positions`` (n, 2), as polygons, the largest first.

    Hidden layers do not count. Points are snapped to a grid of `GRID_SIZE` pixels, which removes the slivers
    that rounding leaves at overlaps.
    """
    faces = drawing.mesh.faces
    is_drawn = signed_areas(positions, faces) != 0
    if drawing.layers:
        is_drawn &= shown_layers(drawing.layers)[drawing.face_layers]
    faces = faces[is_drawn]
    covered = shapely.set_precision(shapely.union_all(shapely.polygons(positions[faces])), GRID_SIZE)
    parts = [part for part in shapely.get_parts(covered) if part.geom_type == "Polygon"]
    return sorted(parts, key=lambda part: -part.area)


def encode_svg(
    drawing: Drawing,
    positions: Floats,
    box: Box,
    scale: float,
    background: Color | None,
) -> str:
    """The text of an SVG picture of ``box``: one path per polygon, its holes by the even-odd rule.

    Paths are in drawing units with three decimals. Raises InputError as `output_size` does.
    """
    return _document(drawing, box, scale, background, _outline_elements(drawing, positions))


def encode_textured_svg(
    drawing: Drawing,
    positions: Floats,
    box: Box,
    scale: float,
    background: Color | None,
    painter: Painter,
    order: Ints | CutMesh | None = None,
) -> str:
    """The text of an SVG picture of ``box``: one embedded picture per part, from back to front.

    A part is a layer, or without layers a component of the mesh; one that passes both behind and in front of
    another has several pictures. order: see `Document.draw_order`. Raises InputError as `output_size` does.
    """
    elements = _picture_elements(drawing, positions, box, scale, painter, order)
    return _document(drawing, box, scale, background, elements)


def _document(
    drawing: Drawing, box: Box, scale: float, background: Color | None, elements: Iterator[str]
) -> str:
    output_size(box, scale)
    x0, y0, x1, y1 = box
    width, height = x1 - x0, y1 - y0
    size = f'width="{width * scale:.10g}" height="{height * scale:.10g}"'
    spaces = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
    lines = [
        f'<svg {spaces} {size} viewBox="{x0} {y0} {width} {height}">',
        f"  <title>{escape(drawing.name)}</title>",
    ]
    if background is not None:
        red, green, blue = (round(255 * value) for value in background)
        fill = f"#{red:02x}{green:02x}{blue:02x}"
        lines.append(f'  <rect x="{x0}" y="{y0}" width="{width}" height="{height}" fill="{fill}"/>')
    return "\n".join([*lines, *elements, "</svg>", ""])


def _outline_elements(drawing: Drawing, positions: Floats) -> Iterator[str]:
    for part in silhouette(drawing, positions):
        data = " ".join(_ring(ring) for ring in (part.exterior, *part.interiors))
        yield f'  <path fill="#000" fill-rule="evenodd" d="{data}"/>'


def _picture_elements(
    drawing: Drawing,
    positions: Floats,
    box: Box,
    scale: float,
    painter: Painter,
    order: Ints | CutMesh | None,
) -> Iterator[str]:
    drawn = drawn_faces(drawing, positions, order)
    count = len(drawn.faces)
    cut = order if isinstance(order, CutMesh) else None
    edges = np.zeros((0, 2), dtype=np.int32) if cut is None else cut.edges
    shares = np.zeros(0) if cut is None else cut.shares
    whole_order = np.arange(len(drawing.mesh.faces))
    sources = cut.sources if cut is not None else order if isinstance(order, np.ndarray) else whole_order
    later = np.ones(count, dtype=bool)  # faces of parts that are in front
    components = drawn.components
    if drawing.layers:  # which do not pass through one another
        runs = [(int(drawn.layers[run[0]]), run) for _, run in drawn.layer_runs(drawing) if len(run)]
        components = drawn.layers
    else:
        runs = component_runs(components, np.arange(count), *drawn.low_and_high)
    for number, (component, run) in enumerate(runs, start=1):
        later[run] = False
        shown = np.zeros(count, dtype=bool)
        shown[run] = True
        # One more row of faces where the part goes on in front of another one, or the joint would show.
        corners = np.zeros(len(drawn.pose), dtype=bool)
        corners[drawn.faces[run]] = True
        shown |= later & (components == component) & corners[drawn.faces].any(axis=1)
        faces = drawn.faces[shown]
        part_box = _common_box(box, drawn.pose[faces.ravel()])
        if part_box is None:
            continue
        part = CutMesh(whole_order, faces.astype(np.int32), sources[shown], edges, shares)
        picture = painter.render(drawing, positions, part_box, scale, None, part)
        height, width = picture.shape[:2]
        place = f'x="{part_box[0]}" y="{part_box[1]}" width="{width / scale:.10g}" '
        place += f'height="{height / scale:.10g}"'
        data = base64.b64encode(encode_png(picture)).decode()
        yield f'  <image id="part-{number}" {place} xlink:href="data:image/png;base64,{data}"/>'


def _common_box(box: Box, points: Floats) -> Box | None:
    """The part of a box that contains points (k, 2); None if it is empty."""
    low, high = np.floor(points.min(axis=0)), np.ceil(points.max(axis=0))
    x0, y0 = max(box[0], int(low[0])), max(box[1], int(low[1]))
    x1, y1 = min(box[2], int(high[0])), min(box[3], int(high[1]))
    return (x0, y0, x1, y1) if x0 < x1 and y0 < y1 else None


def _ring(ring: shapely.LinearRing) -> str:
    """A closed subpath."""
    points = np.round(shapely.get_coordinates(ring)[:-1], 3) + 0.0  # + 0.0 removes "-0"
    return "M" + "L".join(f"{x:.10g} {y:.10g}" for x, y in points.tolist()) + "Z"
