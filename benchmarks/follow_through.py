"""Follow-through: CPU time of a frame while loose parts swing, and of its preparation.

Run from the project's root: python benchmarks/follow_through.py
The upper part of a bundled drawing is loose and the whole is shaken; times are medians, in CPU milliseconds
of the thread.
"""

import time

import numpy as np

from akap_editor.deform.follow_through import FollowThrough
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.io.images import read_image
from akap_editor.resources import bundled_drawings

NO_ANCHORS = np.zeros(0, dtype=np.int64)


def main() -> None:
    """Print one line for each number of free vertices."""
    path = next(path for path in bundled_drawings() if path.stem == "alien")
    image = read_image(path)
    print("vertices  free  prepare  a frame, substeps 1  substeps 2")
    for vertices, share in ((2000, 0.12), (2000, 0.42), (5000, 0.36), (20000, 0.45)):
        mesh = make_drawing(image, vertices=vertices).mesh
        y = mesh.vertices[mesh.faces].mean(axis=1)[:, 1]
        loose = y < np.quantile(y, share)
        row = []
        for bounce in (0.5, 0.7):
            start = time.thread_time()
            follow = FollowThrough(mesh, loose, NO_ANCHORS, 3.0, bounce)
            prepared = time.thread_time() - start
            state, times = follow.start(mesh.vertices), []
            for k in range(60):
                pose = mesh.vertices + 0.05 * mesh.length * np.sin(0.6 * k) * np.array([1.0, 0.0])
                start = time.thread_time()
                state = follow.step(state, pose)
                follow.shown(state, pose)
                times.append(time.thread_time() - start)
            row.append(1000 * float(np.median(times[5:])))
        counts = f"{len(mesh.vertices):8} {follow.free_count:5} {1000 * prepared:8.1f}"
        print(f"{counts} {row[0]:20.2f} {row[1]:11.2f}")


if __name__ == "__main__":
    main()
