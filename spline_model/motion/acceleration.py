"""Accelerations of a free mechanism in its reduced coordinates, strip by strip, compiled.

    r = (poses of the bodies, free strip ends among them; P_2 ... P_(n-3), s_A, s_B of each strip)

Clamps hold by construction. A strip's mass is constant in its control points and the same along both axes,
B: its inner points i follow from its four end points p = (1, n - 2, n - 1, 0),

    A_i = -B_ii^-1 f_i - W A_p,   W = B_ii^-1 B_ip,   (B_pp - B_pi W) A_p = -(f_p - W^T f_i),

whose accelerations are A_p = T (s_A'', s_B'', bodies'') + what the rates make of them. s_A, s_B and the axial
forces of strips that cannot stretch are eliminated, and the bodies' small system remains. The rows of such
forces come with the inner points eliminated, and times a root of B_ii^-1 in them (``Grid.ties``).
"""

from __future__ import annotations

import math

from spline_model.motion.forces import (
    INNER_ROOT,
    INNER_TIP,
    ROOT,
    TIP,
    add_forces,
    add_ties,
    move,
    place,
)
from spline_model.reduced.assembly import scatter
from spline_model.strip.compiled import part
from spline_model.strip.condense import eliminate


@part()
def _to_ends(c, ends, lever, tip, root, out):
    """A covector (2, 4) of the end points in (s_A, s_B, pose of the tip's body, of the root's): out (8,)."""
    out[0] = ends[0, 2] * c[0, INNER_ROOT] + ends[0, 3] * c[1, INNER_ROOT]
    out[1] = ends[1, 2] * c[0, INNER_TIP] + ends[1, 3] * c[1, INNER_TIP]
    k = 2
    if tip:
        out[k], out[k + 1] = c[0, INNER_TIP] + c[0, TIP], c[1, INNER_TIP] + c[1, TIP]
        out[k + 2] = lever[0] * c[0, INNER_TIP] + lever[1] * c[1, INNER_TIP]
        out[k + 2] += lever[2] * c[0, TIP] + lever[3] * c[1, TIP]
        k += 3
    if root:
        out[k], out[k + 1] = c[0, INNER_ROOT] + c[0, ROOT], c[1, INNER_ROOT] + c[1, ROOT]
        out[k + 2] = lever[4] * c[0, INNER_ROOT] + lever[5] * c[1, INNER_ROOT]
        out[k + 2] += lever[6] * c[0, ROOT] + lever[7] * c[1, ROOT]


@part()
def _mass_of_ends(m, ends, lever, tip, root, first, h):
    """Upper mass matrix T^T m T of the end points, those of the bodies from the place ``first`` on."""
    ax, ay, bx, by = ends[0, 2], ends[0, 3], ends[1, 2], ends[1, 3]
    m00, m01, m02, m03, m11 = m[0, 0], m[0, 1], m[0, 2], m[0, 3], m[1, 1]
    m12, m13, m22, m23, m33 = m[1, 2], m[1, 3], m[2, 2], m[2, 3], m[3, 3]
    h[0, 0], h[1, 1] = m00 * (ax * ax + ay * ay), m11 * (bx * bx + by * by)
    h[0, 1] = m01 * (ax * bx + ay * by)
    ux, uy, vx, vy = lever[0], lever[1], lever[2], lever[3]
    px, py, qx, qy = lever[4], lever[5], lever[6], lever[7]
    k = first
    if tip:
        a, b, c, d = m01 + m02, m11 + m12, m12 + m22, m11 + 2.0 * m12 + m22
        h[0, k], h[0, k + 1], h[1, k], h[1, k + 1] = a * ax, a * ay, b * bx, b * by
        h[0, k + 2] = ax * (m01 * ux + m02 * vx) + ay * (m01 * uy + m02 * vy)
        h[1, k + 2] = bx * (m11 * ux + m12 * vx) + by * (m11 * uy + m12 * vy)
        h[k, k], h[k, k + 1], h[k, k + 2] = d, 0.0, b * ux + c * vx
        h[k + 1, k + 1], h[k + 1, k + 2] = d, b * uy + c * vy
        h[k + 2, k + 2] = m11 * (ux * ux + uy * uy) + 2.0 * m12 * (ux * vx + uy * vy)
        h[k + 2, k + 2] += m22 * (vx * vx + vy * vy)
        k += 3
    if root:
        a, b, c, d = m00 + m03, m01 + m13, m03 + m33, m00 + 2.0 * m03 + m33
        h[0, k], h[0, k + 1], h[1, k], h[1, k + 1] = a * ax, a * ay, b * bx, b * by
        h[0, k + 2] = ax * (m00 * px + m03 * qx) + ay * (m00 * py + m03 * qy)
        h[1, k + 2] = bx * (m01 * px + m13 * qx) + by * (m01 * py + m13 * qy)
        h[k, k], h[k, k + 1], h[k, k + 2] = d, 0.0, a * px + c * qx
        h[k + 1, k + 1], h[k + 1, k + 2] = d, a * py + c * qy
        h[k + 2, k + 2] = m00 * (px * px + py * py) + 2.0 * m03 * (px * qx + py * qy)
        h[k + 2, k + 2] += m33 * (qx * qx + qy * qy)
        if tip:
            i, c, d = first, m02 + m23, m01 + m02
            h[i, k] = h[i + 1, k + 1] = b + c
            h[i, k + 1] = h[i + 1, k] = 0.0
            h[i, k + 2], h[i + 1, k + 2] = d * px + (m13 + m23) * qx, d * py + (m13 + m23) * qy
            h[i + 2, k], h[i + 2, k + 1] = b * ux + c * vx, b * uy + c * vy
            h[i + 2, k + 2] = m01 * (ux * px + uy * py) + m13 * (ux * qx + uy * qy)
            h[i + 2, k + 2] += m02 * (vx * px + vy * py) + m23 * (vx * qx + vy * qy)


@part()
def _set_drift(s, at, w, strips, room):
    """Accelerations (2, 4) of the end points that the rates make."""
    drift, ends, lever, last = room.drift[s], room.ends[s], room.lever[s], at + strips.own - 2
    for e in range(2):
        body = strips.roots[s] if e == 0 else strips.tips[s]
        inner, outer, turn = (INNER_ROOT, ROOT, 4) if e == 0 else (INNER_TIP, TIP, 0)
        spin = w[3 * body + 2] if body >= 0 else 0.0
        square, both = spin * spin, 2.0 * spin * w[last + e]
        drift[0, outer], drift[1, outer] = -square * lever[turn + 3], square * lever[turn + 2]
        drift[0, inner] = -square * lever[turn + 1] - both * ends[e, 3]
        drift[1, inner] = square * lever[turn] + both * ends[e, 2]


@part()
def _gather_ends(v, follow, c):
    """The four end points' entries of a covector (n,), inner points condensed by W."""
    n = v.size
    c[INNER_ROOT], c[INNER_TIP], c[TIP], c[ROOT] = v[1], v[n - 2], v[n - 1], v[0]
    for p in range(4):
        total = 0.0
        for i in range(follow.shape[1]):
            total += follow[p, i] * v[i + 2]
        c[p] -= total


@part()
def _strip_system(s, tied, grid, strips, room):
    """The equations of a strip's ends in g and h, and their size; its inner points are eliminated."""
    force, follow, drift = room.force[s], grid.follow[s], room.drift[s]
    count = follow.shape[1]
    tip, root, m = strips.tips[s] >= 0, strips.roots[s] >= 0, grid.ends[s]
    first, g, h, c = 2 + max(tied - 1, 0), room.g[s], room.h[s], room.covector
    ends, lever, line, inner = room.ends[s], room.lever[s], room.line, room.inner
    outer = 2 + 3 * tip + 3 * root
    _mass_of_ends(m, ends, lever, tip, root, first, h)
    for k in range(2):
        _gather_ends(force[k], follow, c[k])
        d0, d1, d2, d3 = drift[k, 0], drift[k, 1], drift[k, 2], drift[k, 3]
        for p in range(4):
            c[k, p] = -(c[k, p] + m[p, 0] * d0 + m[p, 1] * d1 + m[p, 2] * d2 + m[p, 3] * d3)
    _to_ends(c, ends, lever, tip, root, line)
    for i in range(outer):
        g[i if i < 2 else first + i - 2] = line[i]
    if tied > 0:
        for k in range(2):
            for i in range(count):
                inner[k, i] = 0.0
                for j in range(count):
                    inner[k, i] += grid.white[s, i, j] * force[k, j + 2]
    for a in range(tied):
        row, mine = room.rows[s, a], (first + outer - 2 if a == 0 else a + 1)
        left = -room.rest[a]
        for k in range(2):
            for p in range(4):
                left -= row[k, p] * drift[k, p]
            for i in range(count):
                left += row[k, i + 4] * inner[k, i]
        g[mine] = left
        _to_ends(row, ends, lever, tip, root, line)
        for i in range(outer):
            place = i if i < 2 else first + i - 2
            h[min(place, mine), max(place, mine)] = line[i]
        for b in range(a, tied):
            other, total = (first + outer - 2 if b == 0 else b + 1), 0.0
            for k in range(2):
                for i in range(4, 4 + count):
                    total -= row[k, i] * room.rows[s, b, k, i]
            h[min(mine, other), max(mine, other)] = total
    return first + outer - 2 + (1 if tied > 0 else 0)


@part()
def _solve_ends(s, tied, size, poses, strips, room, push):
    """A strip's unknowns y from its bodies' and the rest of its equations, and its axial forces."""
    g, h, y, first = room.g[s], room.h[s], room.y, 2 + max(tied - 1, 0)
    tip, root, k = strips.tips[s], strips.roots[s], first
    if tip >= 0:
        for i in range(3):
            y[k + i] = push[3 * tip + i]
        k += 3
    if root >= 0:
        for i in range(3):
            y[k + i] = push[3 * root + i]
        k += 3
    if tied > 0:
        y[k] = room.axial[s, 0] = room.load[poses + s]
    for i in range(first - 1, -1, -1):
        total = g[i]
        for j in range(i + 1, size):
            total -= h[i, j] * y[j]
        y[i] = total / h[i, i]
    for a in range(1, tied):
        room.axial[s, a] = y[a + 1]


@part()
def _follow_ends(s, at, tied, grid, strips, room, push):
    """Accelerations of a strip's ends (2, 4) from its unknowns and its bodies, and of its own coordinates."""
    count, y, last = grid.follow.shape[2], room.y, at + strips.own - 2
    force, drift, tip, root = room.force[s], room.drift[s], strips.tips[s], strips.roots[s]
    c, lever, ends, pull = room.covector, room.lever[s], room.ends[s], room.inner
    push[last], push[last + 1] = y[0], y[1]
    for i in range(2):
        c[i, INNER_ROOT] = drift[i, INNER_ROOT] + y[0] * ends[0, 2 + i]
        c[i, INNER_TIP] = drift[i, INNER_TIP] + y[1] * ends[1, 2 + i]
        c[i, TIP], c[i, ROOT] = drift[i, TIP], drift[i, ROOT]
        if tip >= 0:
            shift, spin = push[3 * tip + i], push[3 * tip + 2]
            c[i, INNER_TIP] += shift + spin * lever[i]
            c[i, TIP] += shift + spin * lever[2 + i]
        if root >= 0:
            shift, spin = push[3 * root + i], push[3 * root + 2]
            c[i, INNER_ROOT] += shift + spin * lever[4 + i]
            c[i, ROOT] += shift + spin * lever[6 + i]
        for q in range(count):
            pull[i, q] = 0.0
            for a in range(tied):
                pull[i, q] += room.axial[s, a] * room.rows[s, a, i, q + 4]
        for j in range(count):
            total = 0.0
            for q in range(count):
                total -= grid.inverse[s, j, q] * force[i, q + 2] + grid.white[s, q, j] * pull[i, q]
            for p in range(4):
                total -= grid.follow[s, p, j] * c[i, p]
            push[at + 2 * j + i] = total


@part()
def _solve_bodies(poses, tangent, load, push):
    """Accelerations of the bodies, and in place of the load the axial forces beside them; upper tangent."""
    eliminate(load.size, load.size, load, tangent)
    for i in range(load.size - 1, -1, -1):
        for j in range(i + 1, load.size):
            load[i] -= tangent[i, j] * load[j]
        load[i] /= tangent[i, i]
        if i < poses:
            push[i] = load[i]


@part()
def accelerate(r, w, sharpness, grid, strips, masses, room, push):
    """Fill the accelerations (R,) at r with rates w; sharpness [1/s]: as of ``add_ties``."""
    poses, own = masses.inertia.size, strips.own
    tangent, load = room.tangent, room.load
    for b in range(poses // 3):
        room.turns[b, 0], room.turns[b, 1] = math.cos(r[3 * b + 2]), math.sin(r[3 * b + 2])
    for i in range(load.size):
        load[i] = masses.weight[i] if i < poses else 0.0
        for j in range(i, load.size):
            tangent[i, j] = 0.0
        tangent[i, i] = masses.inertia[i] if i < poses else 0.0
    for s in range(strips.roots.size):
        at, tied = poses + s * own, grid.tied[s]
        place(s, at, r, grid, strips, room)
        add_forces(s, tied, strips, grid, room.points[s], room.at, room.axial[s], room.force[s])
        _set_drift(s, at, w, strips, room)
        if tied > 0:
            move(s, at, w, strips, room)
            add_ties(s, tied, sharpness, strips, grid, room.speed[s], room.at, room.rows[s], room.rest)
        elif grid.outer:
            tangent[poses + s, poses + s] = -1.0
        size = _strip_system(s, tied, grid, strips, room)
        first = 2 + max(tied - 1, 0)
        eliminate(first, size, room.g[s], room.h[s])
        scatter(first, size, strips.tips[s], strips.roots[s], poses + s, room.g[s], room.h[s], load, tangent)
    _solve_bodies(poses, tangent, load, push)
    for s in range(strips.roots.size):
        tied = grid.tied[s]
        size = 2 + max(tied - 1, 0) + (3 if strips.tips[s] >= 0 else 0) + (3 if strips.roots[s] >= 0 else 0)
        size += 1 if tied > 0 else 0
        _solve_ends(s, tied, size, poses, strips, room, push)
        _follow_ends(s, poses + s * own, tied, grid, strips, room, push)
