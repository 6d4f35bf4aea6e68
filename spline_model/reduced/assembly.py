"""All strips condensed and gathered at the bodies, and the bodies' linear system."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.frames import carry, fold, fold_tangent, spread
from spline_model.reduced.arrays import (
    ARMS,
    AXIAL,
    BENDING,
    DEAD,
    ENDS,
    FORCE,
    MOVE,
    NEGATIVE,
    RAW,
    SLOWEST,
)
from spline_model.strip.compiled import called, part
from spline_model.strip.condense import SINGULAR, condense, recover
from spline_model.strip.element import (
    BEYOND,
    GRADIENT,
    LAST,
    LEVER,
    MOMENT_AT,
    PER_U,
    POINTS,
    RIGIDITY,
    SPEED,
    VALUE,
    WEIGHT,
    WHERE,
)
from spline_model.strip.ends import place_points, to_element
from spline_model.strip.points import evaluate_points

Array = NDArray[np.float64]


@part()
def place_of(i, body_tip, body_root, outer):
    """Return the bodies' unknown that a strip's i-th outer coordinate is: of its tip, its root or an outer
    force."""
    tip = body_tip >= 0
    if tip and i < 3:
        return 3 * body_tip + i
    if body_root >= 0 and i < 3 * tip + 3:
        return 3 * body_root + i - 3 * tip
    return outer + i - 3 * tip - 3 * (body_root >= 0)


@part()
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
def _element_of(s, at, y, strips, shape, local, out):
    """Evaluate strip s, whose w and a begin at y[at], in its element coordinates; returns their number."""
    n, modes, inner = shape.order.size, strips.compliance.shape[1], strips.coupled - strips.outer
    own, moving = 2 * n - 6, n if strips.roots[s] >= 0 else n - 1
    place_points(s, y[at : at + own], y, strips, local)
    evaluate_points(s, y[at + own : at + own + modes], moving, shape, strips, local, out)
    return to_element(s, moving, inner, strips, local) + strips.outer


@part()
def condensed(s, own, size, strips, local):
    """Condense strip s to its ends; returns its negative pivots, or SINGULAR."""
    h, gap, modes = local.reduced[s], local.gap[s], strips.compliance.shape[1]
    g, b = h[LAST], h[h.shape[1] : h.shape[1] + modes]
    return condense(
        own, size, strips.coupled, strips.outer, strips.compliance[s], strips.gain[s], g, h, b, gap
    )


@part()
def begin(y, load, bodies, space):
    """Frames, what acts on the bodies, into FORCE and RAW, and sums of energies that have nothing in them."""
    out, force, raw = space.out, space.vectors[FORCE], space.vectors[RAW]
    out[BENDING] = out[AXIAL] = out[DEAD] = 0.0
    out[SLOWEST] = np.inf
    for i in range(bodies.load.size):
        force[i] = raw[i] = -load * bodies.load[i] - bodies.weight[i]
    if bodies.frames.place.size > 0:
        carry(y, bodies.frames, space.vectors[ARMS])
    for i in range(bodies.rest.size):
        out[DEAD] -= bodies.weight[i] * y[i]
    if bodies.springs.size > 0:
        _add_springs(y, bodies, space)


@called()
def _add_springs(y, bodies, space):
    """Add what springs do to the bodies, and their energy."""
    for i in range(bodies.springs.shape[0]):
        pull = 0.0 * y[i]
        for j in range(bodies.springs.shape[0]):
            pull += bodies.springs[i, j] * (y[j] - bodies.rest[j])
        space.out[DEAD] += 0.5 * pull * (y[i] - bodies.rest[i])
        space.vectors[FORCE, i] += pull
        space.vectors[RAW, i] += pull


@called()
def _stiffen(bodies, space):
    """Begin the tangent with that of springs."""
    for i in range(bodies.springs.shape[0]):
        for j in range(i, bodies.springs.shape[0]):
            space.tangent[i, j] = bodies.springs[i, j]


@part()
def residual_of(s, own, last, strips, local, space):
    """Return the largest residual of strip s; what it does to its bodies is added to RAW."""
    g, gap, tip, root = local.reduced[s, LAST], local.gap[s], strips.tips[s], strips.roots[s]
    norm = 0.0
    for i in range(own):
        norm = max(norm, abs(g[i]))
    for k in range(gap.size):
        norm = max(norm, abs(gap[k]))
    for i in range(last, last + 3 * (tip >= 0) + 3 * (root >= 0)):
        space.vectors[RAW, place_of(i - last, tip, root, 0)] += g[i]
    return norm


@called()
def assemble(y, load, arrays):
    """Condense all strips at y; the bodies' tangent (upper) and force in ``space``.

    y: the bodies' poses, then w and a of each strip. Returns the largest residual of the strips, in
    EI/L^2 and L, or inf for a singular strip; the bodies' own is RAW of ``space``.
    """
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    poses, own = bodies.rest.size, 2 * shape.order.size - 6
    last = own + strips.coupled - strips.outer
    for i in range(bodies.load.size):
        for j in range(i, bodies.load.size):
            space.tangent[i, j] = 0.0
    if bodies.springs.size > 0:
        _stiffen(bodies, space)
    norm, space.out[NEGATIVE] = 0.0, 0.0
    begin(y, load, bodies, space)
    for s in range(strips.roots.size):
        at = poses + s * (own + strips.compliance.shape[1])
        size = _element_of(s, at, y, strips, shape, local, space.out)
        norm = max(norm, residual_of(s, own, last, strips, local, space))
        negative = condensed(s, own, size, strips, local)
        if negative == SINGULAR:
            return np.inf
        space.out[NEGATIVE] += negative
        h = local.reduced[s]
        scatter(
            last, size, strips.tips[s], strips.roots[s], poses + s, h[LAST], h, space.vectors[FORCE],
            space.tangent,
        )  # fmt: skip
    if bodies.frames.place.size > 0:
        _fold(bodies, space)
    return norm


@called()
def _fold(bodies, space):
    """Fold what acts on frames, of which the tangent has no part, on the bodies that carry them."""
    for i in range(bodies.load.size):
        for j in range(i):
            space.tangent[i, j] = space.tangent[j, i]
    arms = space.vectors[ARMS]
    fold(space.vectors[FORCE], bodies.frames, arms)
    fold(space.vectors[RAW], bodies.frames, arms)
    fold_tangent(space.tangent, 0.0, bodies.frames, arms, arms)


@called()
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


@called()
def solve_free(factors, x):
    """Solve for the free coordinates in place: the right-hand side is the beginning of x, (F,)."""
    count = factors.shape[0]
    for i in range(count):
        x[i] /= factors[i, i]
        for j in range(i + 1, count):
            x[j] -= factors[i, j] * x[i]
    for i in range(count - 1, -1, -1):
        for j in range(i + 1, count):
            x[i] -= factors[i, j] / factors[i, i] * x[j]


@part()
def recovered(s, own, share, strips, local, change, dw, da):
    """Changes of a condensed strip's w and a for a change of its ends, in coordinates of the element."""
    h, modes = local.reduced[s], strips.compliance.shape[1]
    width, tip, root = h.shape[1], strips.tips[s] >= 0, strips.roots[s] >= 0
    size = own + strips.coupled + 3 * tip + 3 * root
    recover(
        own, size, share, strips.coupled, strips.outer, strips.gain[s], h[LAST], h, h[width : width + modes],
        local.gap[s], change, dw, da,
    )  # fmt: skip


@called()
def move_strips(share, arrays, out):
    """w and a of all strips for the bodies' change, MOVE of the vectors (Q,), into out (Y,)."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    n, modes, poses = shape.order.size, strips.compliance.shape[1], bodies.rest.size
    own, ends, move = 2 * n - 6, space.vectors[ENDS], space.vectors[MOVE]
    if bodies.frames.place.size > 0:
        spread(move, bodies.frames, space.vectors[ARMS])
    for s in range(strips.roots.size):
        at = poses + s * (own + modes)
        tip, root = strips.tips[s] >= 0, strips.roots[s] >= 0
        for i in range(3 * tip + 3 * root + strips.outer):
            ends[i] = move[place_of(i, strips.tips[s], strips.roots[s], poses + s)]
        dw, da = out[at : at + own], out[at + own : at + own + modes]
        recovered(s, own, share, strips, local, ends, dw, da)


@part()
def _moment_of_load_beyond(p, points, numbers, rule, tables):
    """Moment about a Gauss point of the dead load beyond it."""
    moment = cx = cy = 0.0
    for i in range(points.size // 2):
        cx += tables[VALUE, p, i] * points[2 * i]
        cy += tables[VALUE, p, i] * points[2 * i + 1]
    for k in range(3):
        qx, qy, ax, ay = numbers[PER_U + 2 * k], numbers[PER_U + 2 * k + 1], 0.0, 0.0
        if qx == 0.0 and qy == 0.0:
            continue
        for i in range(points.size // 2):
            ax += tables[BEYOND + k, p, i] * points[2 * i]
            ay += tables[BEYOND + k, p, i] * points[2 * i + 1]
        far = (1.0 - rule[WHERE, p] ** (k + 1)) / (k + 1)
        moment += (ax - far * cx) * qy - (ay - far * cy) * qx
    return moment


@called()
def moment_defect(y, strips, shape, local, smallest):
    """Return the root of the energy of what the strips' moments differ from balance by over their bending
    energy.

    The balance starts from the force and moment of the clamp at the tip and has the dead load beyond each
    point: int (M - M_b)^2 / EI ds with M_b linear in the curve's points.
    """
    n, rule, tables = shape.order.size, shape.rule, shape.tables
    wrong = stored = 0.0
    tip, inner = n - 2, n - 3
    for s in range(strips.roots.size):
        points, gradient, lever = local.nodal[s, POINTS], local.nodal[s, GRADIENT], local.nodal[s, LEVER]
        numbers, along, moments = strips.numbers[s], strips.along[s], local.lanes[s, MOMENT_AT]
        fx = gradient[2 * tip] + gradient[2 * inner]
        fy = gradient[2 * tip + 1] + gradient[2 * inner + 1]
        x, y0 = points[2 * tip], points[2 * tip + 1]
        bx, by = points[2 * inner] - x, points[2 * inner + 1] - y0
        moment = bx * gradient[2 * inner + 1] - by * gradient[2 * inner]
        for i in range(n):
            lever[i] = (x - points[2 * i]) * fy - (y0 - points[2 * i + 1]) * fx + moment
        for p in range(rule.shape[1]):
            left = moments[p]
            for i in range(n):
                left -= tables[VALUE, p, i] * lever[i]
            left -= _moment_of_load_beyond(p, points, numbers, rule, tables)
            if along[p, RIGIDITY] > 0.0:
                ds = rule[WEIGHT, p] * along[p, SPEED] / along[p, RIGIDITY]
                wrong += ds * left * left
                stored += ds * moments[p] ** 2
    return math.sqrt(wrong / (stored + smallest * smallest))
