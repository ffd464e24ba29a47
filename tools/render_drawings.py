"""Renders the bundled SVG drawings as PNG files, and puppets as OpenRaster files; run it after changing one.

Run from the project's root, with `pip install resvg_py`: python tools/render_drawings.py
"""

import copy
import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

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
    "robot": 1000,
    "rope": 2000,
}


SVG = "http://www.w3.org/2000/svg"
_DATE = (1980, 1, 1, 0, 0, 0)


def write_puppet(source: Path, width: int) -> None:
    """Write the groups of an SVG that are layers as an OpenRaster file."""
    root = ElementTree.fromstring(source.read_text("utf-8"))
    whole = _rendered(root, None, width)
    image = Element("image", w=str(width), h=str(whole.size[1]), version="0.0.3")
    pictures: dict[str, Image.Image] = {}

    def add(parent: Element, stack: Element) -> None:
        for group in parent.findall(f"{{{SVG}}}g"):
            if (name := group.get("data-group")) is not None:
                inner = Element("stack", name=name)
                stack.insert(0, inner)  # the topmost first
                add(group, inner)
            elif (name := group.get("data-layer")) is not None:
                picture = _rendered(root, group, width)
                left, top, right, bottom = picture.getbbox() or (0, 0, 1, 1)
                path = f"data/{len(pictures)}.png"
                pictures[path] = picture.crop((left, top, right, bottom))
                visibility = "hidden" if group.get("data-hidden") else "visible"
                layer = Element("layer", name=name, src=path, x=str(left), y=str(top), visibility=visibility)
                stack.insert(0, layer)
            else:
                add(group, stack)

    add(root, SubElement(image, "stack"))
    small = whole.copy()
    small.thumbnail((256, 256))
    path = source.with_suffix(".ora")
    with zipfile.ZipFile(path, "w") as archive:

        def put(name: str, content: bytes, packed: bool = False) -> None:
            method = zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED
            archive.writestr(zipfile.ZipInfo(name, _DATE), content, method)

        put("mimetype", b"image/openraster")
        put("stack.xml", ElementTree.tostring(image, "utf-8"), packed=True)
        entries = {**pictures, "mergedimage.png": whole, "Thumbnails/thumbnail.png": small}
        for name, picture in entries.items():
            put(name, _png(picture))
    print(path, f"{len(pictures)} layers")


def _rendered(root: Element, layer: Element | None, width: int) -> Image.Image:
    """The picture of one layer alone, or of all visible ones."""
    alone = copy.deepcopy(root)
    for original, group in zip(root.iter(f"{{{SVG}}}g"), list(alone.iter(f"{{{SVG}}}g")), strict=True):
        is_layer = group.get("data-layer") is not None
        if is_layer and (original is not layer if layer is not None else group.get("data-hidden")):
            group.set("display", "none")
    text = ElementTree.tostring(alone, "unicode")
    png = bytes(resvg_py.svg_to_bytes(svg_string=text, width=width))
    return Image.open(io.BytesIO(png)).convert("RGBA")


def _png(picture: Image.Image) -> bytes:
    file = io.BytesIO()
    picture.save(file, "PNG", optimize=True)
    return file.getvalue()


def main() -> None:
    """Write one PNG or OpenRaster file beside each SVG."""
    ElementTree.register_namespace("", SVG)
    for source in sorted(resource("assets", "drawings").glob("*.svg")):
        if "data-layer" in source.read_text("utf-8"):
            write_puppet(source, WIDTHS[source.stem])
            continue
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
