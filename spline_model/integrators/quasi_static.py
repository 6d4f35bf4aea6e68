"""Massless strips under moving bodies: only the bodies' coordinates are dynamic.

The strips' energy at given poses x of the bodies, W(x) = min V, and its gradient g and
Hessian K come from statics with all poses driven. The bodies then move by

    M (v1 - v0) / h + D v + g* = f,   v = (v0 + v1) / 2 = (x1 - x0) / h,
    g* = (g0 + g1) / 2 + (W1 - W0 - (g0 + g1) / 2 . d) M d / (d . M d),   d = x1 - x0,

a discrete gradient: T + W is kept at any step. Second order.
Source: Gonzalez, J Nonlinear Sci 6 (1996) 449, with the mean instead of the midpoint gradient.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import refuse
from spline_model.compile import System, compile_scene
from spline_model.effects import DrivenDisplacement, DrivenRotation
from spline_model.effects.base import Load
from spline_model.errors import InvalidParameter
from spline_model.integrators.monitor import MOST_GAIN, first_gain
from spline_model.integrators.motion import Records
from spline_model.kernels.drives import factor_at
from spline_model.kernels.motion import Motion
from spline_model.kernels.record import DISSIPATED, KINETIC, STRAIN, WEIGHT, WORK
from spline_model.newton import Workspace, solve

Array = NDArray[np.float64]

TOLERANCE = 1e-11
"""Residual of a step in EI/L^2 and EI/L."""
MOST_ITERATIONS = 30
ROUND_OFF = 1e-14
"""Part of the energy below which the gap between its change and the mean gradient's work is round-off: the
gap goes with the third power of a step, and divided by the second it would drown a short one."""
SMALLEST_STEP = 2.0**-12


@dataclass(frozen=True, kw_only=True, eq=False)
class Pose:
    """Strips in equilibrium at poses x (B,): energy W [J], gradient g (B,), Hessian (B, B), unknowns z."""

    x: Array
    energy: float
    weight_energy: float
    gradient: Array
    hessian: Array
    z: Array


class Strips:
    """The strips' static answer to the poses of all bodies."""

    def __init__(self, system: System) -> None:
        scene = system.scene
        if any(isinstance(e, DrivenRotation | DrivenDisplacement) for e in scene.effects):
            raise InvalidParameter("effects", "a drive", "strip_inertia for a driven motion")
        drives: list[DrivenDisplacement | DrivenRotation] = []
        for body in scene.bodies:
            drives.append(DrivenDisplacement(body=body.name, displacement=(0.0, 0.0)))
            drives.append(DrivenRotation(body=body.name, angle=0.0))
        rest = tuple(e for e in scene.effects if not isinstance(e, Load))
        self.system = compile_scene(replace(scene, effects=(*rest, *drives)))
        self.rows = self.system.tables.drives.row
        self.coordinates = self.system.tables.drives.coordinate
        self.work = Workspace.of(self.system)

    def answer(self, x: Array, start: Array) -> Pose | None:
        """Equilibrium at the poses x from the guess ``start`` (N,), or None."""
        drives = self.system.tables.drives._replace(target=x - self.system.tables.drives.origin)
        tables = self.system.tables._replace(drives=drives)
        work = replace(self.work, system=replace(self.system, tables=tables))
        newton = solve(work, start, 1.0)
        if newton.reason or refuse(self.system, newton.z):
            return None
        right = np.zeros((len(x), len(start)))
        right[np.arange(len(x)), self.rows] = -1.0
        try:
            # one more step, to round-off: a gap that is left changes the energy by itself times the
            # reaction, and the discrete gradient divides that by the motion of a step, which may be tiny
            z = newton.z + work.solve(-work.gradient)
            energies = work.evaluate(z, 1.0)
            hessian = np.array([work.solve(force)[self.rows] for force in right])
        except np.linalg.LinAlgError:
            return None
        weight = tables.weight
        return Pose(
            x=x,
            energy=sum(energies),
            weight_energy=float(-weight @ z[: weight.size]),
            gradient=z[self.rows],
            hessian=hessian,
            z=z,
        )


def integrate(
    system: System, motion: Motion, z: Array, v: Array, *, step: float, steps: int, every: int
) -> Records:
    """Take ``steps`` steps from z and the bodies' part of v, recording every ``every``-th one."""
    if motion.bending_damping.first.size or motion.axial_relaxation.size:
        raise InvalidParameter(
            "effects", "strip_damping", "strip_inertia with it: massless strips have no rate"
        )
    strips = Strips(system)
    count = system.layout.coordinate_count
    start = np.concatenate((z[: system.layout.multiplier_start], np.zeros(strips.system.layout.size)))
    start = start[: strips.system.layout.size]
    first = strips.answer(z[strips.coordinates], start)
    if first is None:
        raise InvalidParameter("start", "no equilibrium of the strips", "a static state")
    pose = first
    body = np.ix_(strips.coordinates, strips.coordinates)
    mass = motion.mass[body]
    drag = motion.drag[body] if motion.drag.size else np.zeros_like(mass)
    scale = system.scales.unit[strips.coordinates] / system.scales.energy
    mover = _Mover(strips, mass, drag, _Loads(motion, strips.coordinates), scale)
    v, totals = v[strips.coordinates].copy(), np.zeros(2)
    states, rates, rows, message = [], [], [], ""
    counters = {"steps": 0, "halved_steps": 0}

    def note() -> None:
        states.append(np.concatenate((pose.z[:count], z[count:])))
        velocity = np.zeros(count)
        velocity[strips.coordinates] = v
        rates.append(velocity)
        row = np.zeros(7)
        row[[KINETIC, STRAIN, WEIGHT]] = 0.5 * v @ mass @ v, pose.energy, pose.weight_energy
        row[[WORK, DISSIPATED]] = totals
        rows.append(row)

    note()
    for k in range(1, steps + 1):
        done, h = 0.0, step
        while step - done > 1e-9 * step:
            h = min(h, step - done)
            moved = mover.step(pose, v, (k - 1) * step + done, h)
            if moved is None:
                counters["halved_steps"] += 1
                h /= 2
                if h < SMALLEST_STEP * step:
                    break
                continue
            pose, v, work, lost = moved
            totals += (work, lost)
            counters["steps"] += 1
            done += h
            h = min(2 * h, step)
        if step - done > 1e-9 * step:
            message = f"stopped at {(k - 1) * step:.6g} s: no step is short enough"
            break
        if k % every == 0:
            note()
            if first_gain(np.array((rows[0], rows[-1])), motion.energy, MOST_GAIN) < 2:
                message = f"stopped at {k * step:.6g} s: the energy grows"
                states, rates, rows = states[:-1], rates[:-1], rows[:-1]
                break
    by_strips = strips.work.counters
    counters["newton_iterations"] = by_strips.newton_iterations
    counters["factorisations"] = by_strips.factorisations
    return Records(
        time=np.arange(0.0, len(states)) * (step * every),
        states=np.array(states),
        velocities=np.array(rates),
        rows=np.array(rows),
        message=message,
        counters=counters,
    )


class _Loads:
    """Loads on the bodies as a function of time, (B,)."""

    def __init__(self, motion: Motion, coordinates: NDArray[np.int64]) -> None:
        self.table = motion.tables.loads
        self.place = {int(c): i for i, c in enumerate(coordinates)}
        if any(int(c) not in self.place for c in self.table.coordinate):
            raise InvalidParameter("effects", "tip_force", "loads on bodies only, with massless strips")

    def at(self, time: float) -> Array:
        table, force = self.table, np.zeros(len(self.place))
        for f, coordinate in enumerate(table.coordinate):
            factor = factor_at(time, table.first[f], table.pairs[f], table.times, table.factors)
            force[self.place[int(coordinate)]] += factor * table.value[f]
        return force


@dataclass(frozen=True, eq=False)
class _Mover:
    """One step of the bodies."""

    strips: Strips
    mass: Array
    drag: Array
    loads: _Loads
    scale: Array

    def step(self, pose: Pose, v0: Array, time: float, h: float) -> tuple[Pose, Array, float, float] | None:
        """Pose, velocity, work and loss after a step of length h, or None if it fails."""
        force = self.loads.at(time + h / 2)
        delta = h * v0 + 0.5 * h * h * np.linalg.solve(self.mass, force - pose.gradient)
        guess = pose.z
        for _ in range(MOST_ITERATIONS):
            new = self.strips.answer(pose.x + delta, guess)
            if new is None:
                return None
            guess = new.z
            mean = 0.5 * (pose.gradient + new.gradient)
            metric = delta @ self.mass @ delta
            potential = new.energy + new.weight_energy - pose.energy - pose.weight_energy
            gap = potential - mean @ delta
            if abs(gap) > ROUND_OFF * (abs(pose.energy) + abs(pose.weight_energy)):
                mean = mean + gap / metric * (self.mass @ delta)
            residual = 2 / h * self.mass @ (delta / h - v0) + self.drag @ delta / h + mean - force
            if np.abs(residual * self.scale).max() <= TOLERANCE:
                velocity = 2 * delta / h - v0
                return new, velocity, float(force @ delta), float(delta @ self.drag @ delta / h)
            tangent = 2 / h**2 * self.mass + self.drag / h + 0.5 * new.hessian
            delta = delta - np.linalg.solve(tangent, residual)
        return None
