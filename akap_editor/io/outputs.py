"""Keeps exports from replacing files that nobody named, and their own sources."""

import os
from collections.abc import Iterable
from pathlib import Path

from ..display_text import display_name
from ..errors import FileError, joined
from ..words import tr, tr_plural

_MOST_NAMES = 3  # in a message


def existing(paths: Iterable[Path]) -> list[Path]:
    """The paths at which there is something, be it a link that leads nowhere."""
    return [path for path in paths if os.path.lexists(path)]


def unused_path(path: Path, *suffixes: str) -> Path:
    """``path``, or the first of name-2, name-3, ... that exists neither as it is nor with the suffixes."""
    number = 1
    unused = path
    while existing([unused, *map(unused.with_suffix, suffixes)]):
        number += 1
        unused = path.with_stem(f"{path.stem}-{number}")
    return unused


def quoted_names(paths: list[Path]) -> str:
    """The names of files in a sentence: "“a”, “b” and 3 more"."""
    names = [tr("“{file}”", file=display_name(path)) for path in paths[:_MOST_NAMES]]
    if len(paths) > _MOST_NAMES:
        names[_MOST_NAMES - 1 :] = [tr("{count} more", count=len(paths) - _MOST_NAMES + 1)]
    return joined(names, tr("{names} and {last}"))


def refuse_replacing(path: Path, unnamed: Iterable[Path], overwrite: bool) -> None:
    """Raise FileError for an export to ``path`` that would replace other files, unless ``overwrite``.

    unnamed: the files that would be written besides ``path``.
    """
    replaced = [] if overwrite else existing(unnamed)
    if replaced:
        reason = tr_plural(
            "{files} exists already; choose another name, or replace them (--overwrite)",
            "{files} exist already; choose another name, or replace them (--overwrite)",
            len(replaced),
            files=quoted_names(replaced),
        )
        raise FileError("export", path, reason)


def refuse_source(path: Path, sources: Iterable[Path | None], overwrite: bool) -> None:
    """Raise FileError if ``path`` is one of the files that the export reads, unless ``overwrite``."""
    if not overwrite and is_source(path, sources):
        reason = tr("it is a file that is read; choose another name, or replace it (--overwrite)")
        raise FileError("export", path, reason)


def is_source(path: Path, sources: Iterable[Path | None]) -> bool:
    """Whether ``path`` is one of the files, by whatever name."""
    return any(source is not None and same_file(path, source) for source in sources)


def same_file(path: Path, other: Path) -> bool:
    """Whether two paths lead to one file, which exists."""
    try:
        return os.path.samefile(path, other)
    except (OSError, ValueError):
        return False
