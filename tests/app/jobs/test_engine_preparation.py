"""The engine is loaded by stages; child processes compile what is not compiled yet."""

import gc
import os
from queue import Queue
from types import SimpleNamespace

import pytest

from akap_editor.app.jobs.engine_preparation import PARTS, EnginePreparation, compile_part
from akap_editor.geometry import jit
from akap_editor.progress import Cancelled, listening

DEADLINE = 60.0  # seconds


class FakeChild:
    """A child process that has compiled a stage when the test says so; True for one that died."""

    def __init__(self, name):
        self.name, self.is_terminated = name, False
        self.stages = Queue()
        self.stdout = SimpleNamespace(readline=lambda: self.stages.get(timeout=DEADLINE))

    def terminate(self):
        self.is_terminated = True
        for _ in range(3):
            self.stages.put(b"")

    def communicate(self):
        return b"", None


class Bench:
    """A preparation of one part whose stages count their calls, and its child process."""

    def __init__(self, is_compiled):
        self.calls, self.done, self.wakes, self.children = [], Queue(), Queue(), []
        self.is_compiled = is_compiled
        stages = tuple(lambda number=number: self._call(number) for number in range(3))
        self.engine = EnginePreparation({"part": stages}, self._start_child)

    def _call(self, number):
        if not self.is_compiled and not self.children:
            raise jit.NotCompiledError
        self.calls.append(number)
        self.done.put(number)

    def _start_child(self, name):
        self.children.append(FakeChild(name))
        return self.children[-1]

    def start(self):
        self.engine.wake = lambda: self.wakes.put(None)
        self.engine.start()

    def wait_for_calls(self, count):
        for _ in range(count):
            self.done.get(timeout=DEADLINE)

    def wait_for_wake(self):
        self.wakes.get(timeout=DEADLINE)


def test_without_a_start_nothing_has_to_be_prepared():
    engine = Bench(True).engine
    assert engine.can_open
    assert engine.can_step
    engine.wait_to_open()


def test_what_is_compiled_is_loaded_without_a_child_process():
    bench = Bench(True)
    bench.start()
    assert bench.engine.can_open
    bench.wait_for_calls(3)
    assert bench.calls == [0, 1, 2]
    assert bench.wakes.empty(), "nothing has waited"
    assert not bench.children


def test_at_the_first_start_opening_waits_for_one_stage_and_steps_for_two():
    bench = Bench(False)
    bench.start()
    assert not bench.engine.can_open
    (child,) = bench.children
    assert child.name == "part"
    child.stages.put(b"\n")
    bench.engine.wait_to_open()
    assert bench.engine.can_open
    assert not bench.engine.can_step
    child.stages.put(b"\n")
    bench.wait_for_wake()
    assert bench.engine.can_step
    assert bench.calls == [0, 1], "the rest is loaded when it is compiled"
    bench.wait_for_calls(2)
    child.stages.put(b"\n")
    bench.wait_for_calls(1)
    assert bench.calls == [0, 1, 2]


def test_a_child_process_that_dies_leaves_the_work_to_the_thread():
    bench = Bench(False)
    bench.start()
    assert not bench.engine.can_open
    for _ in range(3):
        bench.children[0].stages.put(b"")
    bench.wait_for_calls(3)
    assert bench.calls == [0, 1, 2]
    assert bench.engine.can_step


def test_without_a_folder_for_machine_code_the_thread_compiles(monkeypatch):
    bench = Bench(False)
    monkeypatch.setattr(
        "akap_editor.app.jobs.engine_preparation.keeps_machine_code", lambda: bench.calls.append("asked")
    )
    monkeypatch.setattr(bench, "_call", lambda number: bench.calls.append(number) if bench.calls else fail())

    def fail():
        raise jit.NotCompiledError

    bench.start()
    bench.engine.wait_to_open(and_to_step=True)
    assert bench.calls[:3] == ["asked", 0, 1]
    assert not bench.children


def test_opening_can_be_cancelled_while_it_waits():
    bench = Bench(False)
    bench.start()
    assert not bench.engine.can_open

    def cancel(share, text):
        assert 0 <= share <= 1
        assert text.startswith("Preparing")
        raise Cancelled("cancelled")

    with listening(cancel), pytest.raises(Cancelled):
        bench.engine.wait_to_open()
    bench.engine.close()


def test_the_child_processes_end_with_the_window():
    bench = Bench(False)
    bench.start()
    assert not bench.engine.can_open
    bench.engine.close()
    bench.engine.wait_to_open(and_to_step=True)
    assert bench.children[0].is_terminated
    assert not bench.calls


def test_a_child_process_tells_of_each_stage_and_yields_to_those_before_it(monkeypatch, capsys):
    calls = []
    monkeypatch.setattr(gc, "disable", lambda: None)
    monkeypatch.setattr(os, "nice", lambda increment: calls.append(increment > 0), raising=False)
    monkeypatch.setitem(PARTS, "part", tuple([lambda: calls.append("stage")] * 3))
    compile_part("part")
    assert calls == [True, "stage"] * 3
    assert capsys.readouterr().out == "\n" * 3
