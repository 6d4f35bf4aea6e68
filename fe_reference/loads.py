"""Loads: forces and moments on bodies and at free ends, and weights, in statics and while time passes.

A dead force F at an offset o from the point of its row has the potential -F.(d + (R - 1) o), and so a moment
and a stiffness that depend on the turn. A follower R F has no potential: its tangent is the product
-R' F (x) 1 of its rate in the turn and the turn's unit vector, which is not symmetric.
"""

from dataclasses import dataclass

import numpy as np

from .arrays import Array, Indices, kernel
from .errors import History
from .loading import Load, TipForce
from .model import Model
from .places import swept, turned

#: Rows (K,) that loads act on; force x, y [N], moment [N m], offset of the point [m] and whether the force
#: turns with it (K, 6); factors (K,), and room for the generalised forces (K, 3).
Pulls = tuple[Indices, Array, Array, Array]
#: Begins (K + 1,) of the histories of loads in instants [s] and factors (H,).
Histories = tuple[Indices, Array, Array]


def pulls_of(rows: Array | Indices, table: Array) -> Pulls:
    """Return loads on rows, in full.

    Args:
        rows: rows (K,) that the loads act on.
        table: forces [N], moment [N m], offset of the point [m] and whether the force turns with it (K, 6).
    """
    many = len(rows)
    return np.asarray(rows, dtype=np.int64), np.reshape(table, (many, 6)), np.ones(many), np.zeros((many, 3))


@kernel()
def put_factors(histories: Histories, time: float, out: Array) -> None:
    """Write the factors of piecewise linear histories at an instant; constant before and after them.

    Args:
        histories: begins (K + 1,), instants (H,) [s] and factors (H,) [1].
        time: instant [s].
        out: factors of the loads (K,) [1], overwritten.
    """
    begins, instants, factors = histories
    for i in range(len(out)):
        out[i] = factors[begins[i]]
        for k in range(begins[i] + 1, begins[i + 1]):
            part = (time - instants[k - 1]) / (instants[k] - instants[k - 1])
            out[i] += min(max(part, 0.0), 1.0) * (factors[k] - factors[k - 1])


@kernel()
def pull(pulls: Pulls, share: float, u: Array, force: Array, curvature: Array) -> float:
    """Subtract a share of the loads from the resisting forces.

    Args:
        pulls: rows, table, factors and generalised forces of K loads; the last are overwritten.
        share: part of the loads that acts [1].
        u: displacements of all rows (rows, 3) [m, rad].
        force: resisting forces (rows, 3) [N, N m], changed.
        curvature: second derivatives of the potential by turns (rows, 2) [N m], added to.

    Returns:
        Work of all loads with a potential since rest [J]: followers have none.
    """
    (rows, table, factors, out), work = pulls, 0.0
    for k in range(len(rows)):
        i, pulled, follows = rows[k], table[k], table[k, 5] > 0.0
        x, y, moment = factors[k] * pulled[0], factors[k] * pulled[1], factors[k] * pulled[2]
        if not follows:
            work += x * u[i, 0] + y * u[i, 1] + moment * u[i, 2]
        if follows or pulled[3] != 0.0 or pulled[4] != 0.0:
            arm_x, arm_y = turned(u[i, 2], pulled[3], pulled[4])
            if follows:
                x, y = turned(u[i, 2], x, y)
            else:
                way = swept(u[i, 2], pulled[3], pulled[4])
                work += x * way[0] + y * way[1]
                curvature[i, 1] += share * (arm_x * x + arm_y * y)
            moment += arm_x * y - arm_y * x
        out[k, 0], out[k, 1], out[k, 2] = x, y, moment
        force[i, 0] -= share * x
        force[i, 1] -= share * y
        force[i, 2] -= share * moment
    return work


@kernel()
def load_power(pulls: Pulls, v: Array) -> float:
    """Return the power of loads in full at the velocities of all rows [W].

    Args:
        pulls: K loads whose generalised forces (K, 3) [N, N m] are known, by `pull`.
        v: velocities of all rows (rows, 3) [m/s, rad/s].
    """
    (rows, _, _, out), power = pulls, 0.0
    for k in range(len(rows)):
        i = rows[k]
        power += out[k, 0] * v[i, 0] + out[k, 1] * v[i, 1] + out[k, 2] * v[i, 2]
    return power


@dataclass(frozen=True, kw_only=True, eq=False)
class Loads:
    """The named loads of a model."""

    pulls: Pulls
    histories: Histories

    @classmethod
    def of(cls, model: Model, points: Array) -> "Loads":
        """Return those of a model whose bodies are reduced about `points` (B, 2) [m]."""
        rows, table, histories = [], [], list[History]()
        for load in model.effects.every(Load):
            if isinstance(load, TipForce):
                row, offset = (model.strip_index(load.strip) + 1) * model.arcs.shape[1] - 1, np.zeros(2)
            else:
                k = model.body_index(load.body)
                row, place = model.arcs.size + k, model.bodies[k].centre if load.at is None else load.at
                offset = place - points[k]
            rows.append(row)
            table.append((*load.force, load.moment, *offset, load.follower))
            histories.append(load.history)
        instants, factors = np.array([point for each in histories for point in each]).reshape(-1, 2).T.copy()
        begins = np.cumsum([0, *map(len, histories)])
        return cls(pulls=pulls_of(np.array(rows), np.array(table)), histories=(begins, instants, factors))

    def factors(self, time: float | None = None) -> Array | None:
        """Return the factors of the loads in full, or at an instant [s], (K,); None if there are none."""
        factors = np.ones(len(self.pulls[0]))
        if time is not None:
            put_factors(self.histories, time, factors)
        return factors if factors.size else None

    @property
    def _following(self) -> Indices:
        table = self.pulls[1]
        return np.flatnonzero((table[:, 5] > 0.0) & table[:, :2].any(axis=1))

    @property
    def follows(self) -> bool:
        """Whether there are loads without a potential."""
        return len(self._following) > 0

    def tangent(self, share: float, numbers: Indices, u: Array, size: int) -> tuple[Array, Array]:
        """Return vectors (R, size), whose products a share of the loads that follow adds to the tangent.

        numbers (rows, 3): coordinates. u (rows, 3): displacements and turns.
        """
        (rows, table, factors, _), follow = self.pulls, self._following
        left, right = np.zeros((2, len(follow), size))
        for r, k in enumerate(follow):
            x, y = turned(u[rows[k], 2], *(share * factors[k] * table[k, :2]))
            left[r, numbers[rows[k], :2]] = y, -x
            right[r, numbers[rows[k], 2]] = 1.0
        return left, right

    def steepest(self, inertia: Array) -> float:
        """Return what no stiffness of turns by forces beside the points of rows exceeds, over the inertia
        (rows,) [1/s^2]."""
        (rows, table, _, _), (begins, _, factors), total = self.pulls, self.histories, 0.0
        for k in np.flatnonzero(table[:, 3:5].any(axis=1)):
            largest = np.abs(factors[begins[k] : begins[k + 1]]).max()
            total += float(largest * np.hypot(*table[k, :2]) * np.hypot(*table[k, 3:5]) / inertia[rows[k]])
        return total
