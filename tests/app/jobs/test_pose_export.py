"""Files that are written in a thread, with pictures that the window draws for them."""

import threading
from threading import Event

import numpy as np
import pytest

from akap_editor.app.dialogs.export.pose import PoseExportOptions, export_pose
from akap_editor.app.jobs.pose_export import PoseExportQueue
from akap_editor.editor import gestures
from akap_editor.editor.framing import crop_box
from akap_editor.errors import InputError
from akap_editor.io.export import formats
from akap_editor.io.images import read_image


class Painter:
    """Says in which thread it drew."""

    def __init__(self):
        self.threads = []

    def render(self, number):
        self.threads.append(threading.current_thread())
        if number < 0:
            raise ValueError("no such picture")
        return np.full((1, 1, 4), number, dtype=np.uint8)


@pytest.fixture
def writer():
    made = PoseExportQueue()
    yield made
    made.close()


def job(*numbers):
    return lambda painter: " ".join(str(painter.render(number)[0, 0, 0]) for number in numbers)


def test_pictures_are_drawn_by_the_window_and_files_written_in_order(writer):
    painter, said = Painter(), []
    writer.begin(job(1, 2))
    writer.begin(job(3))
    while writer.is_busy:
        said += filter(None, [writer.advance(painter)])
    assert said == ["1 2", "3"]
    assert set(painter.threads) == {threading.current_thread()}


def test_what_fails_is_told_where_it_was_begun_and_the_next_is_written(writer):
    writer.begin(job(-1))
    writer.begin(job(5))
    painter = Painter()
    with pytest.raises(ValueError, match="no such picture"):
        writer.finish(painter)
    writer.finish(painter)
    assert len(painter.threads) == 2
    assert not writer.is_busy


def test_a_closed_window_keeps_no_thread_waiting():
    writer, ended, errors = PoseExportQueue(), Event(), []

    def work(painter):
        try:
            return str(painter.render(1))
        except InputError as error:
            errors.append(str(error))
            raise
        finally:
            ended.set()

    writer.begin(work)
    writer.close()
    assert ended.wait(20)
    assert errors == ["the window was closed before the picture was drawn"]


def test_the_drawing_is_bent_on_while_its_picture_is_written(pinned, tmp_path, monkeypatch):
    """The file shows the pose that was exported."""
    gate, encode = Event(), formats.encode_png
    monkeypatch.setattr(formats, "encode_png", lambda picture: gate.wait(60) and encode(picture))
    path = tmp_path / "pose.png"
    export_pose(pinned.state, PoseExportOptions(), path)
    x, y = pinned.pin_position(3)
    drawing, pose = pinned.session.drawing, pinned.session.state.positions
    pinned.do(lambda hand: hand.yield_(3), settle=False)
    assert pinned.state.notice == "Exporting pose.png ..."
    gestures.move_pin(pinned.editor, 3, (x, y - 40))
    while pinned.editor.is_moving:
        pinned.frame()
    np.testing.assert_allclose(pinned.pin_position(3), (x, y - 40), atol=0.25)
    assert pinned.state.is_busy
    assert not path.exists()
    gate.set()
    pinned.settle()
    assert pinned.state.notice.startswith("Exported pose.png, ")
    box = crop_box(drawing, pose, "none")
    expected = pinned.state.offscreen_renderer.render(drawing, pose, box)
    np.testing.assert_array_equal(read_image(path), expected)


def test_a_window_that_closes_writes_the_file_first(pinned, tmp_path):
    path = tmp_path / "pose.png"
    export_pose(pinned.state, PoseExportOptions(), path)
    pinned.state.is_closing = True
    pinned.window.run()
    assert path.exists()
    pinned.state.is_closing = False
