"""Mesh files show at each place of an overlapping pose what the window shows there."""

import json
import struct
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import trimesh

from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.document import Document
from akap_editor.io.export.component_runs import component_runs
from akap_editor.io.export.drawn_faces import DrawnFaces, drawn_faces, stacked
from akap_editor.io.export.texture import y_up
from akap_editor.overlap.seams import CutMesh
from tests.support.bends import rope_with_seam

Triangles = tuple[np.ndarray, np.ndarray]  # corners (q, 3, 2) from back to front, and their uv (q, 3, 2)


def visible_uv(triangles: Triangles, points: np.ndarray) -> np.ndarray:
    """The texture coordinates of the last triangle at each point, (k, 2); NaN where there is none."""
    corners, uv = triangles
    result = np.full((len(points), 2), np.nan)
    for (a, b, c), texture in zip(corners, uv, strict=True):
        weights = np.linalg.solve(np.stack([b - a, c - a], axis=1), (points - a).T)
        inside = (weights.min(axis=0) >= 0) & (weights.sum(axis=0) <= 1)
        u, v = weights[:, inside]
        result[inside] = (1 - u - v)[:, None] * texture[0] + u[:, None] * texture[1] + v[:, None] * texture[2]
    return result


def read_obj(path: Path) -> Triangles:
    rows = [line.split() for line in path.read_text().splitlines()]
    points, uv = (np.array([row[1:3] for row in rows if row[0] == kind], dtype=float) for kind in ("v", "vt"))
    faces = np.array([[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[0] == "f"])
    return points[faces], (uv * [1, -1] + [0, 1])[faces]


def read_glb(path: Path) -> Triangles:
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    scene, binary = json.loads(data[20 : 20 + size]), data[28 + size :]

    def array(number: int, dtype: str, columns: int) -> np.ndarray:
        accessor = scene["accessors"][number]
        begin = scene["bufferViews"][accessor["bufferView"]]["byteOffset"]
        return np.frombuffer(binary, dtype, accessor["count"] * columns, begin).reshape(-1, columns)

    (primitive,) = scene["meshes"][0]["primitives"]
    attributes = primitive["attributes"]
    pose = array(attributes["POSITION"], "<f4", 3) + array(primitive["targets"][0]["POSITION"], "<f4", 3)
    faces = array(primitive["indices"], "<u4", 1).reshape(-1, 3)
    return pose[faces, :2], array(attributes["TEXCOORD_0"], "<f4", 2)[faces]


def read_spine(path: Path) -> Triangles:
    record = json.loads(path.read_text())
    skin, deform = record["skins"][0]["attachments"], record["animations"]["pose"]["attachments"]["default"]
    corners, uv = [], []
    for slot in record["slots"]:
        mesh = skin[slot["name"]][slot["attachment"]]
        offsets = deform[slot["name"]][slot["attachment"]]["deform"][0]["vertices"]
        faces = np.array(mesh["triangles"]).reshape(-1, 3)
        corners.append((np.array(mesh["vertices"]) + offsets).reshape(-1, 2)[faces])
        uv.append(np.array(mesh["uvs"]).reshape(-1, 2)[faces])
    return np.concatenate(corners), np.concatenate(uv)


def read_json(path: Path) -> Triangles:
    record = json.loads(path.read_text())
    points, uv = np.array(record["positions"]), np.array(record["uv"])
    faces, seams = np.array(record["faces"]), record["seams"]
    if seams is not None:
        ends, shares = np.array(seams["edges"]), np.array(seams["shares"])[:, None]
        points, uv = (
            np.concatenate([values, (1 - shares) * values[ends[:, 0]] + shares * values[ends[:, 1]]])
            for values in (points, uv)
        )
        faces = np.array(seams["faces"])
    elif record["order"] is not None:
        faces = faces[record["order"]]
    return points[faces], uv[faces]


READERS = {".obj": read_obj, ".glb": read_glb, ".spine.json": read_spine, ".json": read_json}


def woven(drawn: Document) -> Document:
    """The disc, drawn out to a band, behind the ring on one side and in front of it on the other."""
    mesh = drawn.drawing.mesh
    is_disc = mesh.component == mesh.component[np.argmax(mesh.vertices[:, 0])]
    pose = mesh.vertices.copy()
    pose[is_disc] = (pose[is_disc] - [112, 50]) * [3.2, 0.4] + [45, 45]
    state = replace(drawn.state, positions=pose)
    overlaps = overlaps_of(mesh, (), pose, state.crossings)
    assert overlaps.pairs.region_count == 2
    low, high = overlaps.low_and_high
    left, right = (int(np.flatnonzero(overlaps.pairs.regions == region)[0]) for region in (0, 1))
    over, under = (high, low) if is_disc[mesh.faces[high[left], 0]] else (low, high)
    behind, front = (high, low) if is_disc[mesh.faces[low[right], 0]] else (low, high)
    crossings = np.array([[over[left], under[left]], [behind[right], front[right]]], dtype=np.int32)
    return drawn.with_state(replace(state, crossings=crossings))


def probes(document: Document) -> np.ndarray:
    pose = document.state.positions
    return np.random.default_rng(1).uniform(pose.min(axis=0), pose.max(axis=0), (1500, 2))


@pytest.mark.parametrize("suffix", READERS)
@pytest.mark.parametrize("has_seam", [False, True])
def test_files_show_what_the_window_shows(
    has_seam: bool, suffix: str, drawn: Document, exported: Callable[..., Path]
) -> None:
    document = rope_with_seam() if has_seam else woven(drawn)
    assert isinstance(document.draw_order, CutMesh) == has_seam
    drawing, pose, points = document.drawing, document.state.positions, probes(document)
    shown = drawn_faces(drawing, pose, document.draw_order)
    expected = visible_uv((shown.pose[shown.faces], shown.uv[shown.faces]), points)
    plain = visible_uv((pose[drawing.mesh.faces], drawing.uv[drawing.mesh.faces]), points)
    differs = np.nan_to_num(np.abs(plain - expected)).max(axis=1) > 0.01
    assert differs.mean() > 0.02, "the order of the mesh is another one"
    found = READERS[suffix](exported(document, f"woven{suffix}"))
    seen = visible_uv(found, points if suffix == ".json" else y_up(drawing, points))
    wrong = np.abs(np.nan_to_num(seen, nan=-1) - np.nan_to_num(expected, nan=-1)).max(axis=1) > 0.005
    assert wrong.mean() < 0.002, "but for points on edges"


def test_a_component_has_several_slots_only_where_it_passes_over_and_under(
    drawn: Document, exported: Callable[..., Path]
) -> None:
    def slots(document: Document) -> int:
        path = exported(document, "slots.spine.json")
        return len(json.loads(path.read_text())["slots"])

    assert slots(drawn) == 2
    assert slots(woven(drawn)) == 3


def test_runs_of_components_hold_all_pairs_and_each_face_once() -> None:
    rng = np.random.default_rng(2)
    for _ in range(50):
        components, order = rng.integers(0, 3, 30), rng.permutation(30)
        components[:3] = 0, 1, 2
        rank = np.argsort(rng.permutation(30))
        pairs = rng.integers(0, 30, (40, 2))
        pairs = pairs[rank[pairs[:, 0]] < rank[pairs[:, 1]]]
        runs = component_runs(components, order, pairs[:, 0], pairs[:, 1])
        drawn_order = np.concatenate([faces for _, faces in runs])
        assert sorted(drawn_order.tolist()) == list(range(30))
        place = np.argsort(drawn_order)
        assert (place[pairs[:, 0]] < place[pairs[:, 1]]).all()
        assert all((components[faces] == component).all() for component, faces in runs)
        assert all(a[0] != b[0] for a, b in pairwise(runs))


def test_the_new_vertices_of_a_seam_follow_those_of_the_mesh(drawn: Document) -> None:
    drawing, pose = drawn.drawing, drawn.state.positions
    mesh = drawing.mesh
    edge, share = mesh.faces[:1, :2].astype(np.int32), np.array([0.25])
    order = np.arange(len(mesh.faces))
    cut = CutMesh(order, mesh.faces, order.astype(np.int32), edge, share)
    result = drawn_faces(drawing, pose, cut)
    assert isinstance(result, DrawnFaces)
    np.testing.assert_array_equal(result.pose[: len(pose)], pose)
    np.testing.assert_allclose(
        result.rest[-1], 0.75 * mesh.vertices[edge[0, 0]] + 0.25 * mesh.vertices[edge[0, 1]]
    )
    assert len(result.uv) == len(result.rest) == len(pose) + 1


# -- z by the order of drawing -------------------------------------------------------------------------------


def nearest_uv(corners: np.ndarray, uv: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The texture coordinates of the triangle of the highest z at each point, (k, 2); NaN without one.

    corners: (q, 3, 3), in any order.
    """
    result, height = np.full((len(points), 2), np.nan), np.full(len(points), -np.inf)
    for (a, b, c), texture in zip(corners, uv, strict=True):
        weights = np.linalg.solve(np.stack([b - a, c - a], axis=1)[:2], (points - a[:2]).T)
        weights = np.concatenate([1 - weights.sum(axis=0, keepdims=True), weights])
        z = np.array([a[2], b[2], c[2]]) @ weights
        is_nearest = (weights.min(axis=0) >= 0) & (z > height)
        height[is_nearest] = z[is_nearest]
        result[is_nearest] = (texture.T @ weights).T[is_nearest]
    return result


def assert_depth_tested(document: Document, corners: np.ndarray, uv: np.ndarray) -> None:
    drawing, points = document.drawing, probes(document)
    shown = drawn_faces(drawing, document.state.positions, document.draw_order)
    expected = visible_uv((shown.pose[shown.faces], shown.uv[shown.faces]), points)
    seen = nearest_uv(corners[::-1], uv[::-1], y_up(drawing, points))
    wrong = np.abs(np.nan_to_num(seen, nan=-1) - np.nan_to_num(expected, nan=-1)).max(axis=1) > 0.005
    assert wrong.mean() < 0.002, "but for points on edges"


def test_an_obj_is_right_in_depth_tested_viewers(drawn: Document, exported: Callable[..., Path]) -> None:
    document = woven(drawn)
    rows = [line.split() for line in exported(document, "a.obj").read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[0] == "v"], dtype=float)
    uv = np.array([row[1:3] for row in rows if row[0] == "vt"], dtype=float) * [1, -1] + [0, 1]
    faces = np.array([[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[0] == "f"])
    assert_depth_tested(document, points[faces], uv[faces])
    flat = exported(document, "a.obj", z_order=False).read_text()
    assert {line.split()[3] for line in flat.splitlines() if line.startswith("v ")} == {"0"}


def test_gltf_has_the_same_depth_on_demand(drawn: Document, exported: Callable[..., Path]) -> None:
    document = woven(drawn)
    mesh = trimesh.load(exported(document, "a.glb", z_order=True), process=False, force="mesh")
    faces, uv = mesh.faces, np.array(mesh.visual.uv) * [1, -1] + [0, 1]
    pose = drawn_faces(document.drawing, document.state.positions, document.draw_order).pose
    points = np.column_stack([y_up(document.drawing, pose), 100 * mesh.vertices[:, 2]])
    assert_depth_tested(document, points[faces], uv[faces])
    flat = trimesh.load(exported(document, "a.glb"), process=False, force="mesh")
    assert np.abs(flat.vertices[:, 2]).max() == 0


def test_the_surface_is_torn_only_where_levels_go_around_in_a_circle(drawn: Document) -> None:
    drawing = drawn.drawing
    plain = drawn_faces(drawing, drawn.state.positions, None)
    ring, disc = (np.flatnonzero(plain.components == component) for component in (0, 1))

    def neighbors(faces: np.ndarray) -> np.ndarray:
        """Two faces with a common edge."""
        shared = (plain.faces[faces[1:]][:, :, None] == plain.faces[faces[0]]).any(axis=2).sum(axis=1) == 2
        return faces[[0, 1 + int(np.argmax(shared))]]

    (f, g), (p, q) = neighbors(ring), neighbors(disc)
    for low, high, is_torn in (([f, g], [p, q], False), ([f, q], [p, g], True)):
        result = stacked(plain, np.array(low), np.array(high))
        assert (len(result.rest) > len(plain.rest)) == is_torn
        np.testing.assert_array_equal(result.rest[: len(plain.rest)], plain.rest)
        np.testing.assert_array_equal(result.rest[result.faces], plain.rest[plain.faces])
        np.testing.assert_array_equal(result.uv, plain.uv[result.sources])
        below, above = result.z[result.faces[low]], result.z[result.faces[high]]
        assert (below.max(axis=1) < above.min(axis=1)).all()
