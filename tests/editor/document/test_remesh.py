"""Remeshing a posed drawing: pins, pose and flips, undo, and replays."""

from dataclasses import replace

import numpy as np
import pytest

from akap_editor.editor.document.document import EditState, new_document
from akap_editor.editor.document.drawing import Drawing, Meshing, make_drawing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.remesh import map_points, remesh_drawing, transfer_state
from akap_editor.editor.session.edits import Remesh, SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.recording import parse_recording
from akap_editor.editor.session.replay import replay
from akap_editor.editor.session.session import Session
from akap_editor.editor.session.stepper import PIN_TOLERANCE
from akap_editor.errors import InputError
from akap_editor.geometry.mesh import TriMesh, signed_areas


@pytest.fixture
def figure():
    """A picture of a bar and an island, on a white background with alpha 0."""
    image = np.full((120, 200, 4), 255, np.uint8)
    image[..., 3] = 0
    image[40:80, 20:150] = [200, 40, 30, 255]
    image[50:70, 165:185] = [30, 40, 200, 255]
    return image


@pytest.fixture
def bent(figure):
    """A session with the figure and three pins; the last one was dragged."""
    session = Session(new_document(make_drawing(figure, vertices=300, name="bar")), clock=lambda: 0.0)
    session.begin("Drag Pin")
    for at in [(30.0, 60.0), (85.0, 60.0), (140.0, 60.0)]:
        add_pin(session, at)
    session.apply(SetTargets({3: (130.0, 90.0)}))
    session.settle()
    session.commit()
    return session


def remesh(session, **changes):
    session.begin("Change Mesh")
    session.apply(
        Remesh.from_drawing(remesh_drawing(session.drawing, replace(session.drawing.meshing, **changes)))
    )
    session.commit()


def smooth(points):
    """A map of the plane that is linear nowhere and has no folds."""
    x, y = points.T
    return np.stack([x + 6 * np.sin(y / 20), y + 8 * np.cos(x / 30)], axis=1)


@pytest.mark.parametrize(("vertices", "expand"), [(60, 2.0), (300, 6.0), (1500, 0.0), (4000, 3.0)])
def test_a_pose_is_transferred_as_a_map(figure, vertices, expand):
    drawing = make_drawing(figure, vertices=3000)
    state = EditState((), smooth(drawing.mesh.vertices))
    other = remesh_drawing(drawing, Meshing(vertices, expand))
    positions = transfer_state(state, drawing.mesh, other).positions
    assert np.abs(positions - smooth(other.mesh.vertices)).max() < 1.2
    assert (signed_areas(positions, other.mesh.faces) > 0).all()


def test_the_same_mesh_changes_nothing(bent):
    state = transfer_state(bent.state, bent.drawing.mesh, bent.drawing)
    assert np.abs(state.positions - bent.state.positions).max() < 1e-9
    assert [pin.face for pin in state.pins] == [pin.face for pin in bent.state.pins]


def test_a_drawing_at_rest_stays_at_rest(figure):
    """The new mesh has a wider margin than the old one."""
    drawing = make_drawing(figure, vertices=200)
    state = EditState((), drawing.mesh.vertices)
    other = remesh_drawing(drawing, Meshing(900, 9.0))
    assert transfer_state(state, drawing.mesh, other).positions.tolist() == other.mesh.vertices.tolist()
    nearly = EditState((), drawing.mesh.vertices + 1e-9)
    assert np.abs(transfer_state(nearly, drawing.mesh, other).positions - other.mesh.vertices).max() < 1e-8


@pytest.mark.parametrize(
    "changes", [{"vertices": 1200}, {"vertices": 80}, {"expand": 6.0}, {"threshold": 0.9}]
)
def test_pins_and_pose_stay_and_undo_takes_it_back(bent, changes):
    state, drawing, pin_positions = bent.state, bent.drawing, bent.pin_positions()
    depth = bent.history.depth
    remesh(bent, **changes)
    assert bent.history.depth == depth + 1
    assert bent.drawing.meshing == replace(drawing.meshing, **changes)
    assert bent.drawing.image is drawing.image  # nothing to upload again
    assert [pin.id for pin in bent.state.pins] == [1, 2, 3]
    assert [pin.target.tolist() for pin in bent.state.pins] == [pin.target.tolist() for pin in state.pins]
    assert np.abs(bent.pin_positions() - pin_positions).max() < 1.5
    bent.settle()
    assert bent.pin_error() < PIN_TOLERANCE
    after = bent.state
    bent.undo()
    assert bent.state is state
    assert bent.drawing is drawing
    bent.redo()
    assert bent.state is after
    bent.begin("Bend on")
    bent.apply(SetTargets({3: (120.0, 30.0)}))
    bent.settle()
    bent.commit()
    assert bent.pin_error() < 0.25
    assert (signed_areas(bent.state.positions, bent.drawing.mesh.faces) > 0).all()


def test_escape_restores_the_mesh_bit_for_bit(bent):
    state, drawing = bent.state, bent.drawing
    bent.begin("Change Mesh")
    bent.apply(Remesh.from_drawing(remesh_drawing(drawing, Meshing(100))))
    bent.apply(Remesh.from_drawing(remesh_drawing(bent.drawing, Meshing(500))))
    bent.abort()
    assert bent.state is state
    assert bent.drawing is drawing


def test_a_pin_on_a_part_that_is_gone_is_removed(figure):
    figure[50:70, 165:185, 3] = 150
    session = Session(new_document(make_drawing(figure, vertices=300)))
    session.begin("Add pins")
    add_pin(session, (60.0, 60.0))
    add_pin(session, (175.0, 60.0))
    session.commit()
    remesh(session, threshold=0.8)
    assert [pin.id for pin in session.state.pins] == [1]
    session.undo()
    assert [pin.id for pin in session.state.pins] == [1, 2]


def test_a_recording_is_replayed(bent, figure):
    """On the same mesh to the last bit, with undo and redo; on another mesh nearly."""
    remesh(bent, vertices=700)
    bent.begin("Add Pin")
    add_pin(bent, tuple(bent.pin_positions()[0] + [6.0, 6.0]))
    bent.apply(SetTargets({2: (90.0, 50.0)}))
    bent.settle()
    bent.commit()
    bent.undo()
    bent.undo()
    bent.redo()
    bent.redo()
    recording = parse_recording(bent.recording.to_text())
    *_, last = replay(recording, make_drawing(figure, vertices=300, name="bar"))
    assert last.state.positions.tolist() == bent.state.positions.tolist()
    assert last.state.drawing.meshing == bent.drawing.meshing
    *_, other = replay(recording, make_drawing(figure, vertices=450, name="bar"))
    assert other.state.positions.shape == bent.state.positions.shape
    assert np.abs(other.state.positions - bent.state.positions).max() < 3.0


def test_background_is_removed_and_comes_back(figure):
    figure[..., 3] = 255
    session = Session(new_document(make_drawing(figure, vertices=300)))
    whole = session.drawing
    assert whole.mesh.rest_areas.sum() == pytest.approx(200 * 120)
    session.begin("Add Pin")
    add_pin(session, (60.0, 60.0))
    add_pin(session, (5.0, 5.0))
    session.commit()
    remesh(session, background=0.1)
    assert [pin.id for pin in session.state.pins] == [1]
    assert (session.drawing.image[..., 3] > 0).sum() == 40 * 130 + 20 * 20
    assert session.drawing.original.tolist() == figure.tolist()
    remesh(session, vertices=500)
    assert session.drawing.original is not None
    remesh(session, background=None)
    assert session.drawing.image.tolist() == figure.tolist()
    assert session.drawing.mesh.rest_areas.sum() == pytest.approx(200 * 120)


def test_faces_that_would_flip_are_unflipped(figure):
    """A pose with single vertices pulled far, and new faces that lie across the old ones there."""
    drawing = make_drawing(figure, vertices=400)
    pose = drawing.mesh.vertices.copy()
    inner = np.setdiff1d(np.arange(len(pose)), drawing.mesh.boundary_vertices)
    rng = np.random.default_rng(2)
    for vertex in rng.permutation(inner)[:60]:  # each as far as no face flips
        around = (drawing.mesh.faces == vertex).any(axis=1)
        for size in (20.0, 10.0, 5.0, 2.0):
            candidate = pose.copy()
            candidate[vertex] += size * rng.normal(size=2)
            if (signed_areas(candidate, drawing.mesh.faces[around]) > 0.5).all():
                pose = candidate
                break
    flipped = 0
    for vertices in (150, 380, 900):
        other = remesh_drawing(drawing, Meshing(vertices))
        mapped = map_points(other.mesh.vertices, drawing.mesh, pose)
        flipped += int((signed_areas(mapped, other.mesh.faces) <= 0).sum())
        positions = transfer_state(EditState((), pose), drawing.mesh, other).positions
        assert (signed_areas(positions, other.mesh.faces) > 0).all()
    assert flipped > 0


def test_a_mesh_off_its_picture_cannot_be_made_anew(figure):
    drawing = make_drawing(figure, vertices=100)
    moved = Drawing(figure, TriMesh(drawing.mesh.vertices + 5, drawing.mesh.faces), drawing.uv, "fish")
    with pytest.raises(InputError, match=r"the mesh of fish cannot be made anew: .* 5\.0 pixels away"):
        remesh_drawing(moved, Meshing())


def test_nothing_to_cut_out_changes_nothing(bent):
    state = bent.state
    image = bent.drawing.image.copy()
    image[..., 3] = 10
    with pytest.raises(InputError, match="transparent"):
        remesh_drawing(replace(bent.drawing, image=image), Meshing())
    assert bent.state is state


def test_a_pin_outside_the_new_mesh_moves_to_its_boundary(figure):
    drawing = make_drawing(figure, vertices=300, expand=4.0)
    point = drawing.mesh.find((16.5, 60.0))
    pin = Pin(1, int(point.faces[0]), point.weights[0], np.array([16.5, 60.0]))
    other = remesh_drawing(drawing, Meshing(300, 0.0))
    state = transfer_state(EditState((pin,), drawing.mesh.vertices), drawing.mesh, other)
    assert other.mesh.evaluate(state.points, other.mesh.vertices)[0] == pytest.approx([20, 60], abs=0.6)


@pytest.mark.parametrize(
    "targets",
    [
        {1: (29.0, 47.0), 2: (38.0, -1.0), 3: (117.0, 89.0), 4: (82.0, 79.0)},
        {1: (50.0, 104.0), 2: (-16.0, 57.0), 3: (97.0, 94.0), 4: (106.0, 97.0)},
        {1: (8.0, 56.0), 2: (90.0, 76.0), 3: (31.0, 60.0), 4: (74.0, 64.0)},
    ],
)
def test_pins_return_to_their_targets_on_a_mesh_too_coarse_for_the_pose(figure, targets):
    session = Session(new_document(make_drawing(figure, vertices=1200)))
    session.begin("Bend")
    for place in ((40.0, 60.0), (80.0, 60.0), (120.0, 60.0), (150.0, 60.0)):
        add_pin(session, place)
    session.apply(SetTargets(targets))
    session.settle()
    session.commit()
    remesh(session, vertices=60)
    assert session.pin_error() > 5, "the mesh is no coarser than the bend"
    session.settle()
    assert session.pin_error() < PIN_TOLERANCE
    assert {pin.id: tuple(pin.target) for pin in session.state.pins} == targets


def test_pins_that_escape_stopped_stay_where_they_are_on_another_mesh(bent):
    bent.begin("Bend")
    bent.apply(SetTargets({3: (110.0, 20.0)}))
    bent.step()
    bent.commit()
    bent.stop_motion()
    remesh(bent, vertices=300)
    assert not bent.is_moving


def test_a_drawing_at_rest_does_not_move_on_another_mesh(figure):
    session = Session(new_document(make_drawing(figure, vertices=300)))
    session.begin("Add pin")
    add_pin(session, (60.0, 60.0))
    session.commit()
    remesh(session, vertices=900)
    assert not session.is_moving
    assert not session.is_posed
