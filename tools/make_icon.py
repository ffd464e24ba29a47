"""Makes the program's icon from a bundled drawing; run it after changing that.

Run from the project's root, with `pip install resvg_py`: python tools/make_icon.py
"""

import io

import numpy as np
import resvg_py
from PIL import Image, ImageDraw

from akap_editor.resources import resource

SIZES = (16, 32, 48, 64, 128, 256, 512)
SIDE, SAMPLES = 512, 4
GROUND, PIN, RIM = (255, 205, 120), (255, 255, 255), (43, 36, 58)
HEAD = (366, 24, 1014, 672)  # of the elephant, at a width of 1060
PINS = ((932, 205), (838, 468), (500, 390))  # on the trunk and the ear


def main() -> None:
    """Write assets/icons/akap-editor-<size>.png and docs/images/icon.png."""
    side = SIDE * SAMPLES
    scale = side / (HEAD[2] - HEAD[0])
    source = resource("assets", "drawings", "elephant.svg")
    png = bytes(resvg_py.svg_to_bytes(svg_path=str(source), width=round(1060 * scale)))
    drawing = Image.open(io.BytesIO(png)).convert("RGBA")
    icon = Image.new("RGBA", (side, side), (*GROUND, 255))
    left, top, right, bottom = (round(scale * value) for value in HEAD)
    icon.alpha_composite(drawing.crop((left, top, right, bottom)))
    draw = ImageDraw.Draw(icon)
    for x, y in PINS:
        center = scale * (np.array([x, y]) - HEAD[:2])
        for radius, color in ((0.052, RIM), (0.042, PIN), (0.026, RIM)):
            low, high = center - radius * side, center + radius * side
            draw.ellipse((*low, *high), fill=color)
    corners = Image.new("L", (side, side))
    ImageDraw.Draw(corners).rounded_rectangle((0, 0, side - 1, side - 1), 0.2 * side, fill=255)
    icon.putalpha(corners)
    icon.resize((128, 128), Image.Resampling.LANCZOS).save("docs/images/icon.png", optimize=True)
    for size in SIZES:
        path = resource("assets", "icons") / f"akap-editor-{size}.png"
        icon.resize((size, size), Image.Resampling.LANCZOS).save(path, optimize=True)
        print(path)


if __name__ == "__main__":
    main()
