"""The thread that encodes pictures: order, end, errors, and cancelling without a file."""

from threading import Event

import numpy as np
import pytest

from akap_editor.app.jobs.frame_encoder import FrameEncoder
from akap_editor.errors import InputError


def picture(value):
    return np.full((2, 3, 4), value, dtype=np.uint8)


def exhaust(steps):
    for _ in steps:
        pass


def test_all_pictures_arrive_in_order_and_the_file_is_written(tmp_path):
    target = tmp_path / "values.bin"

    def export(*, shots, write):
        values = bytes(frame[0, 0, 0] for frame in shots)
        write(target, values)
        return f"{len(values)} pictures"

    encoder = FrameEncoder(export)
    for value in range(30):
        exhaust(encoder.take(picture(value)))
    exhaust(encoder.finish())
    assert encoder.said == "30 pictures"
    assert target.read_bytes() == bytes(range(30))
    encoder.close()


def test_what_waits_is_bounded_until_the_thread_reads(tmp_path):
    reads = Event()

    def export(*, shots, write):
        reads.wait()
        return str(sum(1 for _ in shots))

    encoder = FrameEncoder(export)
    taken = 0
    while next(encoder.take(picture(0)), "taken") == "taken":
        taken += 1
        assert taken < 100, "pictures pile up"
    reads.set()
    exhaust(encoder.finish())
    assert encoder.said == str(taken)
    encoder.close()


def test_an_error_of_the_export_is_told_and_later_pictures_are_dropped():
    def export(*, shots, write):
        raise OSError("the disk is full")

    encoder = FrameEncoder(export)
    for value in range(30):
        exhaust(encoder.take(picture(value)))
    exhaust(encoder.finish())
    with pytest.raises(OSError, match="the disk is full"):
        _ = encoder.said
    encoder.close()


def test_closing_before_the_end_writes_nothing(tmp_path):
    target, ended = tmp_path / "values.bin", Event()

    def export(*, shots, write):
        try:
            write(target, bytes(frame[0, 0, 0] for frame in shots))
        finally:
            ended.set()
        return ""

    encoder = FrameEncoder(export)
    exhaust(encoder.take(picture(1)))
    encoder.close()
    assert ended.wait(60)
    with pytest.raises(InputError, match="the export was cancelled"):
        _ = encoder.said
    assert not target.exists()
