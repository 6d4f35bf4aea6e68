"""The energy-consistent step: exact change of energy, and a consistent tangent."""

import numpy as np
import pytest

from spline_model.pivot import cross_axis_pivot
from spline_model.strip.laws import MATERIAL, stretching_law
from spline_model.strip.two_states import stretching_between
from tests import gates
from tests.spline.steps import Step
from tests.table_one import SIX

FORMS = {
    "mixed": {},
    "slender": {"area": 5e-3},
    "inextensible": {"stretch": "inextensible"},
    "B-spline": {"basis": "bspline", "control_points": 8},
    "consistent": {"stretch": "consistent", "control_points": 4},
    "roots": {
        "width": 0.01,
        "thickness": 0.005,
        "effects": ("bending", "stretching", "strip_inertia", "body_inertia", "root_compliance"),
        "parameters": {"root_compliance": {"root": "monolithic"}},
    },
}


def step_of(form):
    """A step of Table 1."""
    return Step(cross_axis_pivot(**(SIX | FORMS[form])).released())


def energy_identity(form, at_the_end=False):
    """Error of DV . (q1 - q0) against V1 - V0, over V1 + V0; at_the_end: of the plain gradient there."""
    step, still = step_of(form), 1e6  # at a huge step the inertia is below round-off
    y1 = step.after()
    before, after = (step.strain_energy(y) for y in (step.state.y.copy(), y1))
    dy = step.dy.copy()
    if at_the_end:
        step.state.y[:], dy = y1, np.zeros_like(dy)
        step.strain_energy(y1)
    dy[step.axial] = 0.0
    if step.axial.size:
        with np.errstate(divide="ignore"):
            rigidity = np.nan_to_num(1.0 / step.model.strips.compliance.ravel(), posinf=0.0)
        dy[step.axial] = rigidity * step.residual(dy, still)[step.axial]
    forces = np.delete(step.residual(dy, still), step.axial)
    work = forces @ np.delete(step.dy, step.axial)
    return abs(work - (after - before)) / (before + after)


@pytest.mark.parametrize("form", FORMS)
def test_discrete_gradient_gives_the_exact_change_of_energy(form):
    """Requirement: D V . dq is the change of energy over a step of any size."""
    gates.check("spline_discrete_gradient", energy_identity(form) + np.finfo(float).tiny)


@pytest.mark.parametrize("form", FORMS)
def test_step_tangent_is_consistent(form):
    """Requirement: Newton's correction of the step is by the derivative of its residual."""
    step = step_of(form)
    for h in (1e-4, 1e-4, 1e-2, 1e6):
        gates.check("spline_step_tangent", step.tangent_error(h))


def test_discrete_gradient_gate_has_teeth():
    """Requirement: the plain gradient at the end of the step does not give the change of energy."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_discrete_gradient", energy_identity("mixed", at_the_end=True))


def test_force_of_stretching_does_the_work_of_its_energy():
    """Between two states the force does the change of energy, natural strain among it."""
    force_of, law = (getattr(each, "py_func", each) for each in (stretching_between, stretching_law))
    v0, v1, given = 1.03, 0.98, (1.01, 0.02, 7.0)
    force = force_of(v0, v1, *given, 0.0)[0]
    energies = [law(v, *given, MATERIAL)[0] for v in (v0, v1)]
    assert force * (v1 - v0) == pytest.approx(energies[1] - energies[0], rel=1e-13)
