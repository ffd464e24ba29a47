"""Names of files that a system accepts, although people cannot read them or programs misread them."""

import os

import pytest

STRANGE_NAMES = {
    "not UTF-8": b"caf\xe9",
    "half of a UTF-8 character": b"\xc3",
    "a surrogate in UTF-8": b"\xed\xa0\x80",
    "an escape sequence": b"\x1b]0;title\x07\x1b[31mred",
    "lines and tabs": b"one\ntwo\rthree\tfour",
    "reversed": "gnp.\u202ecod".encode(),
    "no characters": "\uffff\ufdd0\ufeff".encode(),
    "signs of XML, OBJ and labels": b"<a> & 'b'##c###d #e %s %n \\f",
    "Chinese and an emoji": "\u732b\U0001f408".encode(),
}


def strange_names() -> list:
    """Parameters for a test: the stem of each name as Python has it."""
    return [pytest.param(os.fsdecode(name), id=title) for title, name in STRANGE_NAMES.items()]


def assert_readable(text: str) -> None:
    """Check that a text is one that any program and any terminal can show."""
    text.encode()
    assert not any(
        (ord(sign) < 32 and sign != "\n") or ord(sign) in (0x7F, 0x202E, 0xFFFF) for sign in text
    ), text
