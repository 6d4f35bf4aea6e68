"""From the control points of a strip over a step to its reduced coordinates, and the strip condensed.

D and T are those of ``spline_model.motion.strip``: forces are projected by D, their changes follow from
those of the coordinates by T, so that the tangent is not symmetric.

Roots that turn over a time step: a spring between the chord of a strip's end and what it is clamped to.

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
def _share_of(angle):
    """angle / sin(angle), and its derivative."""
    if abs(angle) < 1e-2:  # the series is exact to round-off here
        square = angle * angle
        return 1.0 + square / 6.0 * (1.0 + 7.0 * square / 60.0), angle / 3.0 * (1.0 + 7.0 * square / 30.0)
    sine = math.sin(angle)
    return angle / sine, (sine - angle * math.cos(angle)) / (sine * sine)


@called()
def _add_chord(end, inner, n, value, block):
    """Add one component of the derivative in d (d) to a block of the tangent, (n n,) by rows."""
    block[inner * n + inner] += value
    block[end * n + end] += value
    block[inner * n + end] -= value
    block[end * n + inner] -= value


@part()
def turn_roots(s, dy, state, strips, work):
    """Add both roots' springs to forces and tangent of the control points; the rest into ``work.roots``."""
    n, old, new = strips.mass.shape[1], state.points[s], work.points[s]
    force, blocks = work.force[s], work.blocks
    for e in range(2):
        end, inner, body = (0, 1, strips.roots[s]) if e == 0 else (n - 1, n - 2, strips.tips[s])
        root, k, c = work.roots[s, e], strips.spring[s, e], dy[3 * body + 2] if body >= 0 else 0.0
        x0, y0 = old[0, inner] - old[0, end], old[1, inner] - old[1, end]
        x1, y1 = new[0, inner] - new[0, end], new[1, inner] - new[1, end]
        share, slope = _share_of(math.atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1))
        square = x1 * x1 + y1 * y1
        both = math.sqrt((x0 * x0 + y0 * y0) * square)
        tx, ty, mx, my, w = -y1 / square, x1 / square, 0.5 * (x0 + x1), 0.5 * (y0 + y1), share / both
        wx, wy = slope / both * tx - w * x1 / square, slope / both * ty - w * y1 / square
        gx, gy = -my * w, mx * w
        push = 0.5 * k * (root_turn(state.ends[s, e], x0, y0) + root_turn(work.ends[s, e], x1, y1))
        force[0, inner] += push * gx
        force[1, inner] += push * gy
        force[0, end] -= push * gx
        force[1, end] -= push * gy
        half = 0.5 * k
        _add_chord(end, inner, n, half * gx * tx - push * my * wx, blocks[0])
        _add_chord(end, inner, n, half * gx * ty - push * (0.5 * w + my * wy), blocks[1])
        _add_chord(end, inner, n, half * gy * tx + push * (0.5 * w + mx * wx), blocks[2])
        _add_chord(end, inner, n, half * gy * ty + push * mx * wy, blocks[3])
        turn, change = 2.0 * math.atan(0.5 * c), 1.0 / (1.0 + 0.25 * c * c)
        mean = turn / c if c != 0.0 else 1.0
        bend = (change - mean) / c if abs(c) > 1e-4 else -c / 6.0
        root[0], root[1] = -half * change * gx, -half * change * gy
        root[2], root[3] = -half * mean * tx, -half * mean * ty
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


@called()
def _project(x, y, root, tip, lead, roots, tips, out):
    """A covector of the control points in (w, tip, root) by the maps of both ends (8,)."""
    n = x.size
    k, held = 2 * (n - 2 * lead), 1.0 if lead == 2 else 0.0
    for i in range(lead, n - lead):
        out[2 * (i - lead)], out[2 * (i - lead) + 1] = x[i], y[i]
    if lead == 2:
        out[k] = root[0] * x[1] + root[1] * y[1]
        out[k + 1] = tip[0] * x[n - 2] + tip[1] * y[n - 2]
        k += 2
    if tips >= 0:
        out[k], out[k + 1] = x[n - 1] + held * x[n - 2], y[n - 1] + held * y[n - 2]
        out[k + 2] = tip[2] * x[n - 2] + tip[3] * y[n - 2] + tip[4] * x[n - 1] + tip[5] * y[n - 1]
        k += 3
    if roots >= 0:
        out[k], out[k + 1] = x[0] + held * x[1], y[0] + held * y[1]
        out[k + 2] = root[2] * x[1] + root[3] * y[1] + root[4] * x[0] + root[5] * y[0]


@called()
def _combine(row, inner, outer, half, n, m, size, h):
    """A row of h from those of ``half``: the inner point's by m[0:2], the outer one's by m[2:4]."""
    a, b, c, d = m[0], m[1], m[2], m[3]
    x, y, u, v = half[inner], half[n + inner], half[outer], half[n + outer]
    for j in range(size):
        h[row, j] = a * x[j] + b * y[j] + c * u[j] + d * v[j]


@called()
def _add_turning(row, turn, maps, ends, fx, fy, ox, oy, h):
    """(dD)^T times the forces f of the inner point and o of the outer one of an end that turns."""
    slope, s = maps[7], maps[6]
    h[row, turn] += 0.5 * slope * (ends[2] * fy - ends[3] * fx)
    h[turn, row] += 0.5 * (maps[0] * fy - maps[1] * fx)
    h[turn, turn] -= (
        0.5 * slope * (ends[0] * (fx + ox) + ends[1] * (fy + oy) + s * (ends[2] * fx + ends[3] * fy))
    )


@called()
def _combine_end(row, inner, outer, half, n, maps, held, size, h, m):
    """The three rows of an end that moves, its inner point with it or not."""
    m[0], m[1], m[2], m[3] = held, 0.0, 1.0, 0.0
    _combine(row, inner, outer, half, n, m, size, h)
    m[0], m[1], m[2], m[3] = 0.0, held, 0.0, 1.0
    _combine(row + 1, inner, outer, half, n, m, size, h)
    m[0], m[1], m[2], m[3] = maps[2], maps[3], maps[4], maps[5]
    _combine(row + 2, inner, outer, half, n, m, size, h)


@part()
def _project_columns(s, strips, work):
    """The tangent with the inertia by changes of the element coordinates: forces on the control points."""
    n, lead, roots, tips = strips.mass.shape[1], strips.lead, strips.roots[s], strips.tips[s]
    blocks, half, root, tip = work.blocks, work.half, work.maps[s, 0, 8:], work.maps[s, 1, 8:]
    for i in range(n):
        for j in range(n):
            blocks[0, i * n + j] += work.stiff[s, i, j]
            blocks[3, i * n + j] += work.stiff[s, i, j]
    for i in range(n):
        begin, end = i * n, i * n + n
        _project(blocks[0, begin:end], blocks[1, begin:end], root, tip, lead, roots, tips, half[i])
        _project(blocks[2, begin:end], blocks[3, begin:end], root, tip, lead, roots, tips, half[n + i])


@part()
def to_reduced(s, strips, work):
    """Force, tangent and coupling of a strip in its element coordinates; returns their number.

    The inertia is added to the tangent on the way.
    """
    n, lead, own, held = strips.mass.shape[1], strips.lead, strips.own, 1.0 if strips.lead == 2 else 0.0
    roots, tips, root, tip = strips.roots[s], strips.tips[s], work.maps[s, 0], work.maps[s, 1]
    half, g, h, force, m, k = work.half, work.g[s], work.h[s], work.force[s], work.mix, own
    size = own + (3 if tips >= 0 else 0) + (3 if roots >= 0 else 0)
    _project_columns(s, strips, work)
    for i in range(lead, n - lead):
        for j in range(size):
            h[2 * (i - lead), j] = half[i, j]
            h[2 * (i - lead) + 1, j] = half[n + i, j]
    if lead == 2:
        m[2] = m[3] = 0.0
        m[0], m[1] = root[0], root[1]
        _combine(own - 2, 1, 0, half, n, m, size, h)
        m[0], m[1] = tip[0], tip[1]
        _combine(own - 1, n - 2, n - 1, half, n, m, size, h)
    _project(force[0], force[1], root, tip, lead, roots, tips, g)
    if tips >= 0:
        _combine_end(k, n - 2, n - 1, half, n, tip, held, size, h, m)
        _add_turning(
            own - 1, k + 2, tip, work.ends[s, 1], held * force[0, n - 2], held * force[1, n - 2],
            force[0, n - 1], force[1, n - 1], h,
        )  # fmt: skip
        k += 3
    if roots >= 0:
        _combine_end(k, 1, 0, half, n, root, held, size, h, m)
        _add_turning(
            own - 2, k + 2, root, work.ends[s, 0], held * force[0, 1], held * force[1, 1], force[0, 0],
            force[1, 0], h,
        )  # fmt: skip
    for c in range(strips.compliance.shape[1]):
        pull, along = work.pull[c], work.along[c]
        _project(pull[:n], pull[n:], root, tip, lead, roots, tips, work.left[c])
        _project(along[:n], along[n:], root[8:], tip[8:], lead, roots, tips, work.right[s, c])
    return size


@part()
def condense(s, size, strips, work):
    """Eliminate a strip's inner axial forces and own coordinates from g and h in place; returns its size.

    Outer axial forces follow behind the ends, their rows combined exactly (``spline_model.strip.condense``).
    """
    count, outer, own = strips.compliance.shape[1], strips.outer, strips.own
    g, h, left, right, gap = work.g[s], work.h[s], work.left, work.right[s], work.gap[s]
    for k in range(count):
        gain = strips.gain[s, k]
        push = gain * gap[k]
        for i in range(size):
            share = gain * left[k, i]
            g[i] += push * left[k, i]
            for j in range(size):
                h[i, j] += share * right[k, j]
    for k in range(outer):
        rest = 1.0 - strips.gain[s, k] * strips.compliance[s, k]
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
