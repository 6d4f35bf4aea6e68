"""Loads fixed in space: dead forces and moments on bodies, and forces at free ends, with their histories."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .arrays import Array, Indices, kernel
from .effects import ALWAYS_FULL, AppliedForce, AppliedMoment, TipForce, factor_of
from .errors import History
from .rigid import turned
from .structure import Structure

#: Loads while time passes, as `load_tables` makes them.
Histories = tuple[Indices, Array, Indices, Array, Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Pull:
    """A load on one body or node.

    Attributes:
        target: index of the body, or the node i as -1 - i.
        row (5,): force x, y [N], moment [N m], and the offset of the point from the body's point [m].
        history: instants [s] and factors.
    """

    target: int
    row: Array
    history: History = ALWAYS_FULL


def applied(structure: Structure) -> list[Pull]:
    """Return the named loads of a scene."""
    effects, pulls = structure.model.effects, []
    if (force := effects.find(AppliedForce)) is not None:
        pulls.append(on_body(structure, force.body, force=force.force, history=force.history))
    if (moment := effects.find(AppliedMoment)) is not None:
        pulls.append(on_body(structure, moment.body, moment=moment.moment, history=moment.history))
    if (tip := effects.find(TipForce)) is not None:
        node = (structure.model.strip_index(tip.strip) + 1) * structure.stations - 1
        row = np.array([*tip.force, 0.0, 0.0, 0.0])
        pulls.append(Pull(target=-1 - node, row=row, history=tip.history))
    return pulls


def on_body(
    structure: Structure,
    name: str | None,
    *,
    force: Sequence[float] = (0.0, 0.0),
    moment: float = 0.0,
    history: History = ALWAYS_FULL,
) -> Pull:
    """Return a dead force [N] at the centre of a body (None: the only one) and a moment [N m] on it."""
    k = structure.model.body_index(name)
    offset = structure.model.bodies[k].centre - structure.points[k]
    return Pull(target=k, row=np.array([*force, moment, *offset]), history=history)


def load_vector(structure: Structure, pulls: Sequence[Pull], time: float | None = None) -> Array:
    """Return the generalised force of loads (size,) of a structure about the centres of its bodies.

    It is constant: the loads act at centres and free ends, where they have no arm that turns. They act in
    full, or as their histories are at an instant [s].
    """
    vector = np.zeros(structure.size)
    for pull in pulls:
        free = np.flatnonzero(structure.free_nodes == -1 - pull.target)
        at = structure.first_body + 3 * pull.target if pull.target >= 0 else 3 * int(free[0])
        vector[at : at + 3] += (1.0 if time is None else factor_of(pull.history, time)) * pull.row[:3]
    return vector


def full_load(structure: Structure, *more: Pull, time: float | None = None) -> Array | None:
    """Return all named loads and more as one (size,), as of `load_vector`; None if there are none."""
    pulls = [*applied(structure), *more]
    return load_vector(structure, pulls, time) if pulls else None


def load_tables(pulls: Sequence[Pull]) -> Histories:
    """Return targets (K,), rows (K, 5), begins (K + 1,) of the histories in instants and factors (H,)."""
    points = np.array([point for pull in pulls for point in pull.history]).reshape(-1, 2)
    instants, factors = np.ascontiguousarray(points.T)
    begins = np.cumsum([0, *(len(pull.history) for pull in pulls)])
    rows = np.array([pull.row for pull in pulls]).reshape(-1, 5)
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
def load_forces(histories: Histories, time: float, bodies: Array, pulls: Array) -> None:
    """Write the generalised forces (K, 3) of the loads at an instant."""
    targets, rows, begins, instants, factors = histories
    for k in range(len(targets)):
        factor, moment = _factor_at(instants, factors, begins[k], begins[k + 1], time), rows[k, 2]
        if targets[k] >= 0:
            x, y = turned(bodies[targets[k], 2], rows[k, 3], rows[k, 4])
            moment += x * rows[k, 1] - y * rows[k, 0]
        pulls[k, 0], pulls[k, 1], pulls[k, 2] = factor * rows[k, 0], factor * rows[k, 1], factor * moment


@kernel()
def load_power(targets: Indices, pulls: Array, v: Array, bodies_v: Array) -> float:
    """Return the power of the loads [W]."""
    power = 0.0
    for k in range(len(targets)):
        rate = bodies_v[targets[k]] if targets[k] >= 0 else v[-1 - targets[k]]
        power += pulls[k, 0] * rate[0] + pulls[k, 1] * rate[1] + pulls[k, 2] * rate[2]
    return power


@kernel()
def put_loads(targets: Indices, pulls: Array, force: Array, resultants: Array) -> None:
    """Take the loads from the forces that resist."""
    for k in range(len(targets)):
        for i in range(3):
            if targets[k] >= 0:
                resultants[targets[k], i] -= pulls[k, i]
            else:
                force[-1 - targets[k], i] -= pulls[k, i]
