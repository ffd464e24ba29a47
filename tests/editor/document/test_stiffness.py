"""Stiffness: how a stroke of the brush covers faces and changes their factors."""

import numpy as np
import pytest

from akap_editor.editor.document.stiffness import apply_stroke, as_stiffness, stroke_coverage
from akap_editor.errors import InputError

NECK = (80.0, 40.0)


def test_coverage_falls_smoothly_to_the_edge(drawing):
    coverage = stroke_coverage(drawing.mesh, [NECK], 25.0)
    distances = np.hypot(*(drawing.mesh.vertices[drawing.mesh.faces].mean(axis=1) - NECK).T)
    assert (coverage[distances < 12.0] == 1.0).all()
    assert (coverage[distances > 25.0] == 0.0).all()
    by_distance = np.argsort(distances)
    assert (np.diff(coverage[by_distance]) <= 1e-12).all()
    assert ((coverage > 0.1) & (coverage < 0.9)).any()


def test_the_smallest_brush_covers_the_face_under_it(drawing):
    rng = np.random.default_rng(5)
    for face in rng.integers(0, len(drawing.mesh.faces), 40):
        dab = rng.dirichlet([3.0, 3.0, 3.0]) @ drawing.mesh.vertices[drawing.mesh.faces[face]]
        assert stroke_coverage(drawing.mesh, [dab], 0.0)[face] > 0


def test_two_full_strokes_are_one_and_half_coverage_gives_the_square_root(drawing):
    m = len(drawing.mesh.faces)
    stiffness = apply_stroke(None, np.linspace(0, 1, m), 400.0)
    assert stiffness[-1] == 400.0
    assert stiffness[m // 2] == pytest.approx(20.0, rel=0.05)
    assert apply_stroke(apply_stroke(None, np.ones(m), 9.0), np.ones(m), 9.0).tolist() == [9.0] * m
    assert apply_stroke(stiffness, np.ones(m), 1.0) is None


@pytest.mark.parametrize("bad", [[2.0], [0.5] * 3, [np.nan] * 3, [2000.0] * 3, "soft", [[1.0]] * 3])
def test_bad_factors_are_refused(bad):
    with pytest.raises(InputError, match="stiffness: expected"):
        as_stiffness(bad, 3)


@pytest.mark.parametrize(
    ("dabs", "radius", "factor", "message"),
    [
        ([[np.nan, 0.0]], 5.0, 2.0, "dabs: expected finite"),
        ([NECK], -1.0, 2.0, "radius: expected"),
        ([NECK], 5.0, 0.5, "factor: expected"),
        ([NECK], 5.0, np.nan, "factor: expected"),
    ],
)
def test_bad_strokes_are_refused(drawing, dabs, radius, factor, message):
    with pytest.raises(InputError, match=message):
        apply_stroke(None, stroke_coverage(drawing.mesh, dabs, radius), factor)
