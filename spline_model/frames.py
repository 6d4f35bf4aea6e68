"""Frames that bodies carry: points at which strips are hinged to bodies or to the ground, or where loads act.

Their coordinates follow from those of their bodies, r_frame = r + R(theta) o, and are no unknowns: kernels
that are given coordinates place them, and what acts on them is folded on their bodies by the chain rule.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.strip.compiled import called, part

Array = NDArray[np.float64]
Places = NDArray[np.int64]


class Frames(NamedTuple):
    """C frames among the coordinates of bodies.

    place (C, 3): of the frame's x; of its carrier's, or -1 on the ground; how many of its coordinates follow,
    3 where it turns with the carrier. lever (C, 2): o at rest, or the point on the ground.
    """

    place: Places
    lever: Array

    @property
    def carried(self) -> list[int]:
        """Places of the coordinates that follow."""
        return [at + k for at, _, count in self.place.tolist() for k in range(count)]

    def among(self, begin: int, length: float) -> Frames:
        """The same over a length, among coordinates that begin with the poses at ``begin``."""
        if not self.place.size:
            return self
        place = self.place.copy()
        place[:, :2] -= np.where(place[:, :2] < 0, 0, begin)
        return Frames(place, self.lever / length)


@called(entered=True)
def carry(y, frames, arms):
    """Put frames where coordinates y have their carriers; arms: R o at their places, for other kernels."""
    for f in range(frames.place.shape[0]):
        at, by, x, z = frames.place[f, 0], frames.place[f, 1], frames.lever[f, 0], frames.lever[f, 1]
        if by < 0:
            y[at], y[at + 1] = x, z
            continue
        cos, sin = np.cos(y[by + 2]), np.sin(y[by + 2])
        arms[at], arms[at + 1] = cos * x - sin * z, sin * x + cos * z
        y[at], y[at + 1] = y[by] + arms[at], y[by + 1] + arms[at + 1]
        if frames.place[f, 2] == 3:
            y[at + 2] = y[by + 2]


@called(entered=True)
def spread(rate, frames, arms):
    """Rates of frames by those of their carriers."""
    for f in range(frames.place.shape[0]):
        at, by = frames.place[f, 0], frames.place[f, 1]
        if by < 0:
            rate[at] = rate[at + 1] = 0.0
            continue
        rate[at], rate[at + 1] = (
            rate[by] - arms[at + 1] * rate[by + 2],
            rate[by + 1] + arms[at] * rate[by + 2],
        )
        if frames.place[f, 2] == 3:
            rate[at + 2] = rate[by + 2]


@called(entered=True)
def fold(force, frames, arms):
    """Add what acts on frames to their carriers; arms keep by how much less its moment gets in a turn."""
    for f in range(frames.place.shape[0]):
        at, by, count = frames.place[f, 0], frames.place[f, 1], frames.place[f, 2]
        x, y = force[at], force[at + 1]
        if by >= 0:
            arms[at + 2] = arms[at] * x + arms[at + 1] * y
            force[by] += x
            force[by + 1] += y
            force[by + 2] += arms[at] * y - arms[at + 1] * x
            if count == 3:
                force[by + 2] += force[at + 2]
        for k in range(count):
            force[at + k] = 0.0


@called(entered=True)
def fold_tangent(tangent, unit, frames, arms, ends):
    """The same of a tangent (N, N), behind that of its gradient; unit: left on the diagonal.

    arms, ends: of its rows and columns, the same ones but over a time step.
    """
    for f in range(frames.place.shape[0]):
        at, by, count = frames.place[f, 0], frames.place[f, 1], frames.place[f, 2]
        for k in range(count):
            row = 1.0 if k == 2 else arms[at] if k == 1 else -arms[at + 1]
            column = 1.0 if k == 2 else ends[at] if k == 1 else -ends[at + 1]
            for j in range(tangent.shape[0] * (by >= 0)):
                if k < 2:
                    tangent[by + k, j] += tangent[at + k, j]
                tangent[by + 2, j] += row * tangent[at + k, j]
            for j in range(tangent.shape[0] * (by >= 0)):
                if k < 2:
                    tangent[j, by + k] += tangent[j, at + k]
                tangent[j, by + 2] += column * tangent[j, at + k]
            for j in range(tangent.shape[0]):
                tangent[at + k, j] = tangent[j, at + k] = 0.0
            tangent[at + k, at + k] = unit
        if by >= 0:
            tangent[by + 2, by + 2] -= ends[at + 2]


@part()
def draw(rate, change, frames, arms):
    """Draw frames to the centres that they turn about: add this to their accelerations, which were spread."""
    for f in range(frames.place.shape[0]):
        at, by = frames.place[f, 0], frames.place[f, 1]
        for k in range(2 * (by >= 0)):
            change[at + k] -= rate[by + 2] * rate[by + 2] * arms[at + k]


@part()
def fold_moving(rate, mass, force, frames, arms):
    """Fold masses (N, N), upper ones, and forces on frames at rates."""
    for i in range(force.size):
        for j in range(i):
            mass[i, j] = mass[j, i]
    for f in range(frames.place.shape[0]):
        at, by = frames.place[f, 0], frames.place[f, 1]
        for k in range(2 * (by >= 0)):
            for i in range(force.size):
                force[i] += mass[i, at + k] * rate[by + 2] * rate[by + 2] * arms[at + k]
    fold(force, frames, arms)
    for f in range(frames.place.shape[0]):
        arms[frames.place[f, 0] + 2] = 0.0  # masses have no part that forces turn
    fold_tangent(mass, 1.0, frames, arms, arms)


NO_FRAMES = Frames(np.zeros((0, 3), dtype=np.int64), np.zeros((0, 2)))
