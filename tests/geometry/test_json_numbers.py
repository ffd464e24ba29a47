"""Numbers of JSON that somebody else wrote."""

import json

import pytest

from akap_editor.errors import InputError
from akap_editor.geometry.json_numbers import MAX_INTEGER, bounded_integer, finite_float, refuse_constant


def parse(text):
    return json.loads(
        text, parse_int=bounded_integer, parse_float=finite_float, parse_constant=refuse_constant
    )


@pytest.mark.parametrize("value", [0, -1, MAX_INTEGER, -MAX_INTEGER, 0.5, -2.5e300, 5e-324])
def test_numbers_that_a_float_holds_are_read(value):
    assert parse(json.dumps([value])) == [value]


@pytest.mark.parametrize(
    "text",
    [
        str(MAX_INTEGER + 1),
        str(-MAX_INTEGER - 1),
        "9" * 18,
        "9" * 5000,
        "1e999",
        "-1e999",
        "NaN",
        "-Infinity",
    ],
    ids=lambda text: text[:20],
)
def test_others_are_refused_in_a_short_sentence(text):
    with pytest.raises(InputError, match="expected") as refusal:
        parse(f"[{text}]")
    assert len(str(refusal.value)) < 150
