"""Measures and derived quantities of cases that can be worked out by hand; frequencies of swings."""

import dataclasses
import json
import math
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from studies.answers import metrics
from studies.answers.adapters import answer_modes, answer_release, answer_static
from studies.answers.answer import centre_shift
from studies.answers.motion import signal_modes
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from studies.cases.problem import named_case
from studies.cases.section import of_moments
from tests import gates
from tests.suite.refused import FINDS

TABLE_1 = named_case("cross_axis_pivot")


def test_trajectory_error_relates_to_the_travel():
    """A path 3 and 4 mm off one that travels 50 mm is off by 10 %."""
    reference = np.array([[0.0, 0.0], [0.02, 0.0], [0.05, 0.0]])
    path = reference + np.array([[0.0, 0.0], [0.003, 0.004], [0.0, 0.005]])
    assert metrics.trajectory_error(path, reference) == pytest.approx([0.0, 0.1, 0.1], rel=1e-12)
    assert metrics.trajectory_error(path[:2], reference) == pytest.approx([0.0, 0.1], rel=1e-12)
    with pytest.raises(ValueError, match="got no displacement"):
        metrics.trajectory_error(path, reference[:1])


def test_relative_error_is_signed_and_counts_an_unloaded_state_as_none():
    """Errors keep their sign, also against negative references; 0 against 0 is no error."""
    error = metrics.relative_error(np.array([1e-12, 1.1, -1.9]), np.array([1e-17, 1.0, -2.0, 5.0]))
    assert error == pytest.approx([0.0, 0.1, 0.05], rel=1e-12)


def test_order_and_limit_of_a_known_sequence():
    """f(h) = 1 + 3 h^2 + 5 h^4 is of order 2; elimination finds its limit and what is uncertain."""
    levels = [np.array([1.0 + 3.0 * h**2 + 5.0 * h**4]) for h in (0.1, 0.05, 0.025)]
    errors = [float(level[0]) - 1.0 for level in levels]
    assert metrics.observed_order(errors[-2], errors[-1]) == pytest.approx(2.0, abs=0.01)
    assert metrics.richardson(levels[1], levels[2], order=2.0) == pytest.approx(1.0, abs=1e-5)
    limit = metrics.extrapolate(levels)
    assert limit.value == pytest.approx(1.0, abs=1e-14)
    assert limit.uncertainty == pytest.approx(4.0 * 5.0 * 0.05**4, rel=1e-6)
    with_four = metrics.extrapolate([np.array([1.0 + 3.0 * 0.2**2 + 5.0 * 0.2**4]), *levels])
    assert with_four.uncertainty == pytest.approx(0.0, abs=1e-14)
    assert math.isnan(metrics.observed_order(0.0, 1.0))
    with pytest.raises(ValueError, match="got 2, expected at least 3"):
        metrics.extrapolate(levels[:2])


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


def test_fingerprint_follows_values_not_layout(case):
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

    def rates(_, state):
        return [state[1], -(stiffness * state[0] + cubic * state[0] ** 3) / whole]

    motion = solve_ivp(rates, (0.0, 1.0), [amplitude, 0.0], events=quarter, rtol=1e-11, atol=1e-12)
    found = metrics.quasi_static_frequency(rotation, centre, energy, mass=mass, moment_of_inertia=inertia)
    return abs(found * 4.0 * motion.t_events[0][0] - 1.0)


@pytest.mark.parametrize(("cubic", "amplitude"), [(0.0, 0.5), (0.0, -1.5), (40.0, 1.2)])
def test_statics_alone_implies_the_frequency_of_an_oscillator(cubic, amplitude):
    """Of an energy of second and fourth order the frequency is that of the integrated equation of motion."""
    gates.check("quasi_static_frequency", implied(cubic, amplitude))
    if cubic:
        gates.refuse("quasi_static_frequency", partial(implied, cubic, amplitude))


TIME = np.linspace(0.0, 0.1, 4000)


def swing(frequency=42.0, time=TIME):
    """A cosine [rad]."""
    return np.cos(2.0 * np.pi * frequency * time)


def test_frequency_of_a_known_swing():
    """Passages of a cosine are found between records, its frequency from them; less than a swing has none."""
    assert metrics.passages(TIME, swing(), 0.0)[:2] == pytest.approx([1.0 / 168.0, 3.0 / 168.0], rel=1e-8)
    assert metrics.swing_frequency(TIME, swing()).value == pytest.approx(42.0, rel=1e-8)
    short = metrics.swing_frequency(TIME[:600], swing()[:600])
    assert math.isnan(short.value)
    assert "not a whole swing" in short.reason


def test_half_a_swing_is_enough_where_it_turns_as_far_to_both_sides():
    """One swing from its turning point has two passages; a swing cut short has them too, but no frequency."""
    assert metrics.swing_frequency(TIME[:953], swing()[:953]).value == pytest.approx(42.0, rel=1e-8)
    assert math.isnan(metrics.swing_frequency(TIME[:800], 0.2 + swing()[:800]).value)


@pytest.mark.parametrize("rest", [0.3, -2.0])
def test_frequency_is_of_the_swing_about_its_rest(rest):
    """A swing about another rest than zero has the same frequency, and its rest is found."""
    found = metrics.swing_frequency(TIME, rest + swing())
    assert found.value == pytest.approx(42.0, rel=1e-6)
    assert found.rest == pytest.approx(rest, abs=1e-10)


def rippled(decay, ripple_hertz=511.0):
    """Relative error of the frequency of a swing with a ripple of a quarter of its amplitude."""
    ripple = 0.25 * np.cos(2.0 * np.pi * ripple_hertz * TIME + 1.0)
    swung = metrics.swing_frequency(TIME, np.exp(-decay * TIME) * (swing() + ripple) - 0.1)
    return abs(swung.value / 42.0 - 1.0)


@pytest.mark.parametrize("decay", [0.0, 8.0])
def test_ripples_are_not_counted(decay):
    """A ripple of twelve times the frequency leaves it as it is; one of less than five times does not."""
    gates.hold("frequency_of_ripples", partial(rippled, decay))


def test_what_stands_still_has_no_frequency():
    """A constant rotation has no frequency, and the reason says that nothing swings."""
    assert metrics.swing_frequency(TIME, np.full_like(TIME, 0.2)).reason == "nothing swings"


def cantilever(weight):
    """The shipped cantilever, with its weight or without: its second mode ripples the rotation."""
    design = named_design("cantilever_with_body")
    names = [name for name in design.effects.names if weight or name != "gravity"]
    return replace(design, effects=design.effects.renamed(names))


def difference_to_the_first_mode(settings, weight, duration, **options):
    """Relative difference of the cantilever's swing to its first mode about the rest that it swings about."""
    motion = answer_release(cantilever(weight), settings, duration=duration, **options)
    return abs(motion.frequency / answer_modes(cantilever(weight), settings, count=1).frequency[0] - 1.0)


@pytest.mark.parametrize("weight", [True, False])
@pytest.mark.parametrize(
    ("settings", "how"),
    [
        (SplineSettings(control_points=6), {"step": 5e-4}),
        pytest.param(FeSettings(elements=10), {}, marks=pytest.mark.slow),
    ],
    ids=["spline", "fe"],
)
def test_cantilever_swings_at_its_first_mode(settings, how, weight):
    """A small damped swing, no larger one, has the frequency of its first mode in spite of its ripples."""
    error = partial(difference_to_the_first_mode, settings, weight, 1.0, **how)
    gates.check("cantilever_swing_frequency", error())
    if weight and how:
        gates.refuse("cantilever_swing_frequency", error)


SECOND = np.linspace(0.0, 1.0, 2001)


def sine(frequency: float) -> np.ndarray:
    """Return a sine of a frequency [Hz] over the second."""
    return np.cos(2.0 * math.pi * frequency * SECOND)


@pytest.mark.parametrize("apart", [3.3, 40.0, 271.0])
def test_two_modes_are_told_apart(apart):
    """Frequencies are right to a percent and amplitudes to 5 %, however far they are apart."""
    first, second = signal_modes(SECOND, 7.0 + 0.4 * sine(4.0) + sine(4.0 + apart))
    assert first == pytest.approx((4.0 + apart, 1.0), rel=0.05)
    assert second == pytest.approx((4.0, 0.4), rel=0.1)


@pytest.mark.parametrize(
    "record",
    [
        np.exp(-3.0 * SECOND) * sine(5.0),
        np.exp(-10.0 * SECOND) * sine(50.0),
        5.0 * SECOND + sine(5.0),
        np.sign(sine(5.0)),
        sine(5.0) + 0.05 * sine(83.0),
    ],
    ids=["damped", "much damped", "drifting", "not a sine", "with a ripple"],
)
def test_one_mode_is_one(record):
    """Damping, drift, harmonics of a large swing and ripples are no modes of their own."""
    assert len(signal_modes(SECOND, record)) == 1


@pytest.mark.parametrize("record", [np.exp(-SECOND), 5.0 * SECOND, sine(0.4), np.zeros(2001)])
def test_what_does_not_swing_has_no_mode(record):
    """Requirement: a drift, a decay, less than a period and rest have none."""
    assert signal_modes(SECOND, record) == []


@pytest.mark.parametrize("model", ["spline", "fe"])
def test_a_release_of_two_modes_has_no_single_frequency(model, command):
    """The modes of `two_mode_pivot` are 23.53 and 319.6 Hz, by `modes` of both models; 236 Hz was printed."""
    coarse = ["--control-points", 8] if model == "spline" else ["--elements", 10, "--duration", 0.1]
    words = ["release", FINDS / "two_mode_pivot.toml", "--model", model, *coarse, "--no-check"]
    answer = json.loads(command(*words, "--json", "-").out)
    assert answer["frequency_Hz"] is None
    assert "contains 2 modes" in answer["frequency_reason"]
    fast, slow = (mode["frequency_Hz"] for mode in answer["modes"])
    assert fast == pytest.approx(319.6, rel=5e-3)
    assert slow == pytest.approx(23.53, rel=1e-2)
    assert answer["modes"][0]["amplitude_rad"] > answer["modes"][1]["amplitude_rad"] > 1e-4
