"""Constants of the strips of an explicit motion, and the arrays that its evaluations work on."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.motion.arrays import Flexures, Masses, sizes_of, zeros

Array = NDArray[np.float64]
Places = NDArray[np.int64]

INNER_ROOT, INNER_TIP, TIP, ROOT = range(4)
"""End points of a strip in the order of their masses: 1, n - 2, n - 1, 0."""


class Grid(NamedTuple):
    """Constants of S strips.

    d1, d2 (n, G) derivatives of the basis, not zero from begin to end (n,); modes (S, K, G) and stiffness
    (S, K) of the axial forces; inverse (S, I, I) B_ii^-1, white its root C^T, C C^T = B_ii^-1; follow
    (S, 4, I) W^T, ends (S, 4, 4) the end points' mass, of which 1 and n - 2 are none where roots turn, but
    inner ones; ties (S, K, 4 + I, G) d1 times the modes, of the end
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
    """Working arrays: x, u, push where accelerations are asked for, rates and the accelerations; mean, dr, dw
    of a step; turns: cosine and sine; ends: arm and s-direction, lever: how inner and outer points of tip and
    root turn; g, h, y of a strip; tangent, load of the bodies. T = 4 + I.
    """

    x: Annotated[Array, "R"]
    u: Annotated[Array, "R"]
    push: Annotated[Array, "R"]
    mean: Annotated[Array, "R"]
    dr: Annotated[Array, "R"]
    dw: Annotated[Array, "R"]
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


def grid_of(strips: Flexures) -> Grid:
    """The constants of strips with mass."""
    n, (gauss, width) = strips.mass.shape[1], strips.d1.shape
    inner, ends = np.arange(strips.lead, n - strips.lead), np.array([1, n - 2, n - 1, 0])
    held = np.array([strips.lead == 2, strips.lead == 2, True, True])
    places, points = strips.first[:, None] + np.arange(width), np.arange(gauss)[:, None]
    d1, d2 = np.zeros((2, n, gauss))
    d1[places, points], d2[places, points] = strips.d1, strips.d2
    seen = (np.arange(n)[:, None] >= strips.first) & (np.arange(n)[:, None] < strips.first + width)
    inverse = np.array([np.linalg.inv(b[np.ix_(inner, inner)]) for b in strips.mass])
    across = strips.mass[:, inner[:, None], ends] * held
    follow = inverse @ across
    white = np.linalg.cholesky(inverse).transpose(0, 2, 1)
    stretch = strips.modes.transpose(0, 2, 1)[:, :, None] * d1
    at_ends = stretch[:, :, ends] * held[:, None] - np.einsum("sip,skig->skpg", follow, stretch[:, :, inner])
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
        ends=np.ascontiguousarray(
            strips.mass[:, ends[:, None], ends] * held[:, None] * held - across.transpose(0, 2, 1) @ follow
        ),
        ties=np.concatenate((at_ends, whitened), axis=2),
        frames=frames,
        tied=tied,
        outer=int(tied.any()),
    )


def room_of(strips: Flexures, masses: Masses, grid: Grid) -> Room:
    """Working arrays."""
    (s, _, k), q = strips.modes.shape, len(masses.inertia)
    sizes = {
        "R": q + s * strips.own,
        "B": q // 3,
        "T": grid.ties.shape[2],
        "E": 8 + k,
        "Q'": q + s * grid.outer,
    }
    return zeros(Room, sizes_of(strips, masses) | sizes)
