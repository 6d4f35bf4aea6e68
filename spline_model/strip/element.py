"""One strip between two end frames: energy, gradient and Hessian in its own coordinates and its ends' poses.

Clamps hold by construction. With a root (P0, phi_r) and a tip (P_(n-1), phi_t) that are fixed to
the ground or carried by bodies,

    P_1 = P_0 + s_A k_A (cos, sin)(phi_r),    P_(n-2) = P_(n-1) - s_B k_B (cos, sin)(phi_t),

k_A and k_B the distances at rest. Own coordinates w = (P_2 ... P_(n-3), s_A, s_B); axial forces a.
Control points stand in the order of elimination: P_2 ... P_(n-3), P_1, P_(n-2), P_(n-1), P_0. The
element's coordinates are (w, coupled axial forces, pose of the tip's body, pose of the root's, mean
axial force). Those of a grounded end do not exist; the last one only that of inextensible strips: no w
can give a straight strip another length, so its mean axial force cannot be condensed. All is
dimensionless (lengths over L, energy over EI/L) and in the ground's frame, so that dead loads are
constant.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.strip.compiled import kernel, part

Array = NDArray[np.float64]
GROUNDED = -1


class Shape(NamedTuple):
    """Basis at the G Gauss points, the same for all strips, points in the order of elimination.

    order (n,) control point at each place; d0, d1, d2 (G, n); beyond (G, n) integrals of the basis
    from u to 1; u, weight (G,).
    """

    order: NDArray[np.int64]
    d0: Array
    d1: Array
    d2: Array
    beyond: Array
    u: Array
    weight: Array


class Strips(NamedTuple):
    """What tells S strips from one another.

    speed, curvature, rigidity (S, G): J0, stress-free curvature and EI at the Gauss points;
    stretching (S,) EA of stretching by quadrature, 0 for the mixed form; strain (S,) natural strain;
    modes (S, G, K) of the axial force, orthonormal along the strip, of which ``split`` belong to the
    stretching and the others to the sliding of control points; compliance (S, K) of each; gain (S, K)
    the stiffness by which they are condensed; coupled: leading axial forces that stay beside w, where a
    compliance is too small to divide by or depends on the state; outer: 1 if the first of them, the
    mean, stays beside the bodies, or 0; roots, tips (S,) bodies or GROUNDED; root, tip (S, 3): clamped
    point in its body's frame, or on the ground, and direction at rest [rad]; reach (S, 2) k_A, k_B;
    dead (S, 2 n) dead load on the control points; weight (S, 2) dead load per du; measure: of all.
    """

    speed: Array
    curvature: Array
    rigidity: Array
    stretching: Array
    strain: Array
    modes: Array
    split: int
    compliance: Array
    gain: Array
    coupled: int
    outer: int
    roots: NDArray[np.int64]
    tips: NDArray[np.int64]
    root: Array
    tip: Array
    reach: Array
    dead: Array
    weight: Array
    measure: int


class Local(NamedTuple):
    """What one evaluation of S strips fills; E = W + coupled + 7 element coordinates, at most.

    points (S, 2 n); gradient (S, 2 n), hessian (S, 2 n, 2 n), coupling (S, K, 2 n) in the control
    points; moment (S, G); g (S, E), h (S, E, E), b and e (S, K, E), the coupling and its combination,
    gap (S, K), gram (S, K, K) derivative of -gap in a; map (S, 16) of the ends; lever (n,) moment of
    the tip's reaction about the control points; square, lines (8, 8) and line (8,): scratch.
    """

    points: Array
    gradient: Array
    hessian: Array
    coupling: Array
    moment: Array
    g: Array
    h: Array
    b: Array
    e: Array
    gap: Array
    gram: Array
    map: Array
    square: Array
    lines: Array
    line: Array
    lever: Array


def local_arrays(strips: int, control_points: int, modes: int, gauss_points: int, coupled: int) -> Local:
    """Arrays of that many strips."""
    s, n, k = strips, control_points, modes
    size = 2 * n - 6 + coupled + 7
    return Local(
        points=np.zeros((s, 2 * n)),
        gradient=np.zeros((s, 2 * n)),
        hessian=np.zeros((s, 2 * n, 2 * n)),
        coupling=np.zeros((s, k, 2 * n)),
        moment=np.zeros((s, gauss_points)),
        g=np.zeros((s, size)),
        h=np.zeros((s, size, size)),
        b=np.zeros((s, k, size)),
        e=np.zeros((s, k, size)),
        gap=np.zeros((s, k)),
        gram=np.zeros((s, k, k)),
        map=np.zeros((s, 16)),
        square=np.zeros((8, 8)),
        lines=np.zeros((8, 8)),
        line=np.zeros(8),
        lever=np.zeros(n),
    )


@kernel()
def end_frame(body, frame, pose, out):
    """Point, direction and the body's centre of a clamped end: out (6,) = x, y, cos, sin, X, Y."""
    if body < 0:
        out[0], out[1], out[4], out[5] = frame[0], frame[1], 0.0, 0.0
        out[2], out[3] = math.cos(frame[2]), math.sin(frame[2])
    else:
        at = 3 * body
        x, y, angle = pose[at], pose[at + 1], pose[at + 2]
        c, d = math.cos(angle), math.sin(angle)
        out[0], out[1] = x + c * frame[0] - d * frame[1], y + d * frame[0] + c * frame[1]
        out[2], out[3] = math.cos(angle + frame[2]), math.sin(angle + frame[2])
        out[4], out[5] = x, y


@part()
def place_points(s, w, pose, strips, local):
    """Control points of strip s from its own coordinates w (W,) and the bodies' poses (3 B,), and its map."""
    points, ends, frame = local.points[s], local.map[s], local.line
    own = w.size
    inner = own - 2
    for i in range(inner):
        points[i] = w[i]
    end_frame(strips.roots[s], strips.root[s], pose, frame)
    kx, ky = strips.reach[s, 0] * frame[2], strips.reach[s, 0] * frame[3]
    points[inner], points[inner + 1] = frame[0] + w[own - 2] * kx, frame[1] + w[own - 2] * ky
    points[inner + 6], points[inner + 7] = frame[0], frame[1]
    ends[0], ends[1] = kx, ky
    ends[8], ends[9] = frame[5] - points[inner + 1], points[inner] - frame[4]
    ends[10], ends[11] = frame[5] - frame[1], frame[0] - frame[4]
    end_frame(strips.tips[s], strips.tip[s], pose, frame)
    kx, ky = -strips.reach[s, 1] * frame[2], -strips.reach[s, 1] * frame[3]
    points[inner + 2], points[inner + 3] = frame[0] + w[own - 1] * kx, frame[1] + w[own - 1] * ky
    points[inner + 4], points[inner + 5] = frame[0], frame[1]
    ends[2], ends[3] = kx, ky
    ends[4], ends[5] = frame[5] - points[inner + 3], points[inner + 2] - frame[4]
    ends[6], ends[7] = frame[5] - frame[1], frame[0] - frame[4]


@kernel()
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
def to_element(moving, inner, tip, root, ends, gradient, hessian, coupling, g, h, b, square, lines, line):
    """Gradient, upper Hessian and coupling of one strip in its element coordinates: g, h and b.

    inner: coupled axial forces beside w; tip, root: whether these ends move.
    """
    at = gradient.size - 8
    behind = at + 2 + inner
    for i in range(at):
        g[i] = gradient[i]
        row, target = hessian[i], h[i]
        for j in range(i, at):
            target[j] = row[j]
        to_ends(row, at, ends, tip, root, target, at, behind)
    to_ends(gradient, at, ends, tip, root, g, at, behind)
    for k in range(b.shape[0]):
        row, target = coupling[k], b[k]
        for i in range(at):
            target[i] = row[i]
        to_ends(row, at, ends, tip, root, target, at, behind)
    # the ends among themselves: J^T (H J), J column by column
    special = 2 * moving - at
    for i in range(special):
        for j in range(i):
            hessian[at + i, at + j] = hessian[at + j, at + i]
    columns = 2 + 3 * tip + 3 * root
    for i in range(special):
        to_ends(hessian[at + i], at, ends, tip, root, line, 0, 2)
        for c in range(columns):
            lines[c, i] = line[c]
    for c in range(columns):
        to_ends(lines[c], 0, ends, tip, root, square[c], 0, 2)
    for c in range(columns):
        row = at + c if c < 2 else behind + c - 2
        for d in range(c, columns):
            h[row, at + d if d < 2 else behind + d - 2] = square[c, d]
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
