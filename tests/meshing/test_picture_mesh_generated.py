"""Laws of the mesh of any picture, on hundreds of generated ones."""

import numpy as np
import pytest
import shapely
from scipy.ndimage import label

from akap_editor.meshing.meshers import PYTHONCDT
from akap_editor.meshing.outline import MIN_HOLE_AREA, MIN_STROKE_WIDTH, Outline, cut_out, visible_polygons
from akap_editor.meshing.picture_mesh import mesh_picture
from akap_editor.meshing.quality import mesh_polygons, mesh_quality, smallest_angles
from akap_editor.meshing.triangulate import MIN_ANGLE, triangulate
from tests.support.generated_cartoons import FAMILIES

pytestmark = pytest.mark.usefixtures("mesher")

CLEAN = ("stars", "rings", "polygons", "blobs")  # everything is wider than a pixel


@pytest.fixture(scope="module", params=FAMILIES)
def family(request):
    """Each family of generated cartoons in turn: its name and pictures."""
    return request.param, list(FAMILIES[request.param]())


def forced(parts: tuple[Outline, ...]) -> shapely.Geometry:
    """The sides of the outlines at corners of less than 60°, near which no mesh has good angles."""
    sides = []
    for part in parts:
        for rim, inside in ((part.outer, 1), *((hole, -1) for hole in part.holes)):
            turning = 1 if shapely.is_ccw(shapely.LinearRing(rim)) else -1
            u, v = np.roll(rim, 1, axis=0) - rim, np.roll(rim, -1, axis=0) - rim
            cross = (v[:, 0] * u[:, 1] - v[:, 1] * u[:, 0]) * turning * inside
            angles = np.arctan2(cross, (u * v).sum(axis=1)) % (2 * np.pi)
            sides += [
                shapely.LineString([rim[i - 1], rim[i], rim[(i + 1) % len(rim)]])
                for i in np.flatnonzero(angles < np.radians(60))
            ]
    return shapely.union_all(sides)


@pytest.mark.parametrize("expand", [0.0, 2.0])
def test_every_outline_becomes_a_sound_mesh(family, mesher, expand):
    """Whole, apart, of good angles; that faces are neither flipped nor empty is what `TriMesh` refuses.

    PythonCDT, which takes ten times as long, gets each picture with one expansion.
    """
    _, pictures = family
    first, every = (int(expand > 0), 2) if mesher == PYTHONCDT else (0, 1)
    for number, alpha in list(enumerate(pictures))[first::every]:
        cut = cut_out(alpha, expand=expand)
        mesh = triangulate(cut.parts, 300)
        quality = mesh_quality(mesh, alpha)
        assert (quality.parts, quality.holes) == (len(cut.parts), cut.holes), number
        assert mesh.vertices.min() >= 0, number
        assert (mesh.vertices <= alpha.shape[::-1]).all(), number

        visible = shapely.union_all(visible_polygons(alpha, 0.5))
        body = shapely.union_all(mesh_polygons(mesh))
        # Where nothing is added at the rim, half a pixel may be missing.
        missing = visible.difference(body.buffer(0.8 if expand == 0 else 0)).area
        assert missing <= 0.001 * visible.area + cut.speck_area, number
        beyond = body.difference(visible.buffer(expand + MIN_STROKE_WIDTH))
        assert all(gap.area < MIN_HOLE_AREA for gap in shapely.get_parts(beyond)), number

        bad = mesh.vertices[mesh.faces[smallest_angles(mesh) < MIN_ANGLE - 3]]
        near = forced(cut.parts).buffer(1e-6)
        assert all(shapely.intersects_xy(near, *face.T).any() for face in bad), number


def test_parts_and_holes_are_those_of_the_pixels():
    for name in CLEAN:
        for number, alpha in enumerate(FAMILIES[name]()):
            cut = cut_out(alpha, expand=0, tolerance=0.2)
            pixels = np.pad(alpha > 127, 1)
            parts, _ = label(pixels, np.ones((3, 3)))
            gaps, _ = label(~pixels)
            sizes, empty = np.bincount(parts.flat)[1:], np.bincount(gaps.flat)[1:]
            # Near the area limit, the exact contour decides whether a part stays.
            assert (sizes > 16).sum() <= len(cut.parts) <= (sizes > 6).sum(), (name, number)
            assert (empty > 20).sum() - 1 <= cut.holes <= (empty > 6).sum() - 1, (name, number)


def test_the_same_picture_gives_the_same_mesh(family):
    _, pictures = family
    first, second = (mesh_picture(pictures[0], 300).mesh for _ in range(2))
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()


@pytest.mark.parametrize(("wanted", "every"), [(200, 2), (1000, 4), (5000, 12)])
def test_number_of_vertices_is_reached(wanted, every):
    """Of those that so few vertices can show; stars of 20 points come last and cannot."""
    pictures = [*list(FAMILIES["stars"]())[:-6], *FAMILIES["combs"](), *FAMILIES["polygons"]()]
    for number, alpha in enumerate(pictures[::every]):
        made = mesh_picture(alpha, wanted)
        assert len(made.mesh.vertices) == pytest.approx(wanted, rel=0.1), number
        assert mesh_quality(made.mesh, alpha).covered >= 0.999, number
