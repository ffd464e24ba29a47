"""The previous version survives whatever stops a save: a killed process, a full disk, lost permissions."""

import errno
import json
import os
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import akap_editor
from akap_editor.errors import InputError
from akap_editor.io import atomic
from akap_editor.io.akap.project import load, save
from akap_editor.io.atomic import write_atomic

ROOT = Path(__file__).resolve().parents[2]

posix = pytest.mark.skipif(os.name != "posix", reason="forks, signals and limits of file sizes are POSIX")
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(Path(akap_editor.__file__).parents[1])}


@posix
def test_old_or_new_version_is_there_wherever_a_save_is_stopped(document, tmp_path):
    path = tmp_path / "folder" / "cat.akap"
    path.parent.mkdir()
    tmp_path.chmod(0o755)
    save(document, path)
    script = ROOT / "tests" / "support" / "crashes.py"
    command = [sys.executable, str(script), str(path)]
    run = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert run.returncode == 0, run.stderr
    counts = json.loads(run.stdout)
    killed, full = counts["kill_at"], counts["limit_size"]
    assert killed["done"] == full["done"] == 1
    assert killed["before"] > 20, "there is more than one moment between opening and moving"
    assert killed["after"] > 1, "a kill may come after the move"
    assert killed["left"] > 5, "a killed process cannot tidy up"
    assert full == {"before": full["before"], "after": 0, "done": 1, "left": 0}
    assert full["before"] >= 7
    refused = {"before": 1, "after": 0, "done": 0, "left": 0}
    assert counts["left"] > 3, "a signal from outside may come in the middle of a save"
    assert counts["no_folder"] == counts["no_file"] == refused


@pytest.mark.skipif(not os.path.exists("/proc/mounts"), reason="a small disk is made with Linux's tmpfs")
def test_a_full_disk_keeps_the_old_version(document, tmp_path):
    path = tmp_path / "cat.akap"
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(tmp_path)], capture_output=True
    )
    if mounted.returncode:
        pytest.skip("only root may mount a small disk")
    try:
        save(document, path)
        before = path.read_bytes()
        moved = replace(document.state, positions=document.state.positions + 1)
        for filled in (40_000, 56_000, 60_000):
            (tmp_path / "filler").write_bytes(bytes(filled))
            with pytest.raises(InputError, match=r"Couldn't save “.*cat\.akap”\. No space left on device\.$"):
                write_atomic(path, bytes(70_000 - filled))
            assert path.read_bytes() == before
            assert sorted(os.listdir(tmp_path)) == ["cat.akap", "filler"]
        (tmp_path / "filler").unlink()
        save(document.with_state(moved), path)
        assert (load(path).state.positions == moved.positions).all()
    finally:
        subprocess.run(["umount", str(tmp_path)], check=True)


@posix
def test_content_reaches_the_disk_before_the_name_and_the_folder_after_it(tmp_path, monkeypatch):
    steps = []
    fsync, move = os.fsync, os.replace

    def flush(descriptor):
        is_folder = stat.S_ISDIR(os.fstat(descriptor).st_mode)
        steps.append("flush folder" if is_folder else "flush file")
        fsync(descriptor)

    monkeypatch.setattr(atomic.os, "fsync", flush)
    monkeypatch.setattr(atomic.os, "replace", lambda *names: (steps.append("move"), move(*names)))
    write_atomic(tmp_path / "a.bin", b"new")
    assert steps == ["flush file", "move", "flush folder"]


@posix
def test_a_folder_that_cannot_be_flushed_is_no_failure(tmp_path, monkeypatch):
    fsync = os.fsync

    def flush(descriptor):
        if stat.S_ISDIR(os.fstat(descriptor).st_mode):
            raise OSError(errno.EINVAL, "Invalid argument")
        fsync(descriptor)

    monkeypatch.setattr(atomic.os, "fsync", flush)
    write_atomic(tmp_path / "a.bin", b"new")
    assert (tmp_path / "a.bin").read_bytes() == b"new"
