"""SVG: parsed as XML and as polygons, and drawn by resvg."""

import re
from dataclasses import replace
from io import BytesIO
from xml.etree import ElementTree

import numpy as np
import pytest
import resvg_py
import shapely
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.geometry.mesh import signed_areas
from akap_editor.io.export import ExportOptions, export
from akap_editor.render.offscreen import OffscreenRenderer
from tests.io.export.test_drawn_faces import woven
from tests.support.similarity import structural_similarity

NAMESPACE = "{http://www.w3.org/2000/svg}"


def paths_of(path):
    """Each path as a list of rings (q, 2); nothing but M, L and Z is in it."""
    found = []
    for element in ElementTree.parse(path).getroot().iter(f"{NAMESPACE}path"):
        assert element.get("fill-rule") == "evenodd"
        data = element.get("d")
        assert re.fullmatch(r"[MLZ0-9eE. +-]*", data)
        rings = [ring.removesuffix("Z").split("L") for ring in data.replace(" M", "M").split("M")[1:]]
        found.append([np.array([point.split() for point in ring], dtype=float) for ring in rings])
    return found


def polygon_of(rings):
    """Even-odd, by symmetric differences."""
    shape = shapely.Polygon()
    for ring in rings:
        polygon = shapely.Polygon(ring)
        assert polygon.is_valid
        shape = shape.symmetric_difference(polygon)
    return shape


def drawn_by_resvg(path):
    return np.asarray(Image.open(BytesIO(bytes(resvg_py.svg_to_bytes(svg_path=str(path))))).convert("RGBA"))


def test_outline_of_a_pose_without_overlaps(exported, bent):
    """Its rings are the mesh's boundary loops, its area that of all faces."""
    mesh, pose = bent.drawing.mesh, bent.state.positions
    paths = paths_of(exported(bent, "a.svg"))
    assert [len(rings) for rings in paths] == [2, 1]
    area = sum(polygon_of(rings).area for rings in paths)
    assert area == pytest.approx(np.abs(signed_areas(pose, mesh.faces)).sum(), rel=1e-4)
    loops = [pose[loop] for loop in mesh.boundary_loops]
    written = [ring for rings in paths for ring in rings]
    assert sorted(map(len, written)) == sorted(map(len, loops))
    for ring in written:
        apart = [np.abs(ring[:, None] - loop[None]).max(axis=2).min(axis=1).max() for loop in loops]
        assert min(apart) < 0.001


def test_where_a_pose_overlaps_there_is_no_hole(exported, bent):
    """The disc is moved over the ring's band: one part, and only the ring's own hole."""
    mesh = bent.drawing.mesh
    apart = mesh.component == mesh.component[np.argmax(mesh.vertices[:, 0])]
    pose = mesh.vertices - np.where(apart[:, None], [45.0, 5.0], [0.0, 0.0])
    document = bent.with_state(replace(bent.state, positions=pose))
    (rings,) = paths_of(exported(document, "a.svg"))
    covered = shapely.union_all(shapely.polygons(pose[mesh.faces]))
    assert covered.area < mesh.rest_areas.sum() - 100
    assert polygon_of(rings).symmetric_difference(covered).area < 0.1


@pytest.mark.parametrize("crop", ["none", "frame", "pose"])
@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_size_and_place(exported, bent, crop, scale):
    root = ElementTree.parse(exported(bent, "a.svg", crop=crop, scale=scale)).getroot()
    low, high = np.floor(bent.state.positions.min(axis=0)), np.ceil(bent.state.positions.max(axis=0))
    frame = np.array([0, 0]), np.array([140, 90])
    low, high = {
        "none": (np.minimum(low, 0), np.maximum(high, frame[1])),
        "frame": frame,
        "pose": (low, high),
    }[crop]
    assert [float(value) for value in root.get("viewBox").split()] == [*low, *(high - low)]
    assert [float(root.get("width")), float(root.get("height"))] == (scale * (high - low)).tolist()


def test_resvg_draws_what_the_mesh_covers(exported, bent):
    """Each pixel's alpha is the covered share of its area, as far as resvg's few samples can tell."""
    path = exported(bent, "a.svg", crop="pose")
    alpha = drawn_by_resvg(path)[..., 3] / 255
    covered = shapely.union_all(shapely.polygons(bent.state.positions[bent.drawing.mesh.faces]))
    x0, y0 = np.floor(bent.state.positions.min(axis=0))
    y, x = np.mgrid[: alpha.shape[0], : alpha.shape[1]]
    cells = shapely.box(x + x0, y + y0, x + x0 + 1, y + y0 + 1)
    expected = shapely.area(shapely.intersection(cells, covered))
    assert np.abs(alpha - expected).max() < 0.15
    assert alpha.sum() == pytest.approx(expected.sum(), rel=0.002)


def test_background_and_name(exported, bent):
    path = exported(bent, "a.svg", background=(1.0, 0.5, 0.0))
    assert drawn_by_resvg(path)[0, 0].tolist() == [255, 128, 0, 255]
    assert ElementTree.parse(path).getroot().find(f"{NAMESPACE}title").text == "ring & disc"
    assert drawn_by_resvg(exported(bent, "b.svg"))[0, 0, 3] == 0


# -- with its texture ----------------------------------------------------------------------------------------


@pytest.fixture
def textured(tmp_path):
    """Exports a document as an SVG with its texture: the file, and the picture that it should look like."""

    def write(document, **options):
        with OffscreenRenderer() as renderer:
            choices = ExportOptions(textured=True, **options)
            (path,) = export(document, tmp_path / "textured.svg", choices, renderer)
            (png,) = export(document, tmp_path / "textured.png", ExportOptions(**options), renderer)
        return path, np.asarray(Image.open(png).convert("RGBA"))

    return write


@pytest.mark.parametrize("pose", ["rest", "bent", "woven"])
@pytest.mark.parametrize("options", [{}, {"scale": 2.0, "crop": "pose", "background": (1.0, 0.5, 0.0)}])
def test_it_looks_like_the_picture(textured, drawn, bent, pose, options):
    document = {"rest": drawn, "bent": bent, "woven": woven(drawn)}[pose]
    path, expected = textured(document, **options)
    picture = drawn_by_resvg(path)
    assert picture.shape == expected.shape
    assert structural_similarity(picture, expected) >= 0.995
    assert np.abs(picture[..., 3].astype(int) - expected[..., 3]).mean() < 0.2


def test_each_part_is_a_picture_from_back_to_front(textured, drawn, bent):
    for document, count in ((bent, 2), (woven(drawn), 3)):
        root = ElementTree.parse(textured(document)[0]).getroot()
        images = list(root.iter(f"{NAMESPACE}image"))
        assert [image.get("id") for image in images] == [f"part-{k + 1}" for k in range(count)]
        assert not list(root.iter(f"{NAMESPACE}path"))


def test_parts_outside_the_frame_are_left_out(textured, drawn):
    mesh = drawn.drawing.mesh
    apart = mesh.component == mesh.component[np.argmax(mesh.vertices[:, 0])]
    pose = mesh.vertices + np.where(apart[:, None], [400.0, 0.0], [0.0, 0.0])
    path, _ = textured(drawn.with_state(replace(drawn.state, positions=pose)), crop="frame")
    assert len(list(ElementTree.parse(path).getroot().iter(f"{NAMESPACE}image"))) == 1


def test_a_texture_needs_a_painter(drawn, tmp_path):
    with pytest.raises(InputError, match="Expected a painter"):
        export(drawn, tmp_path / "a.svg", ExportOptions(textured=True))
    assert list(tmp_path.iterdir()) == []
