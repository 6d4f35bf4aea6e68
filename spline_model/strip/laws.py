"""Point laws: energy per du of bending and stretching in the turning phi and the speed v of the curve.

phi = (x' y'' - y' x'') / |C'|^2 is the turning of the tangent per du, v = |C'|, J0 the speed at
rest. A law gives its energy and its derivatives in (phi, v): all that an element needs. What is
a function of these two alone fits in here, whatever it is. Everything is dimensionless: lengths
over L, energy over EI/L.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from spline_model.strip.compiled import called, part

MATERIAL, SPATIAL = range(2)
TERMS = 7
"""Coefficients of the polynomial of ``curl_law``."""


@called()
def _nearly_flat(y):
    """Return f, h and h + x h' / 2 of ``curl_law`` by y = x^4 below 1: quotients of power series."""
    n0 = 1.0 + y * (1.0 / 360.0 + y * (1.0 / 1814400.0 + y * (1.0 / 43589145600.0)))
    n1 = 1.0 / 360.0 + y * (1.0 / 907200.0 + y * (1.0 / 14529715200.0))
    n2 = 1.0 / 907200.0 + y * (1.0 / 7264857600.0)
    d0 = 1.0 + y * (1.0 / 120.0 + y * (1.0 / 362880.0 + y * (1.0 / 6227020800.0)))
    d1 = 1.0 / 120.0 + y * (1.0 / 181440.0 + y * (1.0 / 2075673600.0))
    d2 = 1.0 / 181440.0 + y * (1.0 / 1037836800.0)
    f = n0 / d0
    slope = (n1 - f * d1) / d0
    bend = (n2 - 2.0 * slope * d1 - f * d2) / d0
    return f, f + y * slope, f + y * (5.0 * slope + 2.0 * y * bend)


@called()
def curled(x):
    """Return the same by x of 1 and more: exponentials over the largest."""
    small = np.exp(-x)
    c, s = 2.0 * small * np.cos(x), 2.0 * small * np.sin(x)
    small *= small
    even, odd, sinh = 1.0 + small, 1.0 - small, 1.0 - small + s  # over e^x / 2
    q, d, w = (even - c) / sinh, (even + c) / sinh, (odd - s) / sinh
    q1, q2 = 1.0 - q * d, 2.0 * q * d * d - d - q * w
    over = q / x
    f, first, second = 2.0 * over, 2.0 * (q1 - over), 2.0 * x * q2 - 4.0 * (q1 - over)
    return f, f + 0.25 * first, f + 0.875 * first + 0.125 * second


@called()
def _curl_parts(f, h, t, drop):
    """Return the factors of energy, moment and tangent of ``curl_law`` by f, h and h + x h' / 2."""
    p = d = e = rest = 0.0 * (f + drop[0])
    for k in range(len(drop) - 1, -1, -1):
        p, d, e, rest = drop[k] + f * p, p + f * d, d + f * e, rest + drop[k]
    p, d, e = f * p, p + f * d, 2.0 * (d + f * e)
    whole, bend = 1.0 / (1.0 - rest), h - f
    return (
        whole * (1.0 - p),
        whole * (1.0 - p - d * bend),
        whole * (1.0 - p - d * (t - f) - 2.0 * e * bend * bend),
    )


@called()
def curl_law(b, drop, curl):
    """Return how the flattening of a strip that curls across its width multiplies energy, moment and tangent.

    The energy density is 1/2 R b^2 (1 - P(f(x))) / (1 - P(1)), x^2 = curl |b|, and R the rigidity at b = 0:

        f = (2 / x) (cosh x - cos x) / (sinh x + sin x),      h = f + x f' / 4,

    f is the share of the curl that is left. P (drop) are the coefficients of f, f^2, ...: nu^2 alone, or what
    clamps leave of it. Moment and tangent follow by the derivatives of P. f is smooth in y = x^4. Source:
    Ashwell, J R Aeronaut Soc 54 (1950) 708; Audoly and Neukirch, J Mech Phys Solids 153 (2021).
    """
    y = curl * curl * b * b
    f, h, t = _nearly_flat(y) if y.real < 1.0 else curled(np.sqrt(np.sqrt(y)))
    return _curl_parts(f, h, t, drop)


def curl_factors(b: Any, drop: Any, curl: Any) -> Any:
    """Return ``curl_law`` of arrays, real or complex, with drop (P, K): factors (3, P, ...)."""
    near, far, parts = (getattr(each, "py_func", each) for each in (_nearly_flat, curled, _curl_parts))
    y = np.asarray(curl * curl * b * b)
    small = y.real < 1.0
    own = np.where(small, near(np.where(small, y, 0.0)), far(np.sqrt(np.sqrt(np.where(small, 1.0, y)))))
    rows = np.moveaxis(drop, -1, 0)
    return np.array(parts(*own, rows.reshape(*rows.shape, *[1] * (y.ndim + 1 - rows.ndim))))


@part()
def bending_law(phi, v, speed, curvature, rigidity, measure):
    """Return the energy, its derivatives in phi (the moment), phi phi, phi v, v and v v, but for
    ``curl_law``.

    material (0)  1/2 EI (phi / J0 - kappa_0)^2 J0 spatial (1)   1/2 EI (phi / v - kappa_0)^2 v     (Eq 10)
    """
    if measure == MATERIAL:
        b = phi / speed - curvature
        return 0.5 * rigidity * b * b * speed, rigidity * b, rigidity / speed, 0.0, 0.0, 0.0
    ratio = phi / v
    b = ratio - curvature
    return (
        0.5 * rigidity * b * b * v,
        rigidity * b,
        rigidity / v,
        -rigidity * ratio / v,
        -rigidity * b * (0.5 * b + curvature),
        rigidity * ratio * ratio / v,
    )


@part()
def stretching_law(v, speed, strain0, rigidity, measure):
    """Return the stretching by quadrature of the strain: energy, its derivatives in v and v v (Eq 13)."""
    eps = v / speed - 1.0 - strain0
    if measure == MATERIAL:
        return 0.5 * rigidity * eps * eps * speed, rigidity * eps, rigidity / speed
    return (
        0.5 * rigidity * eps * eps * v,
        rigidity * eps * (v / speed + 0.5 * eps),
        rigidity * (v / speed + 2.0 * eps) / speed,
    )


@part()
def _mixed_law(v, speed, strain0):
    """Return the mixed stretching, N eps J0: its derivative in N, eps J0, whose own in v is 1; the one in v
    is N."""
    return (v / speed - 1.0 - strain0) * speed


@part()
def axial_laws(v, speed, strain, count, stretching, force, measure):
    """Return the stretching, mixed or by quadrature: stored energy, its derivatives in v, v v and N.

    force: N. The mixed form's energy is that of its forces' compliances, which is not in it.
    """
    stored = by_v = by_vv = by_n = 0.0
    if count > 0:
        by_v, by_n = force, _mixed_law(v, speed, strain)
    if stretching.real > 0.0:
        stored, more, by_vv = stretching_law(v, speed, strain, stretching, measure)
        by_v += more
    return stored, by_v, by_vv, by_n


@part()
def by_curve(weight, a1, b1, r, ex, ey, phi, p0, p1, p2, p3, m, m_phi, m_v, side, f_v):
    """Hessian of E(phi, v) in (x', y', x'', y''): entries 00, 01, 11, 02, 03, 12, 13, 22, 23 and 33.

    p: gradient of phi; m, m_phi, m_v, f_v: derivatives of E in phi, phi phi, phi v, v v; side: in v, over v.
    """
    two = 2.0 * r
    q0, q1 = m_phi * p0 + m_v * ex, m_phi * p1 + m_v * ey
    u0, u1 = m_v * p0 + f_v * ex, m_v * p1 + f_v * ey
    bend = weight * m_phi
    return (
        weight * (q0 * p0 + u0 * ex - m * two * (2.0 * a1 * p0 + phi) + side * ey * ey),
        weight * (q0 * p1 + u0 * ey - m * two * (a1 * p1 + b1 * p0) - side * ex * ey),
        weight * (q1 * p1 + u1 * ey - m * two * (2.0 * b1 * p1 + phi) + side * ex * ex),
        weight * (q0 * p2 - m * two * a1 * p2),
        weight * (q0 * p3 + m * (1.0 - 2.0 * a1 * p3) * r),
        weight * (q1 * p2 + m * (-1.0 - 2.0 * b1 * p2) * r),
        weight * (q1 * p3 - m * two * b1 * p3),
        bend * p2 * p2,
        bend * p2 * p3,
        bend * p3 * p3,
    )
