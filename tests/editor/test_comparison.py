"""A second method that follows the pins of a session."""

import numpy as np
import pytest

from akap_editor.deform.methods import make_deformer
from akap_editor.editor.comparison import MethodComparison
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin, remove_pins
from akap_editor.editor.session.session import Session
from akap_editor.errors import InputError
from akap_editor.geometry.distortion import distortion


@pytest.fixture
def main(drawing):
    """A session with pins at three corners of its drawing."""
    session = Session(new_document(drawing, Settings.parse("igarashi")))
    mesh = drawing.mesh
    session.begin("Pins")
    for corner in (mesh.vertices.argmin(axis=0)[0], mesh.vertices.argmax(axis=0)[0], len(mesh.faces) // 2):
        face = int(np.flatnonzero((mesh.faces == corner).any(axis=1))[0])
        add_pin(session, tuple(mesh.vertices[mesh.faces[face]].mean(axis=0)))
    session.commit()
    return session


def drag(session, dx, dy):
    pin = session.state.pins[0]
    session.begin("Drag")
    session.apply(SetTargets({pin.id: (pin.target[0] + dx, pin.target[1] + dy)}))
    session.settle()
    session.commit()


def followed(comparison, main):
    for _ in range(1000):
        comparison.follow(main)
        if not comparison.is_moving:
            return comparison.session.state.positions
    raise AssertionError("it does not come to rest")


@pytest.mark.parametrize("spec", ["cauchy-green", "mls", "arap"])
def test_it_bends_to_the_same_targets_by_its_own_method(main, spec):
    drag(main, 20.0, -10.0)
    before = main.state
    comparison = MethodComparison(spec)
    pose = followed(comparison, main)
    deformer = make_deformer(spec, main.drawing.mesh)
    deformer.set_pins(main.state.points)
    expected = main.drawing.mesh.vertices
    for _ in range(400 if spec == "arap" else 1):
        expected = deformer.step(expected, main.state.targets).positions
    assert np.abs(pose - expected).max() < (0.5 if spec == "arap" else 1e-9)
    assert main.state is before
    measured = comparison.measure()
    assert measured.area == distortion(main.drawing.mesh, pose).area
    assert comparison.measure() is measured


def test_it_follows_new_pins_removed_pins_undo_and_reset(main):
    comparison = MethodComparison("cauchy-green")
    drag(main, 20.0, -10.0)
    bent = followed(comparison, main)
    main.begin("Remove")
    remove_pins(main, [main.state.pins[1].id])
    main.commit()
    followed(comparison, main)
    assert [pin.id for pin in comparison.session.state.pins] == [pin.id for pin in main.state.pins]
    main.undo()
    assert np.abs(followed(comparison, main) - bent).max() < 0.5
    main.undo()
    followed(comparison, main)
    assert not main.is_posed
    assert not comparison.session.is_posed


def test_another_method_starts_from_the_pose_that_is_there(main):
    drag(main, 20.0, -10.0)
    comparison = MethodComparison("cauchy-green")
    followed(comparison, main)
    comparison.spec = "akap"
    comparison.follow(main)
    assert comparison.session.state.settings == Settings.parse("akap")
    comparison.close()
    assert comparison.session is None
    assert comparison.measure() is None
    assert not comparison.is_moving


def test_without_pins_or_motion_it_rests(drawing):
    session = Session(new_document(drawing))
    comparison = MethodComparison()
    comparison.follow(session)
    assert not comparison.is_moving
    assert comparison.session.state.positions.tolist() == drawing.mesh.vertices.tolist()


def test_bad_method_is_refused_and_leaves_nothing(main):
    comparison = MethodComparison("magic")
    with pytest.raises(InputError, match="method: expected one of"):
        comparison.follow(main)
    assert comparison.session is None
