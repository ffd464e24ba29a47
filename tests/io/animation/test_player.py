"""Web pages that play an animation: what is stored in them, and what a browser shows."""

import base64
import json
import re
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.animation.frames import Frame
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.errors import InputError
from akap_editor.io.animation.formats import write_animation
from akap_editor.io.animation.player import MAX_TEXTURE_SIDE, STEP, encode_player
from akap_editor.io.images import decode_image, read_image
from akap_editor.io.painter import FramedPose, framed_poses
from akap_editor.overlap.seams import CutMesh
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource
from tests.support.chromium import Chromium
from tests.support.similarity import structural_similarity

SIDE = 320


@pytest.fixture(scope="module")
def cat() -> Drawing:
    image = read_image(resource("assets", "drawings", "cat.png"))
    return make_drawing(image, vertices=300, name="</script> & cat")


def bent(drawing: Drawing, angle: float) -> np.ndarray:
    """The drawing curled about its lower edge: each point is rotated by ``angle`` times its height."""
    width, height = drawing.size
    offset = drawing.mesh.vertices - np.array([width / 2, height])
    turn = angle * -offset[:, 1] / height
    cos, sin = np.cos(turn), np.sin(turn)
    x, y = offset.T
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1) + np.array([width / 2, height])


def cut_across(drawing: Drawing) -> CutMesh:
    """The drawing with one face cut in three, drawn back to front in the reverse order."""
    faces = drawing.mesh.faces[::-1].astype(np.int32)
    a, b, c = faces[0].tolist()
    n = len(drawing.mesh.vertices)
    parts = np.array([(a, n, n + 1), (n, b, c), (n, c, n + 1)], dtype=np.int32)
    edges, shares = np.array([(a, b), (a, c)], dtype=np.int32), np.array([0.25, 0.5])
    order = np.arange(len(faces))[::-1]
    sources = np.concatenate([order[[0, 0, 0]], order[1:]]).astype(np.int32)
    return CutMesh(order, np.concatenate([parts, faces[1:]]), sources, edges, shares)


@pytest.fixture(scope="module")
def wave(cat: Drawing) -> list[Frame]:
    """Five frames to the side and back, the middle one with a seam."""
    poses = [bent(cat, angle) for angle in (0.0, 0.3, 0.6)]
    seam = cut_across(cat)
    frames = [Frame(cat, poses[0]), Frame(cat, poses[1], seam.order), Frame(cat, poses[2], seam)]
    return [*frames, frames[1], Frame(cat, poses[0])]


@pytest.fixture(scope="module")
def framed(wave: list[Frame]) -> list[FramedPose]:
    return framed_poses(wave, SIDE, None)


class Page:
    """What a page stores, read as its script reads it."""

    def __init__(self, text: str) -> None:
        self.record = json.loads(re.search(r"const animation = (.*);\n", text)[1])
        self._data = zlib.decompress(base64.b64decode(re.search(r'const packed = "(.*)"', text)[1]))
        self._at = 0
        for mesh in self.record["meshes"]:
            mesh["uv"] = self._take("<f4", 2 * mesh["vertices"]).reshape(-1, 2)
        for order in self.record["orders"]:
            order["faces"] = self._take("<u4", 3 * order["faceCount"]).reshape(-1, 3)
            order["edges"] = self._take("<u4", 2 * order["cutCount"]).reshape(-1, 2)
            order["shares"] = self._take("<f4", order["cutCount"])
        for mesh in self.record["meshes"]:
            mesh["poses"] = [np.zeros(2 * mesh["vertices"], dtype=int)] * 2
            for number in range(mesh["poseCount"]):
                low, high = self._take("u1", 4 * mesh["vertices"]).reshape(2, -1).astype(int)
                code = low + 256 * high
                last, before = mesh["poses"][-1], mesh["poses"][-2]
                residual = np.where(code % 2, -(code + 1) // 2, code // 2)
                pose = residual + (last + (last - before) * (number > 1)) * (number > 0)
                mesh["poses"].append(pose % 65536)
            mesh["poses"] = mesh["poses"][2:]
        assert self._at == len(self._data), "nothing else is stored"

    def _take(self, dtype: str, count: int) -> np.ndarray:
        start, self._at = self._at, self._at + count * np.dtype(dtype).itemsize
        return np.frombuffer(self._data, dtype, count, start)

    def pose(self, frame: int) -> np.ndarray:
        order, pose = self.record["frames"][frame]
        mesh = self.record["meshes"][self.record["orders"][order]["mesh"]]
        return self.record["origin"] + self.record["unit"] * mesh["poses"][pose].reshape(-1, 2)

    def order(self, frame: int) -> dict:
        return self.record["orders"][self.record["frames"][frame][0]]


# -- what is stored ------------------------------------------------------------------------------------------


def test_poses_orders_and_cuts_come_back(framed, wave, cat):
    page = Page(encode_player(framed, 30))
    assert page.record["unit"] == STEP
    for number, frame in enumerate(wave):
        assert np.abs(page.pose(number) - frame.pose).max() <= 0.5001 * STEP
        order, seam = page.order(number), frame.order
        if isinstance(seam, CutMesh):
            np.testing.assert_array_equal(order["faces"], seam.faces)
            np.testing.assert_array_equal(order["edges"], seam.edges)
            np.testing.assert_array_equal(order["shares"], seam.shares)
        else:
            np.testing.assert_array_equal(
                order["faces"], cat.mesh.faces[slice(None) if seam is None else seam]
            )
    np.testing.assert_array_equal(page.record["meshes"][0]["uv"], cat.uv)


def test_what_repeats_is_stored_once(framed):
    record = Page(encode_player(framed, 30)).record
    assert (len(record["meshes"]), len(record["orders"]), len(record["pictures"])) == (1, 3, 1)
    assert record["meshes"][0]["poseCount"] == 3
    assert record["frames"] == [[0, 0], [1, 1], [2, 2], [1, 1], [0, 0]]


def test_another_mesh_in_the_middle(cat, wave):
    finer = make_drawing(cat.image, vertices=400, name=cat.name)
    other = replace(finer, image=cat.image)
    page = Page(encode_player(framed_poses([wave[0], Frame(other, bent(other, 0.4))], SIDE, None), 30))
    assert [mesh["vertices"] for mesh in page.record["meshes"]] == [
        len(d.mesh.vertices) for d in (cat, other)
    ]
    assert np.abs(page.pose(1) - bent(other, 0.4)).max() <= 0.5001 * STEP
    assert not page.record["flows"]


def test_poses_that_reach_far_are_stored_more_coarsely(cat, wave):
    far = Frame(cat, wave[0].pose + np.array([9000.0, 0.0]))
    page = Page(encode_player(framed_poses([wave[0], far], SIDE, None), 30))
    assert page.record["unit"] > STEP
    assert np.abs(page.pose(1) - far.pose).max() <= 0.5001 * page.record["unit"]


@pytest.mark.parametrize(("angles", "flows"), [((0, 1, 2, 1), True), ((0, 1, 2, 3), False), ((0,), False)])
def test_a_loop_flows_on_if_its_last_pose_is_next_to_the_first(cat, angles, flows):
    frames = [Frame(cat, bent(cat, 0.1 * angle)) for angle in angles]
    assert Page(encode_player(framed_poses(frames, SIDE, None), 30)).record["flows"] is flows


def test_the_picture_is_exact_where_it_is_visible(framed, cat):
    uri = Page(encode_player(framed, 30)).record["pictures"][0]
    image = decode_image(base64.b64decode(uri.partition(",")[2]))
    visible = cat.image[..., 3] > 0
    np.testing.assert_array_equal(image[..., 3], cat.image[..., 3])
    np.testing.assert_array_equal(image[visible], cat.image[visible])


def test_a_picture_too_large_for_browsers_is_reduced():
    image = np.zeros((8, MAX_TEXTURE_SIDE + 8, 4), dtype=np.uint8)
    image[2:6, 2:-2] = (250, 130, 20, 255)
    drawing = make_drawing(image, vertices=200)
    frames = framed_poses([Frame(drawing, drawing.mesh.vertices)], 8192, None)
    uri = Page(encode_player(frames, 30)).record["pictures"][0]
    assert max(decode_image(base64.b64decode(uri.partition(",")[2])).shape) == MAX_TEXTURE_SIDE


def test_a_name_is_text_whatever_is_in_it(framed):
    text = encode_player(framed, 30)
    assert text.count("</script>") == 1
    assert "<title>&lt;/script&gt; &amp; cat</title>" in text


def test_no_frames_are_refused(tmp_path):
    with pytest.raises(InputError, match="expected at least one frame"):
        write_animation(tmp_path / "a.html", [], 30)
    assert list(tmp_path.iterdir()) == []


def test_only_a_page_can_wait_for_the_pointer(tmp_path):
    with pytest.raises(InputError, match="hover: expected a web page, got GIF"):
        write_animation(tmp_path / "a.gif", [], 30, hover=True)


def test_nothing_is_loaded_from_elsewhere(framed):
    text = encode_player(framed, 30)
    assert not re.search(r"https?://|\bimport\b|<link|src=\"", text)


# -- what a browser shows ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    with Chromium(tmp_path_factory.mktemp("chromium")) as opened:
        yield opened


@pytest.fixture
def shown(browser, tmp_path):
    """Writes a page, opens it in a window of its size, and waits for the first frame."""

    def show(frames: list[FramedPose], fragment: str = "", **options) -> Chromium:
        path = tmp_path / "page.html"
        write_animation(path, frames, 10, **options)
        record = Page(path.read_text("utf-8")).record
        browser.move_mouse(-1, -1)
        browser.open(path, fragment, (record["width"], record["height"]))
        browser.wait_for("shownOrder !== undefined")
        return browser

    return show


@pytest.fixture(scope="module")
def own_render() -> Iterator[Callable[[FramedPose], np.ndarray]]:
    with OffscreenRenderer() as renderer:

        def render(framed: FramedPose) -> np.ndarray:
            frame, box, scale, background = framed
            return renderer.render(frame.drawing, frame.pose, box, scale, background, frame.order)

        yield render


@pytest.mark.parametrize(
    ("moment", "side", "background"),
    [(0.0, SIDE, None), (2.0, 700, (0.2, 0.5, 0.9)), (1.5, 200, None)],
    ids=["at rest", "bent, with a seam and a background", "between two frames"],
)
def test_a_browser_shows_what_the_renderer_draws(shown, own_render, wave, moment, side, background):
    frames = framed_poses(wave, side, background)
    picture = shown(frames, f"#t={(moment + 1e-4) / 10}").screenshot()
    number, share = int(moment), moment % 1
    pose = (1 - share) * wave[number].pose + share * wave[number + 1].pose
    expected = own_render(frames[number]._replace(frame=wave[number]._replace(pose=pose)))
    assert picture.shape == expected.shape
    assert structural_similarity(picture, expected) >= 0.998
    if background is None:
        assert picture[0, 0, 3] == 0, "transparent"


def test_it_plays_at_once_and_a_click_stops_it(shown, framed):
    page = shown(framed)
    page.wait_for("seconds > 0.1")
    page.click(50, 50)
    stopped = page.evaluate("seconds")
    page.evaluate("new Promise(requestAnimationFrame)")
    assert page.evaluate("[isPlaying, seconds]") == [False, stopped]
    page.click(50, 50)
    page.wait_for(f"seconds > {stopped}")


def test_it_plays_only_under_the_pointer(shown, framed):
    page = shown(framed, hover=True)
    assert not page.evaluate("isPlaying")
    page.move_mouse(60, 60)
    page.wait_for("isPlaying && seconds > 0.1")
    page.move_mouse(-1, -1)
    page.wait_for("!isPlaying")


def test_it_ends_after_its_plays_with_the_last_frame(shown, own_render, framed):
    page = shown(framed[:3], plays=2)
    page.wait_for("!isPlaying")
    assert page.evaluate("seconds") >= (2 * 3 - 1) / 10
    assert structural_similarity(page.screenshot(), own_render(framed[2])) >= 0.998
    page.click(50, 50)
    assert page.evaluate("isPlaying && seconds < 0.4")
