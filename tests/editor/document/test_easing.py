"""Easings rise from 0 to 1; unknown names are refused."""

import numpy as np
import pytest

from akap_editor.editor.document.easing import (
    EASINGS,
    KEYFRAME_EASINGS,
    EasingCurve,
    check_keyframe_easing,
    curve_like,
    easing_curve,
    easing_function,
    end_velocities,
    keyframe_easing_function,
    mirrored_easing,
)
from akap_editor.errors import InputError


@pytest.mark.parametrize("name", EASINGS)
def test_easings_rise_from_0_to_1(name):
    values = [easing_function(name)(t) for t in np.linspace(0, 1, 101)]
    assert values[0] == 0.0
    assert values[-1] == 1.0
    assert (np.diff(values) > 0).all()


def test_hold_jumps_at_the_end():
    assert [keyframe_easing_function("hold")(t) for t in (0.0, 0.999, 1.0)] == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("bad", ["up", None, 3, ["in"]])
def test_unknown_easings_are_refused(bad):
    for function in (easing_function, keyframe_easing_function, check_keyframe_easing):
        with pytest.raises(InputError, match=r"ease: expected one of (smooth, )?none, in, out, in-out"):
            function(bad)
    with pytest.raises(InputError, match="got 'hold'"):
        easing_function("hold")
    assert [check_keyframe_easing(name) for name in KEYFRAME_EASINGS] == list(KEYFRAME_EASINGS)


@pytest.mark.parametrize("name", ["none", "in", "out", "in-out"])
def test_named_easings_are_curves_with_the_same_motion(name):
    curve, function = curve_like(name), keyframe_easing_function(name)
    for t in np.linspace(0, 1, 41):
        assert curve.value(t) == pytest.approx(function(t), abs=1e-9)
    assert curve.end_velocities == pytest.approx(end_velocities(name))


@pytest.mark.parametrize("handles", [(0, 0, 1, 1), (0.2, 1.6, 0.9, -0.4), (0, 1, 0, 1), (0.9, 0, 0.1, 1)])
def test_a_curve_is_its_name_and_mirrors_time(handles):
    curve = EasingCurve(*handles)
    assert easing_curve(check_keyframe_easing(curve.name)) == curve
    backwards = keyframe_easing_function(mirrored_easing(curve.name))
    for t in np.linspace(0, 1, 21):
        assert backwards(t) == pytest.approx(1 - curve.value(1 - t), abs=1e-6)


def test_values_of_a_curve_are_those_of_css():
    """“ease” of CSS is cubic-bezier(0.25, 0.1, 0.25, 1): at half of the time, it has done 80 % of the way."""
    assert keyframe_easing_function("cubic-bezier(0.25, 0.1, 0.25, 1)")(0.5) == pytest.approx(
        0.8024, abs=1e-4
    )
    assert keyframe_easing_function("cubic-bezier(0.3, 0, 0.5, 1.8)")(0.7) > 1


@pytest.mark.parametrize(
    "bad",
    [
        "cubic-bezier(1.5, 0, 0.5, 1)",
        "cubic-bezier(0, -2, 0.5, 1)",
        "cubic-bezier(0, 0, 1)",
        "cubic-bezier(nan, 0, 1, 1)",
        "cubic-bezier(0, 0, 1, 1" + "0" * 200 + ")",
    ],
)
def test_bad_curves_are_refused(bad):
    with pytest.raises(InputError, match=r"of a curve: expected|ease: expected"):
        check_keyframe_easing(bad)
