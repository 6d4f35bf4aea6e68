"""Forces against energies and tangents against forces, by differences at large, folded states."""

from collections.abc import Callable

import numpy as np
import pytest

from fe_reference import ELEMENTS
from fe_reference.law import FORCES, TANGENT, elements
from fe_reference.model import rotation_matrix
from fe_reference.structure import Structure, structure_of
from tests.fe.cases import FORCE, LENGTH, pivot
from tests.gates import hold

#: Sixth-order central difference of a first derivative, offsets 1 to 3.
WEIGHTS = (3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0)


def far_state(structure: Structure) -> np.ndarray:
    """Return coordinates far from rest: body turned by 250 degrees, nodes scattered."""
    generator = np.random.default_rng(7)
    y = np.zeros(structure.size)
    fraction = np.tile(np.arange(1, structure.stations - 1) / (structure.stations - 1.0), structure.strips)
    y[2:-3:3] = fraction * 4.4 + 0.2 * generator.standard_normal(len(fraction))
    y[0:-3:3] = 0.2 * LENGTH / structure.stations * generator.standard_normal(len(fraction))
    y[1:-3:3] = 0.2 * LENGTH / structure.stations * generator.standard_normal(len(fraction))
    y[-3:] = 0.3 * LENGTH, -0.2 * LENGTH, 4.4
    return y


def derivative(function: Callable[[np.ndarray], np.ndarray], y: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Return d f / d y of shape (..., size) by sixth-order differences with a step for every coordinate."""
    columns = []
    for j, h in enumerate(step):
        unit = np.eye(len(y))[j] * h
        columns.append(
            sum(
                w / h * (function(y + k * unit) - function(y - k * unit))
                for k, w in enumerate(WEIGHTS, start=1)
            )
        )
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("about", ["centre", "other point"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_force_is_the_gradient_of_the_energy(element: str, about: str) -> None:
    """The reduced force, master-slave map included, is the gradient of the energy."""
    model = pivot(elements=4, element=element, crossing_ratio=0.4)
    structure = Structure(model, None if about == "centre" else np.array([0.01, 0.09]))
    y = far_state(structure)

    def error(step: float = 1e-3) -> float:
        size = np.where(structure.scale == structure.force_unit, LENGTH, 1.0)
        slope = derivative(lambda z: np.array(sum(structure.evaluate(z).strain)), y, step * size)
        force = structure.evaluate(y).gradient
        return float(np.abs((slope - force) * size).max() / np.abs(force * size).max())

    hold("fe_force_is_gradient", error)


@pytest.mark.parametrize("about", ["centre", "other point"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_is_the_derivative_of_the_force(element: str, about: str) -> None:
    """The reduced tangent, with the curvature of the map, is the derivative of the reduced force."""
    model = pivot(elements=4, element=element, crossing_ratio=0.4)
    structure = Structure(model, None if about == "centre" else np.array([0.01, 0.09]))
    y = far_state(structure)

    def error(step: float = 1e-3) -> float:
        size = np.where(structure.scale == structure.force_unit, LENGTH, 1.0)
        slope = derivative(lambda z: structure.evaluate(z).gradient, y, step * size) * size * size[:, None]
        tangent = structure.evaluate(y).tangent.sparse().toarray() * size * size[:, None]
        return float(np.abs(slope - tangent).max() / np.abs(tangent).max())

    hold("fe_tangent_is_derivative", error)


def test_curvature_of_the_reduction_matters() -> None:
    """Without the curvature of the master-slave map the tangent would be visibly wrong here."""
    structure = structure_of(pivot(elements=4, crossing_ratio=0.4))
    y = far_state(structure)
    with_it = structure.evaluate(y).tangent.sparse()
    without = structure.reduced_matrix(structure.element_matrices(y, TANGENT), y).sparse()
    gap = (with_it - without).toarray()
    assert np.count_nonzero(gap) == 1
    assert abs(gap[-1, -1]) > FORCE * LENGTH


@pytest.mark.parametrize("element", ELEMENTS)
def test_rigid_motion_costs_nothing(element: str) -> None:
    """Turned by three turns and a half and moved as a whole, a strip holds no force."""
    structure = structure_of(pivot(elements=3, element=element))

    def error(turn: float = 7.0 * np.pi, stretch: float = 0.0) -> float:
        rest = np.concatenate([strip.nodes for strip in structure.model.strips])
        field, many = np.full((len(rest), 3), turn), len(structure.numbers)
        field[:, :2] = (1.0 + stretch) * rest @ rotation_matrix(turn).T - rest + 0.3 * LENGTH
        force, ends, none = np.empty_like(field), np.empty((many, 5)), np.empty((0, 6, 6))
        elements(structure.given, 1.0, FORCES, field, (force, ends, none, np.empty((4, 4))))
        return float(np.abs(ends[:, :4]).max() / FORCE)

    hold("fe_rigid_motion", error)
