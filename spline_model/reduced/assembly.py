"""All strips condensed and gathered at the bodies, and the bodies' linear system."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.strip.compiled import kernel, part
from spline_model.strip.condense import SINGULAR, condense, condense_coupled, recover
from spline_model.strip.element import place_points, to_element
from spline_model.strip.laws import MATERIAL
from spline_model.strip.points import evaluate_points

Array = NDArray[np.float64]

BENDING, AXIAL, DEAD, SLOWEST, NEGATIVE = range(5)
"""Places of what ``assemble`` sums up: energies in EI/L, least v / J0, negative pivots of the strips."""
KNOWN = 4
"""States and rates that the next one is predicted from: of five, round-off would outgrow what they add."""


class Bodies(NamedTuple):
    """B bodies, free strip ends among them, and what acts on them; coordinates x, y over L and theta.

    rest (3 B,); load (Q,) generalised force at load factor 1; weight (Q,) at any, Q = 3 B and one more
    for each strip whose mean axial force stands beside the bodies; free (F,) and held (D,) of these;
    driven: place among the held ones of the rotation whose torque is asked for, or -1.
    """

    rest: Array
    load: Array
    weight: Array
    free: NDArray[np.int64]
    held: NDArray[np.int64]
    driven: int


class Space(NamedTuple):
    """Working arrays of a path: y, its rate and prediction, known states; the bodies' system."""

    tangent: Array
    force: Array
    raw: Array
    factors: Array
    change: Array
    move: Array
    ends: Array
    known_at: Array
    known_y: Array
    known_rate: Array
    y: Array
    rate: Array
    predicted: Array
    out: Array
    reaction: Array
    reaction_rate: Array


def working_space(bodies: Bodies, size: int) -> Space:
    """Arrays for that many unknowns."""
    q, f, d = bodies.load.size, bodies.free.size, bodies.held.size
    return Space(
        tangent=np.zeros((q, q)),
        force=np.zeros(q),
        raw=np.zeros(q),
        factors=np.zeros((f, f)),
        change=np.zeros(f),
        move=np.zeros(q),
        ends=np.zeros(7),
        known_at=np.zeros(KNOWN),
        known_y=np.zeros((KNOWN, size)),
        known_rate=np.zeros((KNOWN, size)),
        y=np.zeros(size),
        rate=np.zeros(size),
        predicted=np.zeros(size),
        out=np.zeros(5),
        reaction=np.zeros(d),
        reaction_rate=np.zeros(d),
    )


@kernel()
def place_of(i, body_tip, body_root, outer):
    """The bodies' unknown that a strip's i-th outer coordinate is: of its tip, its root or its mean force."""
    tip = body_tip >= 0
    if tip and i < 3:
        return 3 * body_tip + i
    if body_root >= 0 and i < 3 * tip + 3:
        return 3 * body_root + i - 3 * tip
    return outer


@kernel()
def scatter(first, size, tip, root, outer, g, h, force, tangent):
    """Add a condensed strip's force and upper tangent, from the coordinate ``first`` on, to the bodies'."""
    for i in range(first, size):
        row = place_of(i - first, tip, root, outer)
        force[row] += g[i]
        for j in range(i, size):
            column = place_of(j - first, tip, root, outer)
            value = h[i, j]
            if row == column and i != j:  # a strip from a body to itself
                value *= 2.0
            tangent[min(row, column), max(row, column)] += value


@part()
def element_of(s, at, y, strips, shape, local, out):
    """Evaluate strip s, whose w and a begin at y[at], in its element coordinates; returns their number."""
    n, modes, inner = shape.order.size, strips.compliance.shape[1], strips.coupled - strips.outer
    own, tip, root = 2 * n - 6, strips.tips[s] >= 0, strips.roots[s] >= 0
    moving = n if root else n - 1
    place_points(s, y[at : at + own], y, strips, local)
    evaluate_points(s, y[at + own : at + own + modes], moving, shape, strips, local, out)
    to_element(
        moving,
        inner,
        tip,
        root,
        local.map[s],
        local.gradient[s],
        local.hessian[s],
        local.coupling[s],
        local.g[s],
        local.h[s],
        local.b[s],
        local.square,
        local.lines,
        local.line,
    )
    return own + inner + 3 * tip + 3 * root + strips.outer


@part()
def condensed(s, own, size, strips, local):
    """Condense strip s to its ends; returns its negative pivots, or SINGULAR."""
    g, h, gap = local.g[s], local.h[s], local.gap[s]
    if strips.coupled == 0:
        return condense(own, size, strips.gain[s], g, h, local.b[s], gap)
    return condense_coupled(
        own,
        size,
        strips.coupled,
        strips.outer,
        strips.measure != MATERIAL,
        strips.compliance[s],
        strips.gain[s],
        g,
        h,
        local.b[s],
        local.e[s],
        gap,
        local.gram[s],
    )


@kernel()
def assemble(y, load, bodies, strips, shape, local, space):
    """Condense all strips at y; the bodies' tangent (upper) and force in ``space``.

    y: the bodies' poses, then w and a of each strip. Returns the largest residual of the strips, in
    EI/L^2 and L, or inf for a singular strip; the bodies' own is ``space.raw``.
    """
    out, tangent, force, raw = space.out, space.tangent, space.force, space.raw
    poses, count, modes = bodies.rest.size, strips.roots.size, strips.compliance.shape[1]
    n = shape.order.size
    own, inner = 2 * n - 6, strips.coupled - strips.outer
    out[0] = out[1] = out[2] = out[4] = 0.0
    out[3] = np.inf
    for i in range(force.size):
        force[i] = raw[i] = -load * bodies.load[i] - bodies.weight[i]
        for j in range(i, force.size):
            tangent[i, j] = 0.0
    for i in range(poses):
        out[DEAD] -= bodies.weight[i] * y[i]
    norm = 0.0
    for s in range(count):
        at = poses + s * (own + modes)
        tip, root, last = strips.tips[s] >= 0, strips.roots[s] >= 0, own + inner
        size = element_of(s, at, y, strips, shape, local, out)
        g, h, gap = local.g[s], local.h[s], local.gap[s]
        for i in range(own):
            norm = max(norm, abs(g[i]))
        for k in range(modes):
            norm = max(norm, abs(gap[k]))
        if tip:
            for i in range(3):
                raw[3 * strips.tips[s] + i] += g[last + i]
        if root:
            for i in range(3):
                raw[3 * strips.roots[s] + i] += g[last + 3 * tip + i]
        negative = condensed(s, own, size, strips, local)
        if negative == SINGULAR:
            return np.inf
        out[NEGATIVE] += negative
        scatter(last, size, strips.tips[s], strips.roots[s], poses + s, g, h, force, tangent)
    return norm


@kernel()
def factorise(free, tangent, factors, outer):
    """L D L^T of the free part of the bodies' tangent; returns its negative pivots, or SINGULAR.

    outer: mean axial forces in it, each of which has a negative pivot that does not count.
    """
    negative = -outer
    for i in range(free.size):
        for j in range(i, free.size):
            factors[i, j] = tangent[min(free[i], free[j]), max(free[i], free[j])]
    for i in range(free.size):
        d = factors[i, i]
        if d == 0.0:
            return SINGULAR
        if d < 0.0:
            negative += 1
        for j in range(i + 1, free.size):
            factor = factors[i, j] / d
            for k in range(j, free.size):
                factors[j, k] -= factor * factors[i, k]
    return negative


@kernel()
def solve_free(factors, x):
    """Solve for the free coordinates in place: the right-hand side is x (F,)."""
    count = x.size
    for i in range(count):
        x[i] /= factors[i, i]
        for j in range(i + 1, count):
            x[j] -= factors[i, j] * x[i]
    for i in range(count - 1, -1, -1):
        for j in range(i + 1, count):
            x[i] -= factors[i, j] / factors[i, i] * x[j]


@part()
def move_strips(share, bodies, strips, shape, local, space, out):
    """w and a of all strips for the bodies' change ``space.move`` (3 B,), into out (Y,)."""
    n, modes, poses = shape.order.size, strips.compliance.shape[1], bodies.rest.size
    own, inner = 2 * n - 6, strips.coupled - strips.outer
    for s in range(strips.roots.size):
        at = poses + s * (own + modes)
        tip, root = strips.tips[s] >= 0, strips.roots[s] >= 0
        ends = 3 * tip + 3 * root + strips.outer
        for i in range(ends):
            space.ends[i] = space.move[place_of(i, strips.tips[s], strips.roots[s], poses + s)]
        dw, da = out[at : at + own], out[at + own : at + own + modes]
        recover(
            own,
            own + inner + ends,
            share,
            strips.coupled,
            strips.outer,
            strips.gain[s],
            local.g[s],
            local.h[s],
            local.b[s],
            local.gap[s],
            space.ends,
            dw,
            da,
        )


@part()
def moment_defect(y, strips, shape, local):
    """Energy of what the strips' moments differ from balance by, twice, and twice their bending energy.

    The balance starts from the force and moment of the clamp at the tip and has the dead load
    beyond each point: int (M - M_b)^2 / EI ds with M_b linear in the curve's points.
    """
    n = shape.order.size
    wrong = stored = 0.0
    tip, inner = n - 2, n - 3
    for s in range(strips.roots.size):
        points, gradient, lever = local.points[s], local.gradient[s], local.lever
        fx = gradient[2 * tip] + gradient[2 * inner]
        fy = gradient[2 * tip + 1] + gradient[2 * inner + 1]
        x, y0 = points[2 * tip], points[2 * tip + 1]
        bx, by = points[2 * inner] - x, points[2 * inner + 1] - y0
        moment = bx * gradient[2 * inner + 1] - by * gradient[2 * inner]
        qx, qy = strips.weight[s, 0], strips.weight[s, 1]
        for i in range(n):
            lever[i] = (x - points[2 * i]) * fy - (y0 - points[2 * i + 1]) * fx + moment
        for p in range(shape.weight.size):
            left, cx, cy, ax, ay = local.moment[s, p], 0.0, 0.0, 0.0, 0.0
            for i in range(n):
                left -= shape.d0[p, i] * lever[i]
                cx += shape.d0[p, i] * points[2 * i]
                cy += shape.d0[p, i] * points[2 * i + 1]
                ax += shape.beyond[p, i] * points[2 * i]
                ay += shape.beyond[p, i] * points[2 * i + 1]
            far = 1.0 - shape.u[p]
            left -= (ax - far * cx) * qy - (ay - far * cy) * qx
            if strips.rigidity[s, p] > 0.0:
                ds = shape.weight[p] * strips.speed[s, p] / strips.rigidity[s, p]
                wrong += ds * left * left
                stored += ds * local.moment[s, p] ** 2
    return wrong, stored


@part()
def root_of(wrong, stored, smallest):
    """The moment defect from the two energies."""
    return math.sqrt(wrong / (stored + smallest * smallest))
