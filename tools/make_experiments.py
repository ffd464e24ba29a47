"""Makes the paper's experiments: recordings in assets, and the pictures and figures of docs/experiments.md.

Run from the project's root: python tools/make_experiments.py
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from akap_editor.cli.replay import settings_change
from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import Drawing, make_drawing
from akap_editor.editor.document.framing import frame_box
from akap_editor.editor.document.settings import Settings
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
THE_PAPER = Settings("akap", (("memory", 0.0),))
CELL = 300

Curve = Callable[[float], tuple[float, float]]


class Stage:
    """A session whose clock runs at `MOVES_PER_SECOND`."""

    def __init__(self, name: str, held: Sequence[tuple[float, float]], vertices: int = 2000) -> None:
        self.now = 0.0
        image = read_image(resource("assets", "drawings", f"{name}.png"))
        document = new_document(make_drawing(image, vertices=vertices, name=name), THE_PAPER)
        self.session = Session(document, clock=lambda: self.now)
        for at in held:
            self.pin(at)

    def pin(self, at: tuple[float, float]) -> int:
        """Put a pin on the drawing."""
        self.session.begin("Add pin")
        pin = add_pin(self.session, at)
        assert pin is not None, at
        self.session.commit()
        return pin

    def drag(self, pin: int, curve: Curve, seconds: float) -> None:
        """Send a pin along places ``curve`` of 0..1, with a few steps for each of its moves."""
        self.session.begin("Bend")
        moves = round(seconds * MOVES_PER_SECOND)
        for move in range(1, moves + 1):
            self.now += 1 / MOVES_PER_SECOND
            self.session.apply(SetTargets({pin: curve(move / moves)}))
            for _ in range(STEPS_PER_MOVE):
                self.session.step()
        self.session.commit()


def turned(about: tuple[float, float], start: tuple[float, float], angle: Callable[[float], float]) -> Curve:
    """Places on a circle through ``start``."""
    center, arm = complex(*about), complex(*start) - complex(*about)

    def at(t: float) -> tuple[float, float]:
        place = center + arm * np.exp(1j * angle(t))
        return place.real, place.imag

    return at


def head() -> Recording:
    """Fig. 5: the alien's head rolls to and fro about its neck, by 29 degrees to both sides, four times."""
    stage = Stage("alien", [(390, 920), (670, 920), (500, 640)])
    top = stage.pin((480, 200))
    stage.drag(top, turned((500, 545), (480, 200), lambda t: 0.5 * np.sin(8 * np.pi * t)), 12.0)
    return stage.session.recording


def variants() -> Recording:
    """Fig. 8: the elephant's trunk goes up and over its head."""
    stage = Stage("elephant", [(135, 800), (285, 795), (445, 795), (625, 800), (400, 420)])
    trunk = stage.pin((915, 180))
    path = [(915, 180), (960, 40), (900, -130), (740, -190), (580, -120), (520, 10)]
    way = np.linspace(0, 1, len(path))
    stage.drag(
        trunk,
        lambda t: (
            float(np.interp(t, way, [x for x, _ in path])),
            float(np.interp(t, way, [y for _, y in path])),
        ),
        5.0,
    )
    return stage.session.recording


def there_and_back() -> Recording:
    """Section 3.2: the raptor's tail is led around two loops, one each way, and back to where it was."""
    stage = Stage("raptor", [(352, 740), (655, 745), (520, 400)], vertices=1000)
    tail = stage.pin((32, 215))
    for loop in range(2):
        sign = 1 if loop % 2 else -1
        center = (150, 130)
        stage.drag(tail, turned(center, (32, 215), lambda t, s=sign: s * 2 * np.pi * t), 3.0)
    return stage.session.recording


@dataclass(frozen=True)
class Experiment:
    """name: of its recording and of its pictures; variants: of `akap-editor replay`, with their captions."""

    name: str
    make: Callable[[], Recording]
    columns: dict[str, tuple[str | None, str]]


EXPERIMENTS = (
    Experiment(
        "fig5-rotating-head",
        head,
        {"straight steps": (None, "linear"), "log spirals": (None, "spiral")},
    ),
    Experiment(
        "fig8-variants",
        variants,
        {
            "(a) straight, one solve": (None, "linear,no-dirichlet"),
            "(b) straight, both solves": (None, "linear"),
            "(c) spirals, one solve": (None, "no-dirichlet"),
            "(d) spirals, both solves": (None, ""),
        },
    ),
    Experiment(
        "there-and-back",
        there_and_back,
        {
            "AKAP, as in the paper": (None, ""),
            "AKAP with rest memory": (None, "memory"),
            "ARAP": ("arap", ""),
        },
    ),
)


def played(recording: Recording, drawing: Drawing, method: str | None, variant: str) -> list[EditState]:
    """The states of a recording under a variant."""
    return [moment.state for moment in replay(recording, drawing, settings_change(method, variant))]


def figures(name: str, drawing: Drawing, caption: str, states: list[EditState]) -> str:
    """A row of an experiment's table."""
    mesh, last = drawing.mesh, states[-1].positions
    measured = distortion(mesh, last)
    row = [caption, f"{measured.area:.4f}", f"{measured.angle:.4f}", str(measured.flipped)]
    if name.startswith("fig5"):
        is_head = mesh.vertices[mesh.faces].mean(axis=1)[:, 1] < 480
        growth = signed_areas(last, mesh.faces)[is_head].sum() / mesh.rest_areas[is_head].sum()
        row.append(f"{100 * (growth - 1):+.2f} %")
    if name == "there-and-back":
        off = np.linalg.norm(last - mesh.vertices, axis=1)
        row += [f"{np.sqrt((off**2).mean()):.2f} px", f"{off.max():.2f} px"]
    return "| " + " | ".join(row) + " |"


def rows_of(experiment: Experiment, renderer: OffscreenRenderer) -> Iterator[str]:
    """The rows of an experiment's table; its picture is written on the way."""
    recording = read_recording(RECORDINGS / f"{experiment.name}.akaprec")
    drawing = recorded_drawing(recording)
    poses = [drawing.mesh.vertices]
    for caption, (method, variant) in experiment.columns.items():
        states = played(recording, drawing, method, variant)
        poses.append(states[-1].positions)
        yield figures(experiment.name, drawing, caption, states)
    box = frame_box(drawing, poses)
    scale = CELL / max(box[2] - box[0], box[3] - box[1])
    pictures = [renderer.render(drawing, pose, box, scale, (1.0, 1.0, 1.0)) for pose in poses]
    path = PICTURES / f"{experiment.name}.png"
    write_png(path, np.ascontiguousarray(np.concatenate(pictures, axis=1)))
    print(path)


def main() -> None:
    """Write everything."""
    for experiment in EXPERIMENTS:
        path = RECORDINGS / f"{experiment.name}.akaprec"
        write_recording(experiment.make(), path)
        print(path)
    page = PAGE.read_text("utf-8")
    with OffscreenRenderer() as renderer:
        for experiment in EXPERIMENTS:
            rows = "\n".join(rows_of(experiment, renderer))
            marks = f"<!-- {experiment.name} -->", "<!-- end -->"
            pattern = re.escape(marks[0]) + ".*?" + re.escape(marks[1])
            page = re.sub(pattern, f"{marks[0]}\n{rows}\n{marks[1]}", page, flags=re.DOTALL)
    PAGE.write_text(page, "utf-8")
    print(PAGE)


if __name__ == "__main__":
    main()
