"""Names of all kinds as people see them."""

from pathlib import Path

import pytest

from akap_editor.display_text import display_name, display_text, file_stem, shortened
from tests.support.names import assert_readable, strange_names

CASES = {
    "cat.png": "cat.png",
    "käse & 猫": "käse & 猫",
    "a\N{NO-BREAK SPACE}b": "a\N{NO-BREAK SPACE}b",
    "\N{MAN}\u200d\N{WOMAN}": "\N{MAN}\u200d\N{WOMAN}",  # joined to one emoji
    "caf\udce9": r"caf\xe9",
    "\ud800": r"\ud800",
    "a\nb\tc\0": r"a\nb\tc\x00",
    "\x1b[31m": r"\x1b[31m",
    "\x9b31m": r"\x9b31m",
    "gnp.\u202ecod": r"gnp.\u202ecod",
    "\u2028\ufeff\uffff\ufdd0": r"\u2028\ufeff\uffff\ufdd0",
    "\U000e0041": r"\U000e0041",
}


@pytest.mark.parametrize("text", CASES, ids=ascii)
def test_what_has_no_shape_is_escaped_and_the_rest_stays(text):
    assert display_text(text) == CASES[text]
    assert display_text(CASES[text]) == CASES[text], "once is enough"


def test_lines_stay_on_demand():
    assert display_text("a\nb\x1b", keeps_lines=True) == "a\nb\\x1b"


def test_the_name_of_a_path():
    assert display_name(Path("/a\n/b\udcff.png")) == r"b\xff.png"


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("cat", "cat"),
        ("a/b\\c:d", "a_b_c_d"),
        ("../../etc/passwd", "_.._etc_passwd"),
        ("", "drawing"),
        (" . ", "drawing"),
        ("caf\udce9", "caf_xe9"),
        ("猫" * 300, "猫" * 66),
    ],
)
def test_stems_of_files(name, stem):
    assert file_stem(name) == stem


@pytest.mark.parametrize("length", [0, 1, 29, 30, 31, 5000])
def test_a_long_text_keeps_its_beginning_and_its_end(length):
    text = ("abc" * length)[:length]
    short = shortened(text, 30)
    assert len(short) <= 30
    assert (short == text) == (length <= 30)
    assert text.startswith(short[:10])
    assert text.endswith(short[-10:])


@pytest.mark.parametrize("name", strange_names())
def test_every_strange_name_becomes_readable(name):
    for text in (display_text(name), file_stem(name)):
        assert_readable(text)
        assert "\n" not in text
