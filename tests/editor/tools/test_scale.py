"""The handle on the ring that scales the drawing around a pin, and what the scale does."""

import json
import zipfile
from io import BytesIO

import numpy as np
import pytest

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.rig.pin_scales import face_scales, pin_scale
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.events import PointerEvent
from akap_editor.editor.session.edits import SetKeyframe, SetRestPose, SetScales
from akap_editor.editor.tools.scale import ScalingPin, scale_handle
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import signed_areas
from akap_editor.io.akap.project import decode_document, encode_document
from tests.support.editor_driver import Driver, bits, replayed_state
from tests.support.meshers import needs_triangle
from tests.support.puppets import ARM, BODY, EYES, SKULL, puppet


def handle(d):
    """The handle of the ring that is shown, and its pin, on the screen."""
    ring = d.editor.tool.markers.ring
    return np.array(scale_handle(ring, d.editor.ui_scale)), np.array(ring.center)


def point(d, kind, at, **more):
    d.handle(PointerEvent(kind, (float(at[0]), float(at[1])), **more))


def scale_by_hand(d, factor, release=True):
    """Drag the handle away from the pin."""
    start, center = handle(d)
    point(d, "move", start)
    point(d, "press", start)
    for share in (0.3, 0.6, 1.0):
        point(d, "move", center + (1 + share * (factor - 1)) * (start - center))
        d.advance()
    if release:
        point(d, "release", center + factor * (start - center))
        d.settle()


def scale_at(d, pin):
    return pin_scale(d.session.drawing.mesh, d.state.pin(pin), d.state.positions)


def flipped(d):
    return int((signed_areas(d.state.positions, d.session.drawing.mesh.faces) <= 0).sum())


@needs_triangle
def test_a_drag_of_the_handle_scales_the_drawing_and_back(pinned, drawing):
    pinned.editor.select({2})
    scale_by_hand(pinned, 1.6)
    assert pinned.state.pin(2).scale == pytest.approx(1.6)
    assert pinned.session.history.labels[-1] == "Scale Pin"
    assert 1.35 < scale_at(pinned, 2) < 1.65  # the neck beside it, which is to stay, holds it back
    assert scale_at(pinned, 1) < 1.1
    assert bits(replayed_state(pinned.session.recording, drawing)) == bits(pinned.state)
    start, _ = handle(pinned)
    point(pinned, "press", start, clicks=2)
    point(pinned, "release", start)
    pinned.settle()
    assert pinned.state.pin(2).scale == 1.0
    np.testing.assert_allclose(pinned.state.positions, drawing.mesh.vertices, atol=0.05)


@needs_triangle
def test_escape_restores_every_bit(pinned):
    pinned.editor.select({2})
    before = pinned.everything
    scale_by_hand(pinned, 1.6, release=False)
    assert isinstance(pinned.editor.tool, ScalingPin)
    assert pinned.editor.tool.markers.ring.scale == pytest.approx(1.6)
    assert "160 %" in pinned.editor.hint
    pinned.editor.cancel()
    assert pinned.everything == before


def test_no_face_flips_however_the_scales_jump(pinned):
    random = np.random.default_rng(3)
    for _ in range(25):
        pin, scale = int(random.integers(1, 3)), float(np.exp(random.uniform(np.log(0.25), np.log(4))))
        pinned.editor.apply("Scale Pin", SetScales({pin: scale}))
        for _ in range(4):
            pinned.advance()
            assert flipped(pinned) == 0


def test_if_all_pins_scale_and_move_apart_the_whole_drawing_grows(pinned, drawing):
    rest = drawing.mesh.vertices
    center, pins = rest.mean(axis=0), pinned.session.pin_positions()
    targets = center + 1.5 * (pins - center)
    ids = [pin.id for pin in pinned.state.pins]
    pinned.editor.apply("Scale Pin", SetScales(dict.fromkeys(ids, 1.5)))
    for pin, (x, y) in zip(ids, targets.tolist(), strict=True):
        gestures.move_pin(pinned.editor, pin, (x, y))
    pinned.settle()
    np.testing.assert_allclose(pinned.state.positions, center + 1.5 * (rest - center), atol=0.3)


def test_without_memory_and_with_other_methods_there_is_no_handle(pinned):
    pinned.editor.select({2})
    at, _ = handle(pinned)
    for spec in ("akap:memory=0", "arap"):
        gestures.set_settings(pinned.editor, Settings.parse(spec))
        assert not pinned.session.supports_scales
        point(pinned, "press", at)
        assert not isinstance(pinned.editor.tool, ScalingPin)
        point(pinned, "release", at)
        pinned.undo()


def test_keyframes_and_a_new_rest_pose_take_the_scale_along(pinned):
    pinned.editor.apply("Scale Pin", SetScales({2: 1.5}))
    pinned.settle()
    pinned.editor.apply("Key", SetKeyframe(1.0))
    scaled = pinned.state.positions
    gestures.reset_pose(pinned.editor)
    assert pinned.state.pin(2).scale == pytest.approx(1.0)
    key = pinned.state.animation.keyframes[0]
    gestures.set_pose(pinned.editor, key.positions)
    assert pinned.state.pin(2).scale == pytest.approx(scale_at(pinned, 2))
    assert pinned.state.pin(2).scale > 1.25
    assert pinned.state.positions.tobytes() == scaled.tobytes()
    pinned.editor.apply("Rest", SetRestPose())
    assert pinned.state.pin(2).scale == pytest.approx(1.0)


def test_documents_keep_scales_as_version_2(pinned):
    plain = encode_document(pinned.session.document)
    pinned.editor.apply("Scale Pin", SetScales({2: 1.5}))
    data = encode_document(pinned.session.document)
    versions = [
        json.loads(zipfile.ZipFile(BytesIO(each)).read("document.json"))["version"] for each in (plain, data)
    ]
    assert versions == [1, 2]
    assert decode_document(data).state.pin(2).scale == 1.5
    assert encode_document(decode_document(data)) == data


@pytest.mark.parametrize("scale", [0.2, 4.1, float("nan"), "large"])
def test_scales_out_of_range_are_refused(pinned, scale):
    with pytest.raises(InputError, match="scale of a pin"):
        pinned.session.apply(SetScales({2: scale}))
    with pytest.raises(InputError, match="ids of pins"):
        pinned.session.apply(SetScales({7: 1.5}))


def test_eyes_grow_with_the_head_that_they_ride_on():
    d = Driver(new_document(puppet()))
    skull, body = (gestures.add_pin(d.editor, at) for at in ((80.0, 30.0), (80.0, 160.0)))
    mesh = d.session.drawing.mesh
    assert [int(mesh.face_layers[pin.face]) for pin in d.state.pins] == [SKULL, BODY]
    d.editor.apply("Scale Pin", SetScales({skull: 1.5}))
    d.settle()

    def sizes():
        areas = np.bincount(mesh.face_layers, signed_areas(d.state.positions, mesh.faces))
        return np.sqrt(areas / np.bincount(mesh.face_layers, mesh.rest_areas))

    assert sizes()[SKULL] > 1.2
    assert sizes()[EYES] == pytest.approx(sizes()[SKULL], rel=0.15)
    assert sizes()[BODY] < 1.15
    assert sizes()[ARM] < 1.15
    d.editor.apply("Scale Pin", SetScales({skull: 1.0}))
    d.settle()
    np.testing.assert_allclose(sizes(), 1.0, atol=1e-3)
    assert body is not None


def test_scales_are_blended_by_distance(pinned, drawing):
    assert face_scales(drawing.mesh, pinned.state.pins) is None
    pinned.editor.apply("Scale Pin", SetScales({2: 2.0}))
    scales = face_scales(drawing.mesh, pinned.state.pins)
    assert face_scales(drawing.mesh, pinned.state.pins) is scales
    first, second, *_ = pinned.state.pins
    assert scales[first.face] < 1.15 < 1.75 < scales[second.face]
    assert scales.min() >= 1.0
    assert scales.max() <= 2.0
