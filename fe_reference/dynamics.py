"""Free motion of the body and its strips after the drive is removed."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from .errors import ConvergenceError, InvalidParameter, choice, count, finite, positive, within
from .explicit import Explicit, critical_step
from .implicit import Implicit
from .mass import about_mass_centre
from .model import Model
from .modes import natural_frequencies
from .motion import Progress, Samples, sampling
from .solution import Status
from .statics import body_centre, driven_state
from .structure import Structure

Array = NDArray[np.float64]
INTEGRATORS = ("central-difference", "generalised-alpha")
#: Default of the implicit step: so many in the first period of small motion. The strips swing fifty times as
#: fast as the body and act back on it, so that the period of the body alone says little.
STEPS_PER_PERIOD = 6000
#: Most steps of one run and most numbers kept of it (8 bytes each): beyond, the request is a slip.
MOST_STEPS = 1_000_000_000
MOST_NUMBERS = 200_000_000


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory:
    """A motion at T sampled instants, the start first; G strips, P nodes a strip.

    Attributes:
        status, message: how the run ended; why and when it stopped ("" if it did not).
        time (T,): [s].
        rotation (T,): turn of the body [rad].
        centre (T, 2): its centre of mass, origin at the ground end of the first strip [m].
        rotation_rate (T,): [rad/s].
        kinetic_energy, strain_energy (T,): [J].
        constraint_residual (T,) [m], velocity_residual (T,) [m/s]: zero: clamps and attachments are
            eliminated exactly, not enforced.
        shape (T, G, P, 2): positions of the nodes, same origin [m].
        counters: steps, force_evaluations; implicit also newton_iterations, halvings.
        settings: integrator, step_s, critical_step_s (explicit), start_rad and what else defines the run.
    """

    status: Status
    message: str
    time: Array
    rotation: Array
    centre: Array
    rotation_rate: Array
    kinetic_energy: Array
    strain_energy: Array
    constraint_residual: Array
    velocity_residual: Array
    shape: Array
    counters: Mapping[str, int]
    settings: Mapping[str, float | str]

    @property
    def energy_error(self) -> float:
        """Largest deviation of the energy from that of the start, relative to it [1]."""
        energy = self.kinetic_energy + self.strain_energy
        return float(np.abs(energy / energy[0] - 1.0).max())


def solve_release(
    pivot: Model,
    *,
    start: float,
    duration: float,
    step: float | None = None,
    integrator: str = INTEGRATORS[0],
    safety: float = 0.9,
    spectral_radius: float = 0.9,
    samples: int = 1000,
    increments: int = 20,
    raise_on_failure: bool = True,
    progress: Progress | None = None,
) -> Trajectory:
    """Hold the pivot at a rotation in equilibrium, let go at rest, and follow its motion.

    Args:
        pivot: the model; both elements and both integrators go together. Masses are lumped.
        start: rotation at the start [rad], not zero. duration: [s].
        step: time step [s]. Default: for "central-difference" the smaller critical step of the start and of
            rest, times `safety`; for "generalised-alpha" a 6000th of the first period of small motion. The
            default is shortened so that whole steps fill the duration.
        integrator: "central-difference" (explicit) or "generalised-alpha" (implicit, with `spectral_radius`).
        samples: states kept beside the start, at most.
        increments: of the static path to the start.
        progress: called as progress(done, total) after every sample.

    Leaves out damping and gravity; the corotational element has no physical rotary inertia (see `mass`).

    Raises:
        InvalidParameter: a value outside its domain, or a run too long to finish or to keep.
        ConvergenceError: statics does not reach the start; or (unless `raise_on_failure` is False) the motion
            blew up or a step had no solution: carries the trajectory until then.
    """
    name = choice("integrator", integrator, INTEGRATORS)
    if finite("start", start, "rad") == 0.0:
        raise InvalidParameter("start", start, "a rotation that is not zero [rad]")
    span = positive("duration", duration, "s")
    kept = count("samples", samples)
    structure, body = about_mass_centre(pivot.structure)
    y = driven_state(structure, start, count("increments", increments))
    scheme: Explicit | Implicit
    choices: dict[str, float]
    if name == "central-difference":
        limit = min(critical_step(structure, body, state) for state in (y, np.zeros_like(y)))
        choices = {"critical_step_s": limit, "safety": positive("safety", safety, "1")}
        longest, scheme = safety * limit, Explicit(structure, body)
    else:
        choices = {"spectral_radius": within("spectral_radius", spectral_radius, 0.0, 1.0 + 1e-12, "1")}
        first = natural_frequencies(pivot, count=1, mass="lumped").frequency[0]
        longest, scheme = 1.0 / (STEPS_PER_PERIOD * first), Implicit(structure, body, spectral_radius)
    h, steps = _steps(span, longest if step is None else positive("step", step, "s"), step is None)
    _affordable(span, h, steps, min(kept, steps), y.size)
    motion = scheme.run(y, np.zeros_like(y), h, sampling(steps, kept), progress)
    settings: dict[str, float | str] = {"integrator": name, "start_rad": start, "duration_s": span}
    settings |= {"step_s": h, **choices}
    trajectory = _trajectory(structure, motion, settings)
    if trajectory.status is not Status.CONVERGED and raise_on_failure:
        raise ConvergenceError(
            f"{trajectory.message}; {trajectory.status.text}",
            solution=trajectory,
            load_factor=float(trajectory.time[-1] / span),
            history=tuple(motion.history),
        )
    return trajectory


def _steps(duration: float, longest: float, fill: bool) -> tuple[float, int]:
    """Return step [s] and number of steps; with `fill` the step is shortened to fill the duration."""
    steps = max(1, ceil(duration / longest * (1.0 - 1e-12)))
    return (duration / steps if fill else longest), steps


def _affordable(duration: float, step: float, steps: int, samples: int, size: int) -> None:
    """Refuse a run of too many steps, or of too many numbers to keep."""
    if steps > MOST_STEPS:
        raise InvalidParameter(
            "duration",
            duration,
            f"at most {MOST_STEPS:.0e} steps of {step:.3g} s, this is {steps:.3g} of them [s]",
        )
    if 2 * samples * size > MOST_NUMBERS:
        most = MOST_NUMBERS // (2 * size)
        raise InvalidParameter("samples", samples, f"at most {most} samples of {size} coordinates [1]")


def _trajectory(structure: Structure, motion: Samples, settings: Mapping[str, float | str]) -> Trajectory:
    """Turn samples in the reduced coordinates into what is reported."""
    y, time = np.array(motion.y), np.array(motion.time)
    status = Status.CONVERGED if not motion.message else Status.NOT_CONVERGED
    nodes = np.array([strip.nodes for strip in structure.model.strips])
    moved = np.array([structure.displacement(each)[:, :2] for each in motion.y])
    return Trajectory(
        status=Status.UNSTABLE if motion.unstable else status,
        message=motion.message,
        time=time,
        rotation=y[:, -1],
        centre=body_centre(structure, y),
        rotation_rate=np.array(motion.v)[:, -1],
        kinetic_energy=np.array(motion.kinetic),
        strain_energy=np.array(motion.strain),
        constraint_residual=np.zeros_like(time),
        velocity_residual=np.zeros_like(time),
        shape=nodes + moved.reshape(-1, *nodes.shape) - nodes[0, 0],
        counters=dict(motion.counters),
        settings=settings,
    )
