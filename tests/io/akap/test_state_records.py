"""Angles that pins hold, and stiffness, in .akap files and poses."""

import json
from dataclasses import replace
from io import BytesIO
from zipfile import ZipFile

import numpy as np
import pytest

from akap_editor.errors import InputError
from akap_editor.io.akap.pose import decode_pose, encode_pose
from akap_editor.io.akap.project import decode_document, encode_document


def names(document):
    return ZipFile(BytesIO(encode_document(document))).namelist()


def described(document):
    return json.loads(ZipFile(BytesIO(encode_document(document))).read("document.json"))


def test_a_pose_has_the_angles(make_document, picture):
    plain = make_document(picture)
    pins = (replace(plain.state.pins[0], angle=0.5), *plain.state.pins[1:])
    turned = plain.with_state(replace(plain.state, pins=pins))
    assert [pin.angle for pin in decode_pose(encode_pose(turned), plain.drawing).pins] == [0.5, None]


@pytest.mark.parametrize("bad", [None, "1", True])
def test_an_angle_that_is_no_number_is_refused(make_document, picture, bad):
    plain = make_document(picture)
    record = json.loads(encode_pose(plain))
    record["pins"][0]["angle"] = bad
    with pytest.raises(InputError, match="angle"):
        decode_pose(json.dumps(record).encode(), plain.drawing)


def test_angles_and_stiffness_come_back_and_are_left_out_where_there_are_none(make_document, picture):
    plain = make_document(picture)
    assert "stiffness" not in names(plain)
    assert all("angle" not in record for record in described(plain)["pins"])
    factors = np.linspace(1.0, 1000.0, len(plain.drawing.mesh.faces))
    pins = (replace(plain.state.pins[0], angle=-7.25), *plain.state.pins[1:])
    stiff = plain.with_state(replace(plain.state, pins=pins, stiffness=factors))
    again = decode_document(encode_document(stiff))
    assert again.state.stiffness.tobytes() == factors.tobytes()
    assert [pin.angle for pin in again.state.pins] == [-7.25, *[None] * (len(pins) - 1)]


@pytest.mark.parametrize("factor", [0.5, 1001.0, np.nan])
def test_stiffness_out_of_range_is_refused(make_document, picture, factor):
    plain = make_document(picture)
    factors = np.full(len(plain.drawing.mesh.faces), factor)
    with pytest.raises(InputError, match="stiffness: expected 2 numbers from 1 to 1000"):
        encode_document(plain.with_state(replace(plain.state, stiffness=factors)))


@pytest.mark.parametrize("angle", [1e3, np.inf, np.nan])
def test_angles_out_of_range_are_refused(make_document, picture, angle):
    plain = make_document(picture)
    pins = (replace(plain.state.pins[0], angle=angle), *plain.state.pins[1:])
    with pytest.raises(InputError, match="expected an angle from"):
        encode_document(plain.with_state(replace(plain.state, pins=pins)))
