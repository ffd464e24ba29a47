"""Copies of unsaved work: when they are written, who may have them, and that they outlive the program."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from filelock import FileLock

import akap_editor
from akap_editor.errors import InputError
from akap_editor.io.akap import autosave as autosave_module
from akap_editor.io.akap.autosave import (
    COPY_GESTURES,
    COPY_SECONDS,
    FIRST_COPY_SECONDS,
    ORIGIN_ENTRY,
    STALE_SECONDS,
    Autosave,
)
from akap_editor.io.akap.project import encode_document, has_changed_on_disk, load, save
from tests.io.akap.test_project import assert_equal


class Watch:
    """An autosave whose clock and thread belong to the test."""

    def __init__(self, folder):
        self.now = 0.0
        self.worker = ThreadPoolExecutor(1)
        self.autosave = Autosave(folder, lambda: self.now, self.worker)

    def see(self, document, modified=True, gesture=None):
        """Watch a document, and wait until the thread is done."""
        self.autosave.watch(document, modified, gesture)
        self.worker.submit(int).result()


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "state"


@pytest.fixture
def watch(folder):
    watch = Watch(folder)
    yield watch
    watch.worker.shutdown()


def moved(document, way):
    return document.with_state(replace(document.state, positions=document.state.positions + way))


def hold_writes(monkeypatch):
    """Lets no file be written until the returned event is set."""
    go_on = threading.Event()

    def write(path, data):
        go_on.wait()
        path.write_bytes(data)

    monkeypatch.setattr(autosave_module, "write_atomic", write)
    return go_on


def copies(folder):
    return sorted(folder.glob("*.akap"))


def test_the_first_copy_comes_within_seconds_and_the_next_ones_every_minute(watch, folder, document):
    watch.see(document)
    watch.now = FIRST_COPY_SECONDS - 0.1
    watch.see(moved(document, 1))
    assert copies(folder) == []
    watch.now = FIRST_COPY_SECONDS
    last = moved(document, 2)
    watch.see(last)
    (path,) = copies(folder)
    assert_equal(load(path), last)
    watch.now += COPY_SECONDS
    watch.see(last)
    assert_equal(load(path), last)
    later = moved(document, 3)
    watch.see(later)
    watch.now += COPY_SECONDS - 0.1
    watch.see(later)
    assert_equal(load(path), last), "the next minute begins with the next change"
    watch.now += 0.1
    watch.see(later)
    assert_equal(load(path), later)
    assert copies(folder) == [path]


def test_every_tenth_gesture_is_copied(watch, folder, document):
    for count in range(1, 2 * COPY_GESTURES):
        document = moved(document, 1)
        watch.see(document, gesture=object())
        assert bool(copies(folder)) == (count >= COPY_GESTURES)
        if count == COPY_GESTURES:
            tenth = document
    (path,) = copies(folder)
    assert_equal(load(path), tenth)
    document = moved(document, 1)
    watch.see(document, gesture=object())
    assert_equal(load(path), document)


@pytest.mark.parametrize("end", ["saved", "closed", "nothing open"])
def test_no_copy_is_left_of_what_is_saved_or_not_wanted(watch, folder, document, end):
    watch.see(document)
    watch.now = COPY_SECONDS
    watch.see(document)
    assert len(copies(folder)) == 1
    if end == "closed":
        watch.autosave.close()
    else:
        watch.see(None if end == "nothing open" else document, modified=False)
    assert os.listdir(folder) == []


def test_what_is_saved_while_a_copy_is_being_written_leaves_none(watch, folder, document, monkeypatch):
    go_on = hold_writes(monkeypatch)
    watch.autosave.watch(document, True)
    watch.now = COPY_SECONDS
    watch.autosave.watch(document, True)
    watch.autosave.watch(document, False)
    go_on.set()
    watch.see(document, modified=False)
    assert os.listdir(folder) == []


def test_watching_never_waits_for_the_writer(watch, folder, document, monkeypatch):
    go_on = hold_writes(monkeypatch)
    for _ in range(50):  # a second copy is due, but the first one is not done
        document = moved(document, 1)
        watch.autosave.watch(document, True, object())
        watch.now += COPY_SECONDS
    assert copies(folder) == []
    go_on.set()
    watch.see(document)
    watch.see(document)
    assert_equal(load(copies(folder)[0]), document)


@pytest.mark.parametrize(
    "error",
    [
        InputError("Couldn't save: no space left on device"),
        OSError(28, "no space left on device"),
        ValueError("Out of range float values are not JSON compliant: no space"),
        TypeError("no space: a bug in what is written"),
        MemoryError("no space in memory"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_failure_is_told_once_and_tried_again_every_minute(watch, folder, document, monkeypatch, error):
    def fail(*_):
        raise error

    watch.see(document)
    watch.now = COPY_SECONDS
    with monkeypatch.context() as patch:
        patch.setattr(autosave_module, "write_atomic", fail)
        watch.see(document)
        message = r"^Unsaved work is not protected against a crash\. .*no space"
        with pytest.raises(InputError, match=message):
            watch.see(document)
        watch.see(document)
        watch.now += COPY_SECONDS
        watch.see(document)  # fails once more
        watch.see(document)  # and does not say so again
    watch.now += COPY_SECONDS - 1
    watch.see(document)
    assert copies(folder) == []
    watch.now += 1
    watch.see(document)
    assert_equal(load(copies(folder)[0]), document)


def test_a_file_in_place_of_the_folder_is_told(tmp_path, document):
    (tmp_path / "state").write_text("not a folder")
    watch = Watch(tmp_path / "state")
    watch.see(document)
    watch.now = COPY_SECONDS
    watch.see(document)
    with pytest.raises(InputError, match="Unsaved work is not protected"):
        watch.see(document)
    assert watch.autosave.claim_lost_copies() == []


# -- several programs, and those that died ------------------------------------------------------------------

EDIT = """
import sys, time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from akap_editor.editor import gestures
from akap_editor.editor.editor import Editor
from akap_editor.editor.events import PointerEvent
from akap_editor.io.akap.autosave import Autosave
from akap_editor.io.akap.project import load

editor, worker = Editor(), ThreadPoolExecutor(1)
autosave = Autosave(Path(sys.argv[2]), time.monotonic, worker)
editor.open(load(sys.argv[1]))

def frame():
    editor.advance()
    autosave.watch(editor.session.document, editor.is_modified, editor.session.history.last)

def act(kind, at):
    editor.handle_event(PointerEvent(kind, editor.camera.to_screen(at)))
    frame()

for index in range(10):
    gestures.add_pin(editor, (20.0 + 18 * index, 80.0))
    frame()
at = editor.session.state.pins[3].target
act("press", at)
x = 0
while True:  # and never let go
    x += 1
    act("move", (at[0], at[1] + 20 + x % 20))
    if x == 30:
        worker.submit(int).result()
        print("dragging", flush=True)
"""


@pytest.fixture
def figure(tmp_path):
    """A saved drawing, 240 x 160, that can be dragged."""
    y, x = np.mgrid[0:160, 0:240]
    image = np.full((160, 240, 4), 200, np.uint8)
    image[..., 3] = 255 * (np.hypot((x - 120) / 112, (y - 80) / 60) < 1)
    drawing = akap_editor.make_drawing(image, vertices=150, name="figure")
    path = tmp_path / "figure.akap"
    akap_editor.save(akap_editor.new_document(drawing), path)
    return path


def start(figure, folder):
    command = [sys.executable, "-c", EDIT, str(figure), str(folder)]
    environment = {**os.environ, "PYTHONPATH": str(Path(akap_editor.__file__).parents[1])}
    return subprocess.Popen(command, env=environment, stdout=subprocess.PIPE)


def test_what_a_killed_program_had_is_found_and_what_a_running_one_has_is_not(figure, folder):
    killed, running = start(figure, folder), start(figure, folder)
    try:
        for program in (killed, running):
            assert program.stdout.readline() == b"dragging\n"
        autosave = Autosave(folder)
        assert len(copies(folder)) == 2
        assert autosave.claim_lost_copies() == [], "both are at work"
        killed.kill()
        killed.wait()
        (copy,) = autosave.claim_lost_copies()
        assert Autosave(folder).claim_lost_copies() == [], "it is offered to one program only"
        document = copy.read()
        assert document.path == figure
        assert len(document.state.pins) == 10
        assert abs(time.time() - copy.time) < 600
        original = load(figure)
        assert document.drawing.mesh.vertices.tobytes() == original.drawing.mesh.vertices.tobytes()
        assert (document.drawing.image == original.drawing.image).all()
        copy.release()
        (copy,) = Autosave(folder).claim_lost_copies()
        copy.discard()
        assert autosave.claim_lost_copies() == []
        assert len(copies(folder)) == 1, "the running program's"
    finally:
        for program in (killed, running):
            program.send_signal(signal.SIGKILL)
            program.communicate()


def test_an_adopted_copy_lives_until_the_drawing_is_saved(folder, document):
    dead = Watch(folder)
    dead.see(document)
    dead.autosave.rescue(document)
    watch = Watch(folder)
    (copy,) = watch.autosave.claim_lost_copies()
    recovered = copy.read()
    assert recovered.path is None
    watch.autosave.adopt(copy, recovered)
    watch.see(recovered)
    assert copies(folder) == [copy.path]
    assert Autosave(folder).claim_lost_copies() == []
    watch.now = COPY_SECONDS
    changed = moved(recovered, 1)
    watch.see(changed)
    watch.now += COPY_SECONDS
    watch.see(changed)
    assert copies(folder) == [copy.path]
    assert_equal(load(copy.path), changed)
    watch.see(changed, modified=False)
    assert os.listdir(folder) == []


def test_a_recovered_drawing_knows_whether_its_file_was_changed_meanwhile(folder, document, tmp_path):
    own = save(document, tmp_path / "own.akap")
    dead = Watch(folder)
    dead.autosave.rescue(moved(own, 1))
    (copy,) = Watch(folder).autosave.claim_lost_copies()
    assert copy.read().path == own.path
    assert not has_changed_on_disk(copy.read())
    save(moved(own, 2), own.path)
    assert has_changed_on_disk(copy.read())


def test_rescue_writes_at_once(folder, document):
    watch = Watch(folder)
    watch.see(document)
    watch.autosave.rescue(document)
    assert_equal(load(copies(folder)[0]), document)


ORIGINS = {
    "missing": None,
    "no JSON": b"?",
    "another kind": json.dumps({"path": 3}).encode(),
    "too long": json.dumps({"path": "x" * 100_000}).encode(),
}


@pytest.mark.parametrize("origin", ORIGINS)
def test_a_copy_that_is_no_good_is_an_input_error(folder, document, origin):
    folder.mkdir()
    more = [] if ORIGINS[origin] is None else [(ORIGIN_ENTRY, ORIGINS[origin], True)]
    (folder / "bad.akap").write_bytes(encode_document(document, more))
    (copy,) = Autosave(folder).claim_lost_copies()
    with pytest.raises(InputError, match=r"Couldn't recover “.*bad\.akap”\. "):
        copy.read()
    assert (folder / "bad.akap").exists()


def test_one_lock_that_cannot_be_opened_hides_no_other_copy(folder, document, monkeypatch):
    for _ in range(2):
        dead = Watch(folder)
        dead.see(document)
        dead.autosave.rescue(document)
    unreadable, readable = copies(folder)
    acquire = FileLock.acquire

    def fail(lock, *arguments, **options):
        if Path(lock.lock_file).stem == unreadable.stem:
            raise PermissionError(13, "Permission denied")
        return acquire(lock, *arguments, **options)

    monkeypatch.setattr(FileLock, "acquire", fail)
    (copy,) = Autosave(folder).claim_lost_copies()
    assert copy.path == readable


def test_what_killed_programs_left_beside_their_copies_is_removed(folder, document):
    dead = Watch(folder)
    dead.see(document)
    dead.autosave.rescue(document)
    (copy,) = copies(folder)
    (folder / "0123456789abcdef.lock").touch()
    old, new = folder / ".akap-0123456789abcdef.tmp", folder / ".akap-fedcba9876543210.tmp"
    old.touch()
    new.touch()
    long_ago = time.time() - STALE_SECONDS - 60
    os.utime(old, (long_ago, long_ago))
    running = Watch(folder)
    running.see(document)
    running.now = FIRST_COPY_SECONDS
    running.see(document)
    Autosave(folder).remove_leftovers()
    locks = {path.stem for path in folder.glob("*.lock")}
    assert locks <= {path.stem for path in copies(folder)}
    assert len(copies(folder)) == 2, "no copy is removed"
    assert not old.exists()
    assert new.exists(), "another program may be writing it"
    assert copy.exists()
    running.worker.shutdown()
