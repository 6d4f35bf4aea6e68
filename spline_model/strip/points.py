"""A strip's energy, gradient and Hessian in its control points, summed over the Gauss points."""

from __future__ import annotations

import math

import numpy as np

from spline_model.strip.compiled import part
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
)
from spline_model.strip.laws import MATERIAL, bending_law, mixed_law, stretching_law


@part()
def evaluate_points(s, a, moving, shape, strips, local, out):
    """Fill gradient, upper Hessian, coupling and gap of the first ``moving`` places of strip s.

    Adds bending and axial energy to out[0] and out[1], the dead load's to out[2]; out[3] becomes the
    least v / J0.
    """
    d1, d2, weights, along = shape.tables[FIRST], shape.tables[SECOND], shape.rule[WEIGHT], strips.along[s]
    numbers, split, compliance, measure = (
        strips.numbers[s],
        strips.split,
        strips.compliance[s],
        strips.measure,
    )
    hessian, gram, moment = local.nodal[s], local.axial[s], local.moment[s]
    points, gradient, gap = hessian[POINTS], hessian[GRADIENT], gram[LAST]
    strain, stretching = numbers[STRAIN], numbers[STRETCHING]
    n, count, slowest = d1.shape[1], a.size, np.inf
    bending = axial = fallen = 0.0
    for i in range(2 * n):
        gradient[i] = -numbers[ON_POINTS + i]
        fallen -= numbers[ON_POINTS + i] * points[i]
    for i in range(2 * moving):
        for j in range(i, 2 * moving):
            hessian[i, j] = 0.0
    if numbers[SPRING] > 0.0:  # of roots that turn
        for i in range(2):
            push = numbers[SPRING + i] * points[i]
            bending += 0.5 * push * points[i]
            gradient[i] += push
            hessian[i, i] = numbers[SPRING + i]
    for k in range(count):
        for i in range(2 * moving):
            hessian[2 * n + k, i] = 0.0
        if measure == MATERIAL:
            gap[k] = -compliance[k] * a[k]
            axial += 0.5 * compliance[k] * a[k] * a[k]
        else:
            gap[k] = 0.0
            for j in range(count):
                gram[k, j] = 0.0
    for p in range(weights.size):
        x1 = y1 = x2 = y2 = 0.0
        for i in range(n):
            x, y = points[2 * i], points[2 * i + 1]
            x1 += d1[p, i] * x
            y1 += d1[p, i] * y
            x2 += d2[p, i] * x
            y2 += d2[p, i] * y
        weight, at = weights[p], along[p]
        speed, modes = at[SPEED], at[MODES:]
        square = x1 * x1 + y1 * y1
        v, r = math.sqrt(square), 1.0 / square
        slowest = min(slowest, v / speed)
        tx, ty = x1 / v, y1 / v
        phi = (x1 * y2 - y1 * x2) * r
        density, m, m_phi, m_v, f, f_v = bending_law(
            phi, v, speed, at[CURVATURE], at[RIGIDITY], at[DROP], at[CURL], measure
        )
        bending += weight * density
        moment[p] = m
        force = sliding = by_nv = 0.0
        if count > 0:
            for k in range(split):
                force += modes[k] * a[k]
            for k in range(split, count):
                sliding += modes[k] * a[k]
            loss = compliance[0] * force * force
            if split < count:
                loss += compliance[split] * sliding * sliding
            density, by_v, by_vv, by_n, by_nv = mixed_law(v, speed, strain, force + sliding, loss, measure)
            f += by_v
            f_v += by_vv
            if measure == MATERIAL:
                for k in range(count):
                    gap[k] += weight * modes[k] * by_n
            else:
                axial += weight * density
                for k in range(count):
                    mine, first, last = (force, 0, split) if k < split else (sliding, split, count)
                    gap[k] += weight * modes[k] * (by_n - compliance[k] * mine * v)
                    for j in range(first, last):
                        gram[k, j] += weight * compliance[k] * v * modes[k] * modes[j]
        if stretching > 0.0:
            density, by_v, by_vv = stretching_law(v, speed, strain, stretching, measure)
            axial += weight * density
            f += by_v
            f_v += by_vv
        # gradient of phi in (x', y', x'', y'')
        p0, p1 = (y2 - 2.0 * phi * x1) * r, (-x2 - 2.0 * phi * y1) * r
        p2, p3 = -y1 * r, x1 * r
        g0, g1 = weight * (m * p0 + f * tx), weight * (m * p1 + f * ty)
        g2, g3 = weight * m * p2, weight * m * p3
        # Hessian of E(phi, v): the second derivatives of phi and v are those of the curve
        side, two = f / v, 2.0 * r
        q0, q1 = m_phi * p0 + m_v * tx, m_phi * p1 + m_v * ty
        u0, u1 = m_v * p0 + f_v * tx, m_v * p1 + f_v * ty
        h00 = weight * (q0 * p0 + u0 * tx - m * two * (2.0 * x1 * p0 + phi) + side * ty * ty)
        h11 = weight * (q1 * p1 + u1 * ty - m * two * (2.0 * y1 * p1 + phi) + side * tx * tx)
        h01 = weight * (q0 * p1 + u0 * ty - m * two * (x1 * p1 + y1 * p0) - side * tx * ty)
        h02 = weight * (q0 * p2 - m * two * x1 * p2)
        h03 = weight * (q0 * p3 + m * (1.0 - 2.0 * x1 * p3) * r)
        h12 = weight * (q1 * p2 + m * (-1.0 - 2.0 * y1 * p2) * r)
        h13 = weight * (q1 * p3 - m * two * y1 * p3)
        bend = weight * m_phi
        h22, h23, h33 = bend * p2 * p2, bend * p2 * p3, bend * p3 * p3
        for i in range(moving):
            u, q = d1[p, i], d2[p, i]
            gradient[2 * i] += u * g0 + q * g2
            gradient[2 * i + 1] += u * g1 + q * g3
            xx1, xx2 = u * h00 + q * h02, u * h02 + q * h22
            xy1, xy2 = u * h01 + q * h12, u * h03 + q * h23
            yx1, yx2 = u * h01 + q * h03, u * h12 + q * h23
            yy1, yy2 = u * h11 + q * h13, u * h13 + q * h33
            row0, row1 = hessian[2 * i], hessian[2 * i + 1]
            for j in range(i, moving):
                row0[2 * j] += xx1 * d1[p, j] + xx2 * d2[p, j]
                row0[2 * j + 1] += xy1 * d1[p, j] + xy2 * d2[p, j]
                row1[2 * j] += yx1 * d1[p, j] + yx2 * d2[p, j]
                row1[2 * j + 1] += yy1 * d1[p, j] + yy2 * d2[p, j]
        for k in range(count):
            factor = by_nv
            if measure != MATERIAL:
                factor -= compliance[k] * (force if k < split else sliding)
            wk = weight * modes[k] * factor
            row = hessian[2 * n + k]
            kx, ky = wk * tx, wk * ty
            for i in range(moving):
                row[2 * i] += kx * d1[p, i]
                row[2 * i + 1] += ky * d1[p, i]
    out[0] += bending
    out[1] += axial
    out[2] += fallen
    out[3] = min(out[3], slowest)
