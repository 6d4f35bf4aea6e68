"""Loads: forces and moments on bodies and at free ends, and weights, in statics and while time passes.

A dead force F at an offset o from the point of its row has the potential -F.(d + (R - 1) o), and so a moment
and a stiffness that depend on the turn. A follower R F has no potential: its tangent is the product
-R' F (x) 1 of its rate in the turn and the turn's unit vector, which is not symmetric.

Links are springs and dampers between two places: roots that give way, springs of a scene, dampers of bodies.
A link between the points of two rows stretches by

    e = (u_1 - u_2, theta_1 - theta_2)

in axes of the ground, with u as in `places`. It resists with f = diag(k) e + diag(c) e'. The energy is
e.diag(k) e / 2. At the root of a strip it is between the node and what carries it, for turns alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import read
from .arrays import Array, Indices, kernel
from .effects import BodyDamping, Load, Spring
from .matrix import Symmetric
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
    """The named loads of a model, and the numbers of those without a potential."""

    pulls: Pulls
    histories: Histories
    following: Indices

    @classmethod
    def of(cls, model: Model, points: Array) -> "Loads":
        """Return those of a model whose bodies are reduced about `points` (B, 2) [m]."""
        rows, table, histories = [], [], list[read.History]()
        for load in model.effects.every(Load):
            if load.strip is not None:
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
        pulls = pulls_of(np.array(rows), np.array(table))
        following = np.flatnonzero((pulls[1][:, 5] > 0.0) & pulls[1][:, :2].any(axis=1))
        return cls(pulls=pulls, histories=(begins, instants, factors), following=following)

    def factors(self, time: float | None = None) -> Array | None:
        """Return the factors of the loads in full, or at an instant [s], (K,); None if there are none."""
        factors = np.ones(len(self.pulls[0]))
        if time is not None:
            put_factors(self.histories, time, factors)
        return factors if factors.size else None

    @property
    def follows(self) -> bool:
        """Whether there are loads without a potential."""
        return len(self.following) > 0

    def tangent(self, share: float, numbers: Indices, u: Array, size: int) -> tuple[Array, Array]:
        """Return vectors (R, size), whose products a share of the loads that follow adds to the tangent.

        numbers (rows, 3): coordinates. u (rows, 3): displacements and turns.
        """
        rows, table, factors, _ = self.pulls
        left, right = np.zeros((2, len(self.following), size))
        for r, k in enumerate(self.following):
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


#: How many of the links are roots, which come first; rows at both ends (K, 2), offsets of their points
#: (K, 2, 2) [m], stiffness and damping (K, 3) for x, y and the turn.
Links = tuple[int, Indices, Array, Array, Array]
Parts = tuple[float, float, float]


def links_of(model: Model, points: Array, soft: Sequence[tuple[int, int, float]], relaxation: float) -> Links:
    """Return the links of a model whose bodies are reduced about `points` (B, 2) [m].

    soft: of the roots that give way: node, row of what it is on, and stiffness [N m]. relaxation: their time
    of relaxation [s].
    """
    bodies, effects, found = len(model.bodies), model.effects, []
    damper = effects.find(BodyDamping)
    for node, row, stiffness in soft:
        if stiffness > 0.0:  # a hinge has none
            found.append((node, row, *(0.0,) * 6, stiffness, 0.0, 0.0, relaxation * stiffness))
    roots, offsets = len(found), np.vstack([model.centres - points, np.zeros((1, 2))])
    every = [(model.body_index(each.body), each) for each in effects.every(Spring)]
    if damper is not None and (damper.translation or damper.rotation):
        own = Spring(damping=(damper.translation,) * 2, rotational_damping=damper.rotation)
        every += [(body, own) for body in range(bodies)]
    for body, spring in every:
        other = bodies if spring.other is None else model.body_index(spring.other)
        stiff = (*spring.stiffness, spring.rotational_stiffness)
        damping = (*spring.damping, spring.rotational_damping)
        rows = model.arcs.size + body, model.arcs.size + other
        found.append((*rows, *offsets[[body, other]].flat, *stiff, *damping))
    table = np.reshape(np.array(found, dtype=np.float64), (-1, 12))
    ends, arms, stiffnesses, viscous = (part.copy() for part in np.split(table, (2, 6, 9), axis=1))
    return roots, ends.astype(np.int64), arms.reshape(-1, 2, 2), stiffnesses, viscous


@kernel()
def link_forces(links: Links, u: Array, v: Array, force: Array, curvature: Array) -> Parts:
    """Add the forces of links to forces and curvature at displacements and velocities.

    Args:
        links: rows, offsets, stiffness and damping of K links.
        u, v: displacements (rows, 3) [m, rad] and velocities (rows, 3) [m/s, rad/s].
        force: generalised forces (rows, 3) [N, N m], added to.
        curvature: second derivatives of the energy by turns (rows, 2) [N m], added to.

    Returns:
        Energy of the roots and of all other links [J], and the power that is lost [W].
    """
    (roots, ends, offsets, stiffness, damping), rooted, energy, loss = links, 0.0, 0.0, 0.0
    for k in range(len(ends)):
        x = y = turn = x_rate = y_rate = turn_rate = 0.0
        for end in range(2):
            i, sign = ends[k, end], 1.0 - 2.0 * end
            way = swept(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            arm = turned(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            x, y = x + sign * (u[i, 0] + way[0]), y + sign * (u[i, 1] + way[1])
            x_rate += sign * (v[i, 0] - v[i, 2] * arm[1])
            y_rate += sign * (v[i, 1] + v[i, 2] * arm[0])
            turn, turn_rate = turn + sign * u[i, 2], turn_rate + sign * v[i, 2]
        h, c = stiffness[k], damping[k]
        force_x, force_y = h[0] * x + c[0] * x_rate, h[1] * y + c[1] * y_rate
        moment = h[2] * turn + c[2] * turn_rate
        stored = 0.5 * (h[0] * x * x + h[1] * y * y + h[2] * turn * turn)
        if k < roots:
            rooted += stored
        else:
            energy += stored
        loss += c[0] * x_rate * x_rate + c[1] * y_rate * y_rate + c[2] * turn_rate * turn_rate
        for end in range(2):
            i, sign = ends[k, end], 1.0 - 2.0 * end
            arm = turned(u[i, 2], offsets[k, end, 0], offsets[k, end, 1])
            force[i, 0] += sign * force_x
            force[i, 1] += sign * force_y
            force[i, 2] += sign * (moment + arm[0] * force_y - arm[1] * force_x)
            curvature[i, 1] -= sign * (arm[0] * force_x + arm[1] * force_y)
    return rooted, energy, loss


def _slopes(links: Links, u: Array) -> Array:
    """Return the derivatives of the stretches (K, 3, 6) by displacements and turns at both ends."""
    found = np.zeros((len(links[1]), 3, 6))
    for each, pair, arms in zip(found, links[1], links[2], strict=True):
        for end, sign in enumerate((1.0, -1.0)):
            x, y = turned(u[pair[end], 2], *arms[end])
            each[:, 3 * end : 3 * end + 3] = sign * np.array([[1, 0, -y], [0, 1, x], [0, 0, 1]])
    return found


def add_links(links: Links, u: Array, constants: Array, whole: Symmetric) -> None:
    """Add the matrix of stiffness [N/m, N m] or damping [N s/m, N m s] of links to a matrix.

    Args:
        links: rows, offsets, stiffness and damping of K links.
        u: displacements of all rows (rows, 3) [m, rad].
        constants: stiffness or damping (K, 3) in x, y and the turn.
        whole: matrix (size, size) that is added to.
    """
    for at, slope, own in zip(whole.pattern.links, _slopes(links, u), constants, strict=True):
        np.add.at(whole.data, at[at >= 0], (slope.T * own @ slope)[at >= 0])


def between(links: Links, u: Array, one: Array, other: Array) -> float:
    """Return the second derivative of the energy at fixed forces along two rates (rows, 3) [J]."""
    first, second = (
        np.einsum("kij,kj->ki", _slopes(links, u), rates[links[1]].reshape(-1, 6)) for rates in (one, other)
    )
    return float(np.sum(first * second * links[3]))


def fastest(links: Links, constants: Array, mass: Array, inertia: Array) -> float:
    """Return what no ratio of constants (K, 3) of links to masses and inertias (rows,) exceeds
    [1/s^2 or 1/s], roots excluded.

    It is the sum of the largest ratios of each link alone. At an arm o its end has the mass 1 / (1/m + o^2/J)
    at least.
    """
    roots, ends, offsets, *_ = links
    pairs, arms, own = (each[roots:] for each in (ends, offsets, constants))
    light, turning = 1.0 / mass[pairs], 1.0 / inertia[pairs]
    along = own[:, :2].max(axis=1, initial=0.0) * np.sum(light + turning * np.sum(arms**2, axis=2), axis=1)
    return float(np.sum(along + own[:, 2] * np.sum(turning, axis=1)))
