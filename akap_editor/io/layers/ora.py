"""Reads OpenRaster files (.ora), the layers of Krita, MyPaint and GIMP.

https://www.openraster.org: a zip archive of PNG pictures and of stack.xml, which lists the topmost first.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from ...errors import InputError, error_context, file_errors
from ...layers.layered_picture import MAX_GROUPS, PASS_THROUGH, Layer, LayeredPicture, LayerGroup, trimmed
from ...progress import announce
from ...words import mark, tr
from ..akap.archive import Archive
from ..atomic import os_error_reason, read_file
from ..images import Picture, decode_image
from .limits import LayerBudget, check_size, quoted

ORA_MIMETYPE = b"image/openraster"
MAX_STACK_BYTES = 2**22
MAX_LAYER_BYTES = 2**29
MAX_OFFSET = 1_000_000  # pixels

_BLEND_MODES = {
    "svg:src-over": "normal",
    "svg:multiply": "multiply",
    "svg:screen": "screen",
    "svg:plus": "add",
}


def decode_ora(file: BinaryIO) -> LayeredPicture:
    """The layers in an OpenRaster file. Raises InputError."""
    try:
        data = file.read()
    except OSError as error:
        raise InputError(os_error_reason(error)) from error
    return _OraReader(data).read()


def ora_thumbnail(path: Path) -> Picture:
    """The small picture in an OpenRaster file, (h, w, 4) uint8, at most 256 pixels a side.

    Raises FileError.
    """
    with file_errors("open", path):
        archive = Archive(read_file(path, "an OpenRaster file"), mark("an OpenRaster file"))
        return decode_image(archive.read("Thumbnails/thumbnail.png", MAX_LAYER_BYTES), ("PNG",))


@dataclass
class _OraReader:
    data: bytes
    layers: list[Layer] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    budget: LayerBudget = field(default_factory=LayerBudget)

    def __post_init__(self) -> None:
        self._archive = Archive(self.data, mark("an OpenRaster file"))
        self._count = 1  # of the layers in the file, for the progress

    def read(self) -> LayeredPicture:
        mimetype = self._archive.read("mimetype", 100).strip()
        if mimetype != ORA_MIMETYPE:
            raise InputError(
                tr(
                    "expected the type {type}, got {mimetype!r}",
                    type=ORA_MIMETYPE.decode(),
                    mimetype=mimetype,
                )
            )
        content = self._archive.read("stack.xml", MAX_STACK_BYTES)
        with error_context("stack.xml"):
            root = _parse_xml(content)
            stack = root.find("stack")
            if root.tag != "image" or stack is None:
                raise InputError(tr("expected an image with a stack of layers"))
            size = _integer(root, "w", None), _integer(root, "h", None)
        check_size(*size, "canvas")
        self._count = max(1, sum(1 for _ in root.iter("layer")))
        self._read_stack(stack, (), (0, 0))
        if not self.layers:
            raise InputError(tr("the file contains no layer with visible pixels"))
        return LayeredPicture(size, tuple(self.layers), tuple(self.left_out))

    def _read_stack(self, stack: Element, groups: tuple[LayerGroup, ...], offset: tuple[int, int]) -> None:
        """Read what a stack contains; ``offset`` is that of the stack, to which those of layers are added."""
        for item in reversed(stack):
            name = item.get("name", "") or "unnamed"
            with error_context(f"layer {quoted(name)}"):
                at = offset[0] + _integer(item, "x", 0), offset[1] + _integer(item, "y", 0)
                if item.tag in ("stack", "layer"):
                    self.budget.add_layer()
                    common: dict[str, Any] = {
                        "name": name,
                        "opacity": _opacity(item),
                        "blend": self._blend(item, name),
                        "visible": item.get("visibility", "visible") != "hidden",
                    }
            if item.tag == "stack":
                self._read_stack(item, (*groups, LayerGroup(**(common | _isolation(item, common)))), at)
            elif item.tag == "layer":
                self._read_layer(item, common, groups, at)
            else:
                self.left_out.append(
                    tr(
                        "{name}, which is no picture but of the kind {kind}",
                        name=quoted(name),
                        kind=quoted(item.tag),
                    )
                )

    def _read_layer(
        self, item: Element, common: dict[str, Any], groups: tuple[LayerGroup, ...], at: tuple[int, int]
    ) -> None:
        announce(
            self.budget.layers / (self._count + 1),
            tr("Reading the layer {name}", name=quoted(common["name"])),
        )
        with error_context(tr("layer {name}", name=quoted(common["name"]))):
            source = item.get("src")
            if source is None:
                raise InputError(tr("expected the name of its picture, got none"))
            if not source.lower().endswith(".png"):
                self.left_out.append(
                    tr("the layer {name}, which is no PNG picture", name=quoted(common["name"]))
                )
                return
            cut = trimmed(decode_image(self._archive.read(source, MAX_LAYER_BYTES), ("PNG",)), at)
            if cut is not None:
                self.budget.add_pixels(cut[0].size // 4)
                self.layers.append(Layer(picture=cut[0], offset=cut[1], groups=groups, **common))

    def _blend(self, item: Element, name: str) -> str:
        """The blend mode; one that is not known is named as left out, and drawn as normal."""
        operation = item.get("composite-op", "svg:src-over")
        if operation not in _BLEND_MODES:
            self.left_out.append(
                tr("the blend mode {mode} of {name}", mode=quoted(operation), name=quoted(name))
            )
        return _BLEND_MODES.get(operation, "normal")


def _isolation(item: Element, common: dict[str, Any]) -> dict[str, str]:
    """The blending of a group that is drawn with what lies below it, as OpenRaster says which one is."""
    is_isolated = item.get("isolation") == "isolate" or common["opacity"] < 1 or common["blend"] != "normal"
    return {} if is_isolated else {"blend": PASS_THROUGH}


def _parse_xml(data: bytes) -> Element:
    """The root of an XML document without a document type, so that it can define no entities."""
    builder, depth = TreeBuilder(), 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > MAX_GROUPS:
            raise InputError(tr("expected groups in groups at most {most} deep, got more", most=MAX_GROUPS))
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def refuse(*_: object) -> None:
        raise InputError(tr("expected no document type and no entities, got some"))

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    try:
        parser.Parse(data, True)
        return builder.close()
    except InputError:
        raise
    except Exception as error:  # expat and the builder report damage with exceptions of many kinds
        raise InputError(tr("the list of layers is damaged")) from error


def _integer(item: Element, name: str, default: int | None) -> int:
    """A number of whole pixels; some programs write fractions."""
    text = item.get(name)
    if text is None and default is not None:
        return default
    value = _number(item, name, text)
    if abs(value) > MAX_OFFSET:
        raise InputError(
            tr(
                "{name}: expected at most {most} pixels, got {value:g}",
                name=name,
                most=MAX_OFFSET,
                value=value,
            )
        )
    return round(value)


def _opacity(item: Element) -> float:
    value = _number(item, "opacity", item.get("opacity", "1"))
    if not 0 <= value <= 1:
        raise InputError(tr("opacity: expected a number from 0 to 1, got {value:g}", value=value))
    return value


def _number(item: Element, name: str, text: str | None) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = float("nan")
    if not abs(value) < float("inf"):
        raise InputError(
            tr("{name}: expected a number, got {text!r}", name=name, text=(text or "nothing")[:20])
        )
    return value
