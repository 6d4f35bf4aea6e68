"""How an equilibrium changes along its path: rates, work, and torque and stiffness of the watched turn."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .control import Control
from .law import kernel
from .matrix import Singular
from .newton import Outcome
from .structure import Evaluation, Structure

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Response:
    """How an equilibrium changes along its path.

    Attributes:
        rate: d y / d p (size,).
        conjugate, slope: first and second derivative of the total potential along the path [J].
        torque, stiffness: generalised force on the watched turn [N m] and its derivative [N m/rad], all that
            is not held being free; nan if no turn is watched.
        inertia: number of negative eigenvalues of the tangent on the free coordinates; 0: stable.
    """

    rate: Array
    conjugate: float
    slope: float
    torque: float
    stiffness: float
    inertia: int


def respond(control: Control, found: Outcome) -> Response:
    """Return the response at an equilibrium: one solve for each drive and for the load; raises Singular.

    What is left of the residual is carried to the drives by the same solve: to first order what they exert
    is that of exact equilibrium, free of the round-off in the last elements' forces.
    """
    y, parameter, balance, factors = found.y, found.parameter, found.balance, found.factors
    if factors is None:
        raise Singular(found.failure)
    tangent, held = balance.at.tangent, control.held
    moves = np.zeros((len(held), control.structure.size))
    moves[np.arange(len(held)), held] = 1.0
    moves -= factors.solve(tangent.times(moves))
    drive, rate = moves @ balance.residual, control.slope @ moves
    change, first, second = control.rates(y, parameter, balance.load_work)
    if change is not None:
        rate -= factors.solve(change)
        second += 2.0 * float(change @ rate)
    along = tangent.times(rate)
    torque, stiffness = np.nan, np.nan
    if control.watched is not None:
        if control.is_held[control.watched]:
            k = int(np.flatnonzero(held == control.watched)[0])
            torque, move = float(drive[k]), moves[k]
        else:
            acts = 0.0 if control.load is None else control.share(parameter) * control.load[control.watched]
            torque = float(balance.residual[control.watched] + acts)
            unit = np.zeros(control.structure.size)
            unit[control.watched] = 1.0
            move = factors.solve(unit)
            move /= move[control.watched]
        left = factors.solve(balance.residual)
        stiffness = stiffness_along(control.structure, balance.at, y, move, left)
    return Response(
        rate=rate,
        conjugate=first + float(drive @ control.slope),
        slope=second + float(rate @ along),
        torque=torque,
        stiffness=stiffness,
        inertia=factors.negative,
    )


def stiffness_along(structure: Structure, at: Evaluation, y: Array, rate: Array, left: Array) -> float:
    """Return the second derivative of the potential at y along a rate (size,), by its elements.

    Nodes move far where elements strain little: the tangent times the rate loses the digits by which EA l^2
    exceeds EI. What is `left` to equilibrium (size,) takes the round-off of places out of the forces.
    """
    nodes = (structure.displacement(y), structure.velocity(y, rate), structure.velocity(y, left))
    (_, table, first), (attached, _, offsets) = structure.given, structure.carried
    own = _along(table, first, attached, offsets, at.ends, at.matrices, *nodes, structure.work[0])
    return own + float(at.curvature[1] @ rate[structure.turns] ** 2)


@kernel()
def _along(
    table: Array,
    first: Indices,
    attached: Indices,
    offsets: Array,
    ends: Array,
    matrices: Array,
    u: Array,
    v: Array,
    left: Array,
    force: Array,
) -> float:
    """Return the same of the elements and of the nodes on bodies; force (nodes, 3): scratch.

    With w the turn of an element's chord (x, y), its own change d = v - w (-y, x, 1) strains it, and of the
    rest it is known that the force (X, Y) turns along:

        d.H d + 2 w (X d_y - Y d_x) + w^2 (X x + Y y)        [N m]
    """
    total = 0.0
    force[:] = 0.0
    for e in range(len(first)):
        i, h = first[e], matrices[e]
        j, pull_x, pull_y = i + 1, ends[e, 0], ends[e, 1]
        for k in range(3):
            pull_x -= h[3, k] * left[i, k] + h[3, 3 + k] * left[j, k]
            pull_y -= h[4, k] * left[i, k] + h[4, 3 + k] * left[j, k]
        x, y = table[e, 0] + (u[j, 0] - u[i, 0]), table[e, 1] + (u[j, 1] - u[i, 1])
        step_x, step_y = v[j, 0] - v[i, 0], v[j, 1] - v[i, 1]
        w = (x * step_y - y * step_x) / (x * x + y * y)
        own = (0.0, 0.0, v[i, 2] - w, step_x + w * y, step_y - w * x, v[j, 2] - w)
        for a in range(2, 6):
            for b in range(2, 6):
                total += own[a] * h[a, b] * own[b]
        total += 2.0 * w * (pull_x * own[4] - pull_y * own[3]) + w * w * (pull_x * x + pull_y * y)
        force[i, 0], force[i, 1] = force[i, 0] - pull_x, force[i, 1] - pull_y
        force[j, 0], force[j, 1] = force[j, 0] + pull_x, force[j, 1] + pull_y
    for k in range(len(attached)):
        i = attached[k]
        c, s = math.cos(u[i, 2]), math.sin(u[i, 2])
        x, y = c * offsets[k, 0] - s * offsets[k, 1], s * offsets[k, 0] + c * offsets[k, 1]
        total -= v[i, 2] * v[i, 2] * (x * force[i, 0] + y * force[i, 1])
    return total
