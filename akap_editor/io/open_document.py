"""Opens any file that can be edited as a document."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..display_text import display_name
from ..editor.document.document import Document, new_document
from ..editor.document.drawing import apply_mask, make_drawing
from ..editor.document.rig.suggestion import suggest_joints
from ..editor.session.replay import Replay
from ..errors import FileError, InputError, file_errors
from ..layers.composite import composite
from ..layers.drawing_layer import DrawingLayer
from ..layers.merging import movable_layers
from ..meshing.faint import DEFAULT_THRESHOLD, faint_share
from ..progress import announce, part
from ..words import tr, tr_plural
from .akap.project import PROJECT_SUFFIX, load
from .akap.recording import RECORDING_SUFFIX, read_recording, recorded_drawing
from .artwork_file import artwork_file, with_current_artwork
from .atomic import as_path, noted_reads
from .images import Picture, read_image, read_mask
from .layers.open_layers import is_layered, left_out_notes, merging_notes, open_layers
from .mesh_files.mesh_drawing import read_mesh
from .mesh_files.obj_off import PARSERS

PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
MESH_SUFFIXES = tuple(PARSERS)
THRESHOLD_OPTION = "--threshold"  # of the commands
MIN_REPORTED_SHARE = 0.01  # of the visible pixels


def open_document(
    path: str | Path,
    mask: str | Path | None = None,
    threshold: float | None = None,
    mesher: str | None = None,
    merge_layers: bool = False,
) -> Document:
    """Open a file as a document; the ending of its name decides how.

    .akap: the saved document; .akaprec: the document at the end of the recording; .obj, .off: a flat mesh,
    see `read_mesh`; any other: a picture, which is cut out along its alpha and meshed. A picture in layers
    (.psd, .psb, .ora, a folder of PNG pictures, see `open_layers`) becomes a drawing in layers.
    mask: a picture that is bright, or opaque, where the picture is to be visible; threshold: share of full
    opacity at which the picture ends, None for one that suits it; mesher: of a picture; for both see
    `make_drawing`; merge_layers: merge the visible layers into one picture.
    Raises InputError, which names the file, or SolverError if a recording cannot be replayed.
    """
    with noted_reads() as files:
        document = _open(as_path(path), mask, threshold, mesher, merge_layers)
    if mask is None and is_artwork(path):  # what a mask has cut out could not be reloaded
        document = replace(document, artwork=artwork_file(path))
    return replace(document, sources=tuple(files))


def is_artwork(path: str | Path) -> bool:
    """Whether the name of a file is one of a picture, flat or in layers."""
    return is_layered(path) or as_path(path).suffix.lower() in PICTURE_SUFFIXES


def _open(
    path: Path, mask: str | Path | None, threshold: float | None, mesher: str | None, merge_layers: bool
) -> Document:
    announce(0.0, tr("Reading the file"))
    suffix = path.suffix.lower()
    if mask is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise FileError(
            "use", mask, tr("a mask needs a picture, but {file} is none", file=display_name(path))
        )
    if threshold is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise InputError(tr("threshold: expected a picture to cut out, got {file}", file=display_name(path)))
    if suffix == PROJECT_SUFFIX:
        return with_current_artwork(load(path))
    if suffix == RECORDING_SUFFIX:
        return _open_recording(path)
    if suffix in MESH_SUFFIXES:
        return new_document(read_mesh(path))
    if is_layered(path) and not merge_layers:
        return _open_layered(path, mask, threshold, mesher)
    image, notes = read_picture(path)
    shown = read_mask(mask) if mask is not None else None
    with file_errors("open", path):
        if shown is not None:
            image = apply_mask(image, shown)
        with part(0.5 if is_layered(path) else 0.25, 1.0):
            drawing = make_drawing(image, threshold=threshold, name=path.stem, mesher=mesher)
        return replace(new_document(drawing), notes=notes)


def _open_layered(
    path: Path, mask: str | Path | None, threshold: float | None, mesher: str | None
) -> Document:
    """A document of a picture in layers; of one with a single layer, a flat one."""
    with part(0.0, 0.4):
        layered = open_layers(path)
    shown = read_mask(mask) if mask is not None else None
    notes = left_out_notes(layered)
    count = len(movable_layers(layered))  # the layers themselves would keep their pictures in memory
    with file_errors("open", path):
        with part(0.4, 1.0):
            options: dict[str, Any] = {"threshold": threshold, "name": path.stem, "mesher": mesher}
            if count > 1:
                drawing = make_drawing(None, shown, layers=layered, **options)
            else:
                drawing = make_drawing(composite(layered), shown, **options)
        document = replace(new_document(drawing), notes=tuple(notes))
        return replace(document, state=replace(document.state, joints=suggest_joints(drawing)))


def _layer_note(layers: Sequence[DrawingLayer]) -> str:
    """A sentence about the layers of a drawing."""
    hidden = sum(not layer.visible for layer in layers)
    opened = tr_plural("Opened {count} layer", "Opened {count} layers", len(layers))
    if hidden:
        opened = tr("{opened}, {hidden} of them hidden", opened=opened, hidden=hidden)
    return tr("{opened}; Merge Layers in the File menu makes one drawing of them", opened=opened)


def read_picture(path: str | Path) -> tuple[Picture, tuple[str, ...]]:
    """The picture (h, w, 4) uint8, straight alpha, of a picture file, or of one in layers.

    The visible layers are merged; the second value is sentences, without period, about this and about what
    is left out. Raises FileError.
    """
    if not is_layered(path):
        return read_image(path), ()
    with part(0.0, 0.4):
        layered = open_layers(path)
    with part(0.4, 0.5):
        return composite(layered), tuple(merging_notes(layered))


def opening_notes(document: Document, setting: str = THRESHOLD_OPTION) -> list[str]:
    """Sentences about a picture that was opened: merged layers, a lower threshold, and faint parts.

    setting: where a lower threshold can be chosen.
    """
    drawing = document.drawing
    if document.path is not None or drawing.meshing is None:
        return []
    if drawing.layers:
        in_window = setting != THRESHOLD_OPTION
        return [*([_layer_note(drawing.layers)] if in_window else []), *document.notes]
    alpha, threshold, notes = drawing.image[..., 3], drawing.meshing.threshold, list(document.notes)
    most = int(alpha.max())
    if most <= 255 * DEFAULT_THRESHOLD and threshold < DEFAULT_THRESHOLD:
        notes.append(
            tr(
                "The picture is faint, at most {most:.0%} opaque, so it was cut out at {threshold:.0%} "
                "opacity",
                most=most / 255,
                threshold=threshold,
            )
        )
    share = faint_share(alpha, drawing.mesh, threshold)
    if share >= MIN_REPORTED_SHARE:
        notes.append(faint_note(share, setting))
    return notes


def faint_note(share: float, setting: str = THRESHOLD_OPTION) -> str:
    """A sentence about the share of the visible pixels that the threshold cuts off; see `opening_notes`."""
    return tr(
        "{share:.0%} of what is visible is fainter than the edge and left out; "
        "a lower alpha threshold ({setting}) keeps it",
        share=share,
        setting=setting,
    )


def _open_recording(path: Path) -> Document:
    """The document at the end of a recording."""
    recording = read_recording(path)
    with file_errors("open", path):
        replay = Replay(recording, recorded_drawing(recording))
        for _ in replay.events():
            pass
        if replay.session is None:
            raise InputError(tr("the recording is empty"))
        return replay.end().document
