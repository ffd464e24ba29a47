"""Reads untrusted zip archives, and writes archives that have equal bytes for equal content."""

import reprlib
import zipfile
from collections import Counter
from collections.abc import Iterable
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError
from ...words import mark, tr

MAX_EXPANDED_BYTES = 2**30  # of all entries that are read, and of the pixels of all pictures

ArchiveEntry = tuple[str, bytes, bool]  # name, content, whether it is worth compressing


def pack(entries: Iterable[ArchiveEntry]) -> bytes:
    """A zip archive of the entries, in this order; equal entries give equal bytes, as all have one date."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content, compressed in entries:
            info = zipfile.ZipInfo(name)
            info.create_system = 3  # Unix, on all systems
            info.external_attr = 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED if compressed else zipfile.ZIP_STORED
            archive.writestr(info, content, compresslevel=1)
    return buffer.getvalue()


def check_expanded(size: int) -> None:
    """Raise InputError if a document would expand to more than `MAX_EXPANDED_BYTES`."""
    if size > MAX_EXPANDED_BYTES:
        raise InputError(
            tr("expected at most {most} bytes in all, got {size} or more", most=MAX_EXPANDED_BYTES, size=size)
        )


class Archive:
    """Reads the entries of a zip file by their exact names. Each name may occur once.

    kind: what the file should be, for messages. All methods raise InputError on damage of any kind, and
    nothing else.
    """

    def __init__(self, data: bytes, kind: str = mark("an .akap file")) -> None:
        try:
            self._archive = zipfile.ZipFile(BytesIO(data))
        except Exception as error:  # zipfile reports damage with exceptions of many kinds
            raise InputError(tr("the file is damaged or not {kind}", kind=tr(kind))) from error
        entries = self._archive.infolist()
        self._entries = {entry.filename: entry for entry in entries}
        self._expanded = 0
        if len(self._entries) < len(entries):
            name, count = Counter(entry.filename for entry in entries).most_common(1)[0]
            raise InputError(
                tr("expected each entry once, got {name} {count} times", name=reprlib.repr(name), count=count)
            )

    def __contains__(self, name: str) -> bool:
        return name in self._entries

    def read(self, name: str, most: int) -> bytes:
        """The content of an entry that has at most ``most`` bytes."""
        if name not in self:
            raise InputError(tr("expected the entry {name}, which is missing", name=name))
        entry = self._entries[name]
        if entry.file_size > most:
            raise InputError(
                tr(
                    "{name}: expected at most {most} bytes, got {size}",
                    name=name,
                    most=most,
                    size=entry.file_size,
                )
            )
        self.count_expanded(entry.file_size)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise InputError(
                tr(
                    "{name}: expected no compression or deflate, got method {method}",
                    name=name,
                    method=entry.compress_type,
                )
            )
        try:
            with self._archive.open(entry) as file:
                content = file.read(entry.file_size)  # the bound stops an entry whose size is a lie
        except Exception as error:
            raise InputError(tr("{name}: the entry is damaged", name=name)) from error
        if len(content) != entry.file_size:
            raise InputError(
                tr(
                    "{name}: expected {size} bytes, got {got}",
                    name=name,
                    size=entry.file_size,
                    got=len(content),
                )
            )
        return content

    def count_expanded(self, size: int) -> None:
        """Add bytes to what the archive expands to. Raises InputError above `MAX_EXPANDED_BYTES`."""
        self._expanded += size
        check_expanded(self._expanded)

    def read_array(self, name: str, dtype: str, rows: int, columns: int) -> NDArray[Any]:
        """The array (rows, columns) of an entry without a header, row by row; in the machine's byte order."""
        size = rows * columns * np.dtype(dtype).itemsize
        content = self.read(name, size)
        if len(content) != size:
            raise InputError(
                tr(
                    "{name}: expected {size} bytes for shape ({rows}, {columns}), got {got}",
                    name=name,
                    size=size,
                    rows=rows,
                    columns=columns,
                    got=len(content),
                )
            )
        array = np.frombuffer(content, dtype).reshape(rows, columns)
        return array.astype(array.dtype.newbyteorder("="))
