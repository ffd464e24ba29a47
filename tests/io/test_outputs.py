"""Which files an export may replace."""

import os
from pathlib import Path

import pytest

from akap_editor.errors import InputError
from akap_editor.io.outputs import existing, quoted_names, refuse_replacing, refuse_source, unused_path


def test_what_exists(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    (tmp_path / "link to nowhere").symlink_to(tmp_path / "nowhere")
    names = sorted(os.listdir(tmp_path))
    assert existing([*(tmp_path / name for name in names), tmp_path / "none"]) == [
        tmp_path / name for name in names
    ]


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (["a"], "“a”"),
        (["a", "b"], "“a” and “b”"),
        (["a", "b", "c"], "“a”, “b” and “c”"),
        (["a", "b", "c", "d"], "“a”, “b” and 2 more"),
        (["a\n\udcff"], r"“a\n\xff”"),
    ],
)
def test_names_in_a_sentence(names, text):
    assert quoted_names([Path("folder", name) for name in names]) == text


def test_unnamed_files_are_refused_unless_overwritten(tmp_path):
    (tmp_path / "a.mtl").write_bytes(b"")
    unnamed = [tmp_path / "a.mtl", tmp_path / "a.png"]
    with pytest.raises(
        InputError, match=r"^Couldn't export “.*a\.obj”\. “a\.mtl” exists already; .* \(--overwrite\)\.$"
    ):
        refuse_replacing(tmp_path / "a.obj", unnamed, overwrite=False)
    refuse_replacing(tmp_path / "a.obj", unnamed, overwrite=True)
    refuse_replacing(tmp_path / "a.obj", unnamed[1:], overwrite=False)


@pytest.mark.parametrize("kind", ["itself", "another path", "a link", "a hard link"])
def test_the_source_is_refused_however_it_is_named(tmp_path, kind):
    source = tmp_path / "cat.png"
    source.write_bytes(b"")
    output = {"itself": source, "another path": tmp_path / "." / "x" / ".." / "cat.png"}.get(kind)
    (tmp_path / "x").mkdir()
    if output is None:
        output = tmp_path / "other.png"
        output.symlink_to(source) if kind == "a link" else output.hardlink_to(source)
    with pytest.raises(InputError, match="It is a file that is read"):
        refuse_source(output, [None, source], overwrite=False)
    refuse_source(output, [None, source], overwrite=True)
    refuse_source(tmp_path / "new.png", [None, source], overwrite=False)


def test_the_first_unused_path(tmp_path):
    path = tmp_path / "a.webp"
    assert unused_path(path, ".png") == path
    path.write_bytes(b"")
    (tmp_path / "a-2.png").write_bytes(b"")
    assert unused_path(path, ".png") == tmp_path / "a-3.webp"
    assert unused_path(path) == tmp_path / "a-2.webp"
