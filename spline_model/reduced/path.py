"""An equilibrium path of any mechanism, compiled: _predict, correct, check, halve.

Held coordinates and loads are linear in one factor. As long as stability does not change: where it
does, or the path stops, ``continuation`` finds out why.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import LARGEST_CORRECTION, SLOWEST_SPEED, SMALLEST_CORRECTION
from spline_model.continuation.point import ROUND_OFF, WORK_MISMATCH
from spline_model.continuation.resolution import LARGEST_DEFECT, SMALLEST_MOMENT
from spline_model.reduced.assembly import (
    AXIAL,
    BENDING,
    DEAD,
    FACTORS,
    KNOWN,
    PREDICTED,
    RATE,
    REACTION,
    REACTION_RATE,
    SLOWEST,
    Y,
    moment_defect,
)
from spline_model.reduced.beside import solve
from spline_model.reduced.equilibrium import HALVED, conjugate, stiffness_of
from spline_model.reduced.preload import act, swell
from spline_model.strip.compiled import called, copy, part

Array = NDArray[np.float64]

SMALLEST_STEP = 2.0**-10


class Route(NamedTuple):
    """Where a path goes: factors (S,), the first one its start; held coordinates are origin + factor
    x target (D,), the load factor is factor x growth, the share of weight and pre-strain the
    factor itself where it ``swells``, and all of it otherwise. Critical points end it, or it ``passes`` them.
    """

    factor: Array
    origin: Array
    target: Array
    growth: float
    swells: bool = False
    passes: bool = False


class Answer(NamedTuple):
    """S states: y (S, Y); reaction (S, D); stiffness (S,) of the driven rotation at fixed loads; energies
    (S, 2) bending, axial; done (S,) the potential's derivative integrated over the factor; inertia, defect
    (S,); counters (4,).
    """

    y: Array
    reaction: Array
    stiffness: Array
    energies: Array
    done: Array
    inertia: NDArray[np.int64]
    defect: Array
    counters: NDArray[np.int64]

    def rows(self, kept: slice) -> Answer:
        """Some of the states."""
        by_state = {name: getattr(self, name)[kept] for name in self._fields if name != "counters"}
        return self._replace(**by_state)


def empty_answer(states: int, size: int, held: int) -> Answer:
    """Arrays for that many states."""
    return Answer(
        y=np.zeros((states, size)),
        reaction=np.zeros((states, held)),
        stiffness=np.full(states, np.nan),
        energies=np.zeros((states, 2)),
        done=np.zeros(states),
        inertia=np.zeros(states, dtype=np.int64),
        defect=np.zeros(states),
        counters=np.zeros(4, dtype=np.int64),
    )


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
def _accepted(y, known, bodies, strips, shape, space):
    """Whether a solved state is the continuation of the last one, with end tangents forward and no fold."""
    if not space.out[SLOWEST] > SLOWEST_SPEED:
        return False
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    last, predicted = space.states[known - 1], space.states[PREDICTED]
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
    return correction <= max(LARGEST_CORRECTION**2 * step, SMALLEST_CORRECTION**2)


@part()
def work_of(width, slope0, slope1, bend0, bend1):
    """Gain of a potential over a step, from its first and second derivatives at both ends."""
    return 0.5 * width * (slope0 + slope1) + width * width / 12.0 * (bend0 - bend1)


@part()
def is_work(gained, work, width, slope0, slope1, stored):
    """Whether a gain of potential is the work done, for what is ``stored``: ``continuation.point.jumped``."""
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
    """Forget all known states but the last."""
    at[0] = at[known - 1]
    copy(states[known - 1], states[0])
    copy(states[KNOWN + known - 1], states[KNOWN])


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
def follow(start, route, judged, preload, bodies, strips, shape, local, space, tolerance, answer):
    """Follow a path from ``start`` (Y,) through the route; returns the number of states that converged.

    judged: whether the moment defect refuses; preload: what bodies and strips are overwritten with where
    the route swells. A state with another number of negative eigenvalues, or with a stiffness of another
    sign than the one before, ends the path, unless it passes such points: what happens there is not for here.
    """
    states, out, counters, factors = space.states, space.out, answer.counters, route.factor
    y, predicted, known_at = states[Y], states[PREDICTED], out[FACTORS:]
    held, targets, growth = bodies.held, route.target, route.growth
    copy(start, y)
    copy(start, predicted)
    copy(start, states[0])
    known, at = 0, factors[0]
    energy = gradient = curvature = done = defect = stiffness = 0.0
    inertia, alone = -1, _is_alone(route, bodies)
    for row in range(factors.size):
        begin, step = at, factors[row] - at
        if known > 1 and step * (at - known_at[known - 2]) < 0.0:  # the path turns back
            _keep_last(known, known_at, states)
            known = 1
        whole = step
        while True:
            last, here = True, factors[row]
            if row > 0:
                last = abs(here - at) <= abs(step) * (1 + 1e-9)
                if not last:
                    here = at + step
                if known > 1 and abs(here - at) > 2 * abs(at - known_at[known - 2]):
                    _keep_last(known, known_at, states)
                    known = 1
                _predict(here, known, known_at, states)
                copy(predicted, y)
            for d in range(held.size):
                y[held[d]] = predicted[held[d]] = route.origin[d] + here * targets[d]
            load = here * growth
            if route.swells:
                act(here, preload, bodies, strips)
            negative = solve(
                y, load, alone, targets, growth, bodies, strips, shape, local, space, tolerance, counters
            )
            inertia = negative if row == 0 else inertia
            sound = inertia >= 0 and (negative == inertia or (route.passes and negative >= 0))
            sound = sound and _accepted(y, max(known, 1), bodies, strips, shape, space)
            if sound:
                slope, bend = conjugate(targets, growth, bodies, y, space)
                defect = moment_defect(y, strips, shape, local, SMALLEST_MOMENT)
                total = out[BENDING] + out[AXIAL] + out[DEAD]
                for i in range(bodies.rest.size):
                    total -= load * bodies.load[i] * (y[i] - bodies.rest[i])
                if route.swells:
                    slope, bend = swell(y, here, preload, bodies, strips, shape, local, space)
                    total += here * preload.hung[1]
                sound = not (judged and defect > LARGEST_DEFECT)
                if sound and row > 0:
                    stored = abs(out[BENDING]) + abs(out[AXIAL])
                    work = work_of(here - at, gradient, slope, curvature, bend)
                    sound = is_work(total - energy, work, here - at, gradient, slope, stored)
                    done += work if sound else 0.0
                if sound:
                    energy, gradient, curvature = total, slope, bend
            if not sound:
                counters[HALVED] += 1
                step *= 0.5
                if row == 0 or abs(step) < SMALLEST_STEP * abs(whole):
                    return row
                continue
            at = here
            known = _remember(at, known, known_at, states)
            if last:
                break
            steps = abs(at - begin) / abs(step)
            if abs(step) < abs(whole) and round(steps) % 2 == 0:
                step *= 2.0
        if bodies.driven >= 0:
            before = stiffness
            stiffness = (
                space.vectors[REACTION_RATE, bodies.driven] / targets[bodies.driven]
                if alone
                else stiffness_of(bodies, space)
            )
            if row > 0 and before * stiffness < 0.0 and not route.passes:
                return row
            answer.stiffness[row] = stiffness
        copy(y, answer.y[row])
        for d in range(held.size):
            answer.reaction[row, d] = space.vectors[REACTION, d]
        answer.energies[row, 0], answer.energies[row, 1] = out[BENDING], out[AXIAL]
        answer.inertia[row], answer.defect[row], answer.done[row] = negative, defect, done
    return factors.size
