from dataclasses import replace

import moderngl
import numpy as np
import pytest
import shapely
from PIL import Image

from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.framing import MAX_SIZE, frame_box
from akap_editor.errors import GraphicsError, InputError
from akap_editor.geometry.mesh import TriMesh
from akap_editor.render.offscreen import OffscreenRenderer, standalone_context
from akap_editor.resources import bundled_drawings


def premultiplied(image):
    """(h, w, 4) float64 from 0 to 255."""
    values = image.astype(np.float64)
    values[..., :3] *= values[..., 3:] / 255
    return values


def without_hidden_color(image):
    return np.where(image[..., 3:] > 0, image, 0)


# --- at rest ---


def test_at_rest_noise_comes_back_bit_for_bit(offscreen, sheet, noise):
    drawing = sheet(noise)
    assert np.array_equal(offscreen.render(drawing, drawing.mesh.vertices), without_hidden_color(noise))


def test_color_survives_every_alpha(offscreen, sheet):
    """Row a has alpha a; the columns run through all reds."""
    alpha, red = np.mgrid[:256, :256].astype(np.uint8)
    image = np.stack([red, 255 - red, np.full_like(red, 77), alpha], axis=-1)
    drawing = sheet(image, cells=1)
    assert np.array_equal(offscreen.render(drawing, drawing.mesh.vertices), without_hidden_color(image))


@pytest.mark.parametrize("path", bundled_drawings(), ids=lambda path: path.stem)
def test_at_rest_a_bundled_drawing_comes_back(offscreen, path):
    assert_comes_back(offscreen, np.asarray(Image.open(path).convert("RGBA")))


def test_at_rest_a_cartoon_comes_back(offscreen, cartoon_image):
    assert_comes_back(offscreen, cartoon_image)


def assert_comes_back(offscreen, image):
    """Alpha differs by 1 at most, but for pixels that the mesh covers in part; exact where opaque."""
    drawing = make_drawing(image, vertices=800)
    result = offscreen.render(drawing, drawing.mesh.vertices)
    assert result.shape == image.shape
    visible = result[..., 3] > 0
    missing = image[..., 3].astype(int) - result[..., 3]
    assert missing[visible].min() >= -1
    y, x = np.nonzero(visible & (missing > 1))
    covered = shapely.union_all(shapely.polygons(drawing.mesh.vertices[drawing.mesh.faces]))
    assert not shapely.covers(covered, shapely.box(x, y, x + 1, y + 1)).any()
    assert np.array_equal(result[image[..., 3] == 255], image[image[..., 3] == 255])
    assert np.abs(result[..., :3].astype(int) - image[..., :3])[visible].max() <= 1
    assert not result[~visible].any()


# --- box and scale ---


def test_translated_pose_is_the_picture_shifted_exactly(offscreen, sheet, noise):
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices + np.array([10, 5]))
    assert result.shape == (48 + 5, 64 + 10, 4)
    assert np.array_equal(result[5:, 10:], without_hidden_color(noise))
    assert not result[:5].any()
    assert not result[:, :10].any()


def test_box_with_negative_origin(offscreen, sheet, noise):
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices, box=(-3, -4, 20, 30))
    assert result.shape == (34, 23, 4)
    assert np.array_equal(result[4:, 3:], without_hidden_color(noise)[:30, :20])
    assert not result[:4].any()
    assert not result[:, :3].any()


def test_quarter_turn_turns_the_pixels(offscreen, sheet, noise):
    drawing = sheet(noise)
    x, y = drawing.mesh.vertices.T
    result = offscreen.render(drawing, np.stack([48 - y, x], axis=1), box=(0, 0, 48, 64))
    assert np.array_equal(result, np.rot90(without_hidden_color(noise), -1))


@pytest.mark.parametrize("step", [2, 4, 16])
def test_smaller_scale_is_the_mean_of_premultiplied_pixels(offscreen, sheet, noise, step):
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices, scale=1 / step)
    expected = premultiplied(noise).reshape(48 // step, step, 64 // step, step, 4).mean(axis=(1, 3))
    assert result.shape == expected.shape
    assert np.abs(premultiplied(result) - expected).max() <= 1


def catmull_rom(image, scale):
    """A premultiplied picture (h, w, 4) enlarged by a whole number, without overshoots."""
    for axis in (0, 1):
        count = image.shape[axis]
        position = (np.arange(count * scale) + 0.5) / scale - 0.5
        base = np.floor(position).astype(int)
        t = (position - base).reshape([-1 if i == axis else 1 for i in range(3)])
        weights = (
            t * (t * (2 - t) - 1) / 2,
            (t * t * (3 * t - 5) + 2) / 2,
            t * (t * (4 - 3 * t) + 1) / 2,
            t * t * (t - 1) / 2,
        )
        image = sum(
            weight * np.take(image, np.clip(base + shift, 0, count - 1), axis=axis)
            for weight, shift in zip(weights, (-1, 0, 1, 2), strict=True)
        )
    image = np.maximum(image, 0) / np.maximum(image[..., 3:] / 255, 1)
    return np.minimum(image, image[..., 3:])


@pytest.mark.parametrize("scale", [2, 3, 8])
def test_larger_scale_is_a_cubic_spline_in_premultiplied_pixels(offscreen, sheet, noise, scale):
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices, scale=scale)
    assert np.abs(premultiplied(result) - catmull_rom(premultiplied(noise), scale)).max() <= 1.5


def gradient_energy(image):
    return sum((np.diff(premultiplied(image), axis=axis) ** 2).sum() for axis in (0, 1))


@pytest.fixture(scope="module")
def elephant_image():
    path = next(path for path in bundled_drawings() if path.stem == "elephant")
    return np.asarray(Image.open(path).convert("RGBA"))


@pytest.mark.parametrize("degrees", [10, 33, 45, 77])
def test_a_turn_at_full_scale_costs_little_of_the_detail(offscreen, sheet, elephant_image, degrees):
    """Linear interpolation costs 28 % of the gradient energy of this drawing."""
    drawing, image = sheet(elephant_image), elephant_image
    angle, center = np.radians(degrees), np.array(image.shape[1::-1]) / 2
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    result = offscreen.render(drawing, (drawing.mesh.vertices - center) @ turn + center)
    assert gradient_energy(result) > 0.83 * gradient_energy(without_hidden_color(image))


@pytest.mark.parametrize("shift", [0.001, 0.05, 0.25, 0.5])
def test_a_flat_color_has_no_ripples(offscreen, sheet, plain, shift):
    drawing = sheet(plain(40, 30, 200, 100, 50, 140))
    result = offscreen.render(drawing, drawing.mesh.vertices * 1.7 + shift)
    inside = result[2:-2, 2:-2]
    assert (inside[inside[..., 3] == 140] == [200, 100, 50, 140]).all()
    assert (inside[5:45, 5:60, 3] == 140).all()


@pytest.mark.parametrize("scale", [0.3, 0.45, 0.7, 0.9, 0.99])
def test_small_scales_do_not_alias(offscreen, sheet, scale):
    """A fine checkerboard becomes gray, or keeps its contrast in part, but never gets stripes."""
    y, x = np.mgrid[:96, :96]
    image = np.full((96, 96, 4), 255, np.uint8)
    image[..., :3] = np.where((x + y) % 2, 255, 0)[..., None]
    result = offscreen.render(sheet(image), sheet(image).mesh.vertices, scale=scale)[2:-2, 2:-2, 0]
    windows = np.lib.stride_tricks.sliding_window_view(result.astype(float), (8, 8)).mean(axis=(2, 3))
    assert np.abs(windows - 127.5).max() < 40


def test_sharpness_does_not_jump_where_a_part_becomes_a_little_smaller(offscreen, sheet, elephant_image):
    drawing, factors = sheet(elephant_image), (0.95, 0.99, 0.998, 1.002, 1.01, 1.05)
    energies = [gradient_energy(offscreen.render(drawing, drawing.mesh.vertices * each)) for each in factors]
    assert np.abs(np.diff(np.log(energies))).max() < 0.05


@pytest.mark.parametrize("scale", [0.1, 0.37, 0.5, 1.0, 1.7, 4.0])
def test_a_soft_rim_keeps_its_color_at_any_scale(offscreen, sheet, disc, scale):
    drawing = sheet(disc)
    angle = 0.3
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    result = offscreen.render(drawing, (drawing.mesh.vertices - 32) @ turn + 32, scale=scale)
    alpha = result[..., 3:].astype(float)
    assert alpha.any()
    assert (np.abs(premultiplied(result)[..., :3] - alpha / 255 * [250, 130, 20]) <= 1).all()


@pytest.mark.parametrize(
    ("scale", "size"),
    [
        (0.5, (32, 24)),
        (1.1, (71, 53)),
        (0.01, (1, 1)),
        (1e-9, (1, 1)),
        (3, (192, 144)),
    ],
)
def test_size_is_rounded_up(offscreen, sheet, noise, scale, size):
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices, scale=scale)
    assert (result.shape[1], result.shape[0]) == size


def test_rounding_noise_adds_no_column(offscreen, sheet, noise):
    assert 50 * 1.1 > 55
    drawing = sheet(noise)
    result = offscreen.render(drawing, drawing.mesh.vertices, box=(0, 0, 50, 50), scale=1.1)
    assert result.shape == (55, 55, 4)


def test_frame_box_holds_the_frame_and_all_poses(sheet, plain):
    drawing = sheet(plain(40, 30, 1, 2, 3, 255))
    rest = drawing.mesh.vertices
    assert frame_box(drawing, []) == (0, 0, 40, 30)
    assert frame_box(drawing, [rest / 2]) == (0, 0, 40, 30)
    assert frame_box(drawing, [rest - 0.5, rest + np.array([7.2, 0])]) == (-1, -1, 48, 30)
    assert frame_box(drawing, [rest + 1e-9, rest - 1e-9]) == (0, 0, 40, 30)


# --- background and order ---


def test_background_is_composited_and_opaque(offscreen, sheet, noise):
    drawing = sheet(noise)
    background = np.array([0.2, 0.9, 0.4])
    result = offscreen.render(drawing, drawing.mesh.vertices, background=tuple(background))
    expected = premultiplied(noise)
    over = expected[..., :3] + background * (255 - expected[..., 3:])
    assert (result[..., 3] == 255).all()
    assert np.abs(result[..., :3] - over).max() <= 0.75


def test_later_faces_lie_on_top(offscreen):
    """Left half red, right half green and half transparent; posed one upon the other."""
    image = np.zeros((8, 16, 4), dtype=np.uint8)
    image[:, :8] = (255, 0, 0, 255)
    image[:, 8:] = (0, 255, 0, 128)
    vertices = np.array([[x, y] for x in (0, 7, 9, 16) for y in (0, 8)], dtype=np.float64)
    red = [[0, 2, 3], [0, 3, 1]]
    green = [[4, 6, 7], [4, 7, 5]]
    posed = vertices.copy()
    posed[4:, 0] -= 9
    for faces, expected in ((red + green, [127, 128, 0, 255]), (green + red, [255, 0, 0, 255])):
        mesh = TriMesh(vertices, np.array(faces, dtype=np.int32))
        drawing = Drawing(image, mesh, vertices / [16, 8])
        result = offscreen.render(drawing, posed)
        assert (np.abs(result[:, 1:6].astype(int) - expected) <= 1).all()


def test_a_new_pose_a_new_drawing_and_back(offscreen, sheet, noise, disc):
    first, second = sheet(noise), sheet(disc)
    before = offscreen.render(first, first.mesh.vertices)
    moved = offscreen.render(first, first.mesh.vertices + np.array([3, 0]), box=(0, 0, 64, 48))
    assert np.array_equal(moved[:, 3:], before[:, :-3])
    other = offscreen.render(second, second.mesh.vertices)
    assert np.array_equal(other, without_hidden_color(disc))
    assert np.array_equal(offscreen.render(first, first.mesh.vertices), before)


# --- edges and tiles ---


def test_an_opaque_edge_covers_each_pixel_by_its_share(offscreen, sheet, plain):
    """A turned opaque sheet: alpha is the covered area of a pixel, as far as 4 samples can tell."""
    drawing = sheet(plain(40, 30, 200, 100, 50, 255))
    angle = 0.35
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    pose = (drawing.mesh.vertices - [20, 15]) @ turn + [20, 15]
    result = offscreen.render(drawing, pose, box=(-5, -12, 45, 42))
    corners = (np.array([[0, 0], [40, 0], [40, 30], [0, 30]]) - [20, 15]) @ turn + [20, 15]
    x, y = np.meshgrid(np.arange(-5, 45), np.arange(-12, 42))
    cells = shapely.box(x, y, x + 1, y + 1)
    expected = shapely.area(shapely.intersection(cells, shapely.Polygon(corners)))
    assert np.abs(result[..., 3] / 255 - expected).max() <= 0.3
    assert abs((result[..., 3] / 255).sum() - expected.sum()) < 0.002 * expected.sum()
    assert (result[result[..., 3] > 0][:, :3] == [200, 100, 50]).all()
    partly = (result[..., 3] > 0) & (result[..., 3] < 255)
    assert partly.sum() > 50


@pytest.mark.parametrize("scale", [1.0, 1.7, 3.0])
def test_tiles_join_without_a_seam(offscreen, sheet, noise, monkeypatch, scale):
    drawing = sheet(noise)
    pose = drawing.mesh.vertices @ [[0.9, 0.3], [-0.3, 0.9]] + [20.3, -7.7]
    whole = offscreen.render(drawing, pose, scale=scale)
    monkeypatch.setattr("akap_editor.render.offscreen.TILE_SIZE", 17)
    tiled = offscreen.render(drawing, pose, scale=scale)
    assert np.abs(premultiplied(tiled) - premultiplied(whole)).max() <= 2


def test_at_rest_tiles_are_exact(offscreen, sheet, noise, monkeypatch):
    drawing = sheet(noise)
    monkeypatch.setattr("akap_editor.render.offscreen.TILE_SIZE", 16)
    assert np.array_equal(offscreen.render(drawing, drawing.mesh.vertices), without_hidden_color(noise))


def test_a_picture_may_be_larger_than_the_driver_can_draw_at_once(ctx, sheet, noise):
    drawing = sheet(noise)
    with OffscreenRenderer(ctx) as renderer:
        whole = renderer.render(drawing, drawing.mesh.vertices, scale=4)
        renderer._renderer.max_texture_size = 64
        tiled = renderer.render(drawing, drawing.mesh.vertices, scale=4)
    assert np.abs(premultiplied(tiled) - premultiplied(whole)).max() <= 2


# --- errors and contexts ---


def test_errors_say_what_was_expected_and_what_came(offscreen, sheet, noise):
    drawing = sheet(noise)
    rest = drawing.mesh.vertices
    with pytest.raises(InputError, match=r"at most 8192×8192 pixels, got 8193×1; choose a smaller scale"):
        offscreen.render(drawing, rest, box=(0, 0, MAX_SIZE + 1, 1))
    with pytest.raises(InputError, match=r"at most 8192×8192 pixels, got 64000×48000;"):
        offscreen.render(drawing, rest, scale=1000)
    with pytest.raises(InputError, match=r"at most 8192×8192 pixels, got inf×inf;"):
        offscreen.render(drawing, rest, scale=1.7e308)
    for scale in (0, -1, float("nan"), float("inf")):
        with pytest.raises(InputError, match=rf"scale: expected a positive number, got {scale:g}"):
            offscreen.render(drawing, rest, scale=scale)
    with pytest.raises(InputError, match=r"box: expected x0 < x1 and y0 < y1, got \(5, 0, 5, 9\)"):
        offscreen.render(drawing, rest, box=(5, 0, 5, 9))
    with pytest.raises(InputError, match=r"positions: expected shape \(25, 2\), got \(24, 2\)"):
        offscreen.render(drawing, rest[1:])
    with pytest.raises(InputError, match=r"positions: expected finite numbers, got \[nan, 0.0\] in row 0"):
        offscreen.render(drawing, np.where(np.arange(25)[:, None] == 0, [np.nan, 0.0], rest))
    with pytest.raises(InputError, match=r"poses: expected shape \(25, 2\), got \(3, 2\)"):
        frame_box(drawing, [rest, rest[:3]])


def test_the_largest_size_is_allowed(offscreen, sheet, noise):
    drawing = sheet(noise)
    assert offscreen.render(drawing, drawing.mesh.vertices, box=(0, 0, MAX_SIZE, 1)).shape == (1, MAX_SIZE, 4)


def test_own_context_is_made_on_first_use_and_again_after_leaving(sheet, noise, monkeypatch):
    drawing = sheet(noise)
    made = []
    create = moderngl.create_context
    monkeypatch.setattr(moderngl, "create_context", lambda **kw: made.append(create(**kw)) or made[-1])
    renderer = OffscreenRenderer()
    with renderer:
        assert not made
        for _ in range(2):
            result = renderer.render(drawing, drawing.mesh.vertices)
            assert np.array_equal(result, without_hidden_color(noise))
        with made[0]:
            assert made[0].error == "GL_NO_ERROR"
    with renderer:
        result = renderer.render(replace(drawing), drawing.mesh.vertices)
        assert np.array_equal(result, without_hidden_color(noise))
    assert len(made) == 2


def test_without_opengl_one_sentence_names_the_packages(monkeypatch):
    def fail(**_kw):
        raise Exception("libEGL.so not loaded")

    monkeypatch.setattr(moderngl, "create_context", fail)
    with pytest.raises(
        GraphicsError, match=r"install the packages libegl1 and libgl1 \(libEGL.so not loaded\)$"
    ):
        standalone_context()
