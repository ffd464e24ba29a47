"""Every region keeps its sign on another mesh of the drawing, whichever limbs are in front."""

from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest
import shapely

from akap_editor.editor.document.crossings import crossings_with_limb, overlaps_of
from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.remesh import remesh_drawing, transfer_state
from akap_editor.editor.session.session import Session
from akap_editor.geometry.mesh import TriMesh
from akap_editor.io.images import read_image
from akap_editor.overlap.overlaps import Overlaps
from akap_editor.resources import bundled_drawings
from tests.overlap.test_rules import SCENES, played

SEAM_SHIFT = 0.08  # share of a region with a seam: on a coarse mesh a seam is within the same triangles only


@pytest.fixture(scope="module", params=[name for name in SCENES if name != "gingerbread"])
def session(request: pytest.FixtureRequest) -> Session:
    path = next(path for path in bundled_drawings() if path.stem == request.param.split(",")[0])
    return played(SCENES[request.param], Session(new_document(make_drawing(read_image(path), vertices=400))))


def overlaps(mesh: TriMesh, state: EditState) -> Overlaps:
    return overlaps_of(mesh, state.pins, state.positions, state.crossings)


def states(session: Session) -> list[EditState]:
    """The state, and with the limb of each pin in front of, and behind, all that it overlaps."""
    state, mesh = session.state, session.drawing.mesh
    result = [state]
    for pin in state.pins:
        for to_front in (True, False):
            arguments = mesh, state.pins, state.positions, state.crossings, [pin.id], to_front
            result.append(replace(state, crossings=crossings_with_limb(*arguments)))
    return result


def common_places(mesh: TriMesh, pose: np.ndarray, found: Overlaps) -> tuple[np.ndarray, np.ndarray]:
    """A point of what each pair has in common, at rest on both sheets (p, 2, 2), and the area (p,)."""
    sheets = mesh.faces[np.stack([found.pairs.first, found.pairs.second], axis=1)]
    first, second = (shapely.polygons(pose[sheets[:, k]]) for k in (0, 1))
    shared = shapely.intersection(first, second)
    middles = shapely.get_coordinates(shapely.point_on_surface(shared))
    corners, rest = pose[sheets], mesh.vertices[sheets]
    sides = np.stack([corners[:, :, k] - corners[:, :, 0] for k in (1, 2)], axis=-1)
    weights = np.linalg.solve(sides, (middles[:, None] - corners[:, :, 0])[..., None])
    places = rest[:, :, 0] + (
        np.stack([rest[:, :, k] - rest[:, :, 0] for k in (1, 2)], axis=-1) @ weights
    ).squeeze(-1)
    return places, shapely.area(shared)


@pytest.mark.parametrize("vertices", [150, 600])
def test_every_sign_of_every_region_is_kept(session: Session, vertices: int) -> None:
    mesh = session.drawing.mesh
    meshing = session.drawing.meshing
    assert meshing is not None
    drawing = remesh_drawing(session.drawing, replace(meshing, vertices=vertices))
    new_pose = transfer_state(session.state, mesh, drawing).positions
    triangles = shapely.STRtree(shapely.polygons(mesh.vertices[mesh.faces]))
    for state in states(session):
        old, new_state = overlaps(mesh, state), transfer_state(state, mesh, drawing)
        assert np.array_equal(new_state.positions, new_pose)
        new = overlaps(drawing.mesh, new_state)
        places, areas = common_places(drawing.mesh, new_pose, new)
        signs = {}
        for first, second, sign, region in zip(
            old.pairs.first, old.pairs.second, old.signs, old.pairs.regions, strict=True
        ):
            signs[first, second], signs[second, first] = (sign, region), (-sign, region)
        wrong, compared = defaultdict(float), defaultdict(float)
        located = triangles.nearest(shapely.points(places.reshape(-1, 2))).reshape(-1, 2).tolist()
        for faces, sign, area in zip(located, new.signs, areas, strict=True):
            if tuple(faces) in signs:
                expected, region = signs[tuple(faces)]
                compared[region] += area
                wrong[region] += area * (sign != expected)
        assert set(compared) == set(old.pairs.regions.tolist())
        for region, area in compared.items():
            own = old.signs[old.pairs.regions == region]
            allowed = SEAM_SHIFT if own.min() != own.max() else 0.0
            assert wrong[region] <= allowed * area
