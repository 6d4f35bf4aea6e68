"""One strip over a time step: discrete gradients of its energies, in its element coordinates and condensed.

A discrete gradient DV(p0, p1) satisfies DV . (p1 - p0) = V(p1) - V(p0) exactly and tends to the gradient as
p1 -> p0. It is built from the product rule d(fg) = mean(f) dg + mean(g) df, which needs no division by the
step and is frame indifferent. With v = |C'| the difference of v is mean(C') / mean(v) . dC', and phi = c / s
the quotient of c = x' y'' - y' x'' and s = v^2. All is in the material measure. A viscous stress, ``rate``
times the change of the strain, is beside the mean elastic one. Sources: McLachlan, Quispel and Robidoux,
Phil Trans R Soc A 357 (1999) 1021; Gonzalez, J Nonlinear Sci 6 (1996) 449.

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
from spline_model.strip.ends import place_points, to_coordinates, to_ends
from spline_model.strip.laws import curl_law
from spline_model.strip.points import add_gaps, add_slopes, couple, curve_at, four

SLOPE, SHARE = 12, 14
"""Places in D, behind the map of both ends: dc / dphi and the mean of s, of root and tip."""
GAUSS = (
    (0.5 - 0.4305681557970263, 0.17392742256872692),
    (0.5 - 0.16999052179242813, 0.32607257743127307),
    (0.5 + 0.16999052179242813, 0.32607257743127307),
    (0.5 + 0.4305681557970263, 0.17392742256872692),
)
"""Points on [0, 1] and weights of Gauss and Legendre, four of them."""


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
def _mean_moment(e0, e1, drop, curl):
    """Return the mean over R of the moment of ``curl_law`` between two strains, and its derivative in the
    second.

    Times the change of the strain it is that of the energy to round-off: by Gauss's rule of four points,
    which has no difference of energies, and over more than the law's own width by that difference.
    """
    if abs(e1 - e0) * curl > 1.0:
        by_energy, by_moment, _ = curl_law(e1, drop, curl)
        before = curl_law(e0, drop, curl)[0]
        mean = 0.5 * (e1 * e1 * by_energy - e0 * e0 * before) / (e1 - e0)
        return mean, (e1 * by_moment - mean) / (e1 - e0)
    mean = slope = 0.0
    for point, weight in GAUSS:
        e = e0 + point * (e1 - e0)
        _, by_moment, by_tangent = curl_law(e, drop, curl)
        mean += weight * e * by_moment
        slope += weight * point * by_tangent
    return mean, slope


@part()
def _bend(p, weight, rate, given, old, lanes, tangent):
    """Discrete gradient of bending in (x', y', x'', y'') at Gauss point p, into the lanes, and its derivative
    in the second state, by rows; returns the change of the strain.

    old (5,): C', C'' and |C'| of the first state.
    """
    x1, y1, x2, y2, v0, v1 = lanes[0, p], lanes[1, p], lanes[2, p], lanes[3, p], old[4], lanes[SPEED_AT, p]
    r0, r1, c0, c1 = 1.0 / (v0 * v0), 1.0 / (v1 * v1), old[0] * old[3] - old[1] * old[2], x1 * y2 - y1 * x2
    scale = 1.0 / given[SPEED]
    e0, e1 = c0 * r0 * scale - given[CURVATURE], c1 * r1 * scale - given[CURVATURE]
    moment, share = 0.5 * (e0 + e1), 0.5
    if given[CURL] > 0.0:
        moment, share = _mean_moment(e0, e1, given[DROP:MODES], given[CURL])
    pull = weight * given[RIGIDITY] * (moment + rate * (e1 - e0))
    stiff = weight * given[RIGIDITY] * (share + rate) * scale
    # mean(1/s) dc + mean(c) d(1/s), whose divided difference in s is -1 / (s0 s1)
    middle, mean, divided = 0.5 * (c0 + c1), 0.5 * (r0 + r1), -r0 * r1
    m0, m1, m2, m3 = 0.5 * (old[0] + x1), 0.5 * (old[1] + y1), 0.5 * (old[2] + x2), 0.5 * (old[3] + y2)
    factor = 2.0 * middle * divided
    d = factor * m0 + mean * m3, factor * m1 - mean * m2, -mean * m1, mean * m0
    # derivatives in the second state: of the strain, of the factor and of the mean power
    turn, wide, half = -2.0 * c1 * r1 * r1, 4.0 * middle * r0 * r1 * r1, 0.5 * mean
    k = y2 * r1 + turn * x1, turn * y1 - x2 * r1, -y1 * r1, x1 * r1
    f0, f1, f2, f3 = y2 * divided + wide * x1, wide * y1 - x2 * divided, -y1 * divided, x1 * divided
    q0, q1 = -r1 * r1 * x1, -r1 * r1 * y1
    t = (
        f0 * m0 + q0 * m3 + 0.5 * factor, f1 * m0 + q1 * m3, f2 * m0, f3 * m0 + half,
        f0 * m1 - q0 * m2, f1 * m1 - q1 * m2 + 0.5 * factor, f2 * m1 - half, f3 * m1,
        -q0 * m1, -q1 * m1 - half, 0.0, 0.0,
        q0 * m0 + half, q1 * m0, 0.0, 0.0,
    )  # fmt: skip
    for i in range(4):
        lanes[4 + i, p] = pull * d[i]
        for j in range(4):
            tangent[4 * i + j] = stiff * d[i] * k[j] + pull * t[4 * i + j]
    return e1 - e0


@called()
def _add_products(pairs, h0, h1, h2, h3, block):
    """Add one component's h (C', C'') to its block of the tangent, (n n,) by rows."""
    p0, p1, p2, p3 = pairs[0], pairs[1], pairs[2], pairs[3]
    for c in range(p0.size):
        block[c] += h0 * p0[c] + h1 * p1[c] + h2 * p2[c] + h3 * p3[c]


@part()
def add_points(s, a, h, state, shape, strips, masses, local, work):
    """Forces on the control points, their tangent in the new ones, gaps and their derivatives."""
    lanes, along, numbers, blocks, t = local.lanes[s], strips.along[s], strips.numbers[s], work.blocks, work.t
    rate, strain, stretching, lost = masses.relaxation[s] / h, numbers[STRAIN], numbers[STRETCHING], 0.0
    d1, d2, weights = shape.curve[0], shape.curve[1], shape.rule[WEIGHT]
    at_mean, at_end, mode = lanes[HESSIAN_AT:], lanes[HESSIAN_AT + 2 :], lanes[HESSIAN_AT + 4]
    curve_at(local.nodal[s, POINTS], d1, d2, four(lanes, 0))
    for q in range(4):
        for c in range(blocks.shape[1]):
            blocks[q, c] = 0.0
    for p in range(weights.size):
        weight, given, old = weights[p], along[p], state.curve[s, p]
        x1, y1, v0, speed = lanes[0, p], lanes[1, p], old[4], given[SPEED]
        v1 = math.sqrt(x1 * x1 + y1 * y1)
        lanes[SPEED_AT, p] = v1
        turned = _bend(p, weight, rate, given, old, lanes, t)
        e0, e1 = v0 / speed - 1.0 - strain, v1 / speed - 1.0 - strain
        w, tension = 2.0 / (v0 + v1), stretching * (0.5 * (e0 + e1) + rate * (e1 - e0))
        for k in range(a.size):
            tension += given[MODES + k] * a[k]
        lost += weight * speed * (given[RIGIDITY] * turned**2 + stretching * (e1 - e0) ** 2)
        dx, dy, tx, ty = weight * 0.5 * (old[0] + x1) * w, weight * 0.5 * (old[1] + y1) * w, x1 / v1, y1 / v1
        turn, part_of_end = 0.5 * tension * w, weight * (0.5 + rate)
        grow = stretching * (0.5 + rate) / speed - turn
        lanes[PULL_AT, p] = weight * (0.5 * (v0 + v1) - (1.0 + strain) * speed + rate * (v1 - v0))
        lanes[4, p] += tension * dx
        lanes[5, p] += tension * dy
        at_mean[0, p], at_mean[1, p] = dx, dy
        at_end[0, p], at_end[1, p] = part_of_end * tx, part_of_end * ty
        t[0] += grow * dx * tx + weight * turn
        t[1] += grow * dx * ty
        t[4] += grow * dy * tx
        t[5] += grow * dy * ty + weight * turn
        for q in range(4):  # xx, xy, yx, yy
            i = 4 * (q // 2) + q % 2
            _add_products(masses.pairs[p], t[i], t[i + 2], t[i + 8], t[i + 10], blocks[q])
    add_slopes(d1.shape[0], d1, d2, four(lanes, 4), work.force[s])
    add_gaps(s, a, strips, local)
    for k in range(a.size):
        change = 0.0
        for p in range(weights.size):
            mode[p] = along[p, MODES + k]
            change += weights[p] * mode[p] * (lanes[SPEED_AT, p] - state.curve[s, p, 4])
        if strips.compliance[s, k] > 0.0:
            lost += change * change / strips.compliance[s, k]
        couple(d1.shape[0], d1, mode, (at_mean[0], at_mean[1]), work.pull[k])
        couple(d1.shape[0], d1, mode, (at_end[0], at_end[1]), work.along[k])
    work.lost[s] = rate * lost


@part()
def _turn_end(e, own, turn, force, mean, end, h):
    """Add (dD)^T times the forces at an end; turn: place of its body's rotation."""
    inner, outer, stick, lever, row = own - 2 + 2 * e, own + 4 - 2 * e, 2 * e, 8 - 4 * e, own - 2 + e
    fx, fy, kx, ky = force[inner], force[inner + 1], end[stick], end[stick + 1]
    arm = end[lever + 3] * (fx + force[outer]) - end[lever + 2] * (fy + force[outer + 1])
    h[row, turn] += 0.5 * mean[SLOPE + e] * (kx * fy - ky * fx)
    h[turn, row] += 0.5 * (mean[stick] * fy - mean[stick + 1] * fx)
    h[turn, turn] -= 0.5 * (arm + mean[SLOPE + e] * mean[SHARE + e] * (kx * fx + ky * fy))


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
            row = half[2 * i + q]
            for j in range(n):
                row[2 * j], row[2 * j + 1] = blocks[2 * q, i * n + j], blocks[2 * q + 1, i * n + j]
                row[2 * j + q] += work.stiff[s, i, j]
    for j in range(2 * n):
        for i in range(8):
            line[i] = half[own - 2 + i, j]
        to_ends(line, 0, mean, tip, root, g, 0, 2)
        for i in range(size - own + 2):
            half[own - 2 + i, j] = g[i]
    for i in range(size):
        to_coordinates(s, half[i], own, end, strips, h[i])
    to_coordinates(s, force, own, mean, strips, g)
    if root:
        _turn_end(0, own, size - 1, force, mean, end, h)
    if tip:
        _turn_end(1, own, own + 2, force, mean, end, h)
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
def keep_curve(s, strips, local, state):
    """Keep map and curve of a strip that was evaluated."""
    lanes, curve = local.lanes[s], state.curve[s]
    copy(local.map[s], state.map[s])
    for p in range(curve.shape[0]):
        for i in range(4):
            curve[p, i] = lanes[i, p]
        curve[p, 4] = lanes[SPEED_AT, p]


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
