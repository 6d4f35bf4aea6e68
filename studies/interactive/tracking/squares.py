"""Sub-pixel corners of dark squares: a line through each edge, corners where lines meet. Pixel centres are
whole.

A lens blurs light and the camera encodes it, by about the power 1/2.2: edges of encoded values lie too far
in the dark. What is left of that by another camera, by clipped light and by ink that spreads is one offset of
all edges, told by those of both polarities. The black square around a marker becomes too small and the light
cells within it too large: between its own corners, which are too close by twice the offset, an edge of cells
across u (-1/2 to 1/2, towards its light side) is found 1 - 2 u times the offset off. Least squares over all
edges of the cells give it.
"""

import math
from collections.abc import Collection
from functools import cache

import numpy as np

from studies.interactive.tracking.edges import Picture, edges
from studies.interactive.tracking.planar import BITS, cells, homography, normals, project
from studies.kinds import Array

#: Half length of the profiles in successive passes [px], and the share of the side that keeps them inside the
#: black border.
REACHES = (4.5, 3.0, 3.5)
SHARE = 0.095
LEAST_REACH = 1.5
#: Share of good stations below which an edge is not seen.
KEPT = 0.5
#: Places of the corners after and before those of a square.
AFTER, BEFORE = [1, 2, 3, 0], [3, 0, 1, 2]
#: Power of a camera's values that light is: of those that encode it, as nearly all do.
GAMMA = 2.2
#: Half length of the profiles across the edges of cells, and the part that is skipped at the ends of such an
#: edge, over the side of a cell.
REACH, END = 0.45, 0.25
#: Profiles an edge of cells, which is a few pixels long.
FEW = 12
#: Least share of good stations of an edge of cells.
LEAST_OF_CELLS = 0.5
#: Offset [px] over the step to another power, damped: one that is too large by one makes 0.55; from which one
#: on it is made; powers that cameras have.
BY_POWER, OTHER, POWERS = 0.7, 0.04, (1.0, 3.0)
#: Difference of the offsets of cells and of the square around them that no picture tells [px]: what is left
#: of it on films of powers from 1 to 1/2.4 and blurs from 0.5 to 1.6 px.
APART = 0.01
#: Pictures over which the offset is averaged: it is the camera's own, and changes slowly. After as many only
#: one in EVERY is looked at, for a fifth of all time went there; the average reaches as far back as before.
PICTURES, EVERY = 50, 5


def refine(picture: Picture, quads: Array, gamma: float = GAMMA) -> tuple[Array, Array]:
    """Return the corners (Q, 4, 2) [px] of the squares near `quads`, in their order, and the good stations
    (Q, 4, 3) of their edges as `edges` tells them: share, of a lost one 0, mean place and spread.

    Args:
        gamma: power of the picture's values that light is.
    """
    corners, last = np.array(quads, dtype=float), len(REACHES) - 1
    for k, reach in enumerate(REACHES):
        end = corners[:, AFTER]
        side = np.sqrt(np.sum((end - corners) ** 2, axis=-1))
        half = np.minimum(reach, np.maximum(LEAST_REACH, SHARE * side.min(axis=1))).repeat(4)
        normal = normals(corners, end)
        lines = np.stack((corners, end, normal)).reshape(3, -1, 2)
        found = edges(picture, lines, half, gamma, first=k == 0, last=k == last).reshape(-1, 4, 5)
        for _ in range(2):
            crossing = _meeting(corners, found[..., :1], found[..., 1:2])
            gap = np.sqrt(np.sum((crossing - corners) ** 2, axis=-1))
            lost = ~(gap <= 2.0 * reach)
            # of two edges that meet far away, the one with less good stations is something else's: it stays
            weaker = found[..., 2] <= found[:, BEFORE, 2]
            found[(lost & weaker) | (lost & ~weaker)[:, AFTER]] = 0.0
        good = np.where((lost | lost[:, AFTER])[..., None], 0.0, found[..., 2:])
        corners = np.where(lost[..., None], corners, crossing)
    return corners, good


def _meeting(corners: Array, begin: Array | float, end: Array | float) -> Array:
    """Where the edges of squares (Q, 4, 2) meet that are moved outwards at both ends, by (Q, 4, 1) [px]."""
    normal = normals(corners, corners[:, AFTER])
    r, s = corners + begin * normal, corners[:, AFTER] + end * normal
    p, e = r[:, BEFORE], s - r
    d, gap = e[:, BEFORE], r - p
    cross = d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[..., 0] * e[..., 1] - gap[..., 1] * e[..., 0]) / cross
        return np.asarray(p + t[..., None] * d)


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

    def taken_out(self, picture: Picture, corners: Array, whole: Collection[int]) -> Array:
        """Return corners (Q, 4, 2) [px] of markers without their offset; `whole`: those that are not covered,
        by their numbers, which are their places in Q."""
        self._since += bool(whole)
        settled = self._pictures == PICTURES
        slope, gap = np.zeros((2, 0))
        if whole and not (settled and self._since < EVERY):
            slope, gap = _edges_of_cells(picture, corners, whole, self.gamma)
        weight = float(slope @ slope)
        if weight > 0.0:
            now = float(slope @ gap) / weight
            self._since, self._pictures = 0, min(self._pictures + 1, PICTURES)
            count = PICTURES // EVERY if settled else self._pictures
            scatter = float(np.sqrt(np.mean((gap - now * slope) ** 2)))
            self.sd = math.hypot(scatter / math.sqrt(weight * count), APART)
            before = now if self.offset is None else self.offset
            self.offset = before + (now - before) / count
        if self.offset is None:
            return corners
        moved = _meeting(corners, self.offset, self.offset)
        gamma = min(max(self.gamma + self.offset / BY_POWER, POWERS[0]), POWERS[1])
        if abs(self.offset) > OTHER and gamma != self.gamma:
            self.offset, self.gamma, self._pictures = None, gamma, 0
        return moved


def _edges_of_cells(
    picture: Picture, corners: Array, numbers: Collection[int], gamma: float
) -> tuple[Array, Array]:
    """Return (2, E) of the edges of cells of these markers: what an offset of one pixel does to each, and how
    far it is off [px]."""
    slopes, lines, half = list[Array](), list[Array](), list[Array]()
    for number in numbers:
        side = float(np.hypot(*(np.roll(corners[number], -1, axis=0) - corners[number]).T).min())
        across, places = _cell_edges(number)
        p, q = project(homography(corners[number]), places)
        slopes.append(2.0 * across - 1.0)
        lines.append(np.stack((p, q, normals(p, q))))
        half.append(np.full(len(p), min(REACHES[-1], REACH * side / BITS)))
    every, reach = np.concatenate(lines, axis=1), np.concatenate(half)
    found = edges(picture, every, reach, gamma, stations=FEW)
    kept = (found[:, 2] >= LEAST_OF_CELLS) & (reach >= LEAST_REACH)
    return np.concatenate(slopes)[kept], found[kept, :2].mean(axis=1)


@cache
def _cell_edges(number: int) -> tuple[Array, Array]:
    """Return u (E,) towards the light of the edges between the cells of a marker, and both their ends (2, E,
    2), in sides: as they are seen, the light is to the left of the way from the first to the second."""
    grid, across, places = cells(number).astype(int), list[float](), list[Array]()
    for turned in (False, True):  # lines along y, then along x
        for j, kinds in enumerate(np.diff(grid.T if turned else grid, axis=1).T, start=1):
            at, starts = j / BITS - 0.5, np.flatnonzero(np.diff(kinds, prepend=0))
            for i, stop in zip(starts, np.append(starts[1:], BITS), strict=True):
                if kinds[i]:
                    y, low = 0.5 - (i + END) / BITS, 0.5 - (stop - END) / BITS
                    ends = np.array([(at, y), (at, low)])[:: kinds[i]]
                    across.append(at * kinds[i])
                    places.append(-ends[::-1, ::-1] if turned else ends)
    return np.array(across), np.stack(places, axis=1)
