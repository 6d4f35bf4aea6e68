"""A motion as an answer: the trajectory from the records of a run, and going on where one ended."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.estimate import MotionEstimate
from spline_model.motion.records import DISSIPATED, KINETIC, STRAIN, WEIGHT, WORK, Records, Whole
from spline_model.newton import Laps
from spline_model.solution import Status, Tabulated, body_columns

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Remark:
    """A sentence that is made when it is first asked for."""

    make: Callable[[], str]

    @cached_property
    def text(self) -> str:
        """It, or an empty string."""
        return self.make()


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Trajectory(Tabulated):
    """A motion; T records, the start first.

    time (T,) [s]; bodies: x, y, theta (T, 3) by name [m, m, rad]; body: the one that rotation
    (T,) and centre (T, 2) are of; kinetic_energy, strain_energy (T,) [J]; gravity_energy
    against rest, work of loads and drives so far, dissipated so far (T,) [J];
    whole: what is made when it is asked for, states, velocities and constraint residuals; unresolved: what
    the step leaves unresolved, likewise, and checked: what a companion found; effects: names of the scene's
    effects; counters: steps, halved_steps, newton_iterations, ...; seconds: by part (``newton.Laps``),
    "start" the static state that is let go; estimate: of the error, where an accuracy was asked for;
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
    whole: Whole
    unresolved: _Remark
    effects: tuple[str, ...]
    counters: dict[str, int]
    settings: dict[str, Any]
    seconds: dict[str, float]
    estimate: MotionEstimate | None = None
    rotation_error: float = math.nan
    checked: str = ""

    @property
    def states(self) -> Array:
        """Unknowns (T, N) of the system in motion."""
        return self.whole.both[0]

    @property
    def velocities(self) -> Array:
        """Velocities (T, Q) of the system in motion."""
        return self.whole.both[1]

    @property
    def constraint_residual(self) -> Array:
        """Largest one (T,) [m]."""
        return self.whole.gaps[:, 0]

    @property
    def velocity_residual(self) -> Array:
        """Largest rate of it (T,) [m/s]."""
        return self.whole.gaps[:, 1]

    @property
    def resolution(self) -> str:
        """Empty, or what step and control points leave unresolved."""
        return "; ".join(remark for remark in (self.unresolved.text, self.checked) if remark)

    @property
    def control_points(self) -> int:
        """Control points of a strip."""
        return int(self.settings["control_points"])

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
    unresolved: Callable[[], str],
    laps: Laps,
) -> Trajectory:
    """The trajectory of a run; a run that says why it stopped has not converged."""
    rows = run.rows
    rest = float(system.weight @ system.rest[: system.weight.size])
    return Trajectory(
        status=Status.NOT_CONVERGED if run.message else Status.CONVERGED,
        message=run.message,
        time=run.time,
        bodies={b.name: run.poses[:, 3 * i : 3 * i + 3] for i, b in enumerate(system.scene.bodies)},
        body=body,
        kinetic_energy=rows[:, KINETIC],
        strain_energy=rows[:, STRAIN],
        gravity_energy=rows[:, WEIGHT] + rest,
        work=rows[:, WORK],
        dissipated=rows[:, DISSIPATED],
        whole=run.whole,
        unresolved=_Remark(unresolved),
        effects=effects,
        counters=run.counters,
        settings={
            "control_points": max((s.basis.control_points for s in system.scene.strips), default=0),
            **settings,
        },
        seconds=laps.lap("recover"),
    )


def counted_on(trajectory: Trajectory, before: Trajectory) -> Trajectory:
    """The trajectory with time, work and losses counted on from the end of the one before."""
    return replace(
        trajectory,
        time=trajectory.time + before.time[-1],
        work=trajectory.work + before.work[-1],
        dissipated=trajectory.dissipated + before.dissipated[-1],
    )
