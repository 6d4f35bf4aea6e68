"""Massless strips at a new state with the tangent of an earlier one: energies, forces and gaps alone.

Newton's method with an older tangent converges to the same equilibrium, and an evaluation costs a third.
"""

from __future__ import annotations

import math

import numpy as np

from spline_model.reduced.assembly import AXIAL, BENDING, DEAD, FORCE, SLOWEST, place_of
from spline_model.strip.compiled import called, part
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    FIRST,
    GRADIENT,
    LAST,
    MODES,
    ON_POINTS,
    POINTS,
    RIGIDITY,
    SECOND,
    SPEED,
    SPRING,
    STRAIN,
    STRETCHING,
    WEIGHT,
    place_points,
)
from spline_model.strip.ends import by_roots, to_ends
from spline_model.strip.laws import bending_law, mixed_law, stretching_law


@part()
def add_gradient(s, a, shape, strips, local, out):
    """Fill gradient and gaps of strip s, of the material measure if it has axial forces a; adds energies."""
    d1, d2, weights, along = shape.tables[FIRST], shape.tables[SECOND], shape.rule[WEIGHT], strips.along[s]
    numbers, compliance, measure = strips.numbers[s], strips.compliance[s], strips.measure
    points, gradient, gap = local.nodal[s, POINTS], local.nodal[s, GRADIENT], local.axial[s, LAST]
    strain, stretching, slowest = numbers[STRAIN], numbers[STRETCHING], out[SLOWEST]
    bending = axial = fallen = 0.0
    for i in range(points.size):
        gradient[i] = -numbers[ON_POINTS + i]
        fallen -= numbers[ON_POINTS + i] * points[i]
    if numbers[SPRING] > 0.0:  # of roots that turn
        for i in range(2):
            push = numbers[SPRING + i] * points[i]
            bending += 0.5 * push * points[i]
            gradient[i] += push
    for k in range(a.size):
        gap[k] = -compliance[k] * a[k]
        axial += 0.5 * compliance[k] * a[k] * a[k]
    for p in range(weights.size):
        x1 = y1 = x2 = y2 = 0.0
        for i in range(d1.shape[1]):
            x, y = points[2 * i], points[2 * i + 1]
            x1 += d1[p, i] * x
            y1 += d1[p, i] * y
            x2 += d2[p, i] * x
            y2 += d2[p, i] * y
        weight, at = weights[p], along[p]
        speed = at[SPEED]
        v = math.sqrt(x1 * x1 + y1 * y1)
        inverse = 1.0 / v
        r = inverse * inverse
        slowest = min(slowest, v / speed)
        phi = (x1 * y2 - y1 * x2) * r
        density, m, _, _, f, _ = bending_law(
            phi, v, speed, at[CURVATURE], at[RIGIDITY], at[DROP], at[CURL], measure
        )
        bending += weight * density
        if a.size > 0:
            force = 0.0
            for k in range(a.size):
                force += along[p, MODES + k] * a[k]
            _, by_v, _, by_n, _ = mixed_law(v, speed, strain, force, 0.0, measure)
            f += by_v
            for k in range(a.size):
                gap[k] += weight * along[p, MODES + k] * by_n
        if stretching > 0.0:
            density, by_v, _ = stretching_law(v, speed, strain, stretching, measure)
            axial += weight * density
            f += by_v
        bend, pull = weight * m * r, weight * f * inverse
        g0, g1 = bend * (y2 - 2.0 * phi * x1) + pull * x1, pull * y1 - bend * (x2 + 2.0 * phi * y1)
        g2, g3 = -bend * y1, bend * x1
        for i in range(d1.shape[1]):
            gradient[2 * i] += d1[p, i] * g0 + d2[p, i] * g2
            gradient[2 * i + 1] += d1[p, i] * g1 + d2[p, i] * g3
    out[BENDING] += bending
    out[AXIAL] += axial
    out[DEAD] += fallen
    out[SLOWEST] = slowest


@part()
def condense_again(own, last, size, coupled, outer, gain, g, h, b, gap):
    """The forces g of a strip in its factors h and b of ``spline_model.strip.condense``."""
    end = size - outer
    for k in range(gap.size):
        push = gain[k] * gap[k]
        for i in range(end):
            g[i] += push * b[k, i]
    for k in range(coupled):
        g[end if k < outer else own + k - outer] = gap[k]
    for i in range(last):
        share = g[i] / h[i, i]
        for j in range(i + 1, size):
            g[j] -= h[i, j] * share


@called()
def take_gradients(y, bodies, strips, shape, local, space):
    """As ``spline_model.reduced.assembly.assemble``, but for the tangent, which is kept, and RAW."""
    out, force, poses = space.out, space.vectors[FORCE], bodies.rest.size
    n, modes = shape.order.size, strips.compliance.shape[1]
    own, last = 2 * n - 6, 2 * n - 6 + strips.coupled - strips.outer
    out[BENDING] = out[AXIAL] = out[DEAD] = 0.0
    out[SLOWEST] = np.inf
    for i in range(bodies.load.size):
        force[i] = -bodies.weight[i]
    for i in range(poses):
        out[DEAD] -= bodies.weight[i] * y[i]
    norm = 0.0
    for s in range(strips.roots.size):
        at, tip, root = poses + s * (own + modes), strips.tips[s], strips.roots[s]
        place_points(s, y[at : at + own], y, strips, local)
        add_gradient(s, y[at + own : at + own + modes], shape, strips, local, out)
        h, gradient, gap = local.reduced[s], local.nodal[s, GRADIENT], local.axial[s, LAST]
        g, width = h[LAST], h.shape[1]
        for i in range(own - 2):
            g[i] = gradient[i]
        to_ends(gradient, own - 2, local.map[s], tip >= 0, root >= 0, g, own - 2, last)
        if strips.numbers[s, SPRING] > 0.0:
            by_roots(gradient, own - 2, local.nodal[s, POINTS], g)
        for i in range(own):
            norm = max(norm, abs(g[i]))
        for k in range(modes):
            norm = max(norm, abs(gap[k]))
        size = last + 3 * (tip >= 0) + 3 * (root >= 0) + strips.outer
        condense_again(
            own, last, size, strips.coupled, strips.outer, strips.gain[s], g, h, h[width : width + modes], gap
        )
        for i in range(last, size):
            force[place_of(i - last, tip, root, poses + s)] += g[i]
    return norm
