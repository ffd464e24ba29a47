"""Framing: the boxes of the three crops, and the sizes of their images."""

import numpy as np
import pytest

from akap_editor.editor.document.drawing import Drawing
from akap_editor.editor.framing import (
    CROPS,
    MAX_SIZE,
    crop_box,
    fitted_box,
    frame_box,
    output_size,
    union_of_boxes,
)
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh


@pytest.fixture
def drawing() -> Drawing:
    """A square from 10 to 20 in a picture of 40 × 30 pixels."""
    vertices = np.array([[10.0, 10.0], [20.0, 10.0], [20.0, 20.0], [10.0, 20.0]])
    mesh = TriMesh(vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    return Drawing(np.full((30, 40, 4), 255, dtype=np.uint8), mesh, (vertices / [40, 30]).astype(np.float32))


def test_crop_at_rest(drawing):
    rest = drawing.mesh.vertices
    assert [crop_box(drawing, rest, crop) for crop in CROPS] == [
        (0, 0, 40, 30),
        (0, 0, 40, 30),
        (10, 10, 20, 20),
    ]


def test_only_the_frame_cuts_a_pose_off(drawing):
    pose = drawing.mesh.vertices + np.array([-15.5, 3.25])
    assert crop_box(drawing, pose, "none") == frame_box(drawing, [pose]) == (-6, 0, 40, 30)
    assert crop_box(drawing, pose, "frame") == (0, 0, 40, 30)
    assert crop_box(drawing, pose, "pose") == (-6, 13, 5, 24)


def test_rounding_noise_adds_no_row(drawing):
    rest = drawing.mesh.vertices
    assert (
        crop_box(drawing, rest + 1e-9, "pose") == crop_box(drawing, rest - 1e-9, "pose") == (10, 10, 20, 20)
    )


def test_a_union_holds_all_boxes():
    assert union_of_boxes([(0, 2, 5, 6)]) == (0, 2, 5, 6)
    assert union_of_boxes([(0, 2, 5, 6), (-3, 4, 2, 9)]) == (-3, 2, 5, 9)


def test_bad_crops_and_poses_are_refused(drawing):
    with pytest.raises(InputError, match=r"crop: expected one of none, frame, pose, got 'tight'"):
        crop_box(drawing, drawing.mesh.vertices, "tight")
    with pytest.raises(InputError, match=r"pose: expected shape \(4, 2\), got \(3, 2\)"):
        crop_box(drawing, drawing.mesh.vertices[:3], "pose")


@pytest.mark.parametrize(
    ("box", "scale", "size"),
    [
        ((0, 0, 40, 30), 1.0, (40, 30)),
        ((-6, 0, 40, 30), 0.5, (23, 15)),
        ((-6, 0, 40, 30), 0.1, (5, 3)),
        ((0, 0, 1, 1), 1e-9, (1, 1)),
        ((0, 0, 50, 50), 1.1, (55, 55)),
        ((0, 0, 1024, 1), MAX_SIZE / 1024, (MAX_SIZE, 8)),
    ],
)
def test_size_in_pixels(box, scale, size):
    assert output_size(box, scale) == size


@pytest.mark.parametrize(
    ("box", "scale", "message"),
    [
        ((0, 0, 40, 30), 0.0, "scale: expected a positive number, got 0"),
        ((0, 0, 40, 30), float("nan"), "scale: expected a positive number"),
        ((5, 0, 5, 30), 1.0, "box: expected x0 < x1"),
        ((0, 0, 1, MAX_SIZE + 1), 1.0, "picture size: expected at most 8192×8192 pixels, got 1×8193"),
    ],
)
def test_bad_sizes_are_refused(box, scale, message):
    with pytest.raises(InputError, match=message):
        output_size(box, scale)


@pytest.mark.parametrize("is_even", [False, True])
@pytest.mark.parametrize("longest", [16, 17, 99, 640, 641])
@pytest.mark.parametrize("box", [(0, 0, 100, 80), (0, 0, 640, 481), (-3, 5, 638, 480), (0, 0, 1777, 900)])
def test_pictures_fit_the_longest_side_and_are_never_enlarged(box, longest, is_even):
    shown, scale = fitted_box(box, longest, is_even)
    size = output_size(shown, scale)
    width, height = box[2] - box[0], box[3] - box[1]
    assert scale <= 1
    assert max(size) <= longest
    assert max(size) >= min(longest, max(width, height)) - is_even
    assert shown[:2] == box[:2]
    assert shown[2] >= box[2]
    assert shown[3] >= box[3]
    if is_even:
        assert [side % 2 for side in size] == [0, 0]
    else:
        assert shown == box
