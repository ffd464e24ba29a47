"""Notices that the picture of the open drawing was changed by another program."""

from pathlib import Path

from ...io.layers.open_layers import LAYER_SUFFIXES
from ..app_state import AppState

_Stamp = tuple[tuple[str, int, int], ...]  # of each file: name, time of the last change in ns, size


class ArtworkWatch:
    """Knows when the file of the artwork was last written, as far as the drawing goes."""

    def __init__(self) -> None:
        self._known: tuple[Path, _Stamp] | None = None

    def has_changed(self, path: Path) -> bool:
        """Whether a file was written since the last call with this path, or `remember`."""
        stamp, known = _stamp(path), self._known
        self._known = path, stamp
        return known is not None and known[0] == path and bool(stamp) and stamp != known[1]

    def remember(self, path: Path) -> None:
        """Take the file as it is now for known."""
        self._known = path, _stamp(path)


def _stamp(path: Path) -> _Stamp:
    """Of a picture file, or of the pictures in a folder of layers; empty if it cannot be told."""
    try:
        is_file = path.suffix.lower() in LAYER_SUFFIXES or not path.is_dir()
        files = [path] if is_file else sorted(path.glob("*.[pP][nN][gG]"))
        return tuple((each.name, each.stat().st_mtime_ns, each.stat().st_size) for each in files)
    except OSError:
        return ()


def artwork_path(state: AppState) -> Path | None:
    """The picture that the open drawing was made from, None if it is not known, or no file any more."""
    artwork = state.document.artwork if state.document is not None else None
    return artwork.path if artwork is not None and artwork.path.exists() else None
