"""After a crash: what was lost is offered with a picture, and taken, thrown away or left for later."""

import os

import numpy as np
import pytest

from akap_editor.app import files
from akap_editor.app.dialogs.recovery import RecoveryDialog
from akap_editor.editor.session.stepper import INLINE
from akap_editor.io.akap.autosave import Autosave
from akap_editor.io.akap.project import load, save

TITLE = "Recover unsaved work"


@pytest.fixture
def crash(tmp_path):
    """Leaves a copy like a program that crashes."""
    return lambda document: Autosave(tmp_path, worker=INLINE).rescue(document)


@pytest.fixture
def restart(ui, tmp_path):
    """The window as it starts with this folder of copies; earlier starts keep the locks of their copies."""
    earlier = []

    def start():
        earlier.append(ui.state.autosave)
        ui.state.autosave = Autosave(tmp_path, worker=INLINE)
        ui.state.part(RecoveryDialog).copies = ui.state.autosave.claim_lost_copies()
        ui.settle()
        return ui

    yield start
    for copy in ui.state.part(RecoveryDialog).copies:
        copy.release()


@pytest.fixture
def bent(pinned):
    """The state of a drawing with three pins, one of them dragged."""
    start = pinned.to_screen(pinned.pin_position(3))
    pinned.drag(start, (start[0], start[1] - 90))
    return pinned.document


def test_nothing_is_offered_where_nothing_was_lost(restart):
    restart()
    assert not restart().state.part(RecoveryDialog).copies


def test_recovering_brings_the_drawing_back_unsaved(bent, crash, restart, tmp_path):
    crash(bent)
    ui = restart()
    shot = ui.screenshot()
    middle = shot[200:600, 250:800]
    assert (abs(middle.astype(int) - (90, 140, 200)).sum(axis=2) < 12).mean() > 0.01, "the thumbnail shows it"
    ui.dialog(TITLE, "Recover")
    assert ui.document.state.positions.tobytes() == bent.state.positions.tobytes()
    assert [pin.id for pin in ui.pins] == [1, 2, 3]
    assert ui.editor.is_modified
    assert ui.state.title == "figure * - akap-editor"
    assert ui.state.notice == "Recovered figure, which is not saved yet"
    files.autosave(ui.state)
    assert list(tmp_path.glob("*.akap")), "a second crash would lose it otherwise"
    files.write_document(ui.state, tmp_path / "saved.pose")
    files.autosave(ui.state)
    assert os.listdir(tmp_path) == ["saved.pose"]


def test_a_recovered_drawing_belongs_to_its_file(bent, crash, restart, tmp_path):
    folder = tmp_path / "drawings"
    folder.mkdir()
    saved = save(bent, folder / "figure.akap")
    crash(saved.with_state(bent.state))
    ui = restart()
    ui.dialog(TITLE, "Recover")
    assert ui.state.title == "figure.akap * - akap-editor"
    ui.menu("File", "Save")
    assert not ui.editor.is_modified
    assert (load(folder / "figure.akap").state.positions == bent.state.positions).all()


def test_discarding_removes_the_copy_and_goes_to_the_next(bent, document, crash, restart, tmp_path):
    crash(bent)
    crash(document)
    ui = restart()
    assert len(ui.state.part(RecoveryDialog).copies) == 2
    ui.dialog(TITLE, "Discard")
    assert len(ui.state.part(RecoveryDialog).copies) == 1
    assert len(list(tmp_path.glob("*.akap"))) == 1
    ui.dialog(TITLE, "Discard")
    assert not ui.state.part(RecoveryDialog).copies
    assert os.listdir(tmp_path) == []


def test_later_means_the_next_start(bent, crash, restart, tmp_path):
    crash(bent)
    ui = restart()
    before = ui.document
    ui.dialog(TITLE, "Later")
    assert not ui.state.part(RecoveryDialog).copies
    assert ui.document is before
    assert len(restart().state.part(RecoveryDialog).copies) == 1


def test_recovering_one_leaves_the_others_for_the_next_start(bent, document, crash, restart):
    crash(bent)
    crash(document)
    restart().dialog(TITLE, "Recover")
    ui = restart()
    assert len(ui.state.part(RecoveryDialog).copies) == 1


def test_a_damaged_copy_is_told_and_kept(bent, crash, restart, tmp_path):
    crash(bent)
    (path,) = tmp_path.glob("*.akap")
    path.write_bytes(path.read_bytes()[:-100])
    ui = restart()
    assert ui.state.error.startswith("Couldn't recover an unsaved drawing. ")
    assert not ui.state.part(RecoveryDialog).copies
    assert path.exists()
    ui.dialog("Error", "OK")


def test_a_crash_of_the_program_itself_keeps_the_work(bent, ui, tmp_path):
    files.show_document(ui.state, bent)
    ui.session.mark_unsaved()
    ui.state.autosave = Autosave(tmp_path)
    files.rescue(ui.state)
    (copy,) = Autosave(tmp_path).claim_lost_copies()
    assert np.array_equal(copy.read().state.positions, bent.state.positions)
    copy.release()
