"""Paths of bundled shaders and assets, in a checkout and in an installed wheel."""

from pathlib import Path

from .words import mark, tr

_TITLES = (
    *(mark("Alien"), mark("Bar"), mark("Cat"), mark("Elephant"), mark("Gingerbread")),
    *(mark("Raptor"), mark("Robot"), mark("Rope")),
    *(mark("Hop"), mark("Nod"), mark("Tail Wag"), mark("Walk in Place"), mark("Wave")),  # clips
)
PUPPET_SUFFIX = ".ora"  # of drawings in layers
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


def bundled_puppets() -> list[Path]:
    """The paths of the bundled puppets, OpenRaster files with layers, in alphabetical order."""
    return sorted(resource("assets", "drawings").glob(f"*{PUPPET_SUFFIX}"))


def bundled_files() -> list[Path]:
    """The paths of all bundled drawings and puppets, in alphabetical order of their names."""
    return sorted([*bundled_drawings(), *bundled_puppets()], key=lambda path: path.stem)


def drawing_title(path: Path) -> str:
    """The name of a bundled drawing in the user's language."""
    return tr(path.stem.capitalize())
