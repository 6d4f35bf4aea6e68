"""The energy-consistent time step: residual, Newton, and a whole run, compiled."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.discrete_bending import add_discrete_bending
from spline_model.kernels.discrete_clamps import subtract_discrete_clamps
from spline_model.kernels.discrete_loads import (
    external_work,
    subtract_discrete_drives,
    subtract_discrete_loads,
)
from spline_model.kernels.discrete_stretching import (
    add_discrete_axial_damping,
    add_discrete_axial_force,
    add_discrete_stretching,
)
from spline_model.kernels.dissipation import dissipation
from spline_model.kernels.drives import subtract_weight
from spline_model.kernels.record import forward, record

STEPS, HALVED, NEWTON, FACTORISATIONS, FOLDED, WHOLE = range(6)
"""Places of the counters of a run: STEPS with the parts of halved ones, WHOLE without; FOLDED is 1 if the
last refused step was solved, but no strip."""
MOST_HALVED, MOST_HALVED_A_STEP = 500, 150
"""A run is given up when it has been halved more often than this, and this for every step done: the
swing of Table 1 at steps of its own period takes 120 a step; without a bound a step may take minutes."""


@njit(cache=True, nogil=True)
def assemble_step(z0, z1, delta, v0, time, h, active, motion, gradient, hessian):
    """Residual and tangent of one step of length h from (z0, v0) at ``time`` to z1.

    M (v1 - v0) / h + D V + damping - loads - D psi^T lambda = 0 with (v0 + v1) / 2 = (q1 - q0) / h; rotations
    (``turns``, indices in q) by the Cayley map. Axial forces and multipliers in z1 are the
    step's means. delta (Q,) is q1 - q0, kept apart because at small h its inertia would drown
    in the round-off of q1.
    """
    gradient[:] = 0.0
    hessian[:] = 0.0
    tables, mass = motion.tables, motion.mass
    add_discrete_bending(z0, z1, tables.bending, 1.0, 0.0, gradient, hessian)
    add_discrete_stretching(z0, z1, tables.stretching, 1.0, 0.0, gradient, hessian)
    add_discrete_axial_force(z0, z1, tables.axial_force, gradient, hessian)
    add_discrete_bending(z0, z1, motion.bending_damping, 0.0, 1.0 / h, gradient, hessian)
    add_discrete_stretching(z0, z1, motion.stretching_damping, 0.0, 1.0 / h, gradient, hessian)
    add_discrete_axial_damping(z0, z1, tables.axial_force, motion.axial_relaxation, h, gradient, hessian)
    subtract_discrete_clamps(z0, z1, tables.clamps, motion.chord, gradient, hessian)
    subtract_discrete_loads(tables.loads, time, h, delta, gradient, hessian)
    subtract_discrete_drives(z1, tables.drives, active, time, h, delta, gradient, hessian)
    subtract_weight(tables.weight, gradient)
    count = v0.size
    change = np.empty(count)
    slope = np.ones(count)
    for i in range(count):
        change[i] = delta[i] / h - v0[i]
    for i in motion.turns:
        half = 0.5 * delta[i]
        change[i] = 2.0 * math.tan(half) / h - v0[i]
        slope[i] = 1.0 / math.cos(half) ** 2
    for i in range(count):
        push = 0.0
        for j in range(count):
            m = mass[i, j]
            push += m * change[j]
            hessian[i, j] += 2.0 * m * slope[j] / (h * h)
        gradient[i] += 2.0 * push / h
    for i in range(motion.drag.shape[0]):
        for j in range(count):
            d = motion.drag[i, j]
            gradient[i] += d * (change[j] + v0[j])
            hessian[i, j] += d * slope[j] / h


@njit(cache=True, nogil=True)
def newton_step(z0, z1, delta, v0, time, h, active, motion, tolerance, gradient, hessian, counters):
    """Solve one step in place from the guess delta and the axial forces and multipliers in z1.

    True if the residual came below tolerance. Rotations of more than a quarter turn in one
    step are refused: the Cayley map has a pole at a half turn.
    """
    unit, energy = motion.unit, motion.energy
    size = z1.size
    before = np.inf
    for i in range(delta.size):
        z1[i] = z0[i] + delta[i]
    for _ in range(20):
        assemble_step(z0, z1, delta, v0, time, h, active, motion, gradient, hessian)
        norm = 0.0
        for i in range(size):
            gradient[i] *= unit[i] / energy
            norm = max(norm, abs(gradient[i])) if gradient[i] == gradient[i] else np.inf
        if not norm < 1e12:
            return False
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            return np.abs(delta[motion.turns]).max() <= 0.5 * math.pi if motion.turns.size else True
        before = norm
        for i in range(size):
            for j in range(size):
                hessian[i, j] *= unit[i] * unit[j] / energy
        try:
            step = np.linalg.solve(hessian, gradient)
        except Exception:  # numba: singular to machine precision
            return False
        counters[NEWTON] += 1
        counters[FACTORISATIONS] += 1
        for i in range(size):
            change = unit[i] * step[i]
            if i < delta.size:
                delta[i] -= change
                z1[i] = z0[i] + delta[i]
            else:
                z1[i] -= change
    return False


@njit(cache=True, nogil=True)
def advance(
    z, v, acceleration, time, duration, first_step, smallest, active, motion, tolerance, counters, totals
):
    """Advance (z, v) in place by ``duration``, halving steps whose Newton fails; returns the time done.

    The step doubles again after each success, up to ``first_step``. totals (2,) grows by the
    work of loads and drives and by the dissipated energy [J].
    """
    size, count = z.size, v.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    guess, delta, velocity = np.empty(size), np.empty(count), np.empty(count)
    done, step = 0.0, min(first_step, duration)
    while duration - done > 1e-9 * duration:
        step = min(step, duration - done)
        guess[:] = z
        for i in range(count):
            delta[i] = step * (v[i] + 0.5 * step * acceleration[i])
        solved = newton_step(
            z, guess, delta, v, time + done, step, active, motion, tolerance, gradient, hessian, counters
        )
        if not (solved and forward(guess, motion.tables)):
            counters[HALVED] += 1
            counters[FOLDED] = 1 if solved else 0
            step *= 0.5
            if step < smallest or counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
                return done
            continue
        counters[STEPS] += 1
        for i in range(count):
            mean = delta[i] / step
            for turn in motion.turns:
                if i == turn:
                    mean = 2.0 * math.tan(0.5 * delta[i]) / step
            acceleration[i] = 2.0 * (mean - v[i]) / step
            velocity[i] = mean
            v[i] = 2.0 * mean - v[i]
        totals[0] += external_work(guess, motion.tables, active, time + done, step, delta)
        totals[1] += dissipation(z, guess, velocity, step, motion)
        z[:] = guess
        done += step
        step = min(2.0 * step, first_step)
    counters[WHOLE] += 1
    return duration


@njit(cache=True, nogil=True)
def run(
    z,
    v,
    acceleration,
    step,
    begin,
    end,
    every,
    smallest,
    active,
    motion,
    tolerance,
    counters,
    totals,
    states,
    rates,
    rows,
):
    """Take the steps ``begin`` ... ``end`` - 1, each of length ``step``; returns the next step's number.

    states (R, N), rates (R, Q) and rows (R, 7) are filled at every ``every``-th step's end.
    """
    strains = np.empty(motion.rigidity.shape[0])
    for k in range(begin, end):
        done = advance(
            z,
            v,
            acceleration,
            k * step,
            step,
            step,
            smallest,
            active,
            motion,
            tolerance,
            counters,
            totals,
        )
        if done < step:
            return k
        if (k + 1) % every == 0:
            r = (k + 1) // every
            states[r] = z
            rates[r] = v
            record(z, v, motion, strains, totals, rows[r])
    return end
