"""A motion as an answer: the trajectory from the records of a run, and going on where one ended."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.estimate import MotionEstimate
from spline_model.laps import Laps
from spline_model.motion.records import DISSIPATED, KINETIC, POSITION, STRAIN, VELOCITY, WEIGHT, WORK
from spline_model.motion.start import Motion, Records
from spline_model.solution import Status, Tabulated, body_columns

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Trajectory(Tabulated):
    """A motion; T records, the start first.

    time (T,) [s]; bodies: x, y, theta (T, 3) by name [m, m, rad]; body: the one that rotation
    (T,) and centre (T, 2) are of; kinetic_energy, strain_energy (T,) [J]; gravity_energy
    against rest, work of loads and drives so far, dissipated so far (T,) [J];
    constraint_residual (T,) [m]; velocity_residual (T,) its rate [m/s]; states (T, N) and
    velocities (T, Q) of the system in motion; resolution: empty, or what step and control points
    leave unresolved; effects: names of the scene's effects; counters: steps,
    halved_steps, newton_iterations, ...; seconds: by part (``spline_model.laps``), "start" the
    static state that is let go; estimate: of the error, where an accuracy was asked for;
    rotation_error: largest difference of the rotation to a companion's with two control points more
    [rad], nan without one.
    """

    status: Status
    message: str
    time: Array
    bodies: dict[str, Array]
    body: str
    kinetic_energy: Array
    strain_energy: Array
    gravity_energy: Array
    work: Array
    dissipated: Array
    constraint_residual: Array
    velocity_residual: Array
    states: Array
    velocities: Array
    resolution: str
    effects: tuple[str, ...]
    counters: dict[str, int]
    settings: dict[str, Any]
    seconds: dict[str, float]
    estimate: MotionEstimate | None = None
    rotation_error: float = math.nan

    @property
    def rotation(self) -> Array:
        """Rotation of the body, (T,) [rad]."""
        return self.bodies[self.body][:, 2]

    @property
    def centre(self) -> Array:
        """Centre of the body, (T, 2) [m]."""
        return self.bodies[self.body][:, :2]

    def columns(self) -> dict[str, Array]:
        """What is one number at every instant, by names with units."""
        energies = ("kinetic_energy", "strain_energy", "gravity_energy", "work", "dissipated")
        return {
            "time_s": self.time,
            **body_columns(self.bodies),
            **{f"{name}_J": getattr(self, name) for name in energies},
        }


def trajectory_of(
    system: System,
    run: Records,
    *,
    effects: tuple[str, ...],
    body: str,
    settings: dict[str, Any],
    resolution: str,
    laps: Laps,
) -> Trajectory:
    """The trajectory of a run; a run that says why it stopped has not converged."""
    rows, layout = run.rows, system.layout
    rest = float(system.tables.weight @ system.rest[: system.tables.weight.size])
    return Trajectory(
        status=Status.NOT_CONVERGED if run.message else Status.CONVERGED,
        message=run.message,
        time=run.time,
        bodies={b.name: run.states[:, layout.body(b.name)] for b in system.scene.bodies},
        body=body,
        kinetic_energy=rows[:, KINETIC],
        strain_energy=rows[:, STRAIN],
        gravity_energy=rows[:, WEIGHT] + rest,
        work=rows[:, WORK],
        dissipated=rows[:, DISSIPATED],
        constraint_residual=rows[:, POSITION],
        velocity_residual=rows[:, VELOCITY],
        states=run.states,
        velocities=run.velocities,
        resolution=resolution,
        effects=effects,
        counters=run.counters,
        settings=settings,
        seconds=laps.lap("recover"),
    )


def last_state(before: Trajectory, system: System) -> tuple[Array, Array]:
    """Unknowns (N,) and velocities (Q,) of the last record, for a system that may have other drives."""
    layout = system.layout
    known, count = layout.multiplier_start, layout.coordinate_count
    if before.velocities.shape[1] != count or before.states.shape[1] < known:
        raise InvalidParameter("after", "a motion of another mechanism", f"one of {count} coordinates")
    z = np.zeros(layout.size)
    z[:known] = before.states[-1, :known]
    return z, before.velocities[-1].copy()


def later(motion: Motion, time: float) -> Motion:
    """The motion with its clock set to ``time`` [s]: histories and drives are that far on."""
    drives, loads = motion.tables.drives, motion.tables.loads
    drives = drives._replace(times=drives.times - time, begin=drives.begin - time, until=drives.until - time)
    loads = loads._replace(times=loads.times - time)
    return motion._replace(tables=motion.tables._replace(drives=drives, loads=loads))


def counted_on(trajectory: Trajectory, before: Trajectory) -> Trajectory:
    """The trajectory with time, work and losses counted on from the end of the one before."""
    return replace(
        trajectory,
        time=trajectory.time + before.time[-1],
        work=trajectory.work + before.work[-1],
        dissipated=trajectory.dissipated + before.dissipated[-1],
    )
