"""States of equilibrium: rates, torque and stiffness along their path, and the stiffness of a body."""

from dataclasses import replace

import numpy as np

from .arrays import Array, kernel
from .control import Control, State
from .law import Written
from .links import between
from .matrix import Singular
from .model import Model
from .places import turned
from .structure import Evaluation, Structure, Tables, structure_of

Rates = tuple[float, float, float, float]


def respond(control: Control, found: State) -> State:
    """Return an equilibrium with its response: one solve for each drive and for the load.

    What is left of the residual is carried to the drives by the same solve: to first order what they exert
    is that of exact equilibrium, free of the round-off in the last elements' forces.

    Raises:
        Singular: the tangent is singular to round-off.
    """
    factors, tangent, held = found.factors, found.at.tangent, control.held
    if factors is None:
        raise Singular(found.failure)
    moves = np.zeros((len(held), control.structure.size))
    moves[np.arange(len(held)), held] = 1.0
    moves -= factors.solve(tangent.times(moves))
    left = factors.solve(found.residual)
    drive, rate = (found.residual - tangent.times(left))[held], control.slope @ moves
    change, bent, first, second = control.rates(found.y, found.parameter)
    if change is not None and bent is not None:
        rate -= factors.solve(change)
        second += float((change + bent) @ rate)
    torque, stiffness = np.nan, np.nan
    if control.watched is not None:
        k = control.held.tolist().index(control.watched)
        torque = float(drive[k])
        stiffness = _stiffness_between(control.structure, found.at, found.y, moves[k], moves[k], left)
    return replace(
        found,
        rate=rate,
        conjugate=first + float(drive @ control.slope),
        slope=second + float(rate @ tangent.times(rate)),
        drive=drive,
        torque=torque,
        stiffness=stiffness,
    )


def _stiffness_between(
    structure: Structure, at: Evaluation, y: Array, one: Array, other: Array, left: Array
) -> float:
    """Return the second derivative of the potential at y along two rates (size,), by its elements.

    Nodes move far where elements strain little: the tangent times the rate loses the digits by which EA l^2
    exceeds EI. What is `left` to equilibrium (size,) takes the round-off of places out of the forces.
    """
    u, (v, w, rest) = structure.displacement(y), (structure.velocity(y, rate) for rate in (one, other, left))
    written = (structure.work[0], at.ends, at.matrices, structure.work[1])
    own = float(_between(structure.tables, u, v, w, rest, written))
    own += at.tangent.apart(one, other) + float(at.curvature[:, 1] @ (v[:, 2] * w[:, 2]))
    return own + between(structure.links, u, v, w) if len(structure.links[1]) else own


@kernel()
def _strained(x: float, y: float, rate: Array, i: int) -> tuple[float, Rates]:
    """Return how fast the chord (x, y) of an element turns, and the rest of the rates of its nodes."""
    j = i + 1
    step_x, step_y = rate[j, 0] - rate[i, 0], rate[j, 1] - rate[i, 1]
    w = (x * step_y - y * step_x) / (x * x + y * y)
    return w, (rate[i, 2] - w, step_x + w * y, step_y - w * x, rate[j, 2] - w)


@kernel()
def _between(tables: Tables, u: Array, one: Array, other: Array, left: Array, written: Written) -> float:
    """Return the same of the elements and of the nodes on bodies; of what is written forces are scratch.

    With v the turn of an element's chord (x, y), its own change c = rate - v (-y, x, 1) strains it, and of
    the rest it is known that the force (X, Y) turns along. With w and d for the other rate it is

        c.H d + w (X c_y - Y c_x) + v (X d_y - Y d_x) + v w (X x + Y y)        [N m]
    """
    ((_, table, first, _), (attached, carrier, offsets, _), _, _), (force, ends, matrices, _) = (
        tables,
        written,
    )
    total = 0.0
    force[:] = 0.0
    for e in range(len(first)):
        i, h = first[e], matrices[e]
        j, pull_x, pull_y = i + 1, ends[e, 0], ends[e, 1]
        for k in range(3):
            pull_x -= h[3, k] * left[i, k] + h[3, 3 + k] * left[j, k]
            pull_y -= h[4, k] * left[i, k] + h[4, 3 + k] * left[j, k]
        x, y = table[e, 0] + (u[j, 0] - u[i, 0]), table[e, 1] + (u[j, 1] - u[i, 1])
        v, c = _strained(x, y, one, i)
        w, d = _strained(x, y, other, i)
        for a in range(4):
            for b in range(4):
                total += c[a] * h[2 + a, 2 + b] * d[b]
        total += w * (pull_x * c[2] - pull_y * c[1]) + v * (pull_x * d[2] - pull_y * d[1])
        total += v * w * (pull_x * x + pull_y * y)
        force[i, 0], force[i, 1] = force[i, 0] - pull_x, force[i, 1] - pull_y
        force[j, 0], force[j, 1] = force[j, 0] + pull_x, force[j, 1] + pull_y
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(u[b, 2], offsets[k, 0], offsets[k, 1])
        total -= one[b, 2] * other[b, 2] * (x * force[i, 0] + y * force[i, 1])
    return total


def body_stiffness(
    model: Model, states: Array, shares: Array, body: str | None = None, *, driven: str | None = None
) -> Array:
    """Return the stiffness (S, 3, 3) of a body's x, y and turn about its centre at balanced states (S, size).

    It is the change of what must be exerted on the body, forces [N] and a moment [N m], by displacements [m]
    and a turn [rad] in the axes of the ground: each of the three is prescribed in turn, the others held, and
    all other coordinates follow by the consistent tangent, under loads that stay. What is prescribed to the
    body is released, what is prescribed to others holds them.

    Args:
        model: the mesh that the states belong to. shares (S,): of the load that acts there.
        body: its name; None: the only one. driven: name of the body whose turn is led, if there is one.

    Exact for the mesh. nan where the tangent is singular.
    """
    structure = structure_of(model)
    place, held = structure.body_slice(model.body_index(body)), np.zeros(structure.size, dtype=bool)
    held[place] = True
    if driven is not None:
        held[structure.turns[model.body_index(driven)]] = True
    # without a name it is of the body that is asked for
    held[[structure.first_body + at for at in model.prescribed(model.body_index(body))]] = True
    units, nothing = np.zeros((3, structure.size)), np.zeros(structure.size)
    units[:, place] = np.eye(3)
    found = np.full((len(states), 3, 3), np.nan)
    load = structure.loads.factors()
    for k, y in enumerate(np.asarray(states)):
        at = structure.evaluate(y, load=load, acts=float(shares[k]))
        try:
            moves = units - at.tangent.factors(held).solve(at.tangent.times(units))
        except Singular:
            continue
        found[k] = [[_stiffness_between(structure, at, y, a, b, nothing) for b in moves] for a in moves]
    return found
