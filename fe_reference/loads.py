"""Loads: as a function of the coordinates in statics, and compiled for motions.

Loads are forces and moments on bodies and at free ends, with their histories. A dead force F at an offset o
from the point that its body is reduced about has the potential -F.(d + (R - 1) o), and so a moment and a
stiffness that depend on the turn. A follower R F has no potential: its tangent is the product -R' F (x) 1 of
its rate in the turn and the turn's unit vector, which is not symmetric.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .arrays import Array, Indices, kernel
from .errors import History
from .loading import AppliedForce, BodyLoad, TipForce, factor_of
from .matrix import Symmetric, Unsymmetric
from .mesh import swept, turned
from .structure import Evaluation, Structure

#: Loads while time passes, as `load_tables` makes them.
Histories = tuple[Indices, Array, Indices, Array, Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Pull:
    """A load on one body or node.

    Attributes:
        target: index of the body, or the node i as -1 - i.
        row (5,): force x, y [N], moment [N m], and the offset of the point from the body's point [m].
        history: instants [s] and factors. follows: whether the force turns with its target.
    """

    target: int
    row: Array
    history: History
    follows: bool


def applied(structure: Structure) -> list[Pull]:
    """Return the named loads of a scene: at free ends, and on bodies."""
    pulls, model = [], structure.model
    for tip in model.effects.every(TipForce):
        node = (model.strip_index(tip.strip) + 1) * structure.stations - 1
        row = np.array([*tip.force, tip.moment, 0.0, 0.0])
        pulls.append(Pull(target=-1 - node, row=row, history=tip.history, follows=tip.follower))
    for load in model.effects.every(BodyLoad):
        k = model.body_index(load.body)
        force, moment = getattr(load, "force", (0.0, 0.0)), getattr(load, "moment", 0.0)
        place, follows = getattr(load, "at", None), getattr(load, "follower", False)
        place = model.bodies[k].centre if place is None else np.array(place)
        row = np.array([*force, moment, *(place - structure.points[k])])
        pulls.append(Pull(target=k, row=row, history=load.history, follows=follows))
    return pulls


@dataclass(frozen=True, kw_only=True, eq=False)
class Load:
    """All loads together as a function of the coordinates.

    Attributes:
        constant (size,): the part that does not depend on the coordinates [N, N m].
        turning: of each force that does, first coordinate of its body or node, `Pull.row`, and whether it
            follows.
    """

    constant: Array
    turning: tuple[tuple[int, Array, bool], ...]

    @property
    def follows(self) -> bool:
        """Whether it has no potential."""
        return any(follows for _, _, follows in self.turning)

    def force(self, y: Array, followers: bool = True) -> Array:
        """Return the generalised force at coordinates (size,), with those that follow or without."""
        if not self.turning:
            return self.constant
        force = self.constant.copy()
        for at, row, follows in self.turning:
            if follows and not followers:
                continue
            pull, arm = _turned(y[at + 2], row, follows)
            force[at : at + 2] += np.multiply(follows, pull)
            force[at + 2] += arm[0] * pull[1] - arm[1] * pull[0]
        return force

    def work(self, y: Array) -> float:
        """Return the work from rest of the loads that have a potential [J]."""
        work = float(self.constant @ y)
        for at, row, follows in self.turning:
            if not follows:
                work += float(row[:2] @ swept(y[at + 2], row[3], row[4]))
        return work

    def stiffen(self, tangent: Symmetric, y: Array, share: float) -> Symmetric:
        """Return a tangent with what a share of the load adds; what of it is symmetric is added in place."""
        left, right = [], []
        for at, row, follows in self.turning:
            (x, z), arm = _turned(y[at + 2], row, follows)
            if follows:
                left.append(np.zeros(len(y)))
                right.append(np.eye(1, len(y), at + 2)[0])
                left[-1][at : at + 2] = share * z, -share * x
            else:
                tangent.data[tangent.pattern.diagonal[at + 2]] += share * (arm[0] * x + arm[1] * z)
        if not left:
            return tangent
        return Unsymmetric(tangent.pattern, tangent.data, np.array(left), np.array(right))

    def stiffened(self, at: Evaluation, structure: Structure, y: Array, share: float) -> Evaluation:
        """Return an evaluation at y with the stiffness that a share of the load adds."""
        if not self.turning:
            return at
        places = at.tangent.pattern.diagonal[structure.turns]
        before = at.tangent.data[places]
        tangent = self.stiffen(at.tangent, y, share)
        at.curvature[:, 1] += tangent.data[places] - before
        return replace(at, tangent=tangent)


def _turned(turn: float, row: Array, follows: bool) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return force [N] and arm [m] of a load on what is turned."""
    force = turned(turn, row[0], row[1]) if follows else (row[0], row[1])
    return force, turned(turn, row[3], row[4])


def full_load(structure: Structure, *, time: float | None = None) -> Load | None:
    """Return the named loads in full, or as they are at an instant [s]; None if there are none."""
    pulls = applied(structure)
    if not pulls:
        return None
    constant, turning = np.zeros(structure.size), []
    for pull in pulls:
        at = structure.first_body + 3 * pull.target
        if pull.target < 0:
            at = structure.nodal.tolist().index(3 * (-1 - pull.target))
        row = pull.row.copy()
        row[:3] *= 1.0 if time is None else factor_of(pull.history, time)
        constant[at + 2] += row[2]
        if not pull.follows:
            constant[at : at + 2] += row[:2]
        if row[:2].any() and (pull.follows or row[3:].any()):
            turning.append((at, row, pull.follows))
    return Load(constant=constant, turning=tuple(turning))


def steepest(structure: Structure, inertia: Array) -> float:
    """Return what no stiffness of turns by forces off the centres exceeds, over the inertia (B,) [1/s^2]."""
    total, model = 0.0, structure.model
    for load in model.effects.every(AppliedForce):
        if load.at is not None:
            k = model.body_index(load.body)
            arm = math.hypot(*(np.array(load.at) - model.bodies[k].centre))
            total += max(abs(f) for _, f in load.history) * math.hypot(*load.force) * arm / inertia[k]
    return total


def load_tables(pulls: Sequence[Pull]) -> Histories:
    """Return targets (K,), rows and whether they follow (K, 6), begins (K + 1,) in instants, factors (H,)."""
    points = np.array([point for pull in pulls for point in pull.history]).reshape(-1, 2)
    instants, factors = np.ascontiguousarray(points.T)
    begins = np.cumsum([0, *(len(pull.history) for pull in pulls)])
    rows = np.array([(*pull.row, pull.follows) for pull in pulls]).reshape(-1, 6)
    return np.array([pull.target for pull in pulls], dtype=np.int64), rows, begins, instants, factors


@kernel()
def _factor_at(instants: Array, factors: Array, begin: int, end: int, time: float) -> float:
    """Return the factor of a piecewise linear history at an instant; constant before and after it."""
    factor: float = factors[begin]
    for k in range(begin + 1, end):
        part = (time - instants[k - 1]) / (instants[k] - instants[k - 1])
        factor += min(max(part, 0.0), 1.0) * (factors[k] - factors[k - 1])
    return factor


@kernel()
def load_forces(histories: Histories, time: float, u: Array, bodies: Array, pulls: Array) -> None:
    """Write the generalised forces `pulls` (K, 3) [N, N, N m] of the loads at an instant [s]."""
    targets, rows, begins, instants, factors = histories
    for k in range(len(targets)):
        factor, moment = _factor_at(instants, factors, begins[k], begins[k + 1], time), rows[k, 2]
        turn = bodies[targets[k], 2] if targets[k] >= 0 else u[-1 - targets[k], 2]
        force_x, force_y = rows[k, 0], rows[k, 1]
        if rows[k, 5] > 0.0:
            force_x, force_y = turned(turn, force_x, force_y)
        x, y = turned(turn, rows[k, 3], rows[k, 4])
        moment += x * force_y - y * force_x
        pulls[k, 0], pulls[k, 1], pulls[k, 2] = factor * force_x, factor * force_y, factor * moment


@kernel()
def load_power(targets: Indices, pulls: Array, v: Array, bodies_v: Array) -> float:
    """Return the power [W] of the loads `pulls` (K, 3) at velocities of nodes v (nodes, 3) and bodies (B,
    3)."""
    power = 0.0
    for k in range(len(targets)):
        rate = bodies_v[targets[k]] if targets[k] >= 0 else v[-1 - targets[k]]
        power += pulls[k, 0] * rate[0] + pulls[k, 1] * rate[1] + pulls[k, 2] * rate[2]
    return power


@kernel()
def put_loads(targets: Indices, pulls: Array, force: Array, resultants: Array) -> None:
    """Subtract the loads `pulls` (K, 3) [N, N m] from the resisting forces of nodes (nodes, 3) and bodies (B,
    3)."""
    for k in range(len(targets)):
        for i in range(3):
            if targets[k] >= 0:
                resultants[targets[k], i] -= pulls[k, i]
            else:
                force[-1 - targets[k], i] -= pulls[k, i]
