"""The paper's bordered form: gradient and Hessian of L(z) = V - lambda psi - f q (Eqs 4, 5, 6 and 19).

Unknowns z are control points, poses of bodies, axial forces and multipliers. The point laws are those of
``spline_model.strip``, which the elements share; from there on this is another way to the same equilibria.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.frames import carry, fold, fold_tangent
from spline_model.quadrature import (
    COMPLIANCE,
    CURL,
    CURVATURE,
    DROP,
    FIRST,
    MEASURE,
    MODE,
    MODES,
    RIGIDITY,
    SPEED,
    STRAIN,
    STRETCHING,
    WEIGHT,
    WIDTH,
)
from spline_model.strip.compiled import kernel, part
from spline_model.strip.laws import SPATIAL, bending_law, curl_law, mixed_law, stretching_law
from spline_model.tables import ACROSS, ALONG, BODY, DIRECTION, END, INNER, ROW, SIGN

Array = NDArray[np.float64]

PRINTED = 2
"""Code of the published forces, which ``spline_model.strip.laws`` does not have: they have no energy."""


def evaluate(
    system: System, z: Array, load_factor: float, gradient: Array, hessian: Array
) -> tuple[float, float]:
    """Fill gradient (N,) and hessian (N, N) at z (N,); returns bending and axial energy [J].

    Equilibrium is gradient = 0: its rows are force balance, axial compatibility and, with a minus sign, the
    constraints. Frames are put into z where their bodies carry them.
    """
    frames, arms, drives, loads = system.frames, np.empty_like(z), system.drives, system.loads
    if frames.place.size:
        carry(z, frames, arms)
    bending, axial, _ = assemble(z, system.points, system.clamps, gradient, hessian, np.empty((5, 4)))
    gradient[drives.row] -= z[drives.coordinate] - drives.origin - load_factor * drives.target
    gradient[drives.coordinate] -= z[drives.row]
    hessian[drives.row, drives.coordinate] = hessian[drives.coordinate, drives.row] = -1.0
    np.subtract.at(gradient, loads.coordinate, load_factor * loads.value)
    gradient[: system.weight.size] -= system.weight
    system.followers.subtract(z, load_factor, gradient, hessian)
    if system.springs.size:
        at = system.layout.poses
        gradient[at] += system.springs @ (z[at] - system.rest[at])
        hessian[at, at] += system.springs
    if frames.place.size:
        fold(gradient, frames, arms)
        fold_tangent(hessian, system.scales.energy / system.scales.length**2, frames, arms, arms)
    return bending, axial


@kernel()
def assemble(z, points, clamps, gradient, hessian, work):
    """Fill gradient (N,) and hessian (N, N) of what strips and clamps do; work (5, 4).

    Returns bending and axial energy [J] and the least v / J0.
    """
    for i in range(z.size):
        gradient[i] = 0.0
        for j in range(z.size):
            hessian[i, j] = 0.0
    bending = axial = 0.0
    slowest = np.inf
    for p in range(points.place.shape[0]):
        bent, stretched, v = _add_point(p, z, points, gradient, hessian, work)
        bending += bent
        axial += stretched
        slowest = min(slowest, v / points.numbers[p, SPEED])
    for c in range(clamps.place.shape[0]):
        _subtract_clamp(z, clamps.place[c], clamps.numbers[c], gradient, hessian)
    return bending, axial, slowest


@part()
def derivatives(z, first, width, d1, d2):
    """Return C' and C'': x', y', x'', y'' from ``width`` control points in z, the first at ``first``."""
    x1 = y1 = x2 = y2 = 0.0
    for a in range(width):
        x, y = z[first + 2 * a], z[first + 2 * a + 1]
        x1 += d1[a] * x
        y1 += d1[a] * y
        x2 += d2[a] * x
        y2 += d2[a] * y
    return x1, y1, x2, y2


@part()
def _add_point(p, z, points, gradient, hessian, work):
    """Add the derivatives of a point's energy; returns its energies of bending and stretching, and v."""
    place, numbers, modes = points.place[p], points.numbers[p], points.modes[p]
    first, width, mode, count = place[FIRST], place[WIDTH], place[MODE], place[MODES]
    d1, d2, weight, force = points.basis[0, p], points.basis[1, p], numbers[WEIGHT], 0.0
    curve = derivatives(z, first, width, d1, d2)
    x1, y1, x2, y2 = curve
    s = x1 * x1 + y1 * y1
    v, phi = math.sqrt(s), (x1 * y2 - y1 * x2) / s
    for k in range(count):
        force += modes[k] * z[mode + k]
    bent, m, m_phi, m_v, f, f_phi, f_v = bend(phi, v, numbers, place[MEASURE])
    stretched, by_v, by_vv, by_n, by_nn = stretch(v, force, count, numbers, place[MEASURE])
    _turn_curve(curve, phi, v, weight, (m, m_phi, m_v, f + by_v, f_phi, f_v + by_vv), work)
    _add_to_points(first, width, d1, d2, work, gradient, hessian)
    for k in range(count):
        row, share = mode + k, weight * modes[k]
        gradient[row] += share * by_n
        for j in range(count):
            hessian[row, mode + j] += share * by_nn * modes[j]
        for a in range(width):
            _add_pair(hessian, row, first + 2 * a, share * d1[a] * x1 / v)
            _add_pair(hessian, row, first + 2 * a + 1, share * d1[a] * y1 / v)
    return weight * bent, weight * stretched, v


@part()
def bend(phi, v, numbers, measure):
    """Return the bending energy density and m, m_phi, m_v, f, f_phi, f_v; as published (Eq 12) without
    d|C'|/dq."""
    curvature, rigidity = numbers[CURVATURE], numbers[RIGIDITY]
    if measure == PRINTED:
        density, m, m_phi, m_v, _, _ = bending_law(phi, v, 1.0, curvature, rigidity, SPATIAL)
        ratio = phi / v
        slope = rigidity * (2.0 * ratio - curvature) / v
        return density, m, m_phi, m_v, -m * ratio, -slope, slope * ratio
    density, m, m_phi, m_v, f, f_v = bending_law(phi, v, numbers[SPEED], curvature, rigidity, measure)
    if numbers[CURL] > 0.0:
        strain = phi / numbers[SPEED] - curvature
        by_energy, by_moment, by_tangent = curl_law(strain, numbers[DROP:], numbers[CURL])
        density, m, m_phi = density * by_energy, m * by_moment, m_phi * by_tangent
    return density, m, m_phi, m_v, f, m_v, f_v


@part()
def stretch(v, force, count, numbers, measure):
    """Return the stretching energy density, its derivatives in v, v v, N and N N; its derivative in N v is 1.

    N is the axial force [N], v the speed |C'| [m].
    """
    speed, strain, stretching = numbers[SPEED], numbers[STRAIN], numbers[STRETCHING]
    energy = by_v = by_vv = by_n = by_nn = 0.0
    if stretching > 0.0:
        energy, by_v, by_vv = stretching_law(v, speed, strain, stretching, min(measure, SPATIAL))
        if measure == PRINTED:  # Eq 15 without d|C'|/dq
            eps = v / speed - 1.0 - strain
            by_v -= 0.5 * stretching * eps * eps
            by_vv -= stretching * eps / speed
    if count > 0:
        compliance = numbers[COMPLIANCE]
        by_n = mixed_law(v, speed, strain)
        energy, by_v = energy + force * by_n - 0.5 * compliance * force * force * speed, by_v + force
        by_n -= compliance * force * speed
        by_nn = -compliance * speed
    return energy, by_v, by_vv, by_n, by_nn


@part()
def _turn_curve(curve, phi, v, weight, law, work):
    """Gradient work[0] and Hessian work[1:] in (x', y', x'', y'') of E(phi, v): phi = c / s, v = sqrt(s)."""
    (x1, y1, x2, y2), (m, m_phi, m_v, f, f_phi, f_v), s = curve, law, v * v
    g, h = work[0], work[1:]
    c_i, s_i, v_i = (y2, -x2, -y1, x1), (2.0 * x1, 2.0 * y1, 0.0, 0.0), (x1 / v, y1 / v, 0.0, 0.0)
    for i in range(4):
        phi_i = (c_i[i] - phi * s_i[i]) / s
        g[i] = weight * (m * phi_i + f * v_i[i])
        for j in range(4):
            phi_j = (c_i[j] - phi * s_i[j]) / s
            same = 1.0 if i == j and i < 2 else 0.0
            c_ij = 0.0
            if i + j == 3:  # (x', y'') and (y', x'')
                c_ij = 1.0 if i == 0 or i == 3 else -1.0
            phi_ij = (c_ij - phi_i * s_i[j] - phi_j * s_i[i] - 2.0 * phi * same) / s
            v_ij = (same - v_i[i] * v_i[j]) / v
            turning = phi_i * (m_phi * phi_j + m_v * v_i[j]) + m * phi_ij
            h[i, j] = weight * (turning + v_i[i] * (f_phi * phi_j + f_v * v_i[j]) + f * v_ij)


@part()
def _add_to_points(first, width, d1, d2, work, gradient, hessian):
    """Add gradient work[0] and Hessian work[1:] in (x', y', x'', y'') to those of the control points."""
    g, h = work[0], work[1:]
    for a in range(width):
        for i in range(2):
            row = first + 2 * a + i
            gradient[row] += d1[a] * g[i] + d2[a] * g[i + 2]
            left0, left1 = d1[a] * h[i, 0] + d2[a] * h[i + 2, 0], d1[a] * h[i, 1] + d2[a] * h[i + 2, 1]
            left2, left3 = d1[a] * h[i, 2] + d2[a] * h[i + 2, 2], d1[a] * h[i, 3] + d2[a] * h[i + 2, 3]
            for b in range(width):
                hessian[row, first + 2 * b] += left0 * d1[b] + left2 * d2[b]
                hessian[row, first + 2 * b + 1] += left1 * d1[b] + left3 * d2[b]


@part()
def _subtract_clamp(z, place, numbers, gradient, hessian):
    """Subtract lambda psi of a clamped end, its gradient and its Hessian (Eqs 5 and 6)."""
    angle = 0.0 if place[BODY] < 0 else z[place[BODY] + 2]
    _subtract_position(z, angle, place, numbers, gradient, hessian)
    _subtract_direction(z, angle, place, numbers, gradient, hessian)


@part()
def _subtract_position(z, angle, place, numbers, gradient, hessian):
    """Of the rows that hold the end's point: P_end - X - R(theta) b (Eq 5)."""
    end, body, row, bx, by = place[END], place[BODY], place[ROW], numbers[ACROSS], numbers[ALONG]
    fx, fy, ax, ay = z[row], z[row + 1], bx, by
    if body >= 0:
        cos, sin = math.cos(angle), math.sin(angle)
        ax, ay = cos * bx - sin * by, sin * bx + cos * by
        gradient[row] += z[body]
        gradient[row + 1] += z[body + 1]
        gradient[body] += fx
        gradient[body + 1] += fy
        gradient[body + 2] += fy * ax - fx * ay
        _add_pair(hessian, row, body, 1.0)
        _add_pair(hessian, row + 1, body + 1, 1.0)
        _add_pair(hessian, row, body + 2, -ay)
        _add_pair(hessian, row + 1, body + 2, ax)
        hessian[body + 2, body + 2] -= fx * ax + fy * ay
    gradient[row] -= z[end] - ax
    gradient[row + 1] -= z[end + 1] - ay
    gradient[end] -= fx
    gradient[end + 1] -= fy
    _add_pair(hessian, row, end, -1.0)
    _add_pair(hessian, row + 1, end + 1, -1.0)


@part()
def _subtract_direction(z, angle, place, numbers, gradient, hessian):
    """Of the row that holds the tangent: the angle of C' from the clamp's direction (Eq 6)."""
    end, inner, body, row, sign = place[END], place[INNER], place[BODY], place[ROW], numbers[SIGN]
    moment = z[row + 2]
    if body >= 0:
        gradient[body + 2] += moment
        _add_pair(hessian, row + 2, body + 2, 1.0)
    dx, dy = sign * (z[inner] - z[end]), sign * (z[inner + 1] - z[end + 1])
    s = dx * dx + dy * dy
    mx, my = math.cos(numbers[DIRECTION] + angle), math.sin(numbers[DIRECTION] + angle)
    gradient[row + 2] -= math.atan2(mx * dy - my * dx, mx * dx + my * dy)
    turn = (-dy / s * sign, dx / s * sign)  # d(angle of C') / d(inner)
    hxx, hxy = -moment * 2.0 * dx * dy / (s * s), -moment * (dy * dy - dx * dx) / (s * s)
    for i in range(2):
        gradient[inner + i] -= moment * turn[i]
        gradient[end + i] += moment * turn[i]
        _add_pair(hessian, row + 2, inner + i, -turn[i])
        _add_pair(hessian, row + 2, end + i, turn[i])
        for j in range(2):
            value = hxy if i != j else (hxx if i == 0 else -hxx)
            hessian[inner + i, inner + j] += value
            hessian[end + i, end + j] += value
            hessian[inner + i, end + j] -= value
            hessian[end + i, inner + j] -= value


@part()
def _add_pair(hessian, row, column, value):
    """Add to an entry and to its mirror image."""
    hessian[row, column] += value
    hessian[column, row] += value
