"""The mirror as a value: reflections, pairs, and what is read from files."""

import math

import numpy as np
import pytest

from akap_editor.editor.document.rig.mirror import Mirror, suggest_pairs
from akap_editor.errors import InputError

POINTS = np.array([(3.0, 4.0), (-10.0, 0.5), (100.0, -20.0)])


@pytest.mark.parametrize("angle", [0.0, 0.3, math.pi / 2, 2.8])
def test_a_reflection_is_an_isometry_that_undoes_itself_and_keeps_the_axis(angle):
    mirror = Mirror(7.0, -2.0, angle)
    once = mirror.points(POINTS)
    np.testing.assert_allclose(mirror.points(once), POINTS, atol=1e-12)
    np.testing.assert_allclose(mirror.distances(once), mirror.distances(POINTS), atol=1e-12)
    (a, b, c), (x, y, z) = POINTS, once
    area, mirrored_area = (np.linalg.det([q - p, r - p]) for p, q, r in ((a, b, c), (x, y, z)))
    assert area == pytest.approx(-mirrored_area), "it turns over"
    on_axis = np.array([(7.0 + 5 * math.cos(angle), -2.0 + 5 * math.sin(angle))])
    np.testing.assert_allclose(mirror.points(on_axis), on_axis, atol=1e-12)
    np.testing.assert_allclose(mirror.points(POINTS[1:]) - once[0], mirror.vectors(POINTS[1:] - POINTS[0]))


def test_a_pin_is_in_one_pair():
    mirror = Mirror(0.0, 0.0, 0.0).with_pair(1, 2).with_pair(3, 4)
    assert [mirror.partner(pin) for pin in (1, 2, 3, 4, 5)] == [2, 1, 4, 3, None]
    assert mirror.with_pair(2, 3).pairs == ((2, 3),)
    assert mirror.of_pins([1, 2, 3]).pairs == ((1, 2),)
    assert mirror.without([9]) is mirror


def test_neighbors_across_the_axis_are_pairs():
    mirror = Mirror(50.0, 0.0, math.pi / 2)
    places = {1: (40.0, 10.0), 2: (61.0, 12.0), 3: (50.0, 90.0), 4: (20.0, 60.0), 5: (95.0, 60.0)}
    assert suggest_pairs(mirror, places, reach=5.0) == ((1, 2),)
    assert suggest_pairs(mirror, places, reach=20.0) == ((1, 2), (4, 5))
    assert suggest_pairs(mirror, {}, 5.0) == ()


def test_it_is_read_as_it_was_written():
    mirror = Mirror(12.5, 3.25, 1.2, False, ((4, 9), (1, 2)))
    assert Mirror.from_json(mirror.to_json()) == mirror
    scaled = Mirror.from_json(mirror.to_json(), scale=2.0)
    assert (scaled.x, scaled.y, scaled.angle) == (25.0, 6.5, 1.2)


@pytest.mark.parametrize(
    "changes",
    [
        {"point": [1.0]},
        {"point": None},
        {"point": [math.nan, 0.0]},
        {"point": [1e12, 0.0]},
        {"angle": "up"},
        {"angle": math.inf},
        {"pairs": [[1]]},
        {"pairs": [[1, 2.5]]},
        {"pairs": [[1, 2], [2, 3]]},
        {"pairs": [[1, 1]]},
        {"pairs": 7},
    ],
)
def test_other_kinds_of_values_are_refused(changes):
    record = {**Mirror(1.0, 2.0, 0.5, True, ((1, 2),)).to_json(), **changes}
    with pytest.raises(InputError):
        Mirror.from_json(record)


def test_what_is_no_object_is_refused():
    with pytest.raises(InputError, match="expected an object"):
        Mirror.from_json([1, 2])
