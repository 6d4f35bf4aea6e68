"""One strip in an explicit time step: its points and velocities, and its elastic force, without tangent.

Axial forces follow at each mode from its strain over its compliance. Of a strip that cannot stretch they
are unknown, and what a mode of them asks of the accelerations of the control points,

    sum b A = -rest,   b = int mode t dC' / dP,   rest = int mode (|dC'/dt|^2 - (t . dC'/dt)^2) / |C'|
                                                         + 2 O (its strain's rate) + O^2 (its strain),

keeps its strain at zero: the last two let what round-off and the step leave of it die out (Baumgarte,
CMAME 1 (1972) 1).
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np

from spline_model.motion.arrays import Array, Flexures, Masses, Places, sizes_of, zeros
from spline_model.strip.compiled import part
from spline_model.strip.laws import bending_law, stretching_law

X1, Y1, X2, Y2, SPEED, STRETCH, G0, G1, G2, G3 = range(10)
"""Rows of what is known at the Gauss points: C', C'', |C'|, the stretch that axial forces see, and the
derivatives of the energy in C' and C''. Inner loops only read: a store in them costs a check for aliases."""


INNER_ROOT, INNER_TIP, TIP, ROOT = range(4)
"""End points of a strip in the order of their masses: 1, n - 2, n - 1, 0."""


class Grid(NamedTuple):
    """Constants of S strips.

    d1, d2 (n, G) derivatives of the basis; modes (S, K, G) and stiffness (S, K) of the axial forces; inverse
    (S, I, I) B_ii^-1, white its root C^T, C C^T = B_ii^-1; follow (S, 4, I) W^T, ends (S, 4, 4) the end
    points' mass; ties (S, K, 4 + I, G) d1 times the modes, of end points less W^T of the inner ones, and C^T
    of these; frames (S, 2, 4) point and s-direction of root and tip in the frame of their body or the ground;
    tied (S,) leading axial forces that hold the length; outer: 1 with any, the first stays with the bodies.
    """

    d1: Array
    d2: Array
    modes: Array
    stiffness: Array
    inverse: Array
    white: Array
    follow: Array
    ends: Array
    ties: Array
    frames: Array
    tied: Places
    outer: int

    @classmethod
    def of(cls, strips: Flexures) -> Grid:
        """The constants of strips with mass."""
        n = strips.mass.shape[1]
        inner, ends = np.arange(2, n - 2), np.array([1, n - 2, n - 1, 0])
        d1, d2 = (np.ascontiguousarray(each.T) for each in (strips.d1, strips.d2))
        inverse = np.array([np.linalg.inv(b[np.ix_(inner, inner)]) for b in strips.mass])
        across = strips.mass[:, inner[:, None], ends]
        follow, of_ends = inverse @ across, strips.mass[:, ends[:, None], ends]
        white = np.linalg.cholesky(inverse).transpose(0, 2, 1)
        stretch = strips.modes.transpose(0, 2, 1)[:, :, None] * d1
        with_ends = np.einsum("sip,skig->skpg", follow, stretch[:, :, inner])
        at_ends = stretch[:, :, ends] - with_ends
        whitened = np.einsum("sij,skjg->skig", white, stretch[:, :, inner])
        frames = np.zeros((len(strips.roots), 2, 4))
        for e, (frame, sign) in enumerate(((strips.root, 1.0), (strips.tip, -1.0))):
            forward = np.column_stack((np.cos(frame[:, 2]), np.sin(frame[:, 2])))
            frames[:, e, :2], frames[:, e, 2:] = frame[:, :2], sign * strips.reach[:, e, None] * forward
        tied = np.cumprod(strips.compliance == 0.0, axis=1).sum(axis=1).astype(np.int64)
        return cls(
            d1=d1,
            d2=d2,
            modes=np.ascontiguousarray(strips.modes.transpose(0, 2, 1)),
            stiffness=1.0 / np.where(strips.compliance > 0.0, strips.compliance, np.inf),
            inverse=np.ascontiguousarray(inverse),
            white=np.ascontiguousarray(white),
            follow=np.ascontiguousarray(follow.transpose(0, 2, 1)),
            ends=np.ascontiguousarray(of_ends - across.transpose(0, 2, 1) @ follow),
            ties=np.concatenate((at_ends, whitened), axis=2),
            frames=frames,
            tied=tied,
            outer=int(tied.any()),
        )


class Room(NamedTuple):
    """Working arrays: x, u, push where accelerations are asked for, rates and the accelerations; mean of a
    step; turns: cosine and sine; ends: arm and s-direction, lever: how inner and outer points of tip and
    root turn; g, h, y of a strip; tangent, load of the bodies. T = 4 + I.
    """

    x: Annotated[Array, "R"]
    u: Annotated[Array, "R"]
    push: Annotated[Array, "R"]
    mean: Annotated[Array, "R"]
    turns: Annotated[Array, "B 2"]
    points: Annotated[Array, "S 2 n"]
    speed: Annotated[Array, "S 2 n"]
    force: Annotated[Array, "S 2 n"]
    ends: Annotated[Array, "S 2 4"]
    lever: Annotated[Array, "S 8"]
    drift: Annotated[Array, "S 2 4"]
    at: Annotated[Array, "10 G"]
    axial: Annotated[Array, "S K"]
    rows: Annotated[Array, "S K 2 T"]
    rest: Annotated[Array, "K"]
    covector: Annotated[Array, "2 4"]
    line: Annotated[Array, "8"]
    inner: Annotated[Array, "2 n"]
    g: Annotated[Array, "S E"]
    h: Annotated[Array, "S E E"]
    y: Annotated[Array, "E"]
    tangent: Annotated[Array, "Q' Q'"]
    load: Annotated[Array, "Q'"]

    @classmethod
    def of(cls, strips: Flexures, masses: Masses, grid: Grid) -> Room:
        """Working arrays."""
        (s, _, k), q = strips.modes.shape, len(masses.inertia)
        sizes = {"R": q + s * strips.own, "B": q // 3, "T": grid.ties.shape[2]}
        sizes |= {"E": 8 + k, "Q'": q + s * grid.outer}
        return zeros(cls, sizes_of(strips, masses) | sizes)


@part()
def _place_end(body, frame, turns, end, lever, at, s):
    """Arm and s-direction of an end; how its inner and outer points turn with its body: lever[at:at + 4]."""
    if body < 0:
        for i in range(4):
            end[i] = frame[i]
            lever[at + i] = 0.0
    else:
        c, d = turns[body, 0], turns[body, 1]
        end[0], end[1] = c * frame[0] - d * frame[1], d * frame[0] + c * frame[1]
        end[2], end[3] = c * frame[2] - d * frame[3], d * frame[2] + c * frame[3]
        lever[at], lever[at + 1] = -end[1] - s * end[3], end[0] + s * end[2]
        lever[at + 2], lever[at + 3] = -end[1], end[0]


@part()
def place(s, at, r, grid, strips, room):
    """Control points of a strip, its ends and their levers."""
    n, points, last = strips.mass.shape[1], room.points[s], at + strips.own - 2
    for i in range(2, n - 2):
        points[0, i], points[1, i] = r[at + 2 * i - 4], r[at + 2 * i - 3]
    for e in range(2):
        body = strips.roots[s] if e == 0 else strips.tips[s]
        outer, inner = (0, 1) if e == 0 else (n - 1, n - 2)
        end, reach = room.ends[s, e], r[last + e]
        _place_end(body, grid.frames[s, e], room.turns, end, room.lever[s], 4 - 4 * e, reach)
        x, y = end[0], end[1]
        if body >= 0:
            x, y = x + r[3 * body], y + r[3 * body + 1]
        points[0, outer], points[1, outer] = x, y
        points[0, inner], points[1, inner] = x + reach * end[2], y + reach * end[3]


@part()
def move(s, at, w, strips, room):
    """Velocities of the control points of a strip that was placed."""
    n, speed, lever = strips.mass.shape[1], room.speed[s], room.lever[s]
    last = at + strips.own - 2
    for i in range(2, n - 2):
        speed[0, i], speed[1, i] = w[at + 2 * i - 4], w[at + 2 * i - 3]
    for e in range(2):
        body = strips.roots[s] if e == 0 else strips.tips[s]
        outer, inner = (0, 1) if e == 0 else (n - 1, n - 2)
        rate, turn = w[last + e], 4 - 4 * e
        for k in range(2):
            speed[k, outer] = 0.0
            speed[k, inner] = rate * room.ends[s, e, 2 + k]
            if body >= 0:
                spin = w[3 * body + 2]
                speed[k, outer] += w[3 * body + k] + spin * lever[turn + 2 + k]
                speed[k, inner] += w[3 * body + k] + spin * lever[turn + k]


@part()
def add_forces(s, tied, strips, grid, points, at, axial, force):
    """Fill the gradient (2, n) of a strip's energy in its control points, dead load included.

    at (10, G): see above; axial (K,): the first ``tied`` of them are not known and left out.
    """
    count, gauss, width = strips.compliance.shape[1], strips.weight.size, strips.d1.shape[1]
    measure, strain, stretching = strips.measure, strips.strain[s], strips.stretching[s]
    for p in range(gauss):
        x1 = y1 = x2 = y2 = 0.0
        for i in range(width):
            u, q, x, y = strips.d1[p, i], strips.d2[p, i], points[0, i], points[1, i]
            x1 += u * x
            y1 += u * y
            x2 += q * x
            y2 += q * y
        v = math.sqrt(x1 * x1 + y1 * y1)
        at[X1, p], at[Y1, p], at[X2, p], at[Y2, p], at[SPEED, p] = x1, y1, x2, y2, v
        at[STRETCH, p] = strips.weight[p] * (v - (1.0 + strain) * strips.speed[s, p])
    for k in range(tied, count):
        total = 0.0
        for p in range(gauss):
            total += grid.modes[s, k, p] * at[STRETCH, p]
        axial[k] = total * grid.stiffness[s, k]
    for p in range(gauss):
        x1, y1, x2, y2, v = at[X1, p], at[Y1, p], at[X2, p], at[Y2, p], at[SPEED, p]
        weight, inverse = strips.weight[p], 1.0 / v
        r = inverse * inverse
        phi = (x1 * y2 - y1 * x2) * r
        _, m, _, _, f, _ = bending_law(
            phi, v, strips.speed[s, p], strips.curvature[s, p], strips.rigidity[s, p],
            strips.curl[s, p, 0], strips.curl[s, p, 1], measure,
        )  # fmt: skip
        for k in range(tied, count):
            f += strips.modes[s, p, k] * axial[k]
        if stretching > 0.0:
            f += stretching_law(v, strips.speed[s, p], strain, stretching, measure)[1]
        bend, pull = weight * m * r, weight * f * inverse
        at[G0, p] = bend * (y2 - 2.0 * phi * x1) + pull * x1
        at[G1, p] = pull * y1 - bend * (x2 + 2.0 * phi * y1)
        at[G2, p], at[G3, p] = -bend * y1, bend * x1
    for i in range(points.shape[1]):
        fx, fy = -strips.dead[s, 0, i], -strips.dead[s, 1, i]
        for p in range(gauss):
            fx += grid.d1[i, p] * at[G0, p] + grid.d2[i, p] * at[G2, p]
            fy += grid.d1[i, p] * at[G1, p] + grid.d2[i, p] * at[G3, p]
        force[0, i], force[1, i] = fx, fy


@part()
def add_ties(s, tied, sharpness, strips, grid, speed, at, rows, rest):
    """Rows (K, 2, 4 + I) and rests (K,) of what the ``tied`` axial forces keep; at: from ``add_forces``.

    The rows are those b of the four end points with the inner ones eliminated, and a root of B_ii^-1 times
    those of the inner ones.

    speed (2, n): velocities of the control points; sharpness: O [1/s].
    """
    for p in range(strips.weight.size):
        ux = uy = 0.0
        for i in range(strips.d1.shape[1]):
            ux += strips.d1[p, i] * speed[0, i]
            uy += strips.d1[p, i] * speed[1, i]
        inverse, weight = 1.0 / at[SPEED, p], strips.weight[p]
        tx, ty = at[X1, p] * inverse, at[Y1, p] * inverse
        along, across = tx * ux + ty * uy, tx * uy - ty * ux
        at[G0, p], at[G1, p] = weight * tx, weight * ty
        at[G2, p] = weight * (across * across * inverse + 2.0 * sharpness * along)
        at[G2, p] += sharpness * sharpness * at[STRETCH, p]
    for k in range(tied):
        rest[k] = 0.0
        for p in range(strips.weight.size):
            rest[k] += grid.modes[s, k, p] * at[G2, p]
        for i in range(rows.shape[2]):
            x = y = 0.0
            for p in range(strips.weight.size):
                x += grid.ties[s, k, i, p] * at[G0, p]
                y += grid.ties[s, k, i, p] * at[G1, p]
            rows[k, 0, i], rows[k, 1, i] = x, y
