"""The energy-consistent step: exact change of energy, and a consistent tangent."""

import numpy as np
import pytest

from spline_model.compile import compile_scene
from spline_model.integrators.motion import set_in_motion
from spline_model.kernels.energy import axial_strains, strain_energy
from spline_model.kernels.energy_step import assemble_step
from spline_model.pivot import cross_axis_pivot
from tests import gates
from tests.table_one import TABLE_ONE

FORMS = {
    "mixed": {},
    "B-spline": {"basis": "bspline", "control_points": 8},
    "consistent": {"stretch": "consistent", "control_points": 4},
    "spatial consistent": {"stretch": "consistent", "measure": "spatial", "control_points": 5},
}


class Step:
    """One step between two crooked states of Table 1, without its inertia."""

    def __init__(self, settings):
        self.system = compile_scene(cross_axis_pivot(**(TABLE_ONE | settings)).released())
        self.motion = set_in_motion(self.system)
        self.count = len(self.motion.mass)
        self.unit, self.energy = self.motion.unit, self.motion.energy
        generator = np.random.default_rng(3)
        size = self.system.layout.size
        self.y0, self.y1 = (
            self.system.rest / self.unit + generator.uniform(-0.03, 0.03, size) for _ in range(2)
        )

    def evaluate(self, y1, h=1e-4):
        """Dimensionless residual and tangent of the step."""
        z0, z1 = self.y0 * self.unit, y1 * self.unit
        size = len(z1)
        gradient, hessian = np.empty(size), np.empty((size, size))
        delta, v0 = (z1 - z0)[: self.count], np.zeros(self.count)
        active = np.zeros(0, dtype=np.int64)
        assemble_step(z0, z1, delta, v0, 0.0, h, active, self.motion, gradient, hessian)
        scale = self.unit / self.energy
        return gradient * scale, hessian * scale[:, None] * self.unit

    def strain_energy(self, y):
        """Strain energy in EI/L."""
        strains = np.empty(len(self.motion.rigidity))
        tables, rigidity = self.motion.tables, self.motion.rigidity
        return strain_energy(y * self.unit, tables, rigidity, self.count, strains) / self.energy

    def mean_axial_forces(self):
        """The axial forces that satisfy their rows of the step."""
        strains = np.empty((2, len(self.motion.rigidity)))
        for y, row in zip((self.y0, self.y1), strains, strict=True):
            axial_strains(y * self.unit, self.motion.tables.axial_force, self.count, row)
        return self.motion.rigidity @ strains.mean(axis=0)


def energy_identity(form):
    """Error of D V . (q1 - q0) against V1 - V0, over V1 + V0."""
    step = Step(FORMS[form])
    y1 = step.y1.copy()
    axial = slice(step.count, step.system.layout.multiplier_start)
    y1[axial] = step.mean_axial_forces() / step.unit[axial]
    y1[step.system.layout.multiplier_start :] = 0.0
    forces = step.evaluate(y1, h=1e6)[0][: step.count]  # at a huge h the inertia is below round-off
    work = forces @ (y1 - step.y0)[: step.count]
    before, after = step.strain_energy(step.y0), step.strain_energy(y1)
    return abs(work - (after - before)) / (before + after)


def tangent_error(form, h):
    """Largest error of a column of the tangent against a fourth-order difference, over its largest entry."""
    step = Step(FORMS[form])
    tangent, errors = step.evaluate(step.y1, h)[1], []
    for i in range(len(step.y1)):
        e = np.zeros(len(step.y1))
        e[i] = 2e-4
        f = [step.evaluate(step.y1 + k * e, h)[0] for k in (-2, -1, 1, 2)]
        column = (8 * (f[2] - f[1]) - f[3] + f[0]) / (12 * 2e-4)
        errors.append(np.abs(column - tangent[:, i]).max() / np.abs(tangent[:, i]).max())
    return max(errors)


@pytest.mark.parametrize("form", FORMS)
def test_discrete_gradient_gives_the_exact_change_of_energy(form):
    """Requirement: D V . dq is the change of energy over a step of any size."""
    gates.check("spline_discrete_gradient", energy_identity(form) + np.finfo(float).tiny)


@pytest.mark.parametrize("form", FORMS)
def test_step_tangent_is_consistent(form):
    """Requirement: the tangent of the step is the derivative of its residual."""
    gates.check("spline_step_tangent", tangent_error(form, h=1e-4))
    gates.check("spline_step_tangent", tangent_error(form, h=1e6))


def test_discrete_gradient_gate_has_teeth():
    """Requirement: the plain gradient at the end of the step does not give the change of energy."""
    step = Step(FORMS["mixed"])
    end = Step(FORMS["mixed"])
    end.y0 = end.y1.copy()
    end.y1[step.system.layout.multiplier_start :] = 0.0
    axial = slice(step.count, step.system.layout.multiplier_start)
    end.y1[axial] = end.mean_axial_forces() / end.unit[axial]
    work = end.evaluate(end.y1, h=1e6)[0][: step.count] @ (step.y1 - step.y0)[: step.count]
    before, after = step.strain_energy(step.y0), step.strain_energy(step.y1)
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check("spline_discrete_gradient", abs(work - (after - before)) / (before + after))
