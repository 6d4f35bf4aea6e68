"""One strip as a super-element: energy, gradient and Hessian in its own coordinates and its tip's pose.

Everything is dimensionless: lengths over L, energy over EI/L, axial forces over EI/L^2; the
frame is the ground clamp's, with x along its direction. The tip's pose is e = (X, Y, phi).

    P0 = 0,  P1 = (s_A k, 0),  P_(n-2) = (X, Y) - s_B k (cos phi, sin phi),  P_(n-1) = (X, Y)

with k = 1 / (n - 1); own coordinates w = (s_A, P2 ... P_(n-3), s_B). Energy
int 1/2 theta'^2 + N (v - 1) du - 1/2 sum c_k a_k^2 / (2 k + 1), N = sum a_k P_k(2 u - 1) and
v = |C'|: material bending (Eq 10) and mixed stretching, c_k the compliance of a mode in
L^2/EI (1 / slide stiffness for the modes from m on).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.strip.compiled import part


class Grid(NamedTuple):
    """Basis at the Gauss points: d0, d1, d2 (G, n), modes (G, K), weight (G,)."""

    d0: NDArray[np.float64]
    d1: NDArray[np.float64]
    d2: NDArray[np.float64]
    modes: NDArray[np.float64]
    weight: NDArray[np.float64]


class Local(NamedTuple):
    """What one evaluation fills; n control points, W = 2 n - 6 own coordinates, K modes.

    points (n, 2); turning (G,) theta' at the Gauss points; gradient (2 n,), hessian
    (2 n, 2 n), coupling (K, 2 n) in the control points; g (W + 3,), h (W + 3, W + 3),
    b (K, W + 3) in (w, e); gap (K,) residual of the axial forces; lever (n,) moment of the
    tip's force and moment about the control points, filled by ``fast.doubt``.
    """

    points: NDArray[np.float64]
    turning: NDArray[np.float64]
    lever: NDArray[np.float64]
    gradient: NDArray[np.float64]
    hessian: NDArray[np.float64]
    coupling: NDArray[np.float64]
    g: NDArray[np.float64]
    h: NDArray[np.float64]
    b: NDArray[np.float64]
    gap: NDArray[np.float64]


def local_arrays(control_points: int, modes: int, gauss_points: int) -> Local:
    """Arrays of a strip of that size."""
    n, own = control_points, 2 * control_points - 6
    return Local(
        points=np.zeros((n, 2)),
        turning=np.zeros(gauss_points),
        lever=np.zeros(n),
        gradient=np.zeros(2 * n),
        hessian=np.zeros((2 * n, 2 * n)),
        coupling=np.zeros((modes, 2 * n)),
        g=np.zeros(own + 3),
        h=np.zeros((own + 3, own + 3)),
        b=np.zeros((modes, own + 3)),
        gap=np.zeros(modes),
    )


@part()
def place_points(w, x, y, cos, sin, points):
    """Control points from the own coordinates (W,) and the tip's point and direction."""
    n = points.shape[0]
    reach, last = 1.0 / (n - 1), w.size - 1
    points[1, 0] = w[0] * reach
    for i in range(2, n - 2):
        points[i, 0] = w[2 * i - 3]
        points[i, 1] = w[2 * i - 2]
    points[n - 2, 0] = x - w[last] * reach * cos
    points[n - 2, 1] = y - w[last] * reach * sin
    points[n - 1, 0], points[n - 1, 1] = x, y


@part()
def assemble_points(points, a, compliance, grid, local):
    """Fill gradient, upper hessian blocks, coupling and gap; returns the energies and least |C'|."""
    n, count, modes = points.shape[0], grid.weight.size, a.size
    gradient, hessian, coupling = local.gradient, local.hessian, local.coupling
    gradient[:] = 0.0
    hessian[:] = 0.0
    coupling[:] = 0.0
    bending = axial = 0.0
    slowest = np.inf
    for k in range(modes):
        local.gap[k] = -compliance[k] * a[k] / (2 * k + 1)
        axial += 0.5 * compliance[k] * a[k] * a[k] / (2 * k + 1)
    for p in range(count):
        d1, d2, mode = grid.d1[p], grid.d2[p], grid.modes[p]
        x1 = y1 = x2 = y2 = 0.0
        for i in range(1, n):
            x, y = points[i, 0], points[i, 1]
            x1 += d1[i] * x
            y1 += d1[i] * y
            x2 += d2[i] * x
            y2 += d2[i] * y
        force = 0.0
        for k in range(modes):
            force += mode[k] * a[k]
        weight = grid.weight[p]
        s = x1 * x1 + y1 * y1
        v = math.sqrt(s)
        slowest = min(slowest, v)
        r = 1.0 / s
        f = (x1 * y2 - y1 * x2) * r  # theta'
        local.turning[p] = f
        # gradient of f in (x', y', x'', y'')
        f0, f1 = (y2 - 2.0 * f * x1) * r, (-x2 - 2.0 * f * y1) * r
        f2, f3 = -y1 * r, x1 * r
        bending += 0.5 * weight * f * f
        tx, ty = x1 / v, y1 / v
        side = force / v
        wf = weight * f
        g0, g1 = wf * f0 + weight * force * tx, wf * f1 + weight * force * ty
        g2, g3 = wf * f2, wf * f3
        # Hessian of 1/2 f^2 + N v: f_i f_j + f f_ij (+ N / v (1 - t t^T) in C')
        h00 = weight * (f0 * f0 + f * (-4.0 * x1 * f0 - 2.0 * f) * r + side * ty * ty)
        h11 = weight * (f1 * f1 + f * (-4.0 * y1 * f1 - 2.0 * f) * r + side * tx * tx)
        h01 = weight * (f0 * f1 - 2.0 * f * (x1 * f1 + y1 * f0) * r - side * tx * ty)
        h02 = weight * (f0 * f2 - 2.0 * f * x1 * f2 * r)
        h03 = weight * (f0 * f3 + f * (1.0 - 2.0 * x1 * f3) * r)
        h12 = weight * (f1 * f2 + f * (-1.0 - 2.0 * y1 * f2) * r)
        h13 = weight * (f1 * f3 - 2.0 * f * y1 * f3 * r)
        h22, h23, h33 = weight * f2 * f2, weight * f2 * f3, weight * f3 * f3
        for i in range(1, n):
            u, q = d1[i], d2[i]
            gradient[2 * i] += u * g0 + q * g2
            gradient[2 * i + 1] += u * g1 + q * g3
            xx1, xx2 = u * h00 + q * h02, u * h02 + q * h22
            xy1, xy2 = u * h01 + q * h12, u * h03 + q * h23
            yx1, yx2 = u * h01 + q * h03, u * h12 + q * h23
            yy1, yy2 = u * h11 + q * h13, u * h13 + q * h33
            row0, row1 = hessian[2 * i], hessian[2 * i + 1]
            for j in range(i, n):
                row0[2 * j] += xx1 * d1[j] + xx2 * d2[j]
                row0[2 * j + 1] += xy1 * d1[j] + xy2 * d2[j]
                row1[2 * j] += yx1 * d1[j] + yx2 * d2[j]
                row1[2 * j + 1] += yy1 * d1[j] + yy2 * d2[j]
        for k in range(modes):
            wk = weight * mode[k]
            local.gap[k] += wk * (v - 1.0)
            row = coupling[k]
            kx, ky = wk * tx, wk * ty
            for i in range(1, n):
                row[2 * i] += kx * d1[i]
                row[2 * i + 1] += ky * d1[i]
    return bending, axial, slowest


@part()
def to_own(vector, reach, arm, cos, sin, out):
    """A covector in the control points (2 n,) in the coordinates (w, e), (W + 3,).

    reach = 1 / (n - 1), arm = s_B reach; d(P_(n-2))/d(phi) = arm (sin phi, -cos phi).
    """
    size, last = vector.size, out.size - 4
    bx, by = vector[size - 4], vector[size - 3]
    out[0] = reach * vector[2]
    for i in range(4, size - 4):
        out[i - 3] = vector[i]
    out[last] = -reach * (cos * bx + sin * by)
    out[last + 1] = vector[size - 2] + bx
    out[last + 2] = vector[size - 1] + by
    out[last + 3] = arm * (sin * bx - cos * by)


@part()
def hessian_to_own(hessian, gradient, reach, arm, cos, sin, h):
    """The upper triangle of h in (w, e) from the upper blocks of the Hessian in the control points."""
    size, last = gradient.size, h.shape[0] - 4
    b = size - 4
    row = hessian[2]
    h[0, 0] = reach * reach * row[2]
    for j in range(4, b):
        h[0, j - 3] = reach * row[j]
    for i in range(3, b):
        row, k, f = (hessian[2], 0, reach) if i == 3 else (hessian[i], i - 3, 1.0)
        if i > 3:
            for j in range(i, b):
                h[k, j - 3] = row[j]
        bx, by = f * row[b], f * row[b + 1]
        h[k, last] = -reach * (cos * bx + sin * by)
        h[k, last + 1] = f * row[b + 2] + bx
        h[k, last + 2] = f * row[b + 3] + by
        h[k, last + 3] = arm * (sin * bx - cos * by)
    first, second = hessian[b], hessian[b + 1]
    xx, xy, yy = first[b], first[b + 1], second[b + 1]  # P_(n-2) with itself
    ux, uy, vx, vy = first[b + 2], first[b + 3], second[b + 2], second[b + 3]  # with P_(n-1)
    nx, ny = arm * sin, -arm * cos
    tx, ty = -reach * cos, -reach * sin
    h[last, last] = tx * (tx * xx + 2.0 * ty * xy) + ty * ty * yy
    h[last, last + 1] = tx * (xx + ux) + ty * (xy + vx)
    h[last, last + 2] = tx * (xy + uy) + ty * (yy + vy)
    gx, gy = gradient[b], gradient[b + 1]
    h[last, last + 3] = tx * (xx * nx + xy * ny) + ty * (xy * nx + yy * ny) + reach * (sin * gx - cos * gy)
    h[last + 1, last + 1] = xx + 2.0 * ux + hessian[b + 2, b + 2]
    h[last + 1, last + 2] = xy + uy + vx + hessian[b + 2, b + 3]
    h[last + 2, last + 2] = yy + 2.0 * vy + hessian[b + 3, b + 3]
    h[last + 1, last + 3] = (xx + ux) * nx + (xy + vx) * ny
    h[last + 2, last + 3] = (xy + uy) * nx + (yy + vy) * ny
    h[last + 3, last + 3] = nx * (xx * nx + 2.0 * xy * ny) + yy * ny * ny + arm * (cos * gx + sin * gy)


@part()
def evaluate(w, a, x, y, cos, sin, compliance, grid, local):
    """Fill g, the upper triangle of h, b and gap in (w, e) at a tip in (x, y) with direction (cos, sin).

    Returns bending and axial energy and the least |C'|.
    """
    place_points(w, x, y, cos, sin, local.points)
    bending, axial, slowest = assemble_points(local.points, a, compliance, grid, local)
    reach = 1.0 / (local.points.shape[0] - 1)
    arm = w[w.size - 1] * reach
    to_own(local.gradient, reach, arm, cos, sin, local.g)
    hessian_to_own(local.hessian, local.gradient, reach, arm, cos, sin, local.h)
    for k in range(a.size):
        to_own(local.coupling[k], reach, arm, cos, sin, local.b[k])
    return bending, axial, slowest
