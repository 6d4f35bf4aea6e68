"""The spline model against closed forms of the same theory: limits go to round-off."""

import math

import numpy as np
import pytest

from spline_model import cross_axis_pivot, solve_mechanism, solve_statics
from studies.published.case import published
from tests import gates
from tests.closed_forms import elastica_tip
from tests.spline.scenes import LENGTH, cantilever
from tests.table_one import TABLE_ONE


def tips(increments=20, **loaded):
    """Load factors (S,), and tip (S, 3) rotation, x/L, y/L."""
    named = [f"applied_{name}" for name in loaded if name != "control_points"]
    path = solve_mechanism(cantilever(*named, **loaded), increments=increments)
    return path.load_factor, path.bodies["tip"][:, [2, 0, 1]] / (1.0, LENGTH, LENGTH)


def roll_up(control_points=16):
    """Largest error of the tip while an end moment rolls the strip up to a full circle."""
    share, found = tips(control_points=control_points, moment=2 * math.pi)
    angle = 2 * math.pi * share[1:]
    exact = np.column_stack((angle, np.sin(angle) / angle, (1 - np.cos(angle)) / angle))
    return np.abs(found[1:] - exact).max()


def tip_force(control_points=16):
    """Largest error of tip position and rotation over six loads up to 10 EI/L^2."""
    errors = []
    for load in (0.5, 1.0, 2.0, 4.0, 7.0, 10.0):
        found = tips(8, control_points=control_points, force=load)[1][-1]
        errors.append(np.abs(found - elastica_tip(load)).max())
    return max(errors)


def small_angle_stiffness(stretch="inextensible"):
    """Largest relative error of K at rest against 8 (EI/L)(1 - 3 l + 3 l^2), four crossing ratios."""
    errors = []
    for ratio in (0.5, 0.35, 0.2, 0.127322):
        pivot = cross_axis_pivot(**(TABLE_ONE | {"crossing_ratio": ratio}), control_points=4, stretch=stretch)
        found = solve_statics(pivot, rotation=0.01, increments=1).stiffness[0]
        closed_form = 8 * pivot.flexural_rigidity / TABLE_ONE["length"] * (1 - 3 * ratio + 3 * ratio**2)
        errors.append(abs(found / closed_form - 1))
    return max(errors)


CHECKS = {"spline_roll_up": roll_up, "spline_tip_force": tip_force}


@pytest.mark.parametrize("gate", CHECKS)
def test_spline_meets_the_closed_form(gate):
    """Requirement: with enough control points, and no fewer, the strip reproduces the exact elastica."""
    gates.hold(gate, CHECKS[gate])


def test_small_angle_stiffness_is_the_linear_closed_form():
    """Requirement: K at rest of inextensible strips is the closed form for any crossing ratio."""
    gates.hold("spline_small_angle_stiffness", small_angle_stiffness)


def test_published_cantilever_values():
    """Requirement: the reference itself meets Mattiasson's published table to its last digit."""
    for value in published("tip_force").values:
        angle, x, y = elastica_tip(value.load)
        found = {"displacement_x": x - 1.0, "displacement_y": y, "rotation": angle}[value.quantity]
        assert abs(found - value.published) < 1.02 * value.uncertainty
