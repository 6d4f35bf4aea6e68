"""A step of bodies on massless strips, in equilibrium at the bodies' poses x: one energy W(x), compiled.

    M (v1 - v0) / h + D (v0 + v1) / 2 + DW(x0, x1) - f = 0,   (v0 + v1) / 2 = (x1 - x0) / h,
    DW = (g0 + g1) / 2 + (W1 - W0 - (g0 + g1)/2 . dx) / (dx . M dx) M dx

with g the strips' reactions, so that the energy is the same before and after a step of any size.
Poses and strips are solved for together, the strips condensed as in statics
(``spline_model.reduced.assembly``); coordinates without mass, of free strip ends, are in equilibrium
at the step's end. A step begins along the last tangent, renews it there, and goes on with gradients alone
while the residual shrinks: with an older tangent Newton's method converges to the same equilibrium, and an
evaluation costs a quarter. All are parts of one kernel: a call that passes the tables takes as long.
Source of the discrete gradient: Gonzalez, J Nonlinear Sci 6 (1996) 449.
"""

from __future__ import annotations

import math

from spline_model.motion.step import FACTORISATIONS, MOST_ITERATIONS, NEWTON, solve_rows
from spline_model.reduced.arrays import AXIAL, BENDING, DEAD, FORCE, MOVE, RATE
from spline_model.reduced.assembly import assemble, move_strips
from spline_model.reduced.beside import condense_again, take_residual
from spline_model.reduced.equilibrium import entry
from spline_model.strip.compiled import copy, part
from spline_model.strip.element import LAST

ROUND_OFF = 1e-14
"""Part of the energy below which the gap between its change and the mean gradient's work is round-off: the
gap goes with the third power of a step, and divided by the second it would drown a short one."""
NEARLY, CLOSE = 1e-6, 1e-4
"""Residuals from which one more correction ends below round-off, so that nothing is evaluated behind it: with
a new tangent, and with an older one, if it shrinks fast enough for that."""
AFTER = 1e-9
"""Residual that the last correction with an older tangent may leave: its work in a step is round-off."""
POOR = 0.1
"""Residual over the one before from which the tangent is renewed."""


@part()
def _stored(y, arrays):
    """The potential W at a state just assembled: stationary in the strips' coordinates and forces."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    total = space.out[BENDING] + space.out[AXIAL] + space.out[DEAD]
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes) + own
        for k in range(modes):
            total += y[at + k] * local.gap[s, k]
    return total


@part()
def _look_ahead(poses, arrays):
    """W and reactions behind the last correction, to the second and first order in it.

    What the strips were off their equilibrium raises W by g^2 / 2 d a pivot, and lowers it by gap^2 / 2 c.
    """
    strips, shape = arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    for s in range(strips.roots.size):
        for i in range(2 * shape.order.size - 6):
            poses.energy[1] -= 0.5 * local.reduced[s, LAST, i] ** 2 / local.reduced[s, i, i]
        for k in range(strips.compliance.shape[1]):
            poses.energy[1] += 0.5 * strips.gain[s, k] * local.gap[s, k] ** 2
    force, move = space.vectors[FORCE], space.vectors[MOVE]
    for i in range(poses.next.size):
        change = 0.0
        for j in range(poses.next.size):
            change += entry(space.tangent, i, j) * move[j]
        poses.energy[1] += (force[i] + 0.5 * change) * move[i]
        poses.next[i] += change


@part()
def _mean_gradient(poses, masses, space):
    """The mean gradient's correction along M dx, dx . M dx, and the gap's derivative, less the metric's."""
    force, dx = space.vectors[FORCE], poses.dx
    metric, gap = 0.0, poses.energy[1] - poses.energy[0]
    for i in range(dx.size):
        metric += masses.inertia[i] * dx[i] * dx[i]
        if masses.inertia[i] > 0.0:
            gap -= 0.5 * (poses.pull[i] + force[i]) * dx[i]
    if metric == 0.0 or abs(gap) <= ROUND_OFF * abs(poses.energy[0]):
        return 0.0, metric
    push = gap / metric
    for i in range(poses.slope.size):
        total = force[i]
        if i < dx.size and masses.inertia[i] > 0.0:
            total -= 0.5 * (poses.pull[i] + force[i]) + 2.0 * push * masses.inertia[i] * dx[i]
        for j in range(dx.size):
            if masses.inertia[j] > 0.0:
                total -= 0.5 * entry(space.tangent, j, i) * dx[j]
        poses.slope[i] = total
    return push, metric


@part()
def _balance(h, poses, masses, space):
    """Fill the rows of the step's residual, negative, and its tangent; returns the largest residual."""
    force, x, dx, system = space.vectors[FORCE], poses.x, poses.dx, poses.system
    push, metric = _mean_gradient(poses, masses, space)
    norm = 0.0
    for i in range(x.size):
        heavy = i < dx.size and masses.inertia[i] > 0.0
        share, residual = 0.5 if heavy else 1.0, force[i]
        for c in range(x.size):
            system[i, c] = share * entry(space.tangent, i, c)
        if heavy:
            mass, mean = masses.inertia[i], dx[i] / h
            residual = 0.5 * (poses.pull[i] + force[i]) + push * mass * dx[i]
            residual += 2.0 / h * mass * (mean - poses.rate[i]) + masses.drag[i] * mean
            system[i, i] += 2.0 * mass / (h * h) + masses.drag[i] / h + push * mass
            if push != 0.0:
                for c in range(x.size):
                    system[i, c] += mass * dx[i] / metric * poses.slope[c]
        if i < dx.size:
            residual -= poses.load[i]
        norm = max(norm, abs(residual)) if residual == residual else math.inf
        x[i] = -residual
    for f in range(masses.frames.place.shape[0]):
        for i in range(masses.frames.place[f, 0], masses.frames.place[f, 0] + masses.frames.place[f, 2]):
            system[i, i] = 1.0
    return norm


@part()
def _move_all(share, poses, arrays):
    """Move by the solution x of the rows, the strips with the bodies; share: 1 with their own residual."""
    space, dx, y = arrays.space, poses.dx, poses.trial
    move, rate = space.vectors[MOVE], space.states[RATE]
    for i in range(poses.x.size):
        move[i] = poses.x[i]
    for i in range(dx.size):
        dx[i] += poses.x[i]
        y[i] = poses.y[i] + dx[i]
    move_strips(share, arrays, rate)
    for i in range(dx.size, y.size):
        y[i] += rate[i]


@part()
def _bend_on(h, poses):
    """What the strips bent away from the tangent in the last step they bend again, by its square."""
    again = h * h / (poses.last[0] * poses.last[0])
    for i in range(poses.dx.size, poses.y.size):
        poses.ahead[i] = poses.trial[i] - poses.y[i]
        poses.trial[i] += again * poses.bent[i]


@part()
def evaluate(fresh, poses, arrays):
    """Return the energy and reactions at ``trial``, with a fresh tangent or an older one; the strips'
    residual."""
    if fresh:
        norm = assemble(poses.trial, 0.0, arrays)
    else:
        norm = take_residual(poses.trial, 0.0, arrays)
        condense_again(arrays)
    poses.energy[1] = _stored(poses.trial, arrays)
    for i in range(poses.next.size):
        poses.next[i] = arrays.space.vectors[FORCE, i]
    return norm


@part()
def solve(h, poses, masses, arrays, tolerance, counters):
    """Solve a step of length h for the state ``trial``, from the last one along its tangent; True if done.

    dx is the bodies' change, kept apart as their inertia would drown in its round-off.
    """
    space, norm, before, fresh = arrays.space, math.inf, math.inf, False
    for i in range(poses.dx.size):
        poses.dx[i] = 0.0
    copy(poses.y, poses.trial)
    copy(poses.pull, space.vectors[FORCE])
    poses.energy[1] = poses.energy[0]
    for trial in range(-1, MOST_ITERATIONS):
        strain = 0.0
        if trial >= 0:
            fresh, before = trial == 0 or norm > POOR * before, norm
            counters[FACTORISATIONS] += fresh
            strain = evaluate(fresh, poses, arrays)
        norm = max(strain, _balance(h, poses, masses, space)) if strain == strain else math.inf
        if trial >= 0 and (norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before)):
            return True
        if not norm < 1e12 or not solve_rows(poses.x.size, poses.system, poses.x):
            return False
        _move_all(0.0 if trial < 0 else 1.0, poses, arrays)
        if trial < 0:
            _bend_on(h, poses)
            norm = math.inf
            continue
        counters[NEWTON] += 1
        small = norm <= NEARLY if fresh else norm <= CLOSE and norm * norm <= AFTER * before
        if small and arrays.strips.coupled == 0:
            _look_ahead(poses, arrays)
            return True
    return False
