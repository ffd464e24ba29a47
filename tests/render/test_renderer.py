from dataclasses import replace

import moderngl
import numpy as np
import pytest

from akap_editor.editor.camera import Camera
from akap_editor.errors import InputError
from akap_editor.render.overlays import Overlays
from akap_editor.render.renderer import CANVAS, TRANSPARENT, Background, Renderer

WHITE, BLACK, BLUE = Background((1, 1, 1)), Background((0, 0, 0)), Background((0.2, 0.4, 0.8))


@pytest.fixture
def shoot(ctx, renderer):
    """Draws what the renderer shows and reads (h, w, 4) uint8 back, top row first, premultiplied."""

    def read(size=(64, 48), camera=None, **options):
        view = (camera or Camera()).view(*size)
        target = ctx.simple_framebuffer(size)
        with ctx.scope(target):  # moderngl trips over a framebuffer that is released while bound
            renderer.draw(target, size, view, **options)
        data = target.read(components=4, alignment=1)
        target.release()
        return np.frombuffer(data, dtype=np.uint8).reshape(size[1], size[0], 4)[::-1].astype(int)

    return read


def over(image, color):
    """Straight RGBA composited on an opaque color, (h, w, 3) float64 from 0 to 255."""
    alpha = image[..., 3:] / 255
    return image[..., :3] * alpha + np.array(color) * 255 * (1 - alpha)


# --- pixels ---


@pytest.mark.parametrize("background", [WHITE, BLACK, BLUE])
def test_picture_is_composited_over_a_plain_background(renderer, shoot, sheet, noise, background):
    drawing = sheet(noise)
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot(background=background)
    assert np.abs(result[..., :3] - over(noise, background.color)).max() <= 1
    assert (result[..., 3] == 255).all()


def test_transparent_background_leaves_premultiplied_pixels(renderer, shoot, sheet, noise):
    drawing = sheet(noise)
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot(background=TRANSPARENT)
    assert np.array_equal(result[..., 3], noise[..., 3])
    assert np.abs(result[..., :3] - over(noise, (0, 0, 0))).max() <= 0.5 + 1e-9


@pytest.mark.parametrize("zoom", [0.3, 1.0, 4.0])
def test_soft_rim_has_no_fringe(renderer, shoot, sheet, disc, zoom):
    """Every pixel lies on the straight line from the background's color to the disc's."""
    drawing = sheet(disc)
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot((256, 256), Camera(zoom, (0.3, 0.6)), background=BLUE)[..., :3]
    start, end = np.array([51.0, 102, 204]), np.array([250.0, 130, 20])
    share = (result - start) @ (end - start) / ((end - start) @ (end - start))
    assert np.abs(start + share[..., None] * (end - start) - result).max() <= 2
    assert share.min() > -0.01
    assert 0.99 < share.max() < 1.01


def test_camera_places_the_picture(renderer, shoot, sheet, plain):
    drawing = sheet(plain(16, 8, 255, 0, 0, 255))
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot((64, 48), Camera(2, (10, 20)), background=BLACK)
    expected = np.zeros((48, 64))
    expected[20:36, 10:42] = 255
    assert np.array_equal(result[..., 0], expected)


def test_drawing_ignores_the_state_that_others_left(ctx, renderer, shoot, sheet, disc):
    drawing = sheet(disc)
    renderer.show(drawing, drawing.mesh.vertices)
    before = shoot()
    target = ctx.simple_framebuffer((64, 48))
    with ctx.scope(target, moderngl.CULL_FACE | moderngl.DEPTH_TEST):
        ctx.blend_func = moderngl.ZERO, moderngl.SRC_COLOR
        ctx.viewport = (1, 1, 3, 3)
        ctx.scissor = (0, 0, 2, 2)
        renderer.draw(target, (64, 48), Camera().view(64, 48))
        after = np.frombuffer(target.read(components=4), dtype=np.uint8).reshape(48, 64, 4)[::-1]
    target.release()
    assert np.array_equal(after, before)


def test_before_show_only_the_plain_background_is_drawn(shoot):
    result = shoot(background=CANVAS, overlays=Overlays(mesh_lines=True))
    assert (np.abs(result[..., :3] - 255 * np.array(CANVAS.color)) <= 0.5).all()


# --- checkerboard ---

CHECKER = Background((0, 0, 1), checker=((1, 0, 0), (0, 1, 0)), cell=4)


def checker(width, height):
    y, x = np.mgrid[:height, :width] // 4
    return np.where(((x + y) % 2 == 0)[..., None], [255, 0, 0], [0, 255, 0])


def even_cells_red(pixels):
    """The same pixels with the two checker colors exchanged, if needed, so that the first one is red."""
    return pixels if pixels[0, 0, 0] else pixels[..., [1, 0, 2]]


@pytest.mark.parametrize("zoom", [0.5, 1.0, 2.0])
def test_checker_fills_the_frame_with_cells_of_constant_size(renderer, shoot, sheet, plain, zoom):
    drawing = sheet(plain(40, 24, 0, 0, 0, 0))
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot((100, 70), Camera(zoom, (7, 5)), background=CHECKER)[..., :3]
    width, height = round(40 * zoom), round(24 * zoom)
    inside = np.zeros((70, 100), dtype=bool)
    inside[5 : 5 + height, 7 : 7 + width] = True
    assert (result[~inside] == [0, 0, 255]).all()
    frame = result[5 : 5 + height, 7 : 7 + width]
    assert np.array_equal(even_cells_red(frame), checker(width, height))


def test_checker_stays_even_where_the_frame_begins_between_pixels(renderer, shoot, sheet, plain):
    drawing = sheet(plain(40, 24, 0, 0, 0, 0))
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot((100, 70), Camera(1, (10.4, 6.4)), background=CHECKER)[6:30, 10:50, :3]
    assert np.array_equal(even_cells_red(result), checker(40, 24))


def test_checker_lies_behind_the_picture(renderer, shoot, sheet, plain):
    drawing = sheet(plain(64, 48, 200, 100, 50, 255))
    renderer.show(drawing, drawing.mesh.vertices)
    assert (shoot(background=CHECKER) == [200, 100, 50, 255]).all()


# --- mesh lines ---


def distance_to_lines(drawing, shape):
    """(h, w) distance of each pixel's center to the nearest mesh edge."""
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    points = np.stack([x, y], axis=-1)
    nearest = np.full(shape, np.inf)
    for start, end in drawing.mesh.vertices[drawing.mesh.edges]:
        along = end - start
        share = np.clip((points - start) @ along / (along @ along), 0, 1)[..., None]
        nearest = np.minimum(nearest, np.linalg.norm(points - start - share * along, axis=-1))
    return nearest


@pytest.mark.parametrize(("level", "sign"), [(255, -1), (0, 1)])
def test_mesh_lines_show_on_white_and_on_black(renderer, shoot, sheet, plain, level, sign):
    drawing = sheet(plain(96, 96, level, level, level, 255), cells=3)
    renderer.show(drawing, drawing.mesh.vertices)
    without, lines = shoot((96, 96)), shoot((96, 96), overlays=Overlays(mesh_lines=True))
    change = (lines - without)[..., :3].mean(axis=2) * sign
    distance = distance_to_lines(drawing, change.shape)
    near = distance < (0.75 if level == 255 else 1.5)
    assert np.median(change[near]) > 20
    assert np.array_equal(lines[distance > 2.1], without[distance > 2.1])
    assert (lines[..., 3] == 255).all()


def test_a_dense_mesh_seen_from_afar_does_not_cover_the_picture(renderer, shoot, sheet, plain):
    drawing = sheet(plain(400, 400, 255, 255, 255, 255), cells=100)
    renderer.show(drawing, drawing.mesh.vertices)
    result = shoot((100, 100), Camera(0.25), overlays=Overlays(mesh_lines=True))
    assert result[..., :3].min() > 128
    assert result[..., :3].max() < 255


def test_mesh_lines_follow_the_pose_and_survive_collapsed_edges(renderer, shoot, sheet, plain):
    drawing = sheet(plain(32, 32, 0, 0, 0, 0), cells=1)
    renderer.show(drawing, drawing.mesh.vertices * [1, 0] + [0, 16.5])
    rows = shoot((32, 32), background=WHITE, overlays=Overlays(mesh_lines=True))[..., 0].min(axis=1)
    assert rows[16] < 180
    assert (np.delete(rows, [14, 15, 16, 17, 18]) == 255).all()


# --- uploads ---


def test_positions_are_uploaded_only_when_they_are_another_array(renderer, shoot, sheet, noise):
    drawing = sheet(noise)
    pose = drawing.mesh.vertices.copy()
    renderer.show(drawing, pose)
    before = shoot()
    pose += 3  # against the rule that arrays are frozen, to see whether it is read again
    renderer.show(drawing, pose)
    assert np.array_equal(shoot(), before)
    renderer.show(drawing, pose.copy())
    assert not np.array_equal(shoot(), before)


def test_picture_is_uploaded_only_when_the_drawing_is_another(renderer, shoot, sheet, plain):
    drawing = sheet(plain(64, 48, 255, 0, 0, 255))
    pose = drawing.mesh.vertices
    renderer.show(drawing, pose)
    drawing.image.flags.writeable = True
    drawing.image[:] = (0, 255, 0, 255)
    renderer.show(drawing, pose.copy())
    assert (shoot() == [255, 0, 0, 255]).all()
    renderer.show(replace(drawing), pose)
    assert (shoot() == [0, 255, 0, 255]).all()


def test_a_new_drawing_in_the_same_pose_array_is_drawn(renderer, shoot, sheet, plain):
    first = sheet(plain(64, 48, 255, 0, 0, 255))
    renderer.show(first, first.mesh.vertices)
    second = replace(first, image=plain(64, 48, 0, 0, 255, 255))
    renderer.show(second, first.mesh.vertices)
    assert (shoot() == [0, 0, 255, 255]).all()


def test_positions_must_fit_the_drawing(renderer, shoot, sheet, noise):
    drawing = sheet(noise)
    renderer.show(drawing, drawing.mesh.vertices)
    before = shoot()
    with pytest.raises(InputError, match=r"positions: expected shape \(25, 2\), got \(24, 2\)"):
        renderer.show(drawing, drawing.mesh.vertices[1:])
    assert np.array_equal(shoot(), before)


def test_a_strided_float64_view_is_uploaded_correctly(renderer, shoot, sheet, noise):
    drawing = sheet(noise)
    renderer.show(drawing, drawing.mesh.vertices)
    before = shoot()
    wide = np.zeros((25, 4))
    wide[:, ::2] = drawing.mesh.vertices
    renderer.show(drawing, wide[:, ::2])
    assert np.array_equal(shoot(), before)


# --- limits and memory ---


@pytest.mark.parametrize(("limit", "size"), [(16, (64, 48)), (50, (64, 48)), (16, (600, 2)), (16, (2, 600))])
def test_a_picture_beyond_the_texture_limit_is_scaled_down(
    ctx, renderer, shoot, sheet, plain, limit, size, monkeypatch
):
    sizes, make = [], ctx.texture
    monkeypatch.setattr(
        ctx, "texture", lambda size, *rest, **kw: sizes.append(size) or make(size, *rest, **kw)
    )
    drawing = sheet(plain(*size, 10, 20, 30, 255))
    renderer.max_texture_size = limit
    renderer.show(drawing, drawing.mesh.vertices)
    assert max(map(max, sizes)) == limit
    assert (shoot(size) == [10, 20, 30, 255]).all()


def test_a_picture_beyond_the_texture_limit_is_averaged(renderer, shoot, sheet, plain):
    stripes = plain(64, 48, 200, 0, 0, 255)
    stripes[:, ::2] = (0, 100, 0, 255)
    drawing = sheet(stripes)
    renderer.max_texture_size = 32
    renderer.show(drawing, drawing.mesh.vertices)
    assert (np.abs(shoot() - [100, 50, 0, 255]) <= 1).all()


def test_every_object_is_released(ctx, sheet, noise, disc, monkeypatch):
    made = []

    def recorded(create):
        return lambda *args, **kw: made.append(create(*args, **kw)) or made[-1]

    for name in ("buffer", "texture", "framebuffer", "program", "vertex_array"):
        monkeypatch.setattr(ctx, name, recorded(getattr(ctx, name)))
    renderer = Renderer(ctx)
    for drawing in (sheet(noise), sheet(disc)):
        renderer.show(drawing, drawing.mesh.vertices)
    alive = [item for item in made if not isinstance(item.mglo, moderngl.InvalidObject)]
    assert len(made) > len(alive) > 0
    renderer.release()
    assert all(isinstance(item.mglo, moderngl.InvalidObject) for item in made)
