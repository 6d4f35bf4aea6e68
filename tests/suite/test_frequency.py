"""The frequency of a swing about its rest, ripples not counted, or none; and which modes a record has."""

import json
import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from studies.answers.adapters import answer_modes, answer_release
from studies.answers.metrics import passages, swing_frequency
from studies.answers.motion import signal_modes
from studies.answers.settings import FeSettings, SplineSettings
from studies.cases.design import named_design
from tests import gates

TIME = np.linspace(0.0, 0.1, 4000)


def swing(frequency=42.0, time=TIME):
    """A cosine [rad]."""
    return np.cos(2.0 * np.pi * frequency * time)


def test_frequency_of_a_known_swing():
    """Passages of a cosine are found between records, its frequency from them; less than a swing has none."""
    assert passages(TIME, swing(), 0.0)[:2] == pytest.approx([1.0 / 168.0, 3.0 / 168.0], rel=1e-8)
    assert swing_frequency(TIME, swing()).value == pytest.approx(42.0, rel=1e-8)
    short = swing_frequency(TIME[:600], swing()[:600])
    assert math.isnan(short.value)
    assert "not a whole swing" in short.reason


def test_half_a_swing_is_enough_where_it_turns_as_far_to_both_sides():
    """One swing from its turning point has two passages; a swing cut short has them too, but no frequency."""
    assert swing_frequency(TIME[:953], swing()[:953]).value == pytest.approx(42.0, rel=1e-8)
    assert math.isnan(swing_frequency(TIME[:800], 0.2 + swing()[:800]).value)


@pytest.mark.parametrize("rest", [0.3, -2.0])
def test_frequency_is_of_the_swing_about_its_rest(rest):
    """A swing about another rest than zero has the same frequency, and its rest is found."""
    found = swing_frequency(TIME, rest + swing())
    assert found.value == pytest.approx(42.0, rel=1e-6)
    assert found.rest == pytest.approx(rest, abs=1e-10)


def rippled(decay, ripple_hertz=511.0):
    """Relative error of the frequency of a swing with a ripple of a quarter of its amplitude."""
    ripple = 0.25 * np.cos(2.0 * np.pi * ripple_hertz * TIME + 1.0)
    swung = swing_frequency(TIME, np.exp(-decay * TIME) * (swing() + ripple) - 0.1)
    return abs(swung.value / 42.0 - 1.0)


@pytest.mark.parametrize("decay", [0.0, 8.0])
def test_ripples_are_not_counted(decay):
    """A ripple of twelve times the frequency leaves it as it is; one of less than five times does not."""
    gates.hold("frequency_of_ripples", partial(rippled, decay))


def test_what_stands_still_has_no_frequency():
    """A constant rotation has no frequency, and the reason says that nothing swings."""
    assert swing_frequency(TIME, np.full_like(TIME, 0.2)).reason == "nothing swings"


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


FINDS = Path(__file__).with_name("finds")
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
