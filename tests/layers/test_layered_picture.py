"""Values of layers, and cutting them to what is visible."""

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.layers.layered_picture import Layer, LayeredPicture, LayerGroup, trimmed
from tests.support.layered_files import filled

RED = filled(2, 1, 255, 0, 0)


def test_a_layer_knows_its_place_and_whether_it_is_shown():
    head = LayerGroup("head")
    eye = Layer("eye", RED, (-1, 3), (head,))
    assert eye.path == ("head", "eye")
    assert eye.box == (-1, 3, 1, 4)
    assert eye.is_shown
    hidden = Layer("eye", RED, groups=(head, LayerGroup("face", visible=False)))
    assert not hidden.is_shown


def test_pictures_are_copied_and_read_only():
    pixels = RED.copy()
    layer = Layer("a", pixels)
    pixels[:] = 0
    assert layer.picture[0, 0].tolist() == [255, 0, 0, 255]
    assert not layer.picture.flags.writeable


def test_names_can_be_shown():
    assert Layer("a\u202e\udce9\n", RED).name == "a\\u202e\\xe9\\n"
    assert len(LayerGroup("x" * 999).name) == 255


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Layer("a", RED[..., :3]), r"picture: expected shape \(h, w, 4\) uint8"),
        (lambda: Layer("a", RED, opacity=1.5), "opacity"),
        (lambda: Layer("a", RED, blend="overlay"), "blend"),
        (lambda: Layer("a", RED, blend="pass through"), "blend"),
        (lambda: LayerGroup("a", blend="dissolve"), "blend"),
        (lambda: LayeredPicture((3, 3), ()), "expected a picture with layers"),
        (lambda: LayeredPicture((0, 3), (Layer("a", RED),)), "size: expected at least 1 x 1 pixels"),
    ],
)
def test_other_values_are_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_trimming_cuts_transparent_margins():
    picture = np.zeros((5, 7, 4), np.uint8)
    picture[..., 0] = 9
    assert trimmed(picture, (3, 4)) is None
    picture[2:4, 1:6, 3] = 1
    cut, offset = trimmed(picture, (3, -4))
    assert cut.tolist() == picture[2:4, 1:6].tolist()
    assert offset == (4, -2)
