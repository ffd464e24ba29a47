"""Inspects files of all kinds: what they are, by their content, and whether they are sound."""

import reprlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..editor.document.drawing import Drawing
from ..errors import InputError
from ..geometry.distortion import distortion
from ..layers.composite import composite, hidden_layers
from ..layers.drawing_layer import shown_layers
from ..layers.layered_picture import LayeredPicture
from ..meshing.faint import fitting_threshold
from ..meshing.picture_mesh import mesh_picture
from ..words import mark
from .akap.clip import CLIP_FORMAT, decode_clip
from .akap.json_records import pairs, parse_record, require
from .akap.pose import POSE_FORMAT
from .akap.project import MIMETYPE, decode_document
from .akap.recording import decode_recording
from .akap.state_records import read_pins
from .atomic import read_file
from .images import Picture, decode_image, has_transparency
from .layers.open_layers import LAYER_SUFFIXES, PSD_MAGIC, decode_layers, has_layers, open_layers
from .mesh_files.soundness import count_parts, decode_mesh, mesh_defects

Facts = dict[str, Any]

_PICTURE_KINDS = {  # by their first bytes
    b"\x89PNG": "PNG",
    b"\xff\xd8\xff": "JPEG",
    b"RIFF": "WebP",
    b"BM": "BMP",
    b"GIF8": "GIF",
    b"II*\0": "TIFF",
    b"MM\0*": "TIFF",
}
_KIND_OF_SUFFIX = {
    ".akap": "drawing",
    ".akaprec": "recording",
    **dict.fromkeys((".obj", ".off", ".glb", ".json"), "mesh"),
    **dict.fromkeys((".png", ".jpg", ".jpeg", ".webp", ".bmp", ".gif"), "picture"),
    **dict.fromkeys(LAYER_SUFFIXES, "layers"),
}


@dataclass(frozen=True)
class Inspection:
    """The result of an inspection.

    kind: "picture", "layers", "drawing", "pose", "clip", "recording", "mesh" or "unknown"; facts: values by
    name; problems: one line each, none if the file is sound.
    """

    kind: str
    facts: Facts
    problems: list[str]

    @property
    def sound(self) -> bool:
        """Whether the file has no problems."""
        return not self.problems


def inspect(path: str | Path) -> Inspection:
    """Inspect a file, or a folder of layers. Raises FileError if it cannot be read at all."""
    if Path(path).is_dir():
        return Inspection("layers", *_layer_facts("folder", open_layers(path)))
    data = read_file(path, mark("a file"))
    suffix = Path(path).suffix.lower()
    kind = _kind_by_content(data, suffix) or _KIND_OF_SUFFIX.get(suffix, "unknown")
    if kind == "unknown":
        came = (
            f"expected a picture, a drawing, a recording or a mesh, got something that begins {data[:12]!r}"
        )
        return Inspection(kind, {}, [came])
    try:
        if kind == "layers" and not has_layers(data):
            decode_layers(data, suffix)  # names the format that was expected
        facts, problems = _INSPECTORS[kind](data)
    except InputError as error:
        return Inspection(kind, {}, [str(error)])
    except Exception as error:  # a defect that no reader names must not end the inspection of a file
        reason = reprlib.repr(str(error))
        return Inspection(kind, {}, [f"the file is damaged ({type(error).__name__}: {reason})"])
    return Inspection(kind, facts, problems)


def _kind_by_content(data: bytes, suffix: str) -> str | None:
    """The kind of a file by its first bytes, None if they do not tell.

    suffix: of its name, for zip archives that do not begin with their type.
    """
    if any(data.startswith(magic) for magic in _PICTURE_KINDS):
        return "picture"
    if has_layers(data):
        return "layers"
    if data.startswith(b"PK"):
        return "layers" if suffix == ".ora" and MIMETYPE not in data[:100] else "drawing"
    if b'"akap-recording"' in data[:200]:
        return "recording"
    if f'"{POSE_FORMAT}"'.encode() in data[:200]:
        return "pose"
    if f'"{CLIP_FORMAT}"'.encode() in data[:200]:
        return "clip"
    return "mesh" if data.startswith(b"glTF") else None


def _inspect_picture(data: bytes) -> tuple[Facts, list[str]]:
    image = decode_image(data)
    kind = next(name for magic, name in _PICTURE_KINDS.items() if data.startswith(magic))
    facts: Facts = {"format": kind, "width": image.shape[1], "height": image.shape[0]}
    return _mesh_facts(facts, image)


def _inspect_layers(data: bytes) -> tuple[Facts, list[str]]:
    return _layer_facts("Photoshop" if data.startswith(PSD_MAGIC) else "OpenRaster", decode_layers(data))


def _layer_facts(kind: str, layered: LayeredPicture) -> tuple[Facts, list[str]]:
    width, height = layered.size
    facts: Facts = {"format": kind, "width": width, "height": height, "layers": len(layered.layers)}
    facts["groups"] = len({id(group) for layer in layered.layers for group in layer.groups})
    facts["hidden layers"] = len(hidden_layers(layered))
    if layered.left_out:
        facts["not drawn"] = "; ".join(layered.left_out)
    return _mesh_facts(facts, composite(layered))


def _mesh_facts(facts: Facts, image: Picture) -> tuple[Facts, list[str]]:
    """Add what a picture (h, w, 4) becomes as a drawing."""
    facts["transparent"] = has_transparency(image)
    try:
        meshed = mesh_picture(image[..., 3], threshold=fitting_threshold(image[..., 3]))
    except InputError as error:
        return facts, [str(error)]
    facts |= {"parts": meshed.parts, "holes": meshed.holes, "specks left out": meshed.specks}
    return facts, []


def _inspect_drawing(data: bytes) -> tuple[Facts, list[str]]:
    document = decode_document(data)
    drawing, state = document.drawing, document.state
    measured = distortion(drawing.mesh, state.positions)
    facts = {
        "name": drawing.name,
        "width": drawing.size[0],
        "height": drawing.size[1],
        "vertices": len(drawing.mesh.vertices),
        "faces": len(drawing.mesh.faces),
        "parts": int(drawing.mesh.component.max()) + 1,
        **_drawing_layer_facts(drawing, len(state.joints)),
        **({"artwork": document.artwork.path.as_posix()} if document.artwork is not None else {}),
        "pins": len(state.pins),
        "poses": len(state.poses),
        "keyframes": len(state.animation.keyframes),
        "method": state.settings.method,
        "area distortion": round(measured.area, 6),
        "angle distortion": round(measured.angle, 6),
        "flipped faces": measured.flipped,
    }
    return facts, []


def _drawing_layer_facts(drawing: Drawing, joints: int) -> Facts:
    if not drawing.layers:
        return {}
    hidden = int((~shown_layers(drawing.layers)).sum())
    return {"layers": len(drawing.layers), "hidden layers": hidden, "joints": joints}


def _inspect_pose(data: bytes) -> tuple[Facts, list[str]]:
    record = parse_record(data)
    header = require(record, "drawing", dict)
    count, positions = (
        require(header, "vertices", int),
        pairs(require(record, "positions", list), "positions"),
    )
    pins = read_pins(require(record, "pins", list))
    facts = {"drawing": require(header, "name", str), "vertices": count, "pins": len(pins)}
    if len(positions) != count:
        return facts, [f"expected positions of {count} vertices, got {len(positions)}"]
    return facts, []


def _inspect_clip(data: bytes) -> tuple[Facts, list[str]]:
    clip = decode_clip(data)
    names = ", ".join(clip.names)
    return {"name": clip.name, "pins": names, "keys": len(clip.keys), "seconds": clip.duration}, []


def _inspect_recording(data: bytes) -> tuple[Facts, list[str]]:
    recording = decode_recording(data)
    actions = [event["do"] for event in recording.events]
    facts = {
        "drawing": recording.header.get("name"),
        "vertices": recording.header.get("vertices"),
        "seconds": recording.duration,
        "events": len(actions),
        "gestures": actions.count("commit"),
        "steps": actions.count("step"),
        "drawing inside": "akap" in recording.header,
    }
    return facts, []


def _inspect_mesh(data: bytes) -> tuple[Facts, list[str]]:
    mesh = decode_mesh(data)
    facts = {
        "format": mesh.kind,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "parts": count_parts(mesh),
        "low": mesh.vertices.min(axis=0).tolist(),
        "high": mesh.vertices.max(axis=0).tolist(),
    }
    return facts, mesh_defects(mesh)


_INSPECTORS: dict[str, Callable[[bytes], tuple[Facts, list[str]]]] = {
    "picture": _inspect_picture,
    "layers": _inspect_layers,
    "drawing": _inspect_drawing,
    "pose": _inspect_pose,
    "clip": _inspect_clip,
    "recording": _inspect_recording,
    "mesh": _inspect_mesh,
}
