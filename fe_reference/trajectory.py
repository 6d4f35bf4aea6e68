"""Motions as they are reported."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Array
from .mass import carried_over
from .motion import ENERGIES, Samples
from .solution import Answer, ErrorEstimate, Status, Stopwatch
from .structure import structure_of


@dataclass(frozen=True, kw_only=True, eq=False)
class Trajectory(Answer):
    """A motion at T sampled instants, the start first; G strips, P nodes a strip.

    Attributes:
        status, message: how the run ended; why and when it stopped ("" if it did not).
        time (T,): [s].
        bodies, rates: by name, place of the centre and turn (T, 3) [m, rad], and their rates.
        kinetic_energy, strain_energy (T,): [J].
        gravity_energy (T,): of the weight, zero in the shape at rest [J].
        work, dissipated (T,): by loads and dampers since the start [J].
        shape (T, G, P, 2): positions of the nodes [m].
        states (T, size): reduced coordinates, for `section_forces`.
        effects: names of the effects of the scene.
        counters: steps, force_evaluations; implicit also iterations, factorisations, halvings.
        history: residual norms of implicit steps.
        settings: integrator, step_s, critical_step_s (explicit), start_rad and what else defines the run.
        seconds: by part (`Stopwatch`), "start" the static state that is let go.
        starts_still: whether it starts at rest in equilibrium, to round-off.
        resolution: empty, or what elements and steps leave unresolved.
        rotation_error, displacement_error: estimated errors of the rotations of all bodies [rad] and of the
            places of all bodies and free ends [m], by companions with fewer elements and longer steps, or by
            the meshes of an accuracy; nan without.
        estimate: of the error, where an accuracy was asked for: then all but `states` are limits of meshes,
            at the nodes of the coarsest.

    Clamps and attachments are eliminated exactly, not enforced: there are no residuals of constraints.
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
    history: tuple[tuple[float, ...], ...]
    seconds: Mapping[str, float]
    starts_still: bool = False
    resolution: str = ""
    rotation_error: float = math.nan
    displacement_error: float = math.nan
    estimate: ErrorEstimate | None = None

    @property
    def reached(self) -> float:
        """Part of the duration that the motion went on [1]."""
        return float(self.time[-1] / float(self.settings["duration_s"]))

    @property
    def energy_error(self) -> float:
        """Largest deviation of kinetic + strain + gravity energy - work + dissipated from its start [1].

        It is measured against the largest of: strain and kinetic energy of the start, change of gravity
        energy, work, dissipated energy.
        """
        stored, gravity = self.kinetic_energy + self.strain_energy, self.gravity_energy
        balance = stored + gravity - self.work + self.dissipated
        parts = (stored[:1], gravity - gravity[0], self.work, self.dissipated)
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(balance - balance[0]).max()) / scale if scale > 0.0 else 0.0

    def columns(self) -> dict[str, Array]:
        """Return what is one number at every instant, by names with units: the columns of a frame."""
        return {
            "time_s": self.time,
            **self.body_columns(self.bodies, ("x_m", "y_m", "rotation_rad")),
            **self.body_columns(self.rates, ("x_rate_m_per_s", "y_rate_m_per_s", "rotation_rate_rad_per_s")),
            **{f"{name}_J": getattr(self, name) for name in ENERGIES},
        }


def trajectory(
    motion: Samples, settings: Mapping[str, float | str], remarks: list[str], watch: Stopwatch
) -> Trajectory:
    """Turn samples in the reduced coordinates into the motion of all bodies; remarks: on its start."""
    structure, y, v = motion.home.structure, motion.y, motion.v
    model, pairs = structure.model, list(zip(y, v, strict=True))
    moved = np.array([structure.displacement(each)[:, :2] for each in y])
    # the motion is reduced about other points of the bodies than the model's own structure
    own = structure_of(model)
    states = np.array([carried_over(structure, each, own) for each in y])
    rates = np.array([own.bodies(carried_over(structure, at, own, rate)) for at, rate in pairs])
    places = own.body_places(states)
    energies: dict[str, Any] = dict(zip(ENERGIES, np.array(motion.energy).T.copy(), strict=True))
    status = Status.CONVERGED if not motion.message else Status.NOT_CONVERGED
    return Trajectory(
        status=Status.UNSTABLE if motion.unstable else status,
        message=motion.message,
        time=np.array(motion.time),
        bodies={name: places[:, k] for k, name in enumerate(model.body_names)},
        rates={name: rates[:, k] for k, name in enumerate(model.body_names)},
        **energies,
        shape=model.rest + moved.reshape(-1, *model.rest.shape),
        states=states,
        effects=model.effects.names,
        counters=dict(motion.counters),
        history=tuple(motion.history),
        settings=settings,
        seconds=watch.stop("recover"),
        starts_still=motion.still,
        resolution="; ".join([*motion.home.remarks(motion, float(settings["step_s"])), *remarks]),
    )
