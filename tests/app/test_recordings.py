"""Recordings saved from the window."""

import numpy as np

from akap_editor.editor.replay import replay
from akap_editor.io.recordings import read_recording, recorded_drawing


def test_what_was_done_by_hand_is_saved_and_done_again_to_the_last_bit(ui, tmp_path):
    ui.space.folder = tmp_path
    for place in ((50.0, 80.0), (130.0, 80.0), (210.0, 80.0)):
        ui.click(ui.screen(place))
    start = ui.screen((210.0, 80.0))
    ui.drag(start, (start[0] - 30, start[1] - 90))
    ui.menu("Edit", "Undo")
    ui.menu("Edit", "Redo")
    ui.menu("File", "Save Recording...")
    ui.type_name("Save recording", "wave")
    ui.settle()
    assert ui.space.notice.startswith("Saved wave.akaprec")
    recording = read_recording(tmp_path / "wave.akaprec")
    *_, last = replay(recording, recorded_drawing(recording))
    np.testing.assert_array_equal(last.state.positions, ui.session.state.positions)
    assert ui.session.posed
