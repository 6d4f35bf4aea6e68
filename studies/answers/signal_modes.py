"""The modes that a recorded motion contains: their frequencies and amplitudes, from the record alone."""

import math
from typing import Any, NamedTuple

import numpy as np
from scipy import optimize

from studies.answers.metrics import STILL
from studies.kinds import Array

#: Amplitude of a mode over that of the largest that counts: less is a ripple.
LEAST = 0.1
#: Half width of a line in the spectrum of a Hann window, over the inverse of the record's duration.
WIDTH = 2.0
#: Values of the spectrum between those of the record's own frequencies, and most modes that are told.
FINER, MOST = 8, 6
#: Multiples of a frequency up to which a line is its harmonic, that of a large swing which is no sine.
HARMONICS = 9
#: Records of which there must be so many.
FEWEST = 16


class SignalMode(NamedTuple):
    """A mode in a record: its frequency [Hz], and its amplitude in the unit of the record [rad]."""

    frequency_Hz: float
    amplitude_rad: float


def signal_modes(time: Array, value: Array) -> list[SignalMode]:
    """Return the modes that a record (T,) contains at equal instants (T,) [s], the largest first.

    Lines of its spectrum, with a Hann window, begin a fit of sines by least squares. Lines nearer than the
    width of one to a larger one are that one's, and so are multiples of its frequency. A record of less than
    one and a half periods has none.
    """
    count = len(value)
    if count < FEWEST or float(np.ptp(value)) <= STILL:
        return []
    spacing = float(time[-1] - time[0]) / (count - 1)
    lines = _lines(value, 1.0 / (spacing * count))
    if not lines.size:
        return []
    at = np.linspace(0.0, spacing * (count - 1), count)
    scale = 1.0 / (spacing * count)

    def apart(shifts: Array) -> Array:
        return _fit(at, value, lines + scale * shifts)[1]

    solve: Any = optimize.least_squares  # its stub is a module's
    fitted = solve(apart, np.zeros(len(lines)), bounds=(-0.5, 0.5), x_scale=0.1)
    shifts = fitted.x
    frequencies = lines + scale * shifts
    amplitudes = _fit(at, value, frequencies)[0]
    found = sorted(zip(amplitudes, frequencies, strict=True), reverse=True)
    return [
        SignalMode(float(frequency), float(amplitude))
        for amplitude, frequency in found
        if amplitude >= LEAST * found[0][0]
    ]


def _lines(value: Array, resolution: float) -> Array:
    """Return the frequencies [Hz] of the lines of a record that stand for modes, the largest first."""
    count = len(value)
    window = np.hanning(count)
    rest = float(window @ value / window.sum())
    spectrum = np.abs(np.fft.rfft(window * (value - rest), FINER * count))
    tops = np.flatnonzero((spectrum[1:-1] > spectrum[:-2]) & (spectrum[1:-1] >= spectrum[2:])) + 1
    tops = tops[np.argsort(-spectrum[tops])]
    lines: list[float] = []
    for top in tops:
        frequency = float(top) / FINER * resolution
        if spectrum[top] < LEAST * spectrum[tops[0]] or len(lines) == MOST:
            break
        if frequency > resolution and not any(_belongs(frequency, to, resolution) for to in lines):
            lines.append(frequency)
    return np.array(lines)


def _belongs(frequency: float, to: float, resolution: float) -> bool:
    """Return whether a line is within the width of a larger one, or of a multiple of it."""
    multiple = min(max(round(frequency / to), 1), HARMONICS)
    return abs(frequency - multiple * to) < (WIDTH if multiple == 1 else 1.0) * resolution


def _fit(at: Array, value: Array, frequencies: Array) -> tuple[Array, Array]:
    """Return the amplitudes (F,) of the sines that fit a record best, and what they leave of it (T,)."""
    angle = 2.0 * math.pi * at[:, None] * frequencies
    columns = np.hstack((np.ones((len(at), 1)), np.cos(angle), np.sin(angle)))
    found = np.linalg.lstsq(columns, value, rcond=None)[0]
    return np.hypot(*found[1:].reshape(2, -1)), columns @ found - value
