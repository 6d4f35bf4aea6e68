"""The neutral answers to a release and to small motion, and the modes that a record contains."""

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, NamedTuple, Self

import numpy as np

from studies.answers import metrics
from studies.answers.answer import Answer, own, read_only
from studies.answers.metrics import Frequency, swing_frequency
from studies.answers.models import Asked
from studies.cases.design import flexural_scale
from studies.kinds import Array

#: Amplitude of the second mode over the first up to which one mode carries a motion: a passage through the
#: rest tolerates as much of a ripple.
CARRIED = 0.2
#: Kinetic energy over EI/L of the stiffest strip that is none: a turn of some 1e-8 rad.
STILL = 1e-16
#: The same, above which a start moves whose forces are below round-off: a turn of some 1e-6 rad. Round-off
#: alone gave a stable equilibrium up to 3e-14, at lengths of 20 to 3e6 thicknesses.
MOVED = 1e-12
NOTHING_MOVES = (
    "nothing moves: the start is in equilibrium with all that acts; rotate a body before its release, or "
    "give a load a history"
)
UNSTABLE = (
    "the start is an unstable equilibrium, where a disturbance grows e-fold in {:.3g} s: what moves, if "
    "anything, has grown from round-off; rotate a body slightly before its release"
)
NOT_JUDGED = (
    "the start is in equilibrium, whose stability is not judged, as a load follows its body: what moves, if "
    "anything, has grown from round-off; rotate a body slightly before its release"
)
#: Largest displacement of a mode in a picture, in lengths of the longest strip [1].
AMPLITUDE = 0.1
#: Amplitude of a mode in a record over that of the largest that counts: less is a ripple.
LEAST = 0.1
#: Half width of a line in the spectrum of a Hann window, over the inverse of the record's duration.
WIDTH = 2.0
#: Values of the spectrum between those of the record's own frequencies, and most modes that are told.
FINER, MOST = 8, 6
#: Multiples of a frequency up to which a line is its harmonic, that of a large swing which is no sine.
HARMONICS = 9
#: Records of which there must be so many.
FEWEST = 16


class _SignalMode(NamedTuple):
    """A mode in a record: its frequency [Hz], and its amplitude in the unit of the record [rad]."""

    frequency_Hz: float
    amplitude_rad: float


def signal_modes(time: Array, value: Array) -> list[_SignalMode]:
    """Return the modes of a record `value` (T,) [rad] at equally spaced instants (T,) [s], the largest first.

    Lines of its spectrum, with a Hann window, start a fit of sines by least squares. A line that is nearer
    than the width of a line to a larger one belongs to the larger one, and so do multiples of its frequency.
    A record of less than one and a half periods has no modes.
    """
    count = len(value)
    if count < FEWEST or float(np.ptp(value)) <= metrics.STILL:
        return []
    spacing = float(time[-1] - time[0]) / (count - 1)
    lines = _lines(value, 1.0 / (spacing * count))
    if not lines.size:
        return []
    at = np.linspace(0.0, spacing * (count - 1), count)
    scale = 1.0 / (spacing * count)

    def apart(shifts: Array) -> Array:
        return _fit(at, value, lines + scale * shifts)[1]

    from scipy import optimize

    solve: Any = optimize.least_squares  # its stub is a module's
    fitted = solve(apart, np.zeros(len(lines)), bounds=(-0.5, 0.5), x_scale=0.1)
    shifts = fitted.x
    frequencies = lines + scale * shifts
    amplitudes = _fit(at, value, frequencies)[0]
    found = sorted(zip(amplitudes, frequencies, strict=True), reverse=True)
    return [
        _SignalMode(float(frequency), float(amplitude))
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


@dataclass(frozen=True, kw_only=True)
class Motion(Answer):
    """Motion of a design after its release at rest, T records, the start first.

    The status is "converged", "not_converged" or "unstable", the whole call includes the static path to the
    start, and the settings have integrator and step.

    Attributes:
        time: (T,) [s]; empty when statics does not reach the start.
        kinetic_energy, strain_energy: (T,) of strips and bodies together [J].
        gravity_energy: (T,) against rest [J]; work, dissipated: (T,) by loads, and lost, since the start [J].
    """

    analysis = "release"
    series = "time_s"
    parts = ("kinetic", "strain", "gravity", "dissipated")

    time = own("time")
    kinetic_energy = own("kinetic_energy")
    strain_energy = own("strain_energy")
    gravity_energy = own("gravity_energy")
    work = own("work")
    dissipated = own("dissipated")
    dissipated_energy = own("dissipated")

    @cached_property
    def constraint_residual(self) -> Array:
        """Largest gap of clamps (T,) [m]; zero if constraints are eliminated exactly."""
        return read_only(np.array(getattr(self.solution, "constraint_residual", 0.0 * self.time)))

    @property
    def starts_still(self) -> bool:
        """Whether the motion starts at rest in equilibrium, to round-off."""
        return bool(getattr(self.solution, "starts_still", False))

    @property
    def rotation_error(self) -> float:
        """Estimated error of the rotations of all bodies [rad], by companion motions; NaN without them."""
        return float(getattr(self.solution, "rotation_error", math.nan))

    @property
    def displacement_error(self) -> float:
        """Estimated error of the places of all bodies and free ends [m], by companion motions; NaN without
        them."""
        return float(getattr(self.solution, "displacement_error", math.nan))

    @property
    def balance(self) -> Array:
        """Energy (T,) of the design, less the work of loads, plus the dissipated energy [J]: constant."""
        stored = self.kinetic_energy + self.strain_energy
        return np.asarray(stored + self.gravity_energy - self.work + self.dissipated)

    @property
    def energy_error(self) -> float:
        """Largest error of the balance of energies over the largest of its parts, the stored one at the
        start [1]; NaN without a record."""
        balance, stored = self.balance, (self.kinetic_energy + self.strain_energy)[:1]
        if not len(balance):
            return float("nan")
        parts = (stored, self.gravity_energy - self.gravity_energy[0], self.work, self.dissipated)
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0

    @cached_property
    def modes(self) -> list[_SignalMode]:
        """Frequencies that the rotation contains, with amplitudes, the largest first."""
        return signal_modes(self.time, self.rotation)

    @property
    def swing(self) -> Frequency:
        """Frequency of the free vibration of the rotation, or the reason why there is none.

        There is none if no single mode dominates the rotation.
        """
        if len(self.modes) > 1 and self.modes[1].amplitude_rad > CARRIED * self.modes[0].amplitude_rad:
            parts = (f"{f:.5g} Hz ({math.degrees(a):.3g} deg)" for f, a in self.modes)
            reason = f"the rotation contains {len(self.modes)} modes: {', '.join(parts)}"
            return Frequency(value=math.nan, reason=reason)
        return swing_frequency(self.time, self.rotation)

    @property
    def frequency(self) -> float:
        """Frequency of the free vibration of the rotation [Hz]; NaN without a whole period of one mode."""
        return self.swing.value

    @classmethod
    def of(cls, asked: Asked, result: Any, **given: Any) -> Self:
        """Return the neutral form of a model's trajectory; a message states if nothing moves."""
        found = super().of(asked, result, **given)
        kinetic = float(found.kinetic_energy.max(initial=0.0))
        if not len(found.time) or kinetic > STILL * flexural_scale(asked.design):
            return found
        return replace(found, message=found.message or NOTHING_MOVES, resolution="")


@dataclass(frozen=True, kw_only=True)
class Spectrum(Answer):
    """Natural modes of small motion about a static state, F modes, the lowest first.

    Attributes:
        turned: rotation of the static state [rad]; held: whether it is held. count: of modes that were asked.
        frequency: (F,) [Hz]; negative where the state is unstable.
        mode_shape: (F, G, P, 2) of the strips at unit modal mass.
        slide_frequency: frequencies that are removed because they are the discretisation's alone [Hz].
    """

    analysis = "modes"
    series = "mode"

    turned: float
    held: bool
    count: int = 0
    frequency = own("frequency")
    mode_shape = own("shapes")
    slide_frequency = own("slide_frequency")

    @property
    def mode(self) -> Array:
        """(F,) numbers of the modes [1]."""
        return np.arange(1.0, len(self.frequency) + 1.0)

    @property
    def mode_bodies(self) -> Array:
        """(F, B, 3) displacement x, y and rotation of the bodies at unit modal mass."""
        shapes = np.array([*self.bodies.values()])
        return shapes.reshape(len(shapes), len(self.frequency), 3).swapaxes(0, 1)

    def scale_of(self, state: int) -> float:
        """Return the factor of a mode at unit modal mass for its picture; zero of a mode that moves
        nothing."""
        largest = float(np.hypot(*np.moveaxis(self.mode_shape[state], -1, 0)).max())
        return AMPLITUDE * float(self.along.arc_length.max()) / largest if largest > 0.0 else 0.0

    @property
    def body_shapes(self) -> Array:
        """Displacement (F, 3) x, y [m] and rotation [rad] of the driven or only body; zero without one."""
        return np.zeros((len(self.frequency), 3)) if self.body is None else self.bodies[self.body]

    @classmethod
    def of(cls, asked: Asked, result: Any, **given: Any) -> Self:
        """Return the neutral form of a model's modes, without a solution if statics does not reach the state.

        A message states an accuracy that was not reached.
        """
        status = "not_converged" if result is None else "converged"
        found = cls(asked=asked, solution=result, status=status, **given)
        accuracy = (found.estimate or {}).get("accuracy", math.inf)
        if not found.largest_error > accuracy:
            return found
        return replace(found, resolution=f"the accuracy of {accuracy:g} is not reached by all frequencies")

    @property
    def falls_in(self) -> float | None:
        """Time in which a disturbance of an unstable state grows e-fold [s]; None of a stable one."""
        least = float(self.frequency.min(initial=0.0))
        return -1.0 / (2.0 * math.pi * least) if least < 0.0 else None

    @property
    def _states(self) -> Array:
        """The static state that the motion is about."""
        return np.asarray(self.solution.state)[None]

    def _in_full(self, along: Any) -> Any:
        """Return the fields of the state as often as there are modes."""
        count, rest = len(self.frequency), ("arc_length", "rest_shape", "rest_bodies")
        arrays = {each.name: np.asarray(getattr(along, each.name)) for each in fields(along)}
        moved = {name: array for name, array in arrays.items() if name not in rest}
        return replace(along, **{name: np.repeat(array, count, axis=0) for name, array in moved.items()})
