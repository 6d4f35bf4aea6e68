"""The study of the error estimate: its designs, and the complete set of them against the true errors."""

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.settings import SplineSettings
from studies.cases.problem import named_case
from studies.convergence import error_estimate
from studies.record.store import Store
from tests import gates


def test_the_stress_has_an_estimate_of_its_own():
    """The estimate of the largest stress is not below its error; half a dozen points by curvature are."""
    case = named_case("titanium_pivot")
    exact = answer_static(case, SplineSettings(control_points=16)).max_stress
    estimate = answer_static(case, SplineSettings()).estimate["stress"]

    def optimism(**grid):
        stress = answer_static(case, SplineSettings(**grid)).max_stress
        return np.abs(stress - exact).max() / exact.max() / estimate

    gates.hold("spline_stress_accuracy_optimism", optimism)


def test_estimates_of_all_designs_are_within_their_band():
    """Over 36 designs and six accuracies, and some swings: 0.3 to 10 for 90 %, none below a third."""
    tables = Store().load_tables("convergence/error_estimate")
    rows = tables["estimates"]
    assert rows[rows["problem"] == "statics"]["design"].nunique() >= 30
    least = rows["accuracy"] == rows["accuracy"].min()  # stresses may end at round-off there
    assert (rows.loc[~least, "status"] == "converged").all()
    assert (rows.loc[least, "status"] == "converged").mean() > 0.9
    counted = {name: each for name, each in rows[rows["counts"]].groupby("problem")}
    for problem, every in counted.items():
        assert every["effectivity"].between(*error_estimate.BAND).mean() >= error_estimate.SHARE, problem
    statics, motion, stress = counted["statics"], counted["motion"], tables["stress"].query("counts")
    # the points are chosen for the stiffness of the body too, so that estimates of stress are cautious
    assert stress["effectivity"].min() >= error_estimate.BAND[0]
    assert (stress["true_error"] <= stress["accuracy"]).all()
    gates.check("spline_stress_accuracy_optimism", (1.0 / stress["effectivity"]).max())
    gates.check("spline_accuracy_request", (statics["true_error"] / statics["accuracy"]).max())
    gates.check("spline_accuracy_effectivity", np.log(statics["effectivity"]).abs().max())
    gates.check("spline_motion_accuracy_request", (motion["true_error"] / motion["accuracy"]).max())
    gates.check("spline_motion_accuracy_optimism", (1.0 / motion["effectivity"]).max())
