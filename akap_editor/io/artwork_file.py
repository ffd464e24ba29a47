"""The picture file that a drawing was made from: its content, and whether it has changed."""

import hashlib
from dataclasses import replace
from pathlib import Path

from ..editor.document.document import ArtworkFile, Document
from .atomic import MAX_FILE_BYTES, as_path, resolved

_CHUNK = 2**20  # bytes


def artwork_file(path: str | Path) -> ArtworkFile:
    """The file of a picture or the folder of layers, as it is now."""
    path = as_path(path)
    return ArtworkFile(resolved(path), _digest(path))


def with_current_artwork(document: Document) -> Document:
    """A document whose artwork says whether the file has changed, and is looked for beside its own file.

    There it is looked for if it is not where the document says.
    """
    artwork = document.artwork
    if artwork is None:
        return document
    if not artwork.path.exists() and document.path is not None:
        beside = resolved(document.path).parent / artwork.path.name
        artwork = replace(artwork, path=beside) if beside.exists() else artwork
    digest = _digest(artwork.path) if artwork.digest else ""
    has_changed = bool(digest) and digest != artwork.digest
    return replace(document, artwork=replace(artwork, has_changed=has_changed))


def _digest(path: Path) -> str:
    """SHA-256 of a file, or of the names and contents of a folder's PNG pictures; "" if it is unreadable."""
    total = hashlib.sha256()
    try:
        if path.is_dir():
            for each in sorted(path.glob("*.[pP][nN][gG]")):
                total.update(f"{each.name}\0{_digest(each)}\n".encode(errors="surrogateescape"))
        else:
            if not path.is_file() or path.stat().st_size > MAX_FILE_BYTES:
                return ""
            with path.open("rb") as file:
                while chunk := file.read(_CHUNK):
                    total.update(chunk)
    except OSError:
        return ""
    return total.hexdigest()
