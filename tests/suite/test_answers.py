"""Measures and derived quantities agree with what they stand for on cases that can be worked out by hand."""

import dataclasses
import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from studies.answers.adapters import answer_static
from studies.answers.answer import centre_shift
from studies.answers.metrics import (
    extrapolate,
    observed_order,
    quasi_static_frequency,
    relative_error,
    richardson,
    trajectory_error,
)
from studies.answers.settings import FeSettings
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from tests import gates

TABLE_1 = named_case("cross_axis_pivot")


def test_trajectory_error_relates_to_the_travel():
    """A path 3 and 4 mm off one that travels 50 mm is off by 10 %."""
    reference = np.array([[0.0, 0.0], [0.02, 0.0], [0.05, 0.0]])
    path = reference + np.array([[0.0, 0.0], [0.003, 0.004], [0.0, 0.005]])
    assert trajectory_error(path, reference) == pytest.approx([0.0, 0.1, 0.1], rel=1e-12)
    assert trajectory_error(path[:2], reference) == pytest.approx([0.0, 0.1], rel=1e-12)
    with pytest.raises(ValueError, match="got no displacement"):
        trajectory_error(path, reference[:1])


def test_relative_error_is_signed_and_counts_an_unloaded_state_as_none():
    """Errors keep their sign, also against negative references; 0 against 0 is no error."""
    error = relative_error(np.array([1e-12, 1.1, -1.9]), np.array([1e-17, 1.0, -2.0, 5.0]))
    assert error == pytest.approx([0.0, 0.1, 0.05], rel=1e-12)


def test_order_and_limit_of_a_known_sequence():
    """f(h) = 1 + 3 h^2 + 5 h^4 is of order 2; elimination finds its limit and what is uncertain."""
    levels = [np.array([1.0 + 3.0 * h**2 + 5.0 * h**4]) for h in (0.1, 0.05, 0.025)]
    errors = [float(level[0]) - 1.0 for level in levels]
    assert observed_order(errors[-2], errors[-1]) == pytest.approx(2.0, abs=0.01)
    assert richardson(levels[1], levels[2], order=2.0) == pytest.approx(1.0, abs=1e-5)
    limit = extrapolate(levels)
    assert limit.value == pytest.approx(1.0, abs=1e-14)
    assert limit.uncertainty == pytest.approx(4.0 * 5.0 * 0.05**4, rel=1e-6)
    with_four = extrapolate([np.array([1.0 + 3.0 * 0.2**2 + 5.0 * 0.2**4]), *levels])
    assert with_four.uncertainty == pytest.approx(0.0, abs=1e-14)
    assert math.isnan(observed_order(0.0, 1.0))
    with pytest.raises(ValueError, match="got 2, expected at least 3"):
        extrapolate(levels[:2])


def test_a_hinge_at_the_crossing_has_no_centre_shift():
    """Turning about the crossing point shifts nothing; moving as well shifts by that much."""
    rotation = np.linspace(0.0, 2.0, 5)
    crossing = np.array(TABLE_1.crossing_point)
    arm = np.exp(1j * rotation) * (0.01 + 0.03j)
    turned = np.stack((arm.real, arm.imag), axis=-1)
    moved = np.outer(rotation, [0.002, -0.001])
    assert centre_shift(crossing, rotation, crossing + turned) == pytest.approx(0.0, abs=1e-16)
    assert centre_shift(crossing, rotation, crossing + turned + moved) == pytest.approx(moved, abs=1e-16)


def test_extreme_fibre_strain_is_the_larger_of_the_two_fibres():
    """Axial and bending strain add up on one side whatever their signs."""
    axial = np.array([100.0, -100.0, 0.0])
    moment = np.array([2.0, 2.0, -2.0])
    stretch = 100.0 / (TABLE_1.youngs_modulus * TABLE_1.area)
    bend = 2.0 * TABLE_1.depth / (2.0 * TABLE_1.youngs_modulus * TABLE_1.second_moment_of_area)
    assert TABLE_1.extreme_fibre_strain(axial, moment) == pytest.approx(
        [bend + stretch, bend + stretch, bend]
    )
    assert TABLE_1.depth == pytest.approx(5e-3, rel=1e-3)
    rod = of_moments(TABLE_1.area, TABLE_1.second_moment_of_area)
    assert dataclasses.replace(TABLE_1, outer_fibre=0.002, **rod).depth == 0.004


def test_largest_stress_is_that_of_all_strips_and_sections():
    """The largest stress of a state is found wherever it stands: any strip, any section."""
    answer = answer_static(dataclasses.replace(TABLE_1, rotation=0.1, increments=2), FeSettings(elements=2))
    stress = np.ones_like(answer.stress)
    stress[1, 0, 2], stress[2, 1, 0] = 3.0, 5.0
    pulled = {"axial_force": TABLE_1.area * stress, "bending_moment": np.zeros_like(stress)}
    assert dataclasses.replace(answer, solution=SimpleNamespace(**pulled)).max_stress == pytest.approx(
        [1.0, 3.0, 5.0]
    )


def test_fingerprint_follows_values_not_layout(case, table_1):
    """Comments leave the fingerprint of a problem as it is; a changed value changes it."""
    from studies.cases.design import fingerprint

    assert fingerprint(named_case(case(("# Table 1: 206 GPa", "")))) == fingerprint(TABLE_1)
    assert fingerprint(named_case(case(("206e9", "207e9")))) != fingerprint(TABLE_1)


def implied(cubic, amplitude, states=21):
    """Relative error of the frequency that statics imply of U = k a^2/2 + c a^4/4, against its motion."""
    mass, inertia, arm, stiffness = 0.2, 2e-3, 0.03, 500.0
    rotation = np.linspace(0.0, amplitude, states)
    centre = arm * np.stack((np.cos(rotation), np.sin(rotation)), axis=1)
    energy = 0.5 * stiffness * rotation**2 + 0.25 * cubic * rotation**4
    whole = inertia + mass * arm**2

    def quarter(_, state):
        return state[0]

    quarter.terminal = True  # type: ignore[attr-defined]
    motion = solve_ivp(
        lambda _, s: [s[1], -(stiffness * s[0] + cubic * s[0] ** 3) / whole],
        (0.0, 1.0),
        [amplitude, 0.0],
        events=quarter,
        rtol=1e-11,
        atol=1e-12,
    )
    found = quasi_static_frequency(rotation, centre, energy, mass=mass, moment_of_inertia=inertia)
    return abs(found * 4.0 * motion.t_events[0][0] - 1.0)


@pytest.mark.parametrize(("cubic", "amplitude"), [(0.0, 0.5), (0.0, -1.5), (40.0, 1.2)])
def test_statics_alone_implies_the_frequency_of_an_oscillator(cubic, amplitude):
    """Of an energy of second and fourth order the frequency is that of the integrated equation of motion."""
    gates.check("quasi_static_frequency", implied(cubic, amplitude))
    if cubic:
        gates.refuse("quasi_static_frequency", partial(implied, cubic, amplitude))
