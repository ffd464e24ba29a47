"""Renumbering a mesh for the solver, and back."""

import numpy as np
import pytest

from akap_editor.deform.akap.elimination_order import EliminationOrder
from akap_editor.geometry.mesh import TriMesh
from tests.support import shapes


@pytest.mark.parametrize("name", shapes.SHAPES)
def test_everything_keeps_its_place(name):
    mesh = shapes.SHAPES[name]
    order = EliminationOrder(mesh)
    assert (order.positions(order.pose(mesh.vertices)) == mesh.vertices).all()
    assert (order.mesh.vertices == np.stack([(p := order.pose(mesh.vertices)).real, p.imag], axis=1)).all()
    points = shapes.random_pins(mesh, 3, 4)
    moved = order.mesh.evaluate(order.points(points), order.mesh.vertices)
    assert (moved == mesh.evaluate(points, mesh.vertices)).all()
    areas = order.face_values(mesh.rest_areas)
    assert np.abs(areas - order.mesh.rest_areas).max() < 1e-12 * areas.max()


@pytest.mark.parametrize("name", shapes.SHAPES)
def test_faces_follow_their_last_vertex(name):
    last = EliminationOrder(shapes.SHAPES[name]).mesh.faces.max(axis=1)
    assert (np.diff(last) >= 0).all()


def test_renumbered_mesh_is_as_sound_as_before():
    mesh = EliminationOrder(shapes.SHAPES["islands"]).mesh
    checked = TriMesh(mesh.vertices, mesh.faces, mesh.tied)
    assert (checked.edges == mesh.edges).all()
    assert mesh.tied == shapes.SHAPES["islands"].tied
    assert not mesh.faces.flags.writeable
