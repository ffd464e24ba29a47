"""Replays: bit for bit on the same mesh, alike on others, and errors that name the line."""

import os
import random
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import SetPose
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import Recording, drawing_header, parse_recording
from akap_editor.editor.session.replay import Replay, replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError, SolverError
from akap_editor.io.akap.recording import write_recording
from tests.support.editor_driver import Driver, bits, replayed_state

ROOT = Path(__file__).parents[3]
HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def edit_at_random(driver, seed, count=25):
    """Do ``count`` random things with the pointer, the history, pins, settings and the pose."""
    rng = random.Random(seed)
    editor = driver.editor

    def random_place():
        return rng.uniform(10, 110), rng.uniform(15, 65)

    def drag(end):
        if driver.ids:
            driver.press(driver.where(rng.choice(driver.ids)), shift=rng.random() < 0.3)
            for _ in range(3):
                driver.move(random_place())
                driver.advance()
            end()

    def change_memory():
        settings = driver.state.settings.with_parameter("memory", rng.choice([0.0, 0.5, 1.0]))
        gestures.set_settings(editor, settings)

    def undo_and_redo():
        driver.undo()
        driver.redo()

    actions = [
        lambda: driver.click(random_place(), shift=rng.random() < 0.5),
        lambda: drag(lambda: driver.release(NECK)),
        lambda: drag(lambda: driver.release(NECK)),
        lambda: drag(lambda: driver.key("escape")),
        driver.settle,
        driver.undo,
        undo_and_redo,
        lambda: gestures.remove_selected_pins(editor),
        editor.select_all,
        change_memory,
        lambda: gestures.reset_pose(editor),
    ]
    for place in (HEAD, NECK, END):
        driver.click(place)
    for _ in range(count):
        rng.choice(actions)()


def event_names(recording):
    return {event["do"] for event in recording.events}


@pytest.mark.parametrize("seed", range(4))
def test_on_its_own_mesh_a_replay_is_equal_to_the_last_bit(new_driver, drawing, seed):
    driver = new_driver()
    edit_at_random(driver, seed)
    recording = driver.session.recording
    assert {"settings", "begin", "pins", "targets", "step", "commit"} <= event_names(recording)
    assert bits(replayed_state(recording, drawing)) == bits(driver.state)


def test_the_random_sessions_hold_all_events_of_gestures_steps_and_pins(new_driver):
    names = set()
    for seed in range(4):
        driver = new_driver()
        edit_at_random(driver, seed)
        names |= event_names(driver.session.recording)
    assert names == {
        "settings", "begin", "pins", "targets", "step", "commit", "abort", "undo", "redo", "reset",
    }  # fmt: skip


def test_a_replay_yields_the_state_after_each_event_with_its_time(pinned, drawing):
    session = pinned.session
    pinned.press(END)
    pinned.move((90.0, 60.0))
    poses = [session.state.positions.tobytes()]
    first = len(session.recording.events)
    while pinned.editor.is_moving:
        pinned.advance()
        poses.append(session.state.positions.tobytes())
    replayed = list(replay(parse_recording(session.recording.to_text()), drawing))
    assert [event.time for event in replayed] == [event["t"] for event in session.recording.events]
    assert [event.state.positions.tobytes() for event in replayed[first - 1 :]] == poses


def test_a_session_that_began_in_the_middle_replays_too(pinned, drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    resumed = Driver(pinned.session.document)
    resumed.drag((90.0, 60.0), (95.0, 50.0))
    resumed.settle()
    assert bits(replayed_state(resumed.session.recording, drawing)) == bits(resumed.state)


def test_a_session_with_other_settings_replays_with_them(drawing):
    settings = Settings("akap", (("memory", 0.0), ("trajectory", "linear")))
    driver = Driver(new_document(drawing, settings))
    driver.click(HEAD)
    driver.drag(END, (90.0, 60.0))
    state = replayed_state(driver.session.recording, drawing)
    assert state.settings == settings
    assert bits(state) == bits(driver.state)


def test_on_another_mesh_of_the_picture_pins_end_near_their_targets(pinned, finer_drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    state = replayed_state(pinned.session.recording, finer_drawing)
    assert len(state.positions) == len(finer_drawing.mesh.vertices)
    np.testing.assert_allclose(state.targets, pinned.state.targets, atol=1e-9)
    pin_positions = finer_drawing.mesh.evaluate(state.points, state.positions)
    assert np.hypot(*(pin_positions - pinned.session.pin_positions()).T).max() < 1.0


def test_a_recording_cut_off_in_the_middle_of_a_gesture_replays_up_to_there(pinned, drawing):
    pinned.press(END)
    pinned.move((90.0, 60.0))
    pinned.advance()
    cut = pinned.session.recording.to_text()
    after = bits(pinned.state)
    pinned.advance()
    next_line = pinned.session.recording.to_text()[len(cut) :]
    *_, last = replay(parse_recording(cut + next_line[:7]), drawing)
    assert bits(last.state) == after


PIN = {"id": 1, "face": 3, "weights": [1, 0, 0], "rest": [20, 40], "target": [20, 40]}
SETTINGS = {"do": "settings", "method": "akap", "parameters": {}}
NAN, INFINITE = float("nan"), float("inf")


def pins(**changed):
    return {"do": "pins", "pins": [{**PIN, **changed}]}


@pytest.mark.parametrize(
    "bad",
    [
        pins(face=1_000_000),
        pins(face=-1),
        pins(face=10**30),
        pins(face=INFINITE),
        pins(face="first"),
        pins(weights=[0.5, 0.2, 0.2]),
        pins(weights=[NAN, 0.5, 0.5]),
        pins(weights=[0.2, 0.4, 0.4000001]),
        pins(weights=[-0.1, 0.5, 0.6]),
        pins(weights=[0.5, 0.5]),
        pins(weights=None),
        pins(target=[NAN, 40]),
        pins(target=[1e155, 2]),
        pins(target=[10**400, 2]),
        pins(angle=10**400),
        pins(depth=10**30),
        pins(target=[1, 2, 3]),
        pins(id=NAN),
        {"do": "pins", "pins": [{}]},
        {"do": "pins", "pins": 5},
        {"do": "targets", "targets": {"2": [1, 2]}},
        {"do": "targets", "targets": {"one": [1, 2]}},
        {"do": "targets", "targets": {"1": [NAN, 2]}},
        {"do": "targets", "targets": {"1": [1e155, 2]}},
        {"do": "targets", "targets": {"9" * 5000: [1, 2]}},
        {"do": "keep", "name": "x" * 100_000},
        {"do": "settings", "method": "x" * 100_000, "parameters": {}},
        {"do": "settings", "method": "akap", "parameters": {"memory": INFINITE}},
        {"do": "settings", "method": "akap", "parameters": {"memory": 10**400}},
        {"do": "targets", "targets": {"1": [1, 2, 3]}},
        {"do": "targets", "targets": {"1": ["left", "up"]}},
        {"do": "targets", "targets": [[1, 2]]},
        {"do": "pose", "positions": [[1, 2]]},
        {"do": "pose", "positions": None},
        {"do": "settings", "method": "no such method", "parameters": {}},
        {"do": "settings", "method": "akap", "parameters": {"no such parameter": 1}},
        {"do": "settings", "method": "akap", "parameters": {"memory": None}},
        {"do": "settings", "method": "akap", "parameters": 5},
        {"do": "key", "time": -1},
        {"do": "key", "time": 0, "ease": "up"},
        {"do": "key", "time": 0, "positions": [[0, 0]]},
        {"do": "unkey", "times": 5},
        {"do": "loop", "loop": 1},
        {"do": "rekey", "from": [0], "to": []},
        {"do": "ease", "times": None, "ease": None},
        {"do": "rename", "name": "a", "to": "b"},
        {"do": "order", "names": ["a"]},
        {"do": "begin", "label": "a gesture inside a gesture"},
    ],
)
def test_an_event_that_cannot_be_done_is_named_by_its_line(drawing, bad):
    events = [SETTINGS, {"do": "begin", "label": "Pins"}, pins(), bad]
    replayed = replay(Recording(drawing_header(drawing), [{"t": 0, **event} for event in events]), drawing)
    for _ in range(3):
        next(replayed)
    with pytest.raises(InputError, match="line 5: cannot be replayed") as caught:
        next(replayed)
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("do", ["commit", "abort"])
def test_a_gesture_that_never_began_cannot_end(drawing, do):
    recording = Recording(drawing_header(drawing), [{"t": 0, "do": do}])
    with pytest.raises(InputError, match="line 2: cannot be replayed, no gesture is open"):
        list(replay(recording, drawing))


def test_on_another_mesh_a_pin_outside_the_drawing_is_named_by_its_line(drawing):
    events = [{"t": 0, "do": "begin", "label": "Pins"}, {"t": 0, **pins(rest=[2.0, 2.0])}]
    with pytest.raises(InputError, match=r"line 3: cannot be replayed, .* outside the drawing"):
        list(replay(Recording({}, events), drawing))


def test_a_recording_is_replayed_with_other_settings(driver, drawing):
    assert gestures.add_pin(driver.editor, NECK) is not None
    other = Settings("akap", (("dirichlet", False), ("memory", 0.0)))
    replayed = list(replay(driver.session.recording, drawing, lambda _: other))
    assert {event.state.settings for event in replayed} == {other}


def test_pins_with_the_same_id_are_refused_with_their_line(driver, drawing):
    assert gestures.add_pin(driver.editor, NECK) is not None
    recording = parse_recording(driver.session.recording.to_text())
    event = next(event for event in recording.events if event["do"] == "pins")
    line = recording.events.index(event) + 2
    event["pins"].append(event["pins"][0])
    with pytest.raises(InputError, match=f"line {line}: .*one id twice"):
        list(replay(recording, drawing))


# -- other drawings, earlier states --------------------------------------------------------------------------


def test_a_drawing_of_the_same_proportions_bends_alike_in_its_own_size(pinned, image):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    large = make_drawing(np.repeat(np.repeat(image, 2, axis=0), 2, axis=1), vertices=200, name="figure")
    state = replayed_state(pinned.session.recording, large)
    np.testing.assert_allclose(state.targets, 2 * pinned.state.targets, atol=1e-9)
    pin_positions = large.mesh.evaluate(state.points, state.positions)
    assert np.hypot(*(pin_positions - 2 * pinned.session.pin_positions()).T).max() < 2.0


def test_a_drawing_of_other_proportions_is_refused_in_one_sentence(pinned, image):
    other = make_drawing(np.ascontiguousarray(image.swapaxes(0, 1)), vertices=100, name="tall")
    sentence = "line 1: it was made on 'figure', 120 x 80 pixels, .* but 'tall' has 80 x 120$"
    with pytest.raises(InputError, match=sentence):
        next(replay(pinned.session.recording, other))


@pytest.mark.parametrize("size", [[0, 80], [120], "large", [None, 1], None, [NAN, 80]])
def test_a_header_with_a_bad_size_is_refused(drawing, size):
    header = {**drawing_header(drawing), "size": size, "mesh": "another"}
    with pytest.raises(InputError, match="line 1: "):
        next(replay(Recording(header, [{"t": 0, **SETTINGS}]), drawing))


def test_a_pose_of_another_mesh_with_as_many_vertices_is_refused(pinned, drawing):
    pinned.session.begin("Pose")
    pinned.session.apply(SetPose(drawing.mesh.vertices + 1.0))
    header = {**pinned.session.recording.header, "mesh": "another"}
    recording = Recording(header, pinned.session.recording.events)
    line = len(recording.events) + 1
    with pytest.raises(InputError, match=f"line {line}: .* only the mesh that it was made on"):
        list(replay(recording, drawing))


def test_a_return_to_an_earlier_state_is_exact_and_can_be_undone(pinned, drawing):
    session = pinned.session
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    line, earlier = len(session.recording.events) + 1, session.state
    pinned.drag((90.0, 60.0), (100.0, 20.0))
    pinned.settle()
    old_branch = bits(session.state)
    session.begin("Go back")
    session.return_to(earlier, line)
    session.commit()
    assert bits(session.state) == bits(earlier)
    pinned.drag((90.0, 60.0), (80.0, 55.0))
    pinned.settle()
    assert bits(replayed_state(session.recording, drawing)) == bits(session.state)
    session.undo()
    session.undo()
    assert bits(session.state) == old_branch
    assert bits(replayed_state(session.recording, drawing)) == old_branch


def test_a_step_that_fails_is_named_by_its_line(pinned, drawing, monkeypatch):
    def fail(self):
        raise SolverError("the step has no finite result")

    pinned.drag(END, (90.0, 60.0))
    monkeypatch.setattr(Session, "step", fail)
    first = next(n for n, event in enumerate(pinned.session.recording.events, 2) if event["do"] == "step")
    with pytest.raises(SolverError, match=f"line {first}: the step has no finite result"):
        list(replay(pinned.session.recording, drawing))


def replay_to_end(recording, drawing):
    """The session that a replay leaves, to go on with."""
    whole = Replay(recording, drawing)
    for _ in whole.events():
        pass
    return whole.end()


def test_a_replay_leaves_a_session_with_the_same_history(pinned, drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.drag((40.0, 40.0), (45.0, 45.0))
    assert "Add and Drag Pin" in pinned.session.history.labels
    recording = parse_recording(pinned.session.recording.to_text())
    assert sum(1 for _ in replay(recording, drawing)) == len(recording.events)
    assert replay_to_end(recording, drawing).history.labels == pinned.session.history.labels


def test_the_session_of_a_replay_of_a_half_can_go_on(pinned, drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.drag((40.0, 40.0), (45.0, 45.0))
    recording = parse_recording(pinned.session.recording.to_text())
    half = len(recording.events) // 2
    session = replay_to_end(replace(recording, events=recording.events[:half]), drawing)
    assert not session.history.is_open
    assert not session.is_moving
    assert list(session.recording.events)[:half] == recording.events[:half]
    session.begin("Add Pin")
    assert add_pin(session, (20.0, 40.0)) is not None
    session.commit()
    times = [event["t"] for event in session.recording.events]
    assert times == sorted(times)
    assert bits(replayed_state(session.recording, drawing)) == bits(session.state)


OTHER_MACHINE = """
import sys
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.recording import read_recording, recorded_drawing
recording = read_recording(sys.argv[1])
*_, last = replay(recording, recorded_drawing(recording))
sys.stdout.buffer.write(last.state.positions.tobytes())
"""


def test_a_machine_that_computes_with_other_instructions_gives_the_same_pose(pinned, drawing, tmp_path):
    """Another machine is simulated: numpy and BLAS do without newer instructions of this processor."""
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    write_recording(pinned.session.recording, tmp_path / "a.akaprec", drawing)
    older = {**os.environ, "OPENBLAS_CORETYPE": "Prescott", "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3"}
    command = [sys.executable, "-c", OTHER_MACHINE, str(tmp_path / "a.akaprec")]
    finished = subprocess.run(command, env=older, cwd=ROOT, capture_output=True, check=True)
    positions = np.frombuffer(finished.stdout).reshape(-1, 2)
    np.testing.assert_allclose(positions, pinned.state.positions, atol=1e-6, rtol=0)
