import os
import random
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import SetPose
from akap_editor.editor.session.recording import Recording, drawing_header, parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError, SolverError
from akap_editor.io.akap.recording import write_recording
from tests.support.editor_driver import Driver, bits

ROOT = Path(__file__).parents[3]
HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)


def last(recording, drawing):
    """The state that a recording ends with."""
    *_, moment = replay(recording, drawing)
    return moment.state


def written_and_read(recording):
    return parse_recording(recording.to_text())


def edit_at_random(driver, seed, edits=25):
    """Every kind of edit, in a random order; the states after each."""
    dice = random.Random(seed)
    editor = driver.editor

    def place():
        return dice.uniform(10, 110), dice.uniform(15, 65)

    def drag(end):
        if driver.ids:
            driver.press(driver.where(dice.choice(driver.ids)), shift=dice.random() < 0.3)
            for _ in range(3):
                driver.move(place())
                driver.advance()
            end()

    def memory():
        gestures.set_settings(
            editor, driver.state.settings.with_parameter("memory", dice.choice([0.0, 0.5, 1.0]))
        )

    def there_and_back():
        driver.undo()
        driver.redo()

    acts = [
        lambda: driver.click(place(), shift=dice.random() < 0.5),
        lambda: drag(lambda: driver.release(NECK)),
        lambda: drag(lambda: driver.release(NECK)),
        lambda: drag(lambda: driver.key("escape")),
        driver.settle,
        driver.undo,
        there_and_back,
        lambda: gestures.remove_selected_pins(editor),
        editor.select_all,
        memory,
        lambda: gestures.reset_pose(editor),
    ]
    for at in (HEAD, NECK, END):
        driver.click(at)
    for _ in range(edits):
        dice.choice(acts)()


@pytest.mark.parametrize("seed", range(4))
def test_on_its_own_mesh_a_replay_is_equal_to_the_last_bit(new_driver, drawing, seed):
    driver = new_driver()
    edit_at_random(driver, seed)
    recording = driver.session.recording
    kinds = {event["do"] for event in recording.events}
    assert {"settings", "begin", "pins", "targets", "step", "commit"} <= kinds
    assert bits(last(written_and_read(recording), drawing)) == bits(driver.state)


def test_the_random_sessions_hold_every_kind_of_event_but_a_pose(new_driver):
    kinds = set()
    for seed in range(4):
        driver = new_driver()
        edit_at_random(driver, seed)
        kinds |= {event["do"] for event in driver.session.recording.events}
    assert kinds == {
        "settings", "begin", "pins", "targets", "step", "commit", "abort", "undo", "redo", "reset",
    }  # fmt: skip


def test_every_state_on_the_way_is_that_of_the_session(pinned, drawing):
    """Not only the last one: a replay yields one state an event, with its time."""
    session = pinned.session
    pinned.press(END)
    pinned.move((90.0, 60.0))
    poses = [session.state.positions.tobytes()]
    first = len(session.recording.events)
    while pinned.editor.moving:
        pinned.advance()
        poses.append(session.state.positions.tobytes())
    frames = list(replay(written_and_read(session.recording), drawing))
    assert [frame.time for frame in frames] == [event["t"] for event in session.recording.events]
    assert [state.positions.tobytes() for _, state, *_ in frames[first - 1 :]] == poses


def test_a_session_that_began_in_the_middle_replays_too(pinned, drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    resumed = Driver(pinned.session.document)
    resumed.drag((90.0, 60.0), (95.0, 50.0))
    resumed.settle()
    assert bits(last(written_and_read(resumed.session.recording), drawing)) == bits(resumed.state)


def test_a_session_with_other_settings_replays_with_them(drawing):
    settings = Settings("akap", (("memory", 0.0), ("trajectory", "linear")))
    driver = Driver(new_document(drawing, settings))
    driver.click(HEAD)
    driver.drag(END, (90.0, 60.0))
    state = last(written_and_read(driver.session.recording), drawing)
    assert state.settings == settings
    assert bits(state) == bits(driver.state)


def test_on_another_mesh_of_the_picture_pins_end_near_their_targets(pinned, finer_drawing):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    state = last(written_and_read(pinned.session.recording), finer_drawing)
    assert len(state.positions) == len(finer_drawing.mesh.vertices)
    np.testing.assert_allclose(state.targets, pinned.state.targets, atol=1e-9)
    places = finer_drawing.mesh.evaluate(state.points, state.positions)
    assert np.hypot(*(places - pinned.session.pin_positions()).T).max() < 1.0


def test_a_recording_cut_off_in_the_middle_of_a_gesture_replays_up_to_there(pinned, drawing):
    pinned.press(END)
    pinned.move((90.0, 60.0))
    pinned.advance()
    cut = pinned.session.recording.to_text()
    after = bits(pinned.state)
    pinned.advance()
    next_line = pinned.session.recording.to_text()[len(cut) :]
    assert bits(last(parse_recording(cut + next_line[:7]), drawing)) == after


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
        pins(weights=[0.5, 0.5]),
        pins(weights=None),
        pins(target=[NAN, 40]),
        pins(target=[1, 2, 3]),
        pins(id=NAN),
        {"do": "pins", "pins": [{}]},
        {"do": "pins", "pins": 5},
        {"do": "targets", "targets": {"2": [1, 2]}},
        {"do": "targets", "targets": {"one": [1, 2]}},
        {"do": "targets", "targets": {"1": [NAN, 2]}},
        {"do": "targets", "targets": {"1": [1, 2, 3]}},
        {"do": "targets", "targets": {"1": ["left", "up"]}},
        {"do": "targets", "targets": [[1, 2]]},
        {"do": "pose", "positions": [[1, 2]]},
        {"do": "pose", "positions": None},
        {"do": "settings", "method": "no such method", "parameters": {}},
        {"do": "settings", "method": "akap", "parameters": {"no such parameter": 1}},
        {"do": "settings", "method": "akap", "parameters": {"memory": None}},
        {"do": "settings", "method": "akap", "parameters": 5},
        {"do": "begin", "label": "a gesture inside a gesture"},
    ],
)
def test_an_event_that_cannot_be_done_is_named_by_its_line(drawing, bad):
    events = [SETTINGS, {"do": "begin", "label": "Pins"}, pins(), bad]
    text = Recording(drawing_header(drawing), [{"t": 0, **event} for event in events]).to_text()
    frames = replay(parse_recording(text), drawing)
    for _ in range(3):
        next(frames)
    with pytest.raises(InputError, match="line 5: cannot be replayed"):
        next(frames)


@pytest.mark.parametrize("do", ["commit", "abort"])
def test_a_gesture_that_never_began_cannot_end(drawing, do):
    recording = Recording(drawing_header(drawing), [{"t": 0, "do": do}])
    with pytest.raises(InputError, match="line 2: cannot be replayed, no gesture is open"):
        list(replay(recording, drawing))


def test_on_another_mesh_a_pin_beside_the_drawing_is_named(drawing):
    events = [{"t": 0, "do": "begin", "label": "Pins"}, {"t": 0, **pins(rest=[2.0, 2.0])}]
    with pytest.raises(InputError, match=r"line 3: cannot be replayed, .* outside the drawing"):
        list(replay(Recording({}, events), drawing))


def test_a_recording_is_replayed_with_other_settings(driver, drawing):
    a = gestures.add_pin(driver.editor, NECK)
    assert a is not None
    other = Settings("akap", (("dirichlet", False), ("memory", 0.0)))
    states = [moment.state for moment in replay(driver.session.recording, drawing, lambda _: other)]
    assert {state.settings for state in states} == {other}


def test_pins_with_the_same_id_are_refused_with_their_line(driver, drawing):
    assert gestures.add_pin(driver.editor, NECK) is not None
    recording = written_and_read(driver.session.recording)
    event = next(event for event in recording.events if event["do"] == "pins")
    line = recording.events.index(event) + 2
    event["pins"].append(event["pins"][0])
    with pytest.raises(InputError, match=f"line {line}: .*one id twice"):
        list(replay(recording, drawing))


# -- other drawings, going back ------------------------------------------------------------------------------


def test_a_drawing_of_the_same_proportions_bends_alike_in_its_own_size(pinned, image):
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    large = make_drawing(np.repeat(np.repeat(image, 2, axis=0), 2, axis=1), vertices=200, name="figure")
    state = last(written_and_read(pinned.session.recording), large)
    np.testing.assert_allclose(state.targets, 2 * pinned.state.targets, atol=1e-9)
    places = large.mesh.evaluate(state.points, state.positions)
    assert np.hypot(*(places - 2 * pinned.session.pin_positions()).T).max() < 2.0


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


def test_going_back_restores_exactly_and_the_old_branch_can_be_undone_to(pinned, drawing):
    session = pinned.session
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    line, then = len(session.recording.events) + 1, session.state
    pinned.drag((90.0, 60.0), (100.0, 20.0))
    pinned.settle()
    old_branch = bits(session.state)
    session.begin("Go back")
    session.return_to(then, line)
    session.commit()
    assert bits(session.state) == bits(then)
    pinned.drag((90.0, 60.0), (80.0, 55.0))
    pinned.settle()
    assert bits(last(written_and_read(session.recording), drawing)) == bits(session.state)
    session.undo()
    session.undo()
    assert bits(session.state) == old_branch
    assert bits(last(written_and_read(session.recording), drawing)) == old_branch


def test_a_step_that_fails_is_named_by_its_line(pinned, drawing, monkeypatch):
    def fail(self):
        raise SolverError("the step has no finite result")

    pinned.drag(END, (90.0, 60.0))
    monkeypatch.setattr(Session, "step", fail)
    first = next(n for n, event in enumerate(pinned.session.recording.events, 2) if event["do"] == "step")
    with pytest.raises(SolverError, match=f"line {first}: the step has no finite result"):
        list(replay(pinned.session.recording, drawing))


OTHER_MACHINE = """
import sys
from akap_editor.editor.session.replay import replay
from akap_editor.io.akap.recording import read_recording, recorded_drawing
recording = read_recording(sys.argv[1])
*_, last = replay(recording, recorded_drawing(recording))
sys.stdout.buffer.write(last.state.positions.tobytes())
"""


def test_a_machine_that_computes_with_other_instructions_gives_the_same_pose(pinned, drawing, tmp_path):
    """As near as one machine can come to another: numpy and BLAS without what this processor has."""
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    write_recording(pinned.session.recording, tmp_path / "a.akaprec", drawing)
    older = {**os.environ, "OPENBLAS_CORETYPE": "Prescott", "NPY_DISABLE_CPU_FEATURES": "AVX2 FMA3"}
    command = [sys.executable, "-c", OTHER_MACHINE, str(tmp_path / "a.akaprec")]
    done = subprocess.run(command, env=older, cwd=ROOT, capture_output=True, check=True)
    elsewhere = np.frombuffer(done.stdout).reshape(-1, 2)
    np.testing.assert_allclose(elsewhere, pinned.state.positions, atol=1e-6, rtol=0)
