"""Other codes: not needed, refused in one line when absent, and when there in agreement with both models."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.reference import limit_of
from studies.answers.settings import FeSettings
from studies.baselines import compared
from studies.baselines.answer import BaselineFailed, SolvedPath
from studies.baselines.compared import PEERS, tried
from studies.baselines.exudyn_solve import SOLVERS
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import elements, spline
from studies.baselines.variant import grid
from studies.cases.problem import named_case
from studies.errors import BadInput
from studies.work_precision.limits import errors_of
from tests import gates

CASE = named_case("cross_axis_pivot")
TURNS = np.linspace(0.0, math.pi / 2, 21)

exudyn = pytest.mark.skipif(not exudyn_ancf.installed(), reason="exudyn is not installed (.[peers])")
opensees = pytest.mark.skipif(
    not openseespy_frame.installed(), reason="openseespy is not installed (.[peers])"
)


def against_spline(module, problem=CASE, turns=TURNS, **settings):
    """Larger error of trajectory and torque over the path, against the refined spline."""
    limit = spline.static_path(problem, turns, control_points=14)
    return errors_of(module.static_path(problem, turns, **settings), limit)["worst"]


#: Gate of a code's path, the code, and the elements at which it is asked.
PATHS = [
    pytest.param("exudyn_ancf_path", exudyn_ancf, 40, marks=exudyn),
    pytest.param("openseespy_path", openseespy_frame, 80, marks=opensees),
]


@pytest.mark.parametrize(("gate", "module", "count"), PATHS)
def test_path_tends_to_the_spline(gate, module, count):
    """Requirement: ANCF cables, of the same theory, and corotational frames with a body of stiff links come
    to the spline's path; nothing else is shared."""
    gates.hold(gate, lambda elements=count: against_spline(module, elements=elements))


@exudyn
def test_exact_beam_tends_to_the_reissner_elements():
    """Requirement: Exudyn's rod with shear comes to the limit of this repository's elements with shear."""
    gates.hold("exudyn_exact_path", lambda elements=20: _against_reissner(elements=elements))


def _against_reissner(**settings):
    meshes = [answer_static(CASE, FeSettings(elements=n, element="reissner")) for n in (20, 40, 80)]
    found = limit_of(meshes)
    limit = SolvedPath(
        rotation=TURNS, centre=found.centre, torque=found.torque, stiffness=found.stiffness, work={}
    )
    return errors_of(exudyn_exact.static_path(CASE, TURNS, **settings), limit)["worst"]


@pytest.mark.parametrize(("gate", "module", "count"), PATHS)
def test_other_designs_come_through_alike(gate, module, count):
    """Requirement: strips of other inclination and crossing, with the body off the middle, agree as well."""
    uneven = replace(CASE, crossing_ratio=0.3, inclination=0.6, centre_offset=(0.01, 0.02))
    gates.check(gate, against_spline(module, uneven, np.linspace(0.0, 1.2, 17), elements=count))


def swing_error(module, **settings):
    """Largest difference of the rotation to the spline's over 5 ms after the release [rad]."""
    options = {"start": math.pi / 2, "duration": 5e-3}
    limit = spline.release(CASE, **options, step=1e-6, integrator="leapfrog", control_points=8)
    motion = module.release(CASE, **options, **settings)
    return np.abs(np.interp(limit.time, motion.time, motion.rotation) - limit.rotation).max()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("gate", "module", "count"),
    [
        pytest.param("exudyn_ancf_swing", exudyn_ancf, 8, marks=exudyn),
        pytest.param("openseespy_swing", openseespy_frame, 40, marks=opensees),
    ],
)
def test_swings_as_the_spline(gate, module, count):
    """Requirement: released, the other codes follow the spline."""
    gates.hold(gate, lambda elements=count: swing_error(module, step=1e-5, elements=elements))


@exudyn
def test_tuning_changes_the_time_and_not_the_answer():
    """Requirement: the fast settings give what the code gives as it is delivered."""
    tuned, delivered = (exudyn_ancf.static_path(CASE, TURNS, elements=8, solver=solver) for solver in SOLVERS)
    assert tuned.torque == pytest.approx(delivered.torque, rel=2e-6, abs=1e-6)
    assert tuned.work["factorisations"] < delivered.work["factorisations"]


@exudyn
def test_exudyn_refuses_in_one_line():
    """Requirement: settings out of range are refused before anything is built."""
    for settings in ({"elements": 0}, {"integration": 3}, {"solver": "quick"}):
        with pytest.raises(BadInput, match=r"^(elements|integration|solver): got [^\n]* expected [^\n]*$"):
            exudyn_ancf.static_path(CASE, TURNS, **settings)
    with pytest.raises(BadInput, match=r"^nodes: got 4, expected"):
        exudyn_exact.static_path(CASE, TURNS, nodes=4)


@exudyn
def test_exudyn_says_where_it_stops():
    """Requirement: a path that does not converge is an error with the place, never a wrong answer."""
    with pytest.raises(BaselineFailed, match=r"Exudyn: .*no convergence at load factor"):
        exudyn_ancf.static_path(CASE, TURNS, elements=40, relative_tolerance=1e-14)


@opensees
def test_opensees_refuses_unequal_increments():
    """Requirement: OpenSees is driven by equal increments, and refuses others."""
    with pytest.raises(BadInput, match="unequal increments, expected equal"):
        openseespy_frame.static_path(CASE, [0.0, 0.1, 0.3])


@pytest.mark.parametrize("name", PEERS)
def test_what_is_not_installed_is_said_in_one_line(name, monkeypatch):
    """Requirement: a code that is absent is a row of the study, with what to do."""
    module = PEERS[name]
    monkeypatch.setattr(module, "installed", lambda: False)
    asked = grid(module, "x", elements=(1, 2))
    rows, times = tried(asked, None, ["worst"], judged="worst", repeat=1)
    assert [(row["status"], row["model"]) for row in rows] == [("not installed", name)]
    assert rows[0]["reason"] == "not installed: python -m pip install '.[peers]'"
    assert math.isnan(rows[0]["worst"])
    assert times == []


def test_failed_variant_keeps_its_row():
    """Requirement: a setting that fails is a row with the reason and without errors."""

    def fails(variant):
        raise BaselineFailed("stopped at 0.1 rad")

    rows, times = tried(compared.STATIC[:1], fails, ["worst"], judged="worst", repeat=1)
    assert (rows[0]["status"], rows[0]["reason"]) == ("failed", "stopped at 0.1 rad")
    assert math.isnan(rows[0]["worst"])
    assert times == []


def test_own_elements_stand_beside_the_codes():
    """Requirement: the suite's elements have the interface of a baseline and tend to the spline's path."""
    coarse, fine = (against_spline(elements, elements=count) for count in (5, 20))
    assert fine < 0.1 * coarse < 0.01
