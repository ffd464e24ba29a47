"""Soak test of the editor without a window: thousands of random operations on one drawing.

Run from the project's root: python benchmarks/session_soak.py [--operations N] [--drawing FILE] [--seed S]
The operations are those of an artist in two hours: drags, cancelled drags, pins added and removed, undo and
redo, new mesh densities and rest poses, pose files, saves, exports and autosaves. After every tenth of them a
line reports the undo entries, the recorded events and the memory of the process. At the end the saved file
must equal the document in memory, and the second half of the operations may add at most 20 MB of memory;
otherwise, and after any exception, the exit code is 1.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import argparse
import gc
import sys
import tempfile
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from akap_editor.editor import gestures
from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import Remesh
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError, SolverError
from akap_editor.io.akap.autosave import Autosave
from akap_editor.io.akap.pose import load_pose, save_pose
from akap_editor.io.akap.project import encode_document, load, save
from akap_editor.io.akap.recording import write_recording
from akap_editor.io.export import ExportOptions, export
from akap_editor.io.images import read_image
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource

MAX_GROWTH = 20e6  # bytes, in the second half of the operations
MAX_PINS = 12
EXPORTS = (".svg", ".glb", ".obj", ".spine.json", ".json")

# The share of each operation, in all operations; `Soak` has a method of each name.
SHARES = {
    "drag": 0.50,
    "cancelled drag": 0.06,
    "add pin": 0.12,
    "remove pin": 0.07,
    "undo": 0.10,
    "redo": 0.04,
    "save": 0.04,
    "export": 0.02,
    "reset": 0.02,
    "pose": 0.02,
    "density": 0.002,
    "bake": 0.008,
}


def resident_memory() -> int:
    """Return the resident memory of this process in bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


class Soak:
    """Applies random operations to an editor; its files go to ``folder``."""

    def __init__(self, document: Document, folder: Path, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.now = 0.0
        self.editor = Editor(clock=lambda: self.now)
        self.editor.open(document)
        self.folder, self.path = folder, folder / "drawing.akap"
        self.autosave = Autosave(folder / "state", clock=lambda: self.now)
        self.painter = OffscreenRenderer()
        self.counts: Counter[str] = Counter()

    @property
    def session(self) -> Session:
        """The session of the open drawing."""
        assert self.editor.session is not None
        return self.editor.session

    def operate(self) -> None:
        """Apply one random operation, then sometimes draw a frame in which the pose settles."""
        name = str(self.rng.choice(list(SHARES), p=list(SHARES.values())))
        try:
            getattr(self, "_" + name.replace(" ", "_"))()
            self._frames(int(self.rng.random() < 0.2))
        except (
            InputError,
            SolverError,
        ) as error:  # e.g. no new mesh after a new rest pose
            self.counts[f"{name}: {type(error).__name__}"] += 1
        self.counts[name] += 1

    def _frames(self, count: int) -> None:
        for _ in range(count):
            self.now += 1 / 60
            self.editor.advance(budget=0.0)
            session = self.session
            self.autosave.watch(session.document, self.editor.is_modified, session.history.last)
        self.now += 0.2

    def _pin_on_screen(self, pin: int) -> tuple[float, float]:
        return self.editor.pins_on_screen()[pin]

    def _press(self) -> tuple[float, float] | None:
        pins = [pin.id for pin in self.session.state.pins]
        if not pins:
            self._add_pin()
            return None
        at = self._pin_on_screen(int(self.rng.choice(pins)))
        self.editor.handle_event(PointerEvent("press", at))
        for _ in range(int(self.rng.integers(1, 5))):
            at = at[0] + self.rng.normal(0, 12), at[1] + self.rng.normal(0, 12)
            self.editor.handle_event(PointerEvent("move", at))
        self._frames(1)
        return at

    def _drag(self) -> None:
        at = self._press()
        if at is not None:
            self.editor.handle_event(PointerEvent("release", at))

    def _cancelled_drag(self) -> None:
        self._press()
        self.editor.cancel()

    def _add_pin(self) -> None:
        mesh, state = self.session.drawing.mesh, self.session.state
        if len(state.pins) < MAX_PINS:
            corners = state.positions[mesh.faces[self.rng.integers(len(mesh.faces))]]
            x, y = corners.mean(axis=0)
            gestures.add_pin(self.editor, (float(x), float(y)))

    def _remove_pin(self) -> None:
        pins = [pin.id for pin in self.session.state.pins]
        if pins:
            gestures.remove_pins(self.editor, {int(self.rng.choice(pins))})

    def _undo(self) -> None:
        for _ in range(int(self.rng.integers(1, 4))):
            self.editor.undo()

    def _redo(self) -> None:
        self.editor.redo()

    def _reset(self) -> None:
        gestures.reset_pose(self.editor)

    def _bake(self) -> None:
        gestures.set_rest_pose(self.editor)
        self.editor.undo()  # otherwise each new rest pose distorts the drawing further

    def _pose(self) -> None:
        path = self.folder / "a.pose.json"
        save_pose(self.session.document, path)
        pose = load_pose(path, self.session.drawing)
        gestures.apply_pose(self.editor, pose.pins, pose.positions)

    def _density(self) -> None:
        drawing = self.session.drawing
        assert drawing.meshing is not None
        meshing = replace(drawing.meshing, vertices=int(self.rng.integers(80, 200)))
        self.editor.cancel()
        remesh = Remesh.from_drawing(remesh_drawing(drawing, meshing))
        self.session.begin("Change Density")
        self.session.apply(remesh)
        self.session.commit()

    def _save(self) -> None:
        save(self.session.document, self.path)
        self.editor.mark_saved(self.path)

    def _export(self) -> None:
        name = f"out{self.rng.choice(EXPORTS)}"
        export(self.session.document, self.folder / name, ExportOptions(), self.painter, overwrite=True)

    def finish(self) -> None:
        """Check that the saved file equals the document and that no recovery copy is left."""
        self._save()
        assert encode_document(load(self.path)) == encode_document(self.session.document), (
            "the saved file differs from the document"
        )
        write_recording(self.session.recording, self.folder / "session.akaprec")
        self.autosave.close()
        assert not list((self.folder / "state").glob("*")), "a recovery copy of saved work is left"


def main() -> None:
    """Run the operations and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--operations", type=int, default=20_000)
    parser.add_argument("--drawing", type=Path, default=resource("assets", "drawings", "elephant.png"))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    image = read_image(options.drawing)
    document = new_document(make_drawing(image, vertices=120, name=options.drawing.stem))
    with tempfile.TemporaryDirectory() as folder:
        soak = Soak(document, Path(folder), options.seed)
        sizes: list[int] = []
        print("operations  undo entries  events recorded  memory MB  seconds", flush=True)
        started = time.perf_counter()
        for count in range(1, options.operations + 1):
            soak.operate()
            if count % max(options.operations // 10, 1) == 0:
                gc.collect()
                sizes.append(resident_memory())
                events, depth = len(soak.session.recording.events), soak.session.history.depth
                seconds = time.perf_counter() - started
                print(f"{count:10} {depth:13} {events:16} {sizes[-1] / 1e6:10.1f} {seconds:8.0f}", flush=True)
        soak.finish()
        recording = (Path(folder) / "session.akaprec").stat().st_size
    growth = sizes[-1] - sizes[len(sizes) // 2 - 1]
    print(", ".join(f"{name}: {number}" for name, number in sorted(soak.counts.items())))
    print(f"{soak.now / 60:.0f} minutes; recording {recording / 1e6:.1f} MB; the file equals the document")
    print(f"memory of the second half {growth / 1e6:+.1f} MB")
    sys.exit(growth > MAX_GROWTH)


if __name__ == "__main__":
    main()
