"""Notices that the picture of the open drawing was changed by another program."""

from pathlib import Path

from ...io.layers.open_layers import is_layered
from ...io.open_document import PICTURE_SUFFIXES
from ..app_state import AppState


class ArtworkWatch:
    """Knows when the file of the artwork was last written, as far as the drawing goes."""

    def __init__(self) -> None:
        self._known: tuple[Path, float] | None = None

    def has_changed(self, path: Path) -> bool:
        """Whether a file was written since the last call with this path, or `remember`."""
        time, known = _modified(path), self._known
        self._known = path, time
        return known is not None and known[0] == path and time > known[1]

    def remember(self, path: Path) -> None:
        """Take the file as it is now for known."""
        self._known = path, _modified(path)


def _modified(path: Path) -> float:
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def artwork_path(state: AppState) -> Path | None:
    """The picture that the open drawing was made from, None if it is not known, or no file any more."""
    sources = state.document.sources if state.document is not None else ()
    known = (path for path in sources if is_layered(path) or path.suffix.lower() in PICTURE_SUFFIXES)
    return next((path for path in known if path.exists()), None)
