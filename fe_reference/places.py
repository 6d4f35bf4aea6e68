"""Places where something acts: rows of nodes, of bodies and of the ground, and points that bodies carry.

Displacements, velocities and forces of all that can move are one array (rows, 3) of x, y and the turn: the
nodes strip by strip, the reference points of the bodies, the ground, which stays at zero, and then other
points of bodies where something acts. Loads, weights, springs and dampers act on a row. A row that a body
carries, at an offset o from its reference point, moves and turns with it:

    u = d + (R(theta) - 1) o,    u' = d' + theta' (-(R o)_y, (R o)_x)

An end of a strip on a body follows it like that without penalty or extra unknowns, and with phi = theta.
Forces are reduced by the transpose of the derivative P of the map; the tangent is P^T K P plus the curvature
of the map, -(R o).f on the diagonal entry of theta, with f the force on the row.
"""

import math
from collections.abc import Sequence

import numpy as np

from .arrays import Array, Flags, Indices, kernel

#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2
#: Rows (K,) that bodies carry, the rows of these bodies, the offsets (K, 2) from their points, and whether
#: they turn with the bodies; the arms R o (K, 2), which `carry` writes.
Carried = tuple[Indices, Indices, Array, Flags, Array]


class Rows:
    """The rows of bodies, the ground and points of bodies; the last are numbered as they are asked for.

    Args:
        nodes: number of nodes, whose rows come first. points (B, 2): reference points of the bodies [m].
    """

    def __init__(self, nodes: int, points: Array) -> None:
        self.nodes, self.points, self.ground = nodes, points, nodes + len(points)
        self.carriers: list[int] = []
        self.offsets: list[Array] = []

    def of(self, body: int | None, place: Sequence[float] | Array) -> int:
        """Return the row of a point at rest [m] of a body, None for the ground."""
        if body is None:
            return self.ground
        offset = np.asarray(place) - self.points[body]
        if not offset.any():
            return self.nodes + body
        self.carriers.append(self.nodes + body)
        self.offsets.append(offset)
        return self.ground + len(self.carriers)


@kernel()
def turned(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return R (x, y) with the matrix R of a turn.

    Args:
        angle: turn [rad].
        x, y: components, of any unit.
    """
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


@kernel()
def carry(carried: Carried, u: Array) -> None:
    """Move the carried rows with their bodies, exact rigid motion, and write their arms.

    Args:
        carried: K rows, their carriers and offsets, and the arms.
        u: displacements of all rows (rows, 3) [m, rad]; those of carried rows are overwritten.
    """
    (rows, carrier, offsets, rigid, arms), last, sine, cosine, less = carried, -1, 0.0, 1.0, 0.0
    for k in range(len(rows)):
        i, b, x, y = rows[k], carrier[k], offsets[k, 0], offsets[k, 1]
        if b != last:
            last, sine, cosine = b, math.sin(u[b, 2]), math.cos(u[b, 2])
            less = 2.0 * math.sin(0.5 * u[b, 2]) ** 2  # 1 - cosine, without cancellation at small turns
        arms[k, 0], arms[k, 1] = cosine * x - sine * y, sine * x + cosine * y
        u[i, 0], u[i, 1] = u[b, 0] + (-less * x - sine * y), u[b, 1] + (sine * x - less * y)
        if rigid[k]:
            u[i, 2] = u[b, 2]


@kernel()
def carry_velocity(carried: Carried, v: Array) -> None:
    """Write the velocities of the carried rows.

    Args:
        carried: K rows, their carriers and arms.
        v: velocities of all rows (rows, 3) [m/s, rad/s]; those of carried rows are overwritten.
    """
    rows, carrier, _, rigid, arms = carried
    for k in range(len(rows)):
        i, b = rows[k], carrier[k]
        v[i, 0] = v[b, 0] - v[b, 2] * arms[k, 1]
        v[i, 1] = v[b, 1] + v[b, 2] * arms[k, 0]
        if rigid[k]:
            v[i, 2] = v[b, 2]


@kernel()
def gather(carried: Carried, force: Array, curvature: Array) -> None:
    """Add the forces on carried rows to their bodies, about the points of these.

    Args:
        carried: K rows, their carriers and arms.
        force: generalised forces (rows, 3) [N, N m]; those of bodies are added to.
        curvature: what the carrying adds to the stiffness of turns (rows,) [N m], overwritten.
    """
    rows, carrier, _, rigid, arms = carried
    for i in range(len(curvature)):
        curvature[i] = 0.0
    for k in range(len(rows)):
        i, b, x, y = rows[k], carrier[k], arms[k, 0], arms[k, 1]
        force[b, 0] += force[i, 0]
        force[b, 1] += force[i, 1]
        force[b, 2] += x * force[i, 1] - y * force[i, 0]
        if rigid[k]:
            force[b, 2] += force[i, 2]
        curvature[b] -= x * force[i, 0] + y * force[i, 1]
