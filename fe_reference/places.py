"""Places where something acts: rows of nodes, of bodies and of the ground, and points that bodies carry.

Displacements, velocities and forces of all that can move are one array (rows, 3) of x, y and the turn: the
nodes strip by strip, then the reference points of the bodies, and last the ground, which stays at zero.
Loads, weights, springs and dampers act on a row, at an offset o from its point. That moves and turns with
the row:

    u = d + (R(theta) - 1) o,    u' = d' + theta' (-(R o)_y, (R o)_x)

An end of a strip on a body follows it like that without penalty or extra unknowns, and with phi = theta.
Forces are reduced by the transpose of the derivative P of the map; the tangent is P^T K P plus the curvature
of the map, -(R o).f on the diagonal entry of theta, with f the force of the element on the end.
"""

import math

from .arrays import Array, Flags, Indices, kernel

#: What an end of a strip is on, where it is not on a body: clamped to ground, or on nothing.
GROUND, FREE = -1, -2
#: Attached nodes (K,), the rows of the bodies that carry them, their offsets (K, 2) from these bodies'
#: points, and whether they turn with the bodies.
Carried = tuple[Indices, Indices, Array, Flags]


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
def swept(angle: float, x: float, y: float) -> tuple[float, float]:
    """Return (R - 1) (x, y), written with sines: no cancellation at small turns.

    Args:
        angle: turn of the matrix R [rad].
        x, y: components, of any unit.
    """
    sine, less = math.sin(angle), 2.0 * math.sin(0.5 * angle) ** 2
    return -less * x - sine * y, sine * x - less * y


@kernel()
def carry(carried: Carried, u: Array) -> None:
    """Move the attached nodes with their bodies: exact rigid motion.

    Args:
        carried: K attached nodes, their carriers and offsets.
        u: displacements of all rows (rows, 3) [m, rad]; those of attached nodes are overwritten.
    """
    attached, carrier, offsets, rigid = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = swept(u[b, 2], offsets[k, 0], offsets[k, 1])
        u[i, 0], u[i, 1] = u[b, 0] + x, u[b, 1] + y
        if rigid[k]:
            u[i, 2] = u[b, 2]


@kernel()
def carry_velocity(carried: Carried, u: Array, v: Array) -> None:
    """Write the velocities of the attached nodes.

    Args:
        carried: K attached nodes, their carriers and offsets.
        u: displacements of all rows (rows, 3) [m, rad].
        v: velocities of all rows (rows, 3) [m/s, rad/s]; those of attached nodes are overwritten.
    """
    attached, carrier, offsets, rigid = carried
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(u[b, 2], offsets[k, 0], offsets[k, 1])
        v[i, 0] = v[b, 0] - v[b, 2] * y
        v[i, 1] = v[b, 1] + v[b, 2] * x
        if rigid[k]:
            v[i, 2] = v[b, 2]


@kernel()
def gather(carried: Carried, u: Array, force: Array, curvature: Array) -> None:
    """Add the forces on attached nodes to their bodies, about the points of these.

    Args:
        carried: K attached nodes, their carriers and offsets.
        u: displacements of all rows (rows, 3) [m, rad].
        force: generalised forces (rows, 3) [N, N m]; those of bodies are added to.
        curvature: overwritten (rows, 2) [N m]: what the carrying adds to the stiffness of turns, and a zero
            for what else adds to it.
    """
    attached, carrier, offsets, rigid = carried
    for i in range(len(curvature)):
        curvature[i, 0] = curvature[i, 1] = 0.0
    for k in range(len(attached)):
        i, b = attached[k], carrier[k]
        x, y = turned(u[b, 2], offsets[k, 0], offsets[k, 1])
        force[b, 0] += force[i, 0]
        force[b, 1] += force[i, 1]
        force[b, 2] += x * force[i, 1] - y * force[i, 0]
        if rigid[k]:
            force[b, 2] += force[i, 2]
        curvature[b, 0] -= x * force[i, 0] + y * force[i, 1]
