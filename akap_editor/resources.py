"""Finds shaders and assets, in a checkout and in an installed wheel alike."""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def resource(*parts: str) -> Path:
    """Path of a bundled file or folder, e.g. ``resource("assets", "drawings", "cat.png")``.

    A wheel carries ``shaders`` and ``assets`` inside the package, a checkout beside it.
    Raises FileNotFoundError where neither holds it: the installation is damaged.
    """
    for root in (_PACKAGE, _PACKAGE.parent):
        path = root.joinpath(*parts)
        if path.exists():
            return path
    raise FileNotFoundError(f"bundled file {'/'.join(parts)} is missing: the installation is incomplete")


def bundled_drawings() -> list[Path]:
    """The drawings that come with the program, as paths of PNG files in order of name."""
    return sorted(resource("assets", "drawings").glob("*.png"))
