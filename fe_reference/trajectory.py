"""Motions as they are reported: of the one body of a pivot, and of all bodies of a mechanism."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .mass import carried_over
from .motion import Samples
from .solution import Status
from .statics import body_motion
from .stopwatch import Stopwatch
from .structure import Structure

Array = NDArray[np.float64]


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
        gravity_energy (T,): of the weight, zero in the shape at rest [J].
        work, dissipated (T,): by loads and dampers since the start [J].
        constraint_residual (T,) [m], velocity_residual (T,) [m/s]: zero: clamps and attachments are
            eliminated exactly, not enforced.
        shape (T, G, P, 2): positions of the nodes, same origin [m].
        states (T, size): reduced coordinates, for `section_forces`.
        counters: steps, force_evaluations; implicit also iterations, factorisations, halvings.
        settings: integrator, step_s, critical_step_s (explicit), start_rad and what else defines the run.
        seconds: by part (`fe_reference.stopwatch`), "start" the static state that is let go.
        resolution: empty, or what the elements leave unresolved; rotation_error: estimated error of the
            rotation by a companion with fewer elements [rad], nan without one.
    """

    status: Status
    message: str
    time: Array
    rotation: Array
    centre: Array
    rotation_rate: Array
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    velocity_residual: Array
    shape: Array
    states: Array
    counters: Mapping[str, int]
    settings: Mapping[str, float | str]
    seconds: Mapping[str, float]
    resolution: str = ""
    rotation_error: float = math.nan

    @property
    def energy_error(self) -> float:
        """Largest deviation of the balance of energies from its start [1]; see `imbalance`."""
        return imbalance(self)


@dataclass(frozen=True, kw_only=True, eq=False)
class MechanismTrajectory:
    """A motion of a mechanism at T sampled instants, the start first; G strips, P nodes a strip.

    Attributes:
        status, message: how the run ended; why and when it stopped ("" if it did not).
        time (T,): [s].
        bodies, rates: by name, place of the centre and turn (T, 3) [m, rad], and their rates.
        kinetic_energy, strain_energy, gravity_energy, work, dissipated (T,): as in `Trajectory` [J].
        shape (T, G, P, 2): positions of the nodes [m].
        states (T, size): reduced coordinates, for `section_forces`.
        effects: names of the effects of the scene.
        counters, settings, seconds: as in `Trajectory`.
    """

    status: Status
    message: str
    time: Array
    bodies: Mapping[str, Array]
    rates: Mapping[str, Array]
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    shape: Array
    states: Array
    effects: tuple[str, ...]
    counters: Mapping[str, int]
    settings: Mapping[str, float | str]
    seconds: Mapping[str, float]
    resolution: str = ""
    rotation_error: float = math.nan

    @property
    def energy_error(self) -> float:
        """Largest deviation of the balance of energies from its start [1]; see `imbalance`."""
        return imbalance(self)


def imbalance(motion: Trajectory | MechanismTrajectory) -> float:
    """Return how far kinetic + strain + gravity energy - work + dissipated strays from its start [1].

    It is measured against the largest of: strain and kinetic energy of the start, change of gravity energy,
    work, dissipated energy.
    """
    stored = motion.kinetic_energy + motion.strain_energy
    balance = stored + motion.gravity_energy - motion.work + motion.dissipated
    parts = (stored[:1], motion.gravity_energy - motion.gravity_energy[0], motion.work, motion.dissipated)
    scale = max(float(np.abs(part).max()) for part in parts)
    return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0


def _shared(structure: Structure, motion: Samples, settings: Mapping[str, float | str]) -> dict[str, object]:
    """Return what both kinds of trajectory hold, by field."""
    status = Status.CONVERGED if not motion.message else Status.NOT_CONVERGED
    nodes = np.array([strip.nodes for strip in structure.model.strips])
    moved = np.array([structure.displacement(each)[:, :2] for each in motion.y])
    names = {"kinetic_energy": "kinetic", "strain_energy": "strain", "gravity_energy": "gravity"}
    names |= {"work": "work", "dissipated": "dissipated"}
    return {
        "status": Status.UNSTABLE if motion.unstable else status,
        "message": motion.message,
        "time": np.array(motion.time),
        "shape": nodes + moved.reshape(-1, *nodes.shape),
        # the motion may be reduced about other points of the bodies than the model's own structure
        "states": np.array([carried_over(structure, each, structure.model.structure) for each in motion.y]),
        "counters": dict(motion.counters),
        "settings": settings,
        **{field: motion.energies(part) for field, part in names.items()},
    }


def pivot_trajectory(
    structure: Structure, motion: Samples, settings: Mapping[str, float | str], watch: Stopwatch
) -> Trajectory:
    """Turn samples in the reduced coordinates into the motion of the one body."""
    fields, y = _shared(structure, motion, settings), np.array(motion.y)
    origin = structure.model.strips[0].nodes[0]
    fields["shape"] = np.asarray(fields["shape"]) - origin
    return Trajectory(
        rotation=y[:, -1],
        centre=body_motion(structure, y, 0)[:, :2] - origin,
        rotation_rate=np.array(motion.v)[:, -1],
        constraint_residual=np.zeros(len(y)),
        velocity_residual=np.zeros(len(y)),
        **fields,  # type: ignore[arg-type]
        seconds=watch.stop("recover"),
    )


def mechanism_trajectory(
    structure: Structure, motion: Samples, settings: Mapping[str, float | str], watch: Stopwatch
) -> MechanismTrajectory:
    """Turn samples in the reduced coordinates into the motion of all bodies."""
    y, v, names = np.array(motion.y), np.array(motion.v), structure.model.body_names
    return MechanismTrajectory(
        bodies={name: body_motion(structure, y, k) for k, name in enumerate(names)},
        rates={name: body_rates(structure, y, v, k) for k, name in enumerate(names)},
        effects=structure.model.effects.names,
        **_shared(structure, motion, settings),  # type: ignore[arg-type]
        seconds=watch.stop("recover"),
    )


def body_rates(structure: Structure, y: Array, v: Array, body: int) -> Array:
    """Return the rates of a body's centre and turn (T, 3) [m/s, rad/s] at coordinates and rates (T, size)."""
    at = structure.body_slice(body)
    theta, rates = y[:, at][:, 2], v[:, at].copy()
    c, s = np.cos(theta), np.sin(theta)
    x0, y0 = structure.model.bodies[body].centre - structure.points[body]
    rates[:, 0] -= rates[:, 2] * (s * x0 + c * y0)
    rates[:, 1] += rates[:, 2] * (c * x0 - s * y0)
    return rates
