"""One strip over a time step: its forces and their derivatives in its element coordinates, and condensed.

The step's changes dy of the element coordinates move the control points by exactly D dy (a discrete
null space of the clamps: Betsch, CMAME 194 (2005) 5159), with rotations by the Cayley variable
c = 2 tan(dphi / 2):

    P_end = X + R(phi) r:          dP_end = dX + c mean(R' r)
    P_inner - P_end = s t(phi):    d(P_inner - P_end) = mean(s) c mean(t') + ds mean(t)

so that D^T times the forces on the control points is free of the clamps' reactions, and no energy is
lost. The tangent is D^T (K T) with T = dP/d(dy) at the step's end, and (dD)^T times the forces: it is not
symmetric. D and T are maps of the ends as those of ``spline_model.strip.ends``.
"""

from __future__ import annotations

import math

from spline_model.strip.compiled import called, copy, part
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    HESSIAN_AT,
    MODES,
    POINTS,
    PULL_AT,
    RIGIDITY,
    SPEED,
    SPEED_AT,
    STRAIN,
    STRETCHING,
    WEIGHT,
)
from spline_model.strip.ends import place_points, to_coordinates
from spline_model.strip.points import add_gaps, add_slopes, couple, curve_at, four
from spline_model.strip.two_states import bending_between, bending_strain, stretching_between

SLOPE, SHARE = 12, 14
"""Places in D, behind the map of both ends: dc / dphi and the mean of s, of root and tip."""


@part()
def move_strip(s, at, state, strips, local, work):
    """Place a strip at the step's end; the changes of its control points, and the maps D and T."""
    dy, move, before, after = work.dy, work.move[s], state.map[s], local.map[s]
    own, mean, end = move.size - 6, work.mean[s], work.end
    place_points(s, work.y[at : at + own], work.y, strips, local)
    copy(after, end)
    for i in range(own - 2):
        move[i] = dy[at + i]
    for e in range(2):
        body = strips.tips[s] if e else strips.roots[s]
        inner, outer, stick, lever = own - 2 + 2 * e, own + 4 - 2 * e, 2 * e, 8 - 4 * e
        ds, x, y, c = dy[at + own - 2 + e], 0.0, 0.0, 0.0
        if body >= 0:
            x, y, c = dy[3 * body], dy[3 * body + 1], dy[3 * body + 2]
        share, slope = state.y[at + own - 2 + e] + 0.5 * ds, 1.0 / (1.0 + 0.25 * c * c)
        tx, ty = 0.5 * (before[stick] + after[stick]), 0.5 * (before[stick + 1] + after[stick + 1])
        ux = 0.5 * (before[lever + 2] + after[lever + 2])
        uy = 0.5 * (before[lever + 3] + after[lever + 3])
        mean[stick], mean[stick + 1], mean[SLOPE + e], mean[SHARE + e] = tx, ty, slope, share
        mean[lever], mean[lever + 1] = ux - share * ty, uy + share * tx
        mean[lever + 2], mean[lever + 3] = ux, uy
        move[outer], move[outer + 1] = x + c * ux, y + c * uy
        move[inner] = x + c * mean[lever] + ds * tx
        move[inner + 1] = y + c * mean[lever + 1] + ds * ty
        for i in range(lever, lever + 4):
            end[i] = slope * after[i]


@called()
def _add_products(pairs, h0, h1, h2, h3, block):
    """Add one component's h (C', C'') to its block of the tangent, (n n,) by rows."""
    p0, p1, p2, p3 = pairs[0], pairs[1], pairs[2], pairs[3]
    for c in range(p0.size):
        block[c] += h0 * p0[c] + h1 * p1[c] + h2 * p2[c] + h3 * p3[c]


@part()
def add_points(s, a, h, state, shape, strips, masses, local, work):
    """Forces on the control points, their tangent in the new ones, gaps and their derivatives."""
    lanes, along, numbers, blocks = local.lanes[s], strips.along[s], strips.numbers[s], work.blocks
    rate, strain, stretching = masses.relaxation[s] / h, numbers[STRAIN], numbers[STRETCHING]
    d1, d2, weights = shape.curve[0], shape.curve[1], shape.rule[WEIGHT]
    at_mean, at_end, mode = lanes[HESSIAN_AT:], lanes[HESSIAN_AT + 2 :], lanes[HESSIAN_AT + 4]
    curve_at(local.nodal[s, POINTS], d1, d2, four(lanes, 0))
    for q in range(4):
        for c in range(blocks.shape[1]):
            blocks[q, c] = 0.0
    for p in range(weights.size):
        weight, given, old = weights[p], along[p], state.curve[s, :, p]
        x1, y1, x2, y2, v0, speed = lanes[0, p], lanes[1, p], lanes[2, p], lanes[3, p], old[4], given[SPEED]
        v1 = math.sqrt(x1 * x1 + y1 * y1)
        (
            g0, g1, g2, g3,
            h00, h01, h02, h03, h10, h11, h12, h13, h20, h21, h22, h23, h30, h31, h32, h33,
        ) = bending_between(
            old[0], old[1], old[2], old[3], v0, x1, y1, x2, y2, v1,
            speed, given[CURVATURE], given[RIGIDITY], given[DROP:MODES], given[CURL], rate,
        )  # fmt: skip
        inverse, w, tension, stiffness = 1.0 / v1, 2.0 / (v0 + v1), 0.0, 0.0
        dx, dy = 0.5 * (old[0] + x1) * w, 0.5 * (old[1] + y1) * w
        tx, ty = x1 * inverse, y1 * inverse
        for k in range(a.size):
            tension += given[MODES + k] * a[k]
        if stretching > 0.0:
            force, stiffness = stretching_between(v0, v1, speed, strain, stretching, rate)
            tension += force
        turn = 0.5 * tension * w
        grow, part_of_end = stiffness - turn, weight * (0.5 + rate)
        lanes[SPEED_AT, p] = v1
        lanes[PULL_AT, p] = weight * (0.5 * (v0 + v1) - (1.0 + strain) * speed + rate * (v1 - v0))
        lanes[4, p], lanes[5, p] = weight * (g0 + tension * dx), weight * (g1 + tension * dy)
        lanes[6, p], lanes[7, p] = weight * g2, weight * g3
        at_mean[0, p], at_mean[1, p] = weight * dx, weight * dy
        at_end[0, p], at_end[1, p] = part_of_end * tx, part_of_end * ty
        pairs = masses.pairs[p]
        xx, xy = weight * (h00 + grow * dx * tx + turn), weight * (h01 + grow * dx * ty)
        yx, yy = weight * (h10 + grow * dy * tx), weight * (h11 + grow * dy * ty + turn)
        _add_products(pairs, xx, weight * h02, weight * h20, weight * h22, blocks[0])
        _add_products(pairs, xy, weight * h03, weight * h21, weight * h23, blocks[1])
        _add_products(pairs, yx, weight * h12, weight * h30, weight * h32, blocks[2])
        _add_products(pairs, yy, weight * h13, weight * h31, weight * h33, blocks[3])
    add_slopes(d1.shape[0], d1, d2, four(lanes, 4), work.force[s])
    add_gaps(s, a, strips, local)
    for k in range(a.size):
        for p in range(weights.size):
            mode[p] = along[p, MODES + k]
        couple(d1.shape[0], d1, mode, (at_mean[0], at_mean[1]), work.pull[k])
        couple(d1.shape[0], d1, mode, (at_end[0], at_end[1]), work.along[k])


@part()
def _combine(row, inner, outer, m0, m1, m2, m3, half, size, h):
    """A row of h from those of ``half``: the inner point's by m0 and m1, the outer one's by m2 and m3."""
    x, y, u, v = half[inner], half[inner + 1], half[outer], half[outer + 1]
    for j in range(size):
        h[row, j] = m0 * x[j] + m1 * y[j] + m2 * u[j] + m3 * v[j]


@called()
def _add_end(e, own, turn, size, force, mean, end, half, h):
    """Rows of an end by D, and (dD)^T times the forces; turn: place of its body's rotation, or 0."""
    inner, outer, stick, lever, row = own - 2 + 2 * e, own + 4 - 2 * e, 2 * e, 8 - 4 * e, own - 2 + e
    tx, ty, slope, share = mean[stick], mean[stick + 1], mean[SLOPE + e], mean[SHARE + e]
    _combine(row, inner, outer, tx, ty, 0.0, 0.0, half, size, h)
    if turn == 0:
        return
    _combine(turn - 2, inner, outer, 1.0, 0.0, 1.0, 0.0, half, size, h)
    _combine(turn - 1, inner, outer, 0.0, 1.0, 0.0, 1.0, half, size, h)
    m0, m1, m2, m3 = mean[lever], mean[lever + 1], mean[lever + 2], mean[lever + 3]
    _combine(turn, inner, outer, m0, m1, m2, m3, half, size, h)
    fx, fy, kx, ky = force[inner], force[inner + 1], end[stick], end[stick + 1]
    arm = end[lever + 3] * (fx + force[outer]) - end[lever + 2] * (fy + force[outer + 1])
    h[row, turn] += 0.5 * slope * (kx * fy - ky * fx)
    h[turn, row] += 0.5 * (tx * fy - ty * fx)
    h[turn, turn] -= 0.5 * (arm + slope * share * (kx * fx + ky * fy))


@part()
def to_reduced(s, strips, work):
    """Force, tangent and coupling of a strip in its element coordinates; returns their number.

    The inertia is added to the tangent on the way.
    """
    n, tip, root = work.stiff.shape[1], strips.tips[s] >= 0, strips.roots[s] >= 0
    own, blocks, half, line = 2 * n - 6, work.blocks, work.half, work.line
    mean, end, g, h, force = work.mean[s], work.end, work.g[s], work.h[s], work.force[s]
    size = own + 3 * tip + 3 * root
    for i in range(n):
        for q in range(2):
            for j in range(n):
                line[2 * j], line[2 * j + 1] = blocks[2 * q, i * n + j], blocks[2 * q + 1, i * n + j]
                line[2 * j + q] += work.stiff[s, i, j]
            to_coordinates(s, line, own, end, strips, half[2 * i + q])
    for i in range(own - 2):
        for j in range(size):
            h[i, j] = half[i, j]
    to_coordinates(s, force, own, mean, strips, g)
    _add_end(0, own, size - 1 if root else 0, size, force, mean, end, half, h)
    _add_end(1, own, own + 2 if tip else 0, size, force, mean, end, half, h)
    for k in range(strips.compliance.shape[1]):
        to_coordinates(s, work.pull[k], own, mean, strips, work.left[k])
        to_coordinates(s, work.along[k], own, end, strips, work.right[s, k])
    return size


@part()
def condense(s, size, strips, masses, local, work):
    """Eliminate a strip's inner axial forces and own coordinates from g and h in place; returns its size.

    Outer axial forces follow behind the ends, their rows combined exactly (``spline_model.strip.condense``).
    """
    count, outer, own = strips.compliance.shape[1], masses.outer, work.move.shape[1] - 6
    g, h, left, right, gap = work.g[s], work.h[s], work.left, work.right[s], local.gap[s]
    for k in range(count):
        gain = masses.gain[s, k]
        push = gain * gap[k]
        for i in range(size):
            share = gain * left[k, i]
            g[i] += push * left[k, i]
            for j in range(size):
                h[i, j] += share * right[k, j]
    for k in range(outer):
        rest = 1.0 - masses.gain[s, k] * strips.compliance[s, k]
        at = size + k
        for i in range(size):
            h[i, at] = rest * left[k, i]
            h[at, i] = right[k, i]
        for j in range(outer):
            h[at, size + j] = 0.0
        h[at, at] = -strips.compliance[s, k]
        g[at] = gap[k]
    size += outer
    for i in range(own):
        inverse = 1.0 / h[i, i]
        for j in range(i + 1, size):
            factor = h[j, i] * inverse
            if factor != 0.0:
                g[j] -= factor * g[i]
                for c in range(i + 1, size):
                    h[j, c] -= factor * h[i, c]
    return size


@part()
def lost_between(s, h, old, strips, shape, relaxation, local):
    """Return the energy that strip s dissipates over a step from the curve ``old`` (5, G) to the present
    one."""
    lanes, along, weights = local.lanes[s], strips.along[s], shape.rule[WEIGHT]
    stretching, rate, lost = strips.numbers[s, STRETCHING], relaxation / h, 0.0
    for p in range(weights.size):
        given, v, v0 = along[p], lanes[SPEED_AT, p], old[4, p]
        speed, curvature = given[SPEED], given[CURVATURE]
        bend = bending_strain(lanes[0, p] * lanes[3, p] - lanes[1, p] * lanes[2, p], v, speed, curvature)
        bend -= bending_strain(old[0, p] * old[3, p] - old[1, p] * old[2, p], v0, speed, curvature)
        lost += rate * weights[p] * speed * (given[RIGIDITY] * bend**2 + stretching * ((v - v0) / speed) ** 2)
    for k in range(strips.compliance.shape[1]):
        if strips.compliance[s, k] > 0.0:
            change = 0.0
            for p in range(weights.size):
                change += weights[p] * along[p, MODES + k] * (lanes[SPEED_AT, p] - old[4, p])
            lost += rate * change * change / strips.compliance[s, k]
    return lost


@part()
def keep_curve(s, strips, local, state):
    """Keep map and curve of a strip that was evaluated."""
    copy(local.map[s], state.map[s])
    for i in range(4):
        copy(local.lanes[s, i], state.curve[s, i])
    copy(local.lanes[s, SPEED_AT], state.curve[s, 4])


@part()
def quadratic(matrix, v):
    """Return v . M v of both components of v (2 n), M (n, n)."""
    total = 0.0
    for i in range(matrix.shape[0]):
        x = y = 0.0
        for j in range(matrix.shape[0]):
            x += matrix[i, j] * v[2 * j]
            y += matrix[i, j] * v[2 * j + 1]
        total += x * v[2 * i] + y * v[2 * i + 1]
    return total
