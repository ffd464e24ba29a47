"""Keyframes in other programs: poses that are interpolated linearly, and orders that are switched."""

import json
import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor.animation.frames import Frame
from akap_editor.editor.animation.loose_motion import AnimationFrames
from akap_editor.editor.document.document import Document
from akap_editor.editor.document.keyframes import NO_ANIMATION, Animation, Keyframe
from akap_editor.io.export.baked_animation import TOLERANCE, BakedAnimation, bake_animation
from akap_editor.io.export.drawn_faces import drawn_faces
from akap_editor.io.export.texture import y_up
from akap_editor.overlap.overlaps import NO_CROSSINGS
from akap_editor.overlap.seams import CutMesh
from tests.io.export.test_drawn_faces import Triangles, visible_uv
from tests.support.bends import rope_with_seam
from tests.support.npm import run_with_package

TIMES = (0.0, 0.13, 0.3, 0.4, 0.7, 0.9, 1.0, 1.2)


def frame_at(document: Document, time: float) -> Frame:
    return AnimationFrames(document).frame(time)


def pose_at(baked: BakedAnimation, time: float) -> np.ndarray:
    later = min(np.searchsorted(baked.times, time, side="right"), len(baked.times) - 1)
    start, end = baked.times[later - 1], baked.times[later]
    share = (time - start) / (end - start)
    return (1 - share) * baked.poses[later - 1] + share * baked.poses[later]


def test_poses_between_are_near(keyed: Document) -> None:
    baked = bake_animation(keyed)
    assert baked is not None
    for time in np.linspace(0, 1.2, 37):
        assert np.abs(pose_at(baked, time) - frame_at(keyed, time).pose).max() < 2 * TOLERANCE
    assert set(keyed.state.animation.times) <= set(baked.times)
    assert len(baked.times) < 24, "where the motion is straight, few poses are kept"


def test_each_moment_has_one_order_in_which_its_overlaps_are_right(keyed: Document) -> None:
    baked = bake_animation(keyed)
    assert baked is not None
    assert len(baked.orders) == 2, "in front and behind"
    spans = sorted(span for each in baked.orders for span in each.spans)
    assert spans[0][0] == 0
    assert spans[-1][1] == 1.2
    assert [end for _, end in spans[:-1]] == [start for start, _ in spans[1:]]
    for each in baked.orders:
        rank = np.argsort(each.order)
        assert (rank[each.low] < rank[each.high]).all()


@pytest.mark.parametrize("count", [0, 1])
def test_fewer_than_two_keyframes_are_no_animation(keyed: Document, count: int) -> None:
    animation = replace(NO_ANIMATION, keyframes=keyed.state.animation.keyframes[:count])
    assert bake_animation(keyed.with_state(replace(keyed.state, animation=animation))) is None


def assert_shown(document: Document, time: float, seen: Triangles) -> None:
    """The triangles seen at a time, with y up, show at each point what the window shows there."""
    frame = frame_at(document, time)
    shown = drawn_faces(frame.drawing, frame.pose, frame.order)
    points = np.random.default_rng(1).uniform(frame.pose.min(axis=0), frame.pose.max(axis=0), (500, 2))
    expected = visible_uv((shown.pose[shown.faces], shown.uv[shown.faces]), points)
    found = visible_uv(seen, y_up(frame.drawing, points))
    wrong = np.abs(np.nan_to_num(found, nan=-1) - np.nan_to_num(expected, nan=-1)).max(axis=1) > 0.01
    assert wrong.mean() < 0.02, "but for points near the rim"


# -- Spine ---------------------------------------------------------------------------------------------------

RUNTIME = """
import { readFileSync } from "node:fs";
import * as spine from "@esotericsoftware/spine-core";
const [json, atlas, animation, ...times] = process.argv.slice(2);
const pages = new spine.TextureAtlas(readFileSync(atlas, "utf8"));
for (const page of pages.pages) page.setTexture(
  { getImage: () => ({ width: page.width, height: page.height }), setFilters() {}, setWraps() {} });
const reader = new spine.SkeletonJson(new spine.AtlasAttachmentLoader(pages));
const data = reader.readSkeletonData(readFileSync(json, "utf8"));
const skeleton = new spine.Skeleton(data);
const state = new spine.AnimationState(new spine.AnimationStateData(data));
const result = times.map((time) => {
  skeleton.setToSetupPose();
  if (animation) {
    state.setAnimation(0, animation, false).trackTime = Number(time);
    state.apply(skeleton);
  }
  skeleton.updateWorldTransform(spine.Physics.update);
  return skeleton.drawOrder.filter((slot) => slot.getAttachment()).map((slot) => {
    const mesh = slot.getAttachment(), vertices = new Array(mesh.worldVerticesLength);
    mesh.computeWorldVertices(slot, 0, mesh.worldVerticesLength, vertices, 0, 2);
    return { vertices, uvs: Array.from(mesh.uvs), triangles: mesh.triangles };
  });
});
console.log(JSON.stringify(result));
"""


def spine_shows(path: Path, animation: str, *times: float) -> list[Triangles]:
    """What the official runtime draws at some times of an animation, "" for the setup pose."""
    atlas = path.with_name("a.atlas")
    moments = run_with_package(
        "@esotericsoftware/spine-core", "4.2.74", RUNTIME, path, atlas, animation, *times
    )
    result = []
    for slots in moments:
        corners, uv = [], []
        for slot in slots:
            faces = np.array(slot["triangles"]).reshape(-1, 3)
            corners.append(np.array(slot["vertices"]).reshape(-1, 2)[faces])
            uv.append(np.array(slot["uvs"]).reshape(-1, 2)[faces])
        result.append((np.concatenate(corners), np.concatenate(uv)))
    return result


def test_spine_s_runtime_plays_the_keyframes(keyed: Document, exported: Callable[..., Path]) -> None:
    path = exported(keyed, "a.spine.json")
    for time, seen in zip(TIMES, spine_shows(path, "keyframes", *TIMES), strict=True):
        assert_shown(keyed, time, seen)


def test_spine_s_runtime_shows_rest_and_pose(bent: Document, exported: Callable[..., Path]) -> None:
    path = exported(bent, "a.spine.json")
    drawing = bent.drawing
    for animation, points in (("", drawing.mesh.vertices), ("pose", bent.state.positions)):
        ((corners, uv),) = spine_shows(path, animation, 0.0)
        order = np.lexsort(drawing.uv.T)
        places = corners.reshape(-1, 2)[np.unique(uv.reshape(-1, 2).round(5), axis=0, return_index=True)[1]]
        assert len(places) == len(order)
        expected = y_up(drawing, points)[np.unique(drawing.uv.round(5), axis=0, return_index=True)[1]]
        np.testing.assert_allclose(places, expected, atol=0.01)


# -- glTF ----------------------------------------------------------------------------------------------------

VALIDATOR = """
import { readFileSync } from "node:fs";
import validator from "gltf-validator";
const report = await validator.validateBytes(new Uint8Array(readFileSync(process.argv[2])));
console.log(JSON.stringify(report));
"""


@pytest.mark.parametrize("name", ["drawn", "bent", "keyed"])
def test_the_validator_of_khronos_finds_nothing(
    request: pytest.FixtureRequest, exported: Callable[..., Path], name: str
) -> None:
    path = exported(request.getfixturevalue(name), "a.glb")
    report = run_with_package("gltf-validator", "2.0.0-dev.3.10", VALIDATOR, path)
    issues = report["issues"]
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]
    assert report["info"]["animationCount"] == (name == "keyed")


def gltf_shows(path: Path, time: float) -> Triangles:
    """What a viewer draws at a time of the animation, by the rules of the specification."""
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    scene, binary = json.loads(data[20 : 20 + size]), data[28 + size :]

    def array(number: int) -> np.ndarray:
        accessor = scene["accessors"][number]
        columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        dtype = {5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
        begin = scene["bufferViews"][accessor["bufferView"]]["byteOffset"]
        return np.frombuffer(binary, dtype, accessor["count"] * columns, begin).reshape(-1, columns)

    (animation,) = scene["animations"]
    values: dict[tuple[int, str], np.ndarray] = {}
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        times = array(sampler["input"])[:, 0]
        outputs = array(sampler["output"]).reshape(len(times), -1)
        k = int(np.searchsorted(times, np.float32(time), side="right")) - 1
        value = outputs[k]
        if sampler.get("interpolation") != "STEP" and k + 1 < len(times):
            share = (time - times[k]) / (times[k + 1] - times[k])
            value = (1 - share) * outputs[k] + share * outputs[k + 1]
        values[channel["target"]["node"], channel["target"]["path"]] = value
    corners, uv = [], []
    for number, node in enumerate(scene["nodes"]):
        if values.get((number, "scale"), np.array(node["scale"])).max() == 0:
            continue
        (primitive,) = scene["meshes"][node["mesh"]]["primitives"]
        points = array(primitive["attributes"]["POSITION"]).astype(float)
        for weight, target in zip(values[number, "weights"], primitive["targets"], strict=True):
            points = points + weight * array(target["POSITION"])
        faces = array(primitive["indices"]).reshape(-1, 3)
        corners.append(points[faces][..., :2])
        uv.append(array(primitive["attributes"]["TEXCOORD_0"])[faces])
    return np.concatenate(corners), np.concatenate(uv)


def test_gltf_plays_the_keyframes(keyed: Document, exported: Callable[..., Path]) -> None:
    path = exported(keyed, "a.glb")
    for time in TIMES:
        assert_shown(keyed, time, gltf_shows(path, time))


# -- seams ---------------------------------------------------------------------------------------------------


KNOTTED_TIMES = (0.1, 0.3, 0.41, 0.6, 0.85, 1.0, 1.1)  # the rope moves fast between others


@pytest.fixture(scope="module")
def knotted() -> Document:
    """A rope is tied so that two of its parts meet along a seam, swells a little, and is untied."""
    document = rope_with_seam()
    mesh, state = document.drawing.mesh, document.state
    swollen = state.positions * [1.03, 0.98]
    keyframes = (
        Keyframe(0.0, mesh.vertices),
        Keyframe(0.4, state.positions, crossings=state.crossings, ease="hold"),
        Keyframe(0.7, state.positions, crossings=state.crossings),
        Keyframe(1.0, swollen, crossings=state.crossings),
        Keyframe(1.2, mesh.vertices),
    )
    resting = replace(state, positions=mesh.vertices, crossings=NO_CROSSINGS)
    return document.with_state(replace(resting, animation=Animation(keyframes, ease="none")))


def corners_of(triangles: np.ndarray) -> set[tuple[float, ...]]:
    """Triangles (q, 3, 2) as sets of rounded middles."""
    return {tuple(middle) for middle in (triangles.mean(axis=1) / 0.5).round().tolist()}


def test_faces_are_cut_along_the_seams_of_keyframes(knotted: Document, exported: Callable[..., Path]) -> None:
    frame = frame_at(knotted, 0.5)
    assert isinstance(frame.order, CutMesh)
    expected = y_up(frame.drawing, frame.order.values(frame.pose))[frame.order.faces]
    baked = bake_animation(knotted)
    assert baked is not None
    for each in baked.orders:
        count = len(each.cut.faces if each.cut else knotted.drawing.mesh.faces)
        rank = np.argsort(each.order)
        assert len(rank) == count
        assert (rank[each.low] < rank[each.high]).all()
    path = exported(knotted, "a.glb")
    corners, _ = gltf_shows(path, 0.5)
    assert len(corners) == len(expected) > len(knotted.drawing.mesh.faces)
    assert len(corners_of(corners) ^ corners_of(expected)) < 0.02 * len(corners), "rounding"
    for time in KNOTTED_TIMES:
        assert_shown(knotted, time, gltf_shows(path, time))


def test_spine_s_runtime_shows_the_seams_of_keyframes(
    knotted: Document, exported: Callable[..., Path]
) -> None:
    path = exported(knotted, "a.spine.json")
    shown = spine_shows(path, "keyframes", *KNOTTED_TIMES)
    for time, seen in zip(KNOTTED_TIMES, shown, strict=True):
        assert_shown(knotted, time, seen)
    assert len(shown[2][0]) > len(knotted.drawing.mesh.faces)
