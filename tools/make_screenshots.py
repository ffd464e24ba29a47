"""Makes the pictures in README and docs from the running program, so that they never go stale.

Run from the project's root: python tools/make_screenshots.py
Needs no display: the window opens on GLFW's null platform.
"""

from pathlib import Path

import numpy as np

from akap_editor.app.window import Window
from akap_editor.editor.document import make_drawing, new_document
from akap_editor.editor.replay import replay
from akap_editor.io.images import read_image, write_png
from akap_editor.io.recordings import read_recording
from akap_editor.resources import resource

FOLDER = Path("docs/images")


def shoot(window: Window, path: Path) -> None:
    """Write what the window shows once everything has settled."""
    for _ in range(4):
        window.frame()
    shots: list[np.ndarray] = []
    window.after_draw.append(lambda: shots.append(window.screenshot()))
    window.frame()
    window.after_draw.clear()
    picture = np.dstack([shots[0], np.full(shots[0].shape[:2], 255, dtype=np.uint8)])
    write_png(path, picture)
    print(path)


def main() -> None:
    """The editor with the elephant posed as the bundled recording leaves it."""
    recording = read_recording(resource("assets", "recordings", "elephant.akaprec"))
    image = read_image(resource("assets", "drawings", "elephant.png"))
    document = new_document(make_drawing(image, name="elephant"))
    *_, (_, state) = replay(recording, document.drawing)
    with Window(null=True) as window:
        window.space.show(document.with_state(state))
        window.space.editor.mark_saved(Path("elephant.akap"))
        shoot(window, FOLDER / "editor.png")
        window.space.show_mesh = True
        shoot(window, FOLDER / "mesh.png")


if __name__ == "__main__":
    main()
