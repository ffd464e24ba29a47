"""Playing and editing keyframes: the poses between them, scrubbing, dragging, and what is recorded."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.deform.pose_interpolation import InterpolationCache
from akap_editor.editor import gestures
from akap_editor.editor.animation.keyframe_playback import KeyframePlayback
from akap_editor.editor.animation.keyframe_poses import KeyframePoses
from akap_editor.editor.animation.keyframe_times import mirror_easings, stretch_times
from akap_editor.editor.animation.loose_motion import AnimationFrames
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import Meshing
from akap_editor.editor.document.keyframes import Keyframe
from akap_editor.editor.document.remesh import remesh_drawing
from akap_editor.editor.document.rest_pose import with_pose_as_rest
from akap_editor.editor.session.edits import Remesh
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.io.akap.project import load, save
from tests.support.editor_driver import Driver, bits, replayed_state
from tests.support.puppets import BODY, HAT, SKULL, puppet

END = (105.0, 40.0)


@pytest.fixture
def playback(pinned, clock):
    """Keyframes of the rest pose at 0, and of a bent one at 1 second."""
    playback = KeyframePlayback(pinned.editor, clock)
    playback.update()
    playback.set_keyframe(0.0)
    pinned.drag(END, (90.0, 60.0))
    pinned.settle()
    playback.update()
    playback.set_keyframe(1.0)
    playback.time = 0.0
    return playback


def times(pinned):
    return pinned.session.present.animation.times


def test_the_pose_between_keyframes_is_the_eased_in_between(playback, pinned, drawing):
    start, end = pinned.session.present.animation.keyframes
    playback.set_default_easing("in-out")
    ways = InterpolationCache()
    for moment, share in ((0.0, 0.0), (0.25, 0.15625), (0.5, 0.5), (1.0, 1.0), (7.0, 1.0)):
        expected = ways.pose(drawing.mesh, start.positions, end.positions, share)
        np.testing.assert_array_equal(playback.pose(moment), expected)
    playback.set_default_easing("none")
    np.testing.assert_array_equal(
        playback.pose(0.25), ways.pose(drawing.mesh, start.positions, end.positions, 0.25)
    )
    playback.selected = frozenset({0.0})
    playback.set_easing("hold")
    assert playback.pose(0.999) is start.positions
    assert playback.pose(1.0) is end.positions
    document = pinned.session.present_document
    poses = KeyframePoses()
    assert AnimationFrames(document).frame(1.0).pose is end.positions
    assert poses.moment(drawing.mesh, document.state.animation, 0.5).pose is start.positions


def test_every_edit_is_undone_redone_and_recorded(playback, pinned, drawing):
    session, states = pinned.session, []
    playback.selected = frozenset({1.0})
    for edit in (
        lambda: playback.set_keyframe(0.5),
        lambda: playback.shift_keyframes(0.05),
        playback.duplicate_keyframes,
        lambda: playback.set_easing("out"),
        lambda: setattr(playback, "loop", False),
        lambda: playback.set_default_easing("in"),
        lambda: playback.move_keyframe(1.0, 2.0),
        playback.delete_keyframes,
    ):
        states.append(bits(session.present))
        edit()
        assert bits(session.present) != states[-1]
    states.append(bits(session.present))
    assert bits(replayed_state(session.recording, drawing)) == states[-1]
    for state in reversed(states[:-1]):
        session.undo()
        assert bits(session.present) == state
    for state in states[1:]:
        session.redo()
        assert bits(session.present) == state


def test_a_pose_that_is_seen_between_becomes_a_keyframe_and_is_recorded(playback, pinned, drawing):
    playback.scrub(0.5)
    seen = pinned.session.state.positions
    playback.set_keyframe()
    assert times(pinned) == (0.0, 0.5, 1.0)
    np.testing.assert_array_equal(pinned.session.present.animation.keyframes[1].positions, seen)
    assert bits(replayed_state(pinned.session.recording, drawing)) == bits(pinned.session.present)


def test_looking_changes_nothing_and_edits_of_keyframes_leave_the_pose(playback, pinned):
    session, before = pinned.session, bits(pinned.session.present)
    events = len(session.recording.events)
    for moment in (0.0, 0.3, 1.0, 5.0):
        playback.scrub(moment)
        playback.update()
        assert session.is_previewing
    assert bits(session.present) == before
    assert bits(session.present_document.state) == before
    assert len(session.recording.events) == events
    positions = session.present.positions
    playback.shift_keyframes(0.1)
    playback.update()
    assert session.is_previewing, "it goes on being looked at"
    assert session.present.positions is positions
    playback.show_present()
    assert not session.is_previewing


def test_undo_of_a_pose_shows_the_present(playback, pinned):
    playback.scrub(0.5)
    pinned.undo()  # the keyframe
    playback.update()
    assert playback.is_previewing
    pinned.undo()  # the drag
    playback.update()
    assert not playback.is_previewing
    assert not pinned.session.is_previewing


def test_undo_of_a_move_brings_playhead_and_selection_back(playback, pinned):
    playback.time, playback.selected = 1.0, frozenset({0.0, 1.0})
    playback.update()
    playback.drag_keyframes({0.0: 0.2, 1.0: 0.6})
    playback.drop_keyframes()
    playback.update()
    moved = 0.6, frozenset({0.2, 0.6})
    assert (playback.time, playback.selected) == moved
    for _ in range(2):
        pinned.undo()
        playback.update()
        assert (playback.time, playback.selected) == (1.0, frozenset({0.0, 1.0}))
        assert not playback.shows_unkeyed_pose
        pinned.editor.redo()
        playback.update()
        assert (playback.time, playback.selected) == moved
    playback.scrub(0.4)
    pinned.undo()
    playback.update()
    assert playback.time == 0.4, "it has been moved since"


def test_a_keyframe_that_stays_as_it_is_changes_nothing(playback, pinned):
    before = pinned.session.present, pinned.session.history.labels
    for time in (0.0, 1.0):
        playback.scrub(time)
        playback.set_keyframe()
        assert (pinned.session.present, pinned.session.history.labels) == before
        assert playback.selected == {time}
    playback.show_present()
    playback.set_keyframe(1.0)  # of the present pose, which it holds
    assert (pinned.session.present, pinned.session.history.labels) == before


def test_undo_of_inserted_keyframes_brings_the_playhead_back(playback, pinned):
    pose = pinned.session.present.positions
    playback.scrub(0.3)
    playback.update()
    playback.insert_keyframes("Paste 2 Keyframes", [Keyframe(1.5, pose), Keyframe(2.0, 1.01 * pose)])
    playback.update()
    assert playback.time == 1.5
    pinned.undo()
    playback.update()
    assert playback.time == 0.3


def test_a_drag_of_keyframes_is_one_edit_and_passes_over_others(playback, pinned):
    playback.set_keyframe(0.5)
    playback.selected = frozenset({1.0})
    depth = pinned.session.history.depth
    for to in (0.7, 0.5, 0.2):
        playback.drag_keyframes({1.0: to})
    assert times(pinned) == (0.0, 0.5, 1.0)
    assert playback.animation.times == (0.0, 0.2, 0.5)
    playback.drop_keyframes()
    assert times(pinned) == (0.0, 0.2, 0.5)
    assert playback.selected == {0.2}
    assert pinned.session.history.depth == depth + 1
    playback.drag_keyframes({0.2: 0.5})
    playback.drop_keyframes(keep=False)
    assert times(pinned) == (0.0, 0.2, 0.5)


@pytest.mark.parametrize("selected", [(1.0,), (0.0, 1.0)])
def test_after_a_stretch_the_canvas_shows_the_pose_at_the_playhead(playback, pinned, selected):
    playback.selected = frozenset(selected)
    playback.scrub(1.0)
    for time in (1.2, 1.6, 2.0):
        playback.drag_keyframes(stretch_times((0.0, 1.0), 1.0, time))
        np.testing.assert_array_equal(pinned.state.positions, playback.pose(playback.time))
    playback.drop_keyframes()
    assert playback.time == 2.0
    np.testing.assert_array_equal(pinned.state.positions, playback.pose(2.0))
    playback.shift_keyframes(-0.5)
    np.testing.assert_array_equal(pinned.state.positions, playback.pose(playback.time))


def test_a_reopened_drawing_has_its_playhead_at_the_keyframe_that_it_shows(playback, pinned):
    again = Driver(pinned.session.present_document)
    reopened = KeyframePlayback(again.editor)
    reopened.update()
    assert reopened.time == 1.0
    assert not reopened.shows_unkeyed_pose
    gestures.move_pin(again.editor, 3, (100.0, 20.0))
    again.settle()
    assert reopened.shows_unkeyed_pose
    reopened.scrub(1.0)
    assert not reopened.shows_unkeyed_pose


@pytest.mark.parametrize(
    ("dragged", "to", "expected"),
    [(2.0, 4.0, (0, 2, 4)), (0.0, 1.0, (1, 1.5, 2)), (1.0, 2.0, (0, 2, 4)), (2.0, -9.0, (0, 0.025, 0.05))],
)
def test_stretching_keeps_the_other_end(dragged, to, expected):
    assert tuple(stretch_times((0.0, 1.0, 2.0), dragged, to).values()) == pytest.approx(expected)


@pytest.mark.parametrize(
    "ease", ["none", "in", "out", "in-out", "smooth", "cubic-bezier(0.2, 0.6, 0.4, 1.3)"]
)
def test_reversed_keyframes_play_the_motion_backwards(playback, pinned, ease):
    playback.selected = frozenset({0.0})
    playback.set_easing(ease)
    playback.set_keyframe(1.5, pinned.session.drawing.mesh.vertices)
    playback.selected = frozenset()
    moments = np.linspace(0, 1.5, 7)
    forwards = [playback.pose(time) for time in moments]
    depth = pinned.session.history.depth
    playback.reverse_keyframes()
    assert pinned.session.history.depth == depth + 1
    assert times(pinned) == (0.0, 0.5, 1.5)
    for time, pose in zip(moments, forwards[::-1], strict=True):
        np.testing.assert_allclose(playback.pose(time), pose, atol=1e-6)
    playback.reverse_keyframes()
    for time, pose in zip(moments, forwards, strict=True):
        np.testing.assert_allclose(playback.pose(time), pose, atol=1e-6)


def test_duplicates_in_reverse_lead_back(playback, pinned):
    poses = [each.positions for each in playback.animation.keyframes]
    playback.selected = frozenset({0.0, 1.0})
    playback.reverse_keyframes(copy=True)
    assert times(pinned) == (0.0, 1.0, 1.5, 2.5)
    assert playback.selected == {1.5, 2.5}
    for each, pose in zip(playback.animation.keyframes, [*poses, *poses[::-1]], strict=True):
        np.testing.assert_array_equal(each.positions, pose)


def test_only_selected_keyframes_are_reversed(playback, pinned):
    playback.set_keyframe(1.5, pinned.session.drawing.mesh.vertices)
    before = {each.time: each.positions for each in playback.animation.keyframes}
    playback.selected = frozenset({1.0, 1.5})
    playback.reverse_keyframes()
    after = {each.time: each.positions for each in playback.animation.keyframes}
    for old, new in ((0.0, 0.0), (1.0, 1.5), (1.5, 1.0)):
        np.testing.assert_array_equal(after[new], before[old])


def test_easings_of_intervals_are_mirrored():
    assert mirror_easings(["in", "out", "hold", "smooth"]) == ["smooth", "out", "in", "hold"]
    assert mirror_easings(["cubic-bezier(0.1, 0, 0.4, 1)", "in"]) == ["in", "cubic-bezier(0.6, 0, 0.9, 1)"]


def test_playing_goes_on_and_starts_over(playback, pinned, clock):
    playback.toggle_playing()
    clock.now += 0.5
    playback.advance()
    assert playback.time == pytest.approx(0.5)
    clock.now += 0.75
    playback.advance()
    assert playback.time == pytest.approx(0.25)
    playback.loop = False
    clock.now += 9
    playback.advance()
    assert playback.time == 1.0
    assert not playback.is_playing


def test_another_mesh_and_a_new_rest_pose_keep_the_keyframes(playback, pinned, drawing):
    session = pinned.session
    session.begin("Mesh")
    session.apply(
        Remesh.from_drawing(remesh_drawing(drawing, replace(drawing.meshing or Meshing(), vertices=300)))
    )
    session.commit()
    keys = session.state.animation.keyframes
    assert [len(key.positions) for key in keys] == [len(session.drawing.mesh.vertices)] * 2
    np.testing.assert_allclose(keys[0].positions, session.drawing.mesh.vertices, atol=1e-6)
    assert bits(replayed_state(session.recording, drawing)) == bits(session.state)
    assert with_pose_as_rest(session.state, session.drawing).animation is session.state.animation


def test_a_document_with_poses_and_keyframes_is_recorded_from_its_start(playback, pinned, drawing):
    gestures.add_pose(pinned.editor, "Bent")
    playback.set_default_easing("out")
    opened = Session(new_document(drawing).with_state(pinned.session.present))
    assert bits(replayed_state(opened.recording, drawing)) == bits(opened.state)


@pytest.fixture
def switched(clock):
    """Keyframes of the puppet: at 0 without its hat, at 1 with it and the skull behind the body."""
    driver = Driver(new_document(puppet()), clock)
    playback = KeyframePlayback(driver.editor, clock)
    playback.update()
    playback.set_keyframe(0.0)
    gestures.set_layers(driver.editor, "Show Layer", [HAT], visible=True)
    gestures.move_layer(driver.editor, SKULL, 0)
    playback.update()
    playback.set_keyframe(1.0)
    return driver, playback


def test_layers_are_switched_at_keyframes_and_never_blended(switched):
    driver, playback = switched
    animation = driver.session.present.animation
    frames = AnimationFrames(driver.session.present_document)
    for time, has_hat in ((0.0, False), (0.5, False), (0.999, False), (1.0, True), (9.0, True)):
        frame = frames.frame(time)
        assert frame.drawing.layers[HAT].visible is has_hat
        assert frame.drawing.layer_order[0] == (SKULL if has_hat else BODY)
        assert playback.frame(time).drawing.layer_view == frame.drawing.layer_view
        assert animation.layer_view_at(time) == frame.drawing.layer_view
    assert playback.frame(0.2).drawing is playback.frame(0.7).drawing


def test_the_canvas_shows_the_layers_at_the_playhead_and_a_gesture_goes_on_with_them(switched):
    driver, playback = switched
    session = driver.session
    before = bits(session.present)
    playback.scrub(0.5)
    assert not session.drawing.layers[HAT].visible
    playback.show_present()
    assert session.drawing.layers[HAT].visible
    assert bits(session.present) == before
    playback.scrub(0.5)
    gestures.set_layers(driver.editor, "Hide Layer", [SKULL], visible=False)
    playback.update()
    assert [layer.visible for layer in session.present_document.drawing.layers] == [
        True,
        True,
        False,
        True,
        False,
    ]
    assert playback.shows_unkeyed_pose
    assert bits(replayed_state(session.recording, puppet())) == bits(session.state)
    session.undo()
    assert bits(session.present) == before


def test_auto_key_keys_a_switched_layer(switched):
    driver, playback = switched
    playback.auto_key.is_on = True
    playback.scrub(2.0)
    playback.update()
    gestures.set_layers(driver.editor, "Hide Layer", [BODY], visible=False)
    playback.update()
    key = driver.session.present.animation.keyframes[-1]
    assert key.time == 2.0
    assert not key.layers.visible[BODY]


@pytest.fixture
def deep(playback, pinned):
    """Pin 2 has depth 3 in the keyframe at 1 second, and 0 in that at 0."""
    playback.scrub(0.0)
    playback.set_keyframe(0.0)
    playback.scrub(1.0)
    gestures.set_depth(pinned.editor, 2, 3)
    playback.update()
    assert playback.shows_unkeyed_pose
    playback.set_keyframe(1.0)
    return pinned


def depths(state):
    return {pin.id: pin.depth for pin in state.pins}


def test_depths_of_pins_are_keyed_and_change_at_keyframes(playback, deep):
    session = deep.session
    for time, depth in ((0.0, 0), (0.9, 0), (1.0, 3), (2.0, 3)):
        playback.scrub(time)
        assert depths(session.state)[2] == depth
        assert not playback.shows_unkeyed_pose
    playback.show_present()
    assert depths(session.state)[2] == 3, "of the present pose"


def test_the_order_of_limbs_is_changed_at_a_keyframe_of_the_present_pose(playback, pinned):
    session = pinned.session
    pinned.drag(pinned.where(3), (22.0, 46.0), steps=8)
    pinned.settle()
    playback.update()
    for time in (1.0, 2.0):
        playback.set_keyframe(time)
    playback.scrub(2.0)
    pinned.editor.select({3})
    gestures.order_limb(pinned.editor, False)
    playback.update()
    changed = session.state.crossings
    assert playback.shows_unkeyed_pose, "another limb is in front"
    playback.set_keyframe(2.0)
    assert not playback.shows_unkeyed_pose
    for time, is_changed in ((1.0, False), (2.0, True)):
        playback.scrub(time)
        assert np.array_equal(session.state.crossings, changed) == is_changed


def test_a_gesture_goes_on_with_the_depths_at_the_playhead(playback, deep, drawing):
    session = deep.session
    playback.scrub(0.5)
    before = bits(session.present)
    gestures.set_depth(deep.editor, 1, 5)
    assert (depths(session.state)[1], depths(session.state)[2]) == (5, 0)
    assert bits(replayed_state(session.recording, drawing)) == bits(session.state)
    session.undo()
    assert bits(session.present) == before


def test_documents_with_keyed_depths_are_recorded_saved_and_read(deep, drawing, tmp_path):
    keyframes = deep.session.present.animation.keyframes
    assert dict(keyframes[-1].depths)[2] == 3
    save(deep.session.present_document, tmp_path / "deep.akap")
    opened = load(tmp_path / "deep.akap")
    assert [each.depths for each in opened.state.animation.keyframes] == [each.depths for each in keyframes]
    recorded = Session(opened)
    assert bits(replayed_state(recorded.recording, drawing)) == bits(opened.state)


@pytest.mark.parametrize("bad", [{1: 1000}, {1: 0.5}, {"1": 1}, {10**20: 1}, {1: True}])
def test_bad_depths_are_refused(drawing, bad):
    with pytest.raises(InputError, match="depths: expected"):
        Keyframe(0.0, drawing.mesh.vertices, depths=bad)
