"""Exports the outline of a pose as paths of an SVG picture."""

from xml.sax.saxutils import escape

import numpy as np
import shapely

from ...editor.document.drawing import Drawing
from ...editor.framing import Box, Color, output_size
from ...geometry.mesh import signed_areas
from ...geometry.validation import Floats

GRID_SIZE = 0.001  # pixels


def silhouette(drawing: Drawing, positions: Floats) -> list[shapely.Polygon]:
    """The area that the mesh covers in the pose ``positions`` (n, 2), as polygons, the largest first.

    Points are snapped to a grid of `GRID_SIZE` pixels, which removes the slivers that rounding leaves at
    overlaps.
    """
    faces = drawing.mesh.faces[signed_areas(positions, drawing.mesh.faces) != 0]
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
    output_size(box, scale)
    x0, y0, x1, y1 = box
    width, height = x1 - x0, y1 - y0
    size = f'width="{width * scale:.10g}" height="{height * scale:.10g}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="{x0} {y0} {width} {height}">',
        f"  <title>{escape(drawing.name)}</title>",
    ]
    if background is not None:
        red, green, blue = (round(255 * value) for value in background)
        fill = f"#{red:02x}{green:02x}{blue:02x}"
        lines.append(f'  <rect x="{x0}" y="{y0}" width="{width}" height="{height}" fill="{fill}"/>')
    for part in silhouette(drawing, positions):
        data = " ".join(_ring(ring) for ring in (part.exterior, *part.interiors))
        lines.append(f'  <path fill="#000" fill-rule="evenodd" d="{data}"/>')
    return "\n".join([*lines, "</svg>", ""])


def _ring(ring: shapely.LinearRing) -> str:
    """A closed subpath."""
    points = np.round(shapely.get_coordinates(ring)[:-1], 3) + 0.0  # + 0.0 removes "-0"
    return "M" + "L".join(f"{x:.10g} {y:.10g}" for x, y in points.tolist()) + "Z"
