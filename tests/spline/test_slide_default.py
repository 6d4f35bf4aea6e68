"""The slide stiffness where none is given: the static one for paths, the swing's for motions and modes."""

import numpy as np
import pytest

from spline_model import (
    cross_axis_pivot,
    natural_frequencies,
    solve_impulses,
    solve_release,
    solve_statics,
    swinging_slide_stiffness,
)
from tests.table_one import TABLE_ONE


def pivot(n, slide_stiffness=None):
    """Table 1 with n control points."""
    return cross_axis_pivot(**TABLE_ONE, control_points=n, slide_stiffness=slide_stiffness)


def answers(design):
    """What each way of solving a motion says of a design."""
    return {
        "release": solve_release(design, start=1.0, duration=2e-3).rotation,
        "modes": natural_frequencies(design, rotation=0.5, count=4).frequency,
        "impulses": solve_impulses(design, start=1.0, duration=0.02).rotation,
    }


@pytest.mark.parametrize("n", [5, 8])
def test_a_motion_has_the_slide_stiffness_of_a_swing(n):
    """Requirement: motions and modes without a slide stiffness are those with the swing's, and no others."""
    default, swinging = answers(pivot(n)), answers(pivot(n, swinging_slide_stiffness(n)))
    static = answers(pivot(n, 10.0))
    for name, found in default.items():
        assert np.array_equal(found, swinging[name])
        assert not np.array_equal(found, static[name])


def test_statics_keep_theirs():
    """Requirement: paths without a slide stiffness are those with one of 10 EI/L^2, and no others."""
    default, same, other = (
        solve_statics(pivot(6, value), rotation=1.0, increments=4)
        for value in (None, 10.0, swinging_slide_stiffness(6))
    )
    assert np.array_equal(default.torque, same.torque)
    assert not np.array_equal(default.torque, other.torque)
