"""Kills the running window again and again, in the middle of drags and saves, and looks what is left.

Run from the project's root: python benchmarks/kill_window.py [--kills N] [--seed S]
Needs Xvfb and xdotool. Each round starts the program on a saved drawing with a real mouse, recovers what the
round before has lost, drags pins, saves or does both, and is killed (SIGKILL) at a random moment. After that
the saved file must open and hold one of the two versions, each recovery copy must open, preferences must be
sound, and a copy must be there if the first change was more than a few seconds ago. Prints what was found;
the exit code is 1 if anything was broken.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

from akap_editor.errors import AkapError
from akap_editor.io.akap.autosave import FIRST_COPY_SECONDS
from akap_editor.io.akap.project import load
from akap_editor.io.images import read_image
from akap_editor.resources import resource
from tests.support.running_program import RunningProgram, far_apart, find_camera
from tests.support.x_server import x_server

GRACE_SECONDS = 5.0  # beyond `FIRST_COPY_SECONDS`: a frame and the writing of a copy on a busy machine
LONGEST_SECONDS = 12.0  # from the first change to a kill
PINS = 4


class Rounds:
    """The rounds, with what was found so far.

    found: numbers of what was seen after the kills; broken: a line for everything that must not be.
    """

    def __init__(self, display: str, folder: Path, seed: int) -> None:
        self._display, self._folder, self._rng = display, folder, np.random.default_rng(seed)
        self._preferences, self._saved = folder / "preferences", folder / "saved.akap"
        self._preferences.mkdir()
        (self._preferences / "preferences.json").write_text(json.dumps({"first steps done": True}))
        self._picture = resource("assets", "drawings", "gingerbread.png")
        os.environ["AKAP_EDITOR_STATE"] = str(folder / "state")
        os.environ["AKAP_EDITOR_FILE_DIALOG"] = "own"
        self.found: Counter[str] = Counter()
        self.broken: list[str] = []

    def prepare(self) -> None:
        """Save a drawing with pins."""
        program = self._start(self._picture)
        alpha = read_image(self._picture)[..., 3]
        zoom, offset = find_camera(program.key("shift+c", "the checkerboard is gone"), alpha)
        self._pins = np.rint(far_apart(alpha, PINS) * zoom + offset).astype(int)
        for pin in self._pins.tolist():
            program.click(pin)
        program.save_as(self._saved)
        program.press("ctrl+q")
        program.exit_code()

    def run(self, number: int) -> None:
        """One round: start, recover, work, kill, look."""
        lost = self._copies()
        program = self._start(self._saved)
        if lost:
            program.press("Return")
            program.until_idle()
            self.found["recovered"] += 1
        started = time.monotonic()
        kill_at = started + self._rng.uniform(0.0, LONGEST_SECONDS)
        did = self._work(program, kill_at)
        program.process.kill()
        program.process.wait()
        seconds = time.monotonic() - started
        program.xdotool("mouseup", 1)
        self.found[did] += 1
        self._look(f"kill {number} in a {did}", seconds if "save" not in did else 0.0)

    def _start(self, file: Path) -> RunningProgram:
        return RunningProgram(self._display, file, self._folder, self._preferences)

    def _work(self, program: RunningProgram, kill_at: float) -> str:
        """Drag and save until it is time; returns what was going on then."""
        saves = bool(self._rng.random() < 0.5)
        while True:
            pin = self._pins[self._rng.integers(PINS)]
            program.xdotool("mousemove", *pin, "mousedown", 1)
            for _ in range(12):
                program.xdotool("mousemove", *(pin + self._rng.integers(-90, 91, 2)))
                if time.monotonic() >= kill_at:
                    return "drag"
            program.xdotool("mousemove", *pin, "mouseup", 1)
            if saves:
                program.press("ctrl+s")
                if time.monotonic() + self._rng.uniform(0.0, 1.0) >= kill_at:
                    return "save"

    def _copies(self) -> list[Path]:
        return list((self._folder / "state" / "autosave").glob("*.akap"))

    def _look(self, label: str, seconds_unsaved: float) -> None:
        for path in [self._saved, *self._copies()]:
            try:
                document = load(path)
                assert len(document.state.pins) >= PINS, "the pins are missing"
                self.found["files that open"] += 1
            except (AkapError, AssertionError) as error:
                self.broken.append(f"{label}: {error}")
        preferences = json.loads((self._preferences / "preferences.json").read_text())
        if str(self._saved) not in preferences["recent"]:
            self.broken.append(f"{label}: the file is not among the recent ones")
        must_have_copy = seconds_unsaved > FIRST_COPY_SECONDS + GRACE_SECONDS
        self.found["copies"] += bool(self._copies())
        if must_have_copy and not self._copies():
            self.broken.append(f"{label}: no copy {seconds_unsaved:.1f} s after the first change")


def main() -> int:
    """Run the rounds; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    with x_server() as server, tempfile.TemporaryDirectory() as folder:
        rounds = Rounds(server.display, Path(folder), arguments.seed)
        rounds.prepare()
        for number in range(1, arguments.kills + 1):
            rounds.run(number)
            if number % 10 == 0 or rounds.broken:
                print(f"{number} kills: {dict(rounds.found)}, broken: {rounds.broken}", flush=True)
    return 1 if rounds.broken else 0


if __name__ == "__main__":
    sys.exit(main())
