"""Surrogates against closed forms, against what they were fitted to, and against themselves."""

from dataclasses import replace

import numpy as np
import pytest

from studies.cases.effects import Effects
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from studies.cost.model import spline, steps_of
from studies.cost.surrogates import LAWS, SURROGATES, link_length, small_angle_stiffness, spring
from studies.errors import BadInput
from tests import gates

CASE = named_case("cross_axis_pivot")
UNEVEN = replace(CASE, crossing_ratio=0.3, inclination=0.6, centre_offset=(0.01, 0.02))
SMALL = 1e-3
LINEAR, PIN, FOUR_BAR, BEAM = LAWS


def turned(problem, angle):
    """The pivot turned to an angle [rad] in one increment."""
    return replace(problem, rotation=angle, increments=1)


def small_angle_stiffness_error(**changes):
    """Largest relative difference of the linear closed form's K to the spline's at rest."""
    problem = replace(CASE, **changes)
    path = spline.path(turned(problem, SMALL), control_points=8)
    return abs(small_angle_stiffness(problem) / path.stiffness[0] - 1.0)


def small_angle_place_error(problem, model, angle):
    """Difference of the body's place to that of the spline with strips that hardly stretch, in L p^2."""
    stiff = replace(problem, **of_moments(1e4 * problem.area, problem.second_moment_of_area))
    limit = spline.path(turned(stiff, angle), control_points=8)
    path = SURROGATES[model].path(turned(problem, angle))
    return np.linalg.norm(path.centre[-1] - limit.centre[-1]) / (problem.length * angle**2)


def test_linear_pivot_has_the_exact_stiffness_at_rest():
    """Requirement: K of the closed form is the spline's at rest to round-off, crossing at mid-length."""
    gates.hold("linear_pivot_stiffness", small_angle_stiffness_error)


@pytest.mark.parametrize("ratio", [0.1, 0.127322004, 0.3, 0.8])
def test_linear_pivot_for_any_crossing(ratio):
    """Requirement: K holds for every crossing ratio up to the stretch of the strips, which falls with 1/A."""
    errors = [
        small_angle_stiffness_error(
            crossing_ratio=ratio, **of_moments(f * CASE.area, CASE.second_moment_of_area)
        )
        for f in (1e3, 1e4)
    ]
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.02)


@pytest.mark.parametrize("problem", [CASE, UNEVEN], ids=["Table 1", "uneven"])
@pytest.mark.parametrize("model", [LINEAR, FOUR_BAR])
def test_small_rotations_shift_the_centre_as_the_spline_does(problem, model):
    """Requirement: closed form and fitted linkage have the exact centre shift of small rotations."""
    if model == LINEAR:  # at larger rotations the closed form is no longer exact
        gates.hold(
            "surrogate_centre_shift", lambda angle=0.01: small_angle_place_error(problem, model, angle)
        )
    else:
        gates.check("surrogate_centre_shift", small_angle_place_error(problem, model, 0.01))


def test_constants_of_table_1():
    """Requirement: for strips that cross at mid-length the links are 2/3 L, the springs 2 EI/L, and K_Theta
    is the published polynomial, at n = 1 the sum of its coefficients."""
    rigidity = CASE.youngs_modulus * CASE.second_moment_of_area / CASE.length
    assert link_length(CASE) == pytest.approx(2.0 / 3.0, rel=1e-14)
    assert spring(CASE) == pytest.approx(2.0 * rigidity, rel=1e-14)
    assert SURROGATES[PIN].path(CASE).stiffness / rigidity == pytest.approx(4.307926 / 2.0, rel=1e-12)


@pytest.mark.parametrize("problem", [CASE, UNEVEN], ids=["Table 1", "uneven"])
@pytest.mark.parametrize("model", [LINEAR, FOUR_BAR, BEAM])
def test_stiffness_is_the_derivative_of_the_torque(model, problem):
    """Requirement: the stiffness is that of the torque along the path."""
    p, h = np.linspace(-0.9, 0.7, 5), 1e-4
    up, down = (LAWS[model](problem, p + side * h).torque for side in (1.0, -1.0))
    scale = small_angle_stiffness(problem)
    assert LAWS[model](problem, p).stiffness == pytest.approx((up - down) / (2.0 * h), abs=1e-7 * scale)


def test_constraint_model_has_the_exact_stiffness_at_rest():
    """Requirement: a beam in closed form is exact at rest, stretch included, and no longer where it turns."""

    def error(angle=0.0):
        limit = spline.path(turned(UNEVEN, angle or SMALL), control_points=8)
        stiffness = LAWS[BEAM](UNEVEN, np.array([angle])).stiffness[0]
        return abs(stiffness / limit.stiffness[-1 if angle else 0] - 1.0)

    limit = spline.path(turned(UNEVEN, SMALL), control_points=8)
    assert LAWS[BEAM](UNEVEN, np.zeros(1)).centre[0] == pytest.approx(limit.centre[0], abs=1e-15)
    gates.hold("constraint_model_stiffness", error)


@pytest.mark.parametrize("changes", [{"crossing_ratio": 0.4}, {"inclination": 0.3}, {"inclination": 1.4}])
def test_pin_joint_refuses_what_it_was_not_published_for(changes):
    """Requirement: outside its range of validity the pin joint is refused in one line."""
    with pytest.raises(BadInput, match=r"^pin joint: got .* expected [^\n]*$"):
        SURROGATES[PIN].path(replace(CASE, **changes))


def test_bad_input_is_refused_in_one_line():
    """Requirement: what cannot be asked is refused with what was got and expected."""
    loaded = replace(CASE, effects=Effects(names=("bending", "gravity")))
    with pytest.raises(BadInput, match=r"^step: got 0.02[^\n]*expected[^\n]*$"):
        steps_of(0.01, 0.02)
    with pytest.raises(BadInput, match=r"^effects: got bending, gravity[^\n]*expected[^\n]*$"):
        SURROGATES[FOUR_BAR].path(loaded)
