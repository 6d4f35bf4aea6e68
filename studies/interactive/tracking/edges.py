"""Sub-pixel corners of dark squares: a line through each edge, corners where lines meet. Pixel centres are
whole."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from studies.interactive.tracking.profiles import edge
from studies.kinds import Array

#: Half length of the profiles in successive passes [px], and the share of the side that keeps them inside the
#: black border.
REACHES = (4.5, 3.0, 3.5)
SHARE = 0.095
LEAST_REACH = 1.5
#: Least share of good stations of an edge.
LEAST_SHARE = 0.3


@dataclass(frozen=True, kw_only=True, eq=False)
class Refined:
    """Q squares: corners (Q, 4, 2) [px]; share (Q, 4) of good stations; step (Q, 4) from dark to light
    [grey levels]."""

    corners: Array
    share: Array
    step: Array


def refine(picture: NDArray[np.uint8], quads: Array) -> Refined:
    """Return the squares near `quads` (Q, 4, 2) [px], corners in their order; a lost edge has share 0."""
    corners = np.array(quads, dtype=float)
    share, step = np.zeros(corners.shape[:2]), np.zeros(corners.shape[:2])
    last = len(REACHES) - 1
    for k, reach in enumerate(REACHES):
        for q in range(len(corners)):
            corners[q], share[q], step[q] = _pass(picture, corners[q], reach, k == 0, k == last)
    return Refined(corners=corners, share=share, step=step)


def _pass(
    picture: NDArray[np.uint8], corners: Array, reach: float, first: bool, last: bool
) -> tuple[Array, Array, Array]:
    """One pass over the edges of a square (4, 2)."""
    end = np.roll(corners, -1, axis=0)
    along = end - corners
    side = np.hypot(along[:, 0], along[:, 1])
    half = min(reach, max(LEAST_REACH, SHARE * float(side.min())))
    normal = np.column_stack((along[:, 1], -along[:, 0])) / side[:, None]
    outward = np.einsum("ei,ei->e", normal, (corners + end) / 2 - corners.mean(axis=0))
    normal *= np.sign(outward)[:, None]
    found = np.array([edge(picture, corners[e], end[e], normal[e], half, first, last) for e in range(4)])
    p, q = corners + found[:, :1] * normal, end + found[:, 1:2] * normal
    crossing = _crossings(np.roll(p, 1, axis=0), np.roll(q, 1, axis=0), p, q)
    lost = ~np.isfinite(crossing).all(axis=1) | (np.hypot(*(crossing - corners).T) > 2.0 * reach)
    share = np.where(lost | np.roll(lost, -1), 0.0, found[:, 2])
    return np.where(lost[:, None], corners, crossing), share, found[:, 3]


def _crossings(p: Array, q: Array, r: Array, s: Array) -> Array:
    """Where the lines p q and r s meet, each (E, 2)."""
    d, e = q - p, s - r
    cross = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    gap = r - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[:, 0] * e[:, 1] - gap[:, 1] * e[:, 0]) / cross
        return np.asarray(p + t[:, None] * d)
