"""Paths of bundled shaders and assets, in a checkout and in an installed wheel."""

from pathlib import Path

from .words import mark, tr

_TITLES = (
    *(mark("Alien"), mark("Bar"), mark("Cat"), mark("Elephant"), mark("Gingerbread")),
    *(mark("Raptor"), mark("Rope")),
)
_PACKAGE = Path(__file__).resolve().parent


def resource(*parts: str) -> Path:
    """The path of a bundled file or folder, e.g. ``resource("assets", "drawings", "cat.png")``.

    A wheel has ``shaders`` and ``assets`` inside the package, a checkout beside it.
    Raises FileNotFoundError if neither has the file: the installation is damaged.
    """
    for root in (_PACKAGE, _PACKAGE.parent):
        path = root.joinpath(*parts)
        if path.exists():
            return path
    raise FileNotFoundError(f"bundled file {'/'.join(parts)} is missing: the installation is incomplete")


def bundled_drawings() -> list[Path]:
    """The paths of the bundled drawings, PNG files, in alphabetical order."""
    return sorted(resource("assets", "drawings").glob("*.png"))


def drawing_title(path: Path) -> str:
    """The name of a bundled drawing in the user's language."""
    return tr(path.stem.capitalize())
