"""Long work in slices: progress, the end, cancelling."""

import pytest

from akap_editor.app.jobs.task import START, Progress, Task


def work(log, *, blocked_at=None):
    try:
        for step in range(1, 5):
            log.append(step)
            yield Progress(step / 4, f"Step {step}", is_blocked=step == blocked_at)
    finally:
        log.append("closed")


def test_without_time_each_frame_does_one_step_and_shows_its_progress():
    log = []
    task = Task("Working", work(log))
    assert task.progress is START
    for step in range(1, 5):
        assert not task.advance(0.0)
        assert task.progress == Progress(step / 4, f"Step {step}")
    assert task.advance(0.0), "done"
    assert log == [1, 2, 3, 4, "closed"]


def test_with_time_it_works_on_until_it_is_done():
    log = []
    assert Task("Working", work(log)).advance(60.0)
    assert log == [1, 2, 3, 4, "closed"]


def test_it_returns_to_the_loop_where_it_waits_for_a_thread():
    log = []
    task = Task("Working", work(log, blocked_at=2))
    assert not task.advance(60.0)
    assert task.progress.is_blocked
    assert log == [1, 2]
    assert task.advance(60.0)


def test_cancelling_closes_the_work():
    log = []
    task = Task("Working", work(log))
    task.advance(0.0)
    task.cancel()
    assert log == [1, "closed"]
    assert task.advance(60.0), "nothing is left to do"


def test_what_the_work_raises_is_raised():
    def failing():
        yield Progress(0.5)
        raise ValueError("no more")

    task = Task("Working", failing())
    with pytest.raises(ValueError, match="no more"):
        task.advance(60.0)
