"""How far a camera and a printer push all edges into the dark, by edges of both polarities in one picture.

The black square around a marker becomes too small and the light cells within it too large: between its own
corners, which are too close by twice the offset, an edge of cells across u (-1/2 to 1/2, towards its light
side) is found 1 - 2 u times the offset off. Least squares over all edges of the cells give the offset,
whatever made it: light that is encoded or clipped after a lens has blurred it, or ink that spreads.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from studies.interactive.tracking.edges import GAMMA, LEAST_REACH, REACHES, Picture, edge
from studies.interactive.tracking.planar import CORNERS, homography, project
from studies.kinds import Array

Cells = NDArray[np.bool_]

#: Half length of the profiles across the edges of cells, and what is left out at the ends of such an edge,
#: over the side of a cell.
REACH, END = 0.45, 0.25
#: Least share of good stations of an edge of cells.
LEAST_SHARE = 0.5
#: Offset [px] over the step to another power, damped: one that is too large by one makes 0.55; from which one
#: on it is made; powers that cameras have.
BY_POWER, OTHER, POWERS = 0.7, 0.04, (1.0, 3.0)
#: Difference of the offsets of cells and of the square around them that no picture tells [px]: what is left
#: of it on films of powers from 1 to 1/2.4 and blurs from 0.5 to 1.6 px.
APART = 0.01
#: Pictures over which the offset is averaged: it is the camera's own, and changes slowly.
PICTURES = 50


class Shrinkage:
    """The offset [px] of one camera, from picture to picture, and the power of its values that light is.

    sd: standard deviation of the offset [px].
    """

    def __init__(self) -> None:
        self.offset: float | None = None
        self.gamma = GAMMA
        self.sd = 0.0
        self._pictures = 0

    def taken_out(self, picture: Picture, corners: Array, cells: dict[int, Cells]) -> Array:
        """Return corners (Q, 4, 2) of dark squares with the offset taken out; cells by the place in Q."""
        found = [_offset(picture, corners[place], each, self.gamma) for place, each in cells.items()]
        weight = sum(each for _, each, _ in found)
        if weight > 0.0:
            now = sum(offset * each for offset, each, _ in found) / weight
            self._pictures = min(self._pictures + 1, PICTURES)
            scatter = max(each for _, _, each in found)
            self.sd = math.hypot(scatter / math.sqrt(weight * self._pictures), APART)
            before = now if self.offset is None else self.offset
            self.offset = before + (now - before) / self._pictures
        if self.offset is None:
            return corners
        moved = np.array([grown(each, self.offset) for each in corners])
        gamma = min(max(self.gamma + self.offset / BY_POWER, POWERS[0]), POWERS[1])
        if abs(self.offset) > OTHER and gamma != self.gamma:
            self.offset, self.gamma, self._pictures = None, gamma, 0
        return moved


def grown(corners: Array, offset: float) -> Array:
    """Return a square (4, 2) whose edges lie further out by `offset` [px]."""
    after, before = np.roll(corners, -1, axis=0) - corners, corners - np.roll(corners, 1, axis=0)
    after, before = (each / np.hypot(*each.T)[:, None] for each in (after, before))
    # a corner moves by t before - s after where both edges move by the offset: t = s = offset / sin(angle)
    sine = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.asarray(corners + offset * (before - after) / np.abs(sine)[:, None])


def _offset(picture: Picture, corners: Array, cells: Cells, gamma: float) -> tuple[float, float, float]:
    """Return the offset [px] by the cells (C, C), light or not, of a square, its weight, 0 for none, and the
    standard deviation of an edge [px]."""
    side = float(np.hypot(*(np.roll(corners, -1, axis=0) - corners).T).min())
    half = min(REACHES[-1], REACH * side / len(cells))
    if half < LEAST_REACH:
        return 0.0, 0.0, 0.0
    plane = homography(CORNERS, corners)
    by, gap = [], []
    for across, ends, light in _edges(cells):
        p, q, lit = project(plane, np.array([*ends, light]))
        along = (q - p) / math.hypot(*(q - p))
        normal = np.array([along[1], -along[0]])
        normal *= np.sign(normal @ (lit - p))
        at_p, at_q, share, _ = edge(picture, p, q, normal, half, False, True, gamma)
        if share >= LEAST_SHARE:
            by.append(2.0 * across - 1.0)
            gap.append(0.5 * (at_p + at_q))
    if len(by) < 2:
        return 0.0, 0.0, 0.0
    slope, gaps = np.array(by), np.array(gap)
    weight = float(slope @ slope)
    offset = float(slope @ gaps) / weight
    return offset, weight, float(np.sqrt(np.mean((gaps - offset * slope) ** 2)))


def _edges(cells: Cells) -> Iterator[tuple[float, tuple[Array, Array], Array]]:
    """Yield the edges of cells: u towards the light, both ends, and a place in the light, in sides."""
    count = len(cells)
    for turned in (False, True):  # lines along y, then along x
        grid = cells.T if turned else cells
        for j in range(1, count):
            kinds = grid[:, j].astype(int) - grid[:, j - 1]
            starts = np.flatnonzero(np.diff(kinds, prepend=0))
            for i, stop in zip(starts, np.append(starts[1:], count), strict=True):
                if kinds[i]:
                    yield _placed(j / count - 0.5, (i + END) / count, (stop - END) / count, kinds[i], turned)


def _placed(
    at: float, first: float, last: float, light: int, turned: bool
) -> tuple[float, tuple[Array, Array], Array]:
    """An edge across `at`, between `first` and `last` from the upper or the left side on, in sides."""

    def point(across: float, along: float) -> Array:
        return np.array([along - 0.5, -across]) if turned else np.array([across, 0.5 - along])

    ends = point(at, first), point(at, last)
    return at * light, ends, point(at + 0.1 * light, 0.5 * (first + last))
