"""A limb that is folded shut shows its sheets one over the other, and no other line, light or dark."""

import numpy as np
import pytest
import shapely
from PIL import Image, ImageDraw
from scipy.ndimage import label, map_coordinates, maximum_filter

from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.io.export.drawn_faces import DrawnFaces, drawn_faces
from akap_editor.render.offscreen import OffscreenRenderer
from tests.support.meshers import needs_triangle

WIDTH, HEIGHT = 420, 64
SCALE = 2


def arm() -> np.ndarray:
    """An orange arm with a dark outline, soft at its rim, (h, w, 4) uint8."""
    large = Image.new("RGBA", (4 * WIDTH, 4 * HEIGHT))
    box = 16, 16, 4 * WIDTH - 16, 4 * HEIGHT - 16
    ImageDraw.Draw(large).rounded_rectangle(box, 100, (240, 150, 60, 255), (30, 20, 40, 255), 20)
    return np.asarray(large.resize((WIDTH, HEIGHT), Image.Resampling.BOX))


def folded(elbow: float) -> Session:
    """The arm folded by 172° around an elbow of a length in pixels."""
    session = Session(new_document(make_drawing(arm(), vertices=250)))
    session.begin("Fold")
    for place in ((20, 32), (100, 32), (205 - elbow / 2, 16), (205 - elbow / 2, 48)):
        add_pin(session, place)
    places = [205 + elbow / 2 + 16j, 205 + elbow / 2 + 48j, 300 + 32j, 400 + 32j]
    pins = [add_pin(session, (place.real, place.imag)) for place in places]
    center = 205 + 50j
    for angle in np.linspace(0, np.radians(172), 25)[1:]:
        turned = [center + (place - center) * np.exp(1j * angle) for place in places]
        session.apply(SetTargets({pin: (z.real, z.imag) for pin, z in zip(pins, turned, strict=True)}))
        session.step()
    session.settle()
    return session


def composed(image: np.ndarray, drawn: DrawnFaces, box: tuple[int, int, int, int]) -> np.ndarray:
    """The faces drawn one by one over white, (h, w, 3) from 0 to 255: each pixel's center, linear texture."""
    width, height = SCALE * (box[2] - box[0]), SCALE * (box[3] - box[1])
    result = np.full((height, width, 3), 255.0)
    premultiplied = image.astype(float)
    premultiplied[..., :3] *= premultiplied[..., 3:] / 255
    for face in drawn.faces:
        corners = SCALE * (drawn.pose[face] - box[:2])
        (x0, y0), (x1, y1) = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
        x, y = np.meshgrid(np.arange(int(x0), int(x1)), np.arange(int(y0), int(y1)))
        matrix = np.linalg.inv(np.stack([corners[1] - corners[0], corners[2] - corners[0]], axis=1))
        b, c = matrix @ (np.stack([x.ravel(), y.ravel()]) + 0.5 - corners[0][:, None])
        inside = (b >= 0) & (c >= 0) & (b + c <= 1)
        u, v = drawn.uv[face].T @ np.stack([1 - b - c, b, c])[:, inside]
        at = [v * HEIGHT - 0.5, u * WIDTH - 0.5]
        color = np.stack(
            [map_coordinates(premultiplied[..., k], at, order=1, mode="nearest") for k in range(4)]
        )
        pixels = y.ravel()[inside], x.ravel()[inside]
        result[pixels] = color[:3].T + (1 - color[3, :, None] / 255) * result[pixels]
    return result


@pytest.mark.parametrize("elbow", [40.0, 130.0])
def test_a_limb_folded_shut_shows_its_sheets_and_nothing_else(elbow: float) -> None:
    session = folded(elbow)
    drawing, pose, order = session.drawing, session.state.positions, session.document.draw_order
    assert order is not None, "the arm overlaps itself"
    (left, top), (right, bottom) = np.floor(pose.min(axis=0) - 4), np.ceil(pose.max(axis=0) + 4)
    box = int(left), int(top), int(right), int(bottom)
    with OffscreenRenderer(is_smooth=False) as renderer:  # as the mesh itself, which is compared
        shown = renderer.render(drawing, pose, box, SCALE, (1.0, 1.0, 1.0), order)[..., :3].astype(float)
    expected = composed(drawing.image, drawn_faces(drawing, pose, order), box)
    assert np.abs(shown - expected).max() < 90, "a line would differ by 150 or more"


def winding(curve: np.ndarray, points: np.ndarray) -> np.ndarray:
    """How often a closed curve (q, 2) goes around each of some points (p, 2)."""
    spokes = (curve @ [1, 1j])[None] - (points @ [1, 1j])[:, None]
    return np.rint(np.angle(np.roll(spokes, -1, axis=1) / spokes).sum(axis=1) / (2 * np.pi))


@needs_triangle
@pytest.mark.parametrize("elbow", [40.0, 130.0])
def test_a_gap_in_a_fold_is_one_of_the_bent_outline(elbow: float) -> None:
    """Its crease is a loop of the outline, and it is transparent inside that loop and nowhere else."""
    session = folded(elbow)
    mesh, pose = session.drawing.mesh, session.state.positions
    (left, top), (right, bottom) = np.floor(pose.min(axis=0) - 4), np.ceil(pose.max(axis=0) + 4)
    box = int(left), int(top), int(right), int(bottom)
    with OffscreenRenderer(is_smooth=False) as renderer:  # as the mesh itself, which is compared
        shown = renderer.render(session.drawing, pose, box, SCALE, None, session.document.draw_order)
    is_clear = shown[..., 3] < 128
    parts, count = label(is_clear)
    assert count > 1, "the fold encloses a gap"
    is_gap = is_clear & (parts != parts[0, 0])
    rounded = shapely.box(29, 29, WIDTH - 29, HEIGHT - 29).buffer(25, quad_segs=16).exterior
    outline = mesh.evaluate(mesh.locate(shapely.get_coordinates(rounded.segmentize(2.0))[:-1]), pose)
    y, x = np.nonzero(maximum_filter(is_gap, 25))
    pixels = np.stack([x, y], axis=1).astype(float) / SCALE + 0.5 / SCALE + [left, top]
    is_outside = winding(outline, pixels) == 0
    is_inner = shapely.distance(shapely.LinearRing(outline), shapely.points(pixels)) > 0.5
    assert (is_clear[y, x] == is_outside)[is_inner].all()
    assert (is_gap[y, x] & is_outside).sum() > 0.9 * is_gap.sum()
