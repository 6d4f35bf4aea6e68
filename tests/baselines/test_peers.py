"""Other codes: not needed, refused in one line when absent, and when there in agreement with both models."""

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.answers.adapters import answer_static
from studies.answers.reference import limit_of
from studies.answers.settings import FeSettings
from studies.baselines import compared, peers
from studies.baselines.answer import BaselineFailed, SolvedPath
from studies.baselines.compared import PEERS, kept, spread, tried
from studies.baselines.exudyn_solve import SOLVERS
from studies.baselines.exudyn_strips import exudyn_ancf, exudyn_exact
from studies.baselines.openseespy import openseespy_frame
from studies.baselines.own import elements, spline
from studies.baselines.variant import grid
from studies.cases.problem import named_case
from studies.errors import BadInput
from studies.work_precision.limits import errors_of, path_limits
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


@exudyn
def test_ancf_tends_to_the_spline():
    """Requirement: ANCF cables, of the same theory, come to the spline's path; nothing else is shared."""
    gates.check("exudyn_ancf_path", against_spline(exudyn_ancf, elements=40))


@exudyn
def test_ancf_gate_has_teeth():
    """Requirement: the check notices half as many elements."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("exudyn_ancf_path", against_spline(exudyn_ancf, **gates.teeth("exudyn_ancf_path")))


@exudyn
def test_exact_beam_tends_to_the_reissner_elements():
    """Requirement: Exudyn's rod with shear comes to the limit of this repository's elements with shear."""
    gates.check("exudyn_exact_path", _against_reissner(elements=20))


@exudyn
def test_exact_beam_gate_has_teeth():
    """Requirement: the check notices four elements."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("exudyn_exact_path", _against_reissner(**gates.teeth("exudyn_exact_path")))


def _against_reissner(**settings):
    meshes = [answer_static(CASE, FeSettings(elements=n, element="reissner")) for n in (20, 40, 80)]
    found = limit_of(meshes)
    limit = SolvedPath(
        rotation=TURNS, centre=found.centre, torque=found.torque, stiffness=found.stiffness, work={}
    )
    return errors_of(exudyn_exact.static_path(CASE, TURNS, **settings), limit)["worst"]


@exudyn
@opensees
@pytest.mark.parametrize(("module", "elements"), [(exudyn_ancf, 40), (openseespy_frame, 80)])
def test_other_designs_come_through_alike(module, elements):
    """Requirement: strips of other inclination and crossing, with the body off the middle, agree as well."""
    uneven = replace(CASE, crossing_ratio=0.3, inclination=0.6, centre_offset=(0.01, 0.02))
    name = "exudyn_ancf_path" if module is exudyn_ancf else "openseespy_path"
    gates.check(name, against_spline(module, uneven, np.linspace(0.0, 1.2, 17), elements=elements))


@opensees
def test_frame_tends_to_the_spline():
    """Requirement: OpenSees' corotational frames come to the spline's path, body of stiff links included."""
    gates.check("openseespy_path", against_spline(openseespy_frame, elements=80))


@opensees
def test_frame_gate_has_teeth():
    """Requirement: the check notices a quarter of the elements."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("openseespy_path", against_spline(openseespy_frame, **gates.teeth("openseespy_path")))


def swing_error(module, **settings):
    """Largest difference of the rotation to the spline's over 5 ms after the release [rad]."""
    options = {"start": math.pi / 2, "duration": 5e-3}
    limit = spline.release(CASE, **options, step=1e-6, integrator="leapfrog", control_points=8)
    motion = module.release(CASE, **options, **settings)
    return np.abs(np.interp(limit.time, motion.time, motion.rotation) - limit.rotation).max()


@exudyn
@pytest.mark.slow
def test_ancf_swings_as_the_spline():
    """Requirement: released, ANCF cables follow the spline."""
    gates.check("exudyn_ancf_swing", swing_error(exudyn_ancf, step=1e-5, elements=8))


@exudyn
@pytest.mark.slow
def test_ancf_swing_gate_has_teeth():
    """Requirement: the check notices half as many elements."""
    with pytest.raises(AssertionError, match="x the gate"):
        settings = {"step": 1e-5} | gates.teeth("exudyn_ancf_swing")
        gates.check("exudyn_ancf_swing", swing_error(exudyn_ancf, **settings))


@opensees
@pytest.mark.slow
def test_frame_swings_as_the_spline():
    """Requirement: released, OpenSees' frames follow the spline."""
    gates.check("openseespy_swing", swing_error(openseespy_frame, step=1e-5, elements=40))


@opensees
@pytest.mark.slow
def test_frame_swing_gate_has_teeth():
    """Requirement: the check notices a quarter of the elements."""
    with pytest.raises(AssertionError, match="x the gate"):
        settings = {"step": 1e-5} | gates.teeth("openseespy_swing")
        gates.check("openseespy_swing", swing_error(openseespy_frame, **settings))


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


def test_study_runs_without_other_codes(monkeypatch):
    """Requirement: with no other code there are splines, a row for each absent code, and no ratio to it."""
    import pandas as pd

    for module in (exudyn_ancf, exudyn_exact, openseespy_frame):
        monkeypatch.setattr(module, "installed", lambda: False)
    for name in ("REPEAT", "PASSES"):
        monkeypatch.setattr(compared, name, 1)
    limits, theories = path_limits(CASE)
    rows, times = compared.compared_paths(CASE, limits)
    assert [row["what"] for row in theories] == ["uncertainty", "uncertainty", "difference of the theories"]
    assert {row["status"] for row in rows} == {"converged", "not installed"}
    found = peers._ratios(pd.DataFrame(rows), pd.DataFrame(times), "worst", [1e-3])
    assert set(found.dropna(subset="ratio")["group"]) <= {compared.ELEMENTS, compared.SURROGATE}
    assert (found["spline_s"] > 0.0).all()


def test_failed_variant_keeps_its_row():
    """Requirement: a setting that fails is a row with the reason and without errors."""

    def fails(variant):
        raise BaselineFailed("stopped at 0.1 rad")

    rows, times = tried(compared.STATIC[:1], fails, ["worst"], judged="worst", repeat=1)
    assert (rows[0]["status"], rows[0]["reason"]) == ("failed", "stopped at 0.1 rad")
    assert math.isnan(rows[0]["worst"])
    assert times == []


def test_ratios_compare_at_equal_error():
    """Requirement: the fastest within the level counts, on both sides; luck with one step does not keep."""
    import pandas as pd

    rows = pd.DataFrame(
        [
            ("spline", "spline", "n=5", 1e-2, 1.0),
            ("spline", "spline", "n=6", 1e-4, 1.0),
            ("exudyn ancf", "Exudyn", "elements=4 step=2", 1e-5, 2.0),
            ("exudyn ancf", "Exudyn", "elements=4 step=1", 1e-3, 1.0),
        ],
        columns=["model", "group", "variant", "error", "step_s"],
    ).assign(status="converged", fineness=lambda rows: -rows["step_s"])
    times = rows[["model", "variant"]].assign(
        solve_s=[1.0, 2.0, 30.0, 40.0], low_s=0.5, high_s=[1.5, 2.5, 35.0, 45.0]
    )
    reached = peers._ratios(rows, times, "error", [1e-4]).set_index("group")["ratio"]
    assert reached.to_dict() == {"Exudyn": 15.0}
    assert peers._ratios(rows, times, "error", [1e-6])["ratio"].isna().all()
    doubtful = rows.assign(unsure=6e-5)
    assert peers._ratios(doubtful, times, "error", [1e-4], unsure="unsure")["ratio"].isna().all()
    steady = peers._ratios(kept(rows, "error"), times, "error", [1e-4, 1e-3]).set_index(["level", "group"])[
        "ratio"
    ]
    assert math.isnan(steady[1e-4, "Exudyn"])
    assert steady[1e-3, "Exudyn"] == 15.0


def test_own_elements_stand_beside_the_codes():
    """Requirement: the suite's elements have the interface of a baseline and tend to the spline's path."""
    coarse, fine = (against_spline(elements, elements=count) for count in (5, 20))
    assert fine < 0.1 * coarse < 0.01


def test_times_are_medians_with_quartiles():
    """Requirement: a time is the median of its runs, with the quartiles and their number."""
    assert spread([5.0, 1.0, 2.0, 3.0, 4.0]) == {"solve_s": 3.0, "low_s": 2.0, "high_s": 4.0, "runs": 5}
