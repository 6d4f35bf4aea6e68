"""Roots that turn over a time step: a spring between the chord of a strip's end and what it is clamped to.

    V = k psi^2 / 2,   psi = angle of d = P_inner - P_end - rotation of the body - angle at rest

d goes from d0 to d1, and psi by theta - dphi, with theta the angle between them. The forces k mean(psi) G on
P_inner and, negative, on P_end, and -k mean(psi) dphi / c on the body, with

    G = J (d0 + d1) / 2 theta / (d0 x d1),   G . (d1 - d0) = theta,   J a quarter turn,

do the work that V changes by, exactly; the linear momentum is kept exactly, the angular one to second order
in what psi changes by. Free ends have no spring, and their bodies' angle is that of the chord.
"""

from __future__ import annotations

import math

from spline_model.strip.compiled import called, part

PUSH = 6
"""Place of k mean(psi) in a root's numbers; before it the derivative of the spring's force on P_inner in c
(2,), that of the body's moment in P_inner (2,) and in c, and this moment."""


@called()
def root_turn(end, dx, dy):
    """Angle from the s-direction of an end's frame (4,) to its chord."""
    return math.atan2(end[2] * dy - end[3] * dx, end[2] * dx + end[3] * dy)


@called()
def root_energy(s, points, ends, strips):
    """Energy of a strip's roots at its points (2, n) and end frames (2, 4)."""
    n, energy = points.shape[1], 0.0
    for e in range(2):
        end, inner = (0, 1) if e == 0 else (n - 1, n - 2)
        turn = root_turn(ends[e], points[0, inner] - points[0, end], points[1, inner] - points[1, end])
        energy += 0.5 * strips.spring[s, e] * turn * turn
    return energy


@called()
def share_of(angle):
    """angle / sin(angle), and its derivative."""
    if abs(angle) < 1e-2:  # the series is exact to round-off here
        square = angle * angle
        return 1.0 + square / 6.0 * (1.0 + 7.0 * square / 60.0), angle / 3.0 * (1.0 + 7.0 * square / 30.0)
    sine = math.sin(angle)
    return angle / sine, (sine - angle * math.cos(angle)) / (sine * sine)


@called()
def add_chord(end, inner, n, value, block):
    """Add one component of the derivative in d (d) to a block of the tangent, (n n,) by rows."""
    block[inner * n + inner] += value
    block[end * n + end] += value
    block[inner * n + end] -= value
    block[end * n + inner] -= value


@part()
def turn_roots(s, dy, state, strips, work):
    """Add both roots' springs to forces and tangent of the control points; the rest into ``work.roots``."""
    n, old, new, force, blocks = (
        strips.mass.shape[1],
        state.points[s],
        work.points[s],
        work.force[s],
        work.blocks,
    )
    for e in range(2):
        end, inner, body = (0, 1, strips.roots[s]) if e == 0 else (n - 1, n - 2, strips.tips[s])
        root, k, c = work.roots[s, e], strips.spring[s, e], dy[3 * body + 2] if body >= 0 else 0.0
        x0, y0 = old[0, inner] - old[0, end], old[1, inner] - old[1, end]
        x1, y1 = new[0, inner] - new[0, end], new[1, inner] - new[1, end]
        share, slope = share_of(math.atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1))
        square = x1 * x1 + y1 * y1
        both = math.sqrt((x0 * x0 + y0 * y0) * square)
        tx, ty, mx, my, w = -y1 / square, x1 / square, 0.5 * (x0 + x1), 0.5 * (y0 + y1), share / both
        wx, wy, gx, gy = (
            slope / both * tx - w * x1 / square,
            slope / both * ty - w * y1 / square,
            -my * w,
            mx * w,
        )
        push = 0.5 * k * (root_turn(state.ends[s, e], x0, y0) + root_turn(work.ends[s, e], x1, y1))
        force[0, inner] += push * gx
        force[1, inner] += push * gy
        force[0, end] -= push * gx
        force[1, end] -= push * gy
        half = 0.5 * k
        add_chord(end, inner, n, half * gx * tx - push * my * wx, blocks[0])
        add_chord(end, inner, n, half * gx * ty - push * (0.5 * w + my * wy), blocks[1])
        add_chord(end, inner, n, half * gy * tx + push * (0.5 * w + mx * wx), blocks[2])
        add_chord(end, inner, n, half * gy * ty + push * mx * wy, blocks[3])
        turn, change = 2.0 * math.atan(0.5 * c), 1.0 / (1.0 + 0.25 * c * c)
        mean = turn / c if c != 0.0 else 1.0
        bend = (change - mean) / c if abs(c) > 1e-4 else -c / 6.0
        root[0], root[1], root[2], root[3] = (
            -half * change * gx,
            -half * change * gy,
            -half * mean * tx,
            -half * mean * ty,
        )
        root[4], root[5], root[PUSH] = half * change * mean - push * bend, -push * mean, push


@part()
def turn_bodies(s, strips, work):
    """Add the moments of both roots on their bodies to a strip's g and h in its element coordinates."""
    own, tip, g, h = strips.own, strips.tips[s] >= 0, work.g[s], work.h[s]
    for e in range(2):
        if (strips.roots[s] if e == 0 else strips.tips[s]) < 0:
            continue
        root, maps, inner = work.roots[s, e], work.maps[s, e], 0 if e == 0 else own - 2
        x, y, turn = own, own + 1, own + 2
        if e == 0 and tip:
            x, y, turn = own + 3, own + 4, own + 5
        h[inner, turn] += root[0]
        h[inner + 1, turn] += root[1]
        h[x, turn] -= root[0]
        h[y, turn] -= root[1]
        h[turn, turn] += (
            root[4] - maps[4] * root[0] - maps[5] * root[1] - maps[12] * root[2] - maps[13] * root[3]
        )
        h[turn, inner] += root[2]
        h[turn, inner + 1] += root[3]
        h[turn, x] -= root[2]
        h[turn, y] -= root[3]
        g[turn] += root[5]
