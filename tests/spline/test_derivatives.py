"""Gradient against energy and Hessian against gradient, for every operator, at crooked states."""

import numpy as np
import pytest

from spline_model import DEFAULT_EFFECTS, cross_axis_pivot
from spline_model.bordered import evaluate
from spline_model.compile import compile_scene
from spline_model.quadrature import CURVATURE, STRAIN
from tests import gates
from tests.table_one import SIX

FORMS = {
    "material mixed": {},
    "inextensible": {"stretch": "inextensible"},
    "material consistent": {"stretch": "consistent"},
    "spatial consistent": {"stretch": "consistent", "measure": "spatial"},
    "published": {"stretch": "consistent", "measure": "published"},
    "segments": {"segments": 2, "control_points": 5, "axial_modes": 2},
    "curling": {
        "effects": (*DEFAULT_EFFECTS, "clamped_width", "anticlastic"),
        "width": 0.04,
        "thickness": 0.001,
        "area": 4e-5,
        "second_moment_of_area": 4e-11 / 12.0,
    },
}


class Operator:
    """The assembled operator in dimensionless unknowns around a crooked state."""

    def __init__(self, settings):
        pivot = cross_axis_pivot(**(SIX | settings))
        system, generator = compile_scene(pivot.driven(0.8)), np.random.default_rng(7)
        points = system.points._replace(numbers=system.points.numbers.copy())
        points.numbers[:, [CURVATURE, STRAIN]] = 20.0, 0.01  # of strips that were bent and longer
        self.system = system.with_tables(points=points)
        self.unit, self.energy_unit = self.system.scales.unit, self.system.scales.energy
        noise = generator.uniform(-0.03, 0.03, self.system.layout.size)
        noise[self.system.layout.coordinate_count :] *= 30
        self.y = self.system.rest / self.unit + noise

    def evaluate(self, y):
        """Energy, gradient and Hessian in units of EI/L."""
        gradient, hessian = np.empty(len(y)), np.empty((len(y), len(y)))
        energies = evaluate(self.system, y * self.unit, 1.0, gradient, hessian)
        scale = self.unit / self.energy_unit
        return sum(energies) / self.energy_unit, gradient * scale, hessian * scale[:, None] * self.unit


def fourth_order(function, y, i, step):
    """Fourth-order central difference of a function in its i-th variable."""
    e = np.zeros(len(y))
    e[i] = step
    return (8 * (function(y + e) - function(y - e)) - function(y + 2 * e) + function(y - 2 * e)) / (12 * step)


def hessian_error(step=1e-4, **settings):
    """Largest error of a column of the Hessian, over the largest entry of that column."""
    operator = Operator(settings)
    hessian = operator.evaluate(operator.y)[2]
    columns = [
        fourth_order(lambda y: operator.evaluate(y)[1], operator.y, i, step) for i in range(len(operator.y))
    ]
    return max(
        np.abs(column - hessian[:, i]).max() / np.abs(hessian[:, i]).max() for i, column in enumerate(columns)
    )


def gradient_error(step=2e-4, **settings):
    """Largest error of the gradient's rows without multipliers, over its largest entry."""
    operator = Operator(settings)
    operator.y[operator.system.layout.multiplier_start :] = 0.0  # psi is no part of the energy
    gradient, rows = operator.evaluate(operator.y)[1], operator.system.layout.coordinate_count
    found = [fourth_order(lambda y: operator.evaluate(y)[0], operator.y, i, step) for i in range(rows)]
    return np.abs(np.array(found) - gradient[:rows]).max() / np.abs(gradient[:rows]).max()


@pytest.mark.parametrize("form", FORMS)
def test_hessian_is_the_gradients_derivative(form):
    """Requirement: the tangent of every operator is consistent, also of the printed forces."""
    gates.hold("spline_hessian", lambda **coarse: hessian_error(**FORMS[form] | coarse))


@pytest.mark.parametrize("form", [form for form in FORMS if form != "published"])
def test_gradient_is_the_energys_derivative(form):
    """Requirement: the forces of every energy are its exact gradient, the printed ones are not."""
    gates.check("spline_gradient", gradient_error(**FORMS[form]))
    gates.refuse("spline_gradient", gradient_error)
