"""Between control points of a strip and coordinates of its element: its ends and what goes with them."""

from __future__ import annotations

import numpy as np

from spline_model.strip.compiled import called, part
from spline_model.strip.element import GRADIENT, LAST, POINTS, REACH, ROOT, TIP


@called()
def _end_frame(body, numbers, end, pose, out):
    """Point, direction and the body's centre of a clamped end: out (6,) = x, y, cos, sin, X, Y.

    end: ROOT or TIP, where the end's frame stands in the strip's numbers.
    """
    px, py, turn = numbers[end], numbers[end + 1], numbers[end + 2]
    if body < 0:
        out[0], out[1], out[4], out[5] = px, py, 0.0, 0.0
        out[2], out[3] = np.cos(turn), np.sin(turn)
    else:
        at = 3 * body
        x, y, angle = pose[at], pose[at + 1], pose[at + 2]
        c, d = np.cos(angle), np.sin(angle)
        out[0], out[1] = x + c * px - d * py, y + d * px + c * py
        out[2], out[3] = np.cos(angle + turn), np.sin(angle + turn)
        out[4], out[5] = x, y


@part()
def turned_frame(body, pose, frame, turns, out):
    """The same from point and direction (4,) on the body, by the cosine and sine of its angle."""
    if body < 0:
        out[0], out[1], out[2], out[3], out[4], out[5] = frame[0], frame[1], frame[2], frame[3], 0.0, 0.0
    else:
        x, y, c, d = pose[3 * body], pose[3 * body + 1], turns[body, 0], turns[body, 1]
        out[0], out[1] = x + c * frame[0] - d * frame[1], y + d * frame[0] + c * frame[1]
        out[2], out[3] = c * frame[2] - d * frame[3], d * frame[2] + c * frame[3]
        out[4], out[5] = x, y


@called()
def to_ends(v, at, ends, tip, root, out, first, behind):
    """A covector's entries at P_1, P_(n-2), P_(n-1), P_0, from v[at] on, in (s_A, s_B) and the ends' poses.

    The former go to out[first], the latter to out[behind] on.
    """
    out[first] = ends[0] * v[at] + ends[1] * v[at + 1]
    out[first + 1] = ends[2] * v[at + 2] + ends[3] * v[at + 3]
    k = behind
    if tip:
        out[k] = v[at + 2] + v[at + 4]
        out[k + 1] = v[at + 3] + v[at + 5]
        out[k + 2] = ends[4] * v[at + 2] + ends[5] * v[at + 3] + ends[6] * v[at + 4] + ends[7] * v[at + 5]
        k += 3
    if root:
        out[k] = v[at] + v[at + 6]
        out[k + 1] = v[at + 1] + v[at + 7]
        out[k + 2] = ends[8] * v[at] + ends[9] * v[at + 1] + ends[10] * v[at + 6] + ends[11] * v[at + 7]


@part()
def to_coordinates(s, v, last, ends, strips, out):
    """A covector v (2 n) of the control points in the coordinates of the element, its poses from last on."""
    first = v.size - 8
    for i in range(first):
        out[i] = v[i]
    to_ends(v, first, ends, strips.tips[s] >= 0, strips.roots[s] >= 0, out, first, last)


@part()
def rates_of_end(s, e, rate, strips):
    """Return the rates of what an end, e: 0 the root, 1 the tip, goes by: shift and turn of its body."""
    body = strips.tips[s] if e else strips.roots[s]
    x = y = turn = 0.0
    if body >= 0:
        x, y, turn = rate[3 * body], rate[3 * body + 1], rate[3 * body + 2]
    return x, y, turn


@part()
def move_points(s, at, rate, strips, local, along):
    """Rates (2 n) of the control points of a placed strip by those of its w, from rate[at] on, and poses."""
    ends, first = local.map[s], along.size - 8
    for i in range(first):
        along[i] = rate[at + i]
    for e in range(2):
        inner, outer, stick, lever, reach = first + 2 * e, first + 6 - 2 * e, 2 * e, 8 - 4 * e, at + first + e
        x, y, turn = rates_of_end(s, e, rate, strips)
        along[inner] = x + ends[lever] * turn + ends[stick] * rate[reach]
        along[inner + 1] = y + ends[lever + 1] * turn + ends[stick + 1] * rate[reach]
        along[outer], along[outer + 1] = x + ends[lever + 2] * turn, y + ends[lever + 3] * turn


@part()
def place_points(s, w, pose, strips, local):
    """Control points of strip s from its own coordinates w (W,) and the bodies' poses (3 B,), and its map."""
    root, tip = local.scratch[15], local.scratch[16]
    _end_frame(strips.roots[s], strips.numbers[s], ROOT, pose, root)
    _end_frame(strips.tips[s], strips.numbers[s], TIP, pose, tip)
    place_in_frames(s, w, root, tip, strips, local)


@part()
def place_in_frames(s, w, root, tip, strips, local):
    """The same from the frames of its ends (6,) as of ``end_frame``."""
    points, ends, frame, numbers = local.nodal[s, POINTS], local.map[s], root, strips.numbers[s]
    own = w.size
    inner = own - 2
    for i in range(inner):
        points[i] = w[i]
    kx, ky = numbers[REACH] * frame[2], numbers[REACH] * frame[3]
    points[inner], points[inner + 1] = frame[0] + w[own - 2] * kx, frame[1] + w[own - 2] * ky
    points[inner + 6], points[inner + 7] = frame[0], frame[1]
    ends[0], ends[1] = kx, ky
    ends[8], ends[9] = frame[5] - points[inner + 1], points[inner] - frame[4]
    ends[10], ends[11] = frame[5] - frame[1], frame[0] - frame[4]
    frame = tip
    kx, ky = -numbers[REACH + 1] * frame[2], -numbers[REACH + 1] * frame[3]
    points[inner + 2], points[inner + 3] = frame[0] + w[own - 1] * kx, frame[1] + w[own - 1] * ky
    points[inner + 4], points[inner + 5] = frame[0], frame[1]
    ends[2], ends[3] = kx, ky
    ends[4], ends[5] = frame[5] - points[inner + 3], points[inner + 2] - frame[4]
    ends[6], ends[7] = frame[5] - frame[1], frame[0] - frame[4]


@part()
def _own_rows(s, at, behind, tip, root, strips, local):
    """Rows of the points that are own coordinates, the gradient, and the coupling of the axial forces.

    at: place of P_1; behind: that of the poses.
    """
    hessian, h, ends = local.nodal[s], local.reduced[s], local.map[s]
    gradient, g, width, first = hessian[GRADIENT], h[LAST], h.shape[1], hessian.shape[1]
    for i in range(at):
        g[i] = gradient[i]
        row, target = hessian[i], h[i]
        for j in range(i, at):
            target[j] = row[j]
        to_ends(row, at, ends, tip, root, target, at, behind)
    to_ends(gradient, at, ends, tip, root, g, at, behind)
    for k in range(strips.compliance.shape[1]):
        row, target = hessian[first + k], h[width + k]
        for i in range(at):
            target[i] = row[i]
        to_ends(row, at, ends, tip, root, target, at, behind)


@part()
def _end_rows(s, at, behind, special, tip, root, local):
    """The ends among themselves: J^T (H J), J column by column; special: columns of the ends in H."""
    hessian, h, ends, lines = local.nodal[s], local.reduced[s], local.map[s], local.scratch
    for i in range(special):
        for j in range(i):
            hessian[at + i, at + j] = hessian[at + j, at + i]
    columns = 2 + 3 * tip + 3 * root
    for i in range(special):
        to_ends(hessian[at + i], at, ends, tip, root, lines[16], 0, 2)
        for c in range(columns):
            lines[c, i] = lines[16, c]
    for c in range(columns):
        to_ends(lines[c], 0, ends, tip, root, lines[8 + c], 0, 2)
    for c in range(columns):
        row = at + c if c < 2 else behind + c - 2
        for d in range(c, columns):
            h[row, at + d if d < 2 else behind + d - 2] = lines[8 + c, d]


@part()
def _add_turns(s, at, behind, tip, root, local):
    """Add what the gradient does as the directions turn in which the ends' points move."""
    h, ends, gradient = local.reduced[s], local.map[s], local.nodal[s, GRADIENT]
    if tip:
        turn = behind + 2
        x, y, bx, by = gradient[at + 4], gradient[at + 5], gradient[at + 2], gradient[at + 3]
        h[at + 1, turn] += ends[2] * by - ends[3] * bx
        h[turn, turn] += ends[6] * y - ends[7] * x + ends[4] * by - ends[5] * bx
    if root:
        turn = behind + 2 + 3 * tip
        x, y, bx, by = gradient[at + 6], gradient[at + 7], gradient[at], gradient[at + 1]
        h[at, turn] += ends[0] * by - ends[1] * bx
        h[turn, turn] += ends[10] * y - ends[11] * x + ends[8] * by - ends[9] * bx


@part()
def to_element(s, moving, inner, strips, local):
    """Gradient, upper Hessian and coupling of strip s in its element coordinates, into ``local.reduced``.

    inner: coupled axial forces beside w. Returns the number of coordinates but outer axial forces.
    """
    tip, root, at = strips.tips[s] >= 0, strips.roots[s] >= 0, local.nodal.shape[2] - 8
    behind, special = at + 2 + inner, 2 * moving - at
    _own_rows(s, at, behind, tip, root, strips, local)
    _end_rows(s, at, behind, special, tip, root, local)
    _add_turns(s, at, behind, tip, root, local)
    return behind + 3 * tip + 3 * root
