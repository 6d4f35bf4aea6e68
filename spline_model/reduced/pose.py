"""Bodies held in given poses, compiled: each strip is solved alone between its end frames.

With the poses of all bodies prescribed, the strips know nothing of each other; one Newton
a strip on its own coordinates remains. A state is followed from the last good one: the tangent
predicts, Newton corrects, a part of the way that fails is halved, and all work is bounded.
A strip that is in equilibrium but unstable (it would buckle out of it) is let go downhill.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.checks import SLOWEST_SPEED
from spline_model.reduced.arrays import AXIAL, BENDING, SLOWEST
from spline_model.reduced.assembly import condensed, element_of, recovered
from spline_model.reduced.equilibrium import EVALUATIONS, HALVED, ITERATIONS
from spline_model.strip.compiled import called, copy, kernel
from spline_model.strip.condense import SINGULAR
from spline_model.strip.element import LAST, ROOT, TIP
from spline_model.strip.ends import end_frame

Array = NDArray[np.float64]

MOST_ITERATIONS = 10
"""Newton iterations at one pose; a part of the way that needs more is halved."""
MOST_WORK = 300
"""Newton iterations of one call over all strips before it is given up."""
SMALLEST_PART = 2.0**-9
LONGEST_TURN = 0.5
"""Rotation of a body in one part of the way [rad]."""
LONGEST_SHIFT = 0.15
"""Shift of a strip's end in one part of the way, over the length."""
NUDGE = 0.02
"""Sideways push of an unstable strip, over its length."""
DESCENTS = 80
"""Evaluations of one way downhill before it is given up."""
FOLD = 0.3
"""Least |C'| / J0 on a way downhill: below it the control points fold, and the energy of a kink
between two Gauss points is too low."""


class Room(NamedTuple):
    """Working arrays: step, trial, saddle and best (W + K,) of a strip, change (7,) of its ends, states (Y,)
    at the last part of the way and at its start, place (6,) of an end, sums (5,) of an evaluation.
    """

    step: Array
    trial: Array
    saddle: Array
    best: Array
    change: Array
    last: Array
    start: Array
    place: Array
    out: Array

    @classmethod
    def of(cls, size: int, strip: int) -> Self:
        """Working arrays for states of ``size`` unknowns, ``strip`` of them a strip's."""
        sizes = (strip, strip, strip, strip, 7, size, size, 6, 5)
        return cls(*(np.zeros(each) for each in sizes))


@called()
def _evaluate(s, at, y, strips, shape, local, room):
    """One strip in its element coordinates; returns their number."""
    out = room.out
    out[BENDING] = out[AXIAL] = 0.0
    out[SLOWEST] = np.inf
    return element_of(s, at, y, strips, shape, local, out)


@called()
def _move(share, s, at, own, y, strips, local, room):
    """Add to a condensed strip's w and a what its residual (share 1) and ``room.change`` ask for."""
    modes = strips.compliance.shape[1]
    recovered(s, own, share, strips, local, room.change, room.step[:own], room.step[own:])
    for i in range(own + modes):
        y[at + i] += room.step[i]


@called()
def _correct(s, at, own, y, strips, shape, local, room, tolerance, counters):
    """Newton of one strip between its ends, in place; negative pivots of the solution, or -1 if it fails."""
    for i in range(room.change.size):
        room.change[i] = 0.0
    before = np.inf
    for _ in range(MOST_ITERATIONS + 1):
        size = _evaluate(s, at, y, strips, shape, local, room)
        counters[EVALUATIONS] += 1
        norm = 0.0
        for i in range(own):
            norm = max(norm, abs(local.reduced[s, LAST, i]))
        for k in range(strips.compliance.shape[1]):
            norm = max(norm, abs(local.gap[s, k]))
        if not norm < 1e12:
            return -1
        negative = condensed(s, own, size, strips, local)
        if negative == SINGULAR:
            return -1
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            forward = min(y[at + own - 2], y[at + own - 1]) > 0.0 and room.out[SLOWEST] > SLOWEST_SPEED
            return negative if forward else -1
        before = norm
        _move(1.0, s, at, own, y, strips, local, room)
        counters[ITERATIONS] += 1
    return -1


@called()
def _energy_at(s, at, own, y, strips, shape, local, room):
    """Strain energy of a strip with its axial forces made to follow w; inf for a fold."""
    _evaluate(s, at, y, strips, shape, local, room)
    energy = room.out[BENDING]
    for k in range(strips.compliance.shape[1]):
        c = strips.compliance[s, k]
        y[at + own + k] += local.gap[s, k] / c
        energy += 0.5 * c * y[at + own + k] ** 2
    if not min(room.out[SLOWEST], min(y[at + own - 2], y[at + own - 1])) > FOLD:
        return np.inf
    return energy


@called()
def _descend(s, at, own, y, strips, shape, local, room, tolerance, counters):
    """From any w downhill to a stable equilibrium: Newton with a shift on the diagonal that keeps it so."""
    for i in range(room.change.size):
        room.change[i] = 0.0
    energy, shift = _energy_at(s, at, own, y, strips, shape, local, room), 0.0
    for _ in range(DESCENTS):
        size = _evaluate(s, at, y, strips, shape, local, room)
        counters[EVALUATIONS] += 1
        for i in range(own):
            local.reduced[s, i, i] += shift
        if condensed(s, own, size, strips, local) != 0:
            shift = max(10.0, 4.0 * shift)
            continue
        for i in range(own):
            room.trial[i] = y[at + i]
        _move(1.0, s, at, own, y, strips, local, room)
        counters[ITERATIONS] += 1
        lower = _energy_at(s, at, own, y, strips, shape, local, room)
        if lower <= energy + 1e-12 * abs(energy):
            done = abs(energy - lower) <= 1e-9 * abs(energy) and shift == 0.0
            energy, shift = lower, (0.0 if shift < 20.0 else 0.25 * shift)
            if done:
                return _correct(s, at, own, y, strips, shape, local, room, tolerance, counters)
            continue
        for i in range(own):
            y[at + i] = room.trial[i]
        _energy_at(s, at, own, y, strips, shape, local, room)
        shift = max(10.0, 4.0 * shift)
    return -1


@called()
def _settle(s, at, own, y, strips, shape, local, room, tolerance, counters):
    """From an unstable equilibrium to a stable one beside it, the lower of both sides; 0 if found."""
    size, least = own + strips.compliance.shape[1], np.inf
    for i in range(size):
        room.saddle[i] = room.best[i] = y[at + i]
    end_frame(strips.roots[s], strips.numbers[s], ROOT, y, room.place)
    for turn in range(2):
        for i in range(size):
            y[at + i] = room.saddle[i]
        count = own // 2 - 1
        for i in range(count):
            u, place = (i + 1) / (count + 1), at + 2 * i
            push = (1.0 - 2.0 * turn) * NUDGE * 16.0 * (u * (1.0 - u)) ** 2
            y[place] -= push * room.place[3]
            y[place + 1] += push * room.place[2]
        if _descend(s, at, own, y, strips, shape, local, room, tolerance, counters) == 0:
            energy = _energy_at(s, at, own, y, strips, shape, local, room)
            if energy < least - 1e-9 * abs(energy):
                least = energy
                for i in range(size):
                    room.best[i] = y[at + i]
    for i in range(size):
        y[at + i] = room.best[i]
    return 0 if least < np.inf else -1


@called()
def _advance(y, pose, strips, shape, local, room, tolerance, counters):
    """All strips from y, where they are solved, to the bodies' poses (3 B,); False if one fails."""
    own, modes = 2 * shape.order.size - 6, strips.compliance.shape[1]
    for s in range(strips.roots.size):
        at = pose.size + s * (own + modes)
        for i in range(pose.size):
            y[i] = room.last[i]
        size = _evaluate(s, at, y, strips, shape, local, room)
        counters[EVALUATIONS] += 1
        if condensed(s, own, size, strips, local) == SINGULAR:
            return False
        place = 0
        for body in (strips.tips[s], strips.roots[s]):
            if body >= 0:
                for i in range(3):
                    room.change[place + i] = pose[3 * body + i] - room.last[3 * body + i]
                place += 3
        _move(0.0, s, at, own, y, strips, local, room)
        for i in range(pose.size):
            y[i] = pose[i]
        negative = _correct(s, at, own, y, strips, shape, local, room, tolerance, counters)
        if negative < 0:  # too far for Newton: from the strip as it was, downhill
            for i in range(at, at + own + modes):
                y[i] = room.last[i]
            negative = _descend(s, at, own, y, strips, shape, local, room, tolerance, counters)
        elif negative > 0:
            negative = _settle(s, at, own, y, strips, shape, local, room, tolerance, counters)
        if negative < 0:
            return False
    return True


@called()
def _parts_of(before, pose, strips, room):
    """Into how many parts the way from one set of poses to another is cut before it is tried."""
    longest = 0.0
    for s in range(strips.roots.size):
        for end in range(2):
            body = strips.tips[s] if end else strips.roots[s]
            frame = TIP if end else ROOT
            end_frame(body, strips.numbers[s], frame, before, room.place)
            x, y = room.place[0], room.place[1]
            end_frame(body, strips.numbers[s], frame, pose, room.place)
            longest = max(longest, math.hypot(room.place[0] - x, room.place[1] - y) / LONGEST_SHIFT)
    for i in range(2, pose.size, 3):
        longest = max(longest, abs(pose[i] - before[i]) / LONGEST_TURN)
    return max(1.0, math.ceil(longest))


@kernel()
def hold(y, target, goal, strips, shape, local, room, tolerance, counters):
    """Move the bodies to the poses ``target`` (3 B,) and solve the strips there.

    y holds a solved state and is replaced by the new one; where no equilibrium is found it is left as
    it was. goal (3 B,): scratch. Returns the fraction of the way that was solved.
    """
    copy(y, room.start)
    copy(y, room.last)
    done = 0.0
    step = 1.0 / _parts_of(room.start, target, strips, room)
    while done < 1.0:
        step = min(step, 1.0 - done)
        at = 1.0 if 1.0 - done - step < 1e-9 else done + step
        for i in range(target.size):
            goal[i] = target[i] if at == 1.0 else room.start[i] + at * (target[i] - room.start[i])
        if _advance(y, goal, strips, shape, local, room, tolerance, counters):
            done = at
            copy(y, room.last)
            step *= 2.0
            continue
        copy(room.last, y)
        counters[HALVED] += 1
        step *= 0.5
        if step < SMALLEST_PART or counters[ITERATIONS] > MOST_WORK:
            copy(room.start, y)
            return done
    return 1.0
