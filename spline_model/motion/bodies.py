"""What acts on bodies over a time step: springs, dampers between them, followers, and frames that they carry.

Rotations change by the Cayley variable c = 2 tan(dphi / 2).
"""

from __future__ import annotations

import math

from spline_model.effects.boundary import FOLLOWER
from spline_model.frames import fold, fold_tangent, spread
from spline_model.strip.compiled import called, part


@called()
def cayley(c):
    """Return dphi / c for c = 2 tan(dphi / 2), and its derivative in c."""
    square = c * c
    if square < 1e-8:  # the series is exact to round-off here
        return 1.0 - square / 12.0, -c / 6.0
    share = 2.0 * math.atan(0.5 * c) / c
    return share, (1.0 / (1.0 + 0.25 * square) - share) / c


@part()
def turned(f, state, masses, work):
    """Return a follower, whose parts are the f-th load and the next one, as its body stands amid a step."""
    x, y, turn = work.follow[f], work.follow[f + 1], masses.load_at[f] + 2
    angle = state.y[turn] + math.atan(0.5 * work.dy[turn])
    cos, sin = math.cos(angle), math.sin(angle)
    return cos * x - sin * y, sin * x + cos * y


@part()
def add_followers(state, masses, work):
    """Forces that turn with bodies."""
    for f in range(0, masses.load_at.size - 1):
        at = masses.load_at[f]
        if masses.loads.turns[f] == FOLLOWER and at % 3 == 0:
            x, y = turned(f, state, masses, work)
            share = 0.5 / (1.0 + 0.25 * work.dy[at + 2] * work.dy[at + 2])
            work.residual[at] -= x
            work.residual[at + 1] -= y
            work.tangent[at, at + 2] += share * y
            work.tangent[at + 1, at + 2] -= share * x


@part()
def add_springs(h, state, bodies, masses, work):
    """Springs at the mean of a step, where their work is their gain of energy, and dampers between bodies."""
    dy, raw, tangent = work.dy, work.residual, work.tangent
    for i in range(bodies.springs.shape[0]):
        share, slope, pull = 1.0, 0.0, 0.0
        if i % 3 == 2:
            share, slope = cayley(dy[i])
        for j in range(bodies.springs.shape[0]):
            k, move, turn = bodies.springs[i, j], dy[j], 1.0
            if j % 3 == 2:
                move, turn = 2.0 * math.atan(0.5 * dy[j]), 1.0 / (1.0 + 0.25 * dy[j] * dy[j])
            pull += k * (state.y[j] - bodies.rest[j] + 0.5 * move)
            tangent[i, j] += 0.5 * share * k * turn
        raw[i] += share * pull
        tangent[i, i] += slope * pull
    for i in range(masses.across.shape[0]):
        for j in range(masses.across.shape[0]):
            raw[i] += masses.across[i, j] * dy[j] / h
            tangent[i, j] += masses.across[i, j] / h


@part()
def carry_frames(state, masses, work):
    """Changes of frames over a step by those of their bodies, as the ends of strips go with theirs.

    arms: of the change over the step; ends: of its derivative at the end.
    """
    frames, arms, ends = masses.frames, work.arms, work.ends
    for f in range(frames.place.shape[0]):
        at, turn, x, y = frames.place[f, 0], frames.place[f, 1] + 2, frames.lever[f, 0], frames.lever[f, 1]
        if turn < 2:
            continue
        c, before = work.dy[turn], state.y[turn]
        after, slope = before + 2.0 * math.atan(0.5 * c), 1.0 / (1.0 + 0.25 * c * c)
        x1, y1 = math.cos(after) * x - math.sin(after) * y, math.sin(after) * x + math.cos(after) * y
        arms[at] = 0.5 * (math.cos(before) * x - math.sin(before) * y + x1)
        arms[at + 1] = 0.5 * (math.sin(before) * x + math.cos(before) * y + y1)
        ends[at], ends[at + 1] = slope * x1, slope * y1
    spread(work.dy, frames, arms)


@part()
def fold_frames(masses, work):
    """Fold what acts on frames, and its derivatives, on their bodies."""
    frames, ends = masses.frames, work.ends
    for f in range(frames.place.shape[0]):
        at = frames.place[f, 0]
        ends[at + 2] = 0.5 * (ends[at] * work.residual[at] + ends[at + 1] * work.residual[at + 1])
    fold(work.residual, frames, work.arms)
    fold(work.reduced, frames, work.arms)
    fold_tangent(work.tangent, 0.0, frames, work.arms, ends)
