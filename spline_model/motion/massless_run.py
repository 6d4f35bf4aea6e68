"""Runs of bodies on massless strips: what is refused, halving, books, records, compiled.

Strips without mass stand in stable equilibrium at every instant. Where one snaps through there is none to go
on in, and the run ends: what follows is a motion of the strip, which has its inertia.
"""

from __future__ import annotations

from spline_model.motion.massless import solve
from spline_model.motion.run import MOST_HALVED, MOST_HALVED_A_STEP, SLOWEST_SPEED
from spline_model.motion.step import FOLDS, HALVED, REFUSED, SNAPS, STEPS, WHOLE, load_at
from spline_model.reduced.assembly import NEGATIVE, SLOWEST, assemble, factorise
from spline_model.strip.compiled import copy, kernel, part
from spline_model.strip.element import ON_POINTS, POINTS, place_points


@part()
def refused(poses, bodies, strips, shape, space, scene_bodies):
    """Why a solved state is refused, or 0: FOLDS, or SNAPS where the strips' equilibrium is unstable.

    Every clamped end's tangent points forwards, |C'| is above a tenth of that at rest, and at held masses no
    direction lowers the energy: coordinates without mass would leave such a state at once.
    """
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes) + own
        if strips.roots[s] < scene_bodies and not poses.trial[at - 2] > 0.0:
            return FOLDS
        if strips.tips[s] < scene_bodies and not poses.trial[at - 1] > 0.0:
            return FOLDS
    if not space.out[SLOWEST] > SLOWEST_SPEED:
        return FOLDS
    outer = bodies.load.size - bodies.rest.size
    negative = factorise(poses.still, space.tangent, space.factors, outer)
    return 0 if negative + space.out[NEGATIVE] == 0.0 else SNAPS


@part()
def accept(h, poses, masses):
    """Take the solved step: books, velocities, coordinates."""
    for i in range(poses.dx.size):
        change = poses.dx[i]
        poses.totals[0] += poses.load[i] * change
        poses.totals[1] += masses.drag[i] * change * change / h
        poses.rate[i] = 2.0 * change / h - poses.rate[i] if masses.inertia[i] > 0.0 else 0.0
    for i in range(poses.dx.size, poses.y.size):
        poses.bent[i] = poses.trial[i] - poses.y[i] - poses.ahead[i]
    poses.last[0] = h
    copy(poses.trial, poses.y)
    copy(poses.next, poses.pull)
    poses.energy[0] = poses.energy[1]


@kernel()
def store(poses, masses, bodies, strips, shape, local, row):
    """A record: y, the bodies' rates and its energies, as of ``spline_model.motion.run.store``."""
    y, rate, n = poses.y, poses.rate, shape.order.size
    own, modes = 2 * n - 6, strips.compliance.shape[1]
    kinetic = weight = 0.0
    for i in range(y.size):
        row[i] = y[i]
    for i in range(rate.size):
        row[y.size + i] = rate[i]
        kinetic += 0.5 * masses.inertia[i] * rate[i] * rate[i]
        weight -= bodies.weight[i] * y[i]
    for s in range(strips.roots.size):
        at = rate.size + s * (own + modes)
        place_points(s, y[at : at + own], y, strips, local)
        for i in range(2 * n):
            weight -= strips.numbers[s, ON_POINTS + i] * local.nodal[s, POINTS, i]
    at = y.size + rate.size
    row[at], row[at + 1], row[at + 2] = kinetic, weight, poses.energy[0] - weight
    row[at + 3], row[at + 4] = poses.totals[0], poses.totals[1]


@kernel()
def run(
    time, step, begin, end, every, smallest, scene_bodies, poses, masses, bodies, strips, shape, local, space,
    tolerance, counters, records,
):  # fmt: skip
    """Take the steps ``begin`` ... ``end`` - 1 after a time; returns the next step's number.

    A step whose Newton fails is halved, down to ``smallest``, and doubles again after each success.
    records (R, Y + Q + 5): of ``store``, at the ends of steps whose number ``every`` divides.
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
            counters[REFUSED] = refused(poses, bodies, strips, shape, space, scene_bodies) if solved else 0
            if solved and counters[REFUSED] == 0:
                accept(h, poses, masses)
                counters[STEPS] += 1
                done += h
                h = min(2.0 * h, step)
                continue
            counters[HALVED] += 1
            h *= 0.5
            if h < smallest or counters[HALVED] > MOST_HALVED + MOST_HALVED_A_STEP * counters[WHOLE]:
                return k
            assemble(poses.y, 0.0, bodies, strips, shape, local, space)  # the tangent to begin along
        counters[WHOLE] += 1
        if (k + 1) % every == 0:
            row = records[(k + 1) // every - begin // every - 1]
            store(poses, masses, bodies, strips, shape, local, row)
    return end
