"""Linear modes against the roots of the beam's characteristic equations."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from spline_model.bordered import evaluate
from spline_model.compile import compile_scene
from spline_model.effects.registry import DEFAULT_EFFECTS
from spline_model.errors import InvalidParameter
from spline_model.modes import linear_modes, natural_frequencies
from spline_model.pivot import cross_axis_pivot
from tests import gates
from tests.spline.scenes import LENGTH, RIGIDITY, swinging
from tests.table_one import SIX, TABLE_ONE


def roots(equation, count):
    """First positive roots of an equation in z = beta L."""
    grid = np.linspace(0.05, 3.2 * count, 400 * count)
    values = [equation(z) for z in grid]
    found = [
        brentq(equation, a, b, xtol=1e-14)
        for a, b, fa, fb in zip(grid, grid[1:], values, values[1:], strict=False)
        if fa * fb < 0
    ]
    return np.array(found[:count])


def cantilever_equation(z):
    """Clamped-free beam, over cosh: 1/cosh + cos."""
    return 1 / math.cosh(z) + math.cos(z)


def end_body_equation(mass, inertia):
    """Cantilever with a tip mass [mu L] and a tip inertia [mu L^3]."""

    def equation(z):
        c, s, ch, sh = math.cos(z), math.sin(z), math.cosh(z), math.sinh(z)
        return (
            1
            + c * ch
            + mass * z * (c * sh - s * ch)
            - inertia * z**3 * (c * sh + s * ch)
            + mass * inertia * z**4 * (1 - c * ch)
        ) / ch

    return equation


def frequencies(scene, count):
    """First circular frequencies in sqrt(EI/mu)/L^2."""
    system = compile_scene(scene)
    squares = linear_modes(system, system.rest, system.mass)[0]
    return np.sqrt(squares[:count] / RIGIDITY) * LENGTH**2


def cantilever_error(control_points):
    """Largest relative error of the first four cantilever frequencies."""
    exact = roots(cantilever_equation, 4) ** 2
    return np.abs(frequencies(swinging(control_points=control_points), 4) / exact - 1).max()


def end_body_error(control_points):
    """Largest relative error of the first three frequencies with a heavy and with an extended end body."""
    errors = []
    for mass, inertia in ((1.0, 1e-9), (1.0, 0.1), (0.2, 0.5)):
        scene = swinging(control_points=control_points, tip_mass=mass, tip_inertia=inertia)
        exact = roots(end_body_equation(mass, inertia), 3) ** 2
        errors.append(np.abs(frequencies(scene, 3) / exact - 1).max())
    return max(errors)


CHECKS = {"spline_cantilever_frequencies": cantilever_error, "spline_end_body_frequencies": end_body_error}


@pytest.mark.parametrize("gate", CHECKS)
def test_frequencies_are_the_characteristic_roots(gate):
    """Requirement: cantilever and end-body frequencies are those of the Euler-Bernoulli beam."""
    gates.check(gate, CHECKS[gate](control_points=14))


@pytest.mark.parametrize("gate", CHECKS)
def test_frequency_gates_have_teeth(gate):
    """Requirement: the same checks fail with fewer control points."""
    with pytest.raises(AssertionError, match="x the gate"):
        gates.check(gate, CHECKS[gate](**gates.teeth(gate)))


def test_published_roots():
    """Requirement: the equations themselves have the published roots."""
    assert np.abs(roots(cantilever_equation, 2) - (1.8751040687, 4.6940911330)).max() < 1e-10
    assert abs(roots(end_body_equation(1.0, 1e-12), 1)[0] - 1.24792) < 5e-6
    assert abs(roots(end_body_equation(1.0, 0.1), 1)[0] - 1.19567) < 5e-6


def test_modes_about_a_bent_state():
    """Requirement: held or released, about rest and about 90 deg, modes come sorted and with shapes."""
    pivot = cross_axis_pivot(**SIX)
    rest, bent = natural_frequencies(pivot), natural_frequencies(pivot, rotation=math.pi / 2)
    held = natural_frequencies(pivot, rotation=math.pi / 2, held=True)
    for modes in (rest, bent, held):
        assert (np.diff(modes.frequency) >= 0).all()
        assert modes.shapes.shape == (len(modes.frequency), 2, 61, 2)
        assert modes.body_shapes.shape == (len(modes.frequency), 3)
    assert 70 < rest.frequency[0] < 80
    assert held.frequency[0] > 5 * bent.frequency[0]  # without the swing only the strips vibrate
    assert np.abs(held.body_shapes[:, 2]).max() < 1e-9 * np.abs(bent.body_shapes[:, 2]).max()


def under_constraints(pivot, state):
    """All frequencies about a state from the paper's bordered tangent, with multipliers [Hz]."""
    system = compile_scene(pivot.released())
    unit, count = system.scales.unit, system.layout.coordinate_count
    gradient, tangent, inertia = np.empty(len(state)), *np.zeros((2, len(state), len(state)))
    evaluate(system, state, 0.0, gradient, tangent)
    inertia[:count, :count] = system.mass
    scale = unit[:, None] * unit
    squares = np.linalg.eigvals(np.linalg.solve(scale * tangent, scale * inertia)).real  # 1 / w^2, or 0
    return 1.0 / np.sqrt(squares[squares > 1e-12 * squares.max()]) / (2.0 * np.pi)


@pytest.mark.parametrize(
    "keywords",
    [
        {},
        {"stretch": "inextensible"},
        {"measure": "spatial", "effects": (*DEFAULT_EFFECTS, "gravity", "section_rotary_inertia")},
        {"basis": "bspline", "control_points": 7, "stretch": "consistent"},
    ],
)
def test_modes_of_elements_are_those_under_constraints(keywords):
    """Requirement: clamps that hold by construction or as constraints give the same modes to 1e-9."""
    pivot = cross_axis_pivot(**SIX | keywords)
    found = natural_frequencies(pivot, rotation=0.7, count=6)
    other = under_constraints(pivot, found.state)
    for frequency in (*found.frequency, *found.slide_frequency):
        assert np.abs(other / frequency - 1.0).min() < 1e-9


def test_slide_modes_are_named_not_counted():
    """Requirement: the control points' sliding appears apart from the pivot's own modes."""
    with_slide = natural_frequencies(cross_axis_pivot(**TABLE_ONE, control_points=8), count=5)
    without = natural_frequencies(cross_axis_pivot(**TABLE_ONE, control_points=8, axial_modes=7), count=5)
    assert len(with_slide.slide_frequency) == 2
    assert len(without.slide_frequency) == 0
    # at rest sliding and bending do not couple: the bending modes are the same to round-off
    assert np.abs(with_slide.frequency / without.frequency - 1).max() < 1e-7


def test_no_modes_asked_for_is_refused():
    """Requirement: a count below one is refused."""
    with pytest.raises(InvalidParameter, match="count: got 0"):
        natural_frequencies(cross_axis_pivot(**SIX), count=0)
