"""The neutral answers to a release and to small motion: arrays that do not tell which model they are of."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from studies.answers.frequency import Frequency, swing_frequency
from studies.answers.response import Answered, Solved, ended, taken
from studies.cases.design import Design
from studies.kinds import Array

#: Arrays that a motion takes over from a model's trajectory as they are.
SHARED_ARRAYS = (
    "time",
    "kinetic_energy",
    "strain_energy",
    "gravity_energy",
    "work",
    "dissipated",
)
#: Those that a model may lack which keeps its constraints exactly, and everywhere.
RESIDUALS = ("constraint_residual", "velocity_residual")

#: Kinetic energy over EI/L of the stiffest strip that is none: a turn of some 1e-8 rad.
STILL = 1e-16
NOTHING_MOVES = (
    "nothing moves: the start is in equilibrium with all that acts; turn a body before it is let go, or give "
    "a load a history"
)
UNSTABLE = (
    "nothing moves, but the start is an unstable equilibrium, where a disturbance grows e-fold in {:.3g} s: "
    "turn a body a little before it is let go"
)


@dataclass(frozen=True, kw_only=True)
class Motion(Solved):
    """Motion of a design after its release at rest, T records, the start first.

    Attributes:
        settings: discretisation keywords, integrator and step.
        status: "converged", "not_converged" or "unstable".
        rotation_error: estimated error of the rotation, by a companion motion [rad]; NaN without one.
        time: (T,) [s]; empty when statics does not reach the start.
        bodies: (T, 3) by name: centre of mass x, y [m], rotation, counter-clockwise [rad]; a pivot's origin
            is A1.
        body: name of the one that swings: that was let go; None of strips alone.
        kinetic_energy, strain_energy: (T,) of strips and bodies together [J].
        gravity_energy: (T,) against rest [J]; work, dissipated: (T,) by loads, and lost, since the start [J].
        constraint_residual: (T,) largest gap of clamps [m]; velocity_residual: (T,) its rate [m/s].
        wall_s: time of the motion alone, without the static path to its start [s].
    """

    time: Array
    bodies: dict[str, Array]
    body: str | None
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    velocity_residual: Array
    rotation_error: float = math.nan

    @property
    def rotation(self) -> Array:
        """(T,) of the body that swings, counter-clockwise [rad]."""
        return self.bodies[str(self.body)][:, 2]

    @property
    def centre(self) -> Array:
        """(T, 2) centre of mass of the body that swings [m]."""
        return self.bodies[str(self.body)][:, :2]

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

    @property
    def swing(self) -> Frequency:
        """Frequency of the rotation's swing about its rest, or why there is none."""
        return swing_frequency(self.time, self.rotation)

    @property
    def frequency(self) -> float:
        """Frequency of the rotation's swing about its rest [Hz]; NaN without a whole swing."""
        return self.swing.value


def motion(result: Any, *, energy: float = 0.0, **about: Any) -> Motion:
    """Return the neutral form of a model's trajectory; only some say how well they resolve the swing.

    Args:
        energy: a scale of the design's [J]: a motion without a part of it stands still, and says so. With
            none that is not asked.
        about: model, settings, effects, body that swings and times.
    """
    exact, kinetic = np.zeros(len(result.time)), np.asarray(result.kinetic_energy)
    arrays: dict[str, Any] = {name: getattr(result, name) for name in SHARED_ARRAYS}
    arrays |= {name: getattr(result, name, exact) for name in RESIDUALS}
    arrays = {name: np.asarray(array, dtype=float) for name, array in arrays.items()}
    found = ended(result)
    if len(kinetic) and energy > 0.0 and float(kinetic.max()) <= STILL * energy:
        found |= {"message": result.message or NOTHING_MOVES, "resolution": ""}
    return Motion(
        bodies={name: np.asarray(place, dtype=float) for name, place in result.bodies.items()},
        rotation_error=getattr(result, "rotation_error", math.nan),
        **taken(result, about | {"settings": about["settings"] | dict(result.settings)}),
        **found,
        **arrays,
    )


def no_motion(message: str, design: Design, **about: Any) -> Motion:
    """Return the motion of a design that statics does not bring to the start: without a record."""
    nothing: dict[str, Any] = {name: np.zeros(0) for name in (*SHARED_ARRAYS, *RESIDUALS)}
    return Motion(
        status="not_converged",
        message=message,
        resolution="",
        bodies={body.name: np.zeros((0, 3)) for body in design.bodies},
        counters={},
        wall_s=0.0,
        solve_s=0.0,
        **about,
        **nothing,
    )


@dataclass(frozen=True, kw_only=True)
class Spectrum(Answered):
    """Natural modes of small motion about a static state, F modes, the lowest first.

    Attributes:
        rotation: of the static state [rad]; held: whether it is held.
        frequency: (F,) [Hz]; negative where the state is unstable.
        body: name of the body that may be driven; None without one.
        body_shapes: (F, 3) its displacement x, y and rotation at unit modal mass.
        slide_frequency: frequencies that are left out because they are the discretisation's alone [Hz].
        wall_s: time of the static path to the state and of the modes [s].
        estimate: of the frequencies' error, by name; None of a model that was not asked for an accuracy.
    """

    rotation: float
    held: bool
    frequency: Array
    body: str | None
    body_shapes: Array
    slide_frequency: Array
    wall_s: float
    estimate: dict[str, Any] | None = None

    @property
    def falls_in(self) -> float | None:
        """Time in which a disturbance of an unstable state grows e-fold [s]; None of a stable one."""
        least = float(self.frequency.min(initial=0.0))
        return -1.0 / (2.0 * math.pi * least) if least < 0.0 else None
