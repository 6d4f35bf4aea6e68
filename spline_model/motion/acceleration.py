"""Accelerations of a free mechanism in its coordinates y, strip by strip, compiled.

Clamps hold by construction. A strip's mass is constant in its control points and the same along both axes,
B: its inner points i follow from its four end points p, which are last in the order of elimination,

    A_i = -B_ii^-1 f_i - W A_p,   W = B_ii^-1 B_ip,   (B_pp - B_pi W) A_p = -(f_p - W^T f_i),

whose accelerations are A_p = T (s_A'', s_B'', bodies'') + terms quadratic in the rates. s_A and s_B are
eliminated, and the bodies' small system remains. Axial forces follow at each mode from its strain over its
compliance.
"""

from __future__ import annotations

import math

from spline_model.frames import draw, fold_moving, spread
from spline_model.reduced.arrays import ARMS, FORCE
from spline_model.reduced.assembly import begin, place_of, scatter
from spline_model.strip.compiled import part
from spline_model.strip.condense import eliminate
from spline_model.strip.element import (
    FORCE_AT,
    GIVEN,
    GRADIENT,
    ON_POINTS,
    SPEED_AT,
    STRAIN,
    STRETCHING,
    WEIGHT,
)
from spline_model.strip.ends import move_points, place_in_frames, rates_of_end, to_ends, turned_frame
from spline_model.strip.points import add_slopes, forces_of_strains, four, given_at, slopes_at, take_strains


@part()
def _push(s, a, shape, strips, local):
    """The gradient of a placed strip, with the axial forces that its strains give."""
    numbers, lanes, gradient = strips.numbers[s], local.lanes[s], local.nodal[s, GRADIENT]
    take_strains(s, shape, strips, local)
    forces_of_strains(s, strips, local, a)
    given_at(s, a, strips, lanes)
    given = (
        lanes[SPEED_AT],
        lanes[GIVEN],
        lanes[GIVEN + 1],
        lanes[GIVEN + 2],
        lanes[GIVEN + 4],
        lanes[FORCE_AT],
    )
    rows = four(lanes, 0) + four(lanes, 4) + given
    slopes_at(strips.measure, numbers[STRAIN], numbers[STRETCHING], shape.rule[WEIGHT], *rows)
    for i in range(gradient.size):
        gradient[i] = -numbers[ON_POINTS + i]
    add_slopes(shape.order.size, shape.curve[0], shape.curve[1], four(lanes, 4), gradient)


@part()
def _set_mass(e, f, m, ends, tip, root, h):
    """Upper mass matrix T^T m T of the end points at an end e and at f, 0 the root and 1 the tip.

    Bodies follow behind s_A and s_B, that of the tip first.
    """
    x, y, lever, far = ends[2 * e], ends[2 * e + 1], 8 - 4 * e, 8 - 4 * f
    ii, io, oi, oo = m[e, f], m[e, 3 - f], m[3 - e, f], m[3 - e, 3 - f]
    mine, other = 2 if e else 2 + 3 * tip, 2 if f else 2 + 3 * tip
    if f >= e:
        h[e, f] = ii * (x * ends[2 * f] + y * ends[2 * f + 1])
    if not (tip if f else root):
        return
    px, py, qx, qy = ends[far], ends[far + 1], ends[far + 2], ends[far + 3]
    inner_x, inner_y = ii * px + io * qx, ii * py + io * qy
    outer_x, outer_y = oi * px + oo * qx, oi * py + oo * qy
    h[e, other], h[e, other + 1], h[e, other + 2] = (ii + io) * x, (ii + io) * y, x * inner_x + y * inner_y
    if mine > other or not (tip if e else root):
        return
    ax, ay, bx, by = ends[lever], ends[lever + 1], ends[lever + 2], ends[lever + 3]
    h[mine, other] = h[mine + 1, other + 1] = ii + io + oi + oo
    h[mine, other + 1] = 0.0
    h[mine, other + 2], h[mine + 1, other + 2] = inner_x + outer_x, inner_y + outer_y
    h[mine + 2, other + 2] = ax * inner_x + ay * inner_y + bx * outer_x + by * outer_y
    if mine < other:
        h[mine + 1, other] = 0.0
        h[mine + 2, other] = (ii + io) * ax + (oi + oo) * bx
        h[mine + 2, other + 1] = (ii + io) * ay + (oi + oo) * by


@part()
def _set_drift(s, at, w, strips, ends, drift):
    """Accelerations (8,) of the end points that the rates make."""
    for e in range(2):
        inner, outer, stick, lever = 2 * e, 6 - 2 * e, 2 * e, 8 - 4 * e
        _, _, spin = rates_of_end(s, e, w, strips)
        square, both = spin * spin, 2.0 * spin * w[at + e]
        drift[outer], drift[outer + 1] = -square * ends[lever + 3], square * ends[lever + 2]
        drift[inner] = -square * ends[lever + 1] - both * ends[stick + 1]
        drift[inner + 1] = square * ends[lever] + both * ends[stick]


@part()
def _strip_system(s, grid, strips, local, room):
    """The equations of a strip's ends in g and h, and their size; its inner points are eliminated."""
    force, follow, drift, m = local.nodal[s, GRADIENT], grid.follow[s], room.drift[s], grid.ends[s]
    count, tip, root = follow.shape[1], strips.tips[s] >= 0, strips.roots[s] >= 0
    h, c, ends = room.h[s], room.covector, local.map[s]
    _set_mass(0, 0, m, ends, tip, root, h)
    _set_mass(0, 1, m, ends, tip, root, h)
    _set_mass(1, 0, m, ends, tip, root, h)
    _set_mass(1, 1, m, ends, tip, root, h)
    for p in range(4):
        x, y = -force[2 * (count + p)], -force[2 * (count + p) + 1]
        for i in range(count):
            x += follow[p, i] * force[2 * i]
            y += follow[p, i] * force[2 * i + 1]
        for q in range(4):
            x -= m[p, q] * drift[2 * q]
            y -= m[p, q] * drift[2 * q + 1]
        c[2 * p], c[2 * p + 1] = x, y
    to_ends(c, 0, ends, tip, root, room.g[s], 0, 2)
    return 2 + 3 * tip + 3 * root


@part()
def _substitute(count, size, g, h, x):
    """Solve the first ``count`` of eliminated equations for x (size,), whose other entries are known."""
    for i in range(count - 1, -1, -1):
        total = g[i]
        for j in range(i + 1, size):
            total -= h[i, j] * x[j]
        x[i] = total / h[i, i]


@part()
def _solve_ends(s, size, strips, room, push):
    """A strip's s_A'' and s_B'', into ``solved``, from its bodies' and the rest of its equations."""
    for i in range(2, size):
        room.solved[i] = push[place_of(i - 2, strips.tips[s], strips.roots[s], 0)]
    _substitute(2, size, room.g[s], room.h[s], room.solved)


@part()
def _follow_ends(s, at, grid, strips, local, room, push):
    """Accelerations of a strip's own coordinates from those of its ends and bodies."""
    count, force, c = grid.follow.shape[2], local.nodal[s, GRADIENT], room.along
    push[at + 2 * count], push[at + 2 * count + 1] = room.solved[0], room.solved[1]
    move_points(s, at, push, strips, local, c)
    for i in range(8):
        c[2 * count + i] += room.drift[s, i]
    for j in range(count):
        x = y = 0.0
        for q in range(count):
            x -= grid.inverse[s, j, q] * force[2 * q]
            y -= grid.inverse[s, j, q] * force[2 * q + 1]
        for p in range(4):
            x -= grid.follow[s, p, j] * c[2 * (count + p)]
            y -= grid.follow[s, p, j] * c[2 * (count + p) + 1]
        push[at + 2 * j], push[at + 2 * j + 1] = x, y


@part()
def accelerate(y, w, grid, arrays, masses, room, push):
    """Fill the accelerations (Y,) and the axial forces in y at y with rates w."""
    bodies, strips, shape, local = arrays.bodies, arrays.strips, arrays.shape, arrays.local
    poses, n, modes = bodies.rest.size, shape.order.size, strips.compliance.shape[1]
    own, tangent, load = 2 * n - 6, room.tangent, room.load
    arms, pull = arrays.space.vectors[ARMS], arrays.space.vectors[FORCE]
    begin(y, 0.0, bodies, arrays.space)
    spread(w, bodies.frames, arms)
    for b in range(poses // 3):
        room.turns[b, 0], room.turns[b, 1] = math.cos(y[3 * b + 2]), math.sin(y[3 * b + 2])
    for i in range(poses):
        load[i] = -pull[i]
        for j in range(i, poses):
            tangent[i, j] = 0.0
        tangent[i, i] = masses.inertia[i]
    for s in range(strips.roots.size):
        at, tip, root = poses + s * (own + modes), strips.tips[s], strips.roots[s]
        turned_frame(root, y, grid.frames[s, 0], room.turns, room.ends[0])
        turned_frame(tip, y, grid.frames[s, 1], room.turns, room.ends[1])
        place_in_frames(s, y[at : at + own], room.ends[0], room.ends[1], strips, local)
        _push(s, y[at + own : at + own + modes], shape, strips, local)
        _set_drift(s, at + own - 2, w, strips, local.map[s], room.drift[s])
        size = _strip_system(s, grid, strips, local, room)
        eliminate(2, size, room.g[s], room.h[s])
        scatter(2, size, tip, root, poses, room.g[s], room.h[s], load, tangent)
    if bodies.frames.place.size > 0:
        fold_moving(w, tangent, load, bodies.frames, arms)
    eliminate(poses, poses, load, tangent)
    _substitute(poses, poses, load, tangent, push)
    spread(push, bodies.frames, arms)
    draw(w, push, bodies.frames, arms)
    for s in range(strips.roots.size):
        size = 2 + 3 * (strips.tips[s] >= 0) + 3 * (strips.roots[s] >= 0)
        _solve_ends(s, size, strips, room, push)
        _follow_ends(s, poses + s * (own + modes), grid, strips, local, room, push)
