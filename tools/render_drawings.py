"""Renders the bundled SVG drawings as PNG files; run it after changing one of them.

Run from the project's root, with `pip install resvg_py`: python tools/render_drawings.py
"""

import io

import numpy as np
import resvg_py
from PIL import Image

from akap_editor.io.images import write_png
from akap_editor.resources import resource

WIDTHS = {
    "alien": 1000,
    "bar": 1120,
    "cat": 1000,
    "elephant": 1000,
    "gingerbread": 1000,
    "raptor": 1100,
    "rope": 2000,
}


def main() -> None:
    """Write one PNG beside each SVG."""
    for source in sorted(resource("assets", "drawings").glob("*.svg")):
        png = bytes(resvg_py.svg_to_bytes(svg_path=str(source), width=WIDTHS[source.stem]))
        picture = np.array(Image.open(io.BytesIO(png)).convert("RGBA"))
        if source.stem == "bar":  # anti-aliasing is not symmetric to the last bit
            quarter = picture[: picture.shape[0] // 2, : picture.shape[1] // 2]
            half = np.concatenate([quarter, quarter[:, ::-1]], axis=1)
            picture = np.concatenate([half, half[::-1]])
        path = source.with_suffix(".png")
        write_png(path, picture)
        print(path, picture.shape[1], "×", picture.shape[0])


if __name__ == "__main__":
    main()
