"""Opens any file that can be edited as a document."""

from pathlib import Path

from ..display_text import display_name
from ..editor.document.document import Document, new_document
from ..editor.document.drawing import apply_mask, make_drawing
from ..editor.session.replay import Replay
from ..errors import FileError, InputError, file_errors
from ..meshing.faint import DEFAULT_THRESHOLD, faint_share, fitting_threshold
from ..progress import announce, part
from .akap.project import PROJECT_SUFFIX, load
from .akap.recording import RECORDING_SUFFIX, read_recording, recorded_drawing
from .atomic import as_path
from .images import read_image, read_mask
from .mesh_files.mesh_drawing import read_mesh
from .mesh_files.obj_off import PARSERS

PICTURE_SUFFIXES = (".png", ".webp", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")
MESH_SUFFIXES = tuple(PARSERS)
MIN_REPORTED_SHARE = 0.01  # of the visible pixels


def open_document(
    path: str | Path,
    mask: str | Path | None = None,
    threshold: float | None = None,
    mesher: str | None = None,
) -> Document:
    """Open a file as a document; the ending of its name decides how.

    .akap: the saved document; .akaprec: the document at the end of the recording; .obj, .off: a flat mesh,
    see `read_mesh`; any other: a picture, which is cut out along its alpha and meshed.
    mask: a picture that is bright, or opaque, where the picture is to be visible; threshold: share of full
    opacity at which the picture ends, None for one that suits it, see `fitting_threshold`; mesher: of a
    picture, see `make_drawing`.
    Raises InputError, which names the file, or SolverError if a recording cannot be replayed.
    """
    path = as_path(path)
    announce(0.0, "Reading the file")
    suffix = path.suffix.lower()
    if mask is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise FileError("use", mask, f"a mask needs a picture, but {display_name(path)} is none")
    if threshold is not None and suffix in (PROJECT_SUFFIX, RECORDING_SUFFIX, *MESH_SUFFIXES):
        raise InputError(f"threshold: expected a picture to cut out, got {display_name(path)}")
    if suffix == PROJECT_SUFFIX:
        return load(path)
    if suffix == RECORDING_SUFFIX:
        return _open_recording(path)
    if suffix in MESH_SUFFIXES:
        return new_document(read_mesh(path))
    image = read_image(path)
    shown = read_mask(mask) if mask is not None else None
    with file_errors("open", path):
        if shown is not None:
            image = apply_mask(image, shown)
        if threshold is None:
            threshold = fitting_threshold(image[..., 3])
        with part(0.25, 1.0):
            drawing = make_drawing(image, threshold=threshold, name=path.stem, mesher=mesher)
        return new_document(drawing)


def opening_notes(document: Document) -> list[str]:
    """Sentences about what was cut off a picture that was opened: a lower threshold, and faint parts."""
    drawing = document.drawing
    if document.path is not None or drawing.meshing is None:
        return []
    alpha, threshold, notes = drawing.image[..., 3], drawing.meshing.threshold, []
    most = int(alpha.max())
    if most <= 255 * DEFAULT_THRESHOLD and threshold < DEFAULT_THRESHOLD:
        notes.append(
            f"The picture is faint, at most {most / 255:.0%} opaque, so it was cut out at {threshold:.0%} "
            "opacity"
        )
    share = faint_share(alpha, drawing.mesh, threshold)
    if share >= MIN_REPORTED_SHARE:
        notes.append(faint_note(share))
    return notes


def faint_note(share: float) -> str:
    """A sentence about the share of the visible pixels that the threshold cuts off."""
    return (
        f"{share:.0%} of what is visible is fainter than the edge and left out; "
        "a lower alpha threshold (--threshold) keeps it"
    )


def _open_recording(path: Path) -> Document:
    """The document at the end of a recording."""
    recording = read_recording(path)
    with file_errors("open", path):
        replay = Replay(recording, recorded_drawing(recording))
        for _ in replay.events():
            pass
        if replay.session is None:
            raise InputError("the recording is empty")
        return replay.end().document
