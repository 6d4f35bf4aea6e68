"""Accelerations of a released body on its strips: the strips' ends gathered at the body, and back.

A strip's tip moves with xi = (X, Y, phi, l), over L in the clamp's frame:

    P_(n-1) = (X, Y),   P_(n-2) = (X, Y) - l (cos phi, sin phi).

Its two end points' equation of motion (``spline_model.fast.swing``) becomes H xi'' = e with a
4 x 4 mass H; l is eliminated and what remains is added to the body's 3 x 3 mass.
"""

from __future__ import annotations

import math

from spline_model.fast.strip_force import strip_energy, strip_force
from spline_model.strip.compiled import part


@part()
def accelerate(r, w, swing, space, acceleration):
    """Fill the acceleration (R,) at r with rates w; the velocities enter by the ends' centripetal parts."""
    frame, tips = swing.frame, space.tips
    own = 2 * space.x.shape[1] - 6
    cos_t, sin_t, omega = math.cos(r[2]), math.sin(r[2]), w[2]
    a00 = a11 = swing.body[0]
    a22 = swing.body[1]
    a01 = a02 = a12 = b0 = b1 = b2 = 0.0
    for s in range(swing.mass.size):
        at = 3 + s * own
        place(r, at, s, cos_t, sin_t, frame, space)
        strip_force(
            s,
            space.x,
            space.y,
            swing.grid,
            swing.axial,
            space.at_points,
            space.stretch,
            space.force_x,
            space.force_y,
        )
        h00, h01, h02, h11, h12, h22, e0, e1, e2 = tip_system(r, w, at, s, cos_t, sin_t, omega, swing, space)
        c, d, length = frame.axis[s, 0], frame.axis[s, 1], frame.length[s]
        a, b = -tips[s, 10] / length, tips[s, 9] / length  # d(tip)/d(theta) over L
        k00 = c * c * h00 - 2.0 * c * d * h01 + d * d * h11
        k01 = c * d * (h00 - h11) + (c * c - d * d) * h01
        k11 = d * d * h00 + 2.0 * c * d * h01 + c * c * h11
        k02, k12 = c * h02 - d * h12, d * h02 + c * h12
        q0, q1 = c * e0 - d * e1, d * e0 + c * e1
        mass, first = swing.mass[s], swing.mass[s] * length
        a00 += mass * k00
        a01 += mass * k01
        a11 += mass * k11
        a02 += first * (k00 * a + k01 * b + k02)
        a12 += first * (k01 * a + k11 * b + k12)
        a22 += first * length * (k00 * a * a + 2.0 * (k01 * a * b + k02 * a + k12 * b) + k11 * b * b + h22)
        b0 += first * q0
        b1 += first * q1
        b2 += first * length * (q0 * a + q1 * b + e2)
    l1, l2 = a01 / a00, a02 / a00
    c11, c12, c22 = a11 - l1 * a01, a12 - l1 * a02, a22 - l2 * a02
    r1, r2 = b1 - l1 * b0, b2 - l2 * b0
    spin = (r2 - c12 / c11 * r1) / (c22 - c12 / c11 * c12)
    across = (r1 - c12 * spin) / c11
    along = (b0 - a01 * across - a02 * spin) / a00
    acceleration[0], acceleration[1], acceleration[2] = along, across, spin
    for s in range(swing.mass.size):
        follow_tip(r, 3 + s * own, s, cos_t, sin_t, swing, space, acceleration)


@part()
def place(r, at, s, cos_t, sin_t, frame, space):
    """Control points of a strip from r, and the arm of its tip in tips[s, 9:]."""
    px, py, n, length = space.x, space.y, space.x.shape[1], frame.length[s]
    c, d = frame.axis[s, 0], frame.axis[s, 1]
    ax = cos_t * frame.arm[s, 0] - sin_t * frame.arm[s, 1]
    ay = sin_t * frame.arm[s, 0] + cos_t * frame.arm[s, 1]
    x, y = (r[0] + ax - frame.root[s, 0]) / length, (r[1] + ay - frame.root[s, 1]) / length
    px[s, 1] = r[at]
    for i in range(2, n - 2):
        px[s, i], py[s, i] = r[at + 2 * i - 3], r[at + 2 * i - 2]
    reach = r[at + 2 * n - 7]
    px[s, n - 1], py[s, n - 1] = c * x + d * y, c * y - d * x
    px[s, n - 2] = px[s, n - 1] - reach * cos_t
    py[s, n - 2] = py[s, n - 1] - reach * sin_t
    space.tips[s, 9], space.tips[s, 10] = ax, ay


@part()
def tip_system(r, w, at, s, cos_t, sin_t, omega, swing, space):
    """Mass (3, 3) and force (3,) of a strip at its tip's (X, Y, phi), l eliminated and kept in tips[s]."""
    n, tip, gx, gy = space.x.shape[1], space.tips, space.force_x, space.force_y
    last, length = at + 2 * n - 7, swing.frame.length[s]
    c, d = swing.frame.axis[s, 0], swing.frame.axis[s, 1]
    f0x, f0y, f1x, f1y = gx[s, n - 2], gy[s, n - 2], gx[s, n - 1], gy[s, n - 1]
    for i in range(1, n - 2):
        f0x -= swing.along[s, i, n - 2] * gx[s, i]
        f1x -= swing.along[s, i, n - 1] * gx[s, i]
        f0y -= swing.across[s, i, n - 2] * gy[s, i]
        f1y -= swing.across[s, i, n - 1] * gy[s, i]
    # accelerations of P_(n-1) and P_(n-2) at xi'' = 0
    spin = omega * omega
    t1x = -spin / length * (c * tip[s, 9] + d * tip[s, 10])
    t1y = -spin / length * (c * tip[s, 10] - d * tip[s, 9])
    t0x = t1x + 2.0 * w[last] * omega * sin_t + r[last] * spin * cos_t
    t0y = t1y - 2.0 * w[last] * omega * cos_t + r[last] * spin * sin_t
    xaa, xab, xbb = swing.ends[s, 0, 0], swing.ends[s, 0, 1], swing.ends[s, 0, 2]
    yaa, yab, ybb = swing.ends[s, 1, 0], swing.ends[s, 1, 1], swing.ends[s, 1, 2]
    rate = swing.rate[s]
    f0x = -rate * f0x - xaa * t0x - xab * t1x
    f1x = -rate * f1x - xab * t0x - xbb * t1x
    f0y = -rate * f0y - yaa * t0y - yab * t1y
    f1y = -rate * f1y - yab * t0y - ybb * t1y
    # P_(n-2) moves by (px, py) with phi and by (lx, ly) with l
    px, py, lx, ly = r[last] * sin_t, -r[last] * cos_t, -cos_t, -sin_t
    xl, yl = (xaa + xab) * lx, (yaa + yab) * ly
    pl, inverse = xaa * px * lx + yaa * py * ly, 1.0 / (xaa * lx * lx + yaa * ly * ly)
    push = lx * f0x + ly * f0y
    tip[s, 0], tip[s, 1], tip[s, 2], tip[s, 3], tip[s, 4] = xl, yl, pl, push, inverse
    tip[s, 5], tip[s, 6], tip[s, 7], tip[s, 8] = t0x, t0y, t1x, t1y
    push *= inverse
    return (
        xaa + 2.0 * xab + xbb - xl * xl * inverse,
        -xl * yl * inverse,
        (xaa + xab) * px - xl * pl * inverse,
        yaa + 2.0 * yab + ybb - yl * yl * inverse,
        (yaa + yab) * py - yl * pl * inverse,
        xaa * px * px + yaa * py * py - pl * pl * inverse,
        f0x + f1x - xl * push,
        f0y + f1y - yl * push,
        px * f0x + py * f0y - pl * push,
    )


@part()
def follow_tip(r, at, s, cos_t, sin_t, swing, space, acceleration):
    """Accelerations of l and of the inner points from the body's."""
    n, tip, gx, gy = space.x.shape[1], space.tips, space.force_x, space.force_y
    last, length, rate = at + 2 * n - 7, swing.frame.length[s], swing.rate[s]
    c, d = swing.frame.axis[s, 0], swing.frame.axis[s, 1]
    spin = acceleration[2]
    x, y = (acceleration[0] - spin * tip[s, 10]) / length, (acceleration[1] + spin * tip[s, 9]) / length
    tx, ty = c * x + d * y, c * y - d * x
    reach = (tip[s, 3] - tip[s, 0] * tx - tip[s, 1] * ty - tip[s, 2] * spin) * tip[s, 4]
    acceleration[last] = reach
    # the ends' accelerations in the places of their forces: one product gives the inner points'
    gx[s, n - 1], gy[s, n - 1] = (tx + tip[s, 7]) / rate, (ty + tip[s, 8]) / rate
    gx[s, n - 2] = (tx + r[last] * spin * sin_t - reach * cos_t + tip[s, 5]) / rate
    gy[s, n - 2] = (ty - r[last] * spin * cos_t - reach * sin_t + tip[s, 6]) / rate
    for i in range(1, n - 2):
        ax = ay = 0.0
        for j in range(1, n):
            ax += swing.along[s, i, j] * gx[s, j]
            ay += swing.across[s, i, j] * gy[s, j]
        if i == 1:
            acceleration[at] = -rate * ax
        else:
            acceleration[at + 2 * i - 3], acceleration[at + 2 * i - 2] = -rate * ax, -rate * ay


@part()
def stored_energy(r, swing, space):
    """Strain energy [J] at r, and the least |C'| over L."""
    own = 2 * space.x.shape[1] - 6
    cos_t, sin_t = math.cos(r[2]), math.sin(r[2])
    energy, slowest = 0.0, math.inf
    for s in range(swing.mass.size):
        place(r, 3 + s * own, s, cos_t, sin_t, swing.frame, space)
        bending, axial = strip_energy(
            s, space.x, space.y, swing.grid, swing.axial, space.at_points, space.stretch
        )
        energy += swing.frame.rigidity[s] / swing.frame.length[s] * (bending + axial)
        for p in range(space.stretch.size):
            slowest = min(slowest, 1.0 + space.stretch[p])
    return energy, slowest
