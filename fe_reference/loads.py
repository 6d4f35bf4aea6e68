"""Loads: forces and moments on bodies and at free ends, and weights, in statics and while time passes.

They act on rows, as of `places`. A dead force F has the potential -F.u of the displacement of its row, and so
does a moment. A follower R F has no potential: its tangent is the product -R' F (x) 1 of its rate in the turn
and the turn's unit vector, which is not symmetric.

Links are springs and dampers between two rows: roots that give way, drag of nodes, springs, dampers. With the
difference e of displacements and turns a link resists with f = diag(k) e + diag(c) e', in axes of the ground.
The energy is e.diag(k) e / 2. At the root of a strip it is between the node and what carries it, for turns
alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from . import read
from .arrays import Array, Indices, kernel
from .effects import BodyDamping, Load, Spring
from .model import Model
from .places import Rows, turned

#: Rows (K,) that loads act on; force x, y [N], moment [N m] and whether the force turns with the row (K, 4);
#: factors (K,), and room for the forces (K, 3).
Pulls = tuple[Indices, Array, Array, Array]
#: Begins (K + 1,) of the histories of loads in instants [s] and factors (H,).
Histories = tuple[Indices, Array, Array]


def pulls_of(rows: Sequence[int] | Indices, table: Sequence[tuple[float, ...]] | Array) -> Pulls:
    """Return loads on rows, in full.

    Args:
        rows: rows (K,) that the loads act on.
        table: forces [N], moment [N m] and whether the force turns with the row (K, 4).
    """
    many = len(rows)
    known = np.array(table, dtype=np.float64).reshape(many, 4)
    return np.array(rows, dtype=np.int64), known, np.ones(many), np.zeros((many, 3))


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
def pull(pulls: Pulls, share: float, u: Array, force: Array) -> float:
    """Subtract a share of the loads from the resisting forces.

    Args:
        pulls: rows, table, factors and forces of K loads; the last are overwritten.
        share: part of the loads that acts [1].
        u: displacements of all rows (rows, 3) [m, rad].
        force: resisting forces (rows, 3) [N, N m], changed.

    Returns:
        Work of all loads with a potential since rest [J]: followers have none.
    """
    (rows, table, factors, out), work = pulls, 0.0
    for k in range(len(rows)):
        i, pulled = rows[k], table[k]
        x, y, moment = factors[k] * pulled[0], factors[k] * pulled[1], factors[k] * pulled[2]
        if pulled[3] > 0.0:
            x, y = turned(u[i, 2], x, y)
        else:
            work += x * u[i, 0] + y * u[i, 1] + moment * u[i, 2]
        out[k, 0], out[k, 1], out[k, 2] = x, y, moment
        force[i, 0] -= share * x
        force[i, 1] -= share * y
        force[i, 2] -= share * moment
    return work


@kernel()
def load_power(pulls: Pulls, v: Array) -> float:
    """Return the power of loads in full at the velocities of all rows [W].

    Args:
        pulls: K loads whose forces (K, 3) [N, N m] are known, by `pull`.
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
    def of(cls, model: Model, points: Rows) -> "Loads":
        """Return those of a model on the rows of its nodes and `points` of its bodies."""
        rows, table, histories = [], [], list[read.History]()
        for load in model.every(Load):
            if load.strip is not None:
                rows.append((model.strip_index(load.strip) + 1) * model.arcs.shape[1] - 1)
            else:
                k = model.body_index(load.body)
                rows.append(points.of(k, load.at or model.bodies[k].centre))
            table.append((*load.force, load.moment, load.follower))
            histories.append(load.history)
        instants, factors = np.array([point for each in histories for point in each]).reshape(-1, 2).T.copy()
        begins = np.cumsum([0, *map(len, histories)])
        pulls = pulls_of(rows, table)
        following = np.flatnonzero((pulls[1][:, 3] > 0.0) & pulls[1][:, :2].any(axis=1))
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

    def steepest(self, arms: Array) -> float:
        """Return what no stiffness of turns by forces beside the points of bodies exceeds, over the inertia
        [1/s^2].

        arms (rows,): of the rows, over the inertia of the bodies that carry them [1/(kg m)].
        """
        (rows, table, _, _), (begins, _, factors), total = self.pulls, self.histories, 0.0
        for k, row in enumerate(rows):
            largest = np.abs(factors[begins[k] : begins[k + 1]]).max()
            total += float(largest * np.hypot(*table[k, :2]) * arms[row])
        return total


#: How many of the links are of strips, which come first; rows at both ends (K, 2), stiffness and damping
#: (K, 3) for x, y and the turn.
Links = tuple[int, Indices, Array, Array]
Parts = tuple[float, float, float]


def links_of(
    model: Model, soft: Sequence[tuple[int, int, float]], relaxation: float, drag: Array, points: Rows
) -> Links:
    """Return the links of a model between its nodes and `points` of its bodies.

    soft: of the roots that give way: node, row of what it is on, and stiffness [N m]. relaxation: their time
    of relaxation [s]. drag: of the nodes (nodes,), zero where there is none [N s/m].
    """
    found: list[tuple[float, ...]] = []
    for node, row, stiffness in soft:
        if stiffness > 0.0:  # a hinge has none
            found.append((node, row, 0.0, 0.0, stiffness, 0.0, 0.0, relaxation * stiffness))
    for node in np.flatnonzero(drag).tolist():
        found.append((node, points.ground, 0.0, 0.0, 0.0, drag[node], drag[node], 0.0))
    strips, every = len(found), [(model.body_index(each.body), each) for each in model.every(Spring)]
    damper = model.find(BodyDamping)
    if damper is not None and (damper.translation or damper.rotation):
        own = Spring(damping=(damper.translation,) * 2, rotational_damping=damper.rotation)
        every += [(body, own) for body in range(len(model.bodies))]
    for body, spring in every:
        other = None if spring.other is None else model.body_index(spring.other)
        rows = points.of(body, model.centres[body]), points.of(other, model.centres[other or 0])
        stiff = (*spring.stiffness, spring.rotational_stiffness)
        found.append((*rows, *stiff, *spring.damping, spring.rotational_damping))
    table = np.reshape(np.array(found, dtype=np.float64), (-1, 8))
    ends, stiffnesses, viscous = (part.copy() for part in np.split(table, (2, 5), axis=1))
    return strips, ends.astype(np.int64), stiffnesses, viscous


@kernel()
def link_forces(links: Links, u: Array, v: Array, force: Array) -> Parts:
    """Add the forces of links at displacements and velocities.

    Args:
        links: rows, stiffness and damping of K links.
        u, v: displacements (rows, 3) [m, rad] and velocities (rows, 3) [m/s, rad/s].
        force: generalised forces (rows, 3) [N, N m], added to.

    Returns:
        Energy of the links of strips and of all others [J], and the power that is lost [W].
    """
    (strips, ends, stiffness, damping), rooted, energy, loss = links, 0.0, 0.0, 0.0
    for k in range(len(ends)):
        i, j, stored = ends[k, 0], ends[k, 1], 0.0
        for p in range(3):
            stretch, rate = u[i, p] - u[j, p], v[i, p] - v[j, p]
            resisting = stiffness[k, p] * stretch + damping[k, p] * rate
            force[i, p] += resisting
            force[j, p] -= resisting
            stored += 0.5 * stiffness[k, p] * stretch * stretch
            loss += damping[k, p] * rate * rate
        if k < strips:
            rooted += stored
        else:
            energy += stored
    return rooted, energy, loss


def link_matrices(constants: Array) -> Array:
    """Return the matrices (K, 8, 8) [N/m, N m] or [N s/m, N m s] of links in the displacements of both rows.

    Args:
        constants: stiffness or damping (K, 3) in x, y and the turn.
    """
    matrices, at = np.zeros((len(constants), 8, 8)), np.arange(3)
    for one, other in ((at, at + 3), (at + 3, at)):
        matrices[:, one, one], matrices[:, one, other] = constants, -constants
    return matrices


def fastest(links: Links, constants: Array, light: Array, turning: Array) -> float:
    """Return what no ratio of constants (K, 3) of links to masses exceeds [1/s^2 or 1/s], strips' excluded.

    It is the sum of the largest ratios of each link alone. light, turning (rows,): the inverse of masses and
    of moments of inertia.
    """
    strips, ends, *_ = links
    own, pairs = constants[strips:], ends[strips:]
    along = own[:, :2].max(axis=1, initial=0.0) * light[pairs].sum(axis=1)
    return float(np.sum(along + own[:, 2] * turning[pairs].sum(axis=1)))
