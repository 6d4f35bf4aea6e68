"""A system in motion: its constants, its consistent start, and what happens at an instant of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.effects import Bending
from spline_model.effects.base import Inertia
from spline_model.effects.boundary import factor_at
from spline_model.errors import InvalidParameter
from spline_model.paper import evaluate, strips_of
from spline_model.reduced.model import from_unknowns, require_reduced
from spline_model.reduced.states import coordinates_by
from spline_model.solution import Later
from spline_model.strip.compiled import part
from spline_model.tables import DriveTable, LoadTable

Array = NDArray[np.float64]
Places = NDArray[np.int64]

SAME = 1e-9
"""Instants nearer than this share of a step are the same."""


@part(entered=True)
def factor_of(row: int, time: float, table: DriveTable | LoadTable) -> Any:
    """Return the factor of a load or a drive at an instant [s]."""
    return factor_at(time, table.first[row], table.pairs[row], table.times, table.factors)


@dataclass(frozen=True, eq=False)
class Motion:
    """A system in motion: N unknowns, Q coordinates, M axial modes. What is asked for is made once a system.

    drives, loads: the scene's, by the clock of the motion, the former from where their bodies are.
    """

    system: System
    drives: DriveTable
    loads: LoadTable

    @property
    def rigidity(self) -> Array:
        """Inverse of the axial modes' compliance, (M, M) [N/m]; zero where a strip is inextensible."""
        rigidity: Array = self.system.once("rigidity", axial_rigidity)
        return rigidity

    @property
    def inextensible(self) -> bool:
        """Whether a strip cannot stretch."""
        return bool((np.diag(self.rigidity) == 0.0).any())

    @property
    def massless(self) -> bool:
        """Whether no strip has inertia, so that only the bodies' coordinates are dynamic."""
        return not self.system.mass[: self.system.layout.poses.start].any()

    def later(self, time: float) -> Motion:
        """Return the motion with the clock set to ``time`` [s]: histories and drives are that far on."""
        drives, loads = self.drives, self.loads
        drives = drives._replace(
            times=drives.times - time, begin=drives.begin - time, until=drives.until - time
        )
        return replace(self, drives=drives, loads=loads._replace(times=loads.times - time))

    def event_times(self, duration: float, step: float) -> list[float]:
        """Return the instants inside at which a drive begins or ends or a history has a corner [s].

        A step that ends there keeps its order, and a corner of an active drive, which is a jump of
        its rate, does not ring on as it would in a step across it.
        """
        drives, close = self.drives, SAME * step
        times = np.sort(np.concatenate((drives.begin, drives.until, drives.times, self.loads.times)))
        inside = times[(times > close) & (times < duration - close)]
        return [float(time) for time in inside[np.diff(inside, prepend=-np.inf) > close]]

    def drives_at(self, time: float) -> Places:
        """Return 1 for each drive row (D,) that holds at that time [s], 0 for the others."""
        return ((self.drives.begin < time) & (time < self.drives.until)).astype(np.int64)

    def from_here(self, z: Array, active: Places, before: Places, time: float) -> Motion:
        """Return the motion with the drives that begin now starting from where their bodies are.

        z (N,): unknowns [m, rad, N]; active, before: drive rows (D,) that hold now and before; time [s].
        """
        drives = self.drives
        begun = z[drives.coordinate] - self._factors(time) * drives.target
        origin = np.where(active > before, begun, drives.origin)
        return replace(self, drives=drives._replace(origin=origin))

    def _factors(self, time: float) -> Array:
        """Factors (D,) of the drives at an instant [s]."""
        return np.array([factor_of(d, time, self.drives) for d in range(len(self.drives.row))])

    def catch(self, z: Array, v: Array, active: Places, time: float, span: float) -> tuple[Array, float]:
        """Return the velocity (Q,) that the active drives allow, and the kinetic energy that is lost [J].

        v+ is the velocity nearest to v in the kinetic metric that satisfies all constraints and
        the drives' rates over the next ``span`` [s]: the effect of impulses along the constraints,
        an inelastic catch.
        """
        drives, held, mass = self.drives, np.flatnonzero(active), self.system.mass
        model, at = require_reduced(self.system), drives.coordinate[held]
        places = at - self.system.layout.poses.start
        by = coordinates_by(model, from_unknowns(model, z))
        rates = (self._factors(time + span) - self._factors(time))[held] / span * drives.target[held]
        moved = by @ np.linalg.lstsq(by, v, rcond=None)[0]
        moved += by[:, places] @ ((rates - moved[at]) / by[at, places])
        free = np.delete(by, places, axis=1)
        answer = np.linalg.lstsq(free.T @ mass @ free, free.T @ mass @ (v - moved), rcond=1e-14)[0]
        caught = moved + free @ answer
        return caught, 0.5 * float(v @ mass @ v - caught @ mass @ caught)

    def accelerated(self, z: Array, v: Array) -> tuple[Array, Array]:
        """Consistent acceleration (Q,) and unknowns (N,) at a state, z (Q or more,), with velocity v (Q,).

        M a + dV/dq = Psi_q^T lambda with the constraints (and the inextensible strips' strains)
        differentiated twice: Psi_q a = -(Psi_q v)_q v, the right side by a central difference of
        Psi_q along v, exact at rest. Loads are those of the motion's instant 0.
        """
        system, mass = self._with_first_loads(), self.system.mass
        count, end, size = len(mass), system.layout.multiplier_start, system.layout.size
        unit, gradient, hessian = system.scales.unit[:count], np.empty(size), np.empty((size, size))
        free = np.append(z[:count], np.zeros(size - count))
        free[count:end] = self.rigidity @ strips_of(self.system).strains(free)
        evaluate(system, free, 1.0, gradient, hessian)
        rows = np.append(count + np.flatnonzero(np.diag(self.rigidity) == 0.0), np.arange(end, size))
        jacobian, force, drift = hessian[rows][:, :count].copy(), -gradient[:count], np.zeros(len(rows))
        speed = np.abs(v / unit).max()
        if speed > 0:
            step = 1e-4 / speed
            for sign in (1.0, -1.0):
                moved = free.copy()
                moved[:count] += sign * step * v
                evaluate(system, moved, 1.0, gradient, hessian)
                drift += sign * (hessian[rows][:, :count] @ v) / (2 * step)
        # M a + J^T l = force, J a = -drift: what neither mass nor constraints move is at rest
        sizes = np.linalg.norm(jacobian * unit / system.scales.length, axis=1)
        scale = np.append(unit / system.scales.length, np.diag(mass).max() / np.maximum(sizes, 1e-300))
        matrix = np.block([[mass, jacobian.T], [jacobian, np.zeros((len(rows), len(rows)))]])
        right = np.append(force, -drift) * scale
        solved = scale * np.linalg.lstsq(matrix * scale[:, None] * scale, right, rcond=1e-14)[0]
        free[rows] = solved[count:]
        return solved[:count], free

    def _with_first_loads(self) -> System:
        """The system with the loads that act at the instant 0 of the motion's clock, at load factor 1."""
        loads = self.loads
        parts = [factor_of(f, 0.0, loads) for f in range(len(loads.first))]
        if not parts:
            return self.system
        return self.system.under(loads._replace(value=loads.value * parts))

    def require_material(self) -> None:
        """Check that the measure is the material one; only the leapfrog integrates another.

        Raises InvalidParameter for another measure.
        """
        for bending in self.system.scene.of(Bending):
            if bending.measure != "material":
                raise InvalidParameter("measure", bending.measure, "material, or the integrator leapfrog")


@dataclass(frozen=True, eq=False)
class Start:
    """Where a motion begins: its motion, states that end there, under any drives, and velocities v (Q,)."""

    motion: Motion
    known: Later
    v: Array

    @cached_property
    def _consistent(self) -> tuple[Array, Array]:
        return self.motion.accelerated(self.known.array[-1], self.v)

    @property
    def acceleration(self) -> Array:
        """Acceleration (Q,) [m/s^2, rad/s^2] of the state; computed at its first access."""
        return self._consistent[0]

    @property
    def z(self) -> Array:
        """Unknowns (N,) [m, rad, N] with the axial forces and multipliers of the state."""
        return self._consistent[1]


def set_in_motion(system: System) -> Motion:
    """Return the motion of a system; InvalidParameter if coordinates of the scene have no inertia."""
    if not system.scene.of(Inertia):
        raise InvalidParameter("effects", "no inertia", "strip_inertia and body_inertia for a motion")
    return Motion(system, system.drives, system.acting)


def axial_rigidity(system: System) -> Array:
    """Return the inverse (M, M) [N/m] of the compliance of all axial forces; zero of those without any."""
    strips, start = strips_of(system), system.layout.coordinate_count
    rigidity = np.zeros((strips.axial.size * strips.modes.shape[1],) * 2)
    for first, compliance in zip(strips.axial - start, strips.compliance, strict=True):
        soft = np.flatnonzero(np.diag(compliance))
        rigidity[np.ix_(first + soft, first + soft)] = np.linalg.inv(compliance[np.ix_(soft, soft)])
    return rigidity
