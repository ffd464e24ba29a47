"""A small puppet in layers: body, arm, head, both eyes on one layer, and a hidden hat."""

from functools import cache

import numpy as np

from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.geometry.joints import MeshJoints
from akap_editor.layers.layered_picture import Layer, LayeredPicture, LayerGroup
from tests.support.layered_files import filled

SIZE = 160, 200


def disc(radius: int, *color: int) -> np.ndarray:
    """A disc of one color with a soft rim, (2 radius, 2 radius, 4) uint8."""
    y, x = np.mgrid[: 2 * radius, : 2 * radius] + 0.5 - radius
    picture = filled(2 * radius, 2 * radius, *color)
    picture[..., 3] = np.clip(255 * (radius - np.hypot(x, y)), 0, 255).astype(np.uint8)
    return picture


def eyes() -> np.ndarray:
    """Two eyes beside each other, (16, 44, 4)."""
    picture = np.zeros((16, 44, 4), np.uint8)
    picture[:, :16], picture[:, 28:] = disc(8, 20, 20, 60), disc(8, 20, 20, 60)
    return picture


def puppet_layers() -> LayeredPicture:
    """The layers from the bottom to the top. The arm reaches over the body, the head over its neck."""
    head = LayerGroup("head")
    return LayeredPicture(
        SIZE,
        (
            Layer("body", filled(40, 90, 40, 160, 90), (60, 80)),
            Layer("arm", filled(70, 18, 200, 120, 40), (85, 110)),
            Layer("skull", disc(36, 90, 200, 120), (44, 18), (head,)),
            Layer("eyes", eyes(), (58, 46), (head,)),
            Layer("hat", filled(50, 20, 120, 30, 30), (55, 6), (head,), visible=False),
        ),
    )


BODY, ARM, SKULL, EYES, HAT = range(5)


@cache
def puppet(vertices: int = 400) -> Drawing:
    """The drawing of `puppet_layers`."""
    return make_drawing(layers=puppet_layers(), vertices=vertices, name="puppet")


def joints(*rows: tuple[int, int, tuple[float, float], bool]) -> MeshJoints:
    """Joints of `puppet` from (layer, layer, place, is_weld)."""
    mesh = puppet().mesh
    ends = [mesh.locate([place, place], layers=[a, b]) for a, b, place, _ in rows]
    return MeshJoints(
        np.array([end.faces for end in ends]),
        np.array([end.weights for end in ends]),
        np.array([row[3] for row in rows]),
    )
