"""Records the paper's experiments; writes the pictures and tables of docs/experiments.md.

Run from the project's root: python tools/make_experiments.py
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from akap_editor.cli.replay import settings_change
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.framing import frame_box
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import Recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.geometry.distortion import distortion
from akap_editor.geometry.mesh import signed_areas
from akap_editor.io.akap.recording import read_recording, recorded_drawing, write_recording
from akap_editor.io.images import read_image, write_png
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource

RECORDINGS = resource("assets", "recordings")
PAGE, PICTURES = Path("docs/experiments.md"), Path("docs/images")
MOVES_PER_SECOND = 12
STEPS_PER_MOVE = 4
PAPER_SETTINGS = Settings("akap", (("memory", 0.0),))
CELL = 300  # pixels: the longer side of one pose in a picture

Curve = Callable[[float], tuple[float, float]]


class ScriptedSession:
    """Drags pins of a bundled drawing at `MOVES_PER_SECOND`, with the paper's settings."""

    def __init__(self, name: str, fixed: Sequence[tuple[float, float]], vertices: int = 2000) -> None:
        self.now = 0.0
        image = read_image(resource("assets", "drawings", f"{name}.png"))
        document = new_document(make_drawing(image, vertices=vertices, name=name), PAPER_SETTINGS)
        self.session = Session(document, clock=lambda: self.now)
        for point in fixed:
            self.add_pin(point)

    def add_pin(self, point: tuple[float, float]) -> int:
        """Add a pin at a point of the rest pose; return its id."""
        self.session.begin("Add Pin")
        pin = add_pin(self.session, point)
        assert pin is not None, point
        self.session.commit()
        return pin

    def drag(self, pin: int, curve: Curve, seconds: float) -> None:
        """Drag a pin along ``curve(t)`` for t from 0 to 1, with `STEPS_PER_MOVE` steps after each move."""
        self.session.begin("Drag Pin")
        moves = round(seconds * MOVES_PER_SECOND)
        for move in range(1, moves + 1):
            self.now += 1 / MOVES_PER_SECOND
            self.session.apply(SetTargets({pin: curve(move / moves)}))
            for _ in range(STEPS_PER_MOVE):
                self.session.step()
        self.session.commit()


def arc(center: tuple[float, float], start: tuple[float, float], angle: Callable[[float], float]) -> Curve:
    """Return the curve that rotates ``start`` about ``center`` by ``angle(t)`` radians."""
    c, radius = complex(*center), complex(*start) - complex(*center)

    def point(t: float) -> tuple[float, float]:
        z = c + radius * np.exp(1j * angle(t))
        return z.real, z.imag

    return point


def polyline(points: Sequence[tuple[float, float]]) -> Curve:
    """Return the curve through ``points`` that takes equally long for each segment."""
    times = np.linspace(0, 1, len(points))
    x, y = zip(*points, strict=True)
    return lambda t: (float(np.interp(t, times, x)), float(np.interp(t, times, y)))


def roll_head() -> Recording:
    """Fig. 5: roll the alien's head about its neck, 29° to each side, four times."""
    script = ScriptedSession("alien", [(390, 920), (670, 920), (500, 640)])
    top = script.add_pin((480, 200))
    script.drag(top, arc((500, 545), (480, 200), lambda t: 0.5 * np.sin(8 * np.pi * t)), 12.0)
    return script.session.recording


def raise_trunk() -> Recording:
    """Fig. 8: lift the elephant's trunk over its head."""
    script = ScriptedSession("elephant", [(135, 800), (285, 795), (445, 795), (625, 800), (400, 420)])
    trunk = script.add_pin((915, 180))
    path = [(915, 180), (960, 40), (900, -130), (740, -190), (580, -120), (520, 10)]
    script.drag(trunk, polyline(path), 5.0)
    return script.session.recording


def circle_tail() -> Recording:
    """Section 3.2: lead the raptor's tail around two loops, one in each direction, back to its start."""
    script = ScriptedSession("raptor", [(352, 740), (655, 745), (520, 400)], vertices=1000)
    tail = script.add_pin((32, 215))
    for angle in (-2 * np.pi, 2 * np.pi):
        script.drag(tail, arc((150, 130), (32, 215), partial(np.multiply, angle)), 3.0)
    return script.session.recording


@dataclass(frozen=True)
class Experiment:
    """A recorded session and the methods that it is replayed with.

    ``name`` is the name of the recording and of the picture. ``methods`` maps the caption of a table row to
    the options --method and --variant of `akap-editor replay`.
    """

    name: str
    record: Callable[[], Recording]
    methods: dict[str, tuple[str | None, str]]


EXPERIMENTS = (
    Experiment(
        "fig5-rotating-head",
        roll_head,
        {"straight steps": (None, "linear"), "log spirals": (None, "spiral")},
    ),
    Experiment(
        "fig8-variants",
        raise_trunk,
        {
            "(a) straight, one solve": (None, "linear,no-dirichlet"),
            "(b) straight, both solves": (None, "linear"),
            "(c) spirals, one solve": (None, "no-dirichlet"),
            "(d) spirals, both solves": (None, ""),
        },
    ),
    Experiment(
        "there-and-back",
        circle_tail,
        {
            "AKAP, as in the paper": (None, ""),
            "AKAP with memory": (None, "memory"),
            "ARAP": ("arap", ""),
        },
    ),
)


def last_pose(recording: Recording, drawing: Drawing, method: str | None, variant: str) -> np.ndarray:
    """Replay a recording with another method; return its last pose (n, 2)."""
    *_, last = replay(recording, drawing, settings_change(method, variant))
    return last.state.positions


def table_row(name: str, drawing: Drawing, caption: str, pose: np.ndarray) -> str:
    """Format the measures of a pose (n, 2) as a row of the experiment's table."""
    mesh = drawing.mesh
    measured = distortion(mesh, pose)
    row = [caption, f"{measured.area:.4f}", f"{measured.angle:.4f}", str(measured.flipped)]
    if name.startswith("fig5"):
        is_head = mesh.vertices[mesh.faces].mean(axis=1)[:, 1] < 480
        growth = signed_areas(pose, mesh.faces)[is_head].sum() / mesh.rest_areas[is_head].sum()
        row.append(f"{100 * (growth - 1):+.2f} %")
    if name == "there-and-back":
        distances = np.linalg.norm(pose - mesh.vertices, axis=1)
        row += [f"{np.sqrt((distances**2).mean()):.2f} px", f"{distances.max():.2f} px"]
    return "| " + " | ".join(row) + " |"


def table_rows(experiment: Experiment, renderer: OffscreenRenderer) -> Iterator[str]:
    """Replay an experiment with each method: yield the table rows, then write the picture of all poses."""
    recording = read_recording(RECORDINGS / f"{experiment.name}.akaprec")
    drawing = recorded_drawing(recording)
    poses = [drawing.mesh.vertices]
    for caption, (method, variant) in experiment.methods.items():
        poses.append(last_pose(recording, drawing, method, variant))
        yield table_row(experiment.name, drawing, caption, poses[-1])
    box = frame_box(drawing, poses)
    scale = CELL / max(box[2] - box[0], box[3] - box[1])
    pictures = [renderer.render(drawing, pose, box, scale, (1.0, 1.0, 1.0)) for pose in poses]
    path = PICTURES / f"{experiment.name}.png"
    write_png(path, np.ascontiguousarray(np.concatenate(pictures, axis=1)))
    print(path)


def main() -> None:
    """Write the recordings, the pictures and the tables."""
    for experiment in EXPERIMENTS:
        path = RECORDINGS / f"{experiment.name}.akaprec"
        write_recording(experiment.record(), path)
        print(path)
    page = PAGE.read_text("utf-8")
    with OffscreenRenderer() as renderer:
        for experiment in EXPERIMENTS:
            rows = "\n".join(table_rows(experiment, renderer))
            start, end = f"<!-- {experiment.name} -->", "<!-- end -->"
            table = re.escape(start) + ".*?" + re.escape(end)
            page = re.sub(table, f"{start}\n{rows}\n{end}", page, flags=re.DOTALL)
    PAGE.write_text(page, "utf-8")
    print(PAGE)


if __name__ == "__main__":
    main()
