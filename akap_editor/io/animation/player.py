"""Writes a web page that plays an animation: one HTML file with the picture, the mesh and its poses."""

import base64
import json
import zlib
from collections.abc import Iterable, Sequence
from html import escape
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...editor.document.drawing import Drawing
from ...editor.framing import Color, output_size
from ...errors import InputError
from ...geometry.validation import Floats
from ...layers.drawing_layer import faded_texture
from ...overlap.seams import CutMesh
from ...progress import announced
from ...resources import resource
from ...words import tr
from ..atomic import Write
from ..images import Picture
from ..painter import FramedPose
from .frames import ENCODING

MAX_TEXTURE_SIDE = 4096  # pixels: what practically every browser can draw
STEP = 1 / 32  # pixels of the drawing: poses are rounded to it, or to more where they reach far
_LEVELS = 65535
_ES_HEADER = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;"

Codes = NDArray[np.uint16]  # a pose (n, 2), rounded


def write_player(
    path: Path,
    frames: Iterable[FramedPose],
    fps: float,
    plays: int,
    write: Write,
    hover: bool = False,
) -> str:
    """Write a web page that shows the frames with WebGL 2, and needs nothing else; see `write_animation`.

    Between frames, vertices move along straight lines, so that the motion is smooth on any screen. hover:
    play only while the pointer is over the drawing. Returns a few words on the result.
    """
    framed = list(frames)
    if not framed:
        raise InputError(tr("frames: expected at least one frame, got none"))
    text = encode_player(framed, fps, plays, hover)
    write(path, text.encode())
    return f"at {fps:g} frames per second, for browsers"


def encode_player(frames: Sequence[FramedPose], fps: float, plays: int = 0, hover: bool = False) -> str:
    """The text of the web page, see `write_player`; all frames have the box and the scale of the first."""
    first = frames[0]
    width, height = output_size(first.box, first.scale)
    x0, y0 = first.box[:2]
    contents = _Contents(frames)
    animation: dict[str, Any] = {
        "fps": fps,
        "plays": plays,
        "hover": hover,
        "flows": contents.flows,
        "width": width,
        "height": height,
        "box": [x0, y0, x0 + width / first.scale, y0 + height / first.scale],
        "origin": contents.origin.tolist(),
        "unit": contents.unit,
        "meshes": contents.meshes,
        "orders": contents.orders,
        "frames": contents.frames,
        "shaders": [_es_shader(name) for name in ("mesh.vert", "mesh_sharp.frag")],
        "pictures": [_data_uri(image) for image in contents.pictures],
    }
    record = json.dumps(animation, separators=(",", ":"), allow_nan=False)
    return Template(resource("assets", "player.html").read_text("utf-8")).substitute(
        title=escape(first.frame.drawing.name),
        background=_css_color(first.background),
        width=width,
        height=height,
        animation=record.replace("</", "<\\/"),  # the end of a script is looked for in strings, too
        numbers=base64.b64encode(zlib.compress(b"".join(contents.arrays()), 9)).decode(),
    )


class _Contents:
    """What the frames have in common is stored once: pictures, meshes, orders of drawing, poses.

    meshes, orders: records for the page; frames: [order, pose] of each; origin, unit: a coordinate is
    origin + unit · code; flows: whether the last frame leads to the first as it does to its neighbors.
    """

    def __init__(self, frames: Sequence[FramedPose]) -> None:
        poses = [each.frame.pose for each in frames]
        low = np.min([pose.min(axis=0) for pose in poses], axis=0)
        high = np.max([pose.max(axis=0) for pose in poses], axis=0)
        self.origin: Floats = low
        self.unit = max(STEP, float((high - low).max()) / _LEVELS)
        self.pictures: list[Picture] = []
        self.meshes: list[dict[str, int]] = []
        self.orders: list[dict[str, int]] = []
        self.frames: list[list[int]] = []
        self._drawings: list[Drawing] = []
        self._order_arrays: list[tuple[bytes, ...]] = []
        self._poses: list[list[Codes]] = []  # of each mesh
        self._found: dict[tuple[object, ...], int] = {}  # numbers of what is stored
        for each in announced(frames, ENCODING):
            self._add(each)
        self.flows = _flows(poses)

    def arrays(self) -> Iterable[bytes]:
        """The arrays, little-endian, in the order in which the page reads them."""
        for drawing in self._drawings:
            yield drawing.uv.astype("<f4").tobytes()
        for arrays in self._order_arrays:
            yield from arrays
        for poses in self._poses:
            yield from map(_planes, _residuals(poses))

    def _add(self, each: FramedPose) -> None:
        drawing, pose, order = each.frame
        mesh = self._number(self._drawings, drawing, "mesh", id(drawing))
        if mesh == len(self.meshes):
            opacities = tuple(layer.opacity for layer in drawing.layers)
            image = faded_texture(drawing.image, drawing.layers)
            picture = self._number(self.pictures, image, "picture", id(drawing.image), opacities)
            vertices = len(drawing.mesh.vertices)
            self.meshes.append({"picture": picture, "vertices": vertices, "poseCount": 0})
            self._poses.append([])
        edges: NDArray[Any] = np.zeros((0, 2), dtype="<u4")
        shares: NDArray[Any] = np.zeros(0, dtype="<f4")
        if isinstance(order, CutMesh):
            faces, edges, shares = order.faces, order.edges, order.shares
        else:
            faces = drawing.mesh.faces if order is None else drawing.mesh.faces[order]
        stored = faces.astype("<u4").tobytes(), edges.astype("<u4").tobytes(), shares.astype("<f4").tobytes()
        number = self._number(self._order_arrays, stored, "order", mesh, *stored)
        if number == len(self.orders):
            self.orders.append({"mesh": mesh, "faceCount": len(faces), "cutCount": len(shares)})
        codes = np.rint((pose - self.origin) / self.unit).astype(np.uint16)
        pose_number = self._number(self._poses[mesh], codes, "pose", mesh, codes.tobytes())
        self.meshes[mesh]["poseCount"] = len(self._poses[mesh])
        self.frames.append([number, pose_number])

    def _number(self, things: list[Any], thing: Any, *key: object) -> int:
        """The number of a thing by its key; it is appended if it is new."""
        if key not in self._found:
            self._found[key] = len(things)
            things.append(thing)
        return self._found[key]


def _flows(poses: Sequence[Floats]) -> bool:
    """Whether the way from the last pose to the first is no longer than those between the others."""
    if len({len(pose) for pose in poses}) > 1 or len(poses) < 2:
        return False
    longest = max(float(np.abs(b - a).max()) for a, b in pairwise(poses))
    return float(np.abs(poses[0] - poses[-1]).max()) <= longest


def _residuals(poses: Sequence[Codes]) -> Iterable[Codes]:
    """Poses minus the pose before moved on as before it, modulo 2¹⁶; the inverse is in the page."""
    zero: Codes = np.zeros_like(poses[0])
    for number, pose in enumerate(poses):
        last = poses[number - 1] if number > 0 else zero
        velocity = last - poses[number - 2] if number > 1 else zero
        yield pose - last - velocity


def _planes(residuals: Codes) -> bytes:
    """The low bytes of 16-bit numbers, then the high ones, which are mostly 0: the sign is the lowest bit."""
    signed = residuals.ravel().view(np.int16)
    zigzag = ((signed << 1) ^ (signed >> 15)).view(np.uint16)
    return (zigzag & 0xFF).astype(np.uint8).tobytes() + (zigzag >> 8).astype(np.uint8).tobytes()


def _data_uri(image: Picture) -> str:
    """A lossless WebP of a picture, reduced if it is larger than browsers can draw, as a data URI."""
    picture = Image.fromarray(image)
    share = MAX_TEXTURE_SIDE / max(picture.size)
    if share < 1:
        width, height = (max(1, int(side * share)) for side in picture.size)
        picture = picture.convert("RGBa").resize((width, height), Image.Resampling.BOX).convert("RGBA")
    buffer = BytesIO()
    picture.save(buffer, "WEBP", lossless=True, quality=80, method=4)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode()}"


def _es_shader(name: str) -> str:
    """A shader of the window, for WebGL 2."""
    _, _, body = resource("shaders", name).read_text("utf-8").partition("\n")  # the first line is the version
    return f"{_ES_HEADER}\n{body}"


def _css_color(color: Color | None) -> str:
    return "transparent" if color is None else "#" + "".join(f"{round(255 * value):02x}" for value in color)
