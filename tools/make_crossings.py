"""Draws the pictures of docs/images/crossings: poses that overlap themselves, before and after.

Run from the project's root: python tools/make_crossings.py [names]
Left: faces in the fixed order of the mesh. Right: limbs cross as wholes; alone if both are equal. Scenes on
drawings of ../shared/data are skipped without that folder.
"""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from akap_editor.editor.document.crossings import overlaps_of
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.edits import OrderLimb, SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.io.images import read_image
from akap_editor.render.offscreen import OffscreenRenderer

BUNDLED, SHARED = Path("assets/drawings"), Path("../shared/data")
OUTPUT = Path("docs/images/crossings")
HEIGHT = 520  # pixels
GAP = 12  # pixels between the two pictures of a pair

Point = tuple[float, float]


def line(start: Point, end: Point, steps: int = 30) -> list[Point]:
    """Points from ``start`` (excluded) to ``end``."""
    return [
        (start[0] + (end[0] - start[0]) * k / steps, start[1] + (end[1] - start[1]) * k / steps)
        for k in range(1, steps + 1)
    ]


def arc(start: Point, center: Point, degrees: float, steps: int = 60) -> list[Point]:
    """Points of an arc around ``center``, clockwise on the screen for positive degrees."""
    arm = complex(*start) - complex(*center)
    points = (
        complex(*center) + arm * np.exp(1j * np.radians(degrees) * k / steps) for k in range(1, steps + 1)
    )
    return [(float(point.real), float(point.imag)) for point in points]


@dataclass(frozen=True)
class Drag:
    """A pin at ``start``, a place of the rest pose, is dragged along a path.

    asks: in the end its limb is brought to the front (True) or sent to the back (False).
    """

    start: Point
    path: Sequence[Point]
    asks: bool | None = None


@dataclass(frozen=True)
class Scene:
    """A drawing, its pins and what is dragged.

    box: left, top, right and bottom in pixels of what is shown, by default all.
    """

    image: Path
    pins: Sequence[Point]
    drags: Sequence[Drag]
    box: tuple[int, int, int, int] | None = None


SCENES = {
    "alien": Scene(
        BUNDLED / "alien.png",
        [(386, 919), (675, 919), (515, 714), (485, 380)],
        [
            Drag((143, 653), line((143, 653), (606, 502))),
            Drag((850, 456), line((850, 456), (454, 623))),
        ],
    ),
    "elbow": Scene(
        BUNDLED / "alien.png",
        [(386, 919), (675, 919), (515, 714), (485, 380), (640, 605)],
        [
            Drag(
                (850, 456),
                line((850, 456), (900, 640), 20)
                + line((900, 640), (760, 760), 20)
                + line((760, 760), (640, 620), 20),
            )
        ],
        (590, 480, 850, 720),
    ),
    "dancer": Scene(
        SHARED / "noto" / "dancer.png",
        [(155, 482), (334, 482), (264, 272), (252, 202), (233, 117)],
        [
            Drag((159, 280), line((159, 280), (279, 241))),
            Drag((353, 39), arc((353, 39), (291, 149), 180)),
        ],
    ),
    "gingerbread": Scene(
        BUNDLED / "gingerbread.png",
        [(315, 901), (744, 901), (473, 586), (439, 135)],
        [
            Drag((90, 530), line((90, 530), (690, 560))),
            Drag((879, 214), line((879, 214), (900, 520), 20) + line((900, 520), (330, 520))),
        ],
    ),
    "gopher": Scene(
        SHARED / "gophers" / "gopher-42.png",
        [(2107, 3966), (2107, 1262), (3100, 2960)],
        [
            Drag((4135, 2050), arc((4135, 2050), (3100, 2960), -75) + line((2480, 1750), (2219, 2163))),
            Drag((541, 3763), line((541, 3763), (2107, 3290))),
        ],
    ),
    "raptor": Scene(
        BUNDLED / "raptor.png",
        [(364, 744), (637, 744), (464, 421), (835, 223)],
        [Drag((60, 205), line((60, 205), (330, 120), 20) + line((330, 120), (560, 560)))],
    ),
    "elephant": Scene(
        BUNDLED / "elephant.png",
        [(135, 800), (620, 800), (721, 383), (250, 350)],
        [
            Drag((928, 169), arc((928, 169), (721, 330), -75) + line((588, 60), (420, 330))),
            Drag((50, 290), line((50, 290), (330, 520))),
        ],
    ),
}


def bend(scene: Scene, vertices: int = 2000) -> Session:
    """A session in which the scene was played."""
    session = Session(new_document(make_drawing(read_image(scene.image), vertices=vertices)))
    mesh = session.drawing.mesh
    session.begin("Add Pins")
    for place in scene.pins:
        add_pin(session, place)
    session.commit()
    for drag in scene.drags:
        start = mesh.evaluate(mesh.locate([drag.start]), session.state.positions)[0]
        session.begin("Drag Pin")
        pin = nearest_pin(session, start)
        for x, y in drag.path:
            session.apply(SetTargets({pin: (x, y)}))
            session.step()
        session.settle()
        if drag.asks is not None:
            session.apply(OrderLimb([pin], drag.asks))
        session.commit()
    return session


def trefoil(places: np.ndarray, share: float, length: float) -> np.ndarray:
    """Points (k, 2) of the axis of a rope, at ``places`` (k,) from 0 to 1, on its way to a trefoil, at 1."""
    t = np.linspace(0.12, 2 * np.pi - 0.12, 4000)
    x, y = np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t)
    heading = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    steps = np.hypot(np.diff(x), np.diff(y))
    arc_length = np.concatenate([[0], np.cumsum(steps)])
    angles = heading.mean() + share * (heading[1:] - heading.mean())
    scale = length / arc_length[-1]
    along = [np.concatenate([[0], np.cumsum(turn(angles) * steps)]) * scale for turn in (np.cos, np.sin)]
    return np.stack([np.interp(places * arc_length[-1], arc_length, axis) for axis in along], axis=1)


def tie_rope(pin_count: int = 28, steps: int = 160) -> Session:
    """A session in which the rope is tied into a trefoil that passes over and under in turn."""
    session = Session(new_document(make_drawing(read_image(BUNDLED / "rope.png"), vertices=2500)))
    places = np.linspace(0.02, 0.98, pin_count)
    width, height = session.drawing.size
    session.begin("Add Pins")
    pins = [add_pin(session, (float(place) * width, height / 2)) for place in places]
    session.commit()
    session.begin("Drag Pins")
    for share in np.linspace(0, 1, steps + 1)[1:]:
        points = trefoil(places, float(share), width).tolist()
        session.apply(SetTargets({pin: (x, y) for pin, (x, y) in zip(pins, points, strict=True) if pin}))
        session.step()
    session.settle()
    # Every second passage along the rope goes over.
    state, mesh = session.state, session.drawing.mesh
    overlaps = overlaps_of(mesh, state.pins, state.positions, state.crossings)
    middles = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] / width
    passages = sorted(
        float(middles[faces[overlaps.pairs.regions == region]].mean())
        for region in range(overlaps.pairs.region_count)
        for faces in (overlaps.pairs.first, overlaps.pairs.second)
    )
    for passage in passages[::2]:
        session.apply(OrderLimb([int(np.argmin(np.abs(places - passage))) + 1], True))
    session.commit()
    return session


def nearest_pin(session: Session, place: np.ndarray) -> int:
    """The pin at a place of the pose, added if there is none."""
    pins = session.state.pins
    distances = np.linalg.norm(session.pin_positions() - place, axis=1)
    if len(pins) and distances.min() < 8:
        return pins[int(np.argmin(distances))].id
    pin = add_pin(session, (float(place[0]), float(place[1])))
    assert pin is not None, f"expected a place on the drawing, got {place}"
    return pin


def pictures(
    session: Session, box: tuple[int, int, int, int] | None = None, height: int = HEIGHT
) -> Iterator[np.ndarray]:
    """The pose in the order of the mesh, and with its crossings, (h, w, 3) uint8 each, on white.

    box: see `Scene`.
    """
    pose, drawing = session.state.positions, session.drawing
    if box is None:
        low, high = pose.min(axis=0) - 8, pose.max(axis=0) + 8
        (left, top), (right, bottom) = np.floor(low).astype(int).tolist(), np.ceil(high).astype(int).tolist()
        box = left, top, right, bottom
    scale = height / (box[3] - box[1])
    with OffscreenRenderer() as renderer:
        for order in (None, session.document.draw_order):
            yield renderer.render(drawing, pose, box, scale, (1.0, 1.0, 1.0), order)[..., :3]


def main() -> None:
    """Draw the scenes named on the command line, by default all."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[1:] or (*SCENES, "rope"):
        if name in SCENES and not SCENES[name].image.exists():
            print(f"{name}: skipped, {SCENES[name].image} is absent")
            continue
        is_rope = name == "rope"
        before, after = pictures(tie_rope()) if is_rope else pictures(bend(SCENES[name]), SCENES[name].box)
        gap = np.full((len(before), GAP, 3), 255, dtype=np.uint8)
        shown = after if np.array_equal(before, after) else np.hstack([before, gap, after])
        picture = Image.fromarray(shown).quantize(255, dither=Image.Dither.NONE)
        picture.save(OUTPUT / f"{name}.png", optimize=True)
        print(OUTPUT / f"{name}.png")


if __name__ == "__main__":
    main()
