"""Records of a run, how far its energies and clamps hold, and the trajectory that they are as an answer."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.start import Motion
from spline_model.paper import clamps_of
from spline_model.solution import MotionEstimate, Status, Tabulated, body_columns, kept

Array = NDArray[np.float64]

KINETIC, WEIGHT, STRAIN, WORK, DISSIPATED = range(5)
"""Places of a row: kinetic energy, potential of the weight, strain energy, work of loads and drives so far,
energy dissipated so far [J]."""
ENERGIES = 5
"""Length of a row: the last numbers of a compiled run's record, there in EI/L."""
MOST_GAIN = 1e-6
"""Largest gain of an energy-consistent run over its energy: a million steps stay below."""
QUIET = 1e-6
"""Energies below this, in EI/L, are not told from this much: their gain is round-off."""


def first_gain(rows: Array, unit: float, most: float) -> int:
    """Return the number of the first of the rows (R, 5) of energies [J] with a gain above ``most``, or R.

    It is that of the balance T + V - work + dissipated over the run's energy [1], the largest of the
    balance's parts so far, as a run may start at rest, and the weight's zero is arbitrary. unit: EI/L [J].
    """
    stored, fallen = rows[:, KINETIC] + rows[:, STRAIN], rows[:, WEIGHT] - rows[0, WEIGHT]
    balance = stored + fallen - rows[:, WORK] + rows[:, DISSIPATED]
    parts = np.abs((stored, fallen, rows[:, WORK], rows[:, DISSIPATED])).max(axis=0)
    scale = np.maximum(np.maximum.accumulate(parts), QUIET * unit)
    gained = np.flatnonzero(~((balance - balance[0]) / scale <= most))
    return int(gained[0]) if gained.size else len(rows)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Trajectory(Tabulated):
    """A motion of T records, the start first.

    Attributes
    ----------
    time : (T,) s
    bodies : mapping of str to (T, 3) m, m and rad
        x, y, theta by name.
    body : str
        The one that rotation (T,) and centre (T, 2) belong to.
    kinetic_energy, strain_energy : (T,) J
        The strain energy includes that of springs.
    gravity_energy, work, dissipated : (T,) J
        Energy of the weight relative to rest; work of loads and drives, and dissipated energy, since the
        start.
    motion : Motion
        The system in motion.
    make : callable
        Returns states and velocities, at their first access.
    unresolved : callable
        Returns a message on the frequencies that the step does not resolve.
    still : callable
        Returns whether the start is in equilibrium.
    checked : str
        Remark of the companion motions.
    way : str
        Critical points that statics passed before the start.
    effects : tuple of str
        Names of the scene's effects.
    counters : mapping of str to int
        Steps, halved steps, Newton iterations and more.
    seconds : mapping of str to float, s
        By part (``newton.Laps``); "start" is the static state that is released.
    rotation_error, displacement_error : float, rad and m
        Estimated errors of the rotations of all bodies, and of the places of all bodies and free ends, by
        companions with finer steps and more control points; nan without companions.
    estimate : MotionEstimate or None
        Of a motion to a wanted accuracy.
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
    motion: Motion
    make: Callable[[], tuple[Array, Array]]
    unresolved: Callable[[], str]
    still: Callable[[], bool]
    effects: tuple[str, ...]
    counters: dict[str, int]
    settings: dict[str, Any]
    seconds: dict[str, float]
    rotation_error: float = math.nan
    displacement_error: float = math.nan
    checked: str = ""
    way: str = ""
    estimate: MotionEstimate | None = None

    @kept
    def _moved(self) -> tuple[Array, Array]:
        return self.make()

    @property
    def states(self) -> Array:
        """Unknowns (T, N) of the system in motion [m, rad, N]."""
        return self._moved[0]

    @property
    def velocities(self) -> Array:
        """Velocities (T, Q) of the coordinates in motion [m/s, rad/s]."""
        return self._moved[1]

    @kept
    def constraint_residual(self) -> Array:
        """Largest constraint residual (T,) [m]: of ends, and of directions over the end's chord at rest."""
        system = self.motion.system
        clamps = clamps_of(system)
        (points, (along, across)), (_, reach) = clamps.gaps(self.states), clamps.gaps(system.rest)
        gaps = np.stack((*points, across * reach[0] / np.hypot(along, across)))
        return np.asarray(np.abs(gaps).max(axis=(0, 2), initial=0.0))

    @cached_property
    def resolution(self) -> str:
        """Message on what step and control points do not resolve, or an empty string."""
        return "; ".join(remark for remark in (self.unresolved(), self.way, self.checked) if remark)

    @cached_property
    def starts_still(self) -> bool:
        """Whether the motion starts at rest in equilibrium, to round-off."""
        return self.still()

    @property
    def segments(self) -> int:
        """Segments of a strip."""
        return int(self.settings["segments"])

    @property
    def control_points(self) -> int:
        """Control points of a segment."""
        return int(self.settings["control_points"])

    @property
    def rotation(self) -> Array:
        """Rotation of the body, (T,) [rad]."""
        return self.bodies[self.body][:, 2]

    @property
    def centre(self) -> Array:
        """Centre of the body, (T, 2) [m]."""
        return self.bodies[self.body][:, :2]

    def moves(self, every: int = 1) -> tuple[Array, Array]:
        """Return rotations of all bodies (R, B) [rad], and places of them and of free ends (R, P, 2) [m].

        They are those of every so many of the records.
        """
        poses = np.array([place[::every] for place in self.bodies.values()]).reshape(
            len(self.bodies), len(self.time[::every]), 3
        )
        places, layout = np.moveaxis(poses[..., :2], 0, 1), self.motion.system.layout
        stops = [layout.strip(name).stop for name in self.motion.system.scene.free_ends]
        ends = np.zeros((1, 0, 2))
        if stops:
            ends = self.states[::every, np.array(stops)[:, None] + np.array([-2, -1])]
        ends = np.broadcast_to(ends, (len(places), *ends.shape[1:]))
        return poses[..., 2].T, np.concatenate((places, ends), axis=1)

    def counted_on(self, before: Trajectory) -> Trajectory:
        """Return the motion with time [s], work and losses [J] counted on from the end of the previous
        one."""
        return replace(
            self,
            time=self.time + before.time[-1],
            work=self.work + before.work[-1],
            dissipated=self.dissipated + before.dissipated[-1],
        )

    def columns(self) -> dict[str, Array]:
        """Return all quantities with one number per instant (T,), by names with units."""
        energies = ("kinetic_energy", "strain_energy", "gravity_energy", "work", "dissipated")
        return {
            "time_s": self.time,
            **body_columns(self.bodies),
            **{f"{name}_J": getattr(self, name) for name in energies},
        }
