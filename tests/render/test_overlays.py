"""What is shown over and behind a drawing, probed pixel by pixel; order of faces."""

import numpy as np
import pytest

from akap_editor.editor.camera import Camera
from akap_editor.editor.document.drawing import Drawing
from akap_editor.geometry.mesh import TriMesh
from akap_editor.render.overlays import FaceColors, LineSegments, Overlays, Reference
from akap_editor.render.renderer import TRANSPARENT, Background

BLACK = Background((0, 0, 0))
SCALE = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


@pytest.fixture
def shoot(ctx, renderer):
    """Draws what the renderer shows and reads (h, w, 4) int back, top row first, premultiplied."""

    def read(size=(64, 64), background=BLACK, **overlays):
        target = ctx.simple_framebuffer(size)
        with ctx.scope(target):
            renderer.draw(
                target, size, Camera().view(*size), background=background, overlays=Overlays(**overlays)
            )
        data = target.read(components=4, alignment=1)
        target.release()
        return np.frombuffer(data, dtype=np.uint8).reshape(size[1], size[0], 4)[::-1].astype(int)

    return read


@pytest.fixture
def white_sheet(renderer, sheet, plain):
    drawing = sheet(plain(64, 64, 255, 255, 255, 255), cells=8)
    renderer.show(drawing, drawing.mesh.vertices)
    return drawing


def face_colors(drawing, shot):
    """(m, 3): the colors in the middles of the faces."""
    x, y = drawing.mesh.vertices[drawing.mesh.faces].mean(axis=1).astype(int).T
    return shot[y, x, :3]


@pytest.mark.parametrize("reordered", [False, True])
def test_each_face_has_the_color_of_its_level(renderer, white_sheet, shoot, reordered):
    count = len(white_sheet.mesh.faces)
    order = np.random.default_rng(3).permutation(count) if reordered else None
    renderer.show(white_sheet, white_sheet.mesh.vertices, order)
    levels = np.linspace(0, 1, count)
    colors = face_colors(white_sheet, shoot(face_colors=FaceColors(levels, SCALE)))
    expected = 255 * ((1 - levels)[:, None] * SCALE[0] + levels[:, None] * SCALE[1])
    assert np.abs(colors - expected).max() <= 2


def test_faces_off_the_scale_stand_out(white_sheet, shoot):
    levels = np.full(len(white_sheet.mesh.faces), 0.5)
    levels[5], levels[9] = -1.0, np.nan
    colors = face_colors(white_sheet, shoot(face_colors=FaceColors(levels, np.array([[0.5] * 3, [0.5] * 3]))))
    assert (np.ptp(colors, axis=1) > 200).nonzero()[0].tolist() == [5, 9]


def test_heat_keeps_the_alpha_of_the_picture(renderer, sheet, noise, shoot):
    drawing = sheet(noise)
    renderer.show(drawing, drawing.mesh.vertices)
    shot = shoot((64, 48), TRANSPARENT, face_colors=FaceColors(np.zeros(len(drawing.mesh.faces)), SCALE))
    np.testing.assert_array_equal(shot[..., 3], noise[..., 3])
    assert (shot[..., :3] <= shot[..., 3:] + 1).all()


def test_a_new_heat_replaces_the_old_one(white_sheet, shoot):
    count = len(white_sheet.mesh.faces)
    for level, channel in ((0.0, 2), (1.0, 0), (0.0, 2)):
        colors = face_colors(white_sheet, shoot(face_colors=FaceColors(np.full(count, level), SCALE)))
        assert (colors.argmax(axis=1) == channel).all()


def test_strokes_are_as_wide_as_asked_and_lie_in_order(white_sheet, shoot):
    across = np.array([[[8.0, 32.0], [56.0, 32.0]]])
    down = np.array([[[32.0, 8.0], [32.0, 56.0]]])
    red, green = LineSegments(across, (1, 0, 0, 1), 6.0), LineSegments(down, (0, 1, 0, 1), 2.0)
    shot = shoot(lines=(red, green))
    column = shot[:, 20, 1] < 128
    assert column.nonzero()[0].tolist() == list(range(29, 35))
    row = shot[16, :, 0] < 128
    assert row.nonzero()[0].tolist() == [31, 32]
    assert shot[32, 32, :3].tolist() == [0, 255, 0]
    assert (shoot(lines=(LineSegments(np.zeros((0, 2, 2)), (1, 0, 0, 1), 2.0),)) == 255).all()


def test_many_strokes_after_few(white_sheet, shoot):
    shoot(lines=(LineSegments(np.array([[[1.0, 1.0], [9.0, 1.0]]]), (1, 0, 0, 1), 1.0),))
    y = np.arange(64) + 0.5
    rows = np.stack([np.stack([0 * y, y], axis=1), np.stack([0 * y + 64, y], axis=1)], axis=1)
    assert (shoot(lines=(LineSegments(rows, (0, 0, 1, 1), 1.0),))[..., :3] == (0, 0, 255)).all()


def test_the_rest_pose_shines_through_behind_the_drawing(renderer, white_sheet, shoot):
    renderer.show(white_sheet, white_sheet.mesh.vertices + np.array([32, 0]))
    shot = shoot(rest_pose_opacity=0.25)
    assert np.abs(shot[:, :31, :3] - 64).max() <= 1
    assert (shot[:, 33:, :3] == 255).all()
    assert (shoot()[:, :31, :3] == 0).all()


def test_a_reference_picture_lies_behind_fitted_into_the_frame(renderer, white_sheet, shoot, plain):
    renderer.show(white_sheet, white_sheet.mesh.vertices * [0.25, 1] + [24, 0])
    first = Reference(plain(20, 10, 255, 0, 0, 255), 0.5)
    shot = shoot(reference=first)
    assert np.abs(shot[17:47, 1:23, :3] - (128, 0, 0)).max() <= 1
    assert (shot[:15, :23] == (0, 0, 0, 255)).all()
    assert (shot[49:, :23] == (0, 0, 0, 255)).all()
    assert (shot[:, 25:39, :3] == 255).all()
    second = shoot(reference=Reference(plain(10, 10, 0, 255, 0, 255)))
    assert (second[:, 1:23, :3] == (0, 255, 0)).all()
    assert (shoot()[:, :23, :3] == 0).all()


def test_faces_are_drawn_in_the_order_given(renderer, shoot, plain):
    """Two squares, red and half-transparent green, that lie on one another in the pose."""
    image = plain(64, 32, 255, 0, 0, 255)
    image[:, 32:] = (0, 255, 0, 128)
    corners = np.array([[0, 0], [32, 0], [32, 32], [0, 32]], dtype=float)
    rest = np.concatenate([corners, corners + np.array([32.5, 0])])
    rest[4:, 0] = rest[4:, 0].clip(33, 64)
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    drawing = Drawing(image, TriMesh(rest, faces), (rest / [64, 32]).astype(np.float32))
    pose = np.concatenate([corners, corners])
    renderer.show(drawing, pose)
    over = shoot()[16, 16, :3]
    renderer.show(drawing, pose, np.array([2, 3, 0, 1]))
    under = shoot()[16, 16, :3]
    renderer.show(drawing, pose)
    again = shoot()[16, 16, :3]
    np.testing.assert_allclose(over, (127, 128, 0), atol=2)
    np.testing.assert_allclose(under, (255, 0, 0), atol=1)
    assert (again == over).all()


# -- color scales -------------------------------------------------------------------------------------------
