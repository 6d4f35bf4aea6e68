"""How far a camera and a printer push all edges into the dark, by edges of both polarities in one picture.

The black square around a marker becomes too small and the light cells within it too large: between its own
corners, which are too close by twice the offset, an edge of cells across u (-1/2 to 1/2, towards its light
side) is found 1 - 2 u times the offset off. Least squares over all edges of the cells give the offset,
whatever made it: light that is encoded or clipped after a lens has blurred it, or ink that spreads.
"""

import math
from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

from studies.interactive.tracking.edges import AFTER, BEFORE, GAMMA, LEAST_REACH, REACHES, Picture, edges
from studies.interactive.tracking.planar import CORNERS, homography, project
from studies.kinds import Array

Cells = NDArray[np.bool_]

#: Half length of the profiles across the edges of cells, and what is left out at the ends of such an edge,
#: over the side of a cell.
REACH, END = 0.45, 0.25
#: Profiles an edge of cells, which is a few pixels long.
STATIONS = 12
#: Least share of good stations of an edge of cells.
LEAST_SHARE = 0.5
#: Offset [px] over the step to another power, damped: one that is too large by one makes 0.55; from which one
#: on it is made; powers that cameras have.
BY_POWER, OTHER, POWERS = 0.7, 0.04, (1.0, 3.0)
#: Difference of the offsets of cells and of the square around them that no picture tells [px]: what is left
#: of it on films of powers from 1 to 1/2.4 and blurs from 0.5 to 1.6 px.
APART = 0.01
#: Pictures over which the offset is averaged: it is the camera's own, and changes slowly. After as many only
#: one in EVERY is looked at, for a fifth of all time went there; the average reaches as far back as before.
PICTURES, EVERY = 50, 5


class Shrinkage:
    """The offset [px] of one camera, from picture to picture, and the power of its values that light is.

    sd: standard deviation of the offset [px].
    """

    def __init__(self) -> None:
        self.offset: float | None = None
        self.gamma = GAMMA
        self.sd = 0.0
        self._pictures = 0
        self._since = 0

    def taken_out(self, picture: Picture, corners: Array, cells: dict[int, Cells]) -> Array:
        """Return corners (Q, 4, 2) of dark squares with the offset taken out; cells by the place in Q."""
        self._since += bool(cells)
        settled = self._pictures == PICTURES
        looked = {} if settled and self._since < EVERY else cells
        found = [_offset(picture, corners[place], each, self.gamma) for place, each in looked.items()]
        weight = sum(each for _, each, _ in found)
        if weight > 0.0:
            now = sum(offset * each for offset, each, _ in found) / weight
            self._since, self._pictures = 0, min(self._pictures + 1, PICTURES)
            count = PICTURES // EVERY if settled else self._pictures
            scatter = max(each for _, _, each in found)
            self.sd = math.hypot(scatter / math.sqrt(weight * count), APART)
            before = now if self.offset is None else self.offset
            self.offset = before + (now - before) / count
        if self.offset is None:
            return corners
        moved = _grown(corners, self.offset)
        gamma = min(max(self.gamma + self.offset / BY_POWER, POWERS[0]), POWERS[1])
        if abs(self.offset) > OTHER and gamma != self.gamma:
            self.offset, self.gamma, self._pictures = None, gamma, 0
        return moved


def _grown(corners: Array, offset: float) -> Array:
    """Return squares (Q, 4, 2) whose edges lie further out by `offset` [px]."""
    after = corners[:, AFTER] - corners
    after /= np.sqrt(np.sum(after**2, axis=-1, keepdims=True))
    before = after[:, BEFORE]
    # a corner moves by t before - s after where both edges move by the offset: t = s = offset / sin(angle)
    sine = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    return np.asarray(corners + offset * (before - after) / np.abs(sine)[..., None])


def _offset(picture: Picture, corners: Array, cells: Cells, gamma: float) -> tuple[float, float, float]:
    """Return the offset [px] by the cells (C, C), light or not, of a square, its weight, 0 for none, and the
    standard deviation of an edge [px]."""
    side = float(np.hypot(*(np.roll(corners, -1, axis=0) - corners).T).min())
    half = min(REACHES[-1], REACH * side / len(cells))
    if half < LEAST_REACH:
        return 0.0, 0.0, 0.0
    across, places = _edges(cells.tobytes())
    p, q, lit = project(homography(CORNERS, corners), places)
    along = (q - p) / np.hypot(*(q - p).T)[:, None]
    normal = np.column_stack((along[:, 1], -along[:, 0]))
    normal *= np.sign(np.sum(normal * (lit - p), axis=1))[:, None]
    found = edges(picture, p, q, normal, np.full(len(p), half), gamma, stations=STATIONS)
    kept = found[:, 2] >= LEAST_SHARE
    if kept.sum() < 2:
        return 0.0, 0.0, 0.0
    slope, gaps = 2.0 * across[kept] - 1.0, found[kept, :2].mean(axis=1)
    weight = float(slope @ slope)
    offset = float(slope @ gaps) / weight
    return offset, weight, float(np.sqrt(np.mean((gaps - offset * slope) ** 2)))


@cache
def _edges(cells: bytes) -> tuple[Array, Array]:
    """Return u (E,) towards the light of the edges of cells, and both their ends and a place in the light
    (3, E, 2), in sides."""
    count = math.isqrt(len(cells))
    found = list(_each(np.frombuffer(cells, dtype=bool).reshape(count, count)))
    return np.array([across for across, _, _ in found]), np.stack(
        [np.array([*ends, light]) for _, ends, light in found], axis=1
    )


def _each(cells: Cells) -> Iterator[tuple[float, tuple[Array, Array], Array]]:
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
