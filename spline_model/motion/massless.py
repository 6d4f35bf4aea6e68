"""Bodies on massless strips: the strips in equilibrium at the bodies' poses x, one energy W(x), compiled.

    M (v1 - v0) / h + D (v0 + v1) / 2 + DW(x0, x1) - f = 0,   (v0 + v1) / 2 = (x1 - x0) / h,
    DW = (g0 + g1) / 2 + (W1 - W0 - (g0 + g1)/2 . dx) / (dx . M dx) M dx

with g the strips' reactions, so that the energy is the same before and after a step of any size.
Poses and strips are solved for together, the strips condensed as in statics
(``spline_model.reduced.assembly``); coordinates without mass, of free strip ends, are in equilibrium
at the step's end. A step begins along the last tangent, renews it there, and goes on with gradients alone
(``spline_model.motion.gradients``) while the residual shrinks.
Source of the discrete gradient: Gonzalez, J Nonlinear Sci 6 (1996) 449.
"""

from __future__ import annotations

import math

from spline_model.motion.gradients import take_gradients
from spline_model.motion.run import MOST_HALVED, MOST_HALVED_A_STEP, SLOWEST_SPEED
from spline_model.motion.step import (
    FACTORISATIONS,
    FOLDED,
    HALVED,
    MOST_ITERATIONS,
    NEWTON,
    STEPS,
    WHOLE,
    load_at,
    solve_rows,
)
from spline_model.reduced.assembly import (
    AXIAL,
    BENDING,
    DEAD,
    FORCE,
    MOVE,
    RATE,
    SLOWEST,
    assemble,
    move_strips,
)
from spline_model.reduced.equilibrium import entry
from spline_model.strip.compiled import copy, kernel, part
from spline_model.strip.element import LAST
from spline_model.strip.laws import MATERIAL

ROUND_OFF = 1e-14
"""Part of the energy below which the gap between its change and the mean gradient's work is round-off: the
gap goes with the third power of a step, and divided by the second it would drown a short one."""
NEARLY = 1e-6
"""Residual from which one more correction ends below round-off, so that nothing is evaluated behind it; with
an older tangent, if it shrinks fast enough for that."""
POOR = 0.1
"""Residual over the one before from which the tangent is renewed."""


@part()
def stored(y, bodies, strips, shape, local, space):
    """The potential W at a state just assembled: stationary in the strips' coordinates and forces."""
    total = space.out[BENDING] + space.out[AXIAL] + space.out[DEAD]
    if strips.measure == MATERIAL:
        own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
        for s in range(strips.roots.size):
            at = bodies.rest.size + s * (own + modes) + own
            for k in range(modes):
                total += y[at + k] * local.axial[s, LAST, k]
    return total


@part()
def look_ahead(poses, strips, shape, local, space):
    """W and reactions behind the last correction, to the second and first order in it.

    What the strips were off their equilibrium raises W by g^2 / 2 d a pivot, and lowers it by gap^2 / 2 c.
    """
    for s in range(strips.roots.size):
        for i in range(2 * shape.order.size - 6):
            poses.energy[1] -= 0.5 * local.reduced[s, LAST, i] ** 2 / local.reduced[s, i, i]
        for k in range(strips.compliance.shape[1]):
            poses.energy[1] += 0.5 * strips.gain[s, k] * local.axial[s, LAST, k] ** 2
    force, move = space.vectors[FORCE], space.vectors[MOVE]
    for i in range(poses.next.size):
        change = 0.0
        for j in range(poses.next.size):
            change += entry(space.tangent, i, j) * move[j]
        poses.energy[1] += (force[i] + 0.5 * change) * move[i]
        poses.next[i] += change


@kernel()
def solve(h, moving, poses, masses, bodies, strips, shape, local, space, tolerance, counters):
    """Solve a step of length h from the guess ``trial``, or the strips at held bodies; True if it converged.

    With bodies that move dx is their change, kept apart as their inertia would drown in its round-off.
    """
    y, dx, free, x, count, fresh = poses.trial, poses.dx, poses.free, poses.x, 0, True
    force, move, rate = space.vectors[FORCE], space.vectors[MOVE], space.states[RATE]
    for i in range(bodies.load.size):
        if moving or i >= dx.size or masses.inertia[i] == 0.0:
            free[count] = i
            count += 1
    for i in range(dx.size):
        dx[i] = 0.0
    copy(poses.y, y)
    norm = before = math.inf
    for trial in range(-1 if moving > 0.0 else 0, MOST_ITERATIONS):
        if trial < 0:
            copy(poses.pull, force)
            norm, poses.energy[1] = 0.0, poses.energy[0]
        else:
            fresh = trial == 0 or moving == 0.0 or norm > POOR * before
            before = norm if trial > 0 else math.inf
            if fresh:
                counters[FACTORISATIONS] += 1
                norm = assemble(y, 0.0, bodies, strips, shape, local, space)
            else:
                norm = take_gradients(y, bodies, strips, shape, local, space)
            if not norm < 1e12:
                return False
            poses.energy[1] = stored(y, bodies, strips, shape, local, space)
        metric, gap = 0.0, poses.energy[1] - poses.energy[0]
        for i in range(bodies.load.size):
            poses.next[i] = force[i]
        for i in range(dx.size):
            if masses.inertia[i] > 0.0:
                metric += masses.inertia[i] * dx[i] * dx[i]
                gap -= 0.5 * (poses.pull[i] + force[i]) * dx[i]
        push = gap / metric if metric > 0.0 and abs(gap) > ROUND_OFF * abs(poses.energy[0]) else 0.0
        if push != 0.0:  # the gap's derivative, less that of the metric
            for i in range(bodies.load.size):
                total = force[i]
                heavy = i < dx.size and masses.inertia[i] > 0.0
                if heavy:
                    total -= 0.5 * (poses.pull[i] + force[i]) + 2.0 * push * masses.inertia[i] * dx[i]
                for j in range(dx.size):
                    if masses.inertia[j] > 0.0:
                        total -= 0.5 * entry(space.tangent, j, i) * dx[j]
                poses.slope[i] = total
        for r in range(count):
            i = free[r]
            share, x[r] = 1.0, force[i]
            if i < dx.size:
                x[r] -= poses.load[i]
                if masses.inertia[i] > 0.0:
                    share, mass, mean = 0.5, masses.inertia[i], dx[i] / h
                    x[r] = 0.5 * (poses.pull[i] + force[i]) + push * mass * dx[i] - poses.load[i]
                    x[r] += 2.0 / h * mass * (mean - poses.rate[i]) + masses.drag[i] * mean
            norm = max(norm, abs(x[r])) if x[r] == x[r] else math.inf
            for c in range(count):
                poses.system[r, c] = share * entry(space.tangent, i, free[c])
            if share == 0.5:
                mass, part_of_gap = masses.inertia[i], masses.inertia[i] * dx[i] / max(metric, 1e-300)
                poses.system[r, r] += 2.0 * mass / (h * h) + masses.drag[i] / h + push * mass
                if push != 0.0:
                    for c in range(count):
                        poses.system[r, c] += part_of_gap * poses.slope[free[c]]
            x[r] = -x[r]
        if trial >= 0 and (norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before)):
            return True
        if not norm < 1e12 or not solve_rows(count, poses.system, x):
            return False
        for i in range(bodies.load.size):
            move[i] = 0.0
        for r in range(count):
            i = free[r]
            move[i] = x[r]
            if i < dx.size:
                dx[i] += x[r]
                y[i] = poses.y[i] + dx[i]
        move_strips(1.0 if trial >= 0 else 0.0, bodies, strips, shape, local, space, rate)
        for i in range(dx.size, y.size):
            y[i] += rate[i]
        if trial < 0:
            continue
        counters[NEWTON] += 1
        small = norm <= NEARLY and (fresh or norm * norm <= tolerance * before)
        if moving and small and strips.coupled == 0:
            look_ahead(poses, strips, shape, local, space)
            return True
    return False


def settle(poses, masses, bodies, strips, shape, local, space, tolerance, counters):
    """Bring strips and massless coordinates into equilibrium at the bodies' poses; True if that converged."""
    if not solve(1.0, 0.0, poses, masses, bodies, strips, shape, local, space, tolerance, counters):
        return False
    poses.y[:], poses.pull[:], poses.energy[0] = poses.trial, poses.next, poses.energy[1]
    return True


@part()
def is_strip(poses, bodies, strips, shape, space, scene_bodies):
    """True if every clamped end's tangent points forwards and |C'| is above a tenth of that at rest."""
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes) + own
        if strips.roots[s] < scene_bodies and not poses.trial[at - 2] > 0.0:
            return False
        if strips.tips[s] < scene_bodies and not poses.trial[at - 1] > 0.0:
            return False
    return space.out[SLOWEST] > SLOWEST_SPEED


@part()
def accept(h, poses, masses):
    """Take the solved step: books, velocities, coordinates."""
    for i in range(poses.dx.size):
        change = poses.dx[i]
        poses.totals[0] += poses.load[i] * change
        poses.totals[1] += masses.drag[i] * change * change / h
        poses.rate[i] = 2.0 * change / h - poses.rate[i] if masses.inertia[i] > 0.0 else 0.0
    copy(poses.trial, poses.y)
    copy(poses.next, poses.pull)
    poses.energy[0] = poses.energy[1]


@kernel()
def run(
    time, step, begin, end, every, smallest, scene_bodies, poses, masses, bodies, strips, shape, local, space,
    tolerance, counters, states, rates, books,
):  # fmt: skip
    """Take the steps ``begin`` ... ``end`` - 1 after a time; returns the next step's number.

    A step whose Newton fails is halved, down to ``smallest``, and doubles again after each success.
    states (R, Y), rates (R, Q) and books (R, 3) W, work and losses: at steps whose number ``every`` divides.
    """
    for k in range(begin, end):
        done, h = 0.0, step
        while step - done > 1e-9 * step:
            now, h = time + k * step + done, min(h, step - done)
            for i in range(poses.load.size):
                poses.load[i] = 0.0
            for f in range(masses.load_value.size):
                poses.load[masses.load_body[f]] += load_at(f, now + 0.5 * h, masses)
            solved = solve(h, 1.0, poses, masses, bodies, strips, shape, local, space, tolerance, counters)
            if solved and is_strip(poses, bodies, strips, shape, space, scene_bodies):
                accept(h, poses, masses)
                counters[STEPS] += 1
                done += h
                h = min(2.0 * h, step)
                continue
            counters[HALVED] += 1
            counters[FOLDED] = 1 if solved else 0
            h *= 0.5
            if h < smallest or counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
                return k
            assemble(poses.y, 0.0, bodies, strips, shape, local, space)  # the tangent to begin along
        counters[WHOLE] += 1
        if (k + 1) % every == 0:
            r = (k + 1) // every - begin // every - 1
            copy(poses.y, states[r])
            copy(poses.rate, rates[r])
            books[r, 0], books[r, 1], books[r, 2] = poses.energy[0], poses.totals[0], poses.totals[1]
    return end
