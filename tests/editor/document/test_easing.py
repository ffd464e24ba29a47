"""Easings rise from 0 to 1; unknown names are refused."""

import numpy as np
import pytest

from akap_editor.editor.document.easing import (
    EASINGS,
    KEYFRAME_EASINGS,
    check_keyframe_easing,
    easing_function,
    keyframe_easing_function,
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
