"""The event log reads like a list and takes little memory."""

import tracemalloc

import pytest

from akap_editor.editor.session.event_log import PACK_SIZE, EventLog


def events(count):
    return [{"t": n / 60, "do": "targets", "targets": {"3": [0.1 * n, 1e-300 + n]}} for n in range(count)]


@pytest.mark.parametrize("count", [0, 1, PACK_SIZE - 1, PACK_SIZE, PACK_SIZE + 1, 2 * PACK_SIZE + 7])
def test_it_reads_like_the_list(count):
    expected, log = events(count), EventLog()
    for event in expected:
        log.append(event)
    assert len(log) == count
    assert bool(log) == bool(expected)
    assert list(log) == expected
    assert log == expected
    assert expected == log
    assert log != [*expected, {}]
    assert log[count // 3 : count : 401] == expected[count // 3 : count : 401]
    for index in {0, count // 2, count - 1, -1, -count} if count else ():
        assert log[index] == expected[index]
    with pytest.raises(IndexError):
        log[count]


def test_changing_an_event_does_not_change_the_log():
    log, event = EventLog(), {"t": 0.0, "do": "pins", "pins": [1]}
    log.append(event)
    event["pins"].append(2)
    log[0]["pins"].append(3)
    assert log[0]["pins"] == [1]


@pytest.mark.parametrize("index", [0, PACK_SIZE - 1, PACK_SIZE, -1])
def test_an_event_is_replaced(index):
    expected, log = events(PACK_SIZE + 7), EventLog()
    for event in expected:
        log.append(event)
    expected[index] = {"t": 1.0, "do": "step"}
    log.replace(index, expected[index])
    assert log == expected
    with pytest.raises(IndexError):
        log.replace(len(log), expected[index])


def test_a_hundred_thousand_events_take_little_memory():
    tracemalloc.start()
    log = EventLog()
    for number in range(100_000):
        log.append({"t": round(number / 60, 4), "do": "step"})
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert size < 3e6
