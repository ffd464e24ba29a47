"""`akap-editor bench`: figures that make sense; how long a step takes is not tested."""

import json

import pytest

from tests.support.command_line import assert_one_line


def test_figures(run):
    options = ("--sizes", "200,400", "--frames", "3", "-m", "akap", "-m", "arap", "--json")
    code, said, _ = run("bench", *options)
    assert code == 0
    rows = json.loads(said)
    assert [row["method"] for row in rows] == ["akap", "arap"] * 2
    for row in rows:
        assert 2 <= row["area"] < 2.5
        assert 2 <= row["angle"] < 2.5
        assert 0 < row["median_ms"] <= row["slowest_ms"]
        assert row["flipped"] == 0
        assert row["pin_error"] < 50
    assert rows[0]["vertices"] < rows[2]["vertices"]


def test_table(run):
    code, said, _ = run("bench", "--sizes", "200", "--frames", "2")
    assert code == 0
    head, row = said.splitlines()
    assert len(head) == len(row)
    assert row.split()[0] == "akap:memory=1"


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--sizes", "many"], "'many'"),
        (["--sizes", "5"], "100 to 100000"),
        (["--frames", "0"], "1 to 10000"),
        (["-m", "magic"], "magic"),
    ],
)
def test_bad_options(run, options, part):
    assert_one_line(run("bench", *options), part)
