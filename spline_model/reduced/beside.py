"""A state with the factors of one beside it: what a residual there asks for, and states solved so, compiled.

The prediction of a path is soon so good that one correction ends in round-off. Behind it the tangent H is
not formed again: the gradient is seen to vanish, and with the tangent K of the state before and the predicted
rate v, the rate is

    v - K^-1 H v,

off by K^-1 H - 1 times what v is, and so is the stiffness.
"""

from __future__ import annotations

from spline_model.frames import fold, spread
from spline_model.reduced.arrays import ARMS, FORCE, MOVE, RATE, RAW, REACTION, REACTION_RATE, SPARE
from spline_model.reduced.assembly import begin, move_strips, place_of, residual_of
from spline_model.reduced.equilibrium import CLOSE, CONFIRMED, ITERATIONS, NEARLY, carry, newton, tangent
from spline_model.strip.compiled import called, lane, part
from spline_model.strip.element import (
    FORCE_AT,
    GRADIENT,
    HESSIAN_AT,
    LAST,
    MODES,
    PULL_AT,
)
from spline_model.strip.ends import move_points, place_points, rates_of_end, to_coordinates
from spline_model.strip.laws import MATERIAL
from spline_model.strip.points import add_slopes, curve_at, evaluate_residual, four

COVECTOR, ALONG = 0, 1
"""Rows of ``Local.nodal`` that are free once the Hessian is condensed: H v, and the rates of the points."""
FIRM = 1e4
"""Least pivot, over the residual of the state that was factorised, that has its sign in the state solved for:
over such a step a pivot changes by up to 400 times the residual, large ones most."""
GRAIN = 8.0 * 2.0**-52
"""Round-off of a residual over the square of the control points: of paths with 6 to 20 it was half of it at
most, whatever the processor."""


@part()
def _forward(own, last, end, coupled, outer, gain, h, b, gap, g):
    """Eliminate a right-hand side, g of w and the ends and gap of a, as the strip was condensed."""
    for k in range(gap.size):
        push = gain[k] * gap[k]
        for i in range(end):
            if i < own or i >= last:
                g[i] += push * b[k, i]
    for k in range(coupled):
        g[end if k < outer else own + k - outer] = gap[k]
    for i in range(last):
        factor = g[i] / h[i, i]
        for j in range(i + 1, end + outer):
            g[j] -= factor * h[i, j]


@part()
def condense_again(arrays):
    """Add to FORCE what the strips' g, overwritten, and gaps are at the ends by the factors at hand, and fold
    it on those that carry frames."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    force, modes, own = space.vectors[FORCE], strips.compliance.shape[1], 2 * shape.order.size - 6
    last = own + strips.coupled - strips.outer
    for s in range(strips.roots.size):
        h, tip, root = local.reduced[s], strips.tips[s], strips.roots[s]
        g, b, end = h[LAST], h[h.shape[1] : h.shape[1] + modes], last + 3 * (tip >= 0) + 3 * (root >= 0)
        _forward(own, last, end, strips.coupled, strips.outer, strips.gain[s], h, b, local.gap[s], g)
        for i in range(last, end + strips.outer):
            force[place_of(i - last, tip, root, bodies.rest.size + s)] += g[i]
    if bodies.frames.place.size > 0:
        fold(force, bodies.frames, space.vectors[ARMS])


@called()
def respond(arrays, out):
    """The change (Y,) by which a residual beside a condensed state vanishes, into ``out``.

    The residual: FORCE of the vectors without the strips, and each strip's g and gap in its element, which
    are overwritten. REACTION_RATE: what the drives then bear.
    """
    bodies, space = arrays.bodies, arrays.space
    move = space.vectors[MOVE]
    condense_again(arrays)
    carry(REACTION_RATE, bodies, space)
    move_strips(1.0, arrays, out)
    for i in range(bodies.rest.size):
        out[i] = move[i]


@part()
def take_residual(y, load, arrays):
    """As ``assemble``, but for the tangent, which is kept. Of the strips the largest."""
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    n, modes = shape.order.size, strips.compliance.shape[1]
    own, last, norm = 2 * n - 6, 2 * n - 6 + strips.coupled - strips.outer, 0.0
    begin(y, load, bodies, space)
    for s in range(strips.roots.size):
        at = bodies.rest.size + s * (own + modes)
        place_points(s, y[at : at + own], y, strips, local)
        evaluate_residual(s, y[at + own : at + own + modes], n, shape, strips, local, space.out)
        to_coordinates(s, local.nodal[s, GRADIENT], last, local.map[s], strips, local.reduced[s, LAST])
        norm = max(norm, residual_of(s, own, last, strips, local, space))
    if bodies.frames.place.size > 0:
        fold(space.vectors[RAW], bodies.frames, space.vectors[ARMS])
    return norm


@lane()
def _product_at(
    x1, y1, x2, y2, h00, h01, h11, h02, h03, h12, h13, h22, h23, h33, tx, ty, force,
    g0, g1, g2, g3, strain,
):  # fmt: skip
    """What the derivatives of the energy change by, as those of the curve and the axial force do.

    strain: the change of their derivative in the axial force but for its own compliance.
    """
    for p in range(x1.size):
        a1, b1, a2, b2, pull = x1[p], y1[p], x2[p], y2[p], force[p]
        g0[p] = h00[p] * a1 + h01[p] * b1 + h02[p] * a2 + h03[p] * b2 + pull * tx[p]
        g1[p] = h01[p] * a1 + h11[p] * b1 + h12[p] * a2 + h13[p] * b2 + pull * ty[p]
        g2[p] = h02[p] * a1 + h12[p] * b1 + h22[p] * a2 + h23[p] * b2
        g3[p] = h03[p] * a1 + h13[p] * b1 + h23[p] * a2 + h33[p] * b2
        strain[p] = tx[p] * a1 + ty[p] * b1


@part()
def _add_product(s, a, points, shape, strips, local, covector):
    """What gradient (2 n), into ``covector``, and gaps of strip s change by, as points (2 n) and forces a do.

    Behind ``evaluate_residual``; all but moment and speed is overwritten.
    """
    lanes, along, gap = local.lanes[s], strips.along[s], local.gap[s]
    d1, d2, force, strain = shape.curve[0], shape.curve[1], lanes[FORCE_AT], lanes[PULL_AT]
    curve_at(points, d1, d2, four(lanes, 0))
    for p in range(along.shape[0]):
        total = 0.0
        for k in range(a.size):
            total += along[p, MODES + k] * a[k]
        force[p] = total
    h, more = four(lanes, HESSIAN_AT) + four(lanes, HESSIAN_AT + 4), four(lanes, HESSIAN_AT + 8)
    slopes = four(lanes, 4)
    _product_at(*(four(lanes, 0) + h + more + (force,) + slopes + (strain,)))
    for i in range(covector.size):
        covector[i] = 0.0
    add_slopes(d1.shape[0], d1, d2, slopes, covector)
    for k in range(a.size):
        total = -strips.compliance[s, k] * a[k]
        for p in range(along.shape[0]):
            total += along[p, MODES + k] * strain[p]
        gap[k] = total


@part()
def _turn_ends(s, own, last, rate, strips, local):
    """Add to g what the gradient does as the directions turn in which the ends' points move."""
    ends, along, f, g = local.map[s], local.nodal[s, ALONG], local.nodal[s, GRADIENT], local.reduced[s, LAST]
    for e in range(2):
        inner, outer, stick = own - 2 + 2 * e, own + 4 - 2 * e, 2 * e
        x, y, turn = rates_of_end(s, e, rate, strips)
        fx, fy, ux, uy = f[inner], f[inner + 1], along[inner], along[inner + 1]
        g[own - 2 + e] += turn * (ends[stick] * fy - ends[stick + 1] * fx)
        if (strips.tips[s] if e else strips.roots[s]) >= 0:
            pose = last + 2 if e else last + 3 * (strips.tips[s] >= 0) + 2
            g[pose] += (ux - x) * fy - (uy - y) * fx
            g[pose] += (along[outer] - x) * f[outer + 1] - (along[outer + 1] - y) * f[outer]


@part()
def take_product(rate, load_rate, arrays):
    """H v of a state just evaluated by ``take_residual`` along a rate v (Y,): its g, gap and FORCE.

    In v the rates of frames are put.
    """
    bodies, strips, shape = arrays.bodies, arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    force, poses = space.vectors[FORCE], bodies.rest.size
    n, modes = shape.order.size, strips.compliance.shape[1]
    own, last, arms = 2 * n - 6, 2 * n - 6 + strips.coupled - strips.outer, space.vectors[ARMS]
    if bodies.frames.place.size > 0:
        spread(rate, bodies.frames, arms)
    for i in range(bodies.load.size):
        force[i] = -load_rate * bodies.load[i]
    for f in range(bodies.frames.place.shape[0]):
        turn = bodies.frames.place[f, 1] + 2
        if turn >= 2:
            force[turn] -= arms[bodies.frames.place[f, 0] + 2] * rate[turn]
    for i in range(bodies.springs.shape[0]):
        for j in range(bodies.springs.shape[0]):
            force[i] += bodies.springs[i, j] * rate[j]
    for s in range(strips.roots.size):
        at, along, covector = poses + s * (own + modes), local.nodal[s, ALONG], local.nodal[s, COVECTOR]
        move_points(s, at, rate, strips, local, along)
        _add_product(s, rate[at + own : at + own + modes], along, shape, strips, local, covector)
        to_coordinates(s, covector, last, local.map[s], strips, local.reduced[s, LAST])
        _turn_ends(s, own, last, rate, strips, local)


@part()
def _is_firm(least, arrays):
    """Whether all pivots of strips and bodies are ``least`` or more."""
    strips, shape = arrays.strips, arrays.shape
    local, space = arrays.local, arrays.space
    firm, last = True, 2 * shape.order.size - 6 + strips.coupled - strips.outer
    for i in range(space.factors.shape[0]):
        firm = firm and abs(space.factors[i, i]) >= least
    for s in range(strips.roots.size):
        for i in range(last):
            firm = firm and abs(local.reduced[s, i, i]) >= least
    return firm


@called()
def _confirm(y, load, norm, held_rate, load_rate, arrays, tolerance):
    """Whether y, one correction behind a state of residual ``norm``, is solved; with reactions and rates.

    RATE: as predicted, which becomes the state's own.
    """
    bodies, space, n = arrays.bodies, arrays.space, arrays.shape.order.size
    left = take_residual(y, load, arrays)
    for i in range(bodies.free.size):
        left = max(left, abs(space.vectors[RAW, bodies.free[i]]))
    if not left <= max(CLOSE * tolerance, min(NEARLY * tolerance, GRAIN * n * n)):
        return False
    rate, change, most = space.states[RATE], space.states[SPARE], 0.0
    for d in range(bodies.held.size):
        space.vectors[REACTION, d] = space.vectors[RAW, bodies.held[d]]
        rate[bodies.held[d]] = held_rate[d]
    take_product(rate, load_rate, arrays)
    respond(arrays, change)
    for i in range(y.size):
        rate[i] += change[i]
        most = max(most, abs(change[i]))
    return norm * most <= tolerance


@called()
def solve(y, load, alone, held_rate, load_rate, arrays, tolerance, counters):
    """Solve in place at the held coordinates in y, with rates and reactions; negative eigenvalues, or -1.

    alone: whether the stiffness follows from the rates, so that the tangent need not be that of the state.
    """
    early = alone and arrays.strips.measure == MATERIAL
    negative, norm = newton(y, load, early, arrays, tolerance, counters)
    if early and negative >= 0 and norm > NEARLY * tolerance:
        counters[ITERATIONS] += 1
        if _is_firm(FIRM * norm, arrays):
            counters[CONFIRMED] += 1
            if _confirm(y, load, norm, held_rate, load_rate, arrays, tolerance):
                return negative
        negative, _ = newton(y, load, False, arrays, tolerance, counters)
    if negative >= 0:
        tangent(held_rate, load_rate, arrays)
    return negative
