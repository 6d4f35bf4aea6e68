"""The ends of a strip: their frames, what moves with them, and roots that turn in what they are cut from.

Where roots turn (``effects.RootCompliance``) the strips have a point more, the first in the order of
elimination, that is on no curve: its coordinates are the turns of the root's and the tip's frame against
their bodies, of which P_1 and P_(n-2) know alone. Springs hold them. Where strips shear
(``effects.Shear``) they have another such point: how far P_(n-1), with P_(n-2), is from what the tip is
clamped to, in the ground's frame, against a spring as well.
"""

from __future__ import annotations

import math

from spline_model.strip.compiled import called


@called()
def end_frame(body, numbers, end, bend, pose, out):
    """Point, direction and the body's centre of a clamped end: out (6,) = x, y, cos, sin, X, Y.

    end: ROOT or TIP, where the end's frame stands in the strip's numbers; bend: what its root turns [rad].
    """
    px, py, turn = numbers[end], numbers[end + 1], numbers[end + 2] + bend
    if body < 0:
        out[0], out[1], out[4], out[5] = px, py, 0.0, 0.0
        out[2], out[3] = math.cos(turn), math.sin(turn)
    else:
        at = 3 * body
        x, y, angle = pose[at], pose[at + 1], pose[at + 2]
        c, d = math.cos(angle), math.sin(angle)
        out[0], out[1] = x + c * px - d * py, y + d * px + c * py
        out[2], out[3] = math.cos(angle + turn), math.sin(angle + turn)
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


@called()
def by_roots(v, at, points, out):
    """Add a covector's entries at P_1 and P_(n-2), from v[at] on, in the turns of both roots to out[:2]."""
    for e in range(2):
        inner, outer = at + 2 * e, at + 6 - 2 * e
        x, y = points[inner] - points[outer], points[inner + 1] - points[outer + 1]
        out[e] += x * v[inner + 1] - y * v[inner]


@called()
def add_roots(at, special, behind, tip, root, ends, points, gradient, hessian, line, h, g, couplings, count):
    """Add the turns of both roots to a strip's element coordinates, which hold their springs already.

    at: place of P_1; special: columns of the ends in ``hessian``, whose block is symmetric; behind: place of
    the poses; couplings: first of the ``count`` rows of the axial forces in h.
    """
    by_roots(gradient, at, points, g)
    axial = hessian.shape[1]
    for e in range(2):
        inner, outer = at + 2 * e, at + 6 - 2 * e
        x, y = points[inner] - points[outer], points[inner + 1] - points[outer + 1]
        fx, fy = gradient[inner], gradient[inner + 1]
        for j in range(2, at):
            h[e, j] += x * hessian[j, inner + 1] - y * hessian[j, inner]
        for i in range(8):
            line[i] = x * hessian[inner + 1, at + i] - y * hessian[inner, at + i] if i < special else 0.0
        to_ends(line, 0, ends, tip, root, h[e], at, behind)
        mine, pull = 2 * e, x * fx + y * fy
        h[e, e] += x * line[mine + 1] - y * line[mine] - pull
        if e == 0:
            x, y = points[at + 2] - points[at + 4], points[at + 3] - points[at + 5]
            h[0, 1] += x * line[3] - y * line[2]
            x, y = points[inner] - points[outer], points[inner + 1] - points[outer + 1]
        h[e, at + e] += ends[mine] * fy - ends[mine + 1] * fx
        if e == 0 and root:
            h[0, behind + 2 + 3 * tip] -= pull
        if e == 1 and tip:
            h[1, behind + 2] -= pull
        for k in range(count):
            row = hessian[axial + k]
            h[couplings + k, e] += x * row[inner + 1] - y * row[inner]


@called()
def by_tip(v, at, place, out):
    """Add a covector's entries at P_(n-2) and P_(n-1), from v[at] on, in the tip's offset to out[place:]."""
    for c in range(2):
        out[place + c] += v[at + 2 + c] + v[at + 4 + c]


@called()
def add_shear(
    at, special, behind, tip, root, ends, points, gradient, hessian, line, h, g, couplings, count, place
):
    """Add the offset of the tip to a strip's element coordinates, as ``add_roots`` does the turns; they stand
    at ``place``, behind these turns."""
    axial = hessian.shape[1]
    by_tip(gradient, at, place, g)
    for c in range(2):
        row, inner, outer = place + c, at + 2 + c, at + 4 + c
        for j in range(place + 2, at):
            h[row, j] += hessian[j, inner] + hessian[j, outer]
        for i in range(8):
            line[i] = hessian[inner, at + i] + hessian[outer, at + i] if i < special else 0.0
        to_ends(line, 0, ends, tip, root, h[row], at, behind)
        for d in range(c, 2):
            h[row, place + d] += line[2 + d] + line[4 + d]
        for e in range(place):  # the turns of roots
            mine, there = at + 2 * e, at + 6 - 2 * e
            x, y = points[mine] - points[there], points[mine + 1] - points[there + 1]
            h[e, row] += x * line[2 * e + 1] - y * line[2 * e]
        for k in range(count):
            h[couplings + k, row] += hessian[axial + k, inner] + hessian[axial + k, outer]
