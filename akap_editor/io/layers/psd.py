"""Reads Photoshop files (.psd, .psb) with psd-tools: the pictures of their layers, as 8-bit RGBA."""

import logging
import warnings
from dataclasses import dataclass, field
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from psd_tools import ParseLimits, PSDDecompressionWarning, PSDImage
from psd_tools.api.layers import AdjustmentLayer, Group
from psd_tools.api.layers import Layer as PsdLayer
from psd_tools.constants import BlendMode, ChannelID, ColorMode, CompatibilityMode, Tag
from psd_tools.psd.descriptor import Descriptor

from ...errors import AkapError, InputError, error_context
from ...layers.layered_picture import MAX_GROUPS, PASS_THROUGH, Layer, LayeredPicture, LayerGroup, trimmed
from ...progress import announce
from ...words import tr
from ..atomic import os_error_reason
from ..images import MAX_PIXELS, Picture
from .limits import LayerBudget, check_size, quoted

MAX_ALLOCATED_BYTES = 2**30  # by psd-tools at once
_LIMITS = ParseLimits(max_read_bytes=2**30)
_COLOR_MODES = (
    ColorMode.RGB,
    ColorMode.CMYK,
    ColorMode.GRAYSCALE,
    ColorMode.DUOTONE,
    ColorMode.INDEXED,
    ColorMode.BITMAP,
)
_BLEND_MODES = {
    BlendMode.NORMAL: "normal",
    BlendMode.MULTIPLY: "multiply",
    BlendMode.SCREEN: "screen",
    BlendMode.LINEAR_DODGE: "add",
    BlendMode.PASS_THROUGH: PASS_THROUGH,
}

# Of Photoshop CS2 and before, which psd-tools takes for layers with pixels
_OLD_ADJUSTMENTS = (Tag.BRIGHTNESS_AND_CONTRAST, Tag.HUE_SATURATION_V4)
_SOFT_EDGE = 1  # pixels by which shapes are larger than the artboard that they fill
_ARTBOARD_DATA = (Tag.ARTBOARD_DATA1, Tag.ARTBOARD_DATA2, Tag.ARTBOARD_DATA3)

logging.getLogger("psd_tools").addHandler(logging.NullHandler())  # its remarks are not for our users


def decode_psd(file: BinaryIO) -> LayeredPicture:
    """The layers in a Photoshop file, which is closed once it has been read. Raises InputError.

    The picture of a text, a shape or a smart object is the one that the file contains. Masks are multiplied
    into the opacity of layers, those of groups into each of their layers.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", PSDDecompressionWarning)  # psd-tools would go on with black pixels
        try:
            psd = PSDImage.open(file, MAX_ALLOCATED_BYTES, _LIMITS)
        except Exception as error:  # psd-tools reports damage with exceptions of many kinds
            if isinstance(error, OSError) and error.errno:  # not of psd-tools
                raise InputError(os_error_reason(error)) from error
            raise InputError(tr("the file is damaged or not a Photoshop file")) from error
        file.close()
        psd.compatibility_mode = CompatibilityMode.CLIP_STUDIO_PAINT  # groups may be clipped
        return _PsdReader(psd).read()


@dataclass
class _PsdReader:
    psd: PSDImage
    layers: list[Layer] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    budget: LayerBudget = field(default_factory=LayerBudget)

    def read(self) -> LayeredPicture:
        size = self.psd.width, self.psd.height
        check_size(*size, "canvas")
        if self.psd.color_mode not in _COLOR_MODES:
            mode = self.psd.color_mode.name.capitalize()
            raise InputError(
                tr("expected RGB, CMYK or gray colors, got {mode}; convert the file to RGB", mode=mode)
            )
        if self.psd.depth == 32:
            raise InputError(tr("expected samples of 8 or 16 bits, got 32; convert the file to 16 bits"))
        try:
            self._count = max(1, sum(1 for _ in self.psd.descendants()))
            if len(self.psd):
                self._read_group(self.psd, (), ())
            else:  # a flat picture
                self._read_merged()
        except AkapError:
            raise
        except Exception as error:  # psd-tools reports damage with exceptions of many kinds
            raise InputError(tr("the Photoshop file is damaged or incomplete")) from error
        if not self.layers:
            raise InputError(tr("the file contains no layer with visible pixels"))
        return LayeredPicture(size, tuple(self.layers), tuple(self.left_out))

    def _read_merged(self) -> None:
        image = self.psd.topil()
        if image is not None:
            self._add("Background", _as_array(image), (0, 0), {})

    def _read_group(self, group: Any, groups: tuple[LayerGroup, ...], masks: tuple[PsdLayer, ...]) -> None:
        """Read what a group contains, which psd-tools lists from the bottom to the top.

        masks: the groups around it that have a mask.
        """
        if len(groups) > MAX_GROUPS:
            raise InputError(tr("expected groups in groups at most {most} deep, got more", most=MAX_GROUPS))
        base_is_drawn = True  # whether the layer to which others are clipped has pixels
        for layer in group:
            self.budget.add_layer()
            clipping = bool(layer.clipping)
            if clipping and not base_is_drawn:
                self.left_out.append(
                    tr("{name}, which is clipped to a layer that is not drawn", name=quoted(layer.name))
                )
                continue
            before = len(self.layers)
            if isinstance(layer, Group):
                self._name_what_is_left_out(layer)
                own = LayerGroup(**self._common(layer), clipping=clipping)
                self._read_group(layer, (*groups, own), (*masks, layer) if _is_masked(layer) else masks)
            else:
                self._read_layer(layer, {"groups": groups, "clipping": clipping}, masks)
            if not clipping:
                base_is_drawn = len(self.layers) > before

    def _read_layer(self, layer: PsdLayer, place: dict[str, Any], masks: tuple[PsdLayer, ...]) -> None:
        name = quoted(layer.name)
        announce(self.budget.layers / (self._count + 1), tr("Reading the layer {name}", name=name))
        if not layer.has_pixels() or layer.width < 1 or layer.height < 1:
            is_old_adjustment = any(tag in layer.tagged_blocks for tag in _OLD_ADJUSTMENTS)
            if isinstance(layer, AdjustmentLayer) or is_old_adjustment:
                self.left_out.append(tr("the adjustment layer {name}", name=name))
            elif layer.kind != "pixel":
                self.left_out.append(tr("{name}, of which the file contains no picture", name=name))
            return
        self._name_what_is_left_out(layer)
        with error_context(tr("layer {name}", name=name)):
            check_size(layer.width, layer.height, "size")
            try:
                picture = _rgba(layer)
                for masked in (*masks, *([layer] if _is_masked(layer) else ())):
                    _apply_mask(picture, layer.offset, masked)
            except InputError:
                raise
            except Exception as error:  # psd-tools reports damage with exceptions of many kinds
                raise InputError(tr("the layer is damaged or incomplete")) from error
            _release(layer)
            self._add(layer.name, picture, layer.offset, self._common(layer) | place)

    def _add(self, name: str, picture: Picture, offset: tuple[int, int], values: dict[str, Any]) -> None:
        cut = trimmed(picture, offset)
        if cut is not None:
            self.budget.add_pixels(cut[0].size // 4)
            self.layers.append(Layer(**({"name": name} | values), picture=cut[0], offset=cut[1]))

    def _common(self, layer: PsdLayer) -> dict[str, Any]:
        """What groups and layers have in common."""
        mode = _BLEND_MODES.get(layer.blend_mode, "normal")
        if mode == PASS_THROUGH and not isinstance(layer, Group):
            mode = "normal"
        opacity = layer.opacity / 255 * _fill_opacity(layer)
        return {"name": layer.name, "opacity": opacity, "blend": mode, "visible": bool(layer.visible)}

    def _name_what_is_left_out(self, layer: PsdLayer) -> None:
        """Note what a layer or group has besides pixels."""
        name = quoted(layer.name)
        if layer.blend_mode not in _BLEND_MODES:
            mode = layer.blend_mode.name.lower().replace("_", " ")
            self.left_out.append(tr("the blend mode “{mode}” of {name}", mode=mode, name=name))
        if layer.has_effects() or _has_older_effects(layer):
            self.left_out.append(tr("the effects of {name}", name=name))
        if _has_background(layer):
            self.left_out.append(tr("the background of the artboard {name}", name=name))
        if _has_crop(layer):
            self.left_out.append(tr("the crop of the artboard {name}", name=name))
        if layer.tagged_blocks.get_data(Tag.KNOCKOUT_SETTING):
            self.left_out.append(tr("the knockout of {name}", name=name))
        has_rendered_mask = layer.mask is not None and layer.mask.has_real()
        if layer.has_vector_mask() and layer.kind != "shape" and not has_rendered_mask:
            self.left_out.append(tr("the vector mask of {name}", name=name))
        if _is_masked(layer) and _feather(layer):
            self.left_out.append(tr("the soft edge of the mask of {name}", name=name))


def _fill_opacity(layer: PsdLayer) -> float:
    value = layer.fill_opacity
    return min(max(value, 0), 255) / 255 if isinstance(value, int) else 1.0


def _has_older_effects(layer: PsdLayer) -> bool:
    """Whether a layer has effects as Photoshop CS5 and before wrote them, which psd-tools does not list."""
    effects = layer.tagged_blocks.get_data(Tag.OBJECT_BASED_EFFECTS_LAYER_INFO)
    if effects is None or not effects.get(b"masterFXSwitch"):
        return False
    entries = (value for value in effects.values() if isinstance(value, Descriptor))
    return any(entry.get(b"enab") and b"present" not in entry for entry in entries)


def _has_background(layer: PsdLayer) -> bool:
    """Whether a layer is an artboard that is not transparent."""
    kinds = (data.get(b"artboardBackgroundType") for data in _artboard_data(layer))
    return any(kind is not None and int(kind) != 1 for kind in kinds)


def _has_crop(layer: Any) -> bool:
    """Whether a layer is an artboard that hides pixels outside of it, which are kept here."""
    for data in _artboard_data(layer):
        sides = data.get(b"artboardRect") or {}
        keys = (b"Left", b"Top ", b"Rght", b"Btom")
        left, top, right, bottom = (float(sides.get(key, 0.0)) for key in keys)
        for part in layer.descendants() if left < right and top < bottom else ():
            sides_inside = part.left - left, part.top - top, right - part.right, bottom - part.bottom
            if part.has_pixels() and min(sides_inside) < -_SOFT_EDGE:
                return True
    return False


def _artboard_data(layer: PsdLayer) -> list[Any]:
    found = (layer.tagged_blocks.get_data(tag) for tag in _ARTBOARD_DATA)
    return [data for data in found if data is not None]


def _is_masked(layer: PsdLayer) -> bool:
    return layer.mask is not None and not layer.mask.disabled


def _feather(layer: PsdLayer) -> float:
    parameters = layer.mask.parameters if layer.mask is not None else None
    return (parameters.user_mask_feather or 0.0) if parameters is not None else 0.0


def _rgba(layer: PsdLayer) -> Picture:
    """The picture of a layer, (h, w, 4) uint8, without its mask."""
    image = layer.topil()
    if image is None:
        raise InputError(tr("the layer is damaged or incomplete"))
    if image.mode in ("RGBA", "LA"):
        return _as_array(image)
    picture = _as_array(image.convert("RGB"))
    alpha = layer.topil(ChannelID.TRANSPARENCY_MASK)  # Pillow's CMYK pictures have none
    if alpha is not None:
        picture[..., 3] = np.asarray(alpha.convert("L"))
    return picture


def _as_array(image: Image.Image) -> Picture:
    """The pixels of an image, (h, w, 4) uint8."""
    return np.array(image if image.mode == "RGBA" else image.convert("RGBA"))


def _release(layer: PsdLayer) -> None:
    """Forget the compressed pixels of a layer that has been read; psd-tools holds all of them to the end."""
    for channel in layer._channels:
        channel.data = b""


def _apply_mask(picture: Picture, offset: tuple[int, int], masked: PsdLayer) -> None:
    """Multiply the opacity of a picture whose corner is at ``offset`` by the mask of a layer or group."""
    mask = masked.mask
    assert mask is not None
    if mask.width * mask.height > MAX_PIXELS:
        raise InputError(tr("mask: expected at most {megapixels:g} megapixels", megapixels=MAX_PIXELS / 1e6))
    height, width = picture.shape[:2]
    full = Image.new("L", (width, height), mask.background_color)
    image = mask.topil()
    if image is not None:
        full.paste(image.convert("L"), (mask.left - offset[0], mask.top - offset[1]))
    visible: NDArray[Any] = np.asarray(full).astype(np.uint16)
    parameters = mask.parameters
    density = parameters.user_mask_density if parameters is not None else None
    if density is not None and not mask.has_real():
        visible = 255 - (255 - visible) * density // 255
    picture[..., 3] = (picture[..., 3] * visible + 127) // 255
