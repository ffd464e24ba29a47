"""Zip archives: equal bytes for equal content, and damage of any kind as one sentence."""

import struct
import zipfile
from io import BytesIO

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.akap import archive
from akap_editor.io.akap.archive import Archive, pack

ENTRIES = [("first.json", b"{}" * 50, True), ("second.bin", bytes(range(8)), False)]


def zipped(*entries, method=zipfile.ZIP_STORED):
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as file:
        for name, content in entries:
            file.writestr(zipfile.ZipInfo(name), content, method)
    return buffer.getvalue()


def test_entries_are_read_back_and_packed_to_the_same_bytes():
    data = pack(ENTRIES)
    assert data == pack(ENTRIES)
    packed = Archive(data)
    for name, content, _ in ENTRIES:
        assert name in packed
        assert packed.read(name, 1000) == content
    assert "third" not in packed


def test_an_array_is_read_in_the_order_of_bytes_of_the_file():
    values = np.array([[1.5, -2.0], [3.25, 4.0], [0.0, 1e300]])
    packed = Archive(pack([("values", values.astype(">f8").tobytes(), True)]))
    array = packed.read_array("values", ">f8", 3, 2)
    assert np.array_equal(array, values)
    assert array.dtype.isnative


def truncated_size() -> bytes:
    """An archive whose directory says that its entry is one byte longer than it is."""
    data = bytearray(zipped(("a", b"12345678")))
    directory = data.index(b"PK\x01\x02")
    struct.pack_into("<I", data, directory + 24, 9)
    return bytes(data)


DAMAGE = {
    "empty": (b"", "damaged or not an .akap file"),
    "cut": (b"PK\x03\x04" + bytes(30), "damaged or not an .akap file"),
    "missing": (zipped(("b", b"")), "expected the entry a, which is missing"),
    "too large": (zipped(("a", b"123456789")), "a: expected at most 8 bytes, got 9"),
    "method": (zipped(("a", b"12345678"), method=zipfile.ZIP_BZIP2), "a: expected no compression or deflate"),
    "checksum": (zipped(("a", b"12345678")).replace(b"12345678", b"12345679"), "a: the entry is damaged"),
    "lie": (truncated_size(), "a: expected at most 8 bytes, got 9"),
}


@pytest.mark.parametrize(("data", "message"), DAMAGE.values(), ids=DAMAGE)
def test_damage_is_told_in_one_sentence(data, message):
    with pytest.raises(InputError, match=message):
        Archive(data).read("a", 8)


def test_a_name_that_occurs_twice_is_refused():
    with pytest.warns(UserWarning, match="Duplicate"):
        data = zipped(("a", b"1"), ("a", b"2"))
    with pytest.raises(InputError, match="expected each entry once, got 'a' 2 times"):
        Archive(data)


def test_the_limit_holds_for_all_entries_together(monkeypatch):
    monkeypatch.setattr(archive, "MAX_EXPANDED_BYTES", 100)
    packed = Archive(pack([("a", bytes(60), True), ("b", bytes(60), True)]))
    packed.read("a", 60)
    with pytest.raises(InputError, match="at most 100 bytes in all, got 120 or more"):
        packed.read("b", 60)


def test_an_array_of_another_size_is_refused():
    packed = Archive(pack([("values", bytes(8), False)]))
    with pytest.raises(InputError, match=r"values: expected 16 bytes for shape \(2, 1\), got 8"):
        packed.read_array("values", "<f8", 2, 1)
