"""A strip between two states: discrete gradients of its energies and their derivatives in the second.

A discrete gradient DV(p0, p1) satisfies DV . (p1 - p0) = V(p1) - V(p0) exactly and tends to the
gradient as p1 -> p0. It is built from the product rule d(fg) = mean(f) dg + mean(g) df, which
needs no division by the step and is frame indifferent. With v = |C'| the difference of v is
mean(C') / mean(v) . dC', and phi = c / s the quotient of c = x' y'' - y' x'' and s = v^2. All is in
the material measure. A viscous stress, ``rate`` times the change of the strain, is beside the mean elastic
one. Dimensionless as in ``spline_model.strip.laws``. Sources: McLachlan, Quispel and Robidoux,
Phil Trans R Soc A 357 (1999) 1021; Gonzalez, J Nonlinear Sci 6 (1996) 449.
"""

from __future__ import annotations

from spline_model.strip.compiled import called, part
from spline_model.strip.laws import curl_law

GAUSS = (
    (0.5 - 0.4305681557970263, 0.17392742256872692),
    (0.5 - 0.16999052179242813, 0.32607257743127307),
    (0.5 + 0.16999052179242813, 0.32607257743127307),
    (0.5 + 0.4305681557970263, 0.17392742256872692),
)
"""Points on [0, 1] and weights of Gauss and Legendre, four of them."""


@part()
def _powers_between(v0, v1):
    """Mean of 1/s, its divided difference, derivatives of both in s1; 1/s of each state, its derivative."""
    r0, r1 = 1.0 / (v0 * v0), 1.0 / (v1 * v1)
    return 0.5 * (r0 + r1), -r0 * r1, -0.5 * r1 * r1, r0 * r1 * r1, r0, r1, -r1 * r1


@part()
def bending_strain(c, v, speed, curvature):
    """Return the strain b of bending, in the material measure."""
    return c / (v * v * speed) - curvature


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
def _turning_between(a0, b0, a2, b2, v0, x1, y1, x2, y2, v1, c0, c1):
    """Discrete gradient of c / s in (x', y', x'', y''), its derivative without what vanishes, by rows, the
    derivative of c / s at the second state, and 1 / s at both."""
    mean, divided, mean_s, divided_s, r0, r1, slope = _powers_between(v0, v1)
    middle = 0.5 * (c0 + c1)
    m0, m1, m2, m3 = 0.5 * (a0 + x1), 0.5 * (b0 + y1), 0.5 * (a2 + x2), 0.5 * (b2 + y2)
    factor = 2.0 * middle * divided
    d0, d1, d2, d3 = factor * m0 + mean * m3, factor * m1 - mean * m2, -mean * m1, mean * m0
    # derivatives in the second state: of the product, of the factor and of the mean power
    turn, wide = 2.0 * c1 * slope, 4.0 * middle * divided_s
    k0, k1, k2, k3 = y2 * r1 + turn * x1, turn * y1 - x2 * r1, -y1 * r1, x1 * r1
    f0, f1, f2, f3 = y2 * divided + wide * x1, wide * y1 - x2 * divided, -y1 * divided, x1 * divided
    q0, q1, half = 2.0 * mean_s * x1, 2.0 * mean_s * y1, 0.5 * mean
    return (
        d0, d1, d2, d3,
        f0 * m0 + q0 * m3 + 0.5 * factor, f1 * m0 + q1 * m3, f2 * m0, f3 * m0 + half,
        f0 * m1 - q0 * m2, f1 * m1 - q1 * m2 + 0.5 * factor, f2 * m1 - half, f3 * m1,
        -q0 * m1, -q1 * m1 - half, q0 * m0 + half, q1 * m0,
        k0, k1, k2, k3, r0, r1,
    )  # fmt: skip


@part()
def _moment_between(e0, e1, drop, curl, rate):
    """Mean moment over R between two strains, with the viscous one, and its derivative in the second."""
    mean, share = 0.5 * (e0 + e1), 0.5
    if curl > 0.0:
        mean, share = _mean_moment(e0, e1, drop, curl)
    return mean + rate * (e1 - e0), share + rate


@part()
def _of_product(
    d0, d1, d2, d3, s0, s1, s2, s3, pull, t00, t01, t02, t03, t10, t11, t12, t13, t20, t21, t30, t31
):
    """Derivative of pull times d, 4 x 4 by rows: s that of pull, t that of d without what vanishes."""
    return (
        s0 * d0 + pull * t00, s1 * d0 + pull * t01, s2 * d0 + pull * t02, s3 * d0 + pull * t03,
        s0 * d1 + pull * t10, s1 * d1 + pull * t11, s2 * d1 + pull * t12, s3 * d1 + pull * t13,
        s0 * d2 + pull * t20, s1 * d2 + pull * t21, s2 * d2, s3 * d2,
        s0 * d3 + pull * t30, s1 * d3 + pull * t31, s2 * d3, s3 * d3,
    )  # fmt: skip


@part()
def bending_between(a0, b0, a2, b2, v0, x1, y1, x2, y2, v1, speed, curvature, rigidity, drop, curl, rate):
    """Return the discrete gradient (4 numbers) of bending in (x', y', x'', y''), and its derivative (4 x 4,
    by rows).

    a0, b0, a2, b2: C' and C'' of the first state; x1, y1, x2, y2 of the second.
    """
    c0, c1 = a0 * b2 - b0 * a2, x1 * y2 - y1 * x2
    (
        d0, d1, d2, d3, t00, t01, t02, t03, t10, t11, t12, t13, t20, t21, t30, t31, k0, k1, k2, k3, r0, r1
    ) = _turning_between(a0, b0, a2, b2, v0, x1, y1, x2, y2, v1, c0, c1)  # fmt: skip
    scale = 1.0 / speed
    e0, e1 = c0 * r0 * scale - curvature, c1 * r1 * scale - curvature
    moment, share = _moment_between(e0, e1, drop, curl, rate)
    k0, k1, k2, k3 = scale * k0, scale * k1, scale * k2, scale * k3
    stiff, pull = rigidity * share, rigidity * moment
    s0, s1, s2, s3 = stiff * k0, stiff * k1, stiff * k2, stiff * k3
    g0, g1, g2, g3 = pull * d0, pull * d1, pull * d2, pull * d3
    h00, h01, h02, h03, h10, h11, h12, h13, h20, h21, h22, h23, h30, h31, h32, h33 = _of_product(
        d0, d1, d2, d3, s0, s1, s2, s3, pull, t00, t01, t02, t03, t10, t11, t12, t13, t20, t21, t30, t31
    )
    return (
        g0, g1, g2, g3,
        h00, h01, h02, h03, h10, h11, h12, h13, h20, h21, h22, h23, h30, h31, h32, h33,
    )  # fmt: skip


@part()
def stretching_between(v0, v1, speed, strain0, rigidity, rate):
    """Return the stretching by quadrature: the force along Dv and its derivative in v1."""
    e0, e1, share = v0 / speed - 1.0 - strain0, v1 / speed - 1.0 - strain0, 0.5 + rate
    return rigidity * (0.5 * (e0 + e1) + rate * (e1 - e0)), rigidity * share / speed
