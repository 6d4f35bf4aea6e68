"""The energy-consistent time step on reduced coordinates: residual and Newton's method, compiled.

D^T (M (v1 - v0) / h + DV(q0, q1) + damping - loads) = 0,   (v0 + v1) / 2 = (q1 - q0) / h = D dy / h

Rotations change by the Cayley variable c = 2 tan(dphi / 2).
"""

from __future__ import annotations

import math

from spline_model.effects.boundary import FOLLOWER
from spline_model.frames import fold, fold_tangent, spread
from spline_model.motion.start import factor_of
from spline_model.motion.strip import add_points, condense, move_strip, to_reduced
from spline_model.newton import ROUND_OFF
from spline_model.reduced.assembly import place_of
from spline_model.strip.compiled import called, copy, part
from spline_model.strip.element import ON_POINTS

STEPS, HALVED, NEWTON, FACTORISATIONS, REFUSED, WHOLE = range(6)
"""Places of the counters of a run: STEPS with the parts of halved ones, WHOLE without; REFUSED: why the last
step that was solved is none, or 0."""
FOLDS, SNAPS = 1, 2
"""Why a solved step is refused: a strip folds back, or a massless one would leave its equilibrium."""
MOST_ITERATIONS = 20
MOVED, PER_MOVE, SHARE, SLOPE = range(4)
"""Rows of ``Scratch.moved``: changes of the bodies' coordinates, their derivatives in dy, changes over dy,
and derivatives of these."""
LONGEST_TURN = 1.5
"""Largest turn [rad] that velocities are followed to: the Cayley variable has a pole at a half turn."""


@part()
def _prepare(time, h, state, strips, masses, work):
    """What does not change in a step: inertia, drag and loads on the control points, and loads on bodies."""
    n = masses.points.shape[1]
    for i in range(masses.inertia.size):
        work.load[i] = 0.0
    for s in range(strips.roots.size):
        for i in range(n):
            x = y = 0.0
            for j in range(n):
                work.stiff[s, i, j] = 2.0 / (h * h) * masses.points[s, i, j] + masses.damping[s, i, j] / h
                x += masses.points[s, i, j] * state.velocity[s, 2 * j]
                y += masses.points[s, i, j] * state.velocity[s, 2 * j + 1]
            work.steady[s, 2 * i] = -strips.numbers[s, ON_POINTS + 2 * i] - 2.0 / h * x
            work.steady[s, 2 * i + 1] = -strips.numbers[s, ON_POINTS + 2 * i + 1] - 2.0 / h * y
    for f in range(masses.load_at.size):
        work.follow[f] = load_at(f, time + 0.5 * h, masses)
        if masses.loads.turns[f] != FOLLOWER:
            work.load[masses.load_at[f]] += work.follow[f]


@part()
def load_at(f, time, acts):
    """Return the value of a load at an instant [s]; acts: what has tables of loads and drives."""
    return acts.loads.value[f] * factor_of(f, time, acts.loads)


@part()
def _driven_to(d, time, acts):
    """Where a drive holds its coordinate at an instant [s]."""
    return acts.drives.origin[d] + factor_of(d, time, acts.drives) * acts.drives.target[d]


@part()
def _turn_bodies(dy, moved):
    """Changes of the bodies' coordinates by dy, and what these are over dy."""
    for i in range(moved.shape[1]):
        c = dy[i]
        moved[MOVED, i], moved[PER_MOVE, i], moved[SHARE, i], moved[SLOPE, i] = c, 1.0, 1.0, 0.0
        if i % 3 == 2:
            moved[MOVED, i], moved[PER_MOVE, i] = 2.0 * math.atan(0.5 * c), 1.0 / (1.0 + 0.25 * c * c)
            if c * c < 1e-8:  # the series is exact to round-off here
                moved[SHARE, i], moved[SLOPE, i] = 1.0 - c * c / 12.0, -c / 6.0
            else:
                moved[SHARE, i] = moved[MOVED, i] / c
                moved[SLOPE, i] = (moved[PER_MOVE, i] - moved[SHARE, i]) / c


@part()
def _add_bodies(h, state, bodies, masses, work):
    """Residual and tangent of the bodies alone.

    Springs act at the mean of the step, where their work is their gain of energy.
    """
    dy, raw, tangent, moved = work.dy, work.residual, work.tangent, work.moved
    for i in range(masses.inertia.size):
        mean, push, share = dy[i] / h, work.load[i], moved[SHARE, i]
        for j in range(bodies.springs.shape[0] if i < bodies.springs.shape[0] else 0):
            k = bodies.springs[i, j]
            push -= k * (state.y[j] - bodies.rest[j] + 0.5 * moved[MOVED, j])
            tangent[i, j] += 0.5 * share * k * moved[PER_MOVE, j]
        raw[i] = 2.0 / h * masses.inertia[i] * (mean - state.rate[i]) + masses.drag[i] * mean
        raw[i] -= bodies.weight[i] + share * push
        tangent[i, i] += 2.0 / (h * h) * masses.inertia[i] + masses.drag[i] / h - push * moved[SLOPE, i]
        for j in range(masses.across.shape[0] if i < masses.across.shape[0] else 0):
            raw[i] += masses.across[i, j] * dy[j] / h
            tangent[i, j] += masses.across[i, j] / h


@part()
def _add_followers(state, masses, work):
    """Forces that turn with bodies, as these stand amid the step; parts of one are a load and the next."""
    for i in range(work.turned.size):
        work.turned[i] = 0.0
    for f in range(0, masses.load_at.size - 1):
        at = masses.load_at[f]
        if masses.loads.turns[f] == FOLLOWER and at % 3 == 0:
            angle = state.y[at + 2] + 0.5 * work.moved[MOVED, at + 2]
            cos, sin, share = math.cos(angle), math.sin(angle), 0.5 * work.moved[PER_MOVE, at + 2]
            x, y = (
                cos * work.follow[f] - sin * work.follow[f + 1],
                sin * work.follow[f] + cos * work.follow[f + 1],
            )
            work.turned[at] += x
            work.turned[at + 1] += y
            work.tangent[at, at + 2] += share * y
            work.tangent[at + 1, at + 2] -= share * x
    for i in range(work.turned.size):
        work.residual[i] -= work.turned[i]


@part()
def _carry_frames(state, masses, work):
    """Changes of frames over a step by those of their bodies, as the ends of strips go with theirs.

    arms: of the change over the step; ends: of its derivative at the end.
    """
    frames, arms, ends = masses.frames, work.arms, work.ends
    for f in range(frames.place.shape[0]):
        at, turn, x, y = frames.place[f, 0], frames.place[f, 1] + 2, frames.lever[f, 0], frames.lever[f, 1]
        if turn < 2:
            continue
        before, slope = state.y[turn], work.moved[PER_MOVE, turn]
        after = before + work.moved[MOVED, turn]
        x1, y1 = math.cos(after) * x - math.sin(after) * y, math.sin(after) * x + math.cos(after) * y
        arms[at] = 0.5 * (math.cos(before) * x - math.sin(before) * y + x1)
        arms[at + 1] = 0.5 * (math.sin(before) * x + math.cos(before) * y + y1)
        ends[at], ends[at + 1] = slope * x1, slope * y1
    spread(work.dy, frames, arms)


@part()
def _fold_frames(masses, work):
    """Fold what acts on frames, and its derivatives, on their bodies."""
    frames, ends = masses.frames, work.ends
    for f in range(frames.place.shape[0]):
        at = frames.place[f, 0]
        ends[at + 2] = 0.5 * (ends[at] * work.residual[at] + ends[at + 1] * work.residual[at + 1])
    fold(work.residual, frames, work.arms)
    fold(work.reduced, frames, work.arms)
    fold_tangent(work.tangent, 0.0, frames, work.arms, ends)


@part()
def _add_strip(s, h, state, arrays, masses, work):
    """Residual of a strip, and what it does to the bodies with its own coordinates condensed."""
    strips, shape, local, poses = arrays.strips, arrays.shape, arrays.local, masses.inertia.size
    n, modes = masses.points.shape[1], strips.compliance.shape[1]
    own = 2 * n - 6
    at, behind, dy, raw = poses + s * (own + modes), poses + s * masses.outer, work.dy, work.residual
    tip, root = strips.tips[s], strips.roots[s]
    move_strip(s, at, state, strips, local, work)
    force, move = work.force[s], work.move[s]
    for i in range(n):
        x, y = work.steady[s, 2 * i], work.steady[s, 2 * i + 1]
        for j in range(n):
            x += work.stiff[s, i, j] * move[2 * j]
            y += work.stiff[s, i, j] * move[2 * j + 1]
        force[2 * i], force[2 * i + 1] = x, y
    add_points(s, dy[at + own : at + own + modes], h, state, shape, strips, masses, local, work)
    size, g, hessian = to_reduced(s, strips, work), work.g[s], work.h[s]
    for i in range(own):
        raw[at + i] = g[i]
    for k in range(modes):
        raw[at + own + k] = local.gap[s, k]
    for i in range(own, size):
        raw[place_of(i - own, tip, root, behind)] += g[i]
    size = condense(s, size, strips, masses, local, work)
    for i in range(own, size):
        row = place_of(i - own, tip, root, behind)
        work.reduced[row] += g[i]
        for j in range(own, size):
            work.tangent[row, place_of(j - own, tip, root, behind)] += hessian[i, j]


@called()
def _assemble(h, state, arrays, masses, work):
    """Return the residual of the step dy, and its tangent at the bodies with the strips condensed; the
    largest residual.

    In EI/L^2, EI/L and L, by the places of y; those of held coordinates are what holds them and do not count.
    """
    poses, raw, norm = masses.inertia.size, work.residual, 0.0
    for i in range(work.reduced.size):
        work.reduced[i] = 0.0
        for j in range(work.reduced.size):
            work.tangent[i, j] = 0.0
    _turn_bodies(work.dy, work.moved)
    if masses.frames.place.size > 0:
        _carry_frames(state, masses, work)
        _turn_bodies(work.dy, work.moved)
    for i in range(work.dy.size):
        work.y[i] = state.y[i] + (work.moved[MOVED, i] if i < poses else work.dy[i])
    _add_bodies(h, state, arrays.bodies, masses, work)
    _add_followers(state, masses, work)
    copy(raw[:poses], work.reduced)
    for s in range(arrays.strips.roots.size):
        _add_strip(s, h, state, arrays, masses, work)
    _fold_frames(masses, work)
    for i in range(raw.size):
        if i >= poses or work.held[i] == 0:
            norm = max(norm, abs(raw[i])) if raw[i] == raw[i] else math.inf
    return norm


@called()
def solve_rows(count, matrix, x):
    """Solve the leading (count, count) system in place, with partial pivoting; False if it is singular."""
    for i in range(count):
        best = i
        for j in range(i + 1, count):
            if abs(matrix[j, i]) > abs(matrix[best, i]):
                best = j
        if not abs(matrix[best, i]) > 0.0:
            return False
        if best != i:
            for c in range(i, count):
                matrix[i, c], matrix[best, c] = matrix[best, c], matrix[i, c]
            x[i], x[best] = x[best], x[i]
        inverse = 1.0 / matrix[i, i]
        for j in range(i + 1, count):
            factor = matrix[j, i] * inverse
            if factor != 0.0:
                x[j] -= factor * x[i]
                for c in range(i + 1, count):
                    matrix[j, c] -= factor * matrix[i, c]
    for i in range(count - 1, -1, -1):
        for c in range(i + 1, count):
            x[i] -= matrix[i, c] * x[c]
        x[i] /= matrix[i, i]
    return True


@called()
def _improve(strips, masses, local, work):
    """Newton's correction of dy from the assembled step; its size but for axial forces, or -1 if singular.

    The residual becomes the bodies' correction; held coordinates have none.
    """
    poses, modes, own, size = masses.inertia.size, strips.compliance.shape[1], work.line.size - 6, 0.0
    outer, dy, tangent, x = masses.outer, work.dy, work.tangent, work.reduced
    for i in range(x.size):
        x[i] = -x[i]
    for i in range(poses):
        if work.held[i] == 1:
            for j in range(x.size):
                tangent[i, j] = tangent[j, i] = 0.0
            tangent[i, i], x[i] = 1.0, 0.0
    if not solve_rows(x.size, tangent, x):
        return -1.0
    for i in range(poses):
        dy[i] += x[i]
        size = max(size, abs(x[i]))
    spread(x, masses.frames, work.ends)
    for s in range(strips.roots.size):
        at, tip, root = poses + s * (own + modes), strips.tips[s], strips.roots[s]
        ends = own + (3 if tip >= 0 else 0) + (3 if root >= 0 else 0)
        g, h, change, right = work.g[s], work.h[s], work.change, work.right[s]
        for i in range(own, ends + outer):
            change[i] = x[place_of(i - own, tip, root, poses + s * outer)]
        for i in range(own - 1, -1, -1):
            total = -g[i]
            for j in range(i + 1, ends + outer):
                total -= h[i, j] * change[j]
            change[i] = total / h[i, i]
            dy[at + i] += change[i]
            size = max(size, abs(change[i]))
        for k in range(modes):
            if k < outer:
                dy[at + own + k] += change[ends + k]
            else:
                strain = local.gap[s, k]
                for j in range(ends):
                    strain += right[k, j] * change[j]
                dy[at + own + k] += masses.gain[s, k] * strain
    return size


@part()
def _cayley(turn):
    """Return the Cayley variable of a turn [rad], or of the longest one."""
    return 2.0 * math.tan(0.5 * max(-LONGEST_TURN, min(LONGEST_TURN, turn)))


@part()
def _guess_step(h, state, strips, masses, work):
    """Initial dy from velocities and accelerations over a time h; none, but for the axial forces, over 0."""
    poses, modes, dy = masses.inertia.size, strips.compliance.shape[1], work.dy
    own = work.line.size - 6
    for i in range(poses):
        dy[i] = h * (state.rate[i] + 0.5 * h * state.push[i])
        if i % 3 == 2:
            dy[i] = _cayley(dy[i])
    for s in range(strips.roots.size):
        at, move, ends = poses + s * (own + modes), work.move[s], state.map[s]
        for i in range(move.size):
            move[i] = h * (state.velocity[s, i] + 0.5 * h * state.acceleration[s, i])
        for i in range(own - 2):
            dy[at + i] = move[i]
        for e in range(2):
            body, inner, outer = strips.tips[s] if e else strips.roots[s], own - 2 + 2 * e, own + 4 - 2 * e
            reach, tx, ty = state.y[at + own - 2 + e], ends[2 * e], ends[2 * e + 1]
            cx = reach * tx + move[inner] - move[outer]
            cy = reach * ty + move[inner + 1] - move[outer + 1]
            square, along = tx * tx + ty * ty, tx * cx + ty * cy
            if body >= masses.free_from:  # the chord turns as it likes
                turn = math.atan2(tx * cy - ty * cx, along)
                dy[3 * body], dy[3 * body + 1] = move[outer], move[outer + 1]
                dy[3 * body + 2] = _cayley(turn)
                along = math.sqrt((cx * cx + cy * cy) * square)
            elif body >= 0:
                angle = 2.0 * math.atan(0.5 * dy[3 * body + 2])
                c, d = math.cos(angle), math.sin(angle)
                along = (c * tx - d * ty) * cx + (d * tx + c * ty) * cy
            dy[at + own - 2 + e] = along / square - reach
        for i in range(at + own, at + own + modes):
            dy[i] = state.y[i]


@part()
def newton(time, h, active, state, arrays, masses, tolerance, work, counters):
    """Solve one step for dy; True if the residual came below tolerance, or corrections are round-off.

    Where the way that velocities lead to ends in none, the step begins where the last one ended. Of parts
    whose mass is next to none velocities say nothing: they ring about the equilibrium that the parts follow.
    """
    _prepare(time, h, state, arrays.strips, masses, work)
    for ahead in (h, 0.0):
        _guess_step(ahead, state, arrays.strips, masses, work)
        for d in range(masses.drive_at.size):
            if active[d] == 1:
                i = masses.drive_at[d]
                dy = _driven_to(d, time + h, masses) - state.y[i]
                work.dy[i] = 2.0 * math.tan(0.5 * dy) if i % 3 == 2 else dy
        if _corrected(h, state, arrays, masses, tolerance, work, counters):
            return True
    return False


@part()
def _corrected(h, state, arrays, masses, tolerance, work, counters):
    """Correct dy by Newton's method; True if the residual came below tolerance, or corrections are round-off.

    Rotations of more than a quarter turn in one step are refused: the Cayley map has a pole at a half turn.
    """
    before, size, last = math.inf, math.inf, math.inf
    for _ in range(MOST_ITERATIONS):
        norm = _assemble(h, state, arrays, masses, work)
        if not norm < 1e12:
            return False
        rounded = size <= ROUND_OFF and size > 0.5 * last
        if norm <= tolerance or rounded or (norm <= 1e3 * tolerance and norm > 0.5 * before):
            largest = 0.0
            for i in range(2, masses.inertia.size, 3):
                largest = max(largest, abs(work.dy[i]))
            return largest <= 2.0
        before, last = norm, size
        size = _improve(arrays.strips, masses, arrays.local, work)
        if size < 0.0:
            return False
        counters[NEWTON] += 1
        counters[FACTORISATIONS] += 1
    return False
