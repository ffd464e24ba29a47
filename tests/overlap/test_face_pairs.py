"""The pairs of faces that are found are all that have common area."""

import numpy as np
import pytest
from shapely import STRtree, polygons

from akap_editor.geometry.mesh import TriMesh, signed_areas
from akap_editor.overlap.common_area import common_areas
from akap_editor.overlap.face_pairs import FacePairs, overlapping_faces, pair_index
from akap_editor.overlap.topology import mesh_topology
from tests.support.bends import random_drag, trefoil
from tests.support.shapes import SHAPES, blocks


def brute_force(mesh: TriMesh, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All pairs of faces (p, 2) that intersect and share no edge, by shapely, with their common areas."""
    shapes = polygons(pose[mesh.faces])
    i, j = STRtree(shapes).query(shapes, predicate="intersects")
    i, j = i[i < j], j[i < j]
    shared = (mesh.faces[i][:, :, None] == mesh.faces[j][:, None, :]).sum(axis=(1, 2))
    pairs = np.stack([i, j], axis=1)[shared < 2]
    areas = np.array([shapes[a].intersection(shapes[b]).area for a, b in pairs])
    return pairs, areas


def as_set(first: np.ndarray, second: np.ndarray) -> set[tuple[int, int]]:
    return set(zip(np.minimum(first, second).tolist(), np.maximum(first, second).tolist(), strict=True))


def check_complete(mesh: TriMesh, pose: np.ndarray) -> FacePairs:
    pairs = overlapping_faces(mesh_topology(mesh), pose)
    found = as_set(pairs.first, pairs.second)
    assert len(found) == len(pairs), "a pair was found twice"
    expected, areas = brute_force(mesh, pose)
    tiny = 1e-9 * mesh.rest_areas.sum()
    real = expected[areas > tiny]
    missing = as_set(real[:, 0], real[:, 1]) - found if len(real) else set()
    assert not missing
    surplus = found - (as_set(expected[:, 0], expected[:, 1]) if len(expected) else set())
    assert not surplus
    return pairs


@pytest.mark.parametrize("name", [name for name, mesh in SHAPES.items() if len(mesh.faces) > 1])
@pytest.mark.parametrize("seed", [1, 2])
def test_all_pairs_with_common_area_are_found_in_random_drags(name: str, seed: int) -> None:
    mesh = SHAPES[name]
    for number, pose in enumerate(random_drag(mesh, seed)):
        if number % 4 == 3 and signed_areas(pose, mesh.faces).min() > 0:
            check_complete(mesh, pose)


def test_the_overlaps_of_a_rope_that_rolls_up_are_all_found() -> None:
    mesh = blocks("#" * 25, 40.0, 3, 0.2)
    counts = [check_complete(mesh, trefoil(mesh, 1000, 20, share)).region_count for share in (0.0, 0.8, 1.0)]
    assert counts[0] == 0
    assert counts[-1] == 3


def test_a_part_wholly_inside_another_one_is_found() -> None:
    mesh = blocks("###.#", 100.0, 4, 0.1)
    pose = mesh.vertices.copy()
    small = mesh.component == mesh.component[np.argmax(mesh.vertices[:, 0])]
    pose[small] = (pose[small] - pose[small].mean(axis=0)) * 0.3 + np.array([150.0, 50.0])
    pairs = check_complete(mesh, pose)
    assert pairs.region_count == 1
    assert set(pairs.first.tolist() + pairs.second.tolist()) >= set(np.flatnonzero(small[mesh.faces[:, 0]]))


def test_a_pose_without_overlaps_has_no_pairs(mesh: TriMesh) -> None:
    assert not len(overlapping_faces(mesh_topology(mesh), mesh.vertices))


def test_crumpled_poses_end_in_time() -> None:
    mesh = SHAPES["star"]
    rng = np.random.default_rng(1)
    for spread in (5.0, 50.0, 500.0):
        pose = mesh.vertices + rng.normal(0, spread, mesh.vertices.shape)
        overlapping_faces(mesh_topology(mesh), pose)
    heap = np.tile(mesh.vertices.mean(axis=0), (len(mesh.vertices), 1))
    overlapping_faces(mesh_topology(mesh), heap)
    overlapping_faces(mesh_topology(mesh), heap + rng.normal(0, 1e-9, heap.shape))


def test_pairs_are_looked_up_by_both_faces() -> None:
    mesh = blocks("#" * 25, 40.0, 2, 0.2)
    pairs = overlapping_faces(mesh_topology(mesh), trefoil(mesh, 1000, 20, 1.0))
    arrays = pairs.second, pairs.heads, pairs.starts, pairs.links
    for index, (first, second) in enumerate(zip(pairs.first, pairs.second, strict=True)):
        assert pair_index(first, second, *arrays) == index
        assert pair_index(second, first, *arrays) == -1


def test_common_areas_are_those_of_shapely() -> None:
    mesh = SHAPES["square"]
    rng = np.random.default_rng(3)
    pose = mesh.vertices + rng.normal(0, 4, mesh.vertices.shape)
    pose = pose if signed_areas(pose, mesh.faces).min() > 0 else mesh.vertices
    corners = np.concatenate([pose, pose[:, ::-1] * [1.0, -1.0] + [3.0, 104.0]])
    faces = np.concatenate([mesh.faces, mesh.faces + len(pose)]).astype(np.int32)
    i, j = np.divmod(rng.integers(0, len(mesh.faces) ** 2, 300), len(mesh.faces))
    shapes = polygons(corners[faces])
    expected = [shapes[a].intersection(shapes[b + len(mesh.faces)]).area for a, b in zip(i, j, strict=True)]
    areas = common_areas(corners, faces, i.astype(np.int32), (j + len(mesh.faces)).astype(np.int32))
    assert np.allclose(areas, expected, atol=1e-9)
