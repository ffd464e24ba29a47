"""The thread beside the window: one job after the other, and each wakes the window."""

from threading import Event

import pytest

from akap_editor.app.jobs.background_thread import BackgroundThread


def test_each_job_wakes_the_window_when_its_result_is_there():
    woken, results = [], []
    with BackgroundThread("test", lambda: woken.append(len(results))) as thread:
        for number in range(3):
            thread.submit(results.append, number)
    assert results == [0, 1, 2], "one after the other"
    assert woken == [1, 2, 3], "after each job"


def test_a_job_that_fails_wakes_the_window_too():
    woken = Event()
    with BackgroundThread("test", woken.set) as thread:
        future = thread.submit(int, "none")
        assert woken.wait(60)
        with pytest.raises(ValueError, match="none"):
            future.result()


def test_a_cancelled_job_wakes_the_window_too():
    goes_on, woken = Event(), Event()
    with BackgroundThread("test", woken.set) as thread:
        thread.submit(goes_on.wait)
        waiting = thread.submit(int)
        assert waiting.cancel()
        assert woken.is_set()
        goes_on.set()
