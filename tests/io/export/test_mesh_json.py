"""The JSON of mesh and pins: every number comes back."""

import json
from dataclasses import replace

import numpy as np

from akap_editor.geometry.mesh import TriMesh


def test_every_bit_comes_back(exported, bent):
    text = exported(bent, "a.json").read_text()
    record = json.loads(text)
    assert text.count("\n") == 2 + len(record)
    drawing, state = bent.drawing, bent.state
    assert (record["format"], record["version"], record["name"]) == ("akap-mesh", 1, "ring & disc")
    assert record["picture"] == {"width": 140, "height": 90}
    mesh = TriMesh(record["vertices"], record["faces"])
    np.testing.assert_array_equal(mesh.vertices, drawing.mesh.vertices)
    np.testing.assert_array_equal(mesh.faces, drawing.mesh.faces)
    np.testing.assert_array_equal(np.array(record["positions"]), state.positions)
    np.testing.assert_array_equal(np.array(record["uv"], dtype=np.float32), drawing.uv)
    assert record["settings"] == {"method": "akap", "parameters": {"memory": 1.0}}


def test_angles_of_pins_and_stiffness_are_written(exported, bent):
    record = json.loads(exported(bent, "a.json").read_text())
    assert [pin["angle"] for pin in record["pins"]] == [None, None]
    assert record["stiffness"] is None
    first, second = bent.state.pins
    stiffness = np.linspace(1, 50, len(bent.drawing.mesh.faces)).round(2)
    state = replace(bent.state, pins=(first, replace(second, angle=-7.25)), stiffness=stiffness)
    record = json.loads(exported(bent.with_state(state), "a.json").read_text())
    assert [pin["angle"] for pin in record["pins"]] == [None, -7.25]
    assert record["stiffness"] == stiffness.tolist()


def test_pins_are_where_their_weights_say(exported, bent):
    record = json.loads(exported(bent, "a.json").read_text())
    assert [pin["id"] for pin in record["pins"]] == [1, 4]
    for pin, original in zip(record["pins"], bent.state.pins, strict=True):
        corners = record["faces"][pin["face"]]
        for key, points in (("rest", "vertices"), ("position", "positions")):
            expected = pin["weights"] @ np.array(record[points])[corners]
            np.testing.assert_allclose(pin[key], expected, rtol=1e-12)
        assert pin["target"] == original.target.tolist()
