"""Makes docs/images/smooth.png: a part of a strongly bent bar, with flat faces above, with curved ones below.

Run from the project's root: python tools/make_smooth.py
"""

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from akap_editor.editor.document.document import Document, new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.io.images import Picture, write_png
from akap_editor.render.offscreen import OffscreenRenderer

TARGET = Path("docs/images/smooth.png")
WIDTH, HEIGHT, VERTICES = 600, 160, 2000
LINES, POSTS = 6, 30
SIZE, SCALE = (120, 56), 8  # of the enlarged part, pixels of the drawing


def bar() -> Picture:
    """A bar with lines along and across it."""
    large = Image.new("RGBA", (2 * WIDTH, 2 * HEIGHT))
    draw = ImageDraw.Draw(large)
    box = 20, 20, 2 * WIDTH - 20, 2 * HEIGHT - 20
    draw.rounded_rectangle(box, 60, fill=(238, 230, 212, 255), outline=(42, 34, 56, 255), width=8)
    for number in range(LINES):
        y = 60 + 40 * number
        draw.line((40, y, 2 * WIDTH - 40, y), fill=(46, 142, 138, 255), width=4)
    for number in range(POSTS):
        x = 60 + 40 * number
        draw.line((x, 40, x, 2 * HEIGHT - 40), fill=(229, 138, 58, 255), width=4)
    return np.asarray(large.resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS))


def bent() -> Document:
    """The bar with both ends dragged down."""
    session = Session(new_document(make_drawing(bar(), vertices=VERTICES)))
    session.begin("Drag Pins")
    for place in ((40.0, 80.0), (300.0, 80.0), (560.0, 80.0)):
        add_pin(session, place)
    for targets in ({3: (430.0, 330.0)}, {1: (170.0, 330.0)}):
        session.apply(SetTargets(targets))
        session.settle()
    session.commit()
    return session.document


def main() -> None:
    """Write the picture."""
    document = bent()
    pose = document.state.positions
    left, top = round(pose[:, 0].mean()) - SIZE[0] // 2, round(pose[:, 1].min()) - 4
    box = left, top, left + SIZE[0], top + SIZE[1]
    rows = []
    for is_smooth in (False, True):
        with OffscreenRenderer(is_smooth=is_smooth) as renderer:
            rows.append(renderer.render(document.drawing, pose, box, SCALE, (1.0, 1.0, 1.0)))
    write_png(TARGET, np.concatenate([rows[0], np.full_like(rows[0][:8], 255), rows[1]]))
    print(TARGET)


if __name__ == "__main__":
    main()
