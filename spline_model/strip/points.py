"""A strip's energy, gradient and Hessian in its control points, summed over the Gauss points.

It is done in lanes: a row of ``Local.lanes`` holds one number at each Gauss point, the rows come one by one
to functions that know them apart (``compiled.lane``). So is the Hessian, by pairs of control points.
"""

from __future__ import annotations

import numpy as np

from spline_model.strip.compiled import called, lane, part
from spline_model.strip.element import (
    CURL,
    CURVATURE,
    DROP,
    FORCE_AT,
    GIVEN,
    GRADIENT,
    HESSIAN_AT,
    MODES,
    MOMENT_AT,
    ON_POINTS,
    POINTS,
    PULL_AT,
    RIGIDITY,
    SPEED,
    SPEED_AT,
    STRAIN,
    STRETCHING,
    TANGENT_AT,
    WEIGHT,
)
from spline_model.strip.laws import (
    axial_laws,
    bending_law,
    by_curve,
    curl_law,
    stretching_law,
)


@part()
def four(lanes, first):
    """Return the four rows from one on, apart."""
    return lanes[first], lanes[first + 1], lanes[first + 2], lanes[first + 3]


@lane()
def curve_at(points, d1, d2, curve):
    """x', y', x'', y'' at the Gauss points from the control points; d1, d2 (n, G)."""
    x1, y1, x2, y2 = curve
    for p in range(x1.size):
        x1[p] = y1[p] = x2[p] = y2[p] = 0.0
    for i in range(d1.shape[0]):
        x, y = points[2 * i], points[2 * i + 1]
        for p in range(x1.size):
            x1[p] += d1[i, p] * x
            y1[p] += d1[i, p] * y
            x2[p] += d2[i, p] * x
            y2[p] += d2[i, p] * y


@lane()
def lengths_at(x1, y1, speed, weights, strain, lengths, pulls):
    """|C'| and, times the weights, the strains that axial forces see."""
    for p in range(x1.size):
        v = np.sqrt(x1[p] * x1[p] + y1[p] * y1[p])
        lengths[p], pulls[p] = v, weights[p] * (v - (1.0 + strain) * speed[p])


@part()
def given_at(s, a, strips, lanes):
    """What is given at the Gauss points: J0, curvature, EI, factors of ``curl_law``, N."""
    along = strips.along[s]
    for p in range(along.shape[0]):
        at, force = along[p], 0.0
        for k in range(a.size):
            force += at[MODES + k] * a[k]
        lanes[GIVEN, p], lanes[GIVEN + 1, p], lanes[GIVEN + 2, p] = at[SPEED], at[CURVATURE], at[RIGIDITY]
        lanes[FORCE_AT, p] = force
    if along[0, CURL].real > 0.0:
        _flatten_at(s, strips, lanes)


@part()
def _flatten_at(s, strips, lanes):
    """Factors of ``curl_law`` at the Gauss points."""
    for p in range(lanes.shape[1]):
        at, x1, y1, x2, y2 = strips.along[s, p], lanes[0, p], lanes[1, p], lanes[2, p], lanes[3, p]
        phi = (x1 * y2 - y1 * x2) / (x1 * x1 + y1 * y1)
        factors = curl_law(phi / at[SPEED] - at[CURVATURE], at[DROP:MODES], at[CURL])
        lanes[GIVEN + 3, p], lanes[GIVEN + 4, p], lanes[GIVEN + 5, p] = factors


@lane()
def slopes_at(
    measure, strain, stretching, weights, x1, y1, x2, y2, g0, g1, g2, g3, lengths, speed, curvature, rigidity,
    by_m, force,
):  # fmt: skip
    """Of ``laws_at`` the derivatives of the energy in x', y', x'' and y'' alone."""
    for p in range(weights.size):
        a1, b1, a2, b2, v, weight = x1[p], y1[p], x2[p], y2[p], lengths[p], weights[p]
        r = 1.0 / (v * v)
        phi = (a1 * b2 - b1 * a2) * r
        _, m, _, _, f, _ = bending_law(phi, v, speed[p], curvature[p], rigidity[p], measure)
        f += force[p]
        if stretching.real > 0.0:
            f += stretching_law(v, speed[p], strain, stretching, measure)[1]
        bend, pull = weight * m * by_m[p] * r, weight * f / v
        g0[p], g1[p] = bend * (b2 - 2.0 * phi * a1) + pull * a1, pull * b1 - bend * (a2 + 2.0 * phi * b1)
        g2[p], g3[p] = -bend * b1, bend * a1


@lane()
def _laws_at(
    measure, count, strain, stretching, weights, x1, y1, x2, y2, g0, g1, g2, g3,
    h00, h01, h11, h02, h03, h12, h13, h22, h23, h33, tx, ty, lengths, moments, pulls,
    speed, curvature, rigidity, by_e, by_m, by_t, force,
):  # fmt: skip
    """The laws at the Gauss points; returns bending and axial energy.

    Filled are rows, times the weight: g, h, derivatives in (x', y', x'', y''); the unit tangent; |C'|; the
    moment; derivatives of the axial energy in N. Behind them is what ``given_at`` fills.
    """
    bending = axial = 0.0
    for p in range(weights.size):
        a1, b1, a2, b2, weight = x1[p], y1[p], x2[p], y2[p], weights[p]
        square = a1 * a1 + b1 * b1
        v, r = np.sqrt(square), 1.0 / square
        ex, ey = a1 / v, b1 / v
        phi = (a1 * b2 - b1 * a2) * r
        density, m, m_phi, m_v, f, f_v = bending_law(phi, v, speed[p], curvature[p], rigidity[p], measure)
        m, m_phi = m * by_m[p], m_phi * by_t[p]
        bending += weight * density * by_e[p]
        stored, by_v, by_vv, by_n = axial_laws(v, speed[p], strain, count, stretching, force[p], measure)
        f, f_v = f + by_v, f_v + by_vv
        axial += weight * stored
        lengths[p], moments[p], pulls[p] = v, m, weight * by_n
        tx[p], ty[p] = weight * ex, weight * ey
        # gradient of phi in (x', y', x'', y'')
        p0, p1 = (b2 - 2.0 * phi * a1) * r, (-a2 - 2.0 * phi * b1) * r
        p2, p3 = -b1 * r, a1 * r
        g0[p], g1[p] = weight * (m * p0 + f * ex), weight * (m * p1 + f * ey)
        g2[p], g3[p] = weight * m * p2, weight * m * p3
        h00[p], h01[p], h11[p], h02[p], h03[p], h12[p], h13[p], h22[p], h23[p], h33[p] = by_curve(
            weight, a1, b1, r, ex, ey, phi, p0, p1, p2, p3, m, m_phi, m_v, f / v, f_v
        )
    return bending, axial


@lane()
def _add_pairs(blocks, products, h00, h01, h11, h02, h03, h12, h13, h22, h23, h33):
    """Add one Gauss point to the blocks xx, xy, yx, yy of all pairs (P,) of control points."""
    (xx, xy, yx, yy), (t11, t12, t21, t22) = blocks, products
    for q in range(xx.size):
        both, mean = t12[q] + t21[q], h01 * t11[q] + h23 * t22[q]
        xx[q] += h00 * t11[q] + h02 * both + h22 * t22[q]
        xy[q] += mean + h03 * t12[q] + h12 * t21[q]
        yx[q] += mean + h12 * t12[q] + h03 * t21[q]
        yy[q] += h11 * t11[q] + h13 * both + h33 * t22[q]


@lane()
def add_slopes(moving, d1, d2, slopes, gradient):
    """Add the gradient of the first ``moving`` places."""
    g0, g1, g2, g3 = slopes
    for i in range(moving):
        x = y = 0.0
        for p in range(g0.size):
            x += d1[i, p] * g0[p] + d2[i, p] * g2[p]
            y += d1[i, p] * g1[p] + d2[i, p] * g3[p]
        gradient[2 * i] += x
        gradient[2 * i + 1] += y


@lane()
def couple(moving, d1, share, tangent, row):
    """Coupling of one axial force to the first ``moving`` places."""
    tx, ty = tangent
    for i in range(moving):
        x = y = 0.0
        for p in range(tx.size):
            w = d1[i, p] * share[p]
            x += w * tx[p]
            y += w * ty[p]
        row[2 * i], row[2 * i + 1] = x, y


@part()
def add_gaps(s, a, strips, local):
    """Gap of all axial forces; returns their own energy."""
    along, compliance, lanes, gap = strips.along[s], strips.compliance[s], local.lanes[s], local.gap[s]
    axial = 0.0
    for k in range(a.size):
        c, mode, total = compliance[k], MODES + k, 0.0
        for p in range(along.shape[0]):
            total += along[p, mode] * lanes[PULL_AT, p]
        gap[k] = total - c * a[k]
        axial += 0.5 * c * a[k] * a[k]
    return axial


@part()
def _add_axial(s, count, moving, shape, strips, local):
    """Coupling of all axial forces to the first ``moving`` places."""
    along, lanes, d1 = strips.along[s], local.lanes[s], shape.curve[0]
    tangent, share, first = (lanes[TANGENT_AT], lanes[TANGENT_AT + 1]), lanes[0], 2 * d1.shape[0]
    for k in range(count):
        for p in range(along.shape[0]):
            share[p] = along[p, MODES + k]
        couple(moving, d1, share, tangent, local.nodal[s, first + k])


@part()
def _add_hessian(moving, products, pairs, lanes, hessian):
    """The upper Hessian of the first ``moving`` places, from what it is at the Gauss points."""
    count = (moving * (moving + 1) // 2 + 7) // 8 * 8
    blocks = pairs[0, :count], pairs[1, :count], pairs[2, :count], pairs[3, :count]
    for block in blocks:
        for q in range(count):
            block[q] = 0.0
    for p in range(lanes.shape[1]):
        at = products[0, p, :count], products[1, p, :count], products[2, p, :count], products[3, p, :count]
        (h00, h01, h11, h02), (h03, h12, h13, h22) = four(lanes, HESSIAN_AT), four(lanes, HESSIAN_AT + 4)
        h23, h33 = lanes[HESSIAN_AT + 8], lanes[HESSIAN_AT + 9]
        _add_pairs(blocks, at, h00[p], h01[p], h11[p], h02[p], h03[p], h12[p], h13[p], h22[p], h23[p], h33[p])
    for j in range(moving):
        for i in range(j + 1):
            q = j * (j + 1) // 2 + i
            hessian[2 * i, 2 * j], hessian[2 * i, 2 * j + 1] = pairs[0, q], pairs[1, q]
            hessian[2 * i + 1, 2 * j], hessian[2 * i + 1, 2 * j + 1] = pairs[2, q], pairs[3, q]


@part()
def take_strains(s, shape, strips, local):
    """The curve of a placed strip and, times the weights, the strains that axial forces see, in its lanes."""
    lanes, along, strain = local.lanes[s], strips.along[s], strips.numbers[s, STRAIN]
    curve_at(local.nodal[s, POINTS], shape.curve[0], shape.curve[1], four(lanes, 0))
    for p in range(along.shape[0]):
        lanes[GIVEN, p] = along[p, SPEED]
    weights, lengths, pulls = shape.rule[WEIGHT], lanes[SPEED_AT], lanes[PULL_AT]
    lengths_at(lanes[0], lanes[1], lanes[GIVEN], weights, strain, lengths, pulls)


@part()
def forces_of_strains(s, strips, local, a):
    """Axial forces (K,) by the strains that were taken; none of those without compliance."""
    along = strips.along[s]
    for k in range(a.size):
        total, compliance = 0.0, strips.compliance[s, k]
        for p in range(along.shape[0]):
            total += along[p, MODES + k] * local.lanes[s, PULL_AT, p]
        a[k] = total / compliance if compliance > 0.0 else 0.0


@part()
def evaluate_residual(s, a, moving, shape, strips, local, out):
    """Fill the gradient of the first ``moving`` places of strip s, the gaps, and the rows of its lanes.

    Adds bending, axial and the dead load's energy to the first three of out; out[3] becomes the least v / J0.
    """
    numbers, lanes = strips.numbers[s], local.lanes[s]
    d1, d2 = shape.curve[0], shape.curve[1]
    points, gradient = local.nodal[s, POINTS], local.nodal[s, GRADIENT]
    curve_at(points, d1, d2, four(lanes, 0))
    given_at(s, a, strips, lanes)
    rows = four(lanes, 0) + four(lanes, 4) + four(lanes, 8) + four(lanes, 12)
    more = four(lanes, 16) + four(lanes, 20) + four(lanes, 24) + (lanes[28], lanes[FORCE_AT])
    bending, axial = _laws_at(
        strips.measure, a.size, numbers[STRAIN], numbers[STRETCHING], shape.rule[WEIGHT], *(rows + more)
    )
    slowest = np.inf
    for p in range(lanes.shape[1]):
        slowest = min(slowest, (lanes[SPEED_AT, p] / lanes[GIVEN, p]).real)
    for i in range(gradient.size):
        gradient[i] = -numbers[ON_POINTS + i]
        out[2] -= numbers[ON_POINTS + i] * points[i]
    add_slopes(moving, d1, d2, four(lanes, 4), gradient)
    out[0] += bending
    out[1] += axial + add_gaps(s, a, strips, local)
    out[3] = min(out[3].real, slowest)


@called()
def forces_at(s, a, strips, shape, local):
    """Axial force and moment of strip s, of whatever points, into FORCE_AT and MOMENT_AT of its lanes."""
    numbers, lanes, along = strips.numbers[s], local.lanes[s], strips.along[s]
    curve_at(local.nodal[s, POINTS], shape.curve[0], shape.curve[1], four(lanes, 0))
    given_at(s, a, strips, lanes)
    for p in range(lanes.shape[1]):
        x1, y1, x2, y2 = lanes[0, p], lanes[1, p], lanes[2, p], lanes[3, p]
        square, speed = x1 * x1 + y1 * y1, along[p, SPEED]
        v, phi = np.sqrt(square), (x1 * y2 - y1 * x2) / square
        law = bending_law(phi, v, speed, along[p, CURVATURE], along[p, RIGIDITY], strips.measure)
        lanes[MOMENT_AT, p] = law[1] * lanes[GIVEN + 4, p]
        lanes[FORCE_AT, p] += numbers[STRETCHING] * (v / speed - 1.0 - numbers[STRAIN])


@part()
def evaluate_points(s, a, moving, shape, strips, local, out):
    """The same with upper Hessian and coupling."""
    evaluate_residual(s, a, moving, shape, strips, local, out)
    _add_hessian(moving, shape.products, local.pairs, local.lanes[s], local.nodal[s])
    _add_axial(s, a.size, moving, shape, strips, local)
