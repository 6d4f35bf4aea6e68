"""Other codes: not needed, refused when absent, in agreement with both models; and closed surrogates."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.reference import largest_errors, reference
from studies.answers.settings import SplineSettings
from studies.cases.effects import Effects
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from studies.cost.exudyn import exudyn_ancf, exudyn_exact
from studies.cost.model import Model, elements, spline, steps_of
from studies.cost.openseespy import openseespy_frame
from studies.cost.surrogates import LAWS, SURROGATES, link_length, small_angle_stiffness, spring
from studies.cost.tried import compared, grid
from studies.errors import BadInput, Unanswered
from tests import gates

CASE = named_case("cross_axis_pivot")

exudyn = pytest.mark.skipif(not exudyn_ancf.installed(), reason="exudyn is not installed (.[peers])")
opensees = pytest.mark.skipif(
    not openseespy_frame.installed(), reason="openseespy is not installed (.[peers])"
)


def apart(path, limit):
    """Larger error of trajectory and torque over the path."""
    found = largest_errors(path, limit)
    return max(found["trajectory"], found["torque"])


def against_spline(model, problem=CASE, **settings):
    """The same against the refined spline."""
    limit = answer_static(problem, SplineSettings(control_points=14))
    return apart(model.path(problem, **settings), limit)


#: Gate of a code's path, the code, and the elements at which it is asked.
PATHS = [
    pytest.param("exudyn_ancf_path", exudyn_ancf, 40, marks=exudyn),
    pytest.param("openseespy_path", openseespy_frame, 80, marks=opensees),
]


@pytest.mark.parametrize(("gate", "model", "count"), PATHS)
def test_path_tends_to_the_spline(gate, model, count):
    """Requirement: ANCF cables, of the same theory, and corotational frames with a body of stiff links come
    to the spline's path; nothing else is shared."""
    gates.hold(gate, lambda elements=count: against_spline(model, elements=elements))


@exudyn
@pytest.mark.slow
def test_exact_beam_tends_to_the_reissner_elements():
    """Requirement: Exudyn's rod with shear comes to the limit of this repository's elements with shear."""
    limit = reference(CASE, "reissner")
    gates.hold(
        "exudyn_exact_path", lambda elements=20: apart(exudyn_exact.path(CASE, elements=elements), limit)
    )


@pytest.mark.parametrize(("gate", "model", "count"), PATHS)
def test_other_designs_come_through_alike(gate, model, count):
    """Requirement: strips of other inclination and crossing, with the body off the middle, agree as well."""
    uneven = replace(CASE, crossing_ratio=0.3, inclination=0.6, centre_offset=(0.01, 0.02))
    uneven = replace(uneven, rotation=1.2, increments=16)
    gates.check(gate, against_spline(model, uneven, elements=count))


@exudyn
def test_exudyn_says_where_it_stops():
    """Requirement: a path that does not converge is an error with the place, never a wrong answer."""
    with pytest.raises(Unanswered, match=r"Exudyn: .*no convergence at load factor"):
        exudyn_ancf.path(CASE, elements=40, relative_tolerance=1e-14)


def test_failed_setting_keeps_its_row():
    """Requirement: a setting that fails is a row with the reason; one that does not has errors and times of
    whole calls, of which the increments are a part."""

    def stopping(*_, **__):
        raise Unanswered("stopped at 0.1 rad")

    limits = {"material": reference(CASE)}
    asked = [*grid(Model(name="failing", path=stopping), "x"), *grid(elements, "y", elements=(5, 20))]
    failed, coarse, fine = compared(asked, CASE, limits, passes=1).to_dict("records")
    assert (failed["status"], failed["message"], failed["runs"]) == ("failed", "stopped at 0.1 rad", 0)
    assert math.isnan(failed["torque"])
    assert fine["torque"] < 0.1 * coarse["torque"] < 0.01
    assert 0.0 < fine["solve_s"] < fine["whole_s"]


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
