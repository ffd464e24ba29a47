"""Writes small Photoshop and OpenRaster files for tests."""

import zipfile
from collections.abc import Callable
from io import BytesIO

import numpy as np
from PIL import Image
from psd_tools import PSDImage


def filled(width, height, *color) -> np.ndarray:
    """A picture of one color, (height, width, 4) uint8; opaque unless the color has four values."""
    return np.tile(np.array((*color, 255)[:4], np.uint8), (height, width, 1))


def psd_bytes(build: Callable[[PSDImage], object], size=(6, 4), mode="RGB", depth=8) -> bytes:
    """A Photoshop file with the layers that ``build`` creates."""
    psd = PSDImage.new(mode, size, depth=depth)
    build(psd)
    buffer = BytesIO()
    psd.save(buffer)
    return buffer.getvalue()


def add_layer(group, name, picture, left=0, top=0, **values):
    """A pixel layer on top of a group, with other attributes of psd-tools by name."""
    layer = group.create_pixel_layer(Image.fromarray(picture), name=name, left=left, top=top)
    for key, value in values.items():
        setattr(layer, key, value)
    return layer


def add_mask(layer, values, left, top):
    """A mask of a layer or group, (h, w) uint8, in place of the one that psd-tools makes of alpha."""
    if layer.has_mask():
        layer.remove_mask()
    mask = layer.create_mask(Image.fromarray(values), top=top, left=left)
    infos, channels = layer._record.channel_info, layer._channels
    for info, channel in zip(infos, channels, strict=True):
        info.length = channel._length  # which psd-tools leaves at 0 for groups
    if layer.is_group():  # the marker of its end shares its channels
        layer._bounding_record.channel_info = infos
    return mask


def ora_bytes(stack: str, pictures=None, size="w='6' h='4'", mimetype="image/openraster") -> bytes:
    """An OpenRaster file with the items of a stack as XML, and pictures by entry."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr("mimetype", mimetype)
        archive.writestr(
            "stack.xml", stack if "<image" in stack else f"<image {size}><stack>{stack}</stack></image>"
        )
        for name, picture in (pictures or {}).items():
            png = BytesIO()
            Image.fromarray(picture).save(png, "PNG")
            archive.writestr(name, png.getvalue())
    return buffer.getvalue()
