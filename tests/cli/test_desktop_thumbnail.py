"""`akap-editor thumbnail`, as file managers call it."""

import pytest
from PIL import Image

from tests.support.command_line import assert_one_line


def test_a_thumbnail_of_the_size_asked_for(run, posed, tmp_path):
    assert run("thumbnail", "--size", 45, posed, tmp_path / "out.png") == (0, "", "")
    with Image.open(tmp_path / "out.png") as picture:
        assert picture.size == (45, 30)


@pytest.mark.parametrize("size", [0, -1, 10_000])
def test_bad_sizes_are_refused(run, posed, tmp_path, size):
    result = run("thumbnail", "--size", size, posed, tmp_path / "out.png")
    assert_one_line(result, "--size: expected a number from 1 to 2048")
