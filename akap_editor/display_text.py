"""Text as people can read it: names of files and drawings with whatever cannot be shown escaped.

To the system a name is bytes, and may hold anything: bytes that are not UTF-8 (lone surrogates in Python),
line feeds, escape sequences of terminals, marks that reverse the direction of reading. Whatever shows a name
or writes it into a file of another program asks here first.
"""

import re
import unicodedata
from pathlib import Path

_JOINERS = "\u200c\u200d"  # belong to words of some languages, and to emoji
_ESCAPED_CATEGORIES = (
    "Cc",
    "Cf",
    "Cs",
    "Zl",
    "Zp",
)  # controls, marks without a shape, surrogates, separators
_SURROGATE_OF_BYTE = range(0xDC80, 0xDD00)  # in which Python puts the bytes that are not UTF-8
_CUT = " ... "  # in the middle of a long text
_MAX_STEM_BYTES = 200  # a name has 255, and gets an ending
_RESERVED = re.compile(r'[/\\:*?"<>|]')  # in names of files, on one of the systems


def display_text(value: object, keeps_lines: bool = False) -> str:
    r"""``str(value)`` with every character that has no shape escaped, as in "caf\xe9" for a byte E9.

    keeps_lines: leave line feeds as they are.
    """
    text = str(value)
    if text.isprintable():
        return text
    return "".join(
        character if character == "\n" and keeps_lines else _escaped(character) for character in text
    )


def display_name(path: Path) -> str:
    """The last part of a path, as people can read it."""
    return display_text(path.name)


def shortened(text: str, most: int) -> str:
    """A text of up to ``most`` characters for a message: its beginning and its end, if it is longer."""
    half = (most - len(_CUT)) // 2
    return text if len(text) <= most else f"{text[:half]}{_CUT}{text[-half:]}"


def file_stem(name: str) -> str:
    """A name for a file, without ending, that any system accepts: for a drawing of this name."""
    stem = _RESERVED.sub("_", display_text(name)).strip(" .")
    return stem.encode()[:_MAX_STEM_BYTES].decode(errors="ignore") or "drawing"


def _escaped(character: str) -> str:
    code = ord(character)
    if code in _SURROGATE_OF_BYTE:
        return f"\\x{code - 0xDC00:02x}"
    is_shapeless = unicodedata.category(character) in _ESCAPED_CATEGORIES and character not in _JOINERS
    is_no_character = code & 0xFFFE == 0xFFFE or 0xFDD0 <= code <= 0xFDEF  # XML refuses them
    if not is_shapeless and not is_no_character:
        return character
    return character.encode("unicode_escape", "surrogatepass").decode("ascii")
