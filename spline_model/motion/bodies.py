"""What acts on bodies over a time step: springs, dampers between them, followers, and frames that they carry.

Rotations change by the Cayley variable c = 2 tan(dphi / 2).
"""

from __future__ import annotations

import math

from spline_model.effects.boundary import FOLLOWER
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
    """Changes of carried frames over a step by those of their bodies, as the ends of strips go with theirs.

    arms: derivative of a frame's change, over the step and at its end, and its lever at the end.
    """
    dy = work.dy
    for f in range(masses.frames.shape[0]):
        frame, body, arm = masses.frames[f, 0], masses.frames[f, 1], work.arms[f]
        x, y, c = masses.lever[f, 0], masses.lever[f, 1], dy[body + 2]
        before, after = state.y[body + 2], state.y[body + 2] + 2.0 * math.atan(0.5 * c)
        cos, sin, slope = math.cos(before), math.sin(before), 1.0 / (1.0 + 0.25 * c * c)
        x0, y0 = cos * x - sin * y, sin * x + cos * y
        cos, sin = math.cos(after), math.sin(after)
        x1, y1 = cos * x - sin * y, sin * x + cos * y
        arm[0], arm[1], arm[2], arm[3] = -0.5 * (y0 + y1), 0.5 * (x0 + x1), -slope * y1, slope * x1
        arm[4], arm[5] = x1, y1
        dy[frame], dy[frame + 1] = dy[body] + c * arm[0], dy[body + 1] + c * arm[1]


@part()
def fold_frames(masses, work):
    """Add what acts on carried frames, and its derivatives, to their bodies."""
    raw, reduced, tangent = work.residual, work.reduced, work.tangent
    for f in range(masses.frames.shape[0]):
        frame, body, arm = masses.frames[f, 0], masses.frames[f, 1], work.arms[f]
        turn, fx, fy = body + 2, raw[frame], raw[frame + 1]
        for k in range(2):
            raw[body + k] += raw[frame + k]
            raw[turn] += arm[k] * raw[frame + k]
            reduced[body + k] += reduced[frame + k]
            reduced[turn] += arm[k] * reduced[frame + k]
            for j in range(reduced.size):
                tangent[body + k, j] += tangent[frame + k, j]
                tangent[turn, j] += arm[k] * tangent[frame + k, j]
        for k in range(2):
            for i in range(reduced.size):
                tangent[i, body + k] += tangent[i, frame + k]
                tangent[i, turn] += arm[k + 2] * tangent[i, frame + k]
        slope = 1.0 / (1.0 + 0.25 * work.dy[turn] * work.dy[turn])
        tangent[turn, turn] -= 0.5 * slope * (arm[4] * fx + arm[5] * fy)
