"""Clips on the drawing that they came from, on others, and on those that lack some of their pins."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.animation.clips.clip import (
    Clip,
    ClipKey,
    ClipPin,
    clip_from_keyframes,
    pins_with_names,
)
from akap_editor.editor.animation.clips.retargeting import apply_clip, clip_targets
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.keyframes import Animation, Keyframe
from akap_editor.editor.document.pin import pin_points
from akap_editor.errors import InputError

NAMES = {1: "Body", 2: "Arm", 3: "Hand"}


@pytest.fixture
def named(pinned):
    """The document with pins that have names, and two keyframes, in the second of which the hand moves."""
    state = pinned.session.state
    pins = tuple(replace(pin, name=NAMES.get(pin.id, "")) for pin in state.pins)
    bent = state.positions + 0.1 * (state.positions - state.positions.mean(axis=0)) * [1, -1]
    keys = (Keyframe(0.5, state.positions, "smooth"), Keyframe(1.25, bent, "in"))
    return pinned.session.document.with_state(replace(state, pins=pins, animation=Animation(keys)))


def clip_of(document):
    animation = document.state.animation
    return clip_from_keyframes("Bend", document.drawing, document.state, animation, animation.times)


def test_on_its_own_drawing_the_targets_are_the_places_in_the_keyframes(named):
    clip = clip_of(named)
    assert [key.time for key in clip.keys] == [0.0, 0.75]
    assert [key.ease for key in clip.keys] == ["smooth", "in"]
    mesh, pins = named.drawing.mesh, [pin for pin in named.state.pins if pin.name]
    for key, targets in zip(
        named.state.animation.keyframes, clip_targets(clip, named.drawing, named.state), strict=True
    ):
        places = mesh.evaluate(pin_points(pins), key.positions)
        np.testing.assert_allclose([targets[pin.id] for pin in pins], places, atol=1e-6)


def bent_arm(scale=1.0, turn=0.0):
    """A clip in which the arm is rotated by a right angle and the hand's part is stretched by half."""
    z = scale * np.exp(1j * turn)
    rest = np.array([0, 1, 2]) * z
    keys = [rest, rest[0] + np.array([0, 1j, 1j + 1.5j]) * z]
    points = [np.stack([key.real, key.imag], axis=1) for key in (rest, *keys)]
    pins = (ClipPin("Body", None), ClipPin("Arm", "Body"), ClipPin("Hand", "Arm"))
    return Clip("Arm", pins, points[0], (ClipKey(0.0, points[1]), ClipKey(1.0, points[2])))


def complex_places(document, targets):
    by_name = {pin.name: pin.id for pin in document.state.pins if pin.name}
    return {name: complex(*targets[pin]) for name, pin in by_name.items()}


@pytest.mark.parametrize(("scale", "turn"), [(1.0, 0.0), (37.0, 1.1)])
def test_angles_and_relative_lengths_are_taken_over(named, scale, turn):
    rest, bent = (
        complex_places(named, each)
        for each in clip_targets(bent_arm(scale, turn), named.drawing, named.state)
    )
    upper, lower = rest["Arm"] - rest["Body"], rest["Hand"] - rest["Arm"]
    assert bent["Body"] == pytest.approx(rest["Body"], abs=1e-6)
    assert bent["Arm"] - bent["Body"] == pytest.approx(1j * upper, abs=1e-6)
    assert bent["Hand"] - bent["Arm"] == pytest.approx(1.5j * lower, abs=1e-6)


def test_a_pin_whose_parent_is_missing_hangs_on_the_next_one(named):
    pins = tuple(replace(pin, name="" if pin.name == "Arm" else pin.name) for pin in named.state.pins)
    document = named.with_state(replace(named.state, pins=pins))
    rest, bent = (
        complex_places(document, each) for each in clip_targets(bent_arm(), document.drawing, document.state)
    )
    assert bent["Hand"] - bent["Body"] == pytest.approx(1.25j * (rest["Hand"] - rest["Body"]), abs=1e-6)


def test_other_pins_move_along_with_the_root(named):
    rest = np.array([[0.0, 0], [1, 0]])
    clip = Clip(
        "Shift",
        (ClipPin("Arm", None), ClipPin("Hand", "Arm")),
        rest,
        (ClipKey(0, rest), ClipKey(1, rest + np.array([0, -0.5]))),
    )
    before, after = (np.array([*each.values()]) for each in clip_targets(clip, named.drawing, named.state))
    shift = after - before
    np.testing.assert_allclose(shift, np.broadcast_to(shift[0], shift.shape), atol=1e-9)
    length = np.linalg.norm(before[1] - before[0])
    np.testing.assert_allclose(shift[0], [0, -0.5 * length], rtol=1e-6)


def test_the_mirrored_clip_moves_the_other_way_and_changes_sides():
    clip = bent_arm()
    twice = clip.mirrored().mirrored()
    np.testing.assert_array_equal(twice.rest, clip.rest)
    sided = Clip("S", (ClipPin("Left Hand", None), ClipPin("right foot", "Left Hand")), *_two_keys())
    assert sided.mirrored().names == ("Right Hand", "left foot")
    assert sided.mirrored().pins[1].parent == "Right Hand"


def _two_keys():
    rest = np.array([[0.0, 0], [1, 0]])
    return rest, (ClipKey(0, rest),)


def solved(clip, document, **options):
    *_, keyframes = apply_clip(clip, document, **options)
    return keyframes


def test_the_keyframes_have_the_poses_and_a_loop_ends_as_it_begins(named):
    first, second = bent_arm().keys
    small = 0.85 * first.positions + 0.15 * second.positions
    keys = (first, ClipKey(0.5, small, "in"), ClipKey(1.0, first.positions))
    clip = Clip("Loop", bent_arm().pins, bent_arm().rest, keys)
    keyframes = solved(clip, named, start=2.0, speed=2.0, repeats=2)
    assert [each.time for each in keyframes] == [2.0, 2.25, 2.5, 2.75, 3.0]
    assert [each.ease for each in keyframes] == ["smooth", "in", "smooth", "in", "smooth"]
    assert keyframes[0].positions is keyframes[2].positions is keyframes[4].positions
    mesh, pins = named.drawing.mesh, [pin for pin in named.state.pins if pin.name]
    targets = clip_targets(clip, named.drawing, named.state)[1]
    places = mesh.evaluate(pin_points(pins), keyframes[1].positions)
    np.testing.assert_allclose(places, [targets[pin.id] for pin in pins], atol=1.0)


def test_what_cannot_be_applied_is_told(named):
    with pytest.raises(InputError, match="no pin of the drawing has one of them"):
        clip_targets(bent_arm(), named.drawing, new_document(named.drawing).state)
    with pytest.raises(InputError, match="needs pins with names"):
        clip_from_keyframes("No", named.drawing, new_document(named.drawing).state, Animation(), ())
    with pytest.raises(InputError, match="needs keyframes"):
        clip_from_keyframes("No", named.drawing, named.state, named.state.animation, ())


RIGHT, REST = bent_arm().keys[1].positions, bent_arm().rest


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pins": ()}, "expected 1 to"),
        ({"pins": (ClipPin("A", None), ClipPin("A", None), ClipPin("B", "A"))}, "different names"),
        ({"pins": (ClipPin("A", None), ClipPin("B", None), ClipPin("C", "A"))}, "one root"),
        ({"pins": (ClipPin("A", None), ClipPin("B", "X"), ClipPin("C", "A"))}, "one root"),
        ({"pins": (ClipPin("A", None), ClipPin("B", "C"), ClipPin("C", "B"))}, "circle"),
        ({"keys": ()}, "keys: expected"),
        ({"keys": (ClipKey(0.5, RIGHT),)}, "grow from 0"),
        ({"keys": (ClipKey(0, RIGHT), ClipKey(0, RIGHT))}, "grow from 0"),
        ({"keys": (ClipKey(0, RIGHT[:2]),)}, "positions: expected"),
        ({"keys": (ClipKey(0, RIGHT, "up"),)}, "ease: expected"),
        ({"rest": REST * np.nan}, "rest: expected"),
        ({"rest": REST * 1e12}, "rest: expected"),
    ],
)
def test_bad_clips_are_refused(change, message):
    clip = bent_arm()
    values = {"name": "Bad", "pins": clip.pins, "rest": clip.rest, "keys": clip.keys, **change}
    with pytest.raises(InputError, match=message):
        Clip(**values)


def test_pins_get_names_or_are_added(named):
    mesh = named.drawing.mesh
    unnamed = tuple(replace(pin, name="") for pin in named.state.pins)
    state = replace(named.state, pins=unnamed)
    near = mesh.evaluate(pin_points(unnamed[:1]), mesh.vertices)[0] + 0.01 * mesh.length
    layout = {"Near": tuple(near), "Far": tuple(mesh.vertices[mesh.faces[-1]].mean(axis=0))}
    pins = pins_with_names(named.drawing, state, layout)
    assert pins[0].name == "Near"
    assert {pin.name for pin in pins} >= {"Near", "Far"}
    assert pins_with_names(named.drawing, replace(state, pins=pins), layout) is pins
