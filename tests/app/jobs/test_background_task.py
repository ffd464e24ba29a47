"""Tasks that compute in a thread of their own."""

from threading import Event, get_ident

import pytest

from akap_editor.app.jobs.background_task import background_task
from akap_editor.errors import InputError
from akap_editor.progress import Cancelled, announce

DEADLINE = 60.0  # seconds


class Woken(Event):
    """Counts the wakes of a window."""

    def wait_for_next(self):
        assert self.wait(DEADLINE)
        self.clear()


def finish(task, woken):
    while not task.advance():
        woken.wait_for_next()


def test_the_result_is_used_in_the_thread_of_the_window():
    woken, used = Woken(), []
    task = background_task("Work", get_ident, lambda thread: used.append((thread, get_ident())), woken.set)
    finish(task, woken)
    ((worked_in, used_in),) = used
    assert used_in == get_ident()
    assert worked_in != used_in


def test_progress_is_what_the_work_announces():
    woken, may_end = Woken(), Event()

    def work():
        announce(0.25, "Reading")
        may_end.wait(DEADLINE)

    task = background_task("Work", work, lambda _: None, woken.set)
    while task.progress.text != "Reading":
        assert not task.advance()
        woken.wait_for_next()
    assert task.progress.share == 0.25
    assert task.progress.is_blocked, "the window sleeps meanwhile"
    may_end.set()
    finish(task, woken)


@pytest.mark.parametrize("error", [InputError("no picture"), ValueError("a bug"), SystemExit(3)])
def test_an_exception_is_raised_by_the_task(error):
    woken, failures = Woken(), []

    def work():
        raise error

    task = background_task("Work", work, pytest.fail, woken.set, lambda: failures.append(get_ident()))
    with pytest.raises(type(error), match=str(error)):
        finish(task, woken)
    assert failures == ([get_ident()] if isinstance(error, InputError) else [])


def test_cancelled_work_ends_at_its_next_stage_and_is_not_used():
    woken, has_begun, may_go_on, ended = Woken(), Event(), Event(), []

    def work():
        has_begun.set()
        may_go_on.wait(DEADLINE)
        try:
            announce(0.5, "Next stage")
        except Cancelled:
            ended.append("at the stage")
            raise
        ended.append("at the end")

    task = background_task("Work", work, pytest.fail, woken.set)
    task.advance()
    assert has_begun.wait(DEADLINE)
    task.cancel()
    may_go_on.set()
    woken.wait_for_next()
    assert ended == ["at the stage"]
