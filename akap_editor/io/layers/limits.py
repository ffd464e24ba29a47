"""Bounds of what a picture in layers may hold, because nothing that a file says is trusted."""

from dataclasses import dataclass

from ...display_text import display_text
from ...errors import InputError
from ...words import tr
from ..images import MAX_PIXELS

MAX_LAYERS = 1000
MAX_LAYERS_PIXELS = 2**28  # of all layers together, without their transparent margins
MAX_SHOWN_NAME = 40  # characters


def check_size(width: int, height: int, name: str) -> None:
    """Raise InputError unless a canvas or a layer has pixels, and at most `MAX_PIXELS`."""
    if width < 1 or height < 1:
        raise InputError(
            tr(
                "{name}: expected at least 1 x 1 pixels, got {width} x {height}",
                name=name,
                width=width,
                height=height,
            )
        )
    if width * height > MAX_PIXELS:
        came = tr("{width} x {height} pixels", width=width, height=height)
        raise InputError(
            tr(
                "{name}: expected at most {megapixels:g} megapixels, got {came}",
                name=name,
                megapixels=MAX_PIXELS / 1e6,
                came=came,
            )
        )


def quoted(name: str) -> str:
    """The name of a layer in quotation marks, shortened for a sentence."""
    text = display_text(name)
    return f"“{text}”" if len(text) <= MAX_SHOWN_NAME else f"“{text[: MAX_SHOWN_NAME - 1]}…”"


@dataclass
class LayerBudget:
    """Counts layers and pixels while a file is read. Raises InputError when there are too many."""

    layers: int = 0
    pixels: int = 0

    def add_layer(self) -> None:
        """Count a layer or group."""
        self.layers += 1
        if self.layers > MAX_LAYERS:
            raise InputError(tr("expected at most {most} layers and groups, got more", most=MAX_LAYERS))

    def add_pixels(self, count: int) -> None:
        """Count pixels that are kept in memory."""
        self.pixels += count
        if self.pixels > MAX_LAYERS_PIXELS:
            most = f"{MAX_LAYERS_PIXELS / 1e6:.0f} megapixels"
            raise InputError(tr("expected layers of at most {most} in all, got more", most=most))
