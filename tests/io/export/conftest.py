"""A drawing with a hole and two parts, bent, with pins; and a painter that needs no OpenGL."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.pin import Pin
from akap_editor.io.export import ExportOptions, export


def picture() -> NDArray[np.uint8]:
    """(90, 140, 4): a ring and a disc, soft at the rim, each pixel of a color of its own."""
    y, x = np.mgrid[0:90, 0:140] + 0.5
    ring = np.minimum(38 - np.hypot(x - 45, y - 45), np.hypot(x - 45, y - 45) - 16)
    disc = 18 - np.hypot(x - 112, y - 50)
    image = np.zeros((90, 140, 4), dtype=np.uint8)
    image[..., 3] = np.rint(255 * np.clip(np.maximum(ring, disc) / 2, 0, 1))
    image[..., 0], image[..., 1], image[..., 2] = 80 + x, 250 - 2 * y, 40
    image[image[..., 3] == 0] = 0
    return image


@pytest.fixture(scope="session")
def drawn() -> Document:
    """The drawing at rest."""
    return new_document(make_drawing(picture(), vertices=250, name="ring & disc"))


@pytest.fixture
def bent(drawn: Document) -> Document:
    """Curved and moved partly out of its frame, without overlaps; two pins."""
    rest = drawn.drawing.mesh.vertices
    pose = rest + np.stack([0.3 * rest[:, 1] - 40, 12 * np.sin(rest[:, 0] / 30)], axis=1)
    pins = Pin(1, 0, [0.2, 0.3, 0.5], [1.5, 2.5]), Pin(4, 7, [1.0, 0.0, 0.0], [30.0, -4.0])
    return drawn.with_state(replace(drawn.state, positions=pose, pins=pins))


@pytest.fixture(scope="session")
def keyed(drawn: Document) -> Document:
    """Keyframes: the disc moves over the ring, is held there, then behind it, and back; rest is the pose."""
    mesh = drawn.drawing.mesh
    is_disc = mesh.component == mesh.component[np.argmax(mesh.vertices[:, 0])]
    over = mesh.vertices - np.where(is_disc[:, None], [40.0, 5.0], [0.0, 0.0])
    low, high = overlaps_of(mesh, (), over, drawn.state.crossings).low_and_high
    behind = np.array([[low[0], high[0]]], dtype=np.int32)
    bent = mesh.vertices + np.stack([0 * mesh.vertices[:, 1], 9 * np.sin(mesh.vertices[:, 0] / 30)], axis=1)
    animation = Animation(
        (
            Keyframe(0.0, mesh.vertices),
            Keyframe(0.4, over, ease="hold"),
            Keyframe(0.8, over, crossings=behind, ease="in-out"),
            Keyframe(1.2, bent),
        ),
        ease="smooth",
    )
    return drawn.with_state(replace(drawn.state, animation=animation))


class FlatPainter:
    """Paints rectangles of one color: what was asked for is what is tested."""

    def __init__(self) -> None:
        self.asked: list[tuple] = []

    def render(self, drawing, positions, box, scale, background, order):
        self.asked.append((positions, box, scale, background, order))
        height, width = int((box[3] - box[1]) * scale), int((box[2] - box[0]) * scale)
        return np.full((height, width, 4), 200, dtype=np.uint8)


@pytest.fixture
def painter() -> FlatPainter:
    return FlatPainter()


@pytest.fixture
def exported(tmp_path: Path, painter: FlatPainter) -> Callable[..., Path]:
    """Exports a document to an empty folder; the file named."""

    def write(document: Document, name: str, **options: object) -> Path:
        return export(document, tmp_path / name, ExportOptions(**options), painter)[-1]

    return write
