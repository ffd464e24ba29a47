import errno
import os
import stat
from pathlib import Path

import pytest

from akap_editor.errors import InputError
from akap_editor.io import atomic
from akap_editor.io.atomic import read_file, resolved, write_atomic

posix = pytest.mark.skipif(os.name != "posix", reason="permission bits, links and pipes are those of POSIX")


def fail(*_args, **_kwargs):
    raise OSError(errno.ENOSPC, "No space left on device")


def interrupt(*_args, **_kwargs):
    raise KeyboardInterrupt


class FullDisk:
    """A file that takes half of what is written and fails."""

    def __init__(self, file):
        self.file = file

    def __enter__(self):
        return self

    def __exit__(self, *_exception):
        self.file.close()

    def write(self, data):
        self.file.write(data[: len(data) // 2])
        fail()


def fail_to_write(monkeypatch):
    real = atomic.open_new
    monkeypatch.setattr(atomic, "open_new", lambda path, mode: FullDisk(real(path, mode)))


def test_a_name_that_the_locale_cannot_write_is_one_sentence(tmp_path):
    """As "猫" where names of files are Latin-1; half a surrogate is one where they are UTF-8."""
    for act in (lambda path: write_atomic(path, b""), lambda path: read_file(path, "a file")):
        with pytest.raises(
            InputError, match=r"The names of files have no such characters in the present locale"
        ):
            act(tmp_path / "\ud800.png")


def test_written_is_what_is_read(tmp_path):
    path = tmp_path / "new.bin"
    for data in (b"first", b"", bytes(range(256)) * 1000):
        write_atomic(path, data)
        assert read_file(path, "a file") == data
    assert os.listdir(tmp_path) == ["new.bin"]


def test_reads_are_noted_also_in_blocks_inside_one_another(tmp_path):
    files = [tmp_path / name for name in "abc"]
    for path in files:
        path.write_bytes(b"")
    with atomic.noted_reads() as all_reads:
        read_file(files[0], "a file")
        with atomic.noted_reads() as inner:
            read_file(files[1], "a file")
            with pytest.raises(InputError):
                read_file(tmp_path / "none", "a file")
    read_file(files[2], "a file")
    assert (all_reads, inner) == (files[:2], files[1:2])


FAILURES = {
    "open": lambda patch: patch.setattr(atomic, "open_new", fail),
    "write": fail_to_write,
    "flush to disk": lambda patch: patch.setattr(atomic.os, "fsync", fail),
    "permission bits": lambda patch: patch.setattr(atomic.shutil, "copymode", fail),
    "move": lambda patch: patch.setattr(atomic.os, "replace", fail),
}


@pytest.mark.parametrize("step", FAILURES)
def test_failure_leaves_old_file_and_no_other(tmp_path, monkeypatch, step):
    path = tmp_path / "kept.bin"
    path.write_bytes(b"old")
    with monkeypatch.context() as patch:
        FAILURES[step](patch)
        with pytest.raises(InputError, match=r"^Couldn't save “.*kept\.bin”\. No space left on device\.$"):
            write_atomic(path, b"new content")
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["kept.bin"]


def test_interrupt_leaves_old_file_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "kept.bin"
    path.write_bytes(b"old")
    monkeypatch.setattr(atomic.os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_atomic(path, b"new")
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["kept.bin"]


def test_failure_of_a_new_file_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(atomic.os, "replace", fail)
    with pytest.raises(InputError):
        write_atomic(tmp_path / "new.bin", b"new")
    assert os.listdir(tmp_path) == []


@posix
def test_new_file_follows_umask_and_old_bits_are_kept(tmp_path):
    old_umask = os.umask(0o027)
    try:
        write_atomic(tmp_path / "new.bin", b"new")
        (tmp_path / "old.bin").write_bytes(b"old")
        (tmp_path / "old.bin").chmod(0o604)
        write_atomic(tmp_path / "old.bin", b"new")
    finally:
        os.umask(old_umask)
    assert stat.S_IMODE((tmp_path / "new.bin").stat().st_mode) == 0o640
    assert stat.S_IMODE((tmp_path / "old.bin").stat().st_mode) == 0o604


@posix
def test_link_stays_a_link(tmp_path):
    (tmp_path / "folder").mkdir()
    target, link = tmp_path / "folder" / "target.bin", tmp_path / "link.bin"
    target.write_bytes(b"old")
    link.symlink_to(target)
    write_atomic(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


@posix
@pytest.mark.parametrize("bits", [0o600, 0o640, 0o400])
def test_while_it_is_written_nobody_else_reads_a_file(tmp_path, monkeypatch, bits):
    """Its content is complete when it is flushed, and it has its last bits only when it is in place."""
    path, seen, flush = tmp_path / "private.bin", [], os.fsync

    def look(descriptor):
        seen.append(stat.S_IMODE(os.fstat(descriptor).st_mode))
        flush(descriptor)

    path.write_bytes(b"old")
    path.chmod(bits)
    monkeypatch.setattr(atomic.os, "fsync", look)
    monkeypatch.setattr(atomic.os, "access", lambda *_: True)  # also for those who are not root
    write_atomic(path, b"new")
    assert seen[0] == 0o600
    assert stat.S_IMODE(path.stat().st_mode) == bits


@posix
@pytest.mark.skipif(os.name != "posix" or os.geteuid() != 0, reason="only root can give files away")
def test_root_saves_a_file_and_it_stays_its_owner_s(tmp_path):
    path = tmp_path / "of somebody.bin"
    path.write_bytes(b"old")
    os.chown(path, 1234, 2345)
    path.chmod(0o640)
    write_atomic(path, b"new")
    status = path.stat()
    assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (1234, 2345, 0o640)


@posix
@pytest.mark.parametrize("target", ["loop.bin", "other.bin"])
def test_links_that_lead_to_themselves_are_refused_in_a_sentence(tmp_path, target):
    (tmp_path / "loop.bin").symlink_to(tmp_path / target)
    if target != "loop.bin":
        (tmp_path / target).symlink_to(tmp_path / "loop.bin")
    before = sorted(os.listdir(tmp_path))
    with pytest.raises(
        InputError, match=r"^Couldn't save “.*loop\.bin”\. Too many levels of symbolic links\.$"
    ):
        write_atomic(tmp_path / "loop.bin", b"new")
    with pytest.raises(
        InputError, match=r"^Couldn't open “.*loop\.bin”\. Too many levels of symbolic links\.$"
    ):
        read_file(tmp_path / "loop.bin", "a picture")
    assert sorted(os.listdir(tmp_path)) == before
    assert resolved(tmp_path / "loop.bin").parent == tmp_path


def test_protected_file_is_not_replaced(tmp_path, monkeypatch):
    path = tmp_path / "protected.bin"
    path.write_bytes(b"old")
    monkeypatch.setattr(atomic.os, "access", lambda *_: False)  # root may write whatever the bits say
    with pytest.raises(InputError, match=r"^Couldn't save “.*protected\.bin”\. Permission denied\.$"):
        write_atomic(path, b"new")
    assert path.read_bytes() == b"old"


@posix
def test_what_is_no_regular_file_is_refused(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (tmp_path, pipe):
        with pytest.raises(InputError, match=r"Couldn't save “.*”\. It is not a regular file\."):
            write_atomic(path, b"new")
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    with pytest.raises(InputError, match="Expected a picture, got something that is not a regular file"):
        read_file(pipe, "a picture")
    with pytest.raises(InputError, match="Expected a picture, got a folder"):
        read_file(tmp_path, "a picture")


def test_missing_names_are_said(tmp_path):
    with pytest.raises(InputError, match=r"^Couldn't open “[^“]*none\.png”\. There is no such file\.$"):
        read_file(tmp_path / "none.png", "a picture")
    with pytest.raises(InputError, match=r"^Couldn't save “.*”\. No such file or directory\.$"):
        write_atomic(tmp_path / "no folder" / "new.bin", b"")
    for path in (tmp_path / "nul\0", tmp_path / ("long" * 1000)):
        with pytest.raises(InputError, match=r"^Couldn't open “"):
            read_file(path, "a picture")
        with pytest.raises(InputError, match=r"^Couldn't save “"):
            write_atomic(path, b"")


def test_unreadable_and_oversized_files_are_refused(tmp_path, monkeypatch):
    path = tmp_path / "large.bin"
    path.write_bytes(bytes(11))
    with monkeypatch.context() as patch:
        patch.setattr(atomic, "MAX_FILE_BYTES", 10)
        with pytest.raises(InputError, match="Expected a picture, got a file of 11 bytes, more than 10"):
            read_file(path, "a picture")

    def deny(*_):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(Path, "open", deny)
    with pytest.raises(InputError, match=r"^Couldn't open “[^“]*large\.bin”\. Permission denied\.$"):
        read_file(path, "a picture")
