"""Other codes: not needed, refused in one line when absent, and when there in agreement with both models."""

import math
from dataclasses import replace

import pytest

from studies.answers.adapters import answer_static
from studies.answers.reference import largest_errors, reference
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.cost.exudyn import exudyn_ancf, exudyn_exact
from studies.cost.model import Model, elements
from studies.cost.openseespy import openseespy_frame
from studies.cost.tried import compared, grid
from studies.errors import Unanswered
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
