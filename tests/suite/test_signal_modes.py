"""Which modes a record of a motion contains, and a frequency only where one of them carries it."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from studies.answers.signal_modes import signal_modes

FINDS = Path(__file__).with_name("finds")
TIME = np.linspace(0.0, 1.0, 2001)


def sine(frequency: float) -> np.ndarray:
    """Return a sine of a frequency [Hz] over the second."""
    return np.cos(2.0 * math.pi * frequency * TIME)


@pytest.mark.parametrize("apart", [3.3, 40.0, 271.0])
def test_two_modes_are_told_apart(apart):
    """Frequencies are right to a percent and amplitudes to 5 %, however far they are apart."""
    first, second = signal_modes(TIME, 7.0 + 0.4 * sine(4.0) + sine(4.0 + apart))
    assert first == pytest.approx((4.0 + apart, 1.0), rel=0.05)
    assert second == pytest.approx((4.0, 0.4), rel=0.1)


@pytest.mark.parametrize(
    "record",
    [
        np.exp(-3.0 * TIME) * sine(5.0),
        np.exp(-10.0 * TIME) * sine(50.0),
        5.0 * TIME + sine(5.0),
        np.sign(sine(5.0)),
        sine(5.0) + 0.05 * sine(83.0),
    ],
    ids=["damped", "much damped", "drifting", "not a sine", "with a ripple"],
)
def test_one_mode_is_one(record):
    """Damping, drift, harmonics of a large swing and ripples are no modes of their own."""
    assert len(signal_modes(TIME, record)) == 1


@pytest.mark.parametrize("record", [np.exp(-TIME), 5.0 * TIME, sine(0.4), np.zeros(2001)])
def test_what_does_not_swing_has_no_mode(record):
    """Requirement: a drift, a decay, less than a period and rest have none."""
    assert signal_modes(TIME, record) == []


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
