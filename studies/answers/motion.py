"""The neutral answers to a release and to small motion: arrays that do not tell which model they are of."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from studies.answers.metrics import Frequency, swing_frequency
from studies.answers.models import Asked, mode_bodies
from studies.answers.response import Answered, Solved
from studies.answers.signal_modes import SignalMode, signal_modes
from studies.cases.design import flexural_scale
from studies.kinds import Array

#: Amplitude of the second mode over the first up to which one mode carries a motion: a passage through the
#: rest tolerates as much of a ripple.
CARRIED = 0.2
#: Kinetic energy over EI/L of the stiffest strip that is none: a turn of some 1e-8 rad.
STILL = 1e-16
NOTHING_MOVES = (
    "nothing moves: the start is in equilibrium with all that acts; turn a body before it is let go, or give "
    "a load a history"
)
UNSTABLE = (
    "the start is an unstable equilibrium, where a disturbance grows e-fold in {:.3g} s: what moves, if "
    "anything, has grown from round-off; turn a body a little before it is let go"
)


@dataclass(frozen=True, kw_only=True)
class Motion(Solved):
    """Motion of a design after its release at rest, T records, the start first.

    Attributes:
        settings: discretisation keywords, integrator and step.
        status: "converged", "not_converged" or "unstable".
        rotation_error, displacement_error: estimated errors of the rotations of all bodies [rad] and of the
            places of all bodies and free ends [m], by companion motions; NaN without.
        time: (T,) [s]; empty when statics does not reach the start.
        kinetic_energy, strain_energy: (T,) of strips and bodies together [J].
        gravity_energy: (T,) against rest [J]; work, dissipated: (T,) by loads, and lost, since the start [J].
        constraint_residual: (T,) largest gap of clamps [m].
        starts_still: whether it starts at rest in equilibrium, to the round-off of the problem.
        wall_s: time of the whole call, the static path to its start included [s].
    """

    time: Array
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    starts_still: bool = False
    rotation_error: float = math.nan
    displacement_error: float = math.nan

    @property
    def energy_error(self) -> float:
        """Largest error of the balance of energies over the largest of its parts, the stored one at the
        start [1]; NaN without a record."""
        stored = self.kinetic_energy + self.strain_energy
        balance = stored + self.gravity_energy - self.work + self.dissipated
        if not len(balance):
            return float("nan")
        parts = (stored[:1], self.gravity_energy - self.gravity_energy[0], self.work, self.dissipated)
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0

    @cached_property
    def modes(self) -> list[SignalMode]:
        """Frequencies that the rotation contains, with amplitudes, the largest first."""
        return signal_modes(self.time, self.rotation)

    @property
    def swing(self) -> Frequency:
        """Frequency of the rotation's swing about its rest, or why there is none.

        There is none where no single mode carries the rotation.
        """
        if len(self.modes) > 1 and self.modes[1].amplitude_rad > CARRIED * self.modes[0].amplitude_rad:
            parts = (f"{f:.5g} Hz ({math.degrees(a):.3g} deg)" for f, a in self.modes)
            reason = f"the rotation contains {len(self.modes)} modes: {', '.join(parts)}"
            return Frequency(value=math.nan, reason=reason)
        return swing_frequency(self.time, self.rotation)

    @property
    def frequency(self) -> float:
        """Frequency of the rotation's swing about its rest [Hz]; NaN without a whole swing of one mode."""
        return self.swing.value

    @classmethod
    def of(cls, asked: Asked, result: Any, **seconds: float) -> "Motion":
        """Return the neutral form of a model's trajectory; seconds: its times.

        One without a part of the design's energy in it stands still, and says so.
        """
        own = {name: getattr(result, name, math.nan) for name in ("rotation_error", "displacement_error")}
        own["starts_still"] = bool(result.starts_still)
        if not hasattr(result, "constraint_residual"):  # where constraints are kept exactly
            own["constraint_residual"] = np.zeros(len(result.time))
        kinetic = np.asarray(result.kinetic_energy)
        if len(kinetic) and float(kinetic.max()) <= STILL * flexural_scale(asked.design):
            own |= {"message": result.message or NOTHING_MOVES, "resolution": ""}
        return cls.made(asked, result, **own, **seconds)

    @classmethod
    def without_start(cls, asked: Asked, message: str) -> "Motion":
        """Return the motion of a design that statics does not bring to the start: without a record."""
        nothing: dict[str, Any] = {name: np.zeros(0) for name in cls.arrays()}
        return cls(
            status="not_converged",
            message=message,
            bodies={body.name: np.zeros((0, 3)) for body in asked.design.bodies},
            **cls.about(asked),
            **nothing,
        )


@dataclass(frozen=True, kw_only=True)
class Spectrum(Answered):
    """Natural modes of small motion about a static state, F modes, the lowest first.

    Attributes:
        rotation: of the static state [rad]; held: whether it is held.
        frequency: (F,) [Hz]; negative where the state is unstable.
        body_shapes: (F, 3) displacement x, y and rotation of the body at unit modal mass.
        slide_frequency: frequencies that are left out because they are the discretisation's alone [Hz].
        wall_s: time of the static path to the state and of the modes [s].
    """

    rotation: float
    held: bool
    frequency: Array
    body_shapes: Array
    slide_frequency: Array
    wall_s: float = 0.0

    @property
    def resolution(self) -> str:
        """Return that the accuracy is missed, which the control points or elements were chosen for, or ""."""
        accuracy = (self.estimate or {}).get("accuracy", math.inf)
        missed = self.largest_error > accuracy
        return f"the accuracy of {accuracy:g} is not reached by all frequencies" if missed else ""

    @property
    def falls_in(self) -> float | None:
        """Time in which a disturbance of an unstable state grows e-fold [s]; None of a stable one."""
        least = float(self.frequency.min(initial=0.0))
        return -1.0 / (2.0 * math.pi * least) if least < 0.0 else None

    @classmethod
    def of(cls, asked: Asked, modes: Any, *, message: str = "", **state: Any) -> "Spectrum":
        """Return the neutral form of a model's modes, of which only a spline has some that slide.

        Args:
            asked: what was asked. modes: None where statics does not reach the state, as `message` says.
            state: what they are about, and their time.
        """
        names, body = [body.name for body in asked.design.bodies], asked.design.body
        shapes = np.zeros((0, len(names), 3)) if modes is None else mode_bodies(modes, names)
        return cls(
            status="not_converged" if modes is None else "converged",
            message=message,
            frequency=np.asarray(getattr(modes, "frequency", ()), dtype=float),
            body_shapes=shapes[:, names.index(body)] if body else np.zeros((len(shapes), 3)),
            slide_frequency=np.asarray(getattr(modes, "slide_frequency", ()), dtype=float),
            **cls.about(asked, modes),
            **state,
        )
