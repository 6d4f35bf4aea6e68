"""A body held in a pose, compiled: each strip is solved alone at the tip pose that the body gives it.

With x, y and theta of the body prescribed, the strips know nothing of each other; one Newton
a strip on its own coordinates remains. A state is followed from the last good one: the tangent
predicts, Newton corrects, a part of the way that fails is halved, and all work is bounded.
A strip that is in equilibrium but unstable (it would buckle out of it) is let go downhill.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from spline_model.checks import SLOWEST_SPEED
from spline_model.fast.condense import condense, recover, recover_rate
from spline_model.fast.path import EVALUATIONS, HALVED, ITERATIONS
from spline_model.fast.strip import evaluate
from spline_model.strip.compiled import FAST

MOST_ITERATIONS = 10
"""Newton iterations at one pose; a part of the way that needs more is halved."""
MOST_WORK = 300
"""Newton iterations of one call over all strips before it is given up."""
SMALLEST_PART = 2.0**-9
LONGEST_TURN = 0.5
"""Rotation of the body in one part of the way [rad]."""
LONGEST_SHIFT = 0.15
"""Shift of a tip in one part of the way, over the strip's length."""
NUDGE = 0.02
"""Sideways push of an unstable strip, over its length."""
DESCENTS = 80
"""Evaluations of one way downhill before it is given up."""
FOLD = 0.3
"""Least |C'| / L on a way downhill: below it the control points fold, and the energy of a kink
between two Gauss points is too low."""


class Room(NamedTuple):
    """Working arrays: tips before and at the pose (3,), change of a tip, of one strip's unknowns, states."""

    tip: NDArray[np.float64]
    change: NDArray[np.float64]
    step: NDArray[np.float64]
    last: NDArray[np.float64]
    here: NDArray[np.float64]
    start: NDArray[np.float64]


@njit(cache=True, nogil=True)
def tip_of(frame, s, pose, tip):
    """Pose (3,) of a strip's tip in its clamp's frame, lengths over L, for the body's pose (3,)."""
    cos_t, sin_t = math.cos(pose[2]), math.sin(pose[2])
    ax = cos_t * frame.arm[s, 0] - sin_t * frame.arm[s, 1]
    ay = sin_t * frame.arm[s, 0] + cos_t * frame.arm[s, 1]
    rx = (pose[0] + ax - frame.root[s, 0]) / frame.length[s]
    ry = (pose[1] + ay - frame.root[s, 1]) / frame.length[s]
    c, d = frame.axis[s, 0], frame.axis[s, 1]
    tip[0], tip[1], tip[2] = c * rx + d * ry, c * ry - d * rx, pose[2]


@njit(cache=True, nogil=True, fastmath=FAST)
def strip_at(w, a, tip, compliance, grid, local):
    """Evaluate one strip at a tip pose (3,); returns bending and axial energy over EI/L and the least
    |C'|."""
    return evaluate(w, a, tip[0], tip[1], math.cos(tip[2]), math.sin(tip[2]), compliance, grid, local)


@njit(cache=True, nogil=True, fastmath=FAST)
def residual_norm(local, own):
    """Largest residual of a strip's own equations, in EI/L^2 and L."""
    norm = 0.0
    for i in range(own):
        norm = max(norm, abs(local.g[i]))
    for k in range(local.gap.size):
        norm = max(norm, abs(local.gap[k]))
    return norm


@njit(cache=True, nogil=True)
def correct(w, a, tip, compliance, grid, local, room, tolerance, counters):
    """Newton of one strip at a tip pose, in place; negative pivots of the solution, or -1 if it fails."""
    own = w.size
    dw, da = room.step[:own], room.step[own:]
    room.change[:] = 0.0
    before = np.inf
    for _ in range(MOST_ITERATIONS + 1):
        slowest = strip_at(w, a, tip, compliance, grid, local)[2]
        counters[EVALUATIONS] += 1
        norm = residual_norm(local, own)
        if not norm < 1e12:
            return -1
        negative = condense(local, compliance, own)
        if negative < 0:
            return -1
        if norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            forward = w[0] > 0.0 and w[own - 1] > 0.0 and slowest > SLOWEST_SPEED
            return negative if forward else -1
        before = norm
        recover(local, compliance, own, room.change, dw, da)
        w += dw
        a += da
        counters[ITERATIONS] += 1
    return -1


@njit(cache=True, nogil=True)
def energy_at(w, a, tip, compliance, grid, local):
    """Strain energy of a strip over EI/L with the axial forces a made to follow w; inf for a fold."""
    energy, _, slowest = strip_at(w, a, tip, compliance, grid, local)
    for k in range(a.size):
        a[k] += local.gap[k] * (2 * k + 1) / compliance[k]
        energy += 0.5 * compliance[k] * a[k] * a[k] / (2 * k + 1)
    if not min(slowest, min(w[0], w[w.size - 1])) > FOLD:
        return np.inf
    return energy


@njit(cache=True, nogil=True)
def descend(w, a, tip, compliance, grid, local, room, tolerance, counters):
    """From any w downhill to a stable equilibrium: Newton with a shift on the diagonal that keeps it so."""
    own = w.size
    dw, da = room.step[:own], room.step[own:]
    trial = np.empty(own)
    room.change[:] = 0.0
    energy, shift = energy_at(w, a, tip, compliance, grid, local), 0.0
    for _ in range(DESCENTS):
        strip_at(w, a, tip, compliance, grid, local)
        counters[EVALUATIONS] += 1
        for i in range(own):
            local.h[i, i] += shift
        if condense(local, compliance, own) != 0:
            shift = max(10.0, 4.0 * shift)
            continue
        recover(local, compliance, own, room.change, dw, da)
        counters[ITERATIONS] += 1
        trial[:] = w
        w += dw
        lower = energy_at(w, a, tip, compliance, grid, local)
        if lower <= energy + 1e-12 * abs(energy):
            done = abs(energy - lower) <= 1e-9 * abs(energy) and shift == 0.0
            energy, shift = lower, (0.0 if shift < 20.0 else 0.25 * shift)
            if done:
                return correct(w, a, tip, compliance, grid, local, room, tolerance, counters)
            continue
        w[:] = trial
        energy_at(w, a, tip, compliance, grid, local)
        shift = max(10.0, 4.0 * shift)
    return -1


@njit(cache=True, nogil=True)
def settle(w, a, tip, compliance, grid, local, room, tolerance, counters):
    """From an unstable equilibrium to a stable one beside it, the lower of both sides; 0 if found."""
    own = w.size
    saddle_w, saddle_a, best_w, best_a = w.copy(), a.copy(), w.copy(), a.copy()
    best = np.inf
    for side in (1.0, -1.0):
        w[:], a[:] = saddle_w, saddle_a
        count = own // 2 - 1
        for i in range(count):
            u = (i + 1) / (count + 1)
            w[2 * i + 2] += side * NUDGE * 16.0 * (u * (1.0 - u)) ** 2
        if descend(w, a, tip, compliance, grid, local, room, tolerance, counters) == 0:
            energy = energy_at(w, a, tip, compliance, grid, local)
            if energy < best - 1e-9 * abs(energy):
                best = energy
                best_w[:], best_a[:] = w, a
    w[:], a[:] = best_w, best_a
    return 0 if best < np.inf else -1


@njit(cache=True, nogil=True)
def advance(y, before, pose, frame, grid, locals_, room, tolerance, counters):
    """All strips from the body's pose ``before``, where y is solved, to ``pose``; False if one fails."""
    strips, modes = frame.length.size, frame.compliance.shape[1]
    own = (y.size - 2) // strips - modes
    for s in range(strips):
        at, local, compliance = 2 + s * (own + modes), locals_[s], frame.compliance[s]
        w, a = y[at : at + own], y[at + own : at + own + modes]
        dw, da = room.step[:own], room.step[own:]
        tip_of(frame, s, before, room.tip)
        x, z, phi = room.tip[0], room.tip[1], room.tip[2]
        strip_at(w, a, room.tip, compliance, grid, local)
        counters[EVALUATIONS] += 1
        if condense(local, compliance, own) < 0:
            return False
        tip_of(frame, s, pose, room.tip)
        room.change[0], room.change[1], room.change[2] = room.tip[0] - x, room.tip[1] - z, room.tip[2] - phi
        recover_rate(local, compliance, own, room.change, dw, da)
        w += dw
        a += da
        negative = correct(w, a, room.tip, compliance, grid, local, room, tolerance, counters)
        if negative < 0:  # too far for Newton: from the strip as it was, downhill
            w[:], a[:] = room.last[at : at + own], room.last[at + own : at + own + modes]
            negative = descend(w, a, room.tip, compliance, grid, local, room, tolerance, counters)
        elif negative > 0:
            negative = settle(w, a, room.tip, compliance, grid, local, room, tolerance, counters)
        if negative < 0:
            return False
    y[0], y[1] = pose[0] / frame.length[0], pose[1] / frame.length[0]
    return True


@njit(cache=True, nogil=True)
def parts_of(before, pose, frame):
    """Into how many parts the way from one pose to another is cut before it is tried."""
    longest = 0.0
    first, second = np.empty(3), np.empty(3)
    for s in range(frame.length.size):
        tip_of(frame, s, before, first)
        tip_of(frame, s, pose, second)
        longest = max(longest, math.hypot(second[0] - first[0], second[1] - first[1]) / LONGEST_SHIFT)
    return max(1.0, math.ceil(max(longest, abs(pose[2] - before[2]) / LONGEST_TURN)))


@njit(cache=True, nogil=True)
def hold(y, pose, target, frame, grid, locals_, room, tolerance, counters):
    """Move the body from ``pose`` to ``target`` (3,) [m, m, rad] and solve the strips there.

    y and pose hold a solved state and are replaced by the new one; where no equilibrium is
    found they are left as they were. Returns the fraction of the way that was solved.
    """
    room.start[:], room.last[:] = y, y
    done, last = 0.0, pose.copy()
    step = 1.0 / parts_of(pose, target, frame)
    while done < 1.0:
        step = min(step, 1.0 - done)
        goal = 1.0 if 1.0 - done - step < 1e-9 else done + step
        for i in range(3):
            room.here[i] = target[i] if goal == 1.0 else pose[i] + goal * (target[i] - pose[i])
        if advance(y, last, room.here, frame, grid, locals_, room, tolerance, counters):
            done = goal
            last[:], room.last[:] = room.here, y
            step *= 2.0
            continue
        y[:] = room.last
        counters[HALVED] += 1
        step *= 0.5
        if step < SMALLEST_PART or counters[ITERATIONS] > MOST_WORK:
            y[:] = room.start
            return done
    pose[:] = target
    return 1.0
