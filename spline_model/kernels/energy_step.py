"""The energy-consistent time step: residual, Newton, and a whole run, compiled."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from spline_model.kernels.discrete_bending import add_discrete_bending
from spline_model.kernels.discrete_clamps import subtract_discrete_clamps
from spline_model.kernels.discrete_stretching import add_discrete_axial_force, add_discrete_stretching
from spline_model.kernels.energy import strain_energy

STEPS, HALVED, NEWTON, FACTORISATIONS = range(4)
"""Places of the counters of a run."""


@njit(cache=True, nogil=True)
def assemble_step(z0, z1, delta, v0, h, motion, gradient, hessian):
    """Residual and tangent of one step of length h from (z0, v0) to z1.

    M (v1 - v0) / h + D V - D psi^T lambda = 0 with (v0 + v1) / 2 = (q1 - q0) / h; rotations
    (``turns``, indices in q) by the Cayley map. Axial forces and multipliers in z1 are the
    step's means. delta (Q,) is q1 - q0, kept apart because at small h its inertia would drown
    in the round-off of q1.
    """
    gradient[:] = 0.0
    hessian[:] = 0.0
    tables, mass = motion.tables, motion.mass
    add_discrete_bending(z0, z1, tables.bending, gradient, hessian)
    add_discrete_stretching(z0, z1, tables.stretching, gradient, hessian)
    add_discrete_axial_force(z0, z1, tables.axial_force, gradient, hessian)
    subtract_discrete_clamps(z0, z1, tables.clamps, motion.chord, gradient, hessian)
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


@njit(cache=True, nogil=True)
def newton_step(z0, z1, delta, v0, h, motion, tolerance, gradient, hessian, counters):
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
        assemble_step(z0, z1, delta, v0, h, motion, gradient, hessian)
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
def forward(z, tables):
    """True if every end tangent points forwards and |C'| stays above a tenth of its value at rest."""
    clamps = tables.clamps
    for c in range(clamps.end.size):
        end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
        m = clamps.direction[c] + (z[body + 2] if body >= 0 else 0.0)
        dx, dy = z[inner] - z[end], z[inner + 1] - z[end + 1]
        if not sign * (dx * math.cos(m) + dy * math.sin(m)) > 0.0:
            return False
    table = tables.bending
    for p in range(table.first.size):
        first, d1 = table.first[p], table.d1[p]
        x = y = 0.0
        for a in range(table.width[p]):
            x += d1[a] * z[first + 2 * a]
            y += d1[a] * z[first + 2 * a + 1]
        if not math.hypot(x, y) > 0.1 * table.speed[p]:
            return False
    return True


@njit(cache=True, nogil=True)
def advance(z, v, acceleration, duration, first_step, smallest, motion, tolerance, counters):
    """Advance (z, v) in place by ``duration``, halving steps whose Newton fails; returns the time done.

    The step doubles again after each success, up to ``first_step``.
    """
    size, count = z.size, v.size
    gradient, hessian = np.empty(size), np.empty((size, size))
    guess, delta = np.empty(size), np.empty(count)
    done, step = 0.0, min(first_step, duration)
    while duration - done > 1e-9 * duration:
        step = min(step, duration - done)
        guess[:] = z
        for i in range(count):
            delta[i] = step * (v[i] + 0.5 * step * acceleration[i])
        solved = newton_step(z, guess, delta, v, step, motion, tolerance, gradient, hessian, counters)
        if not (solved and forward(guess, motion.tables)):
            counters[HALVED] += 1
            step *= 0.5
            if step < smallest:
                return done
            continue
        counters[STEPS] += 1
        for i in range(count):
            mean = delta[i] / step
            for turn in motion.turns:
                if i == turn:
                    mean = 2.0 * math.tan(0.5 * delta[i]) / step
            acceleration[i] = 2.0 * (mean - v[i]) / step
            v[i] = 2.0 * mean - v[i]
        z[:] = guess
        done += step
        step = min(2.0 * step, first_step)
    return duration


@njit(cache=True, nogil=True)
def record(z, v, motion, strains, row):
    """Fill row with kinetic and strain energy [J], the constraint residuals psi [m] and d(psi)/dt [m/s]."""
    row[0] = 0.5 * np.dot(v, np.dot(motion.mass, v))
    row[1] = strain_energy(z, motion.tables, motion.rigidity, v.size, strains)
    position = velocity = 0.0
    clamps = motion.tables.clamps
    for c in range(clamps.end.size):
        end, inner, sign, body = clamps.end[c], clamps.inner[c], clamps.sign[c], clamps.body[c]
        bx, by = clamps.point[c]
        gx = gy = angle = vx = vy = omega = 0.0
        if body >= 0:
            gx, gy, angle = z[body], z[body + 1], z[body + 2]
            vx, vy, omega = v[body], v[body + 1], v[body + 2]
        cos, sin = math.cos(angle), math.sin(angle)
        ax, ay = cos * bx - sin * by, sin * bx + cos * by
        m = clamps.direction[c] + angle
        mx, my = math.cos(m), math.sin(m)
        dx, dy = sign * (z[inner] - z[end]), sign * (z[inner + 1] - z[end + 1])
        wx, wy = sign * (v[inner] - v[end]), sign * (v[inner + 1] - v[end + 1])
        reach = motion.chord[c]
        position = max(position, abs(z[end] - gx - ax), abs(z[end + 1] - gy - ay))
        position = max(position, abs(mx * dy - my * dx) / math.hypot(dx, dy) * reach)
        velocity = max(velocity, abs(v[end] - vx + omega * ay), abs(v[end + 1] - vy - omega * ax))
        velocity = max(velocity, abs(mx * wy - my * wx - omega * (mx * dx + my * dy)))
    row[2] = position
    row[3] = velocity


@njit(cache=True, nogil=True)
def run(z, v, acceleration, step, steps, every, smallest, motion, tolerance, counters, states, rates, rows):
    """Take ``steps`` steps, recording each ``every``-th one; returns the steps that were completed.

    states (R, N), rates (R, Q) and rows (R, 4) are filled from row 1 on; row 0 is the start.
    """
    strains = np.empty(motion.rigidity.shape[0])
    record(z, v, motion, strains, rows[0])
    for k in range(1, steps + 1):
        done = advance(z, v, acceleration, step, step, smallest, motion, tolerance, counters)
        if done < step:
            return k - 1
        if k % every == 0:
            r = k // every
            states[r] = z
            rates[r] = v
            record(z, v, motion, strains, rows[r])
    return steps
