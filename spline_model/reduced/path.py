"""An equilibrium path of any mechanism, compiled: _predict, correct, check, halve.

Held coordinates and loads are linear in one factor. As long as stability does not change: where it
does, or the path stops, ``continuation`` finds out why.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import LARGEST_CORRECTION, SLOWEST_SPEED, SMALLEST_CORRECTION
from spline_model.continuation.followed import LARGEST_DEFECT, SMALLEST_MOMENT
from spline_model.continuation.points import ROUND_OFF, WORK_MISMATCH
from spline_model.reduced.arrays import (
    AT,
    AXIAL,
    BEND,
    BENDING,
    DEAD,
    DEFECT,
    DONE,
    ENERGY,
    FACTORS,
    KNOWN,
    PREDICTED,
    RATE,
    REACTION,
    REACTION_RATE,
    SLOPE,
    SLOWEST,
    Y,
)
from spline_model.reduced.assembly import moment_defect
from spline_model.reduced.beside import solve
from spline_model.reduced.equilibrium import HALVED, conjugate, stiffness_of
from spline_model.reduced.preload import act, swell
from spline_model.strip.compiled import called, copy, kernel, once, part

Array = NDArray[np.float64]

SMALLEST_STEP = 2.0**-10


@called()
def _predict(t, known, at, states):
    """Hermite's polynomial through ``known`` states and rates at a factor t, into PREDICTED and RATE."""
    predicted, rate = states[PREDICTED], states[RATE]
    for k in range(predicted.size):
        predicted[k] = rate[k] = 0.0
    for i in range(known):
        away, square, slope, lean = t - at[i], 1.0, 0.0, 0.0
        for j in range(known):
            if j != i:
                apart = at[i] - at[j]
                square *= ((t - at[j]) / apart) ** 2
                slope += 1.0 / apart
                lean += 1.0 / (t - at[j])
        flat = 1.0 - 2.0 * away * slope
        by_value, by_rate = flat * square, away * square
        value_slope, rate_slope = 2.0 * square * (flat * lean - slope), square * (1.0 + 2.0 * away * lean)
        for k in range(predicted.size):
            predicted[k] += by_value * states[i, k] + by_rate * states[KNOWN + i, k]
            rate[k] += value_slope * states[i, k] + rate_slope * states[KNOWN + i, k]


@called()
def _accepted(y, known, arrays):
    """Whether a solved state is the continuation of the last one, if any is known, with end tangents forward
    and no fold."""
    bodies, strips = arrays.bodies, arrays.strips
    shape, space = arrays.shape, arrays.space
    if not space.out[SLOWEST] > SLOWEST_SPEED:
        return False
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    last, predicted = space.states[max(known, 1) - 1], space.states[PREDICTED]
    step = correction = 0.0
    for k in range(bodies.rest.size):
        step += (predicted[k] - last[k]) ** 2
        correction += (y[k] - predicted[k]) ** 2
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes)
        if not (y[at + own - 2] > 0.0 and y[at + own - 1] > 0.0):
            return False
        for k in range(at, at + own):
            step += (predicted[k] - last[k]) ** 2
            correction += (y[k] - predicted[k]) ** 2
    return known == 0 or correction <= max(LARGEST_CORRECTION**2 * step, SMALLEST_CORRECTION**2)


@part()
def _work_of(width, slope0, slope1, bend0, bend1):
    """Return the gain of a potential over a step, from its first and second derivatives at both ends."""
    return 0.5 * width * (slope0 + slope1) + width * width / 12.0 * (bend0 - bend1)


@part()
def _is_work(gained, work, width, slope0, slope1, stored):
    """Whether a gain of potential is the work done, for what is ``stored``: ``points.booked``."""
    scale = max(abs(gained), 0.5 * abs(width) * (abs(slope0) + abs(slope1)))
    return abs(gained - work) <= WORK_MISMATCH * scale + ROUND_OFF * (1.0 + stored)


@called()
def _remember(t, known, at, states):
    """Append Y and RATE to the known states, dropping the oldest; returns their number."""
    if known > 0 and t == at[known - 1]:
        known -= 1
    if known == KNOWN:
        for i in range(KNOWN - 1):
            at[i] = at[i + 1]
            copy(states[i + 1], states[i])
            copy(states[KNOWN + i + 1], states[KNOWN + i])
        known -= 1
    at[known] = t
    copy(states[Y], states[known])
    copy(states[RATE], states[KNOWN + known])
    return known + 1


@called()
def _keep_last(known, at, states):
    """Forget all known states but the last; returns their number."""
    at[0] = at[known - 1]
    copy(states[known - 1], states[0])
    copy(states[KNOWN + known - 1], states[KNOWN])
    return 1


@called()
def _is_alone(route, bodies):
    """Whether the driven rotation alone goes along the route, so that the torque's rate is stiffness."""
    alone = not route.swells and bodies.driven >= 0 and route.target[bodies.driven] != 0.0
    for d in range(bodies.held.size):
        alone = alone and (d == bodies.driven or route.target[d] == 0.0)
    for i in range(bodies.load.size):
        alone = alone and (route.growth == 0.0 or bodies.load[i] == 0.0)
    return alone


@called()
def _stiffness(alone, route, bodies, space):
    """Of the driven rotation at fixed loads, at a state just solved; nan without one."""
    if bodies.driven < 0:
        return np.nan
    if alone:
        return space.vectors[REACTION_RATE, bodies.driven] / route.target[bodies.driven]
    return stiffness_of(bodies, space)


@once()
def _solve_at(here, alone, route, preload, arrays, tolerance, counters):
    """Solve at a factor, into Y, from PREDICTED; the negative eigenvalues, or -1 where it fails."""
    y, predicted, held = arrays.space.states[Y], arrays.space.states[PREDICTED], arrays.bodies.held
    copy(predicted, y)
    for d in range(held.size):
        y[held[d]] = predicted[held[d]] = route.origin[d] + here * route.target[d]
    if route.swells:
        act(here, preload, arrays.bodies, arrays.strips)
    return solve(y, here * route.growth, alone, route.target, route.growth, arrays, tolerance, counters)


@once()
def _is_balanced(here, first, judged, route, preload, arrays):
    """Whether the moments of a state just solved are in balance, and the potential has gained the work done
    since the last state, where there is one. If so, this is the last state then."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    y, out, load = space.states[Y], space.out, here * route.growth
    slope, bend = conjugate(route.target, route.growth, bodies, y, space)
    out[DEFECT] = moment_defect(y, strips, shape, local, SMALLEST_MOMENT)
    potential = out[BENDING] + out[AXIAL] + out[DEAD]
    for i in range(bodies.rest.size):
        potential -= load * bodies.load[i] * (y[i] - bodies.rest[i])
    if route.swells:
        slope, bend = swell(y, here, preload, arrays)
        potential += here * preload.hung[1]
    if judged and out[DEFECT] > LARGEST_DEFECT:
        return False
    if not first:
        width, stored = here - out[AT], abs(out[BENDING]) + abs(out[AXIAL])
        work = _work_of(width, out[SLOPE], slope, out[BEND], bend)
        if not _is_work(potential - out[ENERGY], work, width, out[SLOPE], slope, stored):
            return False
        out[DONE] += work
    out[AT], out[ENERGY], out[SLOPE], out[BEND] = here, potential, slope, bend
    return True


@once()
def _reach(row, known, inertia, alone, route, judged, preload, arrays, tolerance, counters):
    """Go on to a factor of the route in steps, of which one that fails is halved.

    Returns the number of known states, and the negative eigenvalues of the last one or -1.
    """
    states, known_at, begin = arrays.space.states, arrays.space.out[FACTORS:], arrays.space.out[AT]
    at, aim = begin, route.factor[row]
    whole = step = aim - begin
    if known > 1 and whole * (begin - known_at[known - 2]) < 0.0:  # the path turns back
        known = _keep_last(known, known_at, states)
    while True:
        last = row == 0 or abs(aim - at) <= abs(step) * (1 + 1e-9)
        here = aim if last else at + step
        if known > 1 and abs(here - at) > 2 * abs(at - known_at[known - 2]):
            known = _keep_last(known, known_at, states)
        if row > 0:
            _predict(here, known, known_at, states)
        negative = _solve_at(here, alone, route, preload, arrays, tolerance, counters)
        sound = negative >= 0 and (row == 0 or negative == inertia or route.passes)
        sound = sound and _accepted(states[Y], known, arrays)
        if sound and _is_balanced(here, row == 0, judged, route, preload, arrays):
            at, known = here, _remember(here, known, known_at, states)
            if last:
                return known, negative
            if abs(step) < abs(whole) and round(abs(at - begin) / abs(step)) % 2 == 0:
                step *= 2.0
            continue
        counters[HALVED] += 1
        step *= 0.5
        if row == 0 or abs(step) < SMALLEST_STEP * abs(whole):
            return known, -1


@called()
def _store(row, negative, stiffness, space, answer):
    """Write a state that was reached into the answer."""
    out = space.out
    copy(space.states[Y], answer.y[row])
    for d in range(answer.reaction.shape[1]):
        answer.reaction[row, d] = space.vectors[REACTION, d]
    answer.energies[row, 0], answer.energies[row, 1] = out[BENDING], out[AXIAL]
    answer.inertia[row], answer.stiffness[row] = negative, stiffness
    answer.defect[row], answer.done[row] = out[DEFECT], out[DONE]


@kernel()
def follow(start, route, judged, preload, arrays, tolerance, answer):
    """Follow a path from ``start`` (Y,) through the route; returns the number of states that converged.

    judged: whether the moment defect refuses; preload: what bodies and strips are overwritten with where
    the route swells. A state with another number of negative eigenvalues, or with a stiffness of another
    sign than the one before, ends the path, unless it passes such points: what happens there is not for here.
    """
    bodies, space, factors = arrays.bodies, arrays.space, route.factor
    copy(start, space.states[PREDICTED])
    copy(start, space.states[0])
    space.out[AT], space.out[DONE] = factors[0], 0.0
    known, inertia, stiffness, alone = 0, -1, 0.0, _is_alone(route, bodies)
    for row in range(factors.size):
        known, negative = _reach(
            row, known, inertia, alone, route, judged, preload, arrays, tolerance, answer.counters
        )
        if negative < 0:
            return row
        before, stiffness = stiffness, _stiffness(alone, route, bodies, space)
        if row == 0:
            inertia = negative
        elif before * stiffness < 0.0 and not route.passes:
            return row
        _store(row, negative, stiffness, space, answer)
    return factors.size
