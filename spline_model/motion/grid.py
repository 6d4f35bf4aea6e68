"""Constants of the strips of an explicit motion, and the arrays that its evaluations work on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.arrays import Flexures, Masses

Array = NDArray[np.float64]
Places = NDArray[np.int64]

INNER_ROOT, INNER_TIP, TIP, ROOT = range(4)
"""End points of a strip in the order of their masses: 1, n - 2, n - 1, 0."""


class Grid(NamedTuple):
    """Constants of S strips.

    d1, d2 (n, G) derivatives of the basis, not zero from begin to end (n,); modes (S, K, G) and stiffness
    (S, K) of the axial forces; inverse (S, n - 4, n - 4) B_ii^-1, white its root C^T, C C^T = B_ii^-1; follow
    (S, 4, n - 4) W^T, ends (S, 4, 4) the end points' mass; ties (S, K, n, G) d1 times the modes, of the end
    points less W^T of the inner ones, and C^T of these; frames (S, 2, 4) point and s-direction of root and
    tip in the frame of their body or the ground; tied (S,) leading axial forces that hold the length; outer:
    1 with any, the first of which stays with the bodies.
    """

    d1: Array
    d2: Array
    begin: Places
    end: Places
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


class Room(NamedTuple):
    """Working arrays: x, u, push (R,) where accelerations are asked for, rates and the accelerations;
    mean, dr, dw (R,) of a step; turns (B, 2) cosine and sine; points, speed, force (S, 2, n); ends (S, 2, 4)
    arm and s-direction, lever (S, 8) how inner and outer points of tip and root turn; drift (S, 2, 4);
    at (10, G); axial (S, K), rows (S, K, 2, n), rest (K,); covector (2, 4), line (8,), inner (2, n);
    g (S, E), h (S, E, E), y (E,) of a strip; tangent (Q', Q'), load (Q',) of the bodies.
    """

    x: Array
    u: Array
    push: Array
    mean: Array
    dr: Array
    dw: Array
    turns: Array
    points: Array
    speed: Array
    force: Array
    ends: Array
    lever: Array
    drift: Array
    at: Array
    axial: Array
    rows: Array
    rest: Array
    covector: Array
    line: Array
    inner: Array
    g: Array
    h: Array
    y: Array
    tangent: Array
    load: Array


def grid_of(strips: Flexures) -> Grid:
    """The constants of strips with mass."""
    n, (gauss, width) = strips.mass.shape[1], strips.d1.shape
    inner, ends = np.arange(2, n - 2), np.array([1, n - 2, n - 1, 0])
    places, points = strips.first[:, None] + np.arange(width), np.arange(gauss)[:, None]
    d1, d2 = np.zeros((2, n, gauss))
    d1[places, points], d2[places, points] = strips.d1, strips.d2
    seen = (np.arange(n)[:, None] >= strips.first) & (np.arange(n)[:, None] < strips.first + width)
    inverse = np.array([np.linalg.inv(b[np.ix_(inner, inner)]) for b in strips.mass])
    across = strips.mass[:, inner[:, None], ends]
    follow = inverse @ across
    white = np.linalg.cholesky(inverse).transpose(0, 2, 1)
    stretch = strips.modes.transpose(0, 2, 1)[:, :, None] * d1
    at_ends = stretch[:, :, ends] - np.einsum("sip,skig->skpg", follow, stretch[:, :, inner])
    whitened = np.einsum("sij,skjg->skig", white, stretch[:, :, inner])
    frames = np.zeros((len(strips.roots), 2, 4))
    for e, (frame, reach) in enumerate(
        ((strips.root, strips.reach[:, 0]), (strips.tip, -strips.reach[:, 1]))
    ):
        frames[:, e, :2] = frame[:, :2]
        frames[:, e, 2:] = reach[:, None] * np.column_stack((np.cos(frame[:, 2]), np.sin(frame[:, 2])))
    tied = np.cumprod(strips.compliance == 0.0, axis=1).sum(axis=1).astype(np.int64)
    return Grid(
        d1=d1,
        d2=d2,
        begin=seen.argmax(axis=1),
        end=(gauss - seen[:, ::-1].argmax(axis=1)),
        modes=np.ascontiguousarray(strips.modes.transpose(0, 2, 1)),
        stiffness=1.0 / np.where(strips.compliance > 0.0, strips.compliance, np.inf),
        inverse=np.ascontiguousarray(inverse),
        white=np.ascontiguousarray(white),
        follow=np.ascontiguousarray(follow.transpose(0, 2, 1)),
        ends=np.ascontiguousarray(strips.mass[:, ends[:, None], ends] - across.transpose(0, 2, 1) @ follow),
        ties=np.concatenate((at_ends, whitened), axis=2),
        frames=frames,
        tied=tied,
        outer=int(tied.any()),
    )


def room_of(strips: Flexures, masses: Masses, grid: Grid) -> Room:
    """Working arrays."""
    (s, gauss, k), n, q = strips.modes.shape, strips.mass.shape[1], len(masses.inertia)
    size, element, bodies = q + s * (2 * n - 6), 8 + k, q + s * grid.outer
    return Room(
        **{name: np.zeros(size) for name in ("x", "u", "push", "mean", "dr", "dw")},
        turns=np.zeros((q // 3, 2)),
        **{name: np.zeros((s, 2, n)) for name in ("points", "speed", "force")},
        ends=np.zeros((s, 2, 4)),
        lever=np.zeros((s, 8)),
        drift=np.zeros((s, 2, 4)),
        at=np.zeros((10, gauss)),
        axial=np.zeros((s, k)),
        rows=np.zeros((s, k, 2, n)),
        rest=np.zeros(k),
        covector=np.zeros((2, 4)),
        line=np.zeros(8),
        inner=np.zeros((2, n)),
        g=np.zeros((s, element)),
        h=np.zeros((s, element, element)),
        y=np.zeros(element),
        tangent=np.zeros((bodies, bodies)),
        load=np.zeros(bodies),
    )
